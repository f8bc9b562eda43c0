use glam::Vec3;
use rayon::prelude::*;
use std::collections::HashMap;

use crate::TriMesh;
use crate::read::ReadReason;
use crate::rescale::{bits, rescaled};

/// More triangles than this are refused rather than read.
pub(crate) const MAX_TRIANGLES: usize = 50_000_000;

/// Triangles as a file has them, before their vertices are joined.
#[derive(Default)]
pub(crate) struct Soup {
    pub positions: Vec<Vec3>,
    /// As many as positions, or none.
    pub normals: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    pub warnings: Vec<String>,
}

impl Soup {
    /// Joins vertices of bitwise equal position (-0 is 0), drops what is no triangle and what is
    /// there twice, and brings lengths to metres by `factor`.
    pub fn weld(mut self, factor: f64) -> Result<(TriMesh, Vec<String>), ReadReason> {
        if self.triangles.is_empty() {
            return Err(ReadReason::NoFaces);
        }
        if self.triangles.len() > MAX_TRIANGLES {
            return Err(ReadReason::TooManyTriangles);
        }
        if let Some(vertex) = self.positions.iter().position(|p| !p.is_finite()) {
            return Err(ReadReason::NotFinite { vertex });
        }
        let n = self.positions.len();
        let mut used = vec![false; n];
        for (triangle, corners) in self.triangles.iter().enumerate() {
            for &v in corners {
                *used
                    .get_mut(v as usize)
                    .ok_or(ReadReason::IndexOutOfRange {
                        triangle,
                        vertex: v,
                        vertices: n,
                    })? = true;
            }
        }
        let mut places = HashMap::with_capacity(n.min(self.triangles.len()));
        let mut renamed = vec![0_u32; n];
        let mut kept = Vec::new();
        for (v, &p) in self.positions.iter().enumerate().filter(|&(v, _)| used[v]) {
            renamed[v] = *places.entry(bits(p)).or_insert_with(|| {
                kept.push(p + 0.0);
                (kept.len() - 1) as u32
            });
        }
        drop(places);
        let normals = joined_normals(&self.normals, &renamed, &used, kept.len());
        for triangle in &mut self.triangles {
            *triangle = triangle.map(|v| renamed[v as usize]);
        }
        let before = self.triangles.len();
        self.triangles
            .retain(|&[a, b, c]| a != b && b != c && c != a);
        let collapsed = before - self.triangles.len();
        let repeated = drop_repeated(&mut self.triangles);
        if self.triangles.is_empty() {
            return Err(ReadReason::NoArea);
        }
        let mut warnings = self.warnings;
        if collapsed > 0 {
            warnings.push(format!(
                "{collapsed} triangles name one corner twice and were left out"
            ));
        }
        if repeated > 0 {
            warnings.push(format!(
                "{repeated} triangles are there more than once and were kept once"
            ));
        }
        let positions = rescaled(&kept, factor).ok_or(ReadReason::TooLarge)?;
        Ok((
            TriMesh {
                positions,
                normals,
                triangles: self.triangles,
            },
            warnings,
        ))
    }
}

/// One normal per joined vertex, where all that were joined agree; else none, since a hard edge
/// has no single normal.
fn joined_normals(normals: &[Vec3], renamed: &[u32], used: &[bool], kept: usize) -> Vec<Vec3> {
    if normals.len() != renamed.len() {
        return Vec::new();
    }
    let mut joined = vec![Vec3::ZERO; kept];
    for ((&normal, &v), _) in normals
        .iter()
        .zip(renamed)
        .zip(used)
        .filter(|&(_, &used)| used)
    {
        let Some(unit) = normal.is_finite().then(|| normal.try_normalize()).flatten() else {
            return Vec::new();
        };
        // A normal that already has length one is kept as it is, bit for bit.
        let unit = if normal.is_normalized() { normal } else { unit };
        let known = &mut joined[v as usize];
        if *known == Vec3::ZERO {
            *known = unit;
        } else if known.dot(unit) < 0.9999 {
            return Vec::new();
        }
    }
    joined
}

/// Keeps the first of triangles with the same corners in the same turn; returns how many went.
fn drop_repeated(triangles: &mut Vec<[u32; 3]>) -> usize {
    let mut sorted: Vec<([u32; 3], u32)> = triangles
        .par_iter()
        .enumerate()
        .map(|(t, &[a, b, c])| {
            let least = a.min(b).min(c);
            let turned = if least == a {
                [a, b, c]
            } else if least == b {
                [b, c, a]
            } else {
                [c, a, b]
            };
            (turned, t as u32)
        })
        .collect();
    sorted.par_sort_unstable();
    let mut again: Vec<u32> = sorted
        .windows(2)
        .filter(|pair| pair[0].0 == pair[1].0)
        .map(|pair| pair[1].1)
        .collect();
    if again.is_empty() {
        return 0;
    }
    again.sort_unstable();
    let mut next = again.iter().peekable();
    let mut t = 0;
    triangles.retain(|_| {
        let drop = next.next_if(|&&again| again == t).is_some();
        t += 1;
        !drop
    });
    again.len()
}
