//! Lids over holes.

use glam::{DVec2, DVec3, Vec3};
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation,
};

use super::repair::{EdgeUse, by_edge};
use super::{BakeError, Progress};

/// Corners of a rim up to which the lid of least area is sought (its cost grows with the cube).
const MOST_CORNERS: usize = 160;
/// Vertices a lid may gain so that it bends smoothly.
const MOST_ADDED: usize = 20_000;

/// Triangles whose boundary undoes that of the mesh.
///
/// The edges that are passed more often one way than the other form closed loops, whatever the
/// mesh: each gets a disc. A flat rim gets a flat lid, where the generalised winding number of the
/// open mesh is one half too; another the surface that hangs between its sides like a soap film.
pub(super) fn over_holes(
    positions: &[Vec3],
    edges: &[EdgeUse],
    size: f32,
    progress: &Progress,
) -> Result<Vec<[Vec3; 3]>, BakeError> {
    let mut lids = Vec::new();
    for (i, rim) in rims(edges).iter().enumerate() {
        if i % 64 == 0 || rim.len() > 64 {
            progress.check()?;
        }
        let points: Vec<DVec3> = rim
            .iter()
            .map(|&v| positions[v as usize].as_dvec3())
            .collect();
        let mut add = |t: [DVec3; 3]| lids.push(t.map(|p| p.as_vec3()));
        if points.len() == 3 {
            add([points[0], points[1], points[2]]);
        } else if !draped(&points, f64::from(size), &mut add) {
            for t in least_area(&points) {
                add(t.map(|k| points[k]));
            }
        }
    }
    Ok(lids)
}

/// The loops that lids must run along, each without a repeated vertex.
fn rims(edges: &[EdgeUse]) -> Vec<Vec<u32>> {
    let mut open: Vec<(u32, u32)> = Vec::new();
    for e in by_edge(edges) {
        let forward = e.iter().filter(|u| u.forward).count();
        let back = e.len() - forward;
        let (low, high) = (e[0].low, e[0].high);
        open.extend((back..forward).map(|_| (high, low)));
        open.extend((forward..back).map(|_| (low, high)));
    }
    open.sort_unstable();
    let mut used = vec![false; open.len()];
    let mut place = rustc_hash::FxHashMap::default();
    let mut rims = Vec::new();
    // The next edge of each vertex that may be unused.
    let mut next: rustc_hash::FxHashMap<u32, usize> = rustc_hash::FxHashMap::default();
    for first in 0..open.len() {
        if used[first] {
            continue;
        }
        let mut path = vec![open[first].0];
        place.clear();
        place.insert(open[first].0, 0usize);
        let mut edge = first;
        loop {
            used[edge] = true;
            let to = open[edge].1;
            if let Some(&k) = place.get(&to) {
                let rim = path.split_off(k);
                for v in &rim {
                    place.remove(v);
                }
                rims.push(rim);
            }
            place.insert(to, path.len());
            path.push(to);
            let at = next
                .entry(to)
                .or_insert_with(|| open.partition_point(|e| e.0 < to));
            while open.get(*at).is_some_and(|e| e.0 == to) && used[*at] {
                *at += 1;
            }
            // As many edges leave a vertex as reach it, so the walk ends where it began.
            if open.get(*at).is_none_or(|e| e.0 != to) {
                break;
            }
            edge = *at;
        }
    }
    rims.retain(|r| r.len() > 2);
    rims
}

/// Lays a Delaunay triangulation in the plane of the rim and bends it to the rim's heights.
/// False, with nothing added, where the rim crosses itself in that plane.
fn draped(rim: &[DVec3], size: f64, add: &mut impl FnMut([DVec3; 3])) -> bool {
    let n = rim.len();
    let centre = rim.iter().sum::<DVec3>() / n as f64;
    let normal: DVec3 = (0..n)
        .map(|i| (rim[i] - centre).cross(rim[(i + 1) % n] - centre))
        .sum();
    let Some(normal) = normal.try_normalize() else {
        return false;
    };
    let (u, v) = normal.any_orthonormal_pair();
    let flat = |p: DVec3| DVec2::new((p - centre).dot(u), (p - centre).dot(v));
    let heights: Vec<f64> = rim.iter().map(|p| (*p - centre).dot(normal)).collect();
    let extent = rim.iter().map(|&p| flat(p).length()).fold(0.0, f64::max);
    let area = 0.5
        * (0..n)
            .map(|i| flat(rim[i]).perp_dot(flat(rim[(i + 1) % n])))
            .sum::<f64>();
    // A rim seen edge-on has no inside in its plane.
    if area < 1e-3 * extent * extent {
        return false;
    }
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut handles = Vec::with_capacity(n);
    for &p in rim {
        let q = flat(p);
        let Ok(h) = cdt.insert(Point2::new(q.x, q.y)) else {
            return false;
        };
        handles.push(h);
    }
    if cdt.num_vertices() != n {
        return false;
    }
    for i in 0..n {
        let (a, b) = (handles[i], handles[(i + 1) % n]);
        if !cdt.can_add_constraint(a, b) {
            return false;
        }
        cdt.add_constraint(a, b);
    }
    if cdt.num_constraints() != n {
        // A corner lies on another side.
        return false;
    }
    let bend = heights.iter().fold(0.0f64, |m, h| m.max(h.abs()));
    let side = size.max(extent * 0.02);
    let most = if bend > 0.02 * size { MOST_ADDED } else { 0 };
    let result = cdt.refine(
        RefinementParameters::new()
            .exclude_outer_faces(true)
            .keep_constraint_edges()
            .with_angle_limit(AngleLimit::from_deg(0.0))
            .with_max_allowed_area(0.5 * side * side)
            .with_max_additional_vertices(most),
    );
    let outside: rustc_hash::FxHashSet<_> = result.excluded_faces.into_iter().collect();
    let mut corner_of = vec![0; n];
    for (i, h) in handles.iter().enumerate() {
        corner_of[h.index()] = i;
    }
    let mut height = vec![0.0; cdt.num_vertices()];
    for (h, z) in handles.iter().zip(&heights) {
        height[h.index()] = *z;
    }
    let neighbours: Vec<(usize, Vec<usize>)> = cdt
        .vertices()
        .filter(|v| v.index() >= n)
        .map(|v| (v.index(), v.out_edges().map(|e| e.to().index()).collect()))
        .collect();
    // Over-relaxed sweeps settle a disc of N vertices in about √N of them.
    let sweeps = 20 + 8 * neighbours.len().isqrt();
    for _ in 0..sweeps {
        for (i, around) in &neighbours {
            let mean = around.iter().map(|&j| height[j]).sum::<f64>() / around.len() as f64;
            height[*i] += 1.7 * (mean - height[*i]);
        }
    }
    for f in cdt.inner_faces().filter(|f| !outside.contains(&f.fix())) {
        let corners = f.vertices().map(|c| {
            if c.index() < n {
                // The rim's own corners, to the last bit.
                return rim[corner_of[c.index()]];
            }
            let p = c.position();
            centre + u * p.x + v * p.y + normal * height[c.index()]
        });
        add(corners);
    }
    true
}

/// The triangles of least area in all between the corners of a rim (Barequet and Sharir 1995), or
/// a fan where the corners are too many.
fn least_area(rim: &[DVec3]) -> Vec<[usize; 3]> {
    let n = rim.len();
    if n > MOST_CORNERS {
        return (1..n - 1).map(|i| [0, i, i + 1]).collect();
    }
    let area = |a: usize, b: usize, c: usize| (rim[b] - rim[a]).cross(rim[c] - rim[a]).length();
    let mut cost = vec![0.0f64; n * n];
    let mut split = vec![0usize; n * n];
    for span in 2..n {
        for i in 0..n - span {
            let k = i + span;
            let (c, j) = (i + 1..k)
                .map(|j| (cost[i * n + j] + cost[j * n + k] + area(i, j, k), j))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap_or((0.0, i + 1));
            cost[i * n + k] = c;
            split[i * n + k] = j;
        }
    }
    let mut triangles = Vec::with_capacity(n - 2);
    let mut spans = vec![(0, n - 1)];
    while let Some((i, k)) = spans.pop() {
        if k - i < 2 {
            continue;
        }
        let j = split[i * n + k];
        triangles.push([i, j, k]);
        spans.extend([(i, j), (j, k)]);
    }
    triangles
}
