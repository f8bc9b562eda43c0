use glam::Vec3;
use std::collections::{HashMap, HashSet};

/// How far a vertex may step aside, in units in the last place. Beyond it vertices stay together:
/// so many in one place are no longer a shape.
const REACH: u32 = 64;

/// `p` as bits, with -0 and 0 the same.
pub(crate) fn bits(p: Vec3) -> [u32; 3] {
    p.to_array().map(|x| (x + 0.0).to_bits())
}

/// `positions` times `factor`, rounded to f32, such that positions that were distinct stay
/// distinct: where rounding makes two of them one, the later steps aside by the smallest amount
/// that f32 knows. Without this, tiny triangles would collapse and open a closed mesh.
///
/// Returns `None` where a coordinate leaves the range of f32.
pub(crate) fn rescaled(positions: &[Vec3], factor: f64) -> Option<Vec<Vec3>> {
    if factor == 1.0 {
        return Some(positions.to_vec());
    }
    let mut scaled: Vec<Vec3> = positions
        .iter()
        .map(|p| (p.as_dvec3() * factor).as_vec3())
        .collect();
    if !scaled.iter().all(|p| p.is_finite()) {
        return None;
    }
    let mut first = HashMap::with_capacity(scaled.len());
    let mut late = Vec::new();
    for (i, &p) in scaled.iter().enumerate() {
        let owner = *first.entry(bits(p)).or_insert(i);
        if bits(positions[owner]) != bits(positions[i]) {
            late.push(i);
        }
    }
    if late.is_empty() {
        return Some(scaled);
    }
    let mut taken: HashSet<[u32; 3]> = first.into_keys().collect();
    let mut moved = HashMap::new();
    for i in late {
        let place = *moved
            .entry(bits(positions[i]))
            .or_insert_with(|| aside(scaled[i], &taken).unwrap_or(scaled[i]));
        taken.insert(bits(place));
        scaled[i] = place;
    }
    Some(scaled)
}

/// The nearest free place beside `p`, along its largest coordinates first: there the rounding was.
fn aside(p: Vec3, taken: &HashSet<[u32; 3]>) -> Option<Vec3> {
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a: &usize, &b: &usize| p[b].abs().total_cmp(&p[a].abs()));
    let (mut up, mut down) = (p, p);
    for _ in 0..REACH {
        up = Vec3::from_array(up.to_array().map(f32::next_up));
        down = Vec3::from_array(down.to_array().map(f32::next_down));
        for axis in axes {
            for from in [up, down] {
                let mut place = p;
                place[axis] = from[axis];
                if place.is_finite() && !taken.contains(&bits(place)) {
                    return Some(place);
                }
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_in_f32_stay_distinct_in_millimetres() {
        // Between 1.024 and 2 metres the steps of f32 are finer than those at a thousand times it.
        let mut x = 1.03_f32;
        let positions: Vec<Vec3> = (0..1000)
            .map(|_| {
                x = x.next_up();
                Vec3::new(x, 1.03, 1.03)
            })
            .collect();
        let distinct = |p: &[Vec3]| p.iter().map(|&p| bits(p)).collect::<HashSet<_>>().len();
        let scaled = rescaled(&positions, 1000.0).unwrap();
        assert_eq!(distinct(&scaled), 1000);
        assert_eq!(distinct(&rescaled(&scaled, 0.001).unwrap()), 1000);
        let farthest = positions
            .iter()
            .zip(&scaled)
            .map(|(p, q)| (p.x * 1000.0 - q.x).abs())
            .fold(0.0, f32::max);
        assert!(farthest < 0.001, "{farthest} mm");
    }

    #[test]
    fn one_place_stays_one_place() {
        let a = Vec3::new(1.03, 1.0, 1.0);
        let b = Vec3::new(1.03_f32.next_up(), 1.0, 1.0);
        let many = [a, b, a, b, b, a];
        let scaled = rescaled(&many, 1000.0).unwrap();
        assert_eq!(scaled[0], scaled[2]);
        assert_eq!(scaled[1], scaled[3]);
        assert_eq!(scaled[1], scaled[4]);
        assert_ne!(scaled[0], scaled[1]);
    }

    #[test]
    fn what_leaves_f32_is_refused() {
        assert!(rescaled(&[Vec3::splat(1e36)], 1000.0).is_none());
    }
}
