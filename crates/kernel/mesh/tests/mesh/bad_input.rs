use std::path::Path;

use glam::Vec3;
use midair_mesh::{
    Format, Named, Read, ReadError, ReadReason, TriMesh, Unit, WriteOptions, WriteReason, encode,
    read, read_bytes, write,
};
use proptest::prelude::*;

use crate::solids::{cube, sphere};

fn parse(format: Format, text: &str) -> Result<Read, ReadError> {
    read_bytes(text.as_bytes(), format, "it")
}

/// Every error is one line, names the file and says what to do.
fn reason(result: Result<Read, ReadError>) -> ReadReason {
    let error = result.map(|read| read.mesh.triangles.len()).unwrap_err();
    let line = error.to_string();
    assert!(
        line.starts_with("it ")
            && line.lines().count() == 1
            && line.ends_with('.')
            && line.len() < 400,
        "{line}"
    );
    assert!(line.matches(". ").count() >= 1, "no way out: {line}");
    println!("{line}");
    error.reason
}

fn files() -> Vec<(Format, Vec<u8>)> {
    let mut mesh = cube();
    mesh.compute_normals();
    let mut files: Vec<_> = [Format::Glb, Format::Obj, Format::Stl, Format::Ply]
        .map(|format| {
            (
                format,
                encode(format, &[Named::new("it", &mesh)], &WriteOptions::default()).unwrap(),
            )
        })
        .into();
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    files.push((Format::Stl, stl.into()));
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    files.push((Format::Ply, ply.into()));
    let gltf = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    files.push((Format::Gltf, gltf.into()));
    files
}

#[test]
fn files_cut_off_anywhere() {
    for (format, file) in files() {
        assert!(
            read_bytes(&file, format, "it").is_ok(),
            "{format}: {}",
            read_bytes(&file, format, "it").unwrap_err()
        );
        let binary = matches!(format, Format::Glb) || file[..file.len().min(400)].contains(&0);
        for n in 0..file.len() {
            let result = read_bytes(&file[..n], format, "it");
            if binary {
                assert!(result.is_err(), "{format} cut at {n}");
            }
            if let Err(error) = result {
                assert_eq!(error.to_string().lines().count(), 1, "{error}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn files_with_bytes_changed(which in 0..7_usize, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let (format, mut file) = files().swap_remove(which);
        for (at, byte) in changes {
            let at = at.index(file.len());
            file[at] = byte;
        }
        match read_bytes(&file, format, "it") {
            Ok(read) => prop_assert!(read.mesh.positions.iter().all(|p| p.is_finite())),
            Err(error) => prop_assert_eq!(error.to_string().lines().count(), 1),
        }
    }

    #[test]
    fn numbers_in_text_changed(which in 4..7_usize, at in any::<prop::sample::Index>(), number in prop::sample::select(vec!["-1", "4294967295", "18446744073709551615", "1e39", "nan", "0", "99999999999999999999999"])) {
        let (format, file) = files().swap_remove(which);
        let text = String::from_utf8(file).unwrap();
        let places: Vec<usize> = text.char_indices().filter(|(_, c)| c.is_ascii_digit()).map(|(i, _)| i).collect();
        let at = places[at.index(places.len())];
        let text = format!("{}{number}{}", &text[..at], &text[at + 1..]);
        if let Err(error) = parse(format, &text) {
            prop_assert_eq!(error.to_string().lines().count(), 1);
        }
    }
}

#[test]
fn not_a_number() {
    let mut mesh = cube();
    mesh.positions[3].y = f32::NAN;
    let bytes = midair_mesh::to_bytes(&mesh);
    assert_eq!(
        reason(read_bytes(&bytes, Format::Ply, "it")),
        ReadReason::NotFinite { vertex: 3 }
    );
    assert!(matches!(
        reason(parse(Format::Obj, "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n")),
        ReadReason::NotFinite { .. }
    ));
    assert!(matches!(
        reason(parse(
            Format::Obj,
            "v 0 0 0\nv 1 0 1e39\nv 0 1 0\nf 1 2 3\n"
        )),
        ReadReason::NotFinite { .. }
    ));
    let mut stl = encode(
        Format::Stl,
        &[Named::new("it", &cube())],
        &WriteOptions::default(),
    )
    .unwrap();
    stl[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert!(matches!(
        reason(read_bytes(&stl, Format::Stl, "it")),
        ReadReason::NotFinite { vertex: 0 }
    ));
}

#[test]
fn no_triangles() {
    let error = read_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", Format::Obj, "teapot.obj").unwrap_err();
    assert_eq!(
        error.to_string(),
        "teapot.obj has no faces. Export it again with faces, or pick another file."
    );
    assert_eq!(
        reason(parse(Format::Stl, "solid a\nendsolid a\n")),
        ReadReason::NoFaces
    );
    assert_eq!(
        reason(read_bytes(&[0; 84], Format::Stl, "it")),
        ReadReason::NoFaces
    );
    assert_eq!(
        reason(read_bytes(
            &midair_mesh::to_bytes(&TriMesh::default()),
            Format::Ply,
            "it"
        )),
        ReadReason::NoFaces
    );
    assert_eq!(
        reason(parse(Format::Gltf, r#"{"asset":{"version":"2.0"}}"#)),
        ReadReason::NoFaces
    );
    assert_eq!(
        reason(parse(Format::Obj, "v 0 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n")),
        ReadReason::NoArea
    );
}

#[test]
fn duplicate_degenerate_and_flipped_faces() {
    let mut mesh = cube();
    let [a, b, c] = mesh.triangles[0];
    mesh.triangles.extend([[b, c, a], [a, b, c], [a, a, b]]);
    mesh.triangles[5].swap(0, 1);
    let bytes = midair_mesh::to_bytes(&mesh);
    let back = read_bytes(&bytes, Format::Ply, "it").unwrap();
    assert_eq!(
        back.warnings,
        [
            "1 triangles name one corner twice and were left out",
            "2 triangles are there more than once and were kept once"
        ]
    );
    assert_eq!(back.mesh.triangles, mesh.triangles[..12]);
    // A flipped face is kept: reading repairs nothing, the check names it.
    assert_eq!(midair_mesh::check(&back.mesh).miswound_edges, 3);
}

#[test]
fn indices_out_of_range() {
    for face in [
        "1 2 9",
        "1 2 -9",
        "0 1 2",
        "1 2 99999999999",
        "1 2 x",
        "1 2 1.5",
    ] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {face}\n");
        assert!(
            matches!(reason(parse(Format::Obj, &text)), ReadReason::Damaged(_)),
            "{face}"
        );
    }
    let mut mesh = cube();
    mesh.triangles[2][1] = 8;
    assert_eq!(
        reason(read_bytes(&midair_mesh::to_bytes(&mesh), Format::Ply, "it")),
        ReadReason::IndexOutOfRange {
            triangle: 2,
            vertex: 8,
            vertices: 8
        }
    );
}

#[test]
fn counts_that_lie() {
    let head = |vertices: &str, faces: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\nelement face {faces}\nproperty list uint uint vertex_indices\nend_header\n0 0 0\n"
        )
    };
    for (vertices, faces) in [
        ("4000000000", "1"),
        ("1", "18446744073709551615"),
        ("1", "99999999999999999999999"),
    ] {
        reason(parse(Format::Ply, &head(vertices, faces)));
    }
    reason(parse(
        Format::Ply,
        "ply\nformat ascii 1.0\nelement nothing 1000000000000\nend_header\n",
    ));
    let mut list = head("0", "1")
        .replace("ascii", "binary_little_endian")
        .replace("0 0 0\n", "")
        .into_bytes();
    list.extend([0xff; 4]);
    assert!(matches!(
        reason(read_bytes(&list, Format::Ply, "it")),
        ReadReason::CutOff(_)
    ));
    let mut stl = vec![0; 84];
    for announced in [40_000_000, u32::MAX] {
        stl[80..84].copy_from_slice(&announced.to_le_bytes());
        assert!(matches!(
            reason(read_bytes(&stl, Format::Stl, "it")),
            ReadReason::CutOff(_)
        ));
    }
}

#[test]
fn gltf_that_lies() {
    let sound = String::from_utf8(files().pop().unwrap().1).unwrap();
    for (from, to) in [
        (r#""nodes":[{"mesh":0}]"#, r#""nodes":[{"children":[0]}]"#),
        (r#""count":3"#, r#""count":4000000000"#),
        (r#""count":3"#, r#""count":0"#),
        (
            r#""byteLength":36}]"#,
            r#""byteLength":36,"byteStride":4}]"#,
        ),
        (
            r#""byteLength":36}]"#,
            r#""byteOffset":18446744073709551600,"byteLength":36}]"#,
        ),
        (r#""componentType":5126"#, r#""componentType":5123"#),
        (r#""VEC3""#, r#""VEC4""#),
        (r#""POSITION":0"#, r#""POSITION":7"#),
        (r#"{"POSITION":0}"#, r#"{"POSITION":0},"indices":0"#),
        ("base64,AAAA", "base64,A*AA"),
        (
            "data:application/octet-stream;base64,",
            "http://example.com/",
        ),
        (
            r#""scenes""#,
            r#""extensionsRequired":["KHR_draco_mesh_compression"],"scenes""#,
        ),
    ] {
        assert!(sound.contains(from), "{from}");
        reason(parse(Format::Gltf, &sound.replacen(from, to, 1)));
    }
}

#[test]
fn files_that_are_something_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        read(&path)
            .map(|read| read.mesh.triangles.len())
            .unwrap_err()
    };
    assert_eq!(at("it.obj", b"").reason, ReadReason::Empty);
    assert_eq!(at("it.glb", b" \n ").reason, ReadReason::Empty);
    assert_eq!(
        at("it.glb", b"\x89PNG\r\n\x1a\n....").reason,
        ReadReason::NotWhatItSays(Format::Glb)
    );
    assert_eq!(
        at("it.ply", b"hello").reason,
        ReadReason::NotWhatItSays(Format::Ply)
    );
    assert_eq!(at("it.txt", b"hello").reason, ReadReason::UnknownFormat);
    assert_eq!(at("it.obj", b"hello").reason, ReadReason::NoFaces);
    assert_eq!(
        at("it.3mf", b"PK\x03\x04....").reason,
        ReadReason::WriteOnly
    );
    assert!(matches!(
        at("it.stl", b"hello").reason,
        ReadReason::CutOff(_)
    ));
    assert_eq!(read(folder.path()).unwrap_err().reason, ReadReason::Folder);
    let gone = read(&folder.path().join("gone.stl")).unwrap_err();
    assert_eq!(
        gone.to_string(),
        "gone.stl is not there. Check the name and the folder."
    );
}

#[test]
fn meshes_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let to = |name: &str, mesh: &TriMesh| {
        let error = write(
            &folder.path().join(name),
            &[Named::new("part", mesh)],
            &WriteOptions::default(),
        )
        .unwrap_err();
        assert!(
            error.to_string().lines().count() == 1
                && error
                    .to_string()
                    .starts_with(Path::new(name).file_name().unwrap().to_str().unwrap()),
            "{error}"
        );
        println!("{error}");
        error.reason
    };
    std::fs::write(folder.path().join("file"), "").unwrap();
    std::fs::create_dir(folder.path().join("folder.stl")).unwrap();
    assert_eq!(to("it.fbx", &cube()), WriteReason::UnknownFormat);
    assert_eq!(to("it", &cube()), WriteReason::UnknownFormat);
    assert_eq!(to("it.gltf", &cube()), WriteReason::UnknownFormat);
    assert_eq!(to("it.stl", &TriMesh::default()), WriteReason::NoFaces);
    assert_eq!(to("gone/it.stl", &cube()), WriteReason::NoFolder);
    assert_eq!(to("file/it.stl", &cube()), WriteReason::NoFolder);
    assert_eq!(to("folder.stl", &cube()), WriteReason::Folder);
    let mut mesh = cube();
    mesh.positions[0] = Vec3::splat(1e37);
    assert_eq!(to("it.stl", &mesh), WriteReason::TooLarge(Unit::Mm));
    mesh.positions[0].x = f32::NAN;
    assert_eq!(to("it.obj", &mesh), WriteReason::Unsound("part".into()));
    let mut mesh = cube();
    mesh.triangles[0][0] = 8;
    assert_eq!(to("it.ply", &mesh), WriteReason::Unsound("part".into()));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_takes_nothing() {
    // No file can be made here, by any user.
    let error = write(
        Path::new("/proc/it.stl"),
        &[Named::new("it", &cube())],
        &WriteOptions::default(),
    )
    .unwrap_err();
    assert_eq!(error.to_string().lines().count(), 1);
}

#[test]
fn an_old_file_stays_until_the_new_one_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("it.ply");
    write(
        &path,
        &[Named::new("it", &cube())],
        &WriteOptions::default(),
    )
    .unwrap();
    let before = std::fs::read(&path).unwrap();
    write(
        &path,
        &[Named::new("it", &TriMesh::default())],
        &WriteOptions::default(),
    )
    .unwrap_err();
    assert_eq!(std::fs::read(&path).unwrap(), before);
    write(
        &path,
        &[Named::new("it", &sphere(1.0, 1))],
        &WriteOptions::default(),
    )
    .unwrap();
    assert_ne!(std::fs::read(&path).unwrap(), before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
