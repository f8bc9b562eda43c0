use glam::Vec3;

use crate::Rib;

/// Ribs as lines, and lines from each to the next at every fourth point: what is shown of a sweep
/// while it is made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Net {
    /// Rib by rib.
    pub points: Vec<Vec3>,
    /// Two points for each line.
    pub lines: Vec<u32>,
}

/// Every so many points a line runs along the sweep.
const ALONG: usize = 4;

impl Net {
    /// The net of `ribs` with `count` points along each; `closed` ones are a tube's.
    pub fn new(ribs: &[Rib], closed: bool, count: usize) -> Self {
        let count = count.max(2);
        let mut points = Vec::new();
        for rib in ribs {
            if closed {
                rib.ring_into(count, &mut points);
            } else {
                rib.points_into(count, &mut points);
            }
        }
        let columns = (points.len() / ribs.len().max(1)).max(1);
        let mut lines = Vec::with_capacity(2 * points.len() + points.len() / 2);
        for j in 0..ribs.len() {
            let at = |i: usize| (j * columns + i % columns) as u32;
            let last = if closed { columns } else { columns - 1 };
            (0..last).for_each(|i| lines.extend([at(i), at(i + 1)]));
            if j > 0 {
                let marked = |i: &usize| i.is_multiple_of(ALONG) || (!closed && *i == columns - 1);
                let marks = (0..columns).filter(marked);
                marks.for_each(|i| lines.extend([at(i) - columns as u32, at(i)]));
            }
        }
        Self { points, lines }
    }

    /// The bytes it takes where it is drawn.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.points[..]) + size_of_val(&self.lines[..])
    }
}
