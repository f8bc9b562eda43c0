use std::time::Duration;

use super::*;

/// Eight triangles about the origin.
fn ball() -> Vec<Triangle> {
    let ball = midair_mesh::TriMesh {
        positions: vec![
            Vec3::X,
            Vec3::Y,
            Vec3::Z,
            Vec3::NEG_X,
            Vec3::NEG_Y,
            Vec3::NEG_Z,
        ],
        normals: Vec::new(),
        triangles: vec![
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ],
    };
    (0..8).map(|t| Triangle::new(ball.corners(t))).collect()
}

#[test]
fn angles_add_up_to_more_than_a_turn_either_way() {
    let mut state = 7u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    for bias in [-1.0, 0.0, 1.0] {
        for _ in 0..200 {
            let (mut turns, mut sum) = (Turns::NONE, 0.0);
            for _ in 0..300 {
                let angle =
                    (next() * 2.0 - 1.0 + 0.5 * bias).clamp(-0.999, 0.999) * std::f64::consts::PI;
                let size = 1e-9 + 1e-3 * next();
                turns.add((size * angle.cos(), size * angle.sin()));
                sum += angle / std::f64::consts::TAU;
            }
            assert!(
                (turns.count() - sum).abs() < 1e-9,
                "{} is {sum}",
                turns.count()
            );
        }
    }
    // Half turns to the digit, and nothing at all.
    let mut turns = Turns::NONE;
    for _ in 0..5 {
        turns.add((-1.0, 0.0));
        turns.add((0.0, 0.0));
    }
    assert_eq!(turns.count(), 2.5);
}

#[test]
fn both_sides_of_a_surface_are_told_at_once() {
    let all = ball();
    let twice: Vec<Triangle> = all.iter().chain(&all).copied().collect();
    for (triangles, within) in [(&all, 1.0), (&twice, 2.0)] {
        let tree = Tree::new(triangles);
        assert!((tree.winding(Vec3::splat(0.1)) - within).abs() < 1e-5);
        for t in &all {
            let p = t.v[0] * 0.5 + t.v[1] * 0.3 + t.v[2] * 0.2;
            for off in [2e-3, 2e-5] {
                let [out, inside] = tree.winding_beside(p, t.n * off);
                assert!(
                    out.abs() < 0.05 && (inside - within).abs() < 0.05,
                    "{out} {inside}"
                );
            }
        }
    }
}

#[test]
fn many_may_ask_for_moments_at_once() {
    let (told, tell) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let triangles = ball().repeat(20_000);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(8).build();
        let pool = pool.unwrap();
        for _ in 0..10 {
            let tree = Tree::new(&triangles);
            // They come one by one: were the first to have help, it would take up one of the next while it waits for it.
            pool.in_place_scope(|scope| {
                for _ in 0..200 {
                    scope.spawn(|_| {
                        assert!(tree.winding(Vec3::new(0.0, 0.0, 90.0)).abs() < 1.0);
                    });
                    std::thread::sleep(Duration::from_micros(20));
                }
            });
        }
        told.send(()).unwrap();
    });
    let patience = Duration::from_secs(120);
    assert!(
        tell.recv_timeout(patience).is_ok(),
        "all wait for each other"
    );
}
