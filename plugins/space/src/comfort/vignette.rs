//! The edge of the view darkens while the world moves: what does not flow past the corner of the eye makes nobody ill.

use std::f32::consts::TAU;

use bevy::asset::RenderAssetUsages;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use midair_studio::settings::Settings;
use midair_studio::world::WorldView;

use crate::ink::{Ink, Over};
use crate::room::{Root, Stance};

/// Metres before the eyes.
const AWAY: f32 = 1.0;
/// The half angle that stays clear, in radians: wide open, where a headset's own view ends, and as narrow as it gets.
const CLEAR: [f32; 2] = [0.95, 0.40];
/// Of the half angle beyond which all is dark, from where it begins.
const SOFT: f32 = 0.35;
/// Seconds in which it closes, and opens again.
const EASES: f32 = 0.15;

/// Radians from one frame to the next of a turn in steps.
const JUMP: f32 = 0.12;

/// The dark ring before the eyes.
#[derive(Component)]
pub(crate) struct Vignette;

/// How far it is closed, 0 to 1, and how the world stood.
#[derive(Default)]
pub(crate) struct Closed {
    part: f32,
    last: Option<Mat4>,
}

pub(crate) fn darken(
    (settings, view, stance, time): (Res<Settings>, Res<WorldView>, Res<Stance>, Res<Time>),
    root: Single<Entity, With<Root>>,
    ring: Option<Single<(Entity, &mut Transform, &mut Visibility), With<Vignette>>>,
    (mut meshes, mut inks, mut images): (
        ResMut<Assets<Mesh>>,
        ResMut<Assets<Ink>>,
        ResMut<Assets<Image>>,
    ),
    mut closed: Local<Closed>,
    mut commands: Commands,
) {
    let room = view.room_from_world;
    let now = Mat4::from_scale_rotation_translation(
        Vec3::splat(room.scale),
        room.rotation,
        room.translation,
    );
    let last = closed.last.replace(now).unwrap_or(now);
    let moves = last != now;
    let strength = settings.comfort.vignette.clamp(0.0, 1.0);
    let wanted = if moves && stance.head_known {
        strength
    } else {
        0.0
    };
    closed.part = if jumps(&last, &now) {
        // What is over in one frame is not waited for: it is dark in that frame, and opens after it.
        wanted
    } else {
        // A frame that takes long opens it no farther than a short one, or nobody would see it.
        let most = time.delta_secs().min(1.0 / 45.0) / EASES;
        closed.part + (wanted - closed.part).clamp(-most, most)
    };
    let Some(ring) = ring else {
        if closed.part > 0.0 {
            let page = images.add(Image::default());
            commands.spawn((
                Vignette,
                Name::new("vignette"),
                Mesh3d(meshes.add(dark())),
                MeshMaterial3d(inks.add(Ink {
                    page,
                    over: Over::Front,
                })),
                NotShadowCaster,
                NotShadowReceiver,
                Transform::default(),
                Visibility::Hidden,
                ChildOf(*root),
            ));
        }
        return;
    };
    let (_, mut transform, mut visibility) = ring.into_inner();
    if closed.part <= 0.0 {
        visibility.set_if_neq(Visibility::Hidden);
        return;
    }
    visibility.set_if_neq(Visibility::Inherited);
    let [open, narrow] = CLEAR;
    let angle = open + (narrow - open) * closed.part;
    let head = stance.head;
    *transform = Transform {
        translation: head.position + head.rotation * (AWAY * Vec3::NEG_Z),
        rotation: head.rotation,
        // The mesh's clear part has the radius 1.
        scale: Vec3::new(angle.tan(), angle.tan(), 1.0) * AWAY,
    };
}

/// Whether the world turned, between two frames, by more than it does while a hand moves it.
fn jumps(last: &Mat4, now: &Mat4) -> bool {
    let turn = |m: &Mat4| m.to_scale_rotation_translation().1;
    turn(last).angle_between(turn(now)) > JUMP
}

/// A ring of radius 1, clear at its inner edge and dark beyond the soft part.
fn dark() -> Mesh {
    const SPOKES: u32 = 64;
    let mut positions = Vec::new();
    let mut colours = Vec::new();
    for (radius, alpha) in [(1.0, 0.0), (1.0 + SOFT, 0.96), (60.0, 0.96)] {
        for spoke in 0..SPOKES {
            let (sin, cos) = (TAU * spoke as f32 / SPOKES as f32).sin_cos();
            positions.push([radius * cos, radius * sin, 0.0]);
            colours.push([0.0, 0.0, 0.0, alpha]);
        }
    }
    let mut indices = Vec::new();
    for ring in 0..2 {
        for spoke in 0..SPOKES {
            let [a, b] = [spoke, (spoke + 1) % SPOKES].map(|s| ring * SPOKES + s);
            let [c, d] = [a + SPOKES, b + SPOKES];
            indices.extend([a, c, b, b, c, d]);
        }
    }
    let count = positions.len();
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; count])
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.5, 0.5]; count])
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colours)
    .with_inserted_indices(Indices::U32(indices))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_in_steps_is_told_from_one_by_hand() {
        let turned = |degrees: f32| {
            Mat4::from_scale_rotation_translation(
                Vec3::splat(0.7),
                Quat::from_rotation_y(degrees.to_radians()),
                Vec3::new(0.2, 0.0, degrees),
            )
        };
        assert!(jumps(&turned(0.0), &turned(15.0)));
        // Half a turn in a second.
        assert!(!jumps(&turned(0.0), &turned(2.0)));
        assert!(!jumps(&turned(30.0), &turned(30.0)));
    }
}
