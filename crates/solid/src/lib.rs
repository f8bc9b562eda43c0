//! From a recipe to a closed mesh in one call: compile, fuse, extract.
//!
//! The studio, the exports and the benchmarks all go through [`Solid::make`], so that what is
//! measured is what is shown. [`Solid::remake`] starts from an earlier solid and works only where
//! the two recipes differ.
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//! use midair_field::{Placement, Primitive};
//! use midair_solid::Solid;
//!
//! let ball = Primitive::Sphere { radius: 0.2 }.into();
//! let solid = Solid::make(&ball, &Placement::IDENTITY, 0.01, &(), &AtomicBool::new(false))?;
//! let volume = solid.mesh().volume();
//! assert!((volume - 4.0 / 3.0 * std::f64::consts::PI * 0.008).abs() < 2e-4);
//! # Ok::<(), midair_solid::SolidError>(())
//! ```

use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use midair_field::{
    CompileError, FuseError, FuseOptions, Grid, MeshSource, Placement, Program, Recipe, fuse,
    refuse_from,
};
use midair_mesh::TriMesh;
use midair_surface::{Cancelled, Surface, crisp, crisp_unless};

mod export;
mod material;
mod plate;
mod swept;
mod thumbnail;
mod tube;

pub use export::{ExportError, ExportOptions, export, may_export};
pub use material::{Dial, HeadFault, INK, MOST_DIALS, MaterialInfo, Materials, PLAIN, finish};
pub use plate::{PlateFault, plate};
pub use swept::{Clones, clones, own_mesh, own_surface, surface_of};
pub use thumbnail::Thumbnail;
pub use tube::tube;

/// Why a recipe did not become a solid.
#[derive(Debug, thiserror::Error)]
pub enum SolidError {
    /// It was not wanted any more.
    #[error("cancelled")]
    Cancelled,
    /// The recipe cannot be evaluated.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The field cannot be held.
    #[error("{0}")]
    Fuse(FuseError),
}

impl From<FuseError> for SolidError {
    fn from(error: FuseError) -> Self {
        match error {
            FuseError::Cancelled => Self::Cancelled,
            other => Self::Fuse(other),
        }
    }
}

impl From<Cancelled> for SolidError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A recipe's field and surface at one step, and how long they took.
#[derive(Clone)]
pub struct Solid {
    program: Program,
    grid: Grid,
    surface: Surface,
    /// To fuse the operands' fields, bakes not included.
    pub fuse: Duration,
    /// To extract the surface.
    pub extract: Duration,
}

impl Solid {
    /// Evaluates `recipe`, standing at `placement`, on a lattice of `step` metres.
    ///
    /// # Errors
    ///
    /// The recipe names a mesh that `meshes` does not know, the step is too fine for it, or
    /// `cancel` was set.
    pub fn make(
        recipe: &Recipe,
        placement: &Placement,
        step: f32,
        meshes: &dyn MeshSource,
        cancel: &AtomicBool,
    ) -> Result<Self, SolidError> {
        let program = Program::compile(recipe, placement, step, meshes)?;
        let started = Instant::now();
        let grid = fuse(&program, &options(cancel))?;
        let fused = Instant::now();
        let surface = Surface::extract_unless(&grid, cancel)?;
        Ok(Self {
            program,
            grid,
            surface,
            fuse: fused - started,
            extract: fused.elapsed(),
        })
    }

    /// As [`Solid::make`], starting from `self`: only the bricks in which the two can differ are
    /// fused, and only those that do differ are extracted. The outcome is the same.
    ///
    /// # Errors
    ///
    /// As [`Solid::make`].
    pub fn remake(
        &self,
        recipe: &Recipe,
        placement: &Placement,
        step: f32,
        meshes: &dyn MeshSource,
        cancel: &AtomicBool,
    ) -> Result<Self, SolidError> {
        let program = Program::compile(recipe, placement, step, meshes)?;
        let mut grid = self.grid.clone();
        let mut surface = self.surface.clone();
        let started = Instant::now();
        let changed = refuse_from(&mut grid, &self.program, &program, &options(cancel))?;
        let fused = Instant::now();
        surface.update_unless(&grid, &changed, cancel)?;
        Ok(Self {
            program,
            grid,
            surface,
            fuse: fused - started,
            extract: fused.elapsed(),
        })
    }

    /// The field.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The surface, chunk by chunk.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The whole surface, closed and welded, as marching cubes leaves it.
    pub fn mesh(&self) -> TriMesh {
        self.surface.mesh()
    }

    /// The whole surface, closed and welded, with its sharp edges.
    pub fn crisp(&self) -> TriMesh {
        crisp(self.mesh(), &self.program)
    }

    /// What has sharp edges, of the surface that [`Self::mesh`] gave; `None` where that is it already.
    ///
    /// # Errors
    ///
    /// [`SolidError::Cancelled`] once `cancel` is set.
    pub fn crisped(
        &self,
        mesh: &TriMesh,
        cancel: &AtomicBool,
    ) -> Result<Option<TriMesh>, SolidError> {
        Ok(crisp_unless(mesh, &self.program, cancel)?)
    }
}

fn options(cancel: &AtomicBool) -> FuseOptions<'_> {
    FuseOptions {
        cancel: Some(cancel),
        ..FuseOptions::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_field::{Node, Op, Operand, Primitive};

    fn pair(x: f32) -> Recipe {
        let ball = Recipe::from(Primitive::Sphere { radius: 0.1 });
        let operand = |op, x| Operand {
            op,
            placement: Placement::at([x, 0.0, 0.0].into()),
            recipe: ball.clone(),
            muted: false,
        };
        Recipe::new(Node::Solid(vec![
            operand(Op::Union, 0.0),
            operand(Op::Subtract, x),
        ]))
    }

    #[test]
    fn remaking_gives_the_same_as_making() {
        let go = AtomicBool::new(false);
        let make = |r: &Recipe| Solid::make(r, &Placement::IDENTITY, 0.01, &(), &go).unwrap();
        let before = make(&pair(0.12));
        let moved = before
            .remake(&pair(0.07), &Placement::IDENTITY, 0.01, &(), &go)
            .unwrap();
        assert_eq!(moved.mesh(), make(&pair(0.07)).mesh());
    }

    /// 3DBrushVR §4.3: a point brush draws a sphere.
    #[test]
    fn the_surface_of_a_point_is_its_sphere_to_half_a_voxel() {
        use midair_field::{Canvas, Stroke};
        let go = AtomicBool::new(false);
        for step in [0.02, 0.01, 0.005] {
            let at = glam::Vec3::new(0.013, -0.007, 0.021);
            let canvas = Canvas {
                strokes: vec![Stroke::point(at, 0.1)],
                ..Canvas::default()
            };
            let recipe = Recipe::new(Node::Canvas(canvas));
            let solid = Solid::make(&recipe, &Placement::IDENTITY, step, &(), &go).unwrap();
            let mesh = solid.mesh();
            assert!(mesh.triangles.len() > 100);
            for p in &mesh.positions {
                assert!((p.distance(at) - 0.1).abs() < 0.5 * step, "{p} at {step}");
            }
        }
    }

    #[test]
    fn a_set_flag_cancels() {
        let stop = AtomicBool::new(true);
        let made = Solid::make(&pair(0.1), &Placement::IDENTITY, 0.001, &(), &stop);
        assert!(matches!(made, Err(SolidError::Cancelled)));
    }
}
