use std::sync::Arc;

use bevy::math::Vec3;
use midair_document::{Kind, Object};
use midair_mesh::TriMesh;

use super::display_steps;
use crate::evaluate::{Evaluations, Key};
use crate::project::Project;

/// The surface an object is drawn from, in its own frame before its scale; `None` while a solid is not
/// made yet. Starts no work.
pub fn form(project: &Project, evaluations: &Evaluations, object: &Object) -> Option<Arc<TriMesh>> {
    match &object.kind {
        Kind::Solid(recipe) | Kind::Sheet(recipe) => {
            display_steps(project.document(), object, recipe)
                .into_iter()
                .find_map(|step| evaluations.made(&Key::new(recipe, step)))
                .map(|made| made.mesh.clone())
        }
        Kind::Foreign { mesh, .. } => project.mesh(mesh),
        // Nothing comes to rest on a line, and a line by its box.
        Kind::Line(_) | Kind::Stroke(_) => None,
        Kind::Reference(reference) => {
            let half = reference.bounds().max;
            let corner = |x: f32, y: f32| half * Vec3::new(x, y, 0.0);
            Some(Arc::new(TriMesh {
                positions: vec![
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ],
                normals: Vec::new(),
                triangles: vec![[0, 1, 2], [0, 2, 3]],
            }))
        }
    }
}
