use glam::Vec3;
use midair_mesh::TriMesh;

use super::shapes::{ball, bowl, inverted, joined, moved};
use super::*;

const BALL: f32 = 4.0 / 3.0 * std::f32::consts::PI * 0.008;

fn is_ball(mesh: &TriMesh) {
    let v = baked(mesh);
    let whole = baked(&ball(0.2, 48, 24));
    for ((p, a), (_, b)) in nodes(&v).zip(nodes(&whole)) {
        // Further out the order of the triangles may show.
        let most = if b.abs() < 0.017 { 1e-5 } else { 1e-3 };
        assert!((a - b).abs() < most, "{p}: {a}, not {b}");
    }
}

#[test]
fn inverted_ball_is_solid() {
    is_ball(&inverted(ball(0.2, 48, 24)));
}

#[test]
fn flipped_and_repeated_faces_do_not_matter() {
    let mut mesh = ball(0.2, 48, 24);
    let mut seed = 1u32;
    let count = mesh.triangles.len();
    for i in 0..count {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if seed >> 30 == 0 {
            mesh.triangles[i].swap(0, 1);
        }
        if seed >> 27 == 5 {
            let mut again = mesh.triangles[i];
            again.rotate_left(1);
            again.swap(0, 1);
            mesh.triangles.push(again);
        }
    }
    is_ball(&mesh);
}

#[test]
fn loose_triangles_are_joined() {
    let mesh = ball(0.2, 48, 24);
    let loose = TriMesh {
        positions: (0..mesh.triangles.len())
            .flat_map(|t| mesh.corners(t))
            .collect(),
        normals: Vec::new(),
        triangles: (0..mesh.triangles.len() as u32)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect(),
    };
    is_ball(&loose);
}

#[test]
fn holes_are_closed_evenly() {
    let mut mesh = ball(0.2, 48, 24);
    let mut i = 0;
    mesh.triangles.retain(|_| {
        i += 1;
        i % 97 != 0
    });
    is_ball(&mesh);
}

#[test]
fn bowl_gets_a_flat_lid() {
    let v = baked(&bowl(0.2));
    assert!(
        (inside(&v) / (0.5 * BALL) - 1.0).abs() < 0.06,
        "{}",
        inside(&v) / BALL
    );
    for i in 0..40 {
        for j in 0..40 {
            let (x, y) = (i as f32 * 0.006 - 0.12, j as f32 * 0.006 - 0.12);
            for z in [-0.02, -0.005, 0.004, 0.015] {
                let s = v.sample(Vec3::new(x, y, z));
                assert!((s + z).abs() < 1e-4, "({x}, {y}, {z}): {s}");
            }
        }
    }
}

#[test]
fn a_bent_rim_gets_a_smooth_lid() {
    let mut mesh = bowl(0.2);
    for p in &mut mesh.positions {
        p.z += 2.0 * p.x * p.y;
    }
    let v = baked(&mesh);
    // The rim is that of the saddle z = 2xy, which is its own soap film but for little.
    for (p, s) in nodes(&v) {
        let z = p.z - 2.0 * p.x * p.y;
        if p.truncate().length() < 0.15 && z.abs() > 0.008 && z < 0.08 {
            assert_eq!(s < 0.0, z > 0.0, "{p}: {s}");
        }
    }
    steady(&v, 0.04);
}

/// φ changes between neighbouring nodes near the surface by no more than a step.
pub fn steady(v: &Volume, reach: f32) {
    for (p, s) in nodes(v).filter(|n| n.1.abs() < reach) {
        for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
            let q = p + axis * v.step();
            if q.cmple(v.bounds().max).all() {
                let t = v.sample(q);
                assert!((s - t).abs() < 1.02 * v.step(), "{p}: {s} beside {t}");
            }
        }
    }
}

#[test]
fn crossing_balls_have_no_wall_between() {
    let (a, b) = (Vec3::new(-0.07, 0.0, 0.0), Vec3::new(0.07, 0.0, 0.0));
    let mesh = joined(moved(ball(0.13, 64, 32), a), &moved(ball(0.13, 64, 32), b));
    let v = baked(&mesh);
    let s = v.sample(Vec3::ZERO);
    // The nearest surface from the middle is the circle in which they meet.
    let exact = (0.13f32 * 0.13 - 0.07 * 0.07).sqrt();
    assert!((s + exact).abs() < 0.004, "{s}, not -{exact}");
    let from_a = v.sample(Vec3::new(0.03, 0.0, 0.0));
    assert!(
        from_a < -0.08,
        "{from_a}: the wall of the other ball is left"
    );
}

#[test]
fn cavities_stay_and_inverted_parts_are_turned() {
    let hollow = joined(ball(0.2, 48, 24), &inverted(ball(0.1, 48, 24)));
    let v = baked(&hollow);
    assert!(v.sample(Vec3::ZERO) > 0.09);
    assert!(v.sample(Vec3::new(0.15, 0.0, 0.0)) < -0.04);
    let arm = inverted(moved(ball(0.1, 48, 24), Vec3::new(0.2, 0.0, 0.0)));
    let v = baked(&joined(ball(0.2, 48, 24), &arm));
    assert!(v.sample(Vec3::new(0.25, 0.0, 0.0)) < -0.04);
    assert!(v.sample(Vec3::new(0.15, 0.0, 0.0)) < -0.02);
}

#[test]
fn a_sheet_holds_nothing() {
    let sheet = TriMesh {
        positions: vec![
            Vec3::ZERO,
            Vec3::X * 0.2,
            Vec3::new(0.2, 0.1, 0.0),
            Vec3::Y * 0.2,
        ],
        normals: Vec::new(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    assert!(baked(&sheet).is_hollow());
}

#[test]
fn bad_input_is_named() {
    let try_it = |mesh: &TriMesh, step: f32| {
        bake(mesh, &BakeOptions::with_step(step), &Progress::new()).unwrap_err()
    };
    let good = ball(0.2, 12, 6);
    assert_eq!(try_it(&TriMesh::default(), 0.01), BakeError::NoTriangles);
    let mut bad = good.clone();
    bad.positions[3].y = f32::NAN;
    assert_eq!(try_it(&bad, 0.01), BakeError::NotFinite);
    bad.positions[3].y = 1e30;
    assert_eq!(try_it(&bad, 0.01), BakeError::NotFinite);
    bad.positions.fill(Vec3::ONE);
    assert_eq!(try_it(&bad, 0.01), BakeError::NoExtent);
    let mut bad = good.clone();
    bad.triangles[5][1] = 9999;
    assert!(matches!(
        try_it(&bad, 0.01),
        BakeError::NoSuchVertex { triangle: 5, .. }
    ));
    assert_eq!(try_it(&good, 0.0), BakeError::Step(0.0));
    assert!(matches!(try_it(&good, f32::NAN), BakeError::Step(_)));
    let BakeError::TooLarge { fits, .. } = try_it(&good, 1e-5) else {
        panic!("a grid of 60,000 nodes a side was not refused");
    };
    assert!(fits > 1e-4 && fits < 1e-3, "{fits}");
    let options = BakeOptions {
        padding: -1.0,
        ..Default::default()
    };
    let refused = bake(&good, &options, &Progress::new()).unwrap_err();
    assert_eq!(refused, BakeError::Padding(-1.0));
}

#[test]
fn a_bake_can_be_cancelled() {
    let mesh = ball(0.2, 200, 100);
    let progress = Progress::new();
    let other = progress.clone();
    let waiting = std::thread::spawn(move || {
        while other.fraction() < 0.1 {
            std::thread::yield_now();
        }
        other.cancel();
    });
    let result = bake(&mesh, &BakeOptions::with_step(0.001), &progress);
    waiting.join().unwrap();
    assert_eq!(result.unwrap_err(), BakeError::Cancelled);
}
