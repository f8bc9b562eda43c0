use glam::Vec3;
use midair_mesh::Aabb;

use super::shapes::{ball, torus};
use super::*;

fn close(a: f32, b: f32) -> bool {
    (a - b).abs() < 2e-6
}

#[test]
fn rows_agree_with_samples() {
    let v = baked(&torus(0.14, 0.06, 60, 30));
    let rows = [
        (Vec3::new(-0.4, 0.01, 0.02), Vec3::X * 0.0071),
        (Vec3::new(-0.4, 0.5, 0.02), Vec3::X * 0.031),
        (Vec3::new(-0.3, -0.35, -0.1), Vec3::new(0.005, 0.006, 0.002)),
        (Vec3::new(0.1, 0.05, 0.3), Vec3::Z * -0.004),
        (Vec3::new(0.3, 0.05, 0.0), Vec3::X * -0.004),
        (Vec3::new(0.13, 0.05, 0.0), Vec3::ZERO),
    ];
    for (start, delta) in rows {
        let mut out = [0.0; 131];
        v.sample_row(start, delta, &mut out);
        for (i, &s) in out.iter().enumerate() {
            let p = start + i as f32 * delta;
            // Bricks of two kinds meet with a small jump: rounding may choose either.
            let beside = [-1e-6, 1e-6].map(|e| v.sample(p + e));
            let fits = beside.iter().chain([&v.sample(p)]).any(|&b| close(s, b));
            assert!(fits, "{p}: {s}, not {}", v.sample(p));
        }
    }
}

#[test]
fn ranges_hold_all_samples() {
    let v = baked(&torus(0.14, 0.06, 60, 30));
    let mut seed = 7u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    for _ in 0..300 {
        let c = Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5);
        let half = 0.1 * Vec3::new(random(), random(), random());
        let within = Aabb::around(c, half);
        let (least, greatest) = v.range(&within);
        for _ in 0..50 {
            let t = Vec3::new(random(), random(), random());
            let s = v.sample(within.min + t * within.size());
            assert!(
                least <= s && s <= greatest,
                "{s} not in {least}..{greatest}"
            );
        }
    }
}

#[test]
fn outside_is_a_lower_bound() {
    let v = baked(&ball(0.2, 48, 24));
    for i in 0..2000 {
        let a = i as f32 * 0.7;
        let p = Vec3::new(a.sin(), (1.3 * a).cos(), (0.37 * a).sin()) * (0.3 + i as f32 * 1e-3);
        let s = v.sample(p);
        if v.bounds().distance(p) > 0.0 {
            let exact = p.length() - 0.2;
            assert!(
                s >= v.bounds().distance(p) && s <= exact * 1.03 + 0.002,
                "{p}: {s}, {exact}"
            );
        }
    }
    assert!(v.sample(Vec3::splat(1e6)).is_finite());
    // A place that is none gives some number, not a panic.
    let _ = v.sample(Vec3::NAN);
    v.sample_row(Vec3::NAN, Vec3::X, &mut [0.0; 9]);
    v.sample_row(Vec3::ZERO, Vec3::splat(f32::INFINITY), &mut [0.0; 9]);
    v.sample_row(Vec3::ZERO, Vec3::X * 1e30, &mut [0.0; 9]);
}

#[test]
fn functions_are_kept_where_it_matters() {
    let f = |p: Vec3| p.length() - 0.25;
    let bounds = Aabb::around(Vec3::ZERO, Vec3::splat(0.315));
    let v = Volume::from_fn(bounds, 0.01, f).unwrap();
    assert_eq!(v.cells(), UVec3::splat(63));
    for (p, s) in nodes(&v) {
        let d = f(p);
        assert!(s.abs() <= d.abs() + 1e-5 && (s < 0.0) == (d < 0.0));
        if d.abs() < 0.03 {
            assert!(close(s, d), "{p}: {s}, not {d}");
        }
    }
    assert!(Volume::from_fn(bounds, -1.0, f).is_err());
    assert!(Volume::from_fn(bounds, 1e-6, f).is_err());
    assert!(Volume::from_fn(Aabb::EMPTY, 0.01, f).is_err());
}
