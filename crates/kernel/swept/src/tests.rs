use glam::{DQuat, DVec3, Vec3};
use midair_curve::{End, Lengths};
use midair_mesh::check;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use crate::{Profile, Rib, Row, Sweep, SweepError, bent, cut, smoothed, touches};

fn end(position: DVec3, turn: DQuat) -> End {
    End {
        position,
        rotation: turn.normalize(),
    }
}

/// Two hands on smooth ways, as people move them.
#[derive(Clone, Debug)]
struct Ways {
    from: [DVec3; 2],
    to: [DVec3; 2],
    bow: [DVec3; 2],
    turns: [[DQuat; 2]; 2],
    slopes: [f32; 2],
    frames: usize,
}

/// As the other hand is turned when both do the same, as people's do.
fn mirrored(q: DQuat) -> DQuat {
    DQuat::from_xyzw(q.x, -q.y, -q.z, q.w)
}

fn ways() -> impl Strategy<Value = Ways> {
    let v = |r: f64| (-r..r, -r..r, -r..r).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    let q = |r: f64| {
        (v(1.0), -r..r)
            .prop_map(|(axis, by)| DQuat::from_axis_angle(axis.normalize_or(DVec3::X), by))
    };
    let slopes = (0.0..3.0f32, 0.0..3.0f32);
    (
        (v(0.1), v(0.1), v(0.4), v(0.4), v(0.1), v(0.1)),
        (q(1.0), q(0.3), q(0.5), q(0.5)),
        slopes,
        10..40usize,
    )
        .prop_map(
            |((a, b, da, db, ba, bb), (q0, q1, q2, q3), (w0, w1), frames)| {
                let a = a + DVec3::X * -0.25;
                let b = b + DVec3::X * 0.25;
                Ways {
                    from: [a, b],
                    to: [a + da, b + db],
                    bow: [ba, bb],
                    turns: [[q0, q2 * q0], [q1 * mirrored(q0), q3 * q1 * mirrored(q0)]],
                    slopes: [w0, w1],
                    frames,
                }
            },
        )
}

impl Ways {
    /// As the mode sweeps: Eq. 10 once a frame, a rib each time the curve has moved by 0.01 m.
    fn ribs(&self) -> Vec<Rib> {
        let mut lengths = Lengths::default();
        let mut ribs: Vec<Rib> = Vec::new();
        for i in 0..=self.frames * 4 {
            let t = i as f64 / (self.frames * 4) as f64;
            let hand = |k: usize| {
                let at = self.from[k].lerp(self.to[k], t) + self.bow[k] * (4.0 * t * (1.0 - t));
                end(at, self.turns[k][0].slerp(self.turns[k][1], t))
            };
            let (left, right) = (hand(0), hand(1));
            if i == 0 {
                lengths.settle(&left, &right);
            }
            lengths.adapt(&left, &right);
            let before = ribs.last().map_or(0.0, |r| f64::from(r.twist));
            let rib = Rib::held(&left, &right, lengths, self.slopes, before);
            if ribs.last().is_none_or(|last| last.apart(&rib, 24) > 0.01) {
                ribs.push(rib);
            }
        }
        ribs
    }

    /// The same, swept across the plane the curve bends in, as a tube is made on purpose.
    fn across(mut self) -> Self {
        let bend = 0.5 + self.bow[0].length();
        let still = |q: DQuat| DQuat::IDENTITY.slerp(q, 0.15);
        for k in 0..2 {
            let bent = DQuat::from_rotation_z(if k == 0 { bend } else { -bend });
            let turn = self.turns[k][1] * self.turns[k][0].inverse();
            self.turns[k] = [bent, still(turn) * bent];
            let way = self.to[k] - self.from[k];
            self.to[k] = self.from[k] + way * 0.3 + DVec3::Z * 0.35;
            self.from[k].z *= 0.2;
            self.bow[k] *= 0.3;
        }
        self
    }

    fn sweep(&self, profile: Profile, thickness: f32, caps: bool) -> Sweep {
        Sweep {
            ribs: self.ribs().into(),
            count: 24,
            profile,
            thickness,
            caps,
        }
    }
}

#[test]
fn five_hundred_random_sweeps_are_closed_or_say_where_they_touch() {
    let mut rng = TestRunner::deterministic();
    let (mut clean, mut touching, mut inverted) = ([0; 3], [0; 3], 0);
    for i in 0..500 {
        let ways = ways().new_tree(&mut rng).unwrap().current();
        let (profile, thickness, caps) = match i % 3 {
            0 => (Profile::Sheet, 0.012, false),
            1 => (Profile::Tube, 0.0, true),
            _ => (Profile::Tube, 0.008, false),
        };
        // Every other tube is made as one would; the others run through themselves as they like.
        let ways = if i % 3 > 0 && i % 2 == 0 {
            ways.across()
        } else {
            ways
        };
        let sweep = ways.sweep(profile, thickness, caps);
        if sweep.ribs.len() < 2 {
            continue;
        }
        let solid = sweep
            .solid()
            .unwrap_or_else(|e| panic!("{i}: {e}: {ways:?}"));
        let report = check(&solid.mesh);
        let sound = report.watertight
            && report.edge_manifold
            && report.vertex_manifold
            && report.consistently_wound
            && report.outward
            && report.duplicate_faces == 0
            && report.degenerate_faces == 0;
        assert!(sound, "{i} {profile:?}: {:?}", report.faults());
        let (pairs, places) = touches(&solid.mesh);
        assert_eq!(pairs, report.self_touching);
        assert_eq!(pairs == 0, places.is_empty());
        assert_eq!(solid.uv.len(), solid.mesh.positions.len());
        inverted += usize::from(!solid.inverted.is_empty());
        match pairs {
            0 => {
                clean[i % 3] += 1;
                assert!(
                    solid.inverted.is_empty(),
                    "{i}: faces look back, and nothing says so"
                );
            }
            _ => touching[i % 3] += 1,
        }
    }
    println!(
        "500 sweeps (plates, capped tubes, pipes): {clean:?} without fault, {touching:?} say where they touch themselves, {inverted} of those with faces that look back"
    );
    assert!(clean.iter().all(|&n| n >= 60), "{clean:?}");
}

/// Level hands that go straight up.
fn wall(count: u32, profile: Profile) -> Sweep {
    let ribs = (0..=20).map(|j| {
        let at = |x: f64| End {
            position: DVec3::new(x, f64::from(j) * 0.01, 0.0),
            rotation: DQuat::from_rotation_z(x.signum() * -0.9),
        };
        let mut lengths = Lengths::default();
        lengths.settle(&at(-0.1), &at(0.1));
        Rib::held(&at(-0.1), &at(0.1), lengths, [1.0; 2], 0.0)
    });
    // The bow lies in the plane it is swept in unless it is turned.
    let turn = glam::Quat::from_rotation_x(1.2);
    let ribs = ribs.map(|r| Rib {
        tangents: r.tangents.map(|m| turn * m),
        ..r
    });
    Sweep {
        ribs: ribs.collect(),
        count,
        profile,
        thickness: 0.0,
        caps: false,
    }
}

#[test]
fn what_is_open_is_no_solid_and_one_curve_no_surface() {
    let sheet = wall(24, Profile::Sheet);
    assert_eq!(sheet.solid().unwrap_err(), SweepError::Open);
    assert!(!sheet.is_closed());
    let one = Sweep {
        ribs: sheet.ribs[..1].into(),
        ..sheet.clone()
    };
    assert_eq!(one.surface().unwrap_err(), SweepError::TooFew);
    let still = Sweep {
        ribs: vec![sheet.ribs[0]; 4].into(),
        thickness: 0.01,
        ..sheet.clone()
    };
    assert_eq!(still.solid().unwrap_err(), SweepError::Flat);
    let mut broken = sheet.ribs.to_vec();
    broken[3].points[1].y = f32::NAN;
    let broken = Sweep {
        ribs: broken.into(),
        ..sheet
    };
    assert_eq!(broken.surface().unwrap_err(), SweepError::Rib(4));
}

#[test]
fn a_surface_has_its_place_on_a_picture() {
    let surface = wall(24, Profile::Sheet).surface().unwrap();
    assert_eq!(surface.uv.len(), surface.mesh.positions.len());
    let (low, high) = surface
        .uv
        .iter()
        .fold((f32::MAX, 0.0f32), |(l, h), uv| (l.min(uv.y), h.max(uv.y)));
    assert_eq!(low, 0.0);
    assert!((high - 0.2).abs() < 1e-4, "metres swept: {high}");
    assert!(surface.uv.iter().all(|uv| (0.0..=1.0).contains(&uv.x)));
}

/// Hands tilted the same way: the curve is an S, and the one that closes it crosses it in the middle.
fn eight(by: f64) -> Sweep {
    let ribs = (0..=20).map(|j| {
        let at = |x: f64, turn: f64| End {
            position: DVec3::new(x, 0.0, f64::from(j) * 0.01),
            rotation: DQuat::from_rotation_z(turn),
        };
        let (left, right) = (at(-0.1, 1.0), at(0.1, by));
        let mut lengths = Lengths::default();
        lengths.settle(&left, &right);
        Rib::held(&left, &right, lengths, [1.0; 2], 0.0)
    });
    Sweep {
        ribs: ribs.collect(),
        count: 48,
        profile: Profile::Tube,
        thickness: 0.0,
        caps: true,
    }
}

/// The area that a curve and the one that closes it have between them, loop by loop: the curve's height
/// over its chord is half of how far the two are apart.
fn loops(rib: &Rib) -> f64 {
    let curve = rib.curve();
    let side = |u: f64| {
        let (s, back) = (curve.at(u), curve.closing().at(u));
        (s, back)
    };
    let steps = 20_000;
    let strip = |i: usize| {
        let (a, d) = side(i as f64 / f64::from(steps));
        let (b, c) = side((i + 1) as f64 / f64::from(steps));
        let half = |p: DVec3, q: DVec3, r: DVec3| 0.5 * (q - p).cross(r - p).z;
        (half(a, b, c) + half(a, c, d)).abs()
    };
    (0..steps as usize).map(strip).sum()
}

#[test]
fn a_figure_of_eight_is_full_in_both_loops_and_says_where_it_crosses() {
    for by in [1.0, 0.6] {
        let sweep = eight(by);
        let solid = sweep.solid().unwrap();
        let report = check(&solid.mesh);
        assert!(
            report.watertight && report.edge_manifold && report.consistently_wound,
            "{:?}",
            report.faults()
        );
        let at = solid.crossed.expect("it crosses itself");
        assert!(at.length() < 0.05 && at.z.abs() < 0.02, "{at}");
        let (bulk, _) = sweep.bulk(&sweep.points());
        let wanted = loops(&sweep.ribs[0]) * 0.2;
        assert!((bulk - wanted).abs() < 0.04 * wanted, "{bulk} of {wanted}");
        assert!(
            solid.mesh.volume() < 0.95 * bulk,
            "the loops run against each other"
        );
    }
    // Hands tilted against each other make one loop.
    let one = eight(-0.9).solid().unwrap();
    assert_eq!(one.crossed, None);
    // Swept along its own plane it still encloses nothing.
    let flat = eight(1.0);
    let ribs = flat
        .ribs
        .iter()
        .map(|r| r.shifted(Vec3::new(0.0, r.points[0].z, -r.points[0].z)));
    let flat = Sweep {
        ribs: ribs.collect(),
        ..flat
    };
    assert_eq!(flat.solid().unwrap_err(), SweepError::Flat);
}

#[test]
fn a_pinned_end_is_the_middle_of_a_fan() {
    for (profile, thickness, caps) in [
        (Profile::Sheet, 0.01, false),
        (Profile::Tube, 0.0, true),
        (Profile::Tube, 0.006, false),
    ] {
        let ribs = wall(24, profile).ribs;
        let pin = ribs[0].points[0];
        let ribs = ribs.iter().map(|r| Rib {
            points: [pin, r.points[1]],
            ..*r
        });
        let sweep = Sweep {
            ribs: ribs.collect(),
            count: 24,
            profile,
            thickness,
            caps,
        };
        let report = check(&sweep.solid().unwrap().mesh);
        assert!(
            report.watertight && report.edge_manifold && report.vertex_manifold,
            "{profile:?} {:?}",
            report.faults()
        );
        assert_eq!(report.degenerate_faces, 0);
    }
}

proptest! {
    #[test]
    fn smoothing_is_the_papers(ways in ways(), alpha in 0.0..1.0f32) {
        let ribs: Vec<Rib> = ways.ribs().iter().map(|r| Rib { slopes: [1.0; 2], ..*r }).collect();
        prop_assume!(ribs.len() > 3);
        let smooth = smoothed(&ribs, alpha, 1);
        let points = |r: &Rib| -> Vec<Vec3> {
            (0..12).map(|i| r.curve().at(f64::from(i) / 11.0).as_vec3()).collect()
        };
        prop_assert_eq!(points(&smooth[0]), points(&ribs[0]));
        for i in 1..ribs.len() - 1 {
            let (a, b, c, s) = (points(&ribs[i - 1]), points(&ribs[i]), points(&ribs[i + 1]), points(&smooth[i]));
            for k in 0..12 {
                let wanted = b[k] * (1.0 - alpha) + (a[k] + c[k]) * (0.5 * alpha);
                prop_assert!(s[k].distance(wanted) < 1e-5);
            }
        }
    }

    #[test]
    fn a_bent_rib_is_where_it_was_put_and_far_ones_stay(ways in ways(), by in -0.1..0.1f32) {
        let ribs = ways.ribs();
        prop_assume!(ribs.len() > 12);
        let to = ribs[6].shifted(Vec3::splat(by));
        let new = bent(&ribs, 6, &to, 4);
        prop_assert_eq!(new[6], to);
        prop_assert_eq!(new[1], ribs[1]);
        prop_assert!(new[5].points[0].distance(ribs[5].points[0]) <= to.points[0].distance(ribs[6].points[0]) + 1e-6);
        prop_assert!(new.iter().all(Rib::is_sound));
    }

    #[test]
    fn clones_that_stand_closer_are_smaller(ways in ways()) {
        let rib = ways.ribs()[0];
        let row = Row { ribs: vec![Rib { slopes: [0.2, 1.0], ..rib }].into(), count: 9, size: 1.0, paced: true };
        prop_assert!(row.validate().is_ok());
        let places = row.places();
        prop_assert_eq!(places.len(), 9);
        prop_assert!(places.iter().all(|p| p.scale > 0.0 && p.rotation.is_normalized()));
        prop_assert!(places[0].scale < places[4].scale);
        let even = Row { paced: false, size: 0.5, ..row };
        prop_assert!(even.places().iter().all(|p| p.scale == 0.5));
    }
}

#[test]
fn a_cut_leaves_both_parts_with_the_curve_between() {
    let ribs = wall(24, Profile::Sheet).ribs;
    let (a, b) = cut(&ribs, 7).unwrap();
    assert_eq!((a.len(), b.len()), (8, ribs.len() - 7));
    assert_eq!(a[7], b[0]);
    assert!(cut(&ribs, 0).is_none() && cut(&ribs, 20).is_none());
}

#[test]
fn a_million_clones_are_refused() {
    let rib = wall(24, Profile::Sheet).ribs[0];
    let row = Row {
        ribs: vec![rib; 1000].into(),
        count: 1000,
        size: 1.0,
        paced: true,
    };
    assert_eq!(
        row.validate().unwrap_err(),
        SweepError::TooManyClones(1_000_000)
    );
}

#[test]
fn tangents_without_a_length_leave_a_straight_curve() {
    let ribs = (0..=10).map(|j| Rib {
        points: [
            Vec3::new(-0.1, 0.0, 0.01 * j as f32),
            Vec3::new(0.1, 0.0, 0.01 * j as f32),
        ],
        tangents: [Vec3::ZERO; 2],
        slopes: [1.0; 2],
        start: glam::Quat::IDENTITY,
        twist: 0.0,
    });
    let plate = Sweep {
        ribs: ribs.collect(),
        count: 24,
        profile: Profile::Sheet,
        thickness: 0.01,
        caps: false,
    };
    let report = check(&plate.solid().unwrap().mesh);
    assert!(report.is_faultless(), "{:?}", report.faults());
    assert!(
        (report.volume - 0.2 * 0.1 * 0.01).abs() < 1e-7,
        "{}",
        report.volume
    );
    let tube = Sweep {
        profile: Profile::Tube,
        caps: true,
        thickness: 0.0,
        ..plate.clone()
    };
    assert_eq!(
        tube.solid().unwrap_err(),
        SweepError::Flat,
        "a curve and itself"
    );
    let row = Row {
        ribs: plate.ribs,
        count: 5,
        size: 1.0,
        paced: true,
    };
    let places = row.places();
    assert!(
        places
            .iter()
            .all(|p| p.translation.is_finite() && p.rotation.is_normalized())
    );
}

#[test]
fn hands_are_found_again_in_a_rib() {
    let (left, right) = (
        end(DVec3::new(-0.2, 1.0, 0.1), DQuat::from_rotation_y(0.4)),
        end(
            DVec3::new(0.3, 1.1, 0.0),
            DQuat::from_rotation_z(-0.7) * DQuat::from_rotation_x(1.0),
        ),
    );
    let mut lengths = Lengths::default();
    lengths.settle(&left, &right);
    let rib = Rib::held(
        &left,
        &right,
        lengths,
        [1.0, 2.0],
        4.0 * std::f64::consts::PI,
    );
    assert!(rib.twist > 10.0, "two turns are counted: {}", rib.twist);
    for (is, was) in [(rib.left(), left), (rib.right(), right)] {
        assert!(is.position.distance(was.position) < 1e-6);
        assert!(is.rotation.angle_between(was.rotation) < 1e-5);
    }
}

#[test]
fn a_net_through_known_points_is_the_net() {
    let ribs = wall(24, Profile::Sheet).ribs;
    for closed in [false, true] {
        let mut points = Vec::new();
        for rib in ribs.iter() {
            crate::Net::row_into(rib, closed, 12, &mut points);
        }
        let whole = crate::Net::new(&ribs, closed, 12);
        assert_eq!(crate::Net::through(points, ribs.len(), closed), whole);
    }
}
