use std::fmt;

use serde::Serialize;

use crate::Aabb;

/// What [`crate::check`](crate::check()) found. Printed, it is one aligned line per fact and a verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// All vertices.
    pub vertices: usize,
    /// Vertices that no triangle uses; no fault.
    pub unused_vertices: usize,
    /// Triangles that could be looked at.
    pub triangles: usize,
    /// Triangles that could not: a corner is missing or not a number.
    pub unsound_triangles: usize,
    /// Edges, each counted once.
    pub edges: usize,
    /// Whether there are triangles and every edge has a partner for each of them.
    pub watertight: bool,
    /// Edges used an odd number of times.
    pub open_edges: usize,
    /// Whether no edge has more than two triangles.
    pub edge_manifold: bool,
    /// Edges with more than two triangles.
    pub crowded_edges: usize,
    /// Whether the triangles at each vertex form one fan.
    pub vertex_manifold: bool,
    /// Vertices where several fans meet.
    pub pinched_vertices: usize,
    /// Whether the triangles at each edge run along it in opposite directions.
    pub consistently_wound: bool,
    /// Edges that are run along more often one way than the other, open ones aside.
    pub miswound_edges: usize,
    /// Whether the volume is positive: triangles wind counter-clockwise seen from outside.
    pub outward: bool,
    /// Closed pieces that wind inwards although no other piece surrounds them.
    pub inside_out_pieces: usize,
    /// Triangles with the same three corners as one before, whichever way they run.
    pub duplicate_faces: usize,
    /// Triangles that f32 cannot tell from a line: their height over their longest side is at most
    /// 2⁻²⁴ of their largest coordinate.
    pub degenerate_faces: usize,
    /// Pairs of triangles that meet elsewhere than in the corners they share, by exact arithmetic:
    /// without a common corner, any touch; with one, a second common point; with two, one lying on
    /// the other.
    pub self_touching: usize,
    /// Whether all pairs were looked at; if not, there are at least [`Self::self_touching`].
    pub self_touching_complete: bool,
    /// The first few of those pairs, as numbers of triangles.
    pub self_touching_pairs: Vec<[u32; 2]>,
    /// Pieces that hang together by edges.
    pub pieces: usize,
    /// Vertices used − edges + triangles.
    pub euler: i64,
    /// Handles of all pieces together; only a closed and manifold mesh has a genus.
    pub genus: Option<i64>,
    /// The enclosed volume in m³; without meaning where the mesh is open.
    pub volume: f64,
    /// The area in m².
    pub area: f64,
    /// The box around all triangles, in metres.
    pub bounds: Aabb,
}

impl Report {
    /// What is wrong, one clause each; empty for the boundary of a solid.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let mut fault = |n: usize, one: &str, many: &str| {
            if n > 0 {
                faults.push(format!("{n} {}", if n == 1 { one } else { many }));
            }
        };
        fault(
            usize::from(self.triangles == 0),
            "mesh without triangles",
            "",
        );
        fault(
            self.unsound_triangles,
            "triangle without three places",
            "triangles without three places",
        );
        fault(self.open_edges, "open edge", "open edges");
        fault(
            self.crowded_edges,
            "edge with more than two triangles",
            "edges with more than two triangles",
        );
        fault(
            self.pinched_vertices,
            "vertex where surfaces meet in a point",
            "vertices where surfaces meet in a point",
        );
        fault(
            self.miswound_edges,
            "edge between triangles that face opposite ways",
            "edges between triangles that face opposite ways",
        );
        fault(
            self.inside_out_pieces,
            "piece turned inside out",
            "pieces turned inside out",
        );
        fault(self.duplicate_faces, "duplicate face", "duplicate faces");
        fault(
            self.degenerate_faces,
            "face without area",
            "faces without area",
        );
        fault(
            self.self_touching,
            "pair of faces that touch or cross",
            "pairs of faces that touch or cross",
        );
        if self.watertight && !self.outward && self.inside_out_pieces == 0 {
            faults.push("no positive volume".into());
        }
        if !self.self_touching_complete {
            faults.push("touching faces without end, the count is a part of them".into());
        }
        faults
    }

    /// Whether [`Self::faults`] is empty.
    pub fn is_faultless(&self) -> bool {
        self.faults().is_empty()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fact = |name: &str, value: String| writeln!(f, "{name:<20}{value}");
        let yes = |holds: bool, n: usize, what: &str| match holds {
            true => "yes".to_owned(),
            false if n == 0 => "no".to_owned(),
            false => format!("no ({n} {what})"),
        };
        let unused = match self.unused_vertices {
            0 => String::new(),
            n => format!(" ({n} unused)"),
        };
        let least = if self.self_touching_complete {
            ""
        } else {
            "at least "
        };
        fact("vertices", format!("{}{unused}", self.vertices))?;
        fact("triangles", self.triangles.to_string())?;
        fact(
            "watertight",
            yes(self.watertight, self.open_edges, "open edges"),
        )?;
        fact(
            "edge-manifold",
            yes(
                self.edge_manifold,
                self.crowded_edges,
                "edges with more than two triangles",
            ),
        )?;
        fact(
            "vertex-manifold",
            yes(
                self.vertex_manifold,
                self.pinched_vertices,
                "pinched vertices",
            ),
        )?;
        fact(
            "consistently wound",
            yes(self.consistently_wound, self.miswound_edges, "edges"),
        )?;
        fact(
            "outward",
            yes(
                self.outward && self.inside_out_pieces == 0,
                self.inside_out_pieces,
                "pieces inside out",
            ),
        )?;
        fact("duplicate faces", self.duplicate_faces.to_string())?;
        fact("degenerate faces", self.degenerate_faces.to_string())?;
        fact(
            "self-touching",
            format!("{least}{} pairs", self.self_touching),
        )?;
        fact("pieces", self.pieces.to_string())?;
        fact(
            "genus",
            self.genus.map_or("-".into(), |genus| genus.to_string()),
        )?;
        fact("volume", format!("{} m³", significant(self.volume)))?;
        fact("area", format!("{} m²", significant(self.area)))?;
        if !self.bounds.is_empty() {
            let [x, y, z] = self.bounds.size().to_array();
            let (min, max) = (self.bounds.min, self.bounds.max);
            let mm = [x, y, z].map(|v| length(1000.0 * v));
            fact(
                "size",
                format!("{} × {} × {} m", length(x), length(y), length(z)),
            )?;
            fact("", format!("{} × {} × {} mm", mm[0], mm[1], mm[2]))?;
            let corner = |p: glam::Vec3| p.to_array().map(length).join(" ");
            fact("bounds", format!("{} to {}", corner(min), corner(max)))?;
        }
        let faults = self.faults();
        match faults.len() {
            0 => write!(f, "{:<20}no fault found", "verdict"),
            1 => write!(f, "{:<20}1 fault: {}", "verdict", faults[0]),
            n => write!(f, "{:<20}{n} faults: {}", "verdict", faults.join("; ")),
        }
    }
}

/// `x` with six significant digits and no zeros at the end: what is beyond them is the file's own rounding.
fn length(x: f32) -> String {
    let digits = 5 - x.abs().max(f32::MIN_POSITIVE).log10().floor() as i32;
    let text = format!("{x:.*}", digits.clamp(0, 12) as usize);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// `x` with seven significant digits.
fn significant(x: f64) -> String {
    match x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        true => {
            let digits = (6 - x.abs().max(1e-4).log10().floor() as i32).clamp(0, 12) as usize;
            format!("{x:.digits$}")
        }
        false => format!("{x:.6e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::length;

    #[test]
    fn lengths_have_no_noise() {
        for (x, text) in [
            (0.299_999_98, "0.3"),
            (0.399_98, "0.39998"),
            (-400.0, "-400"),
            (0.0, "0"),
            (123_456.7, "123457"),
            (1.5e-5, "0.000015"),
        ] {
            assert_eq!(length(x), text);
        }
    }
}
