//! Two hands on one object scale it.

use bevy::math::{Vec2, Vec3};
use midair_field::Placement;

use crate::hands::Cross;

/// The ratio of EasyVRModeling §4.3 Eq. 1 stays within these.
pub const RATIO: std::ops::RangeInclusive<f32> = 0.4..=4.0;

/// Along which of the object's own axes two hands scale it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// Along its x.
    X,
    /// Along its y.
    Y,
    /// Along its z.
    Z,
    /// Along all three alike.
    #[default]
    All,
}

impl Axis {
    /// The quadrant of the right pad under `touch`: X above, Y right, Z below, A left
    /// (EasyVRModeling Fig. 4b). `None` near the middle, where no quadrant is meant.
    pub fn of_quadrant(touch: Vec2) -> Option<Self> {
        if touch.length() < 0.2 {
            return None;
        }
        Some(if touch.y.abs() >= touch.x.abs() {
            if touch.y > 0.0 { Self::X } else { Self::Z }
        } else if touch.x > 0.0 {
            Self::Y
        } else {
            Self::All
        })
    }

    /// What the panel writes.
    pub fn letter(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Y => "Y",
            Self::Z => "Z",
            Self::All => "A",
        }
    }

    fn factor(self, ratio: f32) -> Vec3 {
        match self {
            Self::X => Vec3::new(ratio, 1.0, 1.0),
            Self::Y => Vec3::new(1.0, ratio, 1.0),
            Self::Z => Vec3::new(1.0, 1.0, ratio),
            Self::All => Vec3::splat(ratio),
        }
    }
}

/// The quadrants of the pad as arms of the cross.
impl From<Cross> for Axis {
    fn from(arm: Cross) -> Self {
        match arm {
            Cross::Up => Self::X,
            Cross::Right => Self::Y,
            Cross::Down => Self::Z,
            Cross::Left => Self::All,
        }
    }
}

/// Two hands on one object (EasyVRModeling §4.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Where the object stood when the second hand took hold.
    start: Placement,
    middle: Vec3,
    /// Metres between the hands when the present axis was chosen.
    apart: f32,
    /// Factors reached with the axes chosen before.
    reached: Vec3,
    axis: Axis,
}

/// Hands nearer than this (metres) give no ratio worth having.
const LEAST_APART: f32 = 1e-3;

impl Stretch {
    /// Starts with both hands where they are.
    pub fn new(left: Vec3, right: Vec3, placement: &Placement) -> Self {
        Self {
            start: *placement,
            middle: left.midpoint(right),
            apart: left.distance(right).max(LEAST_APART),
            reached: Vec3::ONE,
            axis: Axis::All,
        }
    }

    /// Along which axis the hands scale now.
    pub fn axis(&self) -> Axis {
        self.axis
    }

    /// Chooses another axis; what was reached so far stays.
    pub fn choose(&mut self, axis: Axis, left: Vec3, right: Vec3) {
        if axis != self.axis {
            self.reached = self.factor(left, right);
            self.apart = left.distance(right).max(LEAST_APART);
            self.axis = axis;
        }
    }

    /// The factors along the object's axes, each within [`RATIO`] of where it started.
    pub fn factor(&self, left: Vec3, right: Vec3) -> Vec3 {
        let ratio = left.distance(right) / self.apart;
        (self.reached * self.axis.factor(ratio))
            .clamp(Vec3::splat(*RATIO.start()), Vec3::splat(*RATIO.end()))
    }

    /// Where the object stands with the hands at `left` and `right`: scaled about its own centre,
    /// carried by the midpoint of the hands.
    pub fn placement(&self, left: Vec3, right: Vec3) -> Placement {
        Placement {
            translation: self.start.translation + (left.midpoint(right) - self.middle),
            rotation: self.start.rotation,
            scale: self.start.scale * self.factor(left, right),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ratio_is_that_of_the_hands_and_stays_in_its_range() {
        let (l, r) = (Vec3::new(-0.1, 0.0, 0.0), Vec3::new(0.1, 0.0, 0.0));
        let stretch = Stretch::new(l, r, &Placement::IDENTITY);
        assert!((stretch.factor(l * 2.0, r * 2.0) - Vec3::splat(2.0)).length() < 1e-6);
        assert_eq!(stretch.factor(l * 9.0, r * 9.0), Vec3::splat(4.0));
        assert_eq!(stretch.factor(l * 0.1, r * 0.1), Vec3::splat(0.4));
    }

    #[test]
    fn another_axis_goes_on_from_what_was_reached() {
        let (l, r) = (Vec3::new(-0.1, 0.0, 0.0), Vec3::new(0.1, 0.0, 0.0));
        let mut stretch = Stretch::new(l, r, &Placement::IDENTITY);
        stretch.choose(Axis::X, l, r);
        stretch.choose(Axis::Y, l * 2.0, r * 2.0);
        let reached = stretch.factor(l * 3.0, r * 3.0);
        assert!(
            (reached - Vec3::new(2.0, 1.5, 1.0)).length() < 1e-5,
            "{reached}"
        );
    }

    #[test]
    fn hands_at_one_point_stay_finite() {
        let stretch = Stretch::new(Vec3::ZERO, Vec3::ZERO, &Placement::IDENTITY);
        assert!(stretch.placement(Vec3::ZERO, Vec3::X).is_sound());
        assert!(stretch.placement(Vec3::ZERO, Vec3::ZERO).is_sound());
    }

    #[test]
    fn quadrants() {
        assert_eq!(Axis::of_quadrant(Vec2::new(0.0, 0.9)), Some(Axis::X));
        assert_eq!(Axis::of_quadrant(Vec2::new(0.9, 0.1)), Some(Axis::Y));
        assert_eq!(Axis::of_quadrant(Vec2::new(0.1, -0.9)), Some(Axis::Z));
        assert_eq!(Axis::of_quadrant(Vec2::new(-0.9, 0.1)), Some(Axis::All));
        assert_eq!(Axis::of_quadrant(Vec2::ZERO), None);
    }
}
