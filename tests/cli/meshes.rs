//! Meshes as they come: damaged, mislabelled, large.

use std::time::Instant;

use bevy::math::Vec3;
use midair_mesh::{Format, Named, TriMesh, WriteOptions, encode};

use crate::place::Place;

/// Latitudes and longitudes of a ball: 2·n·(m − 1) triangles, and closed.
fn ball(n: u32, m: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    mesh.positions.push(Vec3::NEG_Y);
    for i in 1..m {
        let up = std::f32::consts::PI * i as f32 / m as f32;
        for j in 0..n {
            let round = std::f32::consts::TAU * j as f32 / n as f32;
            let (y, r) = (-up.cos(), up.sin());
            mesh.positions
                .push(Vec3::new(r * round.cos(), y, r * round.sin()));
        }
    }
    mesh.positions.push(Vec3::Y);
    let (last, at) = ((m - 1) * n + 1, |i: u32, j: u32| 1 + i * n + j % n);
    for j in 0..n {
        mesh.triangles.push([0, at(0, j), at(0, j + 1)]);
        mesh.triangles.push([last, at(m - 2, j + 1), at(m - 2, j)]);
        for i in 0..m - 2 {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
            mesh.triangles.extend([[a, d, b], [a, c, d]]);
        }
    }
    mesh
}

fn bytes(mesh: &TriMesh, format: Format) -> Vec<u8> {
    encode(
        format,
        &[Named::new("ball", mesh)],
        &WriteOptions::default(),
    )
    .unwrap()
}

/// Neither `import` nor `check` takes it, and both say why in one line.
fn refused(place: &Place, name: &str, words: &[&str]) {
    let words = [&[name], words].concat();
    place.refused(&["import", name], &words);
    place.refused(&["check", name], &words);
    let library = place.done(&["library"]);
    assert!(!library.contains("own/"), "nothing was kept: {library}");
}

#[test]
fn damaged_files_are_named() {
    let place = Place::new();
    let cases = [
        (
            "nan.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n",
            "not a number",
        ),
        (
            "inf.obj",
            "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n",
            "not a number",
        ),
        ("points.obj", "v 0 0 0\nv 1 0 0\n", "no faces"),
        ("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", ""),
        (
            "range.obj",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n",
            "damaged",
        ),
        ("empty.stl", "", "empty"),
        ("words.ply", "no mesh at all, only words\n", "not a PLY"),
        (
            "image.glb",
            "\u{89}PNG\r\n\u{1a}\n\0\0\0\rIHDR",
            "not a GLB",
        ),
        ("letter.txt", "Dear reader,\n", "no known type"),
        (
            "nan.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n",
            "damaged",
        ),
    ];
    for (name, text, why) in cases {
        place.write(name, text);
        refused(&place, name, &[why]);
    }
    refused(&place, "missing.glb", &["not there"]);
    std::fs::create_dir(place.path("folder.obj")).unwrap();
    refused(&place, "folder.obj", &["folder"]);
}

#[test]
fn files_that_break_off_are_named() {
    let place = Place::new();
    let ball = ball(24, 12);
    for (ending, format) in [
        ("stl", Format::Stl),
        ("glb", Format::Glb),
        ("ply", Format::Ply),
    ] {
        let whole = bytes(&ball, format);
        for part in [0.03, 0.5, 0.98] {
            let name = format!("cut.{ending}");
            place.write(&name, &whole[..(part * whole.len() as f64) as usize]);
            refused(&place, &name, &[]);
        }
        place.write(&format!("whole.{ending}"), &whole);
        place.done(&["check", &format!("whole.{ending}")]);
    }
}

#[test]
fn a_wrong_name_is_seen_through() {
    let place = Place::new();
    let ball = ball(24, 12);
    place.write("really-ply.stl", bytes(&ball, Format::Ply));
    place.write("really-stl.obj", bytes(&ball, Format::Stl));
    place.write("really-glb", bytes(&ball, Format::Glb));
    for name in ["really-ply.stl", "really-stl.obj", "really-glb"] {
        let said = place.midair(&["check", name]);
        assert_eq!(said.status, 0, "{name}: {}", said.err);
    }
    place.write(
        "archive.3mf",
        crate::archive::of_one("3D/3dmodel.model", b"<model/>"),
    );
    refused(&place, "archive.3mf", &["3MF"]);
}

#[test]
fn a_mesh_with_flipped_and_double_faces_is_taken_and_its_faults_are_told() {
    let place = Place::new();
    let mut faulty = ball(24, 12);
    faulty.triangles[40].swap(0, 1);
    let twice = faulty.triangles[60];
    faulty.triangles.push(twice);
    for format in [("faulty.stl", Format::Stl), ("faulty.ply", Format::Ply)] {
        place.write(format.0, bytes(&faulty, format.1));
        // What reading it mended is said first, then what is wrong with it.
        let said = place.midair(&["check", format.0]);
        assert_eq!(said.status, 1);
        let last = said.err.lines().last().unwrap();
        assert!(last.contains(format.0) && last.contains("edges"), "{last}");
        let said = place.midair(&["import", format.0]);
        assert_eq!(said.status, 0, "{}", said.err);
    }
    let said = place.midair(&["check", "--json", "faulty.ply"]);
    let all: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(all[0]["faultless"], false);
}

#[test]
fn one_bad_mesh_of_several_keeps_no_other_out() {
    let place = Place::new();
    place.write("good.ply", bytes(&ball(24, 12), Format::Ply));
    place.write("bad.obj", "v 0 0 0\n");
    place.refused(&["import", "bad.obj", "good.ply"], &["bad.obj"]);
    assert!(place.done(&["library"]).contains("Good"));
}

#[test]
fn a_million_triangles_come_in() {
    let place = Place::new();
    let million = ball(1000, 501);
    assert_eq!(million.triangles.len(), 1_000_000);
    place.write("million.ply", bytes(&million, Format::Ply));
    let since = Instant::now();
    place.done(&["import", "million.ply"]);
    println!(
        "a million triangles: {:.1} s",
        since.elapsed().as_secs_f64()
    );
}
