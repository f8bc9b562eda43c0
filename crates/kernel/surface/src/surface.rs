use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::IVec3;
use midair_field::{BrickCoord, Grid};
use midair_mesh::TriMesh;
use rayon::prelude::*;

use crate::mask::{Mask, bits};
use crate::piece::{Piece, Scratch};
use crate::region::{Region, SLOTS, corners, join};
use crate::table::TABLE;
use crate::weld;

/// The extraction was told to stop; the surface is what it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the extraction of the surface was cancelled")]
pub struct Cancelled;

/// Which chunk: it holds the 4³ bricks (32³ cells) from brick 4·(x, y, z). Sorted by z, y, x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ChunkKey {
    /// Along z.
    pub z: i32,
    /// Along y.
    pub y: i32,
    /// Along x.
    pub x: i32,
}

impl From<IVec3> for ChunkKey {
    fn from(c: IVec3) -> Self {
        Self {
            z: c.z,
            y: c.y,
            x: c.x,
        }
    }
}

impl From<ChunkKey> for IVec3 {
    fn from(k: ChunkKey) -> Self {
        Self::new(k.x, k.y, k.z)
    }
}

/// What is known of a chunk without building its mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Which one.
    pub key: ChunkKey,
    /// The [`Surface::generation`] in which its mesh last changed.
    pub version: u64,
    /// How many triangles; a chunk that became empty stays listed with none.
    pub triangles: usize,
}

/// The surface φ = 0 of a field, kept brick by brick so that an edit extracts again only what it
/// touched.
///
/// # Guarantees
///
/// For every content of the grid, [`Surface::mesh`] is closed, edge- and vertex-manifold and wound
/// counter-clockwise seen from outside; it has one vertex for each crossed grid edge and no
/// triangle without area. What counts as inside is decided node by node: a stored value that is
/// finite and at most −10⁻⁴ steps, or any node of an inside brick. Vertices stay a thousandth of a
/// step away from the nodes (more beyond 1000 steps from the origin, up to a quarter of a step,
/// where `f32` gets coarse), so that triangles keep an area in single precision. The result is
/// the same bytes on any number of threads and after any history of updates.
///
/// Triangles of one cell do not cross each other, and cells meet in their faces alone: the mesh
/// does not intersect itself beyond the rounding of `f32` coordinates. Sheets closer than a step
/// are not resolved: the field between its nodes is unknown.
///
/// ```
/// use midair_surface::{Surface, grid_from_fn};
///
/// let ball = grid_from_fn([32; 3], 0.01, f32::INFINITY, |p| p.distance(glam::Vec3::splat(0.155)) - 0.1);
/// let mesh = Surface::extract(&ball).mesh();
/// // Euler's formula for a sphere: V − E + F = 2 with 3F = 2E.
/// assert_eq!(2 * mesh.positions.len(), mesh.triangles.len() + 4);
/// ```
#[derive(Clone, Default)]
pub struct Surface {
    step: f32,
    chunks: BTreeMap<ChunkKey, Stored>,
    generation: u64,
}

/// A chunk's pieces.
#[derive(Clone)]
pub(crate) struct Stored {
    /// Shared between copies of a surface.
    pieces: Box<[Option<Arc<Piece>>; SLOTS]>,
    /// Vertices before each piece, then all of them.
    pub base: [u32; SLOTS + 1],
    /// Triangles of all pieces.
    pub triangles: usize,
    version: u64,
}

impl Default for Stored {
    fn default() -> Self {
        Self {
            pieces: Box::new([const { None }; SLOTS]),
            base: [0; SLOTS + 1],
            triangles: 0,
            version: 0,
        }
    }
}

impl Stored {
    #[inline]
    pub fn piece(&self, slot: usize) -> Option<&Piece> {
        self.pieces[slot].as_deref()
    }

    pub fn vertices(&self) -> usize {
        self.base[SLOTS] as usize
    }

    fn count(&mut self) {
        self.triangles = 0;
        for (s, piece) in self.pieces.iter().enumerate() {
            let vertices = piece.as_ref().map_or(0, |p| p.vertices());
            self.base[s + 1] = self.base[s] + vertices as u32;
            self.triangles += piece.as_ref().map_or(0, |p| p.triangles.len());
        }
    }
}

/// The bricks of one block that are to be extracted, as bits.
struct Job {
    block: IVec3,
    /// Bricks of which everything may change.
    all: u64,
    /// Bricks of which at most the normals change.
    normals: u64,
}

/// A block's new pieces by slot.
type Done = (IVec3, Vec<(usize, Option<Box<Piece>>)>);

impl Surface {
    /// The surface of a whole field.
    pub fn extract(grid: &Grid) -> Self {
        Self::extract_unless(grid, &AtomicBool::new(false)).unwrap_or_default()
    }

    /// As [`Surface::extract`], given up soon after `cancel` becomes true.
    ///
    /// # Errors
    ///
    /// [`Cancelled`].
    pub fn extract_unless(grid: &Grid, cancel: &AtomicBool) -> Result<Self, Cancelled> {
        let mut surface = Self {
            step: grid.step(),
            ..Self::default()
        };
        if !is_sound(grid.step()) {
            return Ok(surface);
        }
        let region = Region::whole(grid);
        let jobs: Vec<_> = region
            .candidates()
            .into_iter()
            .map(|block| Job {
                block,
                all: !0,
                normals: 0,
            })
            .collect();
        let done = surface.pieces(&region, &jobs, cancel)?;
        surface.commit(done);
        Ok(surface)
    }

    /// Follows an edit of the field: `changed` names every brick whose content is not what it was
    /// at the last extraction or update (more may be named, repeats do no harm). What results
    /// equals a full extraction of `grid`.
    pub fn update(&mut self, grid: &Grid, changed: &[BrickCoord]) {
        let never = AtomicBool::new(false);
        // Cannot be cancelled: nobody else holds the flag.
        let _ = self.update_unless(grid, changed, &never);
    }

    /// As [`Surface::update`], given up soon after `cancel` becomes true; the surface then stays
    /// as it was, and the next update must name these bricks again.
    ///
    /// # Errors
    ///
    /// [`Cancelled`].
    pub fn update_unless(
        &mut self,
        grid: &Grid,
        changed: &[BrickCoord],
        cancel: &AtomicBool,
    ) -> Result<(), Cancelled> {
        if grid.step() != self.step || !is_sound(grid.step()) {
            let fresh = Self::extract_unless(grid, cancel)?;
            self.step = grid.step();
            self.replace(fresh);
            return Ok(());
        }
        // A cell reads the nodes of its own brick and of those after it, and so does an edge; a
        // gradient reads those all around.
        let cells = Mask::of(changed).dilated(true, false);
        let touched = cells.dilated(false, true);
        let wanted = touched.dilated(true, true);
        let region = Region::part(grid, &wanted, &touched);
        let jobs: Vec<Job> = touched
            .blocks()
            .map(|(block, bits)| Job {
                block,
                all: cells.bits(block),
                normals: bits & !cells.bits(block),
            })
            .collect();
        let done = self.pieces(&region, &jobs, cancel)?;
        self.commit(done);
        Ok(())
    }

    fn pieces(
        &self,
        region: &Region,
        jobs: &[Job],
        cancel: &AtomicBool,
    ) -> Result<Vec<Done>, Cancelled> {
        let table = &*TABLE;
        let one = |scratch: &mut Scratch, job: &Job| -> Option<Done> {
            if cancel.load(Ordering::Relaxed) {
                return None;
            }
            let window = region.window(job.block);
            let old = self.chunks.get(&job.block.into());
            let mut found = Vec::new();
            for slot in bits(job.all | job.normals) {
                let at = join(job.block, slot);
                let l = at & 3;
                let before = old.and_then(|o| o.piece(slot));
                if job.all >> slot & 1 == 1 {
                    let now = scratch.extract(table, &window, l, at);
                    if now.as_deref() != before {
                        found.push((slot, now));
                    }
                } else if let Some(now) = before.and_then(|p| scratch.refresh(p, &window, l, at)) {
                    found.push((slot, Some(now)));
                }
            }
            Some((job.block, found))
        };
        jobs.par_iter()
            .map_init(Scratch::new, one)
            .collect::<Option<Vec<_>>>()
            .ok_or(Cancelled)
    }

    /// Puts new pieces in their places.
    fn commit(&mut self, done: Vec<Done>) {
        self.generation += 1;
        let mut stale = Vec::new();
        for (block, pieces) in done {
            if pieces.is_empty() {
                continue;
            }
            let stored = self.chunks.entry(block.into()).or_default();
            stored.version = self.generation;
            let mut low = IVec3::ONE;
            for (slot, piece) in pieces {
                low = low.min(join(IVec3::ZERO, slot));
                stored.pieces[slot] = piece.map(Arc::from);
            }
            stored.count();
            // The meshes of the chunks before repeat the vertices of this one's first bricks.
            stale.extend(
                corners()
                    .skip(1)
                    .filter(|d| (*d * low).cmpeq(IVec3::ZERO).all())
                    .map(|d| ChunkKey::from(block - d)),
            );
        }
        for key in stale {
            if let Some(stored) = self.chunks.get_mut(&key) {
                stored.version = self.generation;
            }
        }
    }

    /// Takes over another surface's pieces; all chunks of either count as changed.
    fn replace(&mut self, fresh: Self) {
        self.generation += 1;
        for stored in self.chunks.values_mut() {
            *stored = Stored::default();
        }
        self.chunks.extend(fresh.chunks);
        for stored in self.chunks.values_mut() {
            stored.version = self.generation;
        }
    }

    /// Metres between the nodes of the field.
    pub fn step(&self) -> f32 {
        self.step
    }

    /// Goes up with every extraction and update.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// How many triangles the whole surface has.
    pub fn triangles(&self) -> usize {
        self.chunks.values().map(|c| c.triangles).sum()
    }

    /// How many vertices the whole surface has.
    pub fn vertices(&self) -> usize {
        self.chunks.values().map(Stored::vertices).sum()
    }

    /// Bytes of memory in use.
    pub fn bytes(&self) -> usize {
        let chunk = |c: &Stored| {
            let pieces = c.pieces.iter().flatten().map(|p| p.bytes());
            size_of::<Stored>() + size_of_val(&*c.pieces) + pieces.sum::<usize>()
        };
        self.chunks.values().map(chunk).sum()
    }

    /// The whole surface as one welded mesh with unit normals.
    pub fn mesh(&self) -> TriMesh {
        weld::whole(&self.chunks)
    }

    /// All chunks, sorted by key.
    pub fn chunks(&self) -> impl Iterator<Item = Chunk> {
        self.chunks.iter().map(|(&key, c)| Chunk {
            key,
            version: c.version,
            triangles: c.triangles,
        })
    }

    /// The chunks whose mesh changed after `generation`, sorted by key.
    pub fn changed_since(&self, generation: u64) -> impl Iterator<Item = Chunk> {
        self.chunks().filter(move |c| c.version > generation)
    }

    /// One chunk's triangles as a mesh of its own: vertices on its border are repeated in the
    /// meshes of the chunks beside it, with the same position and normal. `None` where there is
    /// no surface.
    pub fn chunk_mesh(&self, key: ChunkKey) -> Option<TriMesh> {
        weld::chunk(&self.chunks, key)
    }
}

fn is_sound(step: f32) -> bool {
    step > 0.0 && step.is_finite()
}
