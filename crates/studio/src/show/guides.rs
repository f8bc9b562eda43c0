//! What shows where hands and things are in depth: the work plane, what snaps, the ruler's line, and
//! under each hand a plumb line and a contact shadow.

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy_rapier3d::prelude::{QueryFilter, ReadRapierContext};

use super::Drafts;
use crate::StudioSet;
use crate::hands::{Hands, Side};
use crate::pick::{Proxy, Touch};
use crate::plane::WorkPlane;
use crate::ruler::Ruler;
use crate::settings::{MirrorPlane, Settings};
use crate::snap::{SnapPreview, Snapped};
use crate::units::size;

/// Hands higher than this above everything (physical metres) have no plumb line.
const DEEPEST: f32 = 4.0;
/// The radius of the contact shadow, in physical metres.
const SHADOW: f32 = 0.025;
/// How many lines of the work plane are drawn to each side of its middle.
const LINES: u32 = 20;

/// The neutral that guides are drawn in, seen on light and dark alike.
const GUIDE: Color = Color::srgb(0.55, 0.58, 0.66);

/// What live symmetry is drawn in: the accent.
const SYMMETRY: Color = Color::srgb(0.56, 0.48, 0.90);

/// The contact shadow of one hand.
#[derive(Component)]
struct Contact(Side);

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, spawn).add_systems(
        Update,
        (plumb, plane, snaps, ruler, symmetry).in_set(StudioSet::Cue),
    );
}

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let disc = meshes.add(Circle::new(1.0).mesh().resolution(32));
    let dark = materials.add(StandardMaterial {
        base_color: Color::srgba(0.02, 0.02, 0.03, 0.45),
        alpha_mode: AlphaMode::Blend,
        unlit: true,
        cull_mode: None,
        depth_bias: 10.0,
        ..default()
    });
    for side in Side::BOTH {
        commands.spawn((
            Name::new("contact shadow"),
            Contact(side),
            Mesh3d(disc.clone()),
            MeshMaterial3d(dark.clone()),
            Visibility::Hidden,
            NotShadowCaster,
            NotShadowReceiver,
        ));
    }
}

/// Under each hand that is seen: a line to what is below it, and a shadow where it ends.
fn plumb(
    mut gizmos: Gizmos,
    hands: Res<Hands>,
    drafts: Res<Drafts>,
    touch: Res<Touch>,
    context: ReadRapierContext,
    proxies: Query<&Proxy>,
    mut discs: Query<(&Contact, &mut Transform, &mut Visibility)>,
) {
    let context = context.single().ok();
    for (contact, mut at, mut visibility) in &mut discs {
        let hand = hands.get(contact.0);
        let tip = hand.pose.position;
        let unit = 1.0 / hands.metres_per_world;
        // A hand at rest hangs behind the eyes.
        let seen = hand.tracked
            && hands
                .head
                .is_none_or(|h| (h.rotation * Vec3::NEG_Z).dot(tip - h.position) > 0.0);
        // A hand that lies on a thing shows by itself how deep it is.
        let resting = touch
            .get(contact.0)
            .is_some_and(|t| drafts.get(t.object).is_none());
        let seen = seen && !resting;
        // What is held moves along with the hand and is not below it.
        let below = |entity: Entity| {
            proxies
                .get(entity)
                .is_ok_and(|p| drafts.get(p.object).is_none())
        };
        let filter = QueryFilter::default().predicate(&below);
        let hit = context.as_ref().filter(|_| seen).and_then(|c| {
            c.cast_ray_and_get_normal(tip, Vec3::NEG_Y, DEEPEST * unit, true, filter)
        });
        let found = match hit {
            Some((_, hit)) => Some((hit.point, hit.normal)),
            None if tip.y >= 0.0 => Some((tip.with_y(0.0), Vec3::Y)),
            None => None,
        };
        let found = found.filter(|(at, _)| seen && tip.distance(*at) < DEEPEST * unit);
        let wanted = if found.is_some() {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        };
        visibility.set_if_neq(wanted);
        let Some((point, normal)) = found else {
            continue;
        };
        let far = tip.distance(point);
        // The higher the hand, the wider and the fainter its shadow would be; wider is enough.
        let radius = SHADOW * unit + 0.06 * far;
        at.set_if_neq(Transform {
            translation: point + normal * 0.002 * unit,
            rotation: Quat::from_rotation_arc(Vec3::Z, normal.normalize_or(Vec3::Y)),
            scale: Vec3::splat(radius),
        });
        if far > 0.01 * unit {
            gizmos.line(tip, point, GUIDE.with_alpha(0.6));
            gizmos.circle(
                Isometry3d::new(at.translation, at.rotation),
                radius,
                GUIDE.with_alpha(0.7),
            );
        }
    }
}

/// The work plane, while it is in use.
fn plane(mut gizmos: Gizmos, plane: Res<WorkPlane>, settings: Res<Settings>) {
    if !plane.shown {
        return;
    }
    let step = settings.snap.grid.step;
    let step = if step.is_finite() {
        step.clamp(0.01, 1.0)
    } else {
        0.1
    };
    let cells = UVec2::splat(2 * LINES);
    // The lines of `grid` lie in its x and y.
    let turned = plane.rotation * Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    gizmos
        .grid(
            Isometry3d::new(plane.middle(), turned),
            cells,
            Vec2::splat(step),
            GUIDE.with_alpha(0.22),
        )
        .outer_edges();
    let reach = step * LINES as f32;
    for (axis, colour) in [(Vec3::X, 0.5), (Vec3::Z, 0.5)] {
        let half = plane.rotation * axis * reach;
        gizmos.line(
            plane.middle() - half,
            plane.middle() + half,
            GUIDE.with_alpha(colour),
        );
    }
    gizmos.arrow(
        plane.middle(),
        plane.middle() + plane.normal() * (2.0 * step),
        GUIDE,
    );
}

/// What snaps, and to what, before it is let go.
fn snaps(
    mut gizmos: Gizmos,
    preview: Res<SnapPreview>,
    plane: Res<WorkPlane>,
    settings: Res<Settings>,
    mut readouts: ResMut<super::Readouts>,
) {
    for snapped in &preview.0 {
        let Snapped {
            placement,
            grid,
            angle,
            surface,
        } = snapped;
        let mut words = Vec::new();
        if let Some(foot) = grid {
            let step = settings.snap.grid.step;
            let turned = plane.rotation * Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
            gizmos
                .grid(
                    Isometry3d::new(*foot, turned),
                    UVec2::splat(4),
                    Vec2::splat(step),
                    GUIDE.with_alpha(0.35),
                )
                .outer_edges();
            let local = plane.to_local(*foot);
            words.push(size(local, settings.units.length).replace('×', "/"));
        }
        if let Some(degrees) = angle {
            let named = [("↻", degrees.x), ("↕", degrees.y), ("roll", degrees.z)];
            let said: Vec<_> = named
                .into_iter()
                .filter(|(_, d)| d.abs() > 0.01)
                .map(|(name, d)| format!("{name} {d:.0}°"))
                .collect();
            words.push(if said.is_empty() {
                "0°".to_owned()
            } else {
                said.join(" ")
            });
        }
        if let Some(at) = surface {
            let flat = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
            gizmos.circle(Isometry3d::new(*at + 0.002 * Vec3::Y, flat), 0.03, GUIDE);
            gizmos.line(*at, placement.translation, GUIDE.with_alpha(0.5));
            let on = if at.y.abs() < 1e-5 {
                "on the ground"
            } else {
                "on the surface"
            };
            words.push(on.to_owned());
        }
        if !words.is_empty() {
            readouts.say(placement.translation, words.join(" · "));
        }
    }
}

/// Half the side of what is shown of a mirror plane, in metres.
const MIRROR: f32 = 1.0;

/// The plane and the axis of live symmetry, while it is on.
fn symmetry(mut gizmos: Gizmos, settings: Res<Settings>) {
    let symmetry = &settings.symmetry;
    if !symmetry.is_on() || !symmetry.planes {
        return;
    }
    let colour = SYMMETRY.with_alpha(0.55);
    let half_turn = std::f32::consts::FRAC_PI_2;
    let turned = match symmetry.mirror {
        MirrorPlane::None => None,
        // Squares lie in x and y.
        MirrorPlane::X => Some(Quat::from_rotation_y(half_turn)),
        MirrorPlane::Y => Some(Quat::from_rotation_x(half_turn)),
        MirrorPlane::Z => Some(Quat::IDENTITY),
    };
    if let Some(turned) = turned {
        // An upright plane stands on the ground.
        let up = if symmetry.mirror == MirrorPlane::Y {
            0.0
        } else {
            MIRROR
        };
        let at = Isometry3d::new(Vec3::Y * up, turned);
        gizmos.rect(at, Vec2::splat(2.0 * MIRROR), colour);
        let cells = UVec2::splat(8);
        let cell = Vec2::splat(0.25 * MIRROR);
        gizmos.grid(at, cells, cell, SYMMETRY.with_alpha(0.12));
    }
    let count = symmetry.count.clamp(1, 64);
    if count > 1 {
        gizmos.line(Vec3::ZERO, Vec3::Y * 2.0 * MIRROR, colour);
        for i in 0..count {
            let angle = std::f32::consts::TAU * i as f32 / count as f32;
            let spoke = Quat::from_rotation_y(angle) * Vec3::Z * MIRROR;
            gizmos.line(Vec3::ZERO, spoke, SYMMETRY.with_alpha(0.4));
        }
    }
}

fn ruler(mut gizmos: Gizmos, ruler: Res<Ruler>, hands: Res<Hands>) {
    let size = 0.006 / hands.metres_per_world;
    for &point in ruler
        .points()
        .iter()
        .chain(&ruler.pointed.filter(|_| ruler.on))
    {
        gizmos.sphere(point, size, GUIDE);
    }
    if let Some((a, b)) = ruler.ends() {
        gizmos.line(a, b, Color::WHITE);
    }
}
