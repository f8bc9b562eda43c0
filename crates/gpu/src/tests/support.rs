use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use glam::{Quat, Vec3};
use midair_field::{Brick, Grid, Node, Op, Operand, Placement, Primitive, Program, Recipe};
use midair_mesh::TriMesh;

use crate::{Gpu, GpuOptions};

/// The device, software too; `None` on a machine without any, said once.
pub fn gpu() -> Option<Arc<Gpu>> {
    static GPU: OnceLock<Option<Arc<Gpu>>> = OnceLock::new();
    GPU.get_or_init(|| {
        if Gpu::adapters().is_empty() {
            eprintln!("skipped: no Vulkan adapter on this machine, not even software");
            return None;
        }
        let options = GpuOptions {
            software: true,
            ..GpuOptions::default()
        };
        Some(Arc::new(Gpu::open(&options).expect("an adapter is there")))
    })
    .clone()
}

pub fn operand(op: Op, at: Vec3, p: impl Into<Recipe>) -> Operand {
    Operand {
        op,
        placement: Placement::at(at),
        recipe: p.into(),
        muted: false,
    }
}

pub fn compile(recipe: &Recipe, step: f32) -> Program {
    Program::compile(recipe, &Placement::IDENTITY, step, &()).expect("sound")
}

/// Every kind of primitive, as the processor's own tests have them.
#[path = "../../../kernel/field/src/tests/zoo.rs"]
mod zoo;
pub(crate) use zoo::zoo;

/// Nested, turned, stretched and mirrored: every operator on every side.
pub fn nested() -> Recipe {
    let zoo = zoo();
    let placed = |op, i: usize, at: [f32; 3], turn: f32, scale: [f32; 3]| Operand {
        op,
        placement: Placement {
            translation: at.into(),
            rotation: Quat::from_scaled_axis(Vec3::new(turn, 0.4 * turn, -0.7 * turn)),
            scale: scale.into(),
        },
        recipe: zoo[i].clone().into(),
        muted: false,
    };
    let inner = Recipe::new(Node::Solid(vec![
        placed(Op::Union, 2, [0.0; 3], 0.3, [1.0; 3]),
        placed(Op::Union, 7, [0.1, 0.1, 0.0], 1.0, [1.2; 3]),
        placed(Op::Subtract, 0, [0.15, 0.0, 0.05], 0.0, [0.7, 0.7, 0.7]),
    ]));
    Recipe::new(Node::Solid(vec![
        placed(Op::Union, 5, [-0.1, 0.0, 0.0], 0.2, [1.0, 1.4, 0.8]),
        operand(Op::Union, Vec3::new(0.2, 0.05, 0.0), inner.clone()),
        placed(Op::Subtract, 9, [0.0, 0.05, 0.0], 0.9, [1.0, 1.0, -2.0]),
        placed(Op::Union, 16, [0.0, 0.2, 0.1], 0.5, [0.8; 3]),
        operand(Op::Subtract, Vec3::new(-0.2, 0.1, 0.1), inner),
        placed(Op::Intersect, 0, [0.0, 0.05, 0.0], 0.0, [1.9, 1.7, 1.8]),
    ]))
}

/// The training tasks of EasyVRModeling Fig. 7.
pub fn table_1() -> [(&'static str, Recipe); 3] {
    [
        (
            "cube-sphere",
            include_str!("../../../../benches/cube-sphere.ron"),
        ),
        ("chair", include_str!("../../../../benches/chair.ron")),
        ("cup", include_str!("../../../../benches/cup.ron")),
    ]
    .map(|(name, text)| (name, ron::from_str(text).expect("a recipe")))
}

/// How two fields differ: most in the band (in steps), signs where the processor's magnitude exceeds
/// `bound` steps, and how many nodes were compared.
pub fn difference(ours: &Grid, reference: &Grid, band: f32, bound: f32) -> (f32, usize, usize) {
    let step = reference.step();
    let (mut most, mut signs, mut compared) = (0.0f32, 0, 0);
    let mut coords = reference.sorted_coords();
    coords.extend(ours.sorted_coords());
    coords.sort_unstable_by_key(|c| c.to_array());
    coords.dedup();
    for c in coords {
        let (a, b) = (ours.brick(c), reference.brick(c));
        if let (Some(Brick::Values { values: v, .. }), Some(Brick::Values { values: w, .. })) =
            (a, b)
        {
            for (v, w) in v.iter().zip(w.iter()) {
                if w.abs() < band * step {
                    most = most.max((v - w).abs() / step);
                    compared += 1;
                }
                signs += usize::from(w.abs() > bound * step && (*v < 0.0) != (*w < 0.0));
            }
            continue;
        }
        for node in crate::solid::corners(c * 8, c * 8 + 7) {
            let near = match b {
                Some(Brick::Values { values, .. }) => {
                    let l = node - c * 8;
                    values[(l.x + 8 * (l.y + 8 * l.z)) as usize].abs() <= bound * step
                }
                _ => false,
            };
            signs += usize::from(!near && ours.is_inside(node) != reference.is_inside(node));
        }
    }
    (most, signs, compared)
}

/// Fails unless the mesh is closed, manifold, wound outward, and has no vertex to spare.
pub fn assert_sound(mesh: &TriMesh, name: &str) {
    let report = midair_mesh::check(mesh);
    assert!(report.is_faultless(), "{name}: {report:?}");
    let mut used = vec![false; mesh.positions.len()];
    mesh.triangles
        .as_flattened()
        .iter()
        .for_each(|&v| used[v as usize] = true);
    assert!(used.iter().all(|u| *u), "{name}: a vertex is unused");
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    for n in &mesh.normals {
        assert!((n.length() - 1.0).abs() < 1e-3, "{name}: {n}");
    }
}

/// The lattice edge that a vertex lies on, as a key: axis and node.
pub fn edge_of(p: Vec3, step: f32) -> (usize, [i32; 3]) {
    let q = p / step;
    let off = (q - q.round()).abs();
    let axis = (0..3)
        .max_by(|&a, &b| off[a].total_cmp(&off[b]))
        .unwrap_or(0);
    let mut node = q.round().as_ivec3();
    node[axis] = q[axis].floor() as i32;
    (axis, node.to_array())
}

/// Fails unless two meshes have the same vertices on the same edges and the same triangles; how far
/// apart vertices are at most, metres, and normals.
pub fn assert_same(ours: &TriMesh, reference: &TriMesh, step: f32, name: &str) -> (f32, f32) {
    assert_eq!(
        ours.positions.len(),
        reference.positions.len(),
        "{name}: vertices"
    );
    assert_eq!(
        ours.triangles.len(),
        reference.triangles.len(),
        "{name}: triangles"
    );
    let keys = |m: &TriMesh| -> Vec<_> { m.positions.iter().map(|&p| edge_of(p, step)).collect() };
    let (a, b) = (keys(ours), keys(reference));
    let place: HashMap<_, usize> = b.iter().enumerate().map(|(i, k)| (*k, i)).collect();
    assert_eq!(place.len(), b.len(), "{name}: two vertices on one edge");
    let (mut apart, mut turned) = (0.0f32, 0.0f32);
    for (i, key) in a.iter().enumerate() {
        let j = *place
            .get(key)
            .unwrap_or_else(|| panic!("{name}: no vertex on {key:?}"));
        apart = apart.max(ours.positions[i].distance(reference.positions[j]));
        turned = turned.max(ours.normals[i].distance(reference.normals[j]));
    }
    let triangles = |m: &TriMesh, keys: &[(usize, [i32; 3])]| {
        let mut all: Vec<_> = m
            .triangles
            .iter()
            .map(|t| {
                let mut t = t.map(|v| keys[v as usize]);
                let first = (0..3).min_by_key(|&k| t[k]).unwrap_or(0);
                t.rotate_left(first);
                t
            })
            .collect();
        all.sort_unstable();
        all
    };
    assert!(
        triangles(ours, &a) == triangles(reference, &b),
        "{name}: triangles"
    );
    (apart, turned)
}
