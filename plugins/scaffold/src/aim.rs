//! What a pointer is to be caught by: keypoints and lines, and while a line is pulled the directions it could have.

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_studio::drawing::Drawing;
use midair_studio::hands::Hands;
use midair_studio::plane::WorkPlane;
use midair_studio::tools::Aim;

use crate::ghost::ghosts;
use crate::phase::{Draft, Phase};

/// More directions than this crowd the view.
const DIRECTIONS: usize = 16;
/// A direction reaches so far from where the line begins, as a share of how far that is from the eyes.
const REACH: f64 = 0.8;

pub(crate) fn aim(
    hands: Res<Hands>,
    drawing: Res<Drawing>,
    plane: Res<WorkPlane>,
    draft: Res<Draft>,
    mut aim: ResMut<Aim>,
) {
    let mut next = Aim {
        draws: true,
        ..default()
    };
    // A free curve is not to be pulled about; its depth comes when it is let go.
    let catches = !matches!(draft.phase, Phase::Stroke { .. });
    if catches && hands.pixel > 0.0 {
        next.points = drawing.keypoints().map(|p| p.as_vec3()).collect();
        let ends = |l: &midair_studio::drawing::SceneLine| (l.a.as_vec3(), l.b.as_vec3());
        next.lines = drawing.lines().iter().map(ends).collect();
        next.points
            .extend(ghosts(&draft).map(|g| g.place.as_vec3()));
    }
    // A press on a ghost stays on it: without it the pointer would have another depth.
    let begun = match &draft.phase {
        Phase::Line { from, .. } => Some(*from),
        Phase::Stroke { points, .. } => points.first().map(|p| p.at),
        Phase::Idle => None,
    };
    let of_ghost = |from: &DVec3| {
        let last = draft.last.as_ref();
        last.is_some_and(|l| l.places.iter().any(|p| p.distance(*from) < 1e-4))
    };
    if let Phase::Line { from, .. } = draft.phase
        && hands.pixel > 0.0
        && let Some(head) = hands.head
    {
        // Where it begins catches nothing: that would be no line.
        let from_single = from.as_vec3();
        next.points.retain(|p| p.distance(from_single) > 1e-4);
        let far = from.distance(head.position.as_dvec3()) * REACH;
        for along in directions(&drawing, &plane) {
            let reach = along * far;
            next.lines
                .push(((from - reach).as_vec3(), (from + reach).as_vec3()));
        }
    }
    if let Some(from) = begun.filter(of_ghost) {
        next.points.push(from.as_vec3());
    }
    if *aim != next {
        *aim = next;
    }
}

/// The directions of the lines, the newest first, the vertical, and those of the work plane.
fn directions(drawing: &Drawing, plane: &WorkPlane) -> Vec<DVec3> {
    let of_plane = [Vec3::Y, Vec3::X, Vec3::Z].map(|axis| (plane.rotation * axis).as_dvec3());
    let of_lines = drawing.lines().iter().rev().map(|l| l.b - l.a);
    let mut found: Vec<DVec3> = Vec::new();
    for along in [DVec3::Y].into_iter().chain(of_lines).chain(of_plane) {
        let Some(along) = along.try_normalize() else {
            continue;
        };
        if found.len() < DIRECTIONS && !found.iter().any(|d| d.cross(along).length() < 1e-3) {
            found.push(along);
        }
    }
    found
}
