use glam::Vec3;
use midair_mesh::TriMesh;
use rayon::prelude::*;

use super::find::{Edge, Foot, Sampler};
use super::moved::Moved;
use super::{ascending, sides};

/// An edge of the mesh that is split in two.
pub(super) struct Split {
    /// In ascending order.
    pub ends: [u32; 2],
    pub edge: Edge,
}

/// A triangle that is cut: what it falls into.
struct Pieces {
    /// Of which triangle.
    of: u32,
    /// In it, those of the splits' vertices and the tip are numbered on from those of the mesh.
    triangles: Vec<[u32; 3]>,
    /// Where three sides meet in the middle of it, and the normal there.
    tip: Option<(Vec3, Vec3)>,
    /// Whether none is turned over or without area.
    fits: bool,
}

/// Stands for the vertex at the tip.
const TIP: u32 = u32::MAX;

/// The mesh as it is cut along its edges.
pub(super) struct Cut<'m> {
    pub mesh: &'m TriMesh,
    pub moved: &'m Moved,
    pub sampler: &'m Sampler<'m>,
}

/// What came of cutting.
pub(super) struct Sharp {
    pub mesh: TriMesh,
    /// Triangles of it that were not there before, in order.
    pub changed: Vec<u32>,
    /// Of each triangle that was cut, its number, that of its first piece, and how many these are; in order.
    cuts: Vec<[u32; 3]>,
}

impl Sharp {
    /// The triangle of which one is a piece.
    pub fn origin(&self, t: u32) -> u32 {
        let before = self.cuts.partition_point(|&[_, first, _]| first <= t);
        match before.checked_sub(1).map(|i| self.cuts[i]) {
            None => t,
            Some([was, first, many]) if t < first + many => was,
            Some([was, first, many]) => was + 1 + (t - first - many),
        }
    }
}

impl Cut<'_> {
    /// Cut along `splits`, after those are dropped that would turn a piece over.
    pub fn settled(&self, splits: &mut Vec<Split>) -> Sharp {
        let mut cuts: Vec<Pieces> = self
            .moved
            .touched
            .par_iter()
            .filter_map(|&t| self.pieces(t, splits))
            .collect();
        loop {
            let mut bad: Vec<[u32; 2]> = cuts
                .iter()
                .filter(|cut| !cut.fits)
                .flat_map(|cut| sides(self.mesh.triangles[cut.of as usize]))
                .map(ascending)
                .collect();
            if bad.is_empty() {
                return self.put_together(splits, cuts);
            }
            bad.sort_unstable();
            let is_bad = |side: [u32; 2]| bad.binary_search(&ascending(side)).is_ok();
            // Splits are numbered by their places: those after one that is dropped move up.
            let mut places = vec![0; splits.len()];
            let mut left = 0;
            for (place, split) in places.iter_mut().zip(splits.iter()) {
                *place = left;
                left += u32::from(!is_bad(split.ends));
            }
            let had = splits.len();
            splits.retain(|s| !is_bad(s.ends));
            let first = self.mesh.positions.len() as u32;
            cuts = cuts
                .into_par_iter()
                .filter_map(|mut cut| {
                    if sides(self.mesh.triangles[cut.of as usize]).any(is_bad) {
                        return self.pieces(cut.of, splits);
                    }
                    for v in cut.triangles.as_flattened_mut() {
                        if *v >= first && ((*v - first) as usize) < had {
                            *v = first + places[(*v - first) as usize];
                        }
                    }
                    Some(cut)
                })
                .collect();
        }
    }

    /// The whole mesh: pieces stand where the triangle was that they are of.
    fn put_together(&self, splits: &[Split], cuts: Vec<Pieces>) -> Sharp {
        let mut mesh = TriMesh {
            positions: self.moved.positions.clone(),
            normals: self.moved.normals.clone(),
            triangles: Vec::with_capacity(self.mesh.triangles.len() + 5 * cuts.len()),
        };
        for s in splits {
            mesh.positions.push(s.edge.at);
            mesh.normals.push(self.normal(s));
        }
        let (mut changed, mut list) = (Vec::new(), Vec::with_capacity(cuts.len()));
        let mut cuts = cuts.into_iter().peekable();
        let mut copied = 0;
        for &t in &self.moved.touched {
            let corners = self.mesh.triangles[t as usize];
            let Some(cut) = cuts.next_if(|cut| cut.of == t) else {
                let is_moved = |&v: &u32| {
                    let v = v as usize;
                    self.moved.positions[v] != self.mesh.positions[v]
                };
                if corners.iter().any(is_moved) {
                    let before = mesh.triangles.len() as u32;
                    changed.push(before + (t - copied));
                }
                continue;
            };
            let until = &self.mesh.triangles[copied as usize..t as usize];
            mesh.triangles.extend_from_slice(until);
            copied = t + 1;
            let first = mesh.triangles.len() as u32;
            let tip = mesh.positions.len() as u32;
            if let Some((at, normal)) = cut.tip {
                mesh.positions.push(at);
                mesh.normals.push(normal);
            }
            let named = |v: u32| if v == TIP { tip } else { v };
            let pieces = cut.triangles.iter().map(|piece| piece.map(named));
            mesh.triangles.extend(pieces);
            let many = cut.triangles.len() as u32;
            changed.extend(first..first + many);
            list.push([t, first, many]);
        }
        let rest = &self.mesh.triangles[copied as usize..];
        mesh.triangles.extend_from_slice(rest);
        Sharp {
            mesh,
            changed,
            cuts: list,
        }
    }

    fn normal(&self, split: &Split) -> Vec3 {
        let [a, b] = split.edge.normals;
        (a + b).try_normalize().unwrap_or(a)
    }

    /// What a triangle falls into; `None` where none of its sides is split.
    fn pieces(&self, of: u32, splits: &[Split]) -> Option<Pieces> {
        let t = self.mesh.triangles[of as usize];
        let first = self.mesh.positions.len() as u32;
        let [a, b, c] = t;
        let on = [[a, b], [b, c], [c, a]].map(|side| {
            let at = splits.binary_search_by_key(&ascending(side), |s| s.ends);
            at.ok().map(|at| first + at as u32)
        });
        if on == [None; 3] {
            return None;
        }
        let (triangles, tip) = self.parts(t, on, splits);
        let place = |v: u32| match (v, tip) {
            (TIP, Some((at, _))) => at,
            _ => self.place(v, splits),
        };
        let fits = |piece: &[u32; 3]| {
            let p = piece.map(place);
            let face = (p[1] - p[0]).cross(p[2] - p[0]);
            // What belongs to a side looks as that side does.
            face.length() > self.sampler.least()
                && piece
                    .iter()
                    .filter(|&&v| v < first)
                    .all(|&v| face.dot(self.moved.normals[v as usize]) > 0.0)
        };
        Some(Pieces {
            of,
            fits: triangles.iter().all(fits),
            triangles,
            tip,
        })
    }

    fn place(&self, v: u32, splits: &[Split]) -> Vec3 {
        match (v as usize).checked_sub(self.mesh.positions.len()) {
            None => self.moved.positions[v as usize],
            Some(split) => splits[split].edge.at,
        }
    }

    /// The pieces of one triangle whose sides are split at `on`: that from its first corner to the
    /// second, and so on.
    fn parts(
        &self,
        t: [u32; 3],
        on: [Option<u32>; 3],
        splits: &[Split],
    ) -> (Vec<[u32; 3]>, Option<(Vec3, Vec3)>) {
        // Turned so that a case need be written once.
        let turn = |k: usize| {
            let at = |i: usize| (i + k) % 3;
            ([0, 1, 2].map(|i| t[at(i)]), [0, 1, 2].map(|i| on[at(i)]))
        };
        for k in 0..3 {
            match turn(k) {
                ([a, b, c], [Some(m), None, None]) => {
                    return (vec![[a, m, c], [m, b, c]], None);
                }
                ([a, b, c], [Some(m), None, Some(k)]) => {
                    let p = |v: u32| self.place(v, splits);
                    let short = p(m).distance_squared(p(c)) < p(b).distance_squared(p(k));
                    let rest = if short {
                        [[m, b, c], [m, c, k]]
                    } else {
                        [[m, b, k], [b, c, k]]
                    };
                    return (vec![[a, m, k], rest[0], rest[1]], None);
                }
                _ => {}
            }
        }
        let ([a, b, c], [Some(ab), Some(bc), Some(ca)]) = (t, on) else {
            return (vec![t], None);
        };
        let foot = |v: u32| Foot {
            at: self.moved.positions[v as usize],
            normal: self.moved.normals[v as usize],
            edge: false,
        };
        let Some(at) = self.sampler.corner([a, b, c].map(foot)) else {
            let whole = vec![[a, ab, ca], [ab, b, bc], [bc, c, ca], [ab, bc, ca]];
            return (whole, None);
        };
        let normal = [a, b, c].map(|v| foot(v).normal).iter().sum::<Vec3>();
        let normal = normal.try_normalize().unwrap_or(foot(a).normal);
        let ring = [a, ab, b, bc, c, ca];
        let fan = (0..6).map(|i| [ring[i], ring[(i + 1) % 6], TIP]);
        (fan.collect(), Some((at, normal)))
    }
}
