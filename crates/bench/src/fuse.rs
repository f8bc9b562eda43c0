use std::sync::Arc;

use glam::{Quat, Vec3};
use midair_field::bake::Volume;
use midair_field::{
    Brick, FuseOptions, MeshSource, Node, Op, Operand, Placement, Program, Recipe, fuse,
};
use midair_mesh::{Aabb, MeshHash};
use serde_json::json;

use crate::catalogue::BenchError;
use crate::figure::Details;
use crate::measure::{Budget, Run, Times, repeat};

/// 256 nodes from −1 to 1 m.
const STEP: f32 = 2.0 / 255.0;

/// Where five tori stand: an angle about z and a place, random but the same everywhere (glibc's
/// `rand` after `srand(7)`).
const PLACES: [(f32, [f32; 3]); 5] = [
    (3.057758, [0.3311797, 0.083332, -0.2567612]),
    (0.0642227, [0.0133367, 0.4463534, -0.4212609]),
    (3.7778301, [-0.4001896, 0.024102, -0.3695633]),
    (4.800663, [0.2839427, 0.3500752, -0.3024912]),
    (1.353368, [0.2589144, 0.259828, -0.3900188]),
];

/// The one volume that every operand names.
struct One(Arc<Volume>);

impl MeshSource for One {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        Some(self.0.clone())
    }
}

/// Five baked operands of 64³ nodes, turned and moved, united.
fn tori() -> Result<(Recipe, One), BenchError> {
    let around = Aabb::around(Vec3::ZERO, Vec3::splat(0.5));
    let torus = |p: Vec3| (p.x.hypot(p.y) - 0.28).hypot(p.z) - 0.12;
    let volume = Volume::from_fn(around, 1.0 / 63.0, torus)?;
    let mesh = Recipe::new(Node::Mesh {
        mesh: MeshHash([0; 32]),
        bounds: around,
    });
    let operands = PLACES.map(|(angle, place)| Operand {
        op: Op::Union,
        placement: Placement {
            // The lattice has a node at the origin, 256 nodes from −1 to 1 have none.
            translation: Vec3::from(place) + 0.5 * STEP,
            rotation: Quat::from_rotation_z(angle),
            scale: Vec3::ONE,
        },
        recipe: mesh.clone(),
        muted: false,
    });
    let recipe = Recipe::new(Node::Solid(operands.to_vec()));
    Ok((recipe, One(Arc::new(volume))))
}

pub(crate) fn run(budget: &Budget) -> Result<(Times, Details), BenchError> {
    let (recipe, meshes) = tori()?;
    let make = || -> Result<_, BenchError> {
        let started = std::time::Instant::now();
        let program = Program::compile(&recipe, &Placement::IDENTITY, STEP, &meshes)?;
        let compiled = started.elapsed();
        let grid = fuse(&program, &FuseOptions::default())?;
        Ok((grid, compiled, started.elapsed()))
    };
    let times = repeat(budget, || {
        let (_, compile, total) = make()?;
        Ok::<_, BenchError>(Run {
            total,
            parts: [("compile_ms", compile)],
        })
    })?;
    let grid = make()?.0;
    let near = |(_, b): &(_, &Brick)| matches!(b, Brick::Values { .. });
    let mut details = Details::new();
    details.insert("operands".into(), json!(recipe.leaves()));
    details.insert("bricks".into(), json!(grid.bricks().filter(near).count()));
    Ok((times, details))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tori_are_united() {
        let (recipe, meshes) = tori().unwrap();
        let program = Program::compile(&recipe, &Placement::IDENTITY, STEP, &meshes).unwrap();
        for (angle, place) in PLACES {
            let on_ring = Quat::from_rotation_z(angle) * Vec3::new(0.28, 0.0, 0.0);
            assert!(program.at(on_ring + Vec3::from(place)) < -0.1);
        }
        assert!(program.at(Vec3::ONE) > 0.0);
    }
}
