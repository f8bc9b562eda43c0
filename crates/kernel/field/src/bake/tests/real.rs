//! Meshes as they are found, from the folder MIDAIR_MESHES names.

use midair_mesh::TriMesh;

use super::broken::steady;
use super::*;

fn normalised(mut mesh: TriMesh) -> TriMesh {
    let b = mesh.bounds();
    let scale = LONGEST_SIDE / b.size().max_element();
    mesh.positions
        .iter_mut()
        .for_each(|p| *p = (*p - b.centre()) * scale);
    mesh
}

#[test]
fn found_meshes_become_solids() {
    let Some(folder) = std::env::var_os("MIDAIR_MESHES") else {
        println!("skipped: MIDAIR_MESHES names no folder of meshes");
        return;
    };
    let folder = std::path::PathBuf::from(folder);
    // Share of the box that is inside, from below and from above.
    let shares = [
        ("stanford-bunny.obj", 0.245, 0.275),
        ("teapot.obj", 0.29, 0.34),
        ("suzanne.obj", 0.22, 0.26),
        ("cow.obj", 0.22, 0.25),
        ("fandisk.obj", 0.28, 0.31),
        ("spot.obj", 0.25, 0.275),
    ];
    for (name, least, most) in shares {
        let path = folder.join(name);
        let mesh = normalised(midair_mesh::read(&path).unwrap().mesh);
        let v = baked(&mesh);
        let size = v.solid_bounds().size();
        let share = inside(&v) / (size.x * size.y * size.z);
        println!(
            "{name}: {share:.3} of its box, by its faces {:.3}",
            mesh.volume() as f32 / (size.x * size.y * size.z)
        );
        assert!(
            share > least && share < most,
            "{name}: {share} of its box is inside"
        );
        for (p, s) in nodes(&v) {
            let outside = v.solid_bounds().distance(p);
            assert!(outside == 0.0 || s >= outside * 0.85, "{name}: {s} at {p}");
        }
        steady(&v, 2.0 * v.step());
    }
}
