//! Where a thing comes to rest that is moved near to something it snaps to. Pure: the same for every
//! way in.

use bevy::math::{EulerRot, Quat, Vec3};
use midair_field::Placement;

use crate::plane::WorkPlane;
use crate::settings::SnapSettings;

/// A thing counts as moved from here on, in metres: a click moves nothing.
const MOVED: f32 = 1e-4;
/// And as turned, in radians.
const TURNED: f32 = 0.01;

/// What pulls.
#[derive(Clone, Copy, Debug)]
pub struct Pull<'a> {
    /// Which snaps are on.
    pub settings: &'a SnapSettings,
    /// Whose lines it snaps to.
    pub plane: &'a WorkPlane,
    /// How far above or below a surface is felt, in metres of world.
    pub reach: f32,
}

/// Where it comes to rest, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snapped {
    /// Where it comes to rest.
    pub placement: Placement,
    /// The middle of its underside, where that lies on lines of the grid.
    pub grid: Option<Vec3>,
    /// Its turn about the vertical, its tilt and its roll in degrees, where they were pulled.
    pub angle: Option<Vec3>,
    /// Where its underside rests on something.
    pub surface: Option<Vec3>,
}

/// Where a thing that stood at `before` comes to rest when a hand would have it at `wanted`. `low` and
/// `high` are its box in its own frame, `feet` its lowest points where it stands; `floor` says how high the highest surface is at a point,
/// between so many metres above and below it.
///
/// The turn comes first, then the grid, then the surface, which has the last word on the height. What was
/// not moved is not pulled, nor is what was not turned.
pub fn snap(
    pull: &Pull,
    before: &Placement,
    wanted: Placement,
    (low, high): (Vec3, Vec3),
    feet: impl Fn(&Placement) -> Vec<Vec3>,
    floor: impl Fn(Vec3, f32) -> Option<f32>,
) -> Snapped {
    let mut snapped = Snapped {
        placement: wanted,
        grid: None,
        angle: None,
        surface: None,
    };
    let settings = pull.settings;
    if settings.angle.on && wanted.rotation.angle_between(before.rotation) > TURNED {
        snapped.turn(settings.angle.step);
    }
    let moved = wanted.translation.distance(before.translation) > MOVED;
    if !moved || !low.cmple(high).all() {
        return snapped;
    }
    if settings.grid.on {
        snapped.onto_grid(pull.plane, settings.grid.step, (low, high));
    }
    if settings.surface.on {
        let feet = feet(&snapped.placement);
        snapped.onto_surface(pull.reach, &feet, floor);
    }
    snapped
}

impl Snapped {
    fn turn(&mut self, step: f32) {
        if !(step.is_finite() && step > 0.0) {
            return;
        }
        let (yaw, pitch, roll) = self.placement.rotation.to_euler(EulerRot::YXZ);
        let [yaw, pitch, roll] = [yaw, pitch, roll].map(|a| nearest(a.to_degrees(), step));
        self.placement.rotation = Quat::from_euler(
            EulerRot::YXZ,
            yaw.to_radians(),
            pitch.to_radians(),
            roll.to_radians(),
        )
        .normalize();
        self.angle = Some(Vec3::new(yaw, pitch, roll));
    }

    /// The middle of the side that faces the plane comes onto its lines.
    fn onto_grid(&mut self, plane: &WorkPlane, step: f32, bounds: (Vec3, Vec3)) {
        if !(step.is_finite() && step > 0.0) {
            return;
        }
        let beneath = plane.to_local(self.placement.translation);
        let lowest = corners(&self.placement, bounds)
            .map(|c| plane.to_local(c).y)
            .fold(f32::INFINITY, f32::min);
        let foot = beneath.with_y(lowest);
        let on_lines = Vec3::from(foot.to_array().map(|v| nearest(v, step)));
        self.placement.translation += plane.rotation * (on_lines - foot);
        self.grid = Some(plane.to_world(on_lines));
    }

    /// It is lifted or lowered until one of its feet stands; `feet` are the lowest points of what is moved,
    /// apart from each other.
    fn onto_surface(
        &mut self,
        reach: f32,
        feet: &[Vec3],
        floor: impl Fn(Vec3, f32) -> Option<f32>,
    ) {
        let stands = feet
            .iter()
            .filter_map(|&foot| floor(foot, reach).map(|y| (foot.with_y(y), y - foot.y)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((at, lift)) = stands.filter(|(_, lift)| lift.abs() <= reach) {
            self.placement.translation.y += lift;
            self.surface = Some(at);
        }
    }
}

/// How many cells the underside is divided into along each side, to find its feet.
const CELLS: usize = 5;

/// The lowest points of a surface that stands at `placement`, one for each part of what lies below it:
/// its feet. `points` are in its own frame.
pub fn feet(placement: &Placement, points: &[Vec3]) -> Vec<Vec3> {
    let affine = placement.affine();
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for &p in points {
        let at = affine.transform_point3(p);
        (low, high) = (low.min(at), high.max(at));
    }
    let across = (high - low).max(Vec3::splat(1e-6));
    let mut lowest = [None::<Vec3>; CELLS * CELLS];
    for &p in points {
        let at = affine.transform_point3(p);
        let cell = |v: f32, low: f32, across: f32| {
            ((v - low) / across * CELLS as f32).clamp(0.0, CELLS as f32 - 1.0) as usize
        };
        let cell = cell(at.x, low.x, across.x) * CELLS + cell(at.z, low.z, across.z);
        if lowest[cell].is_none_or(|l| at.y < l.y) {
            lowest[cell] = Some(at);
        }
    }
    lowest.into_iter().flatten().collect()
}

/// The feet of what only its box is known of: under its middle and a little within its corners, since
/// it may stand on an edge.
pub fn box_feet(placement: &Placement, bounds: (Vec3, Vec3)) -> Vec<Vec3> {
    let (low, high) = box_of(placement, bounds);
    let middle = low.midpoint(high);
    let inset = 0.4 * (high - low);
    let feet = [
        (0.0, 0.0),
        (-1.0, -1.0),
        (1.0, -1.0),
        (-1.0, 1.0),
        (1.0, 1.0),
    ];
    feet.map(|(x, z)| Vec3::new(middle.x + x * inset.x, low.y, middle.z + z * inset.z))
        .into()
}

fn nearest(value: f32, step: f32) -> f32 {
    (value / step).round() * step
}

fn corners(placement: &Placement, (low, high): (Vec3, Vec3)) -> impl Iterator<Item = Vec3> {
    let affine = placement.affine();
    (0..8).map(move |i| {
        let pick = |bit: u32, a: f32, b: f32| if i & bit == 0 { a } else { b };
        affine.transform_point3(Vec3::new(
            pick(1, low.x, high.x),
            pick(2, low.y, high.y),
            pick(4, low.z, high.z),
        ))
    })
}

/// The box in the world of what has the box `bounds` in its own frame.
pub fn box_of(placement: &Placement, bounds: (Vec3, Vec3)) -> (Vec3, Vec3) {
    corners(placement, bounds).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), c| {
        (low.min(c), high.max(c))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{AngleSnap, GridSnap, SurfaceSnap};

    const CUBE: (Vec3, Vec3) = (Vec3::splat(-0.07), Vec3::splat(0.07));

    fn none(_: &Placement) -> Vec<Vec3> {
        Vec::new()
    }

    fn all_on() -> SnapSettings {
        SnapSettings {
            grid: GridSnap {
                on: true,
                step: 0.1,
            },
            angle: AngleSnap {
                on: true,
                step: 15.0,
            },
            surface: SurfaceSnap { on: true },
        }
    }

    fn snapped(settings: &SnapSettings, wanted: Placement, floor: Option<f32>) -> Snapped {
        let pull = Pull {
            settings,
            plane: &WorkPlane::default(),
            reach: 0.05,
        };
        let feet = |p: &Placement| box_feet(p, CUBE);
        snap(&pull, &Placement::IDENTITY, wanted, CUBE, feet, |_, _| {
            floor
        })
    }

    #[test]
    fn with_everything_off_nothing_changes() {
        let wanted = Placement {
            rotation: Quat::from_rotation_y(0.3),
            ..Placement::at(Vec3::new(0.123, 0.05, 0.456))
        };
        let found = snapped(&SnapSettings::default(), wanted, Some(0.0));
        assert_eq!(found.placement, wanted);
        assert_eq!((found.grid, found.angle, found.surface), (None, None, None));
    }

    #[test]
    fn the_grid_takes_the_foot_onto_its_lines() {
        let mut settings = all_on();
        settings.surface.on = false;
        let found = snapped(&settings, Placement::at(Vec3::new(0.33, 0.29, -0.06)), None);
        // The underside, not the middle, lies on a line: 0.22 goes to 0.2.
        let at = found.placement.translation;
        assert!(at.distance(Vec3::new(0.3, 0.27, -0.1)) < 1e-5, "{at}");
    }

    #[test]
    fn the_grid_is_that_of_the_plane() {
        let mut settings = all_on();
        settings.surface.on = false;
        let plane = WorkPlane {
            origin: Vec3::new(0.0, 0.0, 0.04),
            rotation: Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
            ..WorkPlane::default()
        };
        let pull = Pull {
            settings: &settings,
            plane: &plane,
            reach: 0.05,
        };
        let wanted = Placement::at(Vec3::new(0.33, 0.28, 0.13));
        let found = snap(&pull, &Placement::IDENTITY, wanted, CUBE, none, |_, _| None);
        let at = found.placement.translation;
        assert!(at.distance(Vec3::new(0.3, 0.3, 0.11)) < 1e-5, "{at}");
    }

    #[test]
    fn an_angle_is_pulled_only_where_it_was_turned() {
        let settings = all_on();
        let slanted = Quat::from_rotation_y(0.3);
        let before = Placement {
            rotation: slanted,
            ..Placement::IDENTITY
        };
        let pull = Pull {
            settings: &settings,
            plane: &WorkPlane::default(),
            reach: 0.05,
        };
        let wanted = Placement {
            translation: Vec3::X,
            ..before
        };
        let found = snap(&pull, &before, wanted, CUBE, none, |_, _| None);
        assert_eq!(found.placement.rotation, slanted);
        let wanted = Placement {
            rotation: Quat::from_euler(EulerRot::YXZ, 0.8, 0.05, 0.0),
            ..before
        };
        let found = snap(&pull, &before, wanted, CUBE, none, |_, _| None);
        let right = Quat::from_rotation_y(45_f32.to_radians());
        assert!(found.placement.rotation.angle_between(right) < 1e-3);
    }

    #[test]
    fn the_underside_comes_onto_a_surface_within_reach() {
        let settings = SnapSettings {
            surface: SurfaceSnap { on: true },
            ..SnapSettings::default()
        };
        let found = snapped(
            &settings,
            Placement::at(Vec3::new(0.2, 0.53, 0.0)),
            Some(0.45),
        );
        assert!((found.placement.translation.y - 0.52).abs() < 1e-5);
        assert!(found.surface.is_some());
        let high = Placement::at(Vec3::new(0.2, 0.6, 0.0));
        assert_eq!(snapped(&settings, high, Some(0.45)).placement, high);
        assert_eq!(snapped(&settings, high, None).placement, high);
    }

    #[test]
    fn what_is_round_comes_to_rest_on_what_it_really_touches() {
        let settings = SnapSettings {
            surface: SurfaceSnap { on: true },
            ..SnapSettings::default()
        };
        let pull = Pull {
            settings: &settings,
            plane: &WorkPlane::default(),
            reach: 0.05,
        };
        // A ball beside a step: its box would come to rest on the step, which the ball does not touch.
        let ball: Vec<Vec3> = (0..4000)
            .map(|i| {
                let y = 1.0 - 2.0 * (i as f32 + 0.5) / 4000.0;
                let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
                let r = (1.0 - y * y).sqrt();
                0.1 * Vec3::new(r * cos, y, r * sin)
            })
            .collect();
        let step = |foot: Vec3, reach: f32| {
            let heights = if foot.x > 0.07 {
                vec![0.0, 0.02]
            } else {
                vec![0.0]
            };
            heights
                .into_iter()
                .filter(|h| (foot.y - h).abs() <= reach)
                .reduce(f32::max)
        };
        let bounds = (Vec3::splat(-0.1), Vec3::splat(0.1));
        let wanted = Placement::at(Vec3::new(0.0, 0.12, 0.0));
        let found = snap(
            &pull,
            &Placement::IDENTITY,
            wanted,
            bounds,
            |p| feet(p, &ball),
            step,
        );
        let y = found.placement.translation.y;
        assert!((y - 0.1).abs() < 1e-3, "on the ground beside the step: {y}");
        assert!(found.surface.is_some_and(|at| at.y == 0.0));
        let boxed = snap(
            &pull,
            &Placement::IDENTITY,
            wanted,
            bounds,
            |p| box_feet(p, bounds),
            step,
        );
        assert!(boxed.placement.translation.y > 0.115, "its box would float");
    }

    #[test]
    fn a_click_moves_nothing_and_senseless_steps_pull_nothing() {
        let mut settings = all_on();
        let pull = Pull {
            settings: &settings.clone(),
            plane: &WorkPlane::default(),
            reach: 0.05,
        };
        let before = Placement::at(Vec3::splat(0.123));
        let found = snap(&pull, &before, before, CUBE, none, |_, _| Some(0.04));
        assert_eq!(found.placement, before);
        for step in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            settings.grid.step = step;
            settings.angle.step = step;
            let wanted = Placement::at(Vec3::new(0.33, 0.29, -0.06));
            assert_eq!(snapped(&settings, wanted, None).placement, wanted, "{step}");
        }
    }
}
