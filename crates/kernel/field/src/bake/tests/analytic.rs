use glam::Vec3;
use rayon::prelude::*;

use super::super::tree::Tree;
use super::super::triangle::Triangle;
use super::shapes::{ball, torus};
use super::*;

fn triangles(mesh: &midair_mesh::TriMesh) -> Vec<Triangle> {
    let count = mesh.triangles.len();
    (0..count).map(|t| Triangle::new(mesh.corners(t))).collect()
}

#[test]
fn fast_winding_is_near_the_exact_sum() {
    let t = triangles(&ball(0.2, 64, 32));
    let tree = Tree::new(&t);
    for p in [Vec3::ZERO, Vec3::new(0.15, 0.02, 0.1), Vec3::splat(0.15)] {
        let turn = |t: &Triangle| {
            let (re, im) = t.angle(p);
            im.atan2(re) / std::f64::consts::TAU
        };
        let exact: f64 = t.iter().map(turn).sum();
        assert!((f64::from(tree.winding(p)) - exact).abs() < 0.06);
        assert!((exact - exact.round()).abs() < 1e-4);
    }
}

#[test]
fn nodes_near_a_ball_are_exact() {
    let mesh = ball(0.2, 64, 32);
    let v = baked(&mesh);
    let t = triangles(&mesh);
    let tree = Tree::new(&t);
    let all: Vec<_> = nodes(&v).collect();
    all.par_iter().enumerate().for_each(|(i, &(p, s))| {
        let d = tree.closest(p, None).0.sqrt();
        if i % 997 == 0 {
            let brute = t
                .iter()
                .map(|t| t.distance_squared(p))
                .fold(f32::INFINITY, f32::min);
            assert!((d - brute.sqrt()).abs() < 1e-6);
        }
        if d <= 1.75 * v.step() {
            assert!((s.abs() - d).abs() < 1e-6, "{p}: {s}, not {d}");
        } else if d <= 3.0 * v.step() {
            assert!((s.abs() - d).abs() < 0.1 * v.step(), "{p}: {s}, not {d}");
        }
        assert!(s.abs() < d * 1.1 + 1e-6, "{p}: {s} claims more than {d}");
        if d > 1e-5 {
            assert_eq!(s < 0.0, tree.winding(p) > 0.5, "{p}: {s}");
        }
    });
}

#[test]
fn torus_has_no_wrong_sign() {
    let (large, small) = (0.14, 0.06);
    let v = baked(&torus(large, small, 160, 80));
    // The facets lie inside the torus by at most this much.
    let sag = 0.5 * (large + small) * (std::f32::consts::PI / 160.0).powi(2)
        + 0.5 * small * (std::f32::consts::PI / 80.0).powi(2);
    for (p, s) in nodes(&v) {
        let exact = (p.truncate().length() - large).hypot(p.z) - small;
        if exact.abs() < 1.5 * v.step() {
            assert!(
                (s - exact).abs() < sag + 1e-4 * v.step(),
                "{p}: {s}, not {exact}"
            );
        }
        if exact.abs() > sag {
            assert_eq!(s < 0.0, exact < 0.0, "{p}: {s}, not {exact}");
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same() {
    let mesh = torus(0.14, 0.06, 60, 30);
    let [one, three] = [1, 3].map(|n| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .unwrap();
        pool.install(|| baked(&mesh).to_bytes())
    });
    assert!(one == three);
}

/// Rays along the sides and through the corners of a mesh are those where rounding might count wrongly.
#[test]
fn a_box_and_a_star_on_the_nodes_have_no_wrong_sign() {
    let step = 1.0 / 128.0;
    let at = |i: u32| {
        let k = glam::UVec3::new(i & 1, i >> 1 & 1, i >> 2).as_vec3();
        (k * 2.0 - 1.0) * 16.0 * step
    };
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let cube = midair_mesh::TriMesh {
        positions: (0..8).map(at).collect(),
        normals: Vec::new(),
        triangles: sides
            .iter()
            .flat_map(|s| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]])
            .collect(),
    };
    let corners = [Vec3::X, Vec3::Y, Vec3::Z].map(|v| [v * 24.0 * step, v * -24.0 * step]);
    let star = midair_mesh::TriMesh {
        positions: corners.concat(),
        normals: Vec::new(),
        triangles: (0..8)
            .map(|i| {
                let t = [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2)];
                if (i & 1) ^ (i >> 1 & 1) ^ (i >> 2) == 0 {
                    t
                } else {
                    [t[0], t[2], t[1]]
                }
            })
            .collect(),
    };
    let options = BakeOptions {
        step,
        padding: 8.0 * step,
    };
    let volume = |mesh| bake(mesh, &options, &Progress::new()).unwrap();
    for (p, s) in nodes(&volume(&cube)) {
        let d = p.abs().max_element() - 16.0 * step;
        assert!(d.abs() < 1e-6 || (s < 0.0) == (d < 0.0), "{p}: {s}");
    }
    for (p, s) in nodes(&volume(&star)) {
        let d = p.abs().element_sum() - 24.0 * step;
        assert!(d.abs() < 1e-6 || (s < 0.0) == (d < 0.0), "{p}: {s}");
    }
}
