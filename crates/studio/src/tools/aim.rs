//! How ways in without a depth of their own place a hand.

use bevy::prelude::*;

/// What the active tool wishes of a mouse or a gamepad, which have to find a depth for the leading
/// hand. A headset knows where its hands are and reads none of it.
///
/// The depth is the first of these that is met: one of [`points`](Self::points) or
/// [`lines`](Self::lines) near the pointer, a surface, the work plane while it is shown, else the
/// plane of the view through the last point. The tool writes it in
/// [`StudioSet::Cue`](crate::StudioSet::Cue); it is back to its default when another tool is taken.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Aim {
    /// The button that acts draws: with it a mouse takes nothing in hand and draws no box that selects.
    pub draws: bool,
    /// Whether surfaces stop the hand.
    pub surfaces: bool,
    /// Whether lines and strokes, as they are seen, stop a hand that draws nothing at the moment.
    pub drawn: bool,
    /// The hand is held level, or as the surface under it lies, and not as the eye looks.
    pub level: bool,
    /// Both hands are led at once: a gamepad's other stick moves the hand that does not lead.
    pub both: bool,
    /// The other hand's trigger turns around what this one's does: where one button is for the other's, it is both.
    pub alt_acts: bool,
    /// Points that catch the hand, in world metres.
    pub points: Vec<Vec3>,
    /// Segments that catch it, after the points.
    pub lines: Vec<(Vec3, Vec3)>,
}

impl Default for Aim {
    fn default() -> Self {
        Self {
            draws: false,
            surfaces: true,
            drawn: true,
            level: false,
            both: false,
            alt_acts: false,
            points: Vec::new(),
            lines: Vec::new(),
        }
    }
}

/// Pixels within which a point or a line catches the pointer.
pub const CATCH: f32 = 10.0;

impl Aim {
    /// How a hand is held that was turned by `turn` against the eye: as the eye looks, or level on
    /// what has the normal `up`.
    pub fn turned(&self, eye: Quat, up: Vec3, turn: Quat) -> Quat {
        if self.level {
            let up = Quat::from_rotation_arc(Vec3::Y, up.normalize_or(Vec3::Y));
            (eye * turn * eye.inverse() * up).normalize()
        } else {
            (eye * turn).normalize()
        }
    }

    /// The target that catches what is seen at `at`, if any: the nearest point, or else the nearest
    /// place on a line. `seen` gives where a point of the world stands on the screen, in pixels.
    pub fn caught(&self, at: Vec2, seen: impl Fn(Vec3) -> Option<Vec2>) -> Option<Vec3> {
        let near = |found: Option<(f32, Vec3)>| found.filter(|&(far, _)| far <= CATCH);
        let nearest = |a: Option<(f32, Vec3)>, b: (f32, Vec3)| match a {
            Some(a) if a.0 <= b.0 => Some(a),
            _ => Some(b),
        };
        let points = self
            .points
            .iter()
            .filter_map(|&p| Some((seen(p)?.distance(at), p)));
        let point = near(points.fold(None, nearest));
        let lines = || {
            let on = self.lines.iter().filter_map(|&(a, b)| {
                let (from, to) = (seen(a)?, seen(b)?);
                let along = to - from;
                let t = (at - from).dot(along) / along.length_squared().max(1e-6);
                let t = t.clamp(0.0, 1.0);
                Some(((from + t * along).distance(at), (a, b, t)))
            });
            let (_, (a, b, t)) = on
                .filter(|(far, _)| *far <= CATCH)
                .min_by(|a, b| a.0.total_cmp(&b.0))?;
            // Perspective bends the way along the line: halving finds what is seen there.
            let (from, to) = (seen(a)?, seen(b)?);
            let along = to - from;
            let wanted = t * along.length_squared();
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..24 {
                let middle = 0.5 * (low + high);
                if (seen(a.lerp(b, middle))? - from).dot(along) < wanted {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            Some(a.lerp(b, 0.5 * (low + high)))
        };
        point.map(|(_, p)| p).or_else(lines)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_catch_before_lines_and_only_from_near() {
        let aim = Aim {
            points: vec![Vec3::new(5.0, 0.0, 0.0)],
            lines: vec![(Vec3::ZERO, Vec3::new(100.0, 0.0, 0.0))],
            ..default()
        };
        let seen = |p: Vec3| Some(p.truncate());
        let caught = |x: f32, y: f32| aim.caught(Vec2::new(x, y), seen);
        assert_eq!(caught(9.0, 1.0), Some(Vec3::new(5.0, 0.0, 0.0)));
        let on = caught(50.0, 8.0).unwrap();
        assert!(on.distance(Vec3::new(50.0, 0.0, 0.0)) < 1e-3, "{on}");
        assert_eq!(caught(50.0, 11.0), None);
        assert_eq!(Aim::default().caught(Vec2::ZERO, seen), None);
    }
}
