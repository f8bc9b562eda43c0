use glam::DVec3;

use super::*;
use crate::line::Line;

fn circle(keypoints: usize) -> Curve {
    let at = |i: usize| std::f64::consts::TAU * i as f64 / keypoints as f64;
    Curve {
        points: (0..=keypoints)
            .map(|i| DVec3::new(at(i).cos(), at(i).sin(), 0.0))
            .collect(),
        tangents: (0..=keypoints)
            .map(|i| DVec3::new(-at(i).sin(), at(i).cos(), 0.0))
            .collect(),
        closed: true,
    }
}

#[test]
fn a_circle_through_four_keypoints_is_round() {
    let fitted = fit(&circle(4));
    let worst = fitted
        .spline
        .flattened(64)
        .points()
        .iter()
        .map(|p| (p.length() - 1.0).abs())
        .fold(0.0, f64::max);
    println!(
        "{worst:e} off in {} steps, variation {:e}",
        fitted.steps, fitted.variation
    );
    assert!(worst < 5e-4, "{worst}");
}

#[test]
fn a_stroke_round_a_square_follows_its_middles() {
    let c =
        [(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let scaffold = Scaffold {
        lines: (0..4).map(|i| Line::new(c[i], c[(i + 1) % 4])).collect(),
        ticks: vec![],
    };
    let stroke: Vec<DVec3> = (0..=200)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 200.0;
            let wobble = 0.2 + 0.008 * (5.0 * a).sin();
            DVec3::new(wobble * a.cos(), wobble * a.sin(), 0.004 * (3.0 * a).cos())
        })
        .collect();
    let Fair::Curve {
        spline,
        keypoints,
        closed,
    } = fair_stroke(&stroke, &scaffold, &StrokeOptions::default())
    else {
        panic!("a curve");
    };
    assert!(closed);
    assert_eq!(keypoints.len(), 5, "{keypoints:?}");
    assert!(keypoints.iter().all(|k| k.along_line));
    for p in spline.flattened(32).points() {
        assert!((p.length() - 0.2).abs() < 2e-4, "{}", p.length());
    }
}

#[test]
fn an_almost_straight_stroke_is_straight() {
    let stroke: Vec<DVec3> = (0..50)
        .map(|i| DVec3::new(0.01 * f64::from(i), 0.005 * (0.3 * f64::from(i)).sin(), 0.0))
        .collect();
    let fair = fair_stroke(&stroke, &Scaffold::default(), &StrokeOptions::default());
    let Fair::Straight(line) = fair else {
        panic!("{fair:?}")
    };
    assert_eq!((line.a, line.b), (stroke[0], stroke[49]));
}

#[test]
fn a_detail_stroke_near_no_scaffold_keeps_its_shape() {
    let stroke: Vec<DVec3> = (0..300)
        .map(|i| {
            let t = 0.03 * f64::from(i);
            DVec3::new(0.05 * t, 0.15 * t.sin(), 0.02 * t)
        })
        .collect();
    let Fair::Curve { spline, .. } =
        fair_stroke(&stroke, &Scaffold::default(), &StrokeOptions::default())
    else {
        panic!("a curve");
    };
    let shown = spline.flattened(32);
    for p in &stroke {
        assert!(straight::to_polyline(*p, shown.points()) < 0.06);
    }
}

#[test]
fn strokes_that_are_none_are_nothing() {
    let options = StrokeOptions::default();
    for stroke in [
        vec![],
        vec![DVec3::ONE],
        vec![DVec3::ONE; 500],
        vec![DVec3::NAN, DVec3::ONE],
    ] {
        assert_eq!(
            fair_stroke(&stroke, &Scaffold::default(), &options),
            Fair::Nothing
        );
    }
}

#[test]
fn the_derivative_is_that_of_small_differences() {
    let mut curve = circle(3);
    curve.points[1].z = 0.4;
    curve.closed = false;
    for (closed, along) in [
        (false, Along::Curve),
        (true, Along::Curve),
        (false, Along::Chords),
    ] {
        curve.closed = closed;
        let mut measure = measure::Measure::new(&curve, 40, along);
        let x = [0.4, 0.7, 0.5, 0.6, 0.8, 0.45];
        let (r, jacobian) = measure.linearised(&x);
        let gradient = jacobian.tr_mul(&r) * 2.0;
        for j in 0..6 {
            let mut value = |h: f64| {
                let mut y = x;
                y[j] += h;
                measure.value(&y)
            };
            let h = 1e-7;
            let difference = (value(h) - value(-h)) / (2.0 * h);
            assert!(
                (difference - gradient[j]).abs() < 1e-3 * gradient[j].abs().max(1.0),
                "{j} {difference} {}",
                gradient[j]
            );
        }
    }
}

#[test]
fn the_fit_never_gets_worse_than_where_it_began() {
    let mut random = crate::line::tests::Random::new(5);
    for n in 4..=10 {
        let points: Vec<DVec3> = (0..n)
            .map(|i| DVec3::new(0.2 * f64::from(i), 0.0, 0.0) + random.within(0.1))
            .collect();
        let tangents = (0..n)
            .map(|_| (DVec3::X + random.within(0.8)).normalize())
            .collect();
        let curve = Curve {
            points,
            tangents,
            closed: false,
        };
        let begun = {
            let x: Vec<f64> = curve
                .points
                .windows(2)
                .flat_map(|q| [q[0].distance(q[1]) / 3.0; 2])
                .collect();
            measure::Measure::new(&curve, 100, Along::Curve).value(&x)
        };
        let fitted = fit_with(&curve, 100, Along::Curve);
        assert!(fitted.variation <= begun);
        assert!(fitted.magnitudes.iter().all(|m| m.is_finite() && *m > 0.0));
    }
}

#[test]
fn a_rounded_square_follows_its_sides_and_never_runs_past_them() {
    let h = 0.2;
    let c = [(-h, -h), (h, -h), (h, h), (-h, h)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let mut scaffold = Scaffold::default();
    for i in 0..4 {
        let (a, b) = (c[i], c[(i + 1) % 4]);
        scaffold.lines.push(Line::new(a, b));
        scaffold.ticks.extend([a.lerp(b, 0.225), a.lerp(b, 0.775)]);
    }
    let r = 0.09;
    let mut drawn = vec![DVec3::new(0.0, -h, 0.0)];
    for (x, y, from) in [
        (1.0, -1.0, -0.5),
        (1.0, 1.0, 0.0),
        (-1.0, 1.0, 0.5),
        (-1.0, -1.0, 1.0),
    ] {
        for i in 0..=8 {
            let a = std::f64::consts::PI * (from + f64::from(i) / 16.0);
            drawn.push(DVec3::new(
                x * (h - r) + r * a.cos(),
                y * (h - r) + r * a.sin(),
                0.0,
            ));
        }
    }
    drawn.push(drawn[0]);
    let line = Polyline::new(drawn).spaced(0.01);
    let mut random = crate::line::tests::Random::new(31);
    let wobbling: Vec<DVec3> = line.iter().map(|p| *p + random.within(0.004)).collect();
    let Fair::Curve {
        spline,
        closed,
        keypoints,
    } = fair_stroke(&wobbling, &scaffold, &StrokeOptions::default())
    else {
        panic!("a curve");
    };
    assert!(closed);
    assert!(
        keypoints.iter().filter(|k| k.along_line).count() >= 12,
        "{keypoints:?}"
    );
    let shown = spline.flattened(32);
    for p in shown.points() {
        assert!(p.x.abs().max(p.y.abs()) < h + 2e-3, "{p}");
        assert!(straight::to_polyline(*p, &line) < 0.012, "{p}");
    }
    assert!(shown.length() < 1.03 * Polyline::new(line).length());
}
