//! A curve as a round tube: how strokes are drawn and printed.

use glam::DVec3;
use midair_mesh::TriMesh;

/// Points nearer to each other than this, in metres, are one.
const SAME: f64 = 1e-7;

/// A closed tube of `radius` metres around `points`, `sides` flat sides around it; round at its ends,
/// joined to itself where it is `closed`. Empty around less than two different points.
///
/// It follows its curve without a twist. Where the curve bends tighter than the radius it passes through
/// itself.
pub fn tube(points: &[DVec3], radius: f64, closed: bool, sides: usize) -> TriMesh {
    let sides = sides.max(3);
    let mut line: Vec<DVec3> = Vec::with_capacity(points.len());
    for &p in points.iter().filter(|p| p.is_finite()) {
        if line.last().is_none_or(|q| q.distance(p) > SAME) {
            line.push(p);
        }
    }
    let meets = |l: &[DVec3]| l.len() > 2 && l[0].distance(l[l.len() - 1]) <= SAME;
    if closed && meets(&line) {
        line.pop();
    }
    let closed = closed && line.len() > 2;
    if line.len() < 2 || radius.is_nan() || radius <= 0.0 {
        return TriMesh::default();
    }
    let tangents = tangents(&line, closed);
    let normals = frames(&line, &tangents, closed);
    let mut mesh = TriMesh::default();
    let mut ring = |centre: DVec3, around: f64, lean: f64, t: DVec3, n: DVec3| {
        let side = t.cross(n);
        for k in 0..sides {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
            let out = n * cos + side * sin;
            mesh.positions.push((centre + out * around).as_vec3());
            let normal = out * (1.0 - lean * lean).max(0.0).sqrt() + t * lean;
            mesh.normals.push(normal.as_vec3());
        }
    };
    let last = line.len() - 1;
    let half = std::f64::consts::FRAC_1_SQRT_2;
    if !closed {
        ring(
            line[0] - tangents[0] * (radius * half),
            radius * half,
            -half,
            tangents[0],
            normals[0],
        );
    }
    for i in 0..line.len() {
        ring(line[i], radius, 0.0, tangents[i], normals[i]);
    }
    if !closed {
        let (t, n) = (tangents[last], normals[last]);
        ring(line[last] + t * (radius * half), radius * half, half, t, n);
    }
    let rings = mesh.positions.len() / sides;
    let at = |r: usize, k: usize| (r % rings * sides + k % sides) as u32;
    for r in 0..if closed { rings } else { rings - 1 } {
        for k in 0..sides {
            let [a, b, c, d] = [at(r, k), at(r, k + 1), at(r + 1, k), at(r + 1, k + 1)];
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    if !closed {
        for (tip, r, out) in [
            (line[0] - tangents[0] * radius, 0, -tangents[0]),
            (
                line[last] + tangents[last] * radius,
                rings - 1,
                tangents[last],
            ),
        ] {
            let apex = mesh.positions.len() as u32;
            mesh.positions.push(tip.as_vec3());
            mesh.normals.push(out.as_vec3());
            for k in 0..sides {
                let (a, b) = (at(r, k), at(r, k + 1));
                mesh.triangles
                    .push(if r == 0 { [apex, b, a] } else { [apex, a, b] });
            }
        }
    }
    mesh
}

/// Unit directions: along the mean of the pieces before and after.
fn tangents(line: &[DVec3], closed: bool) -> Vec<DVec3> {
    let n = line.len();
    let piece = |i: usize, j: usize| (line[j] - line[i]).normalize_or_zero();
    (0..n)
        .map(|i| {
            let before = match i {
                0 if closed => piece(n - 1, 0),
                0 => piece(0, 1),
                _ => piece(i - 1, i),
            };
            let after = match i {
                _ if i + 1 < n => piece(i, i + 1),
                _ if closed => piece(n - 1, 0),
                _ => before,
            };
            (before + after).try_normalize().unwrap_or(after)
        })
        .collect()
}

/// A unit normal in each point that turns about the tangent as little as can be (double reflection), and
/// where the line is closed comes back to itself.
fn frames(line: &[DVec3], tangents: &[DVec3], closed: bool) -> Vec<DVec3> {
    let next = |from: usize, to: usize, normal: DVec3| {
        let step = line[to] - line[from];
        let c = step.length_squared().max(1e-300);
        let reflected = normal - step * (2.0 / c * step.dot(normal));
        let tangent = tangents[from] - step * (2.0 / c * step.dot(tangents[from]));
        let lean = tangents[to] - tangent;
        let c = lean.length_squared().max(1e-300);
        let turned = reflected - lean * (2.0 / c * lean.dot(reflected));
        (turned - tangents[to] * tangents[to].dot(turned))
            .try_normalize()
            .unwrap_or_else(|| tangents[to].any_orthonormal_vector())
    };
    let mut normals = vec![tangents[0].any_orthonormal_vector()];
    for i in 1..line.len() {
        normals.push(next(i - 1, i, normals[i - 1]));
    }
    if closed {
        let n = line.len();
        let back = next(n - 1, 0, normals[n - 1]);
        let (first, t) = (normals[0], tangents[0]);
        let twist = f64::atan2(t.dot(back.cross(first)), back.dot(first));
        for (i, normal) in normals.iter_mut().enumerate() {
            let by = twist * i as f64 / n as f64;
            *normal = glam::DQuat::from_axis_angle(tangents[i], by) * *normal;
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use midair_mesh::check;

    use super::*;

    #[test]
    fn an_open_tube_is_closed_at_its_ends_and_as_thick_as_it_is_to_be() {
        let points: Vec<DVec3> = (0..40)
            .map(|i| {
                let t = 0.1 * f64::from(i);
                DVec3::new(0.2 * t.cos(), 0.05 * t, 0.2 * t.sin())
            })
            .collect();
        let mesh = tube(&points, 0.01, false, 12);
        let report = check(&mesh);
        assert!(report.is_faultless(), "{:?}", report.faults());
        let length: f64 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
        let around = 6.0 * (std::f64::consts::TAU / 12.0).sin() * 1e-4;
        assert!(
            (mesh.volume() / (length * around) - 1.0).abs() < 0.06,
            "{}",
            mesh.volume()
        );
    }

    #[test]
    fn a_closed_one_joins_itself_without_a_twist() {
        let points: Vec<DVec3> = (0..=48)
            .map(|i| {
                let t = std::f64::consts::TAU * f64::from(i) / 48.0;
                DVec3::new(0.2 * t.cos(), 0.03 * (2.0 * t).sin(), 0.2 * t.sin())
            })
            .collect();
        let mesh = tube(&points, 0.01, true, 8);
        assert!(check(&mesh).is_faultless(), "{:?}", check(&mesh).faults());
        assert_eq!(mesh.positions.len(), 48 * 8);
    }

    #[test]
    fn nothing_is_around_nothing() {
        for points in [
            vec![],
            vec![DVec3::ONE],
            vec![DVec3::ONE; 9],
            vec![DVec3::NAN, DVec3::ONE],
        ] {
            assert!(tube(&points, 0.01, true, 8).triangles.is_empty());
        }
        assert!(
            tube(&[DVec3::ZERO, DVec3::X], f64::NAN, false, 8)
                .triangles
                .is_empty()
        );
    }
}
