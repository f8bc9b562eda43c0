//! Hands as they are seen: a wand with a trigger, a grip, a pad and a menu button, greyed while it is lost.

mod model;

use bevy::light::NotShadowReceiver;
use bevy::prelude::*;
use midair_studio::hands::{Action, Hands, Side};

pub(crate) use model::Part;

use crate::room::{Root, Stance};

/// One hand's wand.
#[derive(Component)]
pub(crate) struct Wand(Side);

/// A part of it, and what it looks like at rest.
#[derive(Component)]
pub(crate) struct Piece {
    side: Side,
    part: Option<Part>,
    rest: Handle<StandardMaterial>,
}

/// What parts are made of.
#[derive(Resource)]
pub(crate) struct Looks {
    pressed: Handle<StandardMaterial>,
    lost: Handle<StandardMaterial>,
}

pub(crate) fn spawn(
    root: Single<Entity, With<Root>>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let matte = |colour: Color, roughness: f32| StandardMaterial {
        base_color: colour,
        perceptual_roughness: roughness,
        reflectance: 0.35,
        ..default()
    };
    let looks = Looks {
        pressed: materials.add(StandardMaterial {
            emissive: LinearRgba::rgb(0.35, 0.26, 0.9),
            ..matte(Color::srgb_u8(0x8f, 0x7a, 0xe6), 0.5)
        }),
        lost: materials.add(StandardMaterial {
            base_color: Color::srgba(0.5, 0.5, 0.52, 0.35),
            alpha_mode: AlphaMode::Blend,
            ..default()
        }),
    };
    let body = materials.add(matte(Color::srgb_u8(0x3a, 0x3d, 0x45), 0.62));
    let button = materials.add(matte(Color::srgb_u8(0x6b, 0x6f, 0x7a), 0.5));
    let bright = materials.add(matte(Color::srgb_u8(0xd9, 0xd8, 0xd4), 0.4));
    for side in Side::BOTH {
        let wand = commands
            .spawn((
                Name::new(format!("{side:?} hand")),
                Wand(side),
                Transform::default(),
                Visibility::Hidden,
                ChildOf(*root),
            ))
            .id();
        for made in model::pieces() {
            let rest = match made.look {
                model::Look::Body => body.clone(),
                model::Look::Button => button.clone(),
                model::Look::Bright => bright.clone(),
            };
            commands.spawn((
                Piece {
                    side,
                    part: made.part,
                    rest: rest.clone(),
                },
                Mesh3d(meshes.add(made.mesh)),
                MeshMaterial3d(rest),
                NotShadowReceiver,
                made.place,
                ChildOf(wand),
            ));
        }
    }
    commands.insert_resource(looks);
}

/// Each wand where its hand is; what is pressed lights up.
pub(crate) fn draw(
    (stance, hands): (Res<Stance>, Res<Hands>),
    looks: Option<Res<Looks>>,
    mut wands: Query<(&Wand, &mut Transform, &mut Visibility)>,
    mut pieces: Query<(&Piece, &mut MeshMaterial3d<StandardMaterial>)>,
    mut seen: Local<[bool; 2]>,
) {
    let Some(looks) = looks else { return };
    for (wand, mut transform, mut visibility) in &mut wands {
        let i = wand.0 as usize;
        // A hand that was never there is not shown.
        seen[i] |= stance.tracked[i];
        visibility.set_if_neq(if seen[i] {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        });
        let hand = stance.hands[i];
        transform.set_if_neq(Transform {
            translation: hand.position,
            rotation: hand.rotation,
            scale: Vec3::ONE,
        });
    }
    for (piece, mut material) in &mut pieces {
        let hand = hands.get(piece.side);
        let down = |action| hand.held(action);
        let pressed = piece.part.is_some_and(|part| match part {
            Part::Trigger => down(Action::Act),
            Part::Grip => down(Action::Grab),
            Part::Pad => down(Action::Centre) || hand.swipe.is_some(),
            Part::Menu => down(Action::Menu) || down(Action::Library) || down(Action::Save),
            Part::Up => down(Action::Up),
            Part::Right => down(Action::Right) || down(Action::Redo),
            Part::Down => down(Action::Down),
            Part::Left => down(Action::Left) || down(Action::Undo),
        });
        let wanted = if !stance.tracked[piece.side as usize] {
            &looks.lost
        } else if pressed {
            &looks.pressed
        } else {
            &piece.rest
        };
        if material.0 != *wanted {
            material.0 = wanted.clone();
        }
    }
}
