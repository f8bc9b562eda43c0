use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use midair_field::{MeshSource, Node, Placement, Recipe};
use midair_mesh::TriMesh;
use midair_swept::Surface;

use crate::{Solid, SolidError};

/// Clones beyond which a row is not melted into one surface but written one by one.
const MELTED: usize = 4096;

/// A sweep as it was swept: the mesh of a recipe that is one by itself, not made out of anything.
///
/// It needs no field, has its own points and is there at once. `None` for anything else, and for a
/// solid whose surface runs through itself: a field knows what is inside of it.
pub fn own_mesh(recipe: &Recipe) -> Option<TriMesh> {
    Some(own_surface(recipe)?.mesh)
}

/// The same with its places on a picture.
pub fn own_surface(recipe: &Recipe) -> Option<Surface> {
    match recipe.node() {
        Node::Component { recipe, .. } => own_surface(recipe),
        Node::Sweep(sweep) if sweep.is_closed() => {
            let solid = sweep.solid().ok()?;
            let clean = solid.inverted.is_empty()
                && solid.crossed.is_none()
                && midair_swept::touches(&solid.mesh).0 == 0;
            let (mesh, uv) = (solid.mesh, solid.uv);
            clean.then_some(Surface { mesh, uv })
        }
        Node::Sweep(sweep) => sweep.surface().ok(),
        _ => None,
    }
}

/// The surface of a recipe where it stands, at a step of the world: a sweep's own, a row of very many
/// clones one by one, and the field's for everything else.
///
/// # Errors
/// As [`Solid::make`].
pub fn surface_of(
    recipe: &Recipe,
    placement: &Placement,
    step: f32,
    meshes: &dyn MeshSource,
    cancel: &AtomicBool,
) -> Result<TriMesh, SolidError> {
    if let Some(mesh) = own_mesh(recipe) {
        return Ok(mesh.transformed(&placement.affine()));
    }
    match recipe.node() {
        Node::Clones { row, recipe } if row.len() > MELTED => {
            let mesh = surface_of(recipe, &Placement::IDENTITY, step, meshes, cancel)?;
            let mut all = TriMesh::default();
            for place in row.places() {
                let there = Placement::from(&place).affine();
                let one = mesh.transformed(&(placement.affine() * there));
                let first = all.positions.len() as u32;
                all.positions.extend(one.positions);
                all.normals.extend(one.normals);
                let shifted = one.triangles.iter().map(|t| t.map(|v| v + first));
                all.triangles.extend(shifted);
            }
            Ok(all)
        }
        _ => {
            let solid = Solid::make(recipe, placement, step, meshes, cancel)?;
            let mesh = solid.mesh();
            Ok(solid.crisped(&mesh, cancel)?.unwrap_or(mesh))
        }
    }
}

/// A row of clones by its parts: what is cloned, and where it stands.
pub struct Clones {
    /// The surface of one.
    pub mesh: Arc<TriMesh>,
    /// Where each stands.
    pub places: Vec<midair_swept::Place>,
}

/// The parts of a row of clones; `None` for any other recipe.
///
/// # Errors
/// As [`Solid::make`].
pub fn clones(
    recipe: &Recipe,
    step: f32,
    meshes: &dyn MeshSource,
    cancel: &AtomicBool,
) -> Result<Option<Clones>, SolidError> {
    let Node::Clones { row, recipe } = recipe.node() else {
        return Ok(None);
    };
    let mesh = surface_of(recipe, &Placement::IDENTITY, step, meshes, cancel)?;
    Ok(Some(Clones {
        mesh: Arc::new(mesh),
        places: row.places(),
    }))
}
