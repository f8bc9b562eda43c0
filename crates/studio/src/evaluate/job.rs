use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

use bevy::math::bounding::Aabb3d;
use bevy::prelude::*;
use bevy_mod_outline::ATTRIBUTE_OUTLINE_NORMAL;
use bevy_rapier3d::rapier::prelude::{Pose, SharedShape, TriMesh as Trimesh, TriMeshFlags};
use midair_field::Placement;
use midair_field::Recipe;
use midair_field::bake::Progress;
use midair_field::{Node, Place, Sweep};
use midair_library::Volumes;
use midair_mesh::{Aabb, TriMesh};
use midair_solid::{Clones, Solid, SolidError, clones, own_surface};

use super::backend::{Asked, Backend};
use super::early::Early;
use super::{Key, Update};
use crate::show::{outward, to_bevy_mesh};

/// A solid, made.
pub struct Made {
    /// The whole surface, closed and welded, in the recipe's own frame. Of a row of clones, that of
    /// one of them; of an open sweep, the surface that it is.
    pub mesh: Arc<TriMesh>,
    /// A box around that.
    pub bounds: Aabb,
    /// Where the clones of a row stand.
    pub places: Option<Arc<[Place]>>,
    /// Of a row of very many clones, the surfaces of all of them in a few pieces, ready to be drawn;
    /// taken by the first that draws them.
    pub(crate) pieces: std::sync::Mutex<Vec<Mesh>>,
    /// The same, ready to be drawn; taken by the first that draws it.
    pub(crate) drawn: std::sync::Mutex<Option<Mesh>>,
    look: Look,
    /// The same, ready to be picked; `None` where the solid is empty.
    pub shape: Option<SharedShape>,
    /// Milliseconds to fuse and to extract.
    pub fuse_ms: f64,
    /// Milliseconds to extract.
    pub extract_ms: f64,
    /// Enclosed volume in cubic metres.
    pub volume: f64,
    /// Field and surface of a painting, from which it is made again where a stroke changed it.
    pub solid: Option<Arc<Solid>>,
    /// Bytes held, about.
    pub bytes: usize,
}

/// What makes a drawing of a mesh.
enum Look {
    /// The mesh as it is.
    Smooth,
    /// Parted at the vertices from this one on, which lie on its sharp edges.
    Edged(usize),
    /// With these places on a picture.
    Pictured(Vec<Vec2>),
    /// Creased where it is sharp, with these places on a picture.
    Creased(Vec<Vec2>),
}

/// With its box, which otherwise each thing that is drawn as it would look for in all of its corners.
fn boxed(mut mesh: Mesh, bounds: Aabb) -> Mesh {
    mesh.final_aabb = (!bounds.is_empty()).then(|| Aabb3d::from_min_max(bounds.min, bounds.max));
    mesh
}

impl Made {
    /// As the report counts it.
    pub fn update(&self) -> Update {
        Update {
            fuse_ms: self.fuse_ms,
            extract_ms: self.extract_ms,
            triangles: self.mesh.triangles.len(),
        }
    }

    /// A row of clones.
    fn from_clones(clones: Clones) -> Self {
        let one = Self::from_mesh(clones.mesh);
        let pieces = if clones.places.len() > ONE_BY_ONE {
            merged(&one.mesh, &clones.places)
        } else {
            Vec::new()
        };
        let volume = clones.places.iter().map(|p| f64::from(p.scale).powi(3));
        Self {
            volume: one.volume * volume.sum::<f64>(),
            shape: boxes(&one.mesh, &clones.places),
            bytes: one.bytes
                + clones.places.len() * 192
                + pieces
                    .iter()
                    .map(|p| p.count_vertices() * 60)
                    .sum::<usize>(),
            pieces: std::sync::Mutex::new(pieces),
            places: Some(clones.places.into()),
            ..one
        }
    }

    /// An open sweep, with its places on a picture.
    fn from_sheet(sweep: &Sweep) -> Option<Self> {
        let surface = sweep.surface().ok()?;
        let look = Look::Pictured(surface.uv);
        let made = Self::from(Arc::new(surface.mesh), TriMeshFlags::empty(), look);
        Some(Self {
            volume: 0.0,
            ..made
        })
    }

    /// A closed sweep, drawn sharp where it is and with its places on a picture.
    fn from_swept(mesh: TriMesh, uv: Vec<Vec2>) -> Self {
        Self::from(Arc::new(mesh), TriMeshFlags::ORIENTED, Look::Creased(uv))
    }

    /// A solid of which the vertices from number `plain` on are those of its sharp edges.
    fn from_crisp(mesh: TriMesh, plain: usize) -> Self {
        let look = match mesh.positions.len() > plain {
            true => Look::Edged(plain),
            false => Look::Smooth,
        };
        Self::from(Arc::new(mesh), TriMeshFlags::ORIENTED, look)
    }

    /// It as it is drawn.
    pub(crate) fn drawing(&self) -> Mesh {
        let mesh = &*self.mesh;
        let drawn = match &self.look {
            Look::Smooth => to_bevy_mesh(mesh),
            Look::Edged(first) => to_bevy_mesh(&mesh.parted(*first)),
            Look::Pictured(uv) => to_bevy_mesh(mesh)
                .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uv.clone())
                .with_inserted_attribute(ATTRIBUTE_OUTLINE_NORMAL, outward(mesh)),
            Look::Creased(uv) => {
                let (sharp, more) = mesh.creased(SHARP);
                let own = more.iter().filter_map(|&v| uv.get(v as usize));
                let all: Vec<Vec2> = uv.iter().chain(own).copied().collect();
                to_bevy_mesh(&sharp).with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, all)
            }
        };
        boxed(drawn, self.bounds)
    }

    /// Whether it has edges that the field put back.
    pub(crate) fn has_edges(&self) -> bool {
        matches!(self.look, Look::Edged(_))
    }

    /// From a mesh that needs no evaluation.
    pub fn from_mesh(mesh: Arc<TriMesh>) -> Self {
        // Oriented, so that a hand inside the solid touches it.
        Self::from(mesh, TriMeshFlags::ORIENTED, Look::Smooth)
    }

    fn from(mesh: Arc<TriMesh>, flags: TriMeshFlags, look: Look) -> Self {
        let shape = shape(&mesh, flags);
        let bounds = mesh.bounds();
        // Positions, normals and indices, held as a mesh, a drawing and a collider with its tree.
        let bytes = mesh.positions.len() * 24 * 3 + mesh.triangles.len() * (12 * 3 + 64);
        let made = Self {
            volume: mesh.volume(),
            drawn: std::sync::Mutex::default(),
            look,
            shape,
            fuse_ms: 0.0,
            extract_ms: 0.0,
            solid: None,
            bytes,
            places: None,
            pieces: std::sync::Mutex::default(),
            bounds,
            mesh,
        };
        if let Ok(mut drawn) = made.drawn.lock() {
            *drawn = Some(made.drawing());
        }
        made
    }
}

type Outcome = Result<Arc<Made>, String>;

/// One evaluation on its way.
pub(super) struct Running {
    pub key: Key,
    /// The last frame in which somebody asked for it.
    pub wanted: u64,
    pub progress: Progress,
    pub cancelled: Arc<AtomicBool>,
    /// There before the outcome is.
    pub early: Arc<Early>,
    outcome: Arc<OnceLock<Option<Outcome>>>,
}

impl Running {
    pub fn new(key: Key, frame: u64) -> Self {
        Self {
            key,
            wanted: frame,
            progress: Progress::new(),
            cancelled: Arc::default(),
            early: Arc::default(),
            outcome: Arc::default(),
        }
    }

    pub fn is_finished(&self) -> bool {
        self.outcome.get().is_some()
    }

    /// The outcome; `None` where it was cancelled.
    pub fn take(self) -> Option<Outcome> {
        self.outcome.get()?.clone()
    }

    /// What another thread is to do; from `base`, which gives the same and sooner, where there is one.
    pub fn work(
        &self,
        recipe: Recipe,
        base: Option<Arc<Solid>>,
        volumes: Arc<Volumes>,
        backend: Backend,
    ) -> impl FnOnce() + Send + 'static {
        let step = self.key.step();
        let progress = self.progress.clone();
        let (cancelled, outcome) = (self.cancelled.clone(), self.outcome.clone());
        let early = self.early.clone();
        move || {
            // A mesh that is baked on the way shows its progress and stops when asked to.
            let meshes = volumes.watched(&progress);
            let make = || {
                if let Some(mut row) = clones(&recipe, step, &meshes, &cancelled)? {
                    // Very many are coarser: nobody sees each of them from near.
                    let mut coarser = step;
                    for _ in 0..6 {
                        if row.mesh.positions.len() * row.places.len() <= MOST_VERTICES {
                            break;
                        }
                        coarser *= 1.5;
                        match clones(&recipe, coarser, &meshes, &cancelled)? {
                            Some(next) if !next.mesh.triangles.is_empty() => row = next,
                            _ => break,
                        }
                    }
                    return Ok(Made::from_clones(row));
                }
                if let Node::Sweep(sweep) = recipe.node()
                    && !sweep.is_closed()
                    && let Some(sheet) = Made::from_sheet(sweep)
                {
                    return Ok(sheet);
                }
                if let Some(own) = own_surface(&recipe) {
                    return Ok(Made::from_swept(own.mesh, own.uv));
                }
                let asked = backend.make(&recipe, step, &meshes, &early, &cancelled);
                if let Asked::Made(on_card) = asked {
                    if cancelled.load(Ordering::Relaxed) {
                        return Err(SolidError::Cancelled);
                    }
                    let mut made = Made::from_crisp(on_card.mesh, on_card.plain);
                    made.fuse_ms = on_card.fuse.as_secs_f64() * 1e3;
                    made.extract_ms = on_card.extract.as_secs_f64() * 1e3;
                    return Ok(made);
                }
                let at = Placement::IDENTITY;
                let solid = match &base {
                    Some(base) => base.remake(&recipe, &at, step, &meshes, &cancelled),
                    None => Solid::make(&recipe, &at, step, &meshes, &cancelled),
                }?;
                let extracted = Instant::now();
                let painting = matches!(recipe.node(), Node::Canvas(_));
                let mesh = solid.mesh();
                if !painting {
                    early.is_plain(&mesh);
                }
                let mesh = solid.crisped(&mesh, &cancelled)?.unwrap_or(mesh);
                let extract = solid.extract + extracted.elapsed();
                let mut made = Made::from_crisp(mesh, solid.surface().vertices());
                made.fuse_ms = solid.fuse.as_secs_f64() * 1e3;
                made.extract_ms = extract.as_secs_f64() * 1e3;
                if painting {
                    // Shared with the states before and after, so most of it counts twice.
                    made.bytes += solid.grid().bricks().count() * 1024;
                    made.solid = Some(Arc::new(solid));
                }
                Ok(made)
            };
            // Whoever waits for this is told, whatever happens in here.
            let made = match catch_unwind(AssertUnwindSafe(make)) {
                Ok(Ok(made)) => Some(Ok(Arc::new(made))),
                Ok(Err(SolidError::Cancelled)) => None,
                Ok(Err(_)) if progress.is_cancelled() => None,
                Ok(Err(error)) => Some(Err(error.to_string())),
                Err(_) => Some(Err(
                    "A solid could not be made. Undo the last step, or choose another grid step."
                        .to_owned(),
                )),
            };
            // Set once, here only.
            let _ = outcome.set(made);
        }
    }
}

/// Radians between faces: a rim or the edge of a cap turns further.
const SHARP: f32 = 0.7;
/// Clones up to so many are entities of their own, drawn together since they share a mesh.
pub(crate) const ONE_BY_ONE: usize = 1024;
/// Vertices of all clones of a row together, about.
const MOST_VERTICES: usize = 6_000_000;
/// Vertices of one piece.
const PIECE: usize = 500_000;

/// The surfaces of all clones in pieces of neighbours, so that the main schedule has few things to
/// look at.
pub(crate) fn merged(one: &TriMesh, places: &[Place]) -> Vec<Mesh> {
    let each = (PIECE / one.positions.len().max(1)).max(1);
    let piece = |places: &[Place]| {
        let mut all = TriMesh::default();
        for place in places {
            let first = all.positions.len() as u32;
            let there = |p: &Vec3| place.translation + place.rotation * (*p * place.scale);
            all.positions.extend(one.positions.iter().map(there));
            all.normals
                .extend(one.normals.iter().map(|n| place.rotation * *n));
            let shifted = one.triangles.iter().map(|t| t.map(|v| v + first));
            all.triangles.extend(shifted);
        }
        to_bevy_mesh(&all)
    };
    places.chunks(each).map(piece).collect()
}

/// A box around each clone: enough to point at one.
fn boxes(mesh: &TriMesh, places: &[Place]) -> Option<SharedShape> {
    let bounds = mesh.bounds();
    if bounds.is_empty() || places.is_empty() {
        return None;
    }
    let half = 0.5 * bounds.size();
    let each = places.iter().map(|p| {
        let at = p.translation + p.rotation * (bounds.centre() * p.scale);
        let size = (half * p.scale).max(Vec3::splat(1e-5));
        let shape = SharedShape::cuboid(size.x, size.y, size.z);
        (Pose::from_parts(at, p.rotation), shape)
    });
    Some(SharedShape::compound(each.collect()))
}

fn shape(mesh: &TriMesh, flags: TriMeshFlags) -> Option<SharedShape> {
    if mesh.triangles.is_empty() {
        return None;
    }
    let trimesh = Trimesh::with_flags(mesh.positions.clone(), mesh.triangles.clone(), flags);
    trimesh.ok().map(SharedShape::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_field::{Profile, Rib};

    /// A strip one metre wide, a plate where it has thickness.
    fn strip(thickness: f32) -> Sweep {
        let rib = |i: u32| {
            let at = Vec3::Y * 0.05 * i as f32;
            Rib {
                points: [at - 0.5 * Vec3::X, at + 0.5 * Vec3::X],
                tangents: [Vec3::X; 2],
                slopes: [1.0; 2],
                start: Quat::IDENTITY,
                twist: 0.0,
            }
        };
        Sweep {
            ribs: (0..12).map(rib).collect(),
            count: 12,
            profile: Profile::Sheet,
            thickness,
            caps: false,
        }
    }

    #[test]
    fn what_is_nothing_is_drawn_without_a_word() {
        let nothing = Made::from_crisp(TriMesh::default(), 0).drawing();
        assert!(nothing.count_vertices() > 0);
    }

    #[test]
    fn what_was_let_go_is_drawn_again_as_it_was() {
        let sheet = Made::from_sheet(&strip(0.0)).unwrap();
        let solid = strip(0.02).solid().unwrap();
        let corners = solid.mesh.positions.len();
        let plate = Made::from_swept(solid.mesh, solid.uv);
        for made in [&sheet, &plate] {
            let first = made.drawn.lock().unwrap().take().unwrap();
            let again = made.drawing();
            for what in [
                Mesh::ATTRIBUTE_POSITION,
                Mesh::ATTRIBUTE_NORMAL,
                Mesh::ATTRIBUTE_UV_0,
            ] {
                let [a, b] = [&first, &again].map(|m| m.attribute(what.id).unwrap().get_bytes());
                assert_eq!(a, b, "{what:?}");
            }
            let places = again.attribute(Mesh::ATTRIBUTE_UV_0).unwrap().len();
            assert_eq!(places, again.count_vertices());
        }
        // Its rims are sharp.
        assert!(plate.drawing().count_vertices() > corners);
    }
}
