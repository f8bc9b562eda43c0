//! A dot where a wand would click, and the thread that leads to it.

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use midair_studio::hands::Side;

use super::{Wands, ray};
use crate::boards::Boards;
use crate::room::{Root, Stance};

/// Metres across the dot at a metre from the eyes.
const DOT: f32 = 0.012;
/// Metres across the thread.
const THREAD: f32 = 0.0022;

/// The dot of a wand.
#[derive(Component)]
pub(crate) struct Dot(Side);

/// The thread of a wand.
#[derive(Component)]
pub(crate) struct Thread(Side);

pub(crate) fn spawn(
    root: Single<Entity, With<Root>>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let dot = meshes.add(Sphere::new(0.5).mesh().uv(20, 12));
    let thread = meshes.add(Cylinder::new(0.5, 1.0).mesh().resolution(8).without_caps());
    let mut plain = |colour: Color| {
        materials.add(StandardMaterial {
            base_color: colour,
            unlit: true,
            alpha_mode: AlphaMode::Blend,
            ..default()
        })
    };
    let bright = plain(Color::srgb_u8(0xb3, 0xa2, 0xff));
    let faint = plain(Color::srgba(0.62, 0.54, 0.95, 0.45));
    for side in Side::BOTH {
        commands.spawn((
            Dot(side),
            Mesh3d(dot.clone()),
            MeshMaterial3d(bright.clone()),
            NotShadowCaster,
            NotShadowReceiver,
            Transform::default(),
            Visibility::Hidden,
            ChildOf(*root),
        ));
        commands.spawn((
            Thread(side),
            Mesh3d(thread.clone()),
            MeshMaterial3d(faint.clone()),
            NotShadowCaster,
            NotShadowReceiver,
            Transform::default(),
            Visibility::Hidden,
            ChildOf(*root),
        ));
    }
}

pub(crate) fn show(
    (wands, boards, stance): (Res<Wands>, Res<Boards>, Res<Stance>),
    mut dots: Query<(&Dot, &mut Transform, &mut Visibility), Without<Thread>>,
    mut threads: Query<(&Thread, &mut Transform, &mut Visibility), Without<Dot>>,
) {
    let end = |side: Side| {
        let met = wands.get(side).met?;
        let board = boards.get(met.board)?;
        let pressed = wands.get(side).pressed.is_some();
        // The dot is where the board has its pointer: before it clicks, and while a hand trembles.
        let at = match board.pointer {
            Some((owner, at)) if owner == side => at,
            _ => met.at,
        };
        let lifted = board.at(at) + board.pose.rotation * Vec3::Z * 0.002;
        Some((lifted, board.pose.rotation, pressed))
    };
    for (dot, mut transform, mut visibility) in &mut dots {
        let Some((at, facing, pressed)) = end(dot.0) else {
            visibility.set_if_neq(Visibility::Hidden);
            continue;
        };
        visibility.set_if_neq(Visibility::Inherited);
        let size = DOT * at.distance(stance.head.position).max(0.2);
        let size = if pressed { 0.7 * size } else { size };
        *transform = Transform {
            translation: at,
            rotation: facing,
            scale: Vec3::new(size, size, 0.2 * size),
        };
    }
    for (thread, mut transform, mut visibility) in &mut threads {
        let Some((at, ..)) = end(thread.0) else {
            visibility.set_if_neq(Visibility::Hidden);
            continue;
        };
        visibility.set_if_neq(Visibility::Inherited);
        let (from, _) = ray(&stance.hand(thread.0));
        let along = at - from;
        *transform = Transform {
            translation: from.midpoint(at),
            rotation: Quat::from_rotation_arc(Vec3::Y, along.normalize_or(Vec3::Y)),
            scale: Vec3::new(THREAD, along.length(), THREAD),
        };
    }
}
