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
        let mut points = Vec::new();
        for rib in ribs {
            Self::row_into(rib, closed, count, &mut points);
        }
        Self::through(points, ribs.len(), closed)
    }

    /// The points of one rib in a net.
    pub fn row_into(rib: &Rib, closed: bool, count: usize, points: &mut Vec<Vec3>) {
        let count = count.max(2);
        if closed {
            rib.ring_into(count, points);
        } else {
            rib.points_into(count, points);
        }
    }

    /// The net through points that are known already, those of one rib after those of another: what
    /// was swept a frame ago need not be measured again.
    pub fn through(points: Vec<Vec3>, ribs: usize, closed: bool) -> Self {
        let columns = (points.len() / ribs.max(1)).max(1);
        let mut lines = Vec::with_capacity(2 * points.len() + points.len() / 2);
        for j in 0..ribs {
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
