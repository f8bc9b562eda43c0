//! Table 1 of the Hermite motion controller: the processor's time of one frame while the last curve of
//! a sweep is dragged.

use std::hint::black_box;

use glam::{DQuat, DVec3};
use midair_curve::{End, Lengths};
use midair_swept::{Net, Rib, Row};
use serde_json::json;

use crate::catalogue::BenchError;
use crate::figure::Details;
use crate::measure::{Budget, Times, repeat, timed};

/// One row of the table: points along a curve, curves, vertices of what is cloned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Subject {
    count: usize,
    ribs: usize,
    vertices: usize,
}

/// Curves that are sent anew each frame, at most: those of the last piece.
const PIECE: usize = 16;

impl Subject {
    pub const ALL: [Self; 4] = [
        Self::new(48, 271, 0),
        Self::new(48, 2131, 0),
        Self::new(64, 125, 240),
        Self::new(64, 644, 240),
    ];

    const fn new(count: usize, ribs: usize, vertices: usize) -> Self {
        Self {
            count,
            ribs,
            vertices,
        }
    }

    pub fn name(self) -> String {
        let clones = match self.vertices {
            0 => String::new(),
            p => format!("-p{p}"),
        };
        format!("sweep/n{}-m{}{clones}", self.count, self.ribs)
    }

    /// A frame of the paper's, milliseconds: with its two eyes, drawn on a Titan X.
    pub fn paper(self) -> f64 {
        let frames = match (self.ribs, self.vertices) {
            (271, _) => 116.0,
            (2131, _) => 114.0,
            (125, _) => 97.2,
            _ => 96.4,
        };
        1e3 / frames
    }
}

fn hands(at: usize) -> [End; 2] {
    let t = at as f64 * 0.0107;
    [-1.0, 1.0].map(|side: f64| End {
        position: DVec3::new(0.25 * side, 0.1 * (t * 3.0).sin(), -t),
        rotation: DQuat::from_rotation_z(-side * (0.6 + 0.3 * (t * 2.0).sin()))
            * DQuat::from_rotation_x(0.5 * t),
    })
}

/// What the mode does in a frame: Eq. 10 once, the curve with its frame and twist, the measure
/// against ε, the clones along it, and the net of what is sent.
fn frame(swept: &mut Vec<Rib>, lengths: &mut Lengths, at: usize, subject: Subject) -> usize {
    let [left, right] = hands(at);
    lengths.adapt(&left, &right);
    let before = swept.last().map_or(0.0, |r| f64::from(r.twist));
    let live = Rib::held(&left, &right, *lengths, [1.0, 0.6], before);
    if swept
        .last()
        .is_none_or(|r| r.apart(&live, subject.count) > 0.01)
    {
        swept.push(live);
    }
    let mut sent = 0;
    if subject.vertices > 0 {
        let row = Row {
            ribs: [live].into(),
            count: subject.count as u32,
            size: 1.0,
            paced: true,
        };
        sent += size_of_val(&black_box(row.places())[..]);
    }
    let piece = swept.len() / PIECE * PIECE;
    let mut last = swept[piece.saturating_sub(1)..].to_vec();
    last.push(live);
    sent + black_box(Net::new(&last, false, subject.count)).bytes()
}

pub(crate) fn run(subject: Subject, budget: &Budget) -> Result<(Times, Details), BenchError> {
    let mut lengths = Lengths::default();
    let [left, right] = hands(0);
    lengths.settle(&left, &right);
    let (mut swept, mut most, mut at) = (Vec::new(), 0, 0);
    while swept.len() < subject.ribs {
        most = frame(&mut swept, &mut lengths, at, subject).max(most);
        at += 1;
    }
    let mut details = Details::new();
    details.insert("bytes".into(), json!(most));
    details.insert(
        "clones".into(),
        json!(if subject.vertices > 0 {
            swept.len() * subject.count
        } else {
            0
        }),
    );
    let times = repeat(budget, || {
        // The same curve again and again: the surface stays as large as the table says.
        let took = timed(|| {
            let sent = frame(&mut swept, &mut lengths, at, subject);
            swept.truncate(subject.ribs);
            sent
        });
        Ok::<_, BenchError>(took.into())
    })?;
    Ok((times, details))
}
