use glam::{DQuat, DVec3};
use proptest::prelude::*;

use super::*;

fn correct(line: Line, lines: &[Line]) -> Corrected {
    let scaffold = Scaffold {
        lines: lines.to_vec(),
        ticks: Vec::new(),
    };
    correct_line(&line, &scaffold, &LineOptions::default())
}

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

#[test]
fn a_nearly_upright_line_stands_upright() {
    let out = correct(Line::new(v(0.0, 0.0, 0.0), v(0.02, 0.5, 0.01)), &[]);
    let d = out.line.direction().unwrap();
    assert!(d.cross(DVec3::Y).length() < 1e-10, "{out:?}");
    assert_eq!(out.kept.len(), 1);
    assert!((out.line.a.midpoint(out.line.b) - v(0.01, 0.25, 0.005)).length() < 1e-6);
}

#[test]
fn an_angle_of_ones_own_is_met_and_none_is_not() {
    let base = Line::new(v(0.0, 0.0, 0.0), v(0.6, 0.0, 0.0));
    let scaffold = Scaffold {
        lines: vec![base],
        ticks: vec![],
    };
    let at = |degrees: f64| {
        let a = degrees.to_radians();
        Line::new(v(0.01, 0.0, 0.0), v(0.4 * a.cos(), 0.0, 0.4 * a.sin()))
    };
    let own = LineOptions {
        own_angle: 72.0_f64.to_radians(),
        part_turn: 0.0,
        ..LineOptions::default()
    };
    let angle = |line: Line, options: &LineOptions| {
        let out = correct_line(&line, &scaffold, options).line;
        out.direction().unwrap().dot(DVec3::X).acos().to_degrees()
    };
    assert!((angle(at(70.0), &own) - 72.0).abs() < 1e-6);
    // From the other side of the line it is the same angle.
    assert!((angle(at(106.5), &own) - 108.0).abs() < 1e-6);
    let none = LineOptions {
        own_angle: 0.0,
        ..own
    };
    assert!((angle(at(70.0), &none) - 72.0).abs() > 0.5);
}

#[test]
fn of_two_keypoints_one_wins_and_the_other_leaves_no_trace() {
    let posts = [
        Line::new(v(0.0, 0.0, 0.0), v(0.0, -1.0, 0.0)),
        Line::new(v(0.04, 0.0, 0.0), v(0.04, -1.0, 0.0)),
    ];
    let out = correct(Line::new(v(0.012, 0.01, 0.0), v(0.012, 0.3, 0.4)), &posts);
    assert!(out.line.a.distance(v(0.0, 0.0, 0.0)) < 1e-10, "{out:?}");
    assert!(!out.dropped.is_empty());
}

#[test]
fn the_fourth_side_closes_a_rectangle() {
    let lines = [
        Line::new(v(0.0, 0.0, 0.0), v(0.4, 0.0, 0.0)),
        Line::new(v(0.4, 0.0, 0.0), v(0.4, 0.3, 0.0)),
        Line::new(v(0.0, 0.0, 0.0), v(0.0, 0.3, 0.0)),
    ];
    let out = correct(
        Line::new(v(0.01, 0.31, 0.01), v(0.39, 0.29, -0.015)),
        &lines,
    );
    assert!(out.line.a.distance(v(0.0, 0.3, 0.0)) < 1e-10);
    assert!(out.line.b.distance(v(0.4, 0.3, 0.0)) < 1e-10);
    let kept = |f: fn(&Constraint) -> bool| out.kept.iter().any(f);
    assert!(kept(|c| matches!(c, Constraint::Parallel { .. })));
    assert!(kept(|c| matches!(c, Constraint::Perpendicular { .. })));
    assert!(kept(|c| matches!(c, Constraint::EqualLength { .. })));
}

#[test]
fn lines_that_are_none_come_back_as_they_are() {
    let posts = [
        Line::new(DVec3::ZERO, DVec3::Y),
        Line::new(DVec3::ONE, DVec3::ONE),
    ];
    for line in [
        Line::new(DVec3::ONE, DVec3::ONE),
        Line::new(DVec3::NAN, DVec3::ONE),
        Line::new(DVec3::ZERO, DVec3::X * f64::INFINITY),
    ] {
        let out = correct(line, &posts);
        assert!(out.kept.is_empty());
        assert_eq!(format!("{:?}", out.line), format!("{line:?}"));
    }
}

#[test]
fn zooming_in_makes_the_thresholds_finer() {
    let post = [Line::new(DVec3::ZERO, v(0.0, -1.0, 0.0))];
    let drawn = Line::new(v(0.03, 0.0, 0.0), v(0.6, 0.3, 0.5));
    let scaffold = Scaffold {
        lines: post.to_vec(),
        ticks: vec![],
    };
    let near = correct_line(&drawn, &scaffold, &LineOptions::default());
    assert!(near.line.a.length() < 1e-9);
    // No upright line is as long, so that only the end decides.
    let zoomed = LineOptions {
        metres_per_world: 4.0,
        ..LineOptions::default()
    };
    let far = correct_line(&drawn, &scaffold, &zoomed);
    assert!(far.line.a.distance(drawn.a) < 1e-9, "{far:?}");
}

/// A splitmix of its own: the same sketches on every machine.
pub(crate) struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in a ball.
    pub fn within(&mut self, radius: f64) -> DVec3 {
        loop {
            let p = v(
                self.between(-1.0, 1.0),
                self.between(-1.0, 1.0),
                self.between(-1.0, 1.0),
            );
            if p.length_squared() <= 1.0 {
                return p * radius;
            }
        }
    }
}

/// Draws `edges` between `corners` one after the other. Whoever draws sees what stands there: where
/// a corner is reached already it is aimed at as it is shown.
pub(super) fn sketch(
    corners: &[DVec3],
    edges: &[(usize, usize)],
    noise: f64,
    random: &mut Random,
) -> Vec<Line> {
    let mut shown: Vec<Option<DVec3>> = vec![None; corners.len()];
    let mut scaffold = Scaffold::default();
    for &(i, j) in edges {
        let aim = |k: usize, other: usize| match (shown[k], shown[other]) {
            (Some(p), _) => p,
            // A free end is aimed at from the end that stands.
            (None, Some(q)) => q + corners[k] - corners[other],
            (None, None) => corners[k],
        };
        let drawn = Line::new(
            aim(i, j) + random.within(noise),
            aim(j, i) + random.within(noise),
        );
        let out = correct_line(&drawn, &scaffold, &LineOptions::default());
        shown[i].get_or_insert(out.line.a);
        shown[j].get_or_insert(out.line.b);
        scaffold.lines.push(out.line);
    }
    scaffold.lines
}

/// Whether every pair of edges that meet in a corner meet exactly.
pub(super) fn closes(lines: &[Line], edges: &[(usize, usize)]) -> bool {
    let mut at = std::collections::HashMap::<usize, DVec3>::new();
    lines.iter().zip(edges).all(|(line, &(i, j))| {
        [(i, line.a), (j, line.b)]
            .into_iter()
            .all(|(k, p)| at.entry(k).or_insert(p).distance(p) < 1e-6)
    })
}

pub(super) const BOX: [(usize, usize); 12] = [
    (0, 1),
    (1, 2),
    (2, 3),
    (3, 0),
    (0, 4),
    (1, 5),
    (2, 6),
    (3, 7),
    (4, 5),
    (5, 6),
    (6, 7),
    (7, 4),
];

pub(super) fn random_box(random: &mut Random) -> [DVec3; 8] {
    let sides = loop {
        let mut s = [0; 3].map(|_| random.between(0.2, 0.6));
        let unsorted = s;
        s.sort_by(f64::total_cmp);
        if s[1] / s[0] > 1.3 && s[2] / s[1] > 1.3 {
            break unsorted;
        }
    };
    let turn = DQuat::from_rotation_y(random.between(0.0, std::f64::consts::TAU));
    let [x, y, z] = sides;
    [
        v(0.0, 0.0, 0.0),
        v(x, 0.0, 0.0),
        v(x, 0.0, z),
        v(0.0, 0.0, z),
        v(0.0, y, 0.0),
        v(x, y, 0.0),
        v(x, y, z),
        v(0.0, y, z),
    ]
    .map(|p| turn * p)
}

/// Twelve edges, three directions square to each other, three lengths.
pub(super) fn is_box(lines: &[Line]) -> bool {
    if !closes(lines, &BOX) {
        return false;
    }
    let of = |i: usize| lines[i].b - lines[i].a;
    let axes = [of(0), of(1), of(4)];
    let square = |a: DVec3, b: DVec3| a.normalize().dot(b.normalize()).abs() < 1e-6;
    square(axes[0], axes[1])
        && square(axes[1], axes[2])
        && square(axes[0], axes[2])
        && [(0, [0, 2, 8, 10]), (1, [1, 3, 9, 11]), (2, [4, 5, 6, 7])]
            .iter()
            .all(|&(axis, edges)| {
                edges.iter().all(|&e| {
                    let d = of(e);
                    d.distance(axes[axis]).min((d + axes[axis]).length()) < 1e-6
                })
            })
}

#[test]
fn most_noisy_boxes_come_out_exact() {
    let mut random = Random::new(7);
    let exact = (0..200)
        .filter(|_| {
            let corners = random_box(&mut random);
            is_box(&sketch(&corners, &BOX, 0.02, &mut random))
        })
        .count();
    println!("{exact} of 200 boxes");
    assert!(exact >= 190, "{exact} of 200 boxes");
}

#[test]
fn most_noisy_hexagonal_prisms_come_out_exact() {
    let mut edges = Vec::new();
    for i in 0..6 {
        edges.push((i, (i + 1) % 6));
    }
    for i in 0..6 {
        edges.push((i, i + 6));
    }
    for i in 0..6 {
        edges.push((i + 6, (i + 1) % 6 + 6));
    }
    let mut random = Random::new(11);
    let mut closed = 0;
    let mut exact = 0;
    for _ in 0..200 {
        let (side, height) = (random.between(0.2, 0.6), random.between(0.2, 0.6));
        let turn = random.between(0.0, 6.3);
        let corners: Vec<DVec3> = (0..12)
            .map(|i| {
                let a = turn + std::f64::consts::FRAC_PI_3 * (i % 6) as f64;
                v(
                    side * a.cos(),
                    if i < 6 { 0.0 } else { height },
                    side * a.sin(),
                )
            })
            .collect();
        let lines = sketch(&corners, &edges, 0.02, &mut random);
        let closes = closes(&lines, &edges);
        let regular = (0..6).all(|i| {
            let [a, b] = [i, (i + 1) % 6].map(|k| lines[k].direction().unwrap_or_default());
            (a.dot(b) - 0.5).abs() < 1e-6
        });
        closed += usize::from(closes);
        let upright = lines[6..12].iter().all(|l| {
            l.direction()
                .is_some_and(|d| d.cross(DVec3::Y).length() < 1e-6)
        });
        let equal = |part: &[Line]| {
            part.iter()
                .all(|l| (l.length() - part[0].length()).abs() < 1e-6)
        };
        if !(closes
            && upright
            && regular
            && equal(&lines[..6])
            && equal(&lines[12..])
            && equal(&lines[6..12]))
            && std::env::var_os("SHOW").is_some()
        {
            println!(
                "side {side:.3} upright {upright} regular {regular} equal {} {} {} height {height:.4}",
                equal(&lines[..6]),
                equal(&lines[12..]),
                equal(&lines[6..12])
            );
            for l in &lines {
                println!(
                    "  {:.4} {:.2}",
                    l.length(),
                    (l.b - l.a).z.atan2((l.b - l.a).x).to_degrees()
                );
            }
        }
        exact += usize::from(
            closes
                && upright
                && regular
                && equal(&lines[..6])
                && equal(&lines[12..])
                && equal(&lines[6..12]),
        );
    }
    println!("{exact} of 200 prisms exact, {closed} closed");
    assert!(closed >= 198 && exact >= 190, "{closed} {exact}");
}

#[test]
fn few_iterations_are_enough() {
    let mut random = Random::new(3);
    let mut histogram = std::collections::BTreeMap::<usize, usize>::new();
    for _ in 0..50 {
        let corners = random_box(&mut random);
        let mut scaffold = Scaffold::default();
        for &(i, j) in &BOX {
            let drawn = Line::new(
                corners[i] + random.within(0.02),
                corners[j] + random.within(0.02),
            );
            let out = correct_line(&drawn, &scaffold, &LineOptions::default());
            *histogram.entry(out.iterations).or_default() += 1;
            scaffold.lines.push(out.line);
        }
    }
    println!("iterations: {histogram:?}");
}

fn scene() -> impl Strategy<Value = (Line, Scaffold)> {
    let point = || (-0.5..0.5, -0.5..0.5, -0.5..0.5).prop_map(|(x, y, z)| v(x, y, z));
    let line = move || (point(), point()).prop_map(|(a, b)| Line::new(a, b));
    (line(), proptest::collection::vec(line(), 0..12)).prop_map(|(l, lines)| {
        (
            l,
            Scaffold {
                lines,
                ticks: vec![],
            },
        )
    })
}

proptest! {
    #[test]
    fn what_is_kept_holds_and_nothing_is_thrown_far((line, scaffold) in scene()) {
        let options = LineOptions::default();
        let out = correct_line(&line, &scaffold, &options);
        for c in &out.kept {
            prop_assert!(c.energy(&out.line, 1.0).sqrt() < 1e-6, "{c:?}");
        }
        let most = 0.05 + line.length() * 0.43;
        prop_assert!(out.line.a.distance(line.a) <= most && out.line.b.distance(line.b) <= most);
    }

    #[test]
    fn correcting_a_corrected_line_changes_nothing((line, scaffold) in scene()) {
        let options = LineOptions::default();
        let once = correct_line(&line, &scaffold, &options);
        prop_assume!(!once.refused);
        let twice = correct_line(&once.line, &scaffold, &options);
        prop_assert!(twice.line.a.distance(once.line.a) < 1e-9, "{once:?} {twice:?}");
        prop_assert!(twice.line.b.distance(once.line.b) < 1e-9, "{once:?} {twice:?}");
    }

    #[test]
    fn where_one_stands_does_not_matter((line, scaffold) in scene(), turn in 0.0..6.0, shift in -3.0..3.0) {
        let options = LineOptions::default();
        let q = DQuat::from_rotation_y(turn);
        let t = v(shift, 0.5 * shift, -shift);
        let there = |l: &Line| Line::new(q * l.a + t, q * l.b + t);
        let moved = Scaffold { lines: scaffold.lines.iter().map(there).collect(), ticks: vec![] };
        let here = correct_line(&line, &scaffold, &options);
        let out = correct_line(&there(&line), &moved, &options);
        let back = there(&here.line);
        prop_assert!(out.line.a.distance(back.a) < 1e-7, "{here:?} {out:?}");
        prop_assert!(out.line.b.distance(back.b) < 1e-7);
    }

    #[test]
    fn turned_in_any_way_it_is_the_same_without_a_vertical((line, scaffold) in scene(), x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0) {
        let options = LineOptions { vertical: false, ..LineOptions::default() };
        let q = DQuat::from_scaled_axis(v(x, y, z) * 3.0);
        let there = |l: &Line| Line::new(q * l.a, q * l.b);
        let moved = Scaffold { lines: scaffold.lines.iter().map(there).collect(), ticks: vec![] };
        let here = correct_line(&line, &scaffold, &options);
        let out = correct_line(&there(&line), &moved, &options);
        let back = there(&here.line);
        prop_assert!(out.line.a.distance(back.a) < 1e-7, "{here:?} {out:?}");
        prop_assert!(out.line.b.distance(back.b) < 1e-7);
    }

    #[test]
    fn in_a_zoomed_world_it_is_the_same_in_its_scale((line, scaffold) in scene(), zoom in 0.1..10.0) {
        let there = |l: &Line| Line::new(l.a / zoom, l.b / zoom);
        let moved = Scaffold { lines: scaffold.lines.iter().map(there).collect(), ticks: vec![] };
        let here = correct_line(&line, &scaffold, &LineOptions::default());
        let options = LineOptions { metres_per_world: zoom, ..LineOptions::default() };
        let out = correct_line(&there(&line), &moved, &options);
        let back = there(&here.line);
        prop_assert!(out.line.a.distance(back.a) * zoom < 1e-7, "{here:?} {out:?}");
        prop_assert!(out.line.b.distance(back.b) * zoom < 1e-7);
    }

    #[test]
    fn other_readings_differ_and_end_with_what_was_drawn((line, scaffold) in scene()) {
        let options = LineOptions::default();
        let all = readings(&line, &scaffold, &options, 5);
        prop_assert!(!all.is_empty() && all.len() <= 5);
        prop_assert_eq!(all[0].line, correct_line(&line, &scaffold, &options).line);
        for (i, a) in all.iter().enumerate() {
            for c in &a.kept {
                prop_assert!(c.energy(&a.line, 1.0).sqrt() < 1e-6, "{c:?}");
            }
            for b in &all[..i] {
                prop_assert!(a.line.a.distance(b.line.a).max(a.line.b.distance(b.line.b)) > 9e-4);
            }
        }
        let moved = all[0].line.a.distance(line.a).max(all[0].line.b.distance(line.b));
        if moved > 2e-3 {
            prop_assert_eq!(all[all.len() - 1].line, line);
        }
    }
}

#[test]
fn a_scene_in_which_everything_conflicts_throws_no_line() {
    let mut random = Random::new(23);
    for _ in 0..40 {
        // Hundreds of points around both ends, and lines in every direction.
        let near = |random: &mut Random, at: DVec3| at + random.within(0.05);
        let (a, b) = (v(0.0, 0.0, 0.0), v(0.4, 0.1, 0.0));
        let scaffold = Scaffold {
            lines: (0..150)
                .map(|_| Line::new(near(&mut random, a), near(&mut random, b)))
                .collect(),
            ticks: (0..300).map(|_| near(&mut random, a)).collect(),
        };
        let drawn = Line::new(a, b);
        let out = correct_line(&drawn, &scaffold, &LineOptions::default());
        assert!(
            out.line.a.distance(a) < 0.2 && out.line.b.distance(b) < 0.2,
            "{out:?}"
        );
        for c in &out.kept {
            assert!(c.energy(&out.line, 1.0).sqrt() < 1e-6);
        }
    }
}

#[test]
fn two_identical_lines_stay_identical() {
    let line = Line::new(v(0.1, 0.2, 0.3), v(0.5, 0.2, 0.3));
    let out = correct(line, &[line, line]);
    assert!(out.line.a.distance(line.a) < 1e-9 && out.line.b.distance(line.b) < 1e-9);
}
