//! The room: light, ground and air around the model.

mod air;
mod eye;
mod hull;
mod lines;

use bevy::{
    asset::RenderAssetUsages,
    color::ColorToComponents,
    dev_tools::infinite_grid::{InfiniteGrid, InfiniteGridPlugin, InfiniteGridSettings},
    light::{
        CascadeShadowConfig, CascadeShadowConfigBuilder, DirectionalLightShadowMap,
        EnvironmentMapLight, GlobalAmbientLight, NotShadowCaster, Skybox,
    },
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
    render::renderer::RenderAdapterInfo,
};

use crate::panel::Host;
use crate::settings::{RoomKind, Settings};

pub use eye::{Eye, FIELD_OF_VIEW, Unhurried, camera, headset};

/// The colours of a room.
struct Colours {
    /// The air at the horizon, overhead and underfoot.
    air: [Color; 3],
    /// What shows shadows: nearly the colour underfoot.
    ground: Color,
    /// Fine and strong lines of the ground.
    lines: [Color; 2],
    /// How strong the light of the air is, and what keeps the darkest corner legible.
    light: [f32; 2],
    /// The key light, in lux.
    key: f32,
}

impl Colours {
    fn of(room: RoomKind) -> Self {
        let rgb = Color::srgb_u8;
        match room {
            RoomKind::Dusk => Self {
                air: [
                    rgb(0x41, 0x46, 0x50),
                    rgb(0x1d, 0x1f, 0x26),
                    rgb(0x2a, 0x2d, 0x34),
                ],
                ground: Color::srgba_u8(0x2c, 0x2f, 0x36, 0xb0),
                lines: [
                    Color::srgba(0.72, 0.75, 0.82, 0.055),
                    Color::srgba(0.78, 0.81, 0.88, 0.17),
                ],
                light: [620.0, 20.0],
                key: 3_600.0,
            },
            RoomKind::Day => Self {
                air: [
                    rgb(0xe2, 0xe4, 0xe7),
                    rgb(0xb9, 0xc3, 0xd0),
                    rgb(0xc9, 0xcb, 0xcf),
                ],
                ground: Color::srgba_u8(0xd8, 0xda, 0xde, 0xb0),
                lines: [
                    Color::srgba(0.20, 0.22, 0.26, 0.11),
                    Color::srgba(0.16, 0.18, 0.22, 0.28),
                ],
                light: [760.0, 40.0],
                key: 3_900.0,
            },
            RoomKind::Paper => Self {
                air: [
                    rgb(0xff, 0xff, 0xff),
                    rgb(0xfa, 0xfa, 0xfb),
                    rgb(0xf4, 0xf4, 0xf5),
                ],
                ground: Color::srgba_u8(0xfa, 0xfa, 0xfa, 0xd0),
                lines: [
                    Color::srgba(0.30, 0.32, 0.38, 0.10),
                    Color::srgba(0.24, 0.26, 0.32, 0.24),
                ],
                light: [800.0, 40.0],
                key: 3_900.0,
            },
        }
    }
}

/// Light, ground grid and air; added only where something is drawn.
pub struct RoomPlugin;

impl Plugin for RoomPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            InfiniteGridPlugin,
            super::guides::plugin,
            super::ease::plugin,
            lines::plugin,
        ))
        .init_resource::<Air>()
        .insert_resource(DirectionalLightShadowMap { size: MAP })
        .add_systems(Startup, furnish)
        .add_systems(
            Update,
            (
                paint.run_if(resource_changed::<Settings>),
                breathe,
                eye::afford,
                shade.run_if(resource_changed::<Host>),
            )
                .chain(),
        );
    }
}

/// What surrounds every camera.
#[derive(Resource, Default)]
struct Air {
    sky: Handle<Image>,
    light: EnvironmentMapLight,
}

/// The disc that shows shadows.
#[derive(Component)]
struct Ground;

/// The one lamp that casts shadows.
#[derive(Component)]
struct KeyLight;

/// Metres from the middle within which the ground is seen in full, and to which it fades.
const GROUND: [f32; 2] = [3.0, 14.0];

fn furnish(
    (adapter, unhurried): (Option<Res<RenderAdapterInfo>>, Option<Res<Unhurried>>),
    windows: Query<&Window>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Name::new("ground grid"),
        InfiniteGrid,
        InfiniteGridSettings {
            // A line every 0.1 m, a strong one every metre.
            scale: 10.0,
            // Far lines stand closer than pixels do, seen from low down more so: they fade before they shimmer.
            fadeout_distance: 9.0,
            dot_fadeout_strength: 0.5,
            ..default()
        },
    ));
    // Without a graphics card a window shows no shadows: a frame in time is worth more. A picture
    // has the time.
    let shadows =
        windows.is_empty() || unhurried.is_some() || !adapter.is_some_and(|a| is_software(&a));
    let mut ground = commands.spawn((
        Name::new("ground"),
        Ground,
        Mesh3d(meshes.add(disc())),
        MeshMaterial3d(materials.add(StandardMaterial {
            perceptual_roughness: 1.0,
            reflectance: 0.0,
            // What is below the ground shows through it, and from below there is none.
            alpha_mode: AlphaMode::Blend,
            // Drawn before everything else that is seen through.
            depth_bias: -1000.0,
            ..default()
        })),
        NotShadowCaster,
        // Below what stands on the ground and below the lines.
        Transform::from_xyz(0.0, -0.001, 0.0),
    ));
    if !shadows {
        ground.insert(Visibility::Hidden);
    }
    // One key light from above and to the left, soft enough that no side is lost.
    commands.spawn((
        Name::new("key light"),
        KeyLight,
        DirectionalLight {
            illuminance: Colours::of(RoomKind::default()).key,
            color: Color::srgb(1.0, 0.97, 0.93),
            shadow_maps_enabled: shadows,
            // The defaults are for houses: here a thing of a few centimetres casts a shadow too.
            shadow_depth_bias: 0.004,
            shadow_normal_bias: 1.2,
            ..default()
        },
        cascades(Host::Screen),
        Transform::from_xyz(-1.6, 3.6, 2.2).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

/// Texels along an edge of what is seen from the key light.
const MAP: usize = 1536;

/// How far shadows reach, and how finely.
fn cascades(host: Host) -> CascadeShadowConfig {
    match host {
        Host::Screen => CascadeShadowConfigBuilder {
            num_cascades: 1,
            minimum_distance: 0.02,
            first_cascade_far_bound: 4.0,
            maximum_distance: 9.0,
            overlap_proportion: 0.2,
        },
        // An eye of a headset sees three times as wide: what is within reach has a map of its own, or a hand's shadow is
        // made of tiles.
        Host::Room => CascadeShadowConfigBuilder {
            num_cascades: 2,
            minimum_distance: 0.05,
            first_cascade_far_bound: 1.1,
            maximum_distance: 6.0,
            overlap_proportion: 0.25,
        },
    }
    .build()
}

/// Shadows as whoever looks needs them.
fn shade(host: Res<Host>, mut lights: Query<&mut CascadeShadowConfig, With<KeyLight>>) {
    for mut light in &mut lights {
        *light = cascades(*host);
    }
}

/// Whether the processor does the drawing.
pub fn is_software(adapter: &RenderAdapterInfo) -> bool {
    // The type itself is the graphics library's, which nothing else here needs.
    format!("{:?}", adapter.device_type) == "Cpu"
}

/// A disc that fades towards its rim.
fn disc() -> Mesh {
    const SPOKES: u32 = 48;
    let [full, rim] = GROUND;
    let mut positions = vec![[0.0, 0.0, 0.0]];
    let mut colours = vec![[1.0, 1.0, 1.0, 1.0]];
    for (radius, alpha) in [(full, 1.0), (0.5 * (full + rim), 0.35), (rim, 0.0)] {
        for spoke in 0..SPOKES {
            let (sin, cos) = (std::f32::consts::TAU * spoke as f32 / SPOKES as f32).sin_cos();
            positions.push([radius * cos, 0.0, -radius * sin]);
            colours.push([1.0, 1.0, 1.0, alpha]);
        }
    }
    let mut indices = Vec::new();
    for spoke in 0..SPOKES {
        let next = (spoke + 1) % SPOKES;
        indices.extend([0, 1 + spoke, 1 + next]);
        for ring in 0..2 {
            let [a, b] = [spoke, next].map(|s| 1 + ring * SPOKES + s);
            let [c, d] = [a + SPOKES, b + SPOKES];
            indices.extend([a, c, b, b, c, d]);
        }
    }
    let up = vec![[0.0, 1.0, 0.0]; positions.len()];
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, up)
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
    .with_inserted_indices(Indices::U32(indices))
}

/// The room in its colours.
fn paint(
    settings: Res<Settings>,
    mut painted: Local<Option<RoomKind>>,
    mut air: ResMut<Air>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    (mut clear, mut ambient): (ResMut<ClearColor>, ResMut<GlobalAmbientLight>),
    ground: Query<&MeshMaterial3d<StandardMaterial>, With<Ground>>,
    mut key: Query<&mut DirectionalLight, With<KeyLight>>,
    mut grid: Query<&mut InfiniteGridSettings>,
) {
    let room = settings.look.room;
    if painted.replace(room) == Some(room) {
        return;
    }
    let colours = Colours::of(room);
    clear.0 = colours.air[0];
    let [light, least] = colours.light;
    ambient.brightness = least;
    for mut key in &mut key {
        key.illuminance = colours.key;
    }
    for material in &ground {
        if let Some(mut material) = materials.get_mut(&material.0) {
            material.base_color = colours.ground;
        }
    }
    let [minor, major] = colours.lines;
    for mut settings in &mut grid {
        settings.minor_line_color = minor;
        settings.major_line_color = major;
        // Colour belongs to the model: the axes are told apart by their strength alone.
        settings.x_axis_color = major.with_alpha(1.0).mix(&colours.air[2], 0.6);
        settings.z_axis_color = settings.x_axis_color;
    }
    let [middle, high, low] = colours.air.map(|c| c.to_linear());
    air.sky = images.add(air::cube(128, 1, |from, _| {
        let towards = if from.y < 0.0 { low } else { high };
        // The light band at the horizon is narrow below and wide above.
        let t = (from.y.abs() / if from.y < 0.0 { 0.45 } else { 0.75 }).min(1.0);
        middle.mix(&towards, t * t * (3.0 - 2.0 * t)).to_vec3()
    }));
    if air.light.diffuse_map == Handle::default() {
        let [matte, shine] = air::cubes();
        air.light.diffuse_map = images.add(matte);
        air.light.specular_map = images.add(shine);
    }
    air.light.intensity = light;
}

/// Every camera stands in the same air.
fn breathe(
    air: Res<Air>,
    cameras: Query<Entity, With<Camera3d>>,
    fresh: Query<(), Added<Camera3d>>,
    mut commands: Commands,
) {
    for camera in &cameras {
        if air.is_changed() || fresh.contains(camera) {
            commands.entity(camera).insert((
                Skybox {
                    image: Some(air.sky.clone()),
                    // Undone by the camera's exposure, so that the colours are those above.
                    brightness: 1_000.0,
                    ..default()
                },
                air.light.clone(),
            ));
        }
    }
}
