//! The room: light, ground and air around the model.

use bevy::{
    asset::RenderAssetUsages,
    dev_tools::infinite_grid::{InfiniteGrid, InfiniteGridPlugin, InfiniteGridSettings},
    light::{
        CascadeShadowConfigBuilder, DirectionalLightShadowMap, EnvironmentMapLight,
        GlobalAmbientLight, NotShadowCaster, Skybox,
    },
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
    render::{
        render_resource::{
            Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
        },
        renderer::RenderAdapterInfo,
    },
};

/// Which room one works in.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Room {
    /// Calm and dark, the default.
    #[default]
    Dusk,
    /// Bright.
    Day,
}

impl Room {
    /// The colour of the air at the horizon.
    pub fn air(self) -> Color {
        match self {
            Self::Dusk => Color::srgb_u8(0x41, 0x46, 0x50),
            Self::Day => Color::srgb_u8(0xe2, 0xe4, 0xe7),
        }
    }

    /// The colour overhead.
    fn zenith(self) -> Color {
        match self {
            Self::Dusk => Color::srgb_u8(0x1d, 0x1f, 0x26),
            Self::Day => Color::srgb_u8(0xb9, 0xc3, 0xd0),
        }
    }

    /// The colour underfoot.
    fn nadir(self) -> Color {
        match self {
            Self::Dusk => Color::srgb_u8(0x2a, 0x2d, 0x34),
            Self::Day => Color::srgb_u8(0xc9, 0xcb, 0xcf),
        }
    }

    /// What shows shadows: nearly the colour underfoot.
    fn ground(self) -> Color {
        match self {
            Self::Dusk => Color::srgba_u8(0x2c, 0x2f, 0x36, 0xb0),
            Self::Day => Color::srgba_u8(0xd8, 0xda, 0xde, 0xb0),
        }
    }

    /// Fine and strong lines of the ground.
    fn lines(self) -> [Color; 2] {
        match self {
            Self::Dusk => [
                Color::srgba(0.72, 0.75, 0.82, 0.10),
                Color::srgba(0.78, 0.81, 0.88, 0.26),
            ],
            Self::Day => [
                Color::srgba(0.20, 0.22, 0.26, 0.18),
                Color::srgba(0.16, 0.18, 0.22, 0.40),
            ],
        }
    }
}

/// Light, ground grid and air; added only where something is drawn.
pub struct RoomPlugin;

impl Plugin for RoomPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((InfiniteGridPlugin, super::guides::plugin))
            .init_resource::<Room>()
            .init_resource::<Air>()
            .insert_resource(DirectionalLightShadowMap { size: 1536 })
            .add_systems(Startup, furnish)
            .add_systems(
                Update,
                (paint.run_if(resource_changed::<Room>), breathe).chain(),
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

/// Metres from the middle within which the ground is seen in full, and to which it fades.
const GROUND: [f32; 2] = [3.0, 14.0];

fn furnish(
    adapter: Option<Res<RenderAdapterInfo>>,
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
            fadeout_distance: 18.0,
            dot_fadeout_strength: 0.2,
            ..default()
        },
    ));
    // Without a graphics card a window shows no shadows: a frame in time is worth more. A picture
    // has the time.
    let shadows = windows.is_empty() || !adapter.is_some_and(|a| is_software(&a));
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
        DirectionalLight {
            illuminance: 6_800.0,
            color: Color::srgb(1.0, 0.97, 0.93),
            shadow_maps_enabled: shadows,
            // The defaults are for houses: here a thing of a few centimetres casts a shadow too.
            shadow_depth_bias: 0.004,
            shadow_normal_bias: 1.2,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 1,
            minimum_distance: 0.02,
            first_cascade_far_bound: 4.0,
            maximum_distance: 9.0,
            overlap_proportion: 0.2,
        }
        .build(),
        Transform::from_xyz(-1.6, 3.6, 2.2).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.spawn((
        Name::new("fill light"),
        DirectionalLight {
            illuminance: 1_500.0,
            color: Color::srgb(0.80, 0.87, 1.0),
            ..default()
        },
        Transform::from_xyz(2.6, 1.0, -1.4).looking_at(Vec3::ZERO, Vec3::Y),
    ));
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
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, up)
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
    .with_inserted_indices(Indices::U32(indices))
}

/// The room in its colours.
fn paint(
    room: Res<Room>,
    mut air: ResMut<Air>,
    mut images: ResMut<Assets<Image>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut clear: ResMut<ClearColor>,
    mut ambient: ResMut<GlobalAmbientLight>,
    ground: Query<&MeshMaterial3d<StandardMaterial>, With<Ground>>,
    mut grid: Query<&mut InfiniteGridSettings>,
) {
    clear.0 = room.air();
    // The light of the air says which way is up; this keeps the darkest corner legible.
    ambient.brightness = match *room {
        Room::Dusk => 60.0,
        Room::Day => 160.0,
    };
    for material in &ground {
        if let Some(mut material) = materials.get_mut(&material.0) {
            material.base_color = room.ground();
        }
    }
    let [minor, major] = room.lines();
    for mut settings in &mut grid {
        settings.minor_line_color = minor;
        settings.major_line_color = major;
        // Colour belongs to the model: the axes are told apart by their strength alone.
        settings.x_axis_color = major.with_alpha(1.0).darker(0.30);
        settings.z_axis_color = major.with_alpha(1.0).darker(0.30);
    }
    air.sky = images.add(sky(*room));
    let light = [0.95, 0.55, 0.30].map(|l| Color::srgb(0.96 * l, 0.98 * l, l));
    air.light = EnvironmentMapLight {
        intensity: match *room {
            Room::Dusk => 950.0,
            Room::Day => 1_500.0,
        },
        ..EnvironmentMapLight::hemispherical_gradient(&mut images, light[0], light[1], light[2])
    };
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

/// A soft gradient from underfoot to overhead, as the six faces of a cube.
fn sky(room: Room) -> Image {
    const SIDE: u32 = 128;
    let [low, middle, high] = [room.nadir(), room.air(), room.zenith()].map(|c| c.to_linear());
    let mut texels = Vec::with_capacity((SIDE * SIDE * 6 * 8) as usize);
    for face in 0..6 {
        for row in 0..SIDE {
            for column in 0..SIDE {
                let [u, v] = [column, row].map(|i| 2.0 * (i as f32 + 0.5) / SIDE as f32 - 1.0);
                let y = match face {
                    2 => 1.0,
                    3 => -1.0,
                    _ => -v,
                };
                let height = y / (1.0 + u * u + v * v).sqrt();
                let towards = if height < 0.0 { low } else { high };
                // The light band at the horizon is narrow below and wide above.
                let t = (height.abs() / if height < 0.0 { 0.45 } else { 0.75 }).min(1.0);
                let colour = middle.mix(&towards, t * t * (3.0 - 2.0 * t));
                for channel in [colour.red, colour.green, colour.blue, 1.0] {
                    texels.extend(half(channel).to_le_bytes());
                }
            }
        }
    }
    let mut image = Image::new(
        Extent3d {
            width: SIDE,
            height: SIDE,
            depth_or_array_layers: 6,
        },
        TextureDimension::D2,
        texels,
        // Eight bits would show as bands in so dark a gradient.
        TextureFormat::Rgba16Float,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::Cube),
        ..default()
    });
    image
}

/// A number in [2⁻¹⁴, 2) as a binary16; smaller ones become 0.
fn half(x: f32) -> u16 {
    let bits = x.to_bits();
    let exponent = (bits >> 23) as i32 - 127 + 15;
    if exponent <= 0 {
        return 0;
    }
    // Rounded: a carry into the exponent is right.
    ((((exponent as u32) << 23 | bits & 0x7f_ffff) + 0x1000) >> 13) as u16
}

#[cfg(test)]
mod tests {
    use super::half;

    #[test]
    fn halves() {
        assert_eq!(half(1.0), 0x3c00);
        assert_eq!(half(0.5), 0x3800);
        assert_eq!(half(0.333_25), 0x3555);
        assert_eq!(half(0.0), 0);
    }
}
