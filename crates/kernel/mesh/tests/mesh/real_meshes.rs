use std::path::PathBuf;

use midair_mesh::{Format, Named, WriteOptions, check, encode, read, read_bytes};

/// Every mesh of the folder in `MIDAIR_MESHES`, where there is one.
fn meshes() -> Vec<PathBuf> {
    let Some(folder) = std::env::var_os("MIDAIR_MESHES") else {
        println!("MIDAIR_MESHES is not set: nothing to read");
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|p| Format::from_path(p).is_some())
        .collect();
    paths.sort();
    paths
}

#[test]
fn real_meshes_read_and_survive_every_format() {
    for path in meshes() {
        let mesh = read(&path).unwrap_or_else(|error| panic!("{error}"));
        let report = check(&mesh.mesh);
        println!("{}: {:?}\n{report}\n", path.display(), mesh.warnings);
        assert!(report.triangles > 500 && report.area > 0.0);
        for format in [Format::Glb, Format::Obj, Format::Stl, Format::Ply] {
            let bytes = encode(
                format,
                &[Named::new("it", &mesh.mesh)],
                &WriteOptions::default(),
            )
            .unwrap();
            let back = read_bytes(&bytes, format, "it").unwrap();
            assert_eq!(
                (back.mesh.triangles.len(), back.mesh.positions.len()),
                (mesh.mesh.triangles.len(), mesh.mesh.positions.len()),
                "{format}"
            );
            let again = check(&back.mesh);
            assert_eq!(
                (again.open_edges, again.pieces),
                (report.open_edges, report.pieces),
                "{format}"
            );
        }
    }
}
