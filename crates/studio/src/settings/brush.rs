use serde::{Deserialize, Serialize};

/// What a stroke of Brush is convolved from (3DBrushVR §3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum BrushSkeleton {
    /// A point, or the way it is led.
    #[default]
    Point,
    /// A line between two points.
    Line,
    /// A flat area with four corners or more.
    Polygon,
    /// A solid.
    Volume,
}

impl BrushSkeleton {
    /// All, in the order in which the cross goes through them.
    pub const ALL: [Self; 4] = [Self::Point, Self::Line, Self::Polygon, Self::Volume];

    /// The one after it, or before it.
    #[must_use]
    pub fn step(self, ahead: bool) -> Self {
        let n = Self::ALL.len();
        let by = if ahead { 1 } else { n - 1 };
        Self::ALL[(self as usize + by) % n]
    }

    /// What people read.
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "Point",
            Self::Line => "Line",
            Self::Polygon => "Polygon",
            Self::Volume => "Volume",
        }
    }
}

/// What is set on the panel of Brush.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BrushSettings {
    /// What the next stroke is convolved from.
    pub skeleton: BrushSkeleton,
    /// How far the surface of points, lines and polygons lies from them, metres in the hand.
    pub radius: f32,
    /// The longest side of a volume brush, metres in the hand.
    pub size: f32,
    /// The weight of a stroke, λ in 3DBrushVR Eq. 3.
    pub strength: f32,
    /// Whether strokes take away; alt does the other thing.
    pub erase: bool,
    /// The exponent with which a new painting blends: 1 melts, 16 unites.
    pub blend: f32,
    /// The support over the radius of a new painting: how far strokes feel each other.
    pub reach: f32,
    /// The volume brush, by its id in the library.
    pub volume: String,
    /// What a new painting is made of, by its id; nothing for what is usual.
    pub material: String,
}

impl Default for BrushSettings {
    fn default() -> Self {
        Self {
            skeleton: BrushSkeleton::default(),
            radius: 0.03,
            size: 0.3,
            strength: 1.0,
            erase: false,
            blend: 1.0,
            reach: 1.75,
            volume: "brush/horse".to_owned(),
            material: String::new(),
        }
    }
}

impl BrushSettings {
    /// Radii that can be set, metres in the hand.
    pub const RADII: (f32, f32) = (0.001, 0.5);
    /// Sizes of a volume brush, metres in the hand.
    pub const SIZES: (f32, f32) = (0.01, 3.0);

    /// The size of the brush times `factor`.
    pub fn resize(&mut self, factor: f32) {
        let (slot, (least, most)) = match self.skeleton {
            BrushSkeleton::Volume => (&mut self.size, Self::SIZES),
            _ => (&mut self.radius, Self::RADII),
        };
        *slot = (*slot * factor).clamp(least, most);
    }

    /// As it can be painted with, whatever was set.
    #[must_use]
    pub fn sound(&self) -> Self {
        let within = |x: f32, (least, most): (f32, f32), usual: f32| {
            if x.is_finite() {
                x.clamp(least, most)
            } else {
                usual
            }
        };
        let usual = Self::default();
        Self {
            radius: within(self.radius, Self::RADII, usual.radius),
            size: within(self.size, Self::SIZES, usual.size),
            strength: within(self.strength, (0.05, 20.0), 1.0),
            blend: within(self.blend, (1.0, 16.0), 1.0),
            reach: within(self.reach, (1.05, 4.0), usual.reach),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cross_goes_through_all_skeletons_and_back() {
        let mut at = BrushSkeleton::Point;
        for _ in 0..4 {
            at = at.step(true);
            assert_eq!(at.step(false).step(true), at);
        }
        assert_eq!(at, BrushSkeleton::Point);
    }

    #[test]
    fn a_size_stays_within_bounds_and_is_that_of_the_skeleton_at_hand() {
        let mut brush = BrushSettings::default();
        brush.resize(1e6);
        assert_eq!(brush.radius, BrushSettings::RADII.1);
        assert_eq!(brush.size, BrushSettings::default().size);
        brush.skeleton = BrushSkeleton::Volume;
        brush.resize(0.5);
        assert!((brush.size - 0.15).abs() < 1e-6);
        brush.radius = f32::NAN;
        assert!(brush.sound().radius > 0.0);
    }
}
