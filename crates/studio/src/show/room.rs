//! The room: light, ground and air around the model.

use bevy::{
    dev_tools::infinite_grid::{InfiniteGrid, InfiniteGridPlugin, InfiniteGridSettings},
    light::GlobalAmbientLight,
    prelude::*,
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
    /// The colour of the air.
    pub fn air(self) -> Color {
        match self {
            Self::Dusk => Color::srgb_u8(0x2b, 0x2e, 0x35),
            Self::Day => Color::srgb_u8(0xd9, 0xdc, 0xe0),
        }
    }
}

/// Light, ground grid and air; added only where something is drawn.
pub struct RoomPlugin;

impl Plugin for RoomPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(InfiniteGridPlugin)
            .init_resource::<Room>()
            .add_systems(Startup, furnish)
            .add_systems(Update, air.run_if(resource_changed::<Room>));
    }
}

fn furnish(mut commands: Commands) {
    commands.spawn((
        Name::new("ground grid"),
        InfiniteGrid,
        InfiniteGridSettings::default(),
    ));
    // One key light from above and to the left, soft enough that no side is lost.
    commands.spawn((
        Name::new("key light"),
        DirectionalLight {
            illuminance: 7_500.0,
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::from_xyz(-1.5, 3.5, 2.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    commands.spawn((
        Name::new("fill light"),
        DirectionalLight {
            illuminance: 1_600.0,
            color: Color::srgb(0.80, 0.87, 1.0),
            ..default()
        },
        Transform::from_xyz(2.5, 1.0, -1.5).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}

fn air(room: Res<Room>, mut clear: ResMut<ClearColor>, mut ambient: ResMut<GlobalAmbientLight>) {
    clear.0 = room.air();
    ambient.brightness = match *room {
        Room::Dusk => 260.0,
        Room::Day => 650.0,
    };
}
