mod analytic;
mod broken;
mod keeping;
mod real;
mod sampling;
mod shapes;

use glam::UVec3;

use super::*;

fn baked(mesh: &midair_mesh::TriMesh) -> Volume {
    bake(mesh, &BakeOptions::default(), &Progress::new()).unwrap()
}

/// Every node of a volume: its place and φ there.
fn nodes(v: &Volume) -> impl Iterator<Item = (glam::Vec3, f32)> {
    let n = v.cells() + 1;
    (0..n.x * n.y * n.z).map(move |i| {
        let p = v
            .frame
            .node(UVec3::new(i % n.x, i / n.x % n.y, i / n.x / n.y));
        (p, v.sample(p))
    })
}

/// The volume inside, by counting nodes.
fn inside(v: &Volume) -> f32 {
    nodes(v).filter(|n| n.1 < 0.0).count() as f32 * v.step().powi(3)
}
