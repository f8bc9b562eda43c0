use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::Rib;

/// Eq. 12, `times` over: each rib but the first and the last is brought nearer to the mean of its
/// neighbours by `alpha` (the paper's is 0.1).
///
/// A Hermite curve is linear in its points and tangents, so averaging those averages the curves.
pub fn smoothed(ribs: &[Rib], alpha: f32, times: usize) -> Arc<[Rib]> {
    let mut now = ribs.to_vec();
    for _ in 0..times {
        let before = now.clone();
        for i in 1..before.len().saturating_sub(1) {
            let mean = before[i - 1].lerp(&before[i + 1], 0.5);
            now[i] = before[i].lerp(&mean, alpha);
        }
    }
    now.into()
}

/// The ribs with the one at `at` replaced by `to`, its neighbours following it the less the
/// further they are, none beyond `reach` ribs.
pub fn bent(ribs: &[Rib], at: usize, to: &Rib, reach: usize) -> Arc<[Rib]> {
    let Some(from) = ribs.get(at).copied() else {
        return ribs.into();
    };
    let turn = to.start * from.start.inverse();
    let bend = |(i, rib): (usize, &Rib)| {
        let far = i.abs_diff(at);
        if far > reach {
            return *rib;
        }
        if far == 0 {
            return *to;
        }
        // A bell that ends level where its reach ends.
        let t = far as f32 / (reach + 1) as f32;
        let w = 0.5 + 0.5 * (std::f32::consts::PI * t).cos();
        let pair = |x: [Vec3; 2], a: [Vec3; 2], b: [Vec3; 2]| {
            [x[0] + (b[0] - a[0]) * w, x[1] + (b[1] - a[1]) * w]
        };
        let slope =
            |k: usize| (rib.slopes[k] + (to.slopes[k] - from.slopes[k]) * w).clamp(0.0, 3.0);
        Rib {
            points: pair(rib.points, from.points, to.points),
            tangents: pair(rib.tangents, from.tangents, to.tangents),
            slopes: [slope(0), slope(1)],
            start: (Quat::IDENTITY.slerp(turn, w) * rib.start).normalize(),
            twist: rib.twist + (to.twist - from.twist) * w,
        }
    };
    ribs.iter().enumerate().map(bend).collect()
}

/// The ribs up to the one at `at` and those from it on: both parts have it. `None` where one of
/// them would be no surface.
pub fn cut(ribs: &[Rib], at: usize) -> Option<(Arc<[Rib]>, Arc<[Rib]>)> {
    let inside = at > 0 && at + 1 < ribs.len();
    inside.then(|| (ribs[..=at].into(), ribs[at..].into()))
}

/// All of them moved by `by`.
pub fn moved(ribs: &[Rib], by: Vec3) -> Arc<[Rib]> {
    ribs.iter().map(|r| r.shifted(by)).collect()
}
