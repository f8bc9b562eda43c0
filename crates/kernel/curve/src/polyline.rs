use glam::DVec3;

/// Points joined by straight lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyline {
    points: Vec<DVec3>,
    /// Metres from the first point to each.
    along: Vec<f64>,
}

impl Polyline {
    /// The line through `points`. Those that are not finite are left out.
    pub fn new(points: impl IntoIterator<Item = DVec3>) -> Self {
        let points: Vec<DVec3> = points.into_iter().filter(|p| p.is_finite()).collect();
        let mut along = Vec::with_capacity(points.len());
        let mut length = 0.0;
        for (i, p) in points.iter().enumerate() {
            if i > 0 {
                length += p.distance(points[i - 1]);
            }
            along.push(length);
        }
        Self { points, along }
    }

    /// Its points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Metres from one end to the other along it.
    pub fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    /// The point `distance` metres from its start; the ends beyond them. `None` where it has none.
    pub fn at(&self, distance: f64) -> Option<DVec3> {
        let after = self.along.partition_point(|&s| s < distance);
        if after == 0 {
            return self.points.first().copied();
        }
        let Some(&end) = self.points.get(after) else {
            return self.points.last().copied();
        };
        let (from, to) = (self.along[after - 1], self.along[after]);
        let t = if to > from {
            (distance - from) / (to - from)
        } else {
            0.0
        };
        Some(self.points[after - 1].lerp(end, t))
    }

    /// Metres from its start to the place on it that is nearest to a point.
    pub fn nearest(&self, to: DVec3) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        for (i, pair) in self.points.windows(2).enumerate() {
            let along = pair[1] - pair[0];
            let t = (to - pair[0]).dot(along) / along.length_squared().max(1e-18);
            let t = t.clamp(0.0, 1.0);
            let far = (pair[0] + along * t).distance_squared(to);
            if far < best.0 {
                best = (far, self.along[i] + t * (self.along[i + 1] - self.along[i]));
            }
        }
        best.1
    }

    /// `count` points, at least two, evenly by arc length and with both ends among them. Empty
    /// where it has no point.
    pub fn resampled(&self, count: usize) -> Vec<DVec3> {
        let count = count.max(2);
        let step = self.length() / (count - 1) as f64;
        (0..count)
            .filter_map(|i| self.at(step * i as f64))
            .collect()
    }

    /// Points at most `spacing` metres apart along it, evenly and with both ends among them, at
    /// most 100,000 of them.
    pub fn spaced(&self, spacing: f64) -> Vec<DVec3> {
        let pieces = (self.length() / spacing.max(f64::MIN_POSITIVE)).ceil();
        self.resampled(pieces.clamp(1.0, 99_999.0) as usize + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_even_and_end_where_it_ends() {
        let line = Polyline::new([
            DVec3::ZERO,
            DVec3::X * 0.3,
            DVec3::X,
            DVec3::new(1.0, 2.0, 0.0),
        ]);
        let points = line.resampled(7);
        assert_eq!(points[0], DVec3::ZERO);
        assert!(points[6].distance(DVec3::new(1.0, 2.0, 0.0)) < 1e-12);
        for pair in Polyline::new(points).along.windows(2) {
            assert!((pair[1] - pair[0] - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn the_nearest_place_is_found_along_it() {
        let line = Polyline::new([DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y]);
        assert!((line.nearest(DVec3::new(0.4, 0.3, 0.2)) - 0.4).abs() < 1e-12);
        assert!((line.nearest(DVec3::new(1.5, 0.7, 0.0)) - 1.7).abs() < 1e-12);
        assert_eq!(line.nearest(DVec3::splat(-1.0)), 0.0);
        assert_eq!(Polyline::new([DVec3::ONE]).nearest(DVec3::X), 0.0);
    }

    #[test]
    fn one_point_and_none_are_lines_too() {
        assert!(Polyline::new([]).resampled(4).is_empty());
        assert_eq!(Polyline::new([DVec3::ONE]).spaced(0.01), [DVec3::ONE; 2]);
        assert_eq!(Polyline::new([DVec3::NAN, DVec3::ONE]).points().len(), 1);
    }
}
