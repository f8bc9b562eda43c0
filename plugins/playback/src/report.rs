use std::collections::BTreeMap;

use serde::Serialize;

use crate::SystemReport;

/// A frame of a headset at 90 Hz has so many milliseconds.
const FRAME_MS: f32 = 11.0;

/// What came of a session: the JSON of `--report`. Fields may be added, none renamed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// The session's title.
    pub title: String,
    /// Every object of the document.
    pub objects: Vec<ObjectReport>,
    /// Construction lines.
    pub lines: Vec<LineReport>,
    /// Shape strokes.
    pub strokes: Vec<StrokeReport>,
    /// Edits made.
    pub edits: usize,
    /// Steps that can be taken back.
    pub undo: usize,
    /// Steps that can be taken again.
    pub redo: usize,
    /// Every solid that was evaluated, in order.
    pub updates: Vec<UpdateReport>,
    /// Frames played.
    pub frames: u64,
    /// Steps played.
    pub steps: usize,
    /// Seconds of session time.
    pub seconds: f64,
    /// How long a frame's work took; waiting for background work is not in it.
    pub frame_ms: FrameTimes,
    /// How long the main schedule took, without extraction and without waiting for what is drawn; empty unless it was
    /// asked for.
    pub main_ms: FrameTimes,
    /// Where that time went, part by part of a frame; empty unless it was asked for.
    pub parts_ms: BTreeMap<String, FrameTimes>,
    /// What each system took, the costliest first; empty unless `MIDAIR_TIME_SYSTEMS` is set.
    pub systems: Vec<SystemReport>,
    /// What drawing each frame cost beside the main schedule; none unless it was asked for.
    pub drawn: Option<DrawnReport>,
    /// Seconds of processor time that the whole process took while it was played; none where the system does not say.
    pub cpu_seconds: Option<f64>,
    /// How long each preview took to make.
    pub preview_ms: FrameTimes,
    /// How far apart previews came while a hand moved an operand.
    pub preview_apart_ms: FrameTimes,
    /// Everything that could not be done, one line each.
    pub warnings: Vec<String>,
}

/// What drawing a frame cost, over a whole session without its first second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DrawnReport {
    /// From the main world into the render world, during which both stand still.
    pub extract_ms: FrameTimes,
    /// From the beginning to the end of a frame in the render world, waiting for the driver included.
    pub render_ms: FrameTimes,
    /// Processor time of the render world's thread in a frame; the driver's threads are not in it.
    pub render_cpu_ms: FrameTimes,
}

/// One object.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ObjectReport {
    /// Its number in the document.
    pub id: u64,
    /// What it is: "solid", "mesh" …
    pub kind: String,
    /// What people call it.
    pub name: String,
    /// Object to world, a 4×4 matrix column by column.
    pub transform: [f32; 16],
    /// Triangles of its surface.
    pub triangles: usize,
    /// m³ enclosed, in world size; none where it encloses nothing.
    pub volume: Option<f64>,
    /// Whether its surface is closed; none where it has none.
    pub closed: Option<bool>,
}

/// One construction line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LineReport {
    /// One end, in world metres.
    pub a: [f32; 3],
    /// The other.
    pub b: [f32; 3],
    /// How many constraints its correction kept.
    pub kept: usize,
}

/// One stroke.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct StrokeReport {
    /// Its points, in world metres.
    pub points: Vec<[f32; 3]>,
}

/// One evaluation of a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct UpdateReport {
    /// Recipe to field.
    pub fuse_ms: f64,
    /// Field to surface.
    pub extract_ms: f64,
    /// Triangles made.
    pub triangles: usize,
}

/// Milliseconds of a frame's work over a whole session; zero where no frame was played.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct FrameTimes {
    /// How many there are.
    pub count: usize,
    /// The fastest.
    pub min: f64,
    /// Half of them are faster.
    pub median: f64,
    /// 99 % are faster.
    pub p99: f64,
    /// 99.9 % are faster.
    pub p999: f64,
    /// The slowest.
    pub max: f64,
    /// The share, from 0 to 1, of those that took longer than 11 ms.
    pub over_11_ms: f64,
}

impl FrameTimes {
    /// The quantiles of `ms`, by nearest rank.
    pub fn of(mut ms: Vec<f32>) -> Self {
        ms.sort_by(f32::total_cmp);
        let at = |q: f64| {
            let rank = (q * ms.len() as f64).ceil() as usize;
            ms.get(rank.clamp(1, ms.len().max(1)) - 1)
                .copied()
                .map_or(0.0, f64::from)
        };
        let over = ms.iter().filter(|&&t| t > FRAME_MS).count();
        Self {
            count: ms.len(),
            over_11_ms: over as f64 / ms.len().max(1) as f64,
            min: at(0.0),
            median: at(0.5),
            p99: at(0.99),
            p999: at(0.999),
            max: at(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_of_the_right_rank() {
        let t = FrameTimes::of((1..=1000).map(|i| i as f32).collect());
        assert_eq!(
            (t.min, t.median, t.p99, t.p999, t.max),
            (1.0, 500.0, 990.0, 999.0, 1000.0)
        );
        assert_eq!((t.count, t.over_11_ms), (1000, 0.989));
        assert_eq!(FrameTimes::of(Vec::new()), FrameTimes::default());
    }
}
