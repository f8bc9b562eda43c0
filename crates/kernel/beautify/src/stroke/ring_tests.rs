//! Strokes that end where they begin: round, and begun anywhere.

use std::f64::consts::TAU;

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::line::Line;
use crate::line::tests::Random;

/// A stroke along `at`, of which one time round goes from 0 to 1, begun at `from` and as far past its start as `over` of it.
fn drawn(at: impl Fn(f64) -> DVec3, from: f64, over: f64) -> Vec<DVec3> {
    (0..=400)
        .map(|i| at((from + (1.0 + over) * f64::from(i) / 400.0).rem_euclid(1.0)))
        .collect()
}

fn ellipse(a: f64, b: f64) -> impl Fn(f64) -> DVec3 + Copy {
    move |t| DVec3::new(a * (TAU * t).cos(), b * (TAU * t).sin(), 0.3)
}

/// A square of half a side of `h` whose corners are round by `r`.
fn rounded_square(h: f64, r: f64) -> impl Fn(f64) -> DVec3 + Copy {
    move |t| {
        let (side, quarter) = (2.0 * (h - r), 0.5 * std::f64::consts::PI * r);
        let whole = 4.0 * (side + quarter);
        let mut s = t.rem_euclid(1.0) * whole;
        let turn = (s / (side + quarter)).floor().min(3.0);
        s -= turn * (side + quarter);
        let p = if s < side {
            DVec3::new(h, s - 0.5 * side, 0.0)
        } else {
            let a = (s - side) / r;
            DVec3::new(h - r + r * a.cos(), h - r + r * a.sin(), 0.0)
        };
        glam::DQuat::from_rotation_z(turn * 0.25 * TAU) * p
    }
}

fn ticks(at: impl Fn(f64) -> DVec3, count: usize) -> Scaffold {
    Scaffold {
        lines: vec![],
        ticks: (0..count).map(|i| at(i as f64 / count as f64)).collect(),
    }
}

fn closed(stroke: &[DVec3], scaffold: &Scaffold) -> (Spline, Vec<Keypoint>) {
    let fair = fair_stroke(stroke, scaffold, &StrokeOptions::default());
    let Fair::Curve {
        spline,
        keypoints,
        closed: true,
    } = fair
    else {
        panic!("{fair:?}");
    };
    (spline, keypoints)
}

/// How far apart two closed curves are at most.
fn apart(a: &Spline, b: &Spline) -> f64 {
    let (a, b) = (a.flattened(48), b.flattened(48));
    let one = |a: &[DVec3], b: &[DVec3]| {
        let far = a.iter().map(|p| straight::to_polyline(*p, b));
        far.fold(0.0, f64::max)
    };
    one(a.points(), b.points()).max(one(b.points(), a.points()))
}

/// The curvature as a vector at a share of a segment.
fn bend(b: &CubicBezier, t: f64) -> DVec3 {
    let (p, s) = (b.0, 1.0 - t);
    let v = ((p[1] - p[0]) * s * s + (p[2] - p[1]) * (2.0 * s * t) + (p[3] - p[2]) * t * t) * 3.0;
    let a = ((p[2] - p[1] * 2.0 + p[0]) * s + (p[3] - p[2] * 2.0 + p[1]) * t) * 6.0;
    v.cross(a) / v.length().powi(3)
}

/// By how much the curvature jumps in each keypoint, the first one first.
fn jumps(spline: &Spline) -> Vec<f64> {
    let n = spline.segments.len();
    (0..n)
        .map(|i| {
            let before = &spline.segments[(i + n - 1) % n];
            bend(before, 1.0).distance(bend(&spline.segments[i], 0.0))
        })
        .collect()
}

#[test]
fn a_circle_drawn_past_few_points_or_none_is_round() {
    for radius in [0.016, 0.03, 0.05, 0.1, 0.2, 0.4] {
        let circle = ellipse(radius, radius);
        // Small ones pass but one place.
        for count in 0..=if radius < 0.05 { 1 } else { 6 } {
            for from in [0.0, 0.03, 0.37] {
                // Whole, two centimetres too far, and one short of where it began.
                for over in [0.0, 0.02, -0.01].map(|by| by / (TAU * radius)) {
                    let stroke = drawn(circle, from, over);
                    let (spline, keypoints) = closed(&stroke, &ticks(circle, count));
                    let worst = spline
                        .flattened(32)
                        .points()
                        .iter()
                        .map(|p| (p.truncate().length() / radius - 1.0).abs())
                        .fold(0.0, f64::max);
                    // Samples a centimetre apart are the corners of a polygon.
                    let corners = match radius {
                        ..0.05 => 1e-3,
                        _ if over < 0.0 => 6e-4,
                        _ => 2.4e-4,
                    };
                    let allowed = 0.004 + corners / radius;
                    assert!(
                        worst < allowed,
                        "{radius} {count} {from} {over}: {worst} of {allowed}, {keypoints:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn where_a_closed_stroke_begins_does_not_show() {
    let shapes: [(&str, Box<dyn Fn(f64) -> DVec3>); 3] = [
        ("circle", Box::new(ellipse(0.2, 0.2))),
        ("ellipse", Box::new(ellipse(0.3, 0.15))),
        ("square", Box::new(rounded_square(0.2, 0.09))),
    ];
    for (name, shape) in &shapes {
        for count in [3, 4, 5, 6, 8] {
            let scaffold = ticks(shape, count);
            let (first, keypoints) = closed(&drawn(shape, 0.0, 0.0), &scaffold);
            let at_seam = jumps(&first)[0];
            let most = jumps(&first).into_iter().fold(0.0, f64::max);
            println!(
                "{name} {count}: {} keypoints, curvature jumps by {at_seam:.3} at the seam, {most:.3} at most",
                keypoints.len() - 1
            );
            // The square's corners begin at its ticks: there the curvature of what was drawn jumps by 11.
            assert!(*name == "square" || most < 1.0, "{name} {count}: {most}");
            for from in [0.02, 0.11, 0.26, 0.5, 0.77] {
                let (other, _) = closed(&drawn(shape, from, 0.0), &scaffold);
                let far = apart(&first, &other);
                assert!(far < 1e-3, "{name} {count} {from}: {far}");
            }
        }
    }
}

#[test]
fn a_wobbling_circle_is_as_round_where_it_begins_as_elsewhere() {
    let (mut seam, mut elsewhere) = (0.0_f64, 0.0_f64);
    let mut random = Random::new(17);
    let circle = ellipse(0.2, 0.2);
    for _ in 0..40 {
        // A hand is off slowly, and somewhere else when it comes back.
        let bumps: Vec<(f64, DVec3)> = (0..6)
            .map(|i| (f64::from(i) / 6.0, random.within(0.012)))
            .collect();
        let mut stroke = drawn(circle, 0.13, 0.0);
        let last = stroke.len() as f64 - 1.0;
        for (i, p) in stroke.iter_mut().enumerate() {
            for (at, by) in &bumps {
                *p += *by * (-40.0 * (i as f64 / last - at).powi(2)).exp();
            }
        }
        let begun = stroke[0];
        let (spline, _) = closed(&stroke, &ticks(circle, 4));
        for p in spline.flattened(32).points() {
            let off = (p.truncate().length() - 0.2).abs();
            if p.distance(begun) < 0.08 {
                seam = seam.max(off);
            } else {
                elsewhere = elsewhere.max(off);
            }
        }
    }
    println!("{seam} {elsewhere}");
    assert!(seam <= elsewhere, "{seam} {elsewhere}");
    assert!(elsewhere < 0.01, "{elsewhere}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_keypoint_may_be_the_first(seed in 0_u64..100_000, count in 3_usize..9, by in 1_usize..8) {
        let mut random = Random::new(seed);
        let by = by % count;
        let at = |i: usize| TAU * i as f64 / count as f64;
        let points: Vec<DVec3> = (0..count)
            .map(|i| DVec3::new(at(i).cos(), at(i).sin(), 0.0) * 0.2 + random.within(0.05))
            .collect();
        let tangents: Vec<DVec3> = (0..count)
            .map(|i| (DVec3::new(-at(i).sin(), at(i).cos(), 0.0) + random.within(0.4)).normalize())
            .collect();
        let from = |first: usize| Curve {
            points: (0..=count).map(|i| points[(first + i) % count]).collect(),
            tangents: (0..=count).map(|i| tangents[(first + i) % count]).collect(),
            closed: true,
        };
        let (a, b) = (fit(&from(0)), fit(&from(by)));
        prop_assert!(apart(&a.spline, &b.spline) < 1e-6, "{}", apart(&a.spline, &b.spline));
    }
}

#[test]
fn a_line_of_the_scaffold_is_followed_where_the_ring_begins_as_well() {
    let circle = ellipse(0.2, 0.2);
    let at = circle(0.0);
    let scaffold = Scaffold {
        lines: vec![Line::new(at - DVec3::Y * 0.1, at + DVec3::Y * 0.1)],
        ticks: vec![circle(0.25), circle(0.5), circle(0.75)],
    };
    for over in [0.0, 0.015, -0.015] {
        let (spline, keypoints) = closed(&drawn(circle, 0.0, over), &scaffold);
        assert_eq!(keypoints[0].point, at);
        assert!(keypoints[0].along_line, "{keypoints:?}");
        let first = spline.segments[0].0;
        assert!((first[1] - first[0]).angle_between(DVec3::Y) < 1e-9);
    }
}
