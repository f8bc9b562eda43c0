//! Meshes of the user's: brought in, baked, kept, and evaluated.

mod common;

use std::fs;
use std::path::PathBuf;

use common::{home, real_meshes};
use glam::Vec3;
use midair_field::bake::Progress;
use midair_field::{MeshSource as _, Node, Placement, Program};
use midair_library::{ImportError, Library, MeshShelf, Volumes, import, import_all};

const TETRAHEDRON: &str =
    "v 0 0 0\nv 2 0 0\nv 0 4 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

#[test]
fn a_mesh_becomes_a_component() {
    let (dir, folders) = home();
    let path = dir.path().join("my_first-mesh.obj");
    fs::write(&path, TETRAHEDRON).unwrap();
    let progress = Progress::new();
    let c = import(&folders, &path, None, &progress).unwrap();
    assert_eq!(
        (c.id.as_str(), c.name.as_str(), c.category.as_str()),
        ("own/my-first-mesh", "My first mesh", "Own")
    );
    assert_eq!(progress.fraction(), 1.0);
    let b = c.recipe.bounds();
    assert!(
        (b.size() - Vec3::new(0.2, 0.4, 0.3)).abs().max_element() < 1e-6,
        "{b:?}"
    );
    assert!(b.centre().length() < 1e-6);

    let library = Library::load(&folders);
    assert_eq!(library.warnings(), []);
    assert_eq!(library.get(&c.id), Some(&c));
    let Node::Mesh { mesh, .. } = c.recipe.node() else {
        panic!("{:?}", c.recipe);
    };
    let shelf = MeshShelf::new(folders.meshes());
    assert_eq!(shelf.mesh(mesh).unwrap().hash(), *mesh);

    let volumes = Volumes::new(&folders);
    let program = Program::compile(&c.placed(), &Placement::IDENTITY, 0.01, &volumes).unwrap();
    assert!(program.at(Vec3::new(-0.07, -0.17, -0.12)) < 0.0);
    assert!(program.at(Vec3::new(0.09, 0.19, 0.14)) > 0.0);

    // Again: the same component, not a second one. Under another name: another.
    assert_eq!(import(&folders, &path, None, &progress).unwrap(), c);
    let named = import(&folders, &path, Some("Corner"), &progress).unwrap();
    assert_eq!(
        (named.id.as_str(), &named.recipe),
        ("own/corner", &c.recipe)
    );
    assert_eq!(fs::read_dir(folders.meshes()).unwrap().count(), 1);

    // Its mesh goes: it stays listed.
    fs::remove_dir_all(folders.meshes()).unwrap();
    let library = Library::load(&folders);
    assert!(library.get(&c.id).unwrap().missing);
    assert_eq!(library.warnings().len(), 2);
    assert!(MeshShelf::new(folders.meshes()).mesh(mesh).is_none());
}

#[test]
fn one_bad_mesh_does_not_keep_the_others_out() {
    let (dir, folders) = home();
    let file = |name: &str, bytes: &[u8]| {
        let path = dir.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let paths: Vec<PathBuf> = vec![
        dir.path().join("absent.obj"),
        file("empty.stl", b""),
        file("text.ply", b"hello"),
        file("no-triangles.obj", b"v 0 0 0\nv 1 0 0\n"),
        file("nan.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        file("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
        file("line.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
        file("good.obj", TETRAHEDRON.as_bytes()),
    ];
    let progress = Progress::new();
    let done: Vec<_> = import_all(&folders, &paths, None, &progress).collect();
    assert_eq!(done.len(), paths.len());
    for (path, result) in paths.iter().zip(&done).take(paths.len() - 1) {
        let error = result
            .as_ref()
            .expect_err(&path.display().to_string())
            .to_string();
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(error.contains(name) && !error.contains('\n'), "{error}");
    }
    assert_eq!(done[paths.len() - 1].as_ref().unwrap().name, "Good");
    let own: Vec<_> = Library::load(&folders)
        .components()
        .iter()
        .filter(|c| c.category == "Own")
        .cloned()
        .collect();
    assert_eq!(own.len(), 1);
    assert_eq!(fs::read_dir(folders.meshes()).unwrap().count(), 1);
}

#[test]
fn a_cancelled_import_leaves_nothing() {
    let (dir, folders) = home();
    let path = dir.path().join("a.obj");
    fs::write(&path, TETRAHEDRON).unwrap();
    let progress = Progress::new();
    progress.cancel();
    let error = import(&folders, &path, None, &progress).unwrap_err();
    assert!(matches!(error, ImportError::Cancelled { .. }), "{error}");
    assert!(!folders.components().exists() && !folders.meshes().exists());
}

#[test]
fn real_meshes_come_in() {
    let (_dir, folders) = home();
    let paths = real_meshes();
    let progress = Progress::new();
    let volumes = Volumes::new(&folders);
    for (path, result) in paths
        .iter()
        .zip(import_all(&folders, &paths, None, &progress))
    {
        let c = result.unwrap_or_else(|e| panic!("{e}"));
        let longest = c.recipe.bounds().size().max_element();
        assert!(
            (longest - 0.4).abs() < 1e-5,
            "{}: {longest}",
            path.display()
        );
        let [mesh] = c.recipe.meshes()[..] else {
            panic!("{:?}", c.recipe);
        };
        assert!(volumes.volume(&mesh, 0.01).is_some(), "{}", path.display());
    }
    let library = Library::load(&folders);
    assert_eq!(library.warnings(), []);
    assert_eq!(
        library
            .components()
            .iter()
            .filter(|c| c.category == "Own")
            .count(),
        paths.len()
    );
}

#[test]
fn a_damaged_mesh_file_is_as_good_as_gone_and_is_written_again() {
    let (dir, folders) = home();
    let path = dir.path().join("a.obj");
    fs::write(&path, TETRAHEDRON).unwrap();
    let c = import(&folders, &path, None, &Progress::new()).unwrap();
    let [mesh] = c.recipe.meshes()[..] else {
        panic!("{:?}", c.recipe);
    };
    let kept = fs::read_dir(folders.meshes())
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let bytes = fs::read(&kept).unwrap();
    fs::write(&kept, &bytes[..bytes.len() - 5]).unwrap();
    assert!(MeshShelf::new(folders.meshes()).mesh(&mesh).is_none());
    import(&folders, &path, None, &Progress::new()).unwrap();
    assert_eq!(fs::read(&kept).unwrap(), bytes);
}
