//! Strokes that were meant to be straight.

use glam::DVec3;
use nalgebra::{Matrix3, SymmetricEigen};

use super::StrokeOptions;

/// Whether samples keep to their principal axis (§4.2.2: 8 % off, 10 % longer).
pub(super) fn is_straight(samples: &[DVec3], options: &StrokeOptions) -> bool {
    let count = samples.len() as f64;
    let centre = samples.iter().sum::<DVec3>() / count;
    let mut spread = Matrix3::<f64>::zeros();
    for p in samples {
        let d = nalgebra::Vector3::from((*p - centre).to_array());
        spread += d * d.transpose();
    }
    let eigen = SymmetricEigen::new(spread);
    let axis = eigen.eigenvectors.column(eigen.eigenvalues.imax());
    let axis = DVec3::new(axis[0], axis[1], axis[2]);
    let (mut low, mut high, mut off, mut arc) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64, 0.0);
    for (i, p) in samples.iter().enumerate() {
        let along = (*p - centre).dot(axis);
        (low, high) = (low.min(along), high.max(along));
        off = off.max((*p - centre - axis * along).length());
        if i > 0 {
            arc += p.distance(samples[i - 1]);
        }
    }
    let length = high - low;
    off < options.straight_distance * length && arc <= length * (1.0 + options.straight_length)
}

/// Metres from a point to the nearest point of a polyline.
pub(super) fn to_polyline(p: DVec3, points: &[DVec3]) -> f64 {
    let to_piece = |pair: &[DVec3]| {
        let along = pair[1] - pair[0];
        let t = ((p - pair[0]).dot(along) / along.length_squared().max(1e-300)).clamp(0.0, 1.0);
        (pair[0] + along * t).distance_squared(p)
    };
    points
        .windows(2)
        .map(to_piece)
        .fold(f64::INFINITY, f64::min)
        .sqrt()
}
