use std::collections::BTreeMap;

use glam::IVec3;
use midair_field::BRICK;
use midair_mesh::TriMesh;
use rayon::prelude::*;

use crate::mask::bits;
use crate::piece::Piece;
use crate::region::{SLOTS, corners, join, split};
use crate::surface::{ChunkKey, Stored};
use crate::table::EDGE_IDS;

type Chunks = BTreeMap<ChunkKey, Stored>;

/// The numbers of a piece's vertices in the mesh that is being put together.
#[derive(Clone, Copy)]
struct Numbered<'s> {
    piece: &'s Piece,
    /// The number of the first one.
    base: u32,
    part: Part,
    /// Numbered edges before each word.
    before: [[u16; BRICK]; 3],
}

/// The edges of a brick that lie on the low sides of it named by `side`: the ones that cells
/// before the brick use. All of them if `side` is zero.
#[derive(Clone, Copy)]
struct Part {
    side: IVec3,
    mask: u64,
    planes: usize,
}

impl Part {
    fn new(side: IVec3) -> Self {
        let x = if side.x == 1 {
            0x0101_0101_0101_0101
        } else {
            !0
        };
        let y = if side.y == 1 { 0xff } else { !0 };
        Self {
            side,
            mask: x & y,
            planes: if side.z == 1 { 1 } else { BRICK },
        }
    }

    /// The crossed edges of a piece in this part: axis, z, bits.
    fn words(self, piece: &Piece) -> impl Iterator<Item = (usize, usize, u64)> {
        (0..3)
            .filter(move |&a| self.side[a] == 0)
            .flat_map(move |a| {
                (0..self.planes).map(move |z| (a, z, piece.crossed[a][z] & self.mask))
            })
    }
}

impl<'s> Numbered<'s> {
    fn whole(piece: &'s Piece, base: u32) -> Self {
        Self {
            piece,
            base,
            part: Part::new(IVec3::ZERO),
            before: piece.before,
        }
    }

    /// Numbers nothing but a part; how many vertices that is.
    fn part(piece: &'s Piece, base: u32, side: IVec3) -> (Self, u32) {
        let part = Part::new(side);
        let mut before = [[0; BRICK]; 3];
        let mut count = 0;
        for (a, z, word) in part.words(piece) {
            before[a][z] = count;
            count += word.count_ones() as u16;
        }
        let numbered = Self {
            piece,
            base,
            part,
            before,
        };
        (numbered, u32::from(count))
    }

    /// Enters the numbers of the edges that the brick `d` before this one uses.
    fn enter(&self, map: &mut [u32; EDGE_IDS], d: IVec3) {
        let origin = (8 * d.x + 72 * d.y + 648 * d.z) as usize;
        let used = Part::new(d);
        for a in (0..3).filter(|&a| d[a] == 0) {
            for z in 0..used.planes {
                let all = self.piece.crossed[a][z] & self.part.mask;
                let mut word = all & used.mask;
                if word == 0 {
                    continue;
                }
                let to = a * 729 + origin + 81 * z;
                let mut next = self.base + u32::from(self.before[a][z]);
                // Without a gap the numbers just follow each other.
                let dense = word == all;
                while word != 0 {
                    let bit = word.trailing_zeros() as usize;
                    word &= word - 1;
                    let id = to + (bit & 7) + 9 * (bit >> 3);
                    if dense {
                        map[id] = next;
                        next += 1;
                    } else {
                        map[id] = next + (all & ((1 << bit) - 1)).count_ones();
                    }
                }
            }
        }
    }
}

/// The vertex numbers of a chunk's 4³ bricks and of those just after it, 5³ in all.
struct Numbers<'s>([Option<Numbered<'s>>; 125]);

impl<'s> Numbers<'s> {
    fn index(l: IVec3) -> usize {
        (l.x + 5 * l.y + 25 * l.z) as usize
    }

    /// All bricks of the neighbourhood that have a piece: place, chunk beside, slot.
    fn new(mut numbered: impl FnMut(IVec3, usize) -> Option<Numbered<'s>>) -> Self {
        let mut all = [None; 125];
        for (i, n) in all.iter_mut().enumerate() {
            let i = i as i32;
            let (side, slot) = split(IVec3::new(i % 5, i / 5 % 5, i / 25));
            *n = numbered(side, slot);
        }
        Self(all)
    }

    /// The triangles of the chunk's own bricks.
    fn triangles(
        &self,
        map: &mut [u32; EDGE_IDS],
        mut put: impl FnMut(&[[u16; 3]], &[u32; EDGE_IDS]),
    ) {
        for slot in 0..SLOTS {
            let l = join(IVec3::ZERO, slot);
            let Some(own) = &self.0[Self::index(l)] else {
                continue;
            };
            if own.piece.triangles.is_empty() {
                continue;
            }
            for d in corners().take(7) {
                if let Some(n) = &self.0[Self::index(l + d)] {
                    n.enter(map, d);
                }
            }
            put(&own.piece.triangles, map);
        }
    }
}

/// Everything in one mesh: chunks in order, their bricks in order, x, y and z edges in order.
pub(crate) fn whole(chunks: &Chunks) -> TriMesh {
    let mut starts = Vec::with_capacity(chunks.len());
    let (mut vertices, mut triangles) = (0, 0);
    for (&key, stored) in chunks {
        starts.push((key, stored, vertices as u32));
        vertices += stored.vertices();
        triangles += stored.triangles;
    }
    let mut mesh = TriMesh {
        positions: bytemuck::zeroed_vec(vertices),
        normals: bytemuck::zeroed_vec(vertices),
        triangles: bytemuck::zeroed_vec(triangles),
    };
    let (mut p, mut n, mut t) = (
        &mut mesh.positions[..],
        &mut mesh.normals[..],
        &mut mesh.triangles[..],
    );
    let mut parts = Vec::with_capacity(starts.len());
    for &(key, stored, _) in &starts {
        parts.push((
            key,
            stored,
            cut(&mut p, stored.vertices()),
            cut(&mut n, stored.vertices()),
            cut(&mut t, stored.triangles),
        ));
    }
    let beside = |key: ChunkKey| corners().map(move |d| ChunkKey::from(IVec3::from(key) + d));
    parts.into_par_iter().for_each_init(
        || vec![0; EDGE_IDS],
        |map, (key, stored, p, n, mut t)| {
            for (slot, at) in stored.base.windows(2).enumerate() {
                if let Some(piece) = stored.piece(slot) {
                    let range = at[0] as usize..at[1] as usize;
                    p[range.clone()].copy_from_slice(piece.positions());
                    n[range].copy_from_slice(piece.normals());
                }
            }
            let mut near = [None; 8];
            for (near, key) in near.iter_mut().zip(beside(key)) {
                let found = starts.binary_search_by_key(&key, |s| s.0);
                *near = found.ok().map(|i| (starts[i].1, starts[i].2));
            }
            let numbers = Numbers::new(|side, slot| {
                let (stored, start) = near[(side.x + 2 * side.y + 4 * side.z) as usize]?;
                Some(Numbered::whole(
                    stored.piece(slot)?,
                    start + stored.base[slot],
                ))
            });
            let Ok(map) = <&mut [u32; EDGE_IDS]>::try_from(&mut map[..]) else {
                return;
            };
            numbers.triangles(map, |from, map| {
                for (to, from) in cut(&mut t, from.len()).iter_mut().zip(from) {
                    *to = from.map(|id| map[id as usize]);
                }
            });
        },
    );
    mesh
}

/// One chunk's triangles with all vertices they use.
pub(crate) fn chunk(chunks: &Chunks, key: ChunkKey) -> Option<TriMesh> {
    let own = chunks.get(&key).filter(|c| c.triangles > 0)?;
    let mut mesh = TriMesh::default();
    let mut take = |range: std::ops::Range<usize>, piece: &Piece| {
        mesh.positions
            .extend_from_slice(&piece.positions()[range.clone()]);
        mesh.normals.extend_from_slice(&piece.normals()[range]);
    };
    for piece in (0..SLOTS).filter_map(|s| own.piece(s)) {
        take(0..piece.vertices(), piece);
    }
    let near: Vec<_> = corners()
        .map(|d| chunks.get(&ChunkKey::from(IVec3::from(key) + d)))
        .collect();
    let mut next = own.vertices() as u32;
    let numbers = Numbers::new(|side, slot| {
        let stored = near[(side.x + 2 * side.y + 4 * side.z) as usize]?;
        let piece = stored.piece(slot)?;
        if side == IVec3::ZERO {
            return Some(Numbered::whole(piece, stored.base[slot]));
        }
        let (numbered, count) = Numbered::part(piece, next, side);
        next += count;
        for (a, z, word) in numbered.part.words(piece) {
            for bit in bits(word) {
                let v = piece.rank(a, z, 1 << bit) as usize;
                take(v..v + 1, piece);
            }
        }
        Some(numbered)
    });
    let mut triangles = Vec::with_capacity(own.triangles);
    numbers.triangles(&mut [0; EDGE_IDS], |from, map| {
        triangles.extend(from.iter().map(|t| t.map(|id| map[id as usize])));
    });
    mesh.triangles = triangles;
    Some(mesh)
}

/// Takes the first `n` of a slice off it.
fn cut<'a, T>(slice: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    let (head, tail) = std::mem::take(slice).split_at_mut(n);
    *slice = tail;
    head
}
