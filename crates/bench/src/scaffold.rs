//! ScaffoldSketch's corrections: a line into a scene of lines, a stroke through keypoints (§4).

use glam::DVec3;
use midair_beautify::stroke::{Curve, fit};
use midair_beautify::{Line, LineOptions, Scaffold, correct_line};
use serde_json::json;

use crate::catalogue::BenchError;
use crate::figure::Details;
use crate::measure::{Budget, Times, repeat, timed};

/// One correction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Subject {
    /// Into 45 lines, near to few of them.
    Few,
    /// Into 45 lines, between corners.
    Many,
    /// Into 500 lines, between corners.
    Crowd,
    /// A circle through four keypoints.
    Circle,
    /// An open curve through so many.
    Open(usize),
}

impl Subject {
    pub const ALL: [Self; 6] = [
        Self::Few,
        Self::Many,
        Self::Crowd,
        Self::Circle,
        Self::Open(9),
        Self::Open(10),
    ];

    pub fn name(self) -> String {
        match self {
            Self::Few => "scaffold/line-45/few".into(),
            Self::Many => "scaffold/line-45/many".into(),
            Self::Crowd => "scaffold/line-500".into(),
            Self::Circle => "scaffold/stroke/circle".into(),
            Self::Open(n) => format!("scaffold/stroke/{n}"),
        }
    }

    /// §4.1 and §4.2.2, milliseconds.
    pub fn paper(self) -> Option<f64> {
        match self {
            Self::Few => Some(200.0),
            Self::Many => Some(1_100.0),
            Self::Crowd => None,
            Self::Circle => Some(50.0),
            Self::Open(_) => Some(1_000.0),
        }
    }
}

pub(crate) fn run(subject: Subject, budget: &Budget) -> Result<(Times, Details), BenchError> {
    let mut details = Details::new();
    let times = match subject {
        Subject::Few | Subject::Many | Subject::Crowd => {
            let count = if subject == Subject::Crowd { 500 } else { 45 };
            let scene = scene(count);
            let drawn = match subject {
                // Upright, away from everything.
                Subject::Few => line([2.0, 0.0, 2.0], [2.02, 0.57, 2.01]),
                // The other upright edge of the last box but one.
                _ => {
                    let edge = scene.lines[count - 12];
                    let off = DVec3::new(0.012, -0.01, 0.009);
                    Line::new(edge.a + off, edge.b - off)
                }
            };
            let options = LineOptions::default();
            let out = correct_line(&drawn, &scene, &options);
            details.insert("lines".into(), json!(count));
            details.insert("kept".into(), json!(out.kept.len()));
            details.insert("dropped".into(), json!(out.dropped.len()));
            repeat(budget, || {
                let took = timed(|| correct_line(&drawn, &scene, &options));
                Ok::<_, BenchError>(took.into())
            })?
        }
        Subject::Circle | Subject::Open(_) => {
            let curve = match subject {
                Subject::Open(n) => spiral(n),
                _ => circle(),
            };
            let fitted = fit(&curve);
            details.insert("keypoints".into(), json!(curve.points.len()));
            details.insert("steps".into(), json!(fitted.steps));
            details.insert("variation".into(), json!(fitted.variation));
            repeat(budget, || {
                let took = timed(|| fit(&curve));
                Ok::<_, BenchError>(took.into())
            })?
        }
    };
    Ok((times, details))
}

fn line(a: [f64; 3], b: [f64; 3]) -> Line {
    Line::new(DVec3::from_array(a), DVec3::from_array(b))
}

/// Boxes of different sides beside each other, the last of them not finished.
fn scene(count: usize) -> Scaffold {
    const EDGES: [(usize, usize); 12] = [
        (0, 1),
        (1, 3),
        (3, 2),
        (2, 0),
        (4, 5),
        (5, 7),
        (7, 6),
        (6, 4),
        (0, 4),
        (1, 5),
        (3, 7),
        (2, 6),
    ];
    let boxes = (0..).map(|i| {
        let i = f64::from(i);
        let corner = DVec3::new(0.62 * (i % 6.0), 0.0, 0.55 * (i / 6.0).floor());
        let sides = DVec3::new(0.3 + 0.02 * (i % 5.0), 0.4 + 0.03 * (i % 3.0), 0.25);
        (corner, sides)
    });
    let lines = boxes.flat_map(|(corner, sides)| {
        let at = move |k: usize| {
            let k = [k & 1, k >> 2 & 1, k >> 1 & 1].map(|b| b as f64);
            corner + sides * DVec3::from_array(k)
        };
        EDGES.map(|(a, b)| Line::new(at(a), at(b)))
    });
    Scaffold {
        lines: lines.take(count).collect(),
        ticks: Vec::new(),
    }
}

fn circle() -> Curve {
    let at = |i: i32| (f64::from(i) * std::f64::consts::FRAC_PI_2).sin_cos();
    Curve {
        points: (0..=4).map(|i| DVec3::new(at(i).1, at(i).0, 0.0)).collect(),
        tangents: (0..=4)
            .map(|i| DVec3::new(-at(i).0, at(i).1, 0.0))
            .collect(),
        closed: true,
    }
}

/// A spiral that is bent here and there, with tangents that are not quite its own.
fn spiral(keypoints: usize) -> Curve {
    let points: Vec<DVec3> = (0..keypoints)
        .map(|i| {
            let i = i as f64;
            let a = 3.2 * std::f64::consts::PI * i / (keypoints - 1) as f64;
            let wide = 1.0 + 0.3 * (5.1 * i).sin();
            DVec3::new(wide * a.cos(), a.sin(), 0.25 * a + 0.2 * (3.7 * i).cos())
        })
        .collect();
    let tangents = (0..keypoints)
        .map(|i| {
            let (from, to) = (i.saturating_sub(1), (i + 1).min(keypoints - 1));
            let off = 0.25 * DVec3::new((2.3 * i as f64).sin(), (4.1 * i as f64).cos(), 0.3);
            (0.5 * (points[to] - points[from]) + off).normalize()
        })
        .collect();
    Curve {
        points,
        tangents,
        closed: false,
    }
}
