use std::io::{Cursor, Read as _};

use glam::{Vec2, Vec3};
use midair_mesh::{
    Finish, Format, Named, TriMesh, Unit, WriteOptions, check, encode, read, read_as, read_bytes,
    read_bytes_as, write,
};

use crate::solids::{cube, cuboid, sphere, torus};

const LOSSLESS: [Format; 3] = [Format::Glb, Format::Obj, Format::Ply];

fn bytes(format: Format, mesh: &TriMesh) -> Vec<u8> {
    encode(format, &[Named::new("it", mesh)], &WriteOptions::default()).unwrap()
}

#[test]
fn metres_come_back_bit_for_bit() {
    let mesh = sphere(0.123_456_79, 3);
    for format in LOSSLESS {
        let back = read_bytes(&bytes(format, &mesh), format, "it").unwrap();
        let corners = |mesh: &TriMesh| {
            (0..mesh.triangles.len())
                .map(|t| mesh.corners(t))
                .collect::<Vec<_>>()
        };
        assert_eq!(corners(&back.mesh), corners(&mesh), "{format}");
        assert_eq!(back.mesh.positions.len(), mesh.positions.len());
        // An OBJ comes back with its vertices in the order of the faces.
        assert!(format == Format::Obj || back.mesh.hash() == mesh.hash());
        assert!(back.warnings.is_empty(), "{:?}", back.warnings);
    }
}

#[test]
fn stl_is_in_millimetres() {
    let mesh = cube();
    let file = bytes(Format::Stl, &mesh);
    assert_eq!(file.len(), 84 + 50 * 12);
    assert_eq!(
        f32::from_le_bytes(file[96..100].try_into().unwrap()).abs(),
        500.0
    );
    let back = read_bytes(&file, Format::Stl, "it").unwrap().mesh;
    assert_eq!(back.positions.len(), 8);
    assert!(check(&back).is_faultless() && back.volume() == 1.0);
    let metres = read_bytes_as(&file, Format::Stl, "it", Some(Unit::M))
        .unwrap()
        .mesh;
    assert_eq!(metres.bounds().size(), Vec3::splat(1000.0));
}

#[test]
fn any_format_can_be_in_any_unit() {
    let mesh = torus(12, 8);
    for format in [Format::Glb, Format::Obj, Format::Stl, Format::Ply] {
        for unit in Unit::ALL {
            let options = WriteOptions { unit: Some(unit) };
            let file = encode(format, &[Named::new("it", &mesh)], &options).unwrap();
            let back = read_bytes_as(&file, format, "it", Some(unit)).unwrap().mesh;
            assert!(
                (back.volume() / mesh.volume() - 1.0).abs() < 1e-5,
                "{format} {unit}"
            );
            assert!(check(&back).is_faultless(), "{format} {unit}");
        }
    }
    assert_eq!("inch".parse(), Ok(Unit::Inch));
    assert!(
        "yard"
            .parse::<Unit>()
            .unwrap_err()
            .to_string()
            .contains("mm, cm, m or inch")
    );
}

#[test]
fn tiny_triangles_stay_closed_in_millimetres() {
    // Steps of one unit in the last place between 1.024 and 2: in millimetres they would collapse.
    let step = |n: u32| Vec3::splat(f32::from_bits(1.03_f32.to_bits() + n));
    let mesh = cuboid(step(0), step(3));
    let fine = sphere(1.0, 6);
    let fine = TriMesh {
        positions: fine.positions.iter().map(|&p| p * 2e-6 + 1.5).collect(),
        ..fine
    };
    for mesh in [
        mesh,
        read_bytes(&bytes(Format::Ply, &fine), Format::Ply, "it")
            .unwrap()
            .mesh,
    ] {
        let open = check(&mesh);
        for unit in Unit::ALL {
            let options = WriteOptions { unit: Some(unit) };
            let file = encode(Format::Stl, &[Named::new("it", &mesh)], &options).unwrap();
            let back = read_bytes_as(&file, Format::Stl, "it", Some(unit)).unwrap();
            assert_eq!(back.mesh.positions.len(), mesh.positions.len(), "{unit}");
            let report = check(&back.mesh);
            assert_eq!(
                (report.watertight, report.triangles),
                (open.watertight, open.triangles),
                "{unit}"
            );
            assert!(back.warnings.is_empty());
        }
    }
}

#[test]
fn normals_travel_in_glb_and_ply() {
    let mut mesh = sphere(1.0, 3);
    mesh.compute_normals();
    for format in [Format::Glb, Format::Ply] {
        let back = read_bytes(&bytes(format, &mesh), format, "it")
            .unwrap()
            .mesh;
        assert_eq!(back, mesh, "{format}");
    }
}

#[test]
fn several_objects_stay_several_where_the_format_can() {
    let [a, b] = [cube(), cuboid(Vec3::splat(2.0), Vec3::splat(3.0))];
    let both = [Named::new("left & <right>", &a), Named::new("b\nc", &b)];
    for format in [Format::Glb, Format::Obj, Format::Stl, Format::Ply] {
        let file = encode(format, &both, &WriteOptions::default()).unwrap();
        let back = read_bytes(&file, format, "it").unwrap().mesh;
        let report = check(&back);
        assert!(
            report.is_faultless() && report.pieces == 2,
            "{format}\n{report}"
        );
        assert!((report.volume - 2.0).abs() < 1e-6);
    }
    let obj =
        String::from_utf8(encode(Format::Obj, &both, &WriteOptions::default()).unwrap()).unwrap();
    assert_eq!(obj.lines().filter(|line| line.starts_with("o ")).count(), 2);
    let glb = encode(Format::Glb, &both, &WriteOptions::default()).unwrap();
    let glb = gltf::Gltf::from_slice(&glb).unwrap();
    let names: Vec<_> = glb
        .nodes()
        .map(|node| node.name().unwrap().to_owned())
        .collect();
    assert_eq!(names, ["left & <right>", "b\nc"]);
}

#[test]
fn looks_travel_in_glb_one_material_for_all_that_look_alike() {
    let mesh = cube();
    let red = Finish {
        colour: [255, 0, 128],
        opacity: 0.5,
        roughness: 0.25,
        metallic: 1.0,
    };
    let parts = [
        Named::new("a", &mesh).finished(Some(red)),
        Named::new("b", &mesh),
        Named::new("c", &mesh).finished(Some(red)),
    ];
    let file = encode(Format::Glb, &parts, &WriteOptions::default()).unwrap();
    let file = gltf::Gltf::from_slice(&file).unwrap();
    assert_eq!(file.materials().count(), 1);
    let of = |i: usize| {
        let mesh = file.meshes().nth(i).unwrap();
        mesh.primitives().next().unwrap().material().index()
    };
    assert_eq!([of(0), of(1), of(2)], [Some(0), None, Some(0)]);
    let material = file.materials().next().unwrap();
    assert_eq!(material.alpha_mode(), gltf::material::AlphaMode::Blend);
    let pbr = material.pbr_metallic_roughness();
    assert_eq!((pbr.roughness_factor(), pbr.metallic_factor()), (0.25, 1.0));
    let [r, g, b, a] = pbr.base_color_factor();
    assert_eq!([r, g, a], [1.0, 0.0, 0.5]);
    // 128 of 255 in sRGB is 21.6 % of the light.
    assert!((b - 0.2159).abs() < 1e-4, "{b}");
}

#[test]
fn a_3mf_package_holds_millimetres_and_names() {
    let [a, b] = [cube(), sphere(0.25, 3)];
    let file = encode(
        Format::ThreeMf,
        &[Named::new("a & <b>", &a), Named::new("", &b)],
        &WriteOptions::default(),
    )
    .unwrap();
    let models = threemf::read(Cursor::new(&file)).unwrap();
    let [model] = models.as_slice() else {
        panic!("{} models", models.len())
    };
    assert!(matches!(model.unit, threemf::model::Unit::Millimeter));
    assert_eq!(model.build.item.len(), 2);
    assert_eq!(model.resources.object[0].name.as_deref(), Some("a & <b>"));
    for (object, mesh) in model.resources.object.iter().zip([&a, &b]) {
        let shape = object.mesh.as_ref().unwrap();
        let back = TriMesh {
            positions: shape
                .vertices
                .vertex
                .iter()
                .map(|v| Vec3::new(v.x as f32, v.y as f32, v.z as f32))
                .collect(),
            normals: vec![],
            triangles: shape
                .triangles
                .triangle
                .iter()
                .map(|t| [t.v1, t.v2, t.v3].map(|v| v as u32))
                .collect(),
        };
        assert_eq!(back.triangles, mesh.triangles);
        assert!(check(&back).is_faultless());
        assert!((back.volume() / mesh.volume() / 1e9 - 1.0).abs() < 1e-5);
    }
    // The parts that a slicer looks for.
    let mut zip = zip::ZipArchive::new(Cursor::new(&file)).unwrap();
    for part in ["[Content_Types].xml", "_rels/.rels", "3D/model.model"] {
        let mut text = String::new();
        zip.by_name(part)
            .unwrap()
            .read_to_string(&mut text)
            .unwrap();
        assert!(text.starts_with("<?xml"), "{part}: {text:.60}");
    }
}

#[test]
fn the_same_mesh_gives_the_same_bytes() {
    let mut mesh = sphere(0.2, 4);
    mesh.compute_normals();
    for format in [
        Format::Glb,
        Format::Obj,
        Format::Stl,
        Format::Ply,
        Format::ThreeMf,
    ] {
        assert_eq!(bytes(format, &mesh), bytes(format, &mesh), "{format}");
    }
}

#[test]
fn files_are_written_and_read_by_name() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.glb", "a.OBJ", "ä b.stl", "a.ply"] {
        let path = folder.path().join(name);
        write(
            &path,
            &[Named::new("it", &cube())],
            &WriteOptions::default(),
        )
        .unwrap();
        let back = read(&path).unwrap();
        assert_eq!(back.mesh.volume(), 1.0);
        assert_eq!(back.name, name.rsplit_once('.').unwrap().0);
    }
    let path = folder.path().join("a.3mf");
    write(
        &path,
        &[Named::new("it", &cube())],
        &WriteOptions::default(),
    )
    .unwrap();
    assert!(path.metadata().unwrap().len() > 500);
    // Nothing else is left in the folder.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 5);
}

#[test]
fn a_wrong_name_is_read_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    for format in [Format::Glb, Format::Stl, Format::Ply, Format::Obj] {
        for name in ["it.obj", "it.glb", "it.stl", "it.ply", "it.xyz", "it"] {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes(format, &cube())).unwrap();
            let back = read(&path).unwrap();
            assert_eq!(back.mesh.volume(), 1.0, "{format} {name}");
            let wrong = Format::from_path(&path).is_some_and(|f| f != format);
            assert_eq!(
                back.warnings.len(),
                usize::from(wrong),
                "{:?}",
                back.warnings
            );
            if wrong {
                assert!(
                    back.warnings[0].contains(&format!("{name} is really")),
                    "{}",
                    back.warnings[0]
                );
            }
        }
    }
}

#[test]
fn text_stl_in_its_many_forms() {
    let solid = |name: &str, z: f32| {
        let tetrahedron = [
            "0 0 0 0 1 0 1 0 0",
            "0 0 0 1 0 0 0 0 1",
            "0 0 0 0 0 1 0 1 0",
            "1 0 0 0 1 0 0 0 1",
        ];
        let mut text = format!("solid{name}\n");
        for t in tetrahedron {
            let n: Vec<f32> = t.split(' ').map(|n| n.parse().unwrap()).collect();
            text += "  facet normal 0 0 0\n    outer loop\n";
            for v in n.chunks(3) {
                text += &format!("      vertex {} {:e} {}\n", v[0], v[1], v[2] + z);
            }
            text += "    endloop\n  endfacet\n";
        }
        text + &format!("endsolid{name}\n")
    };
    let one = solid(" a b", 0.0);
    for text in [
        one.clone(),
        one.to_uppercase(),
        one.replace('\n', "\r\n"),
        solid("", 0.0),
        format!("\n  {one}\n\n"),
    ] {
        let back = read_bytes_as(text.as_bytes(), Format::Stl, "it", Some(Unit::M))
            .unwrap()
            .mesh;
        assert!(check(&back).is_faultless() && (back.volume() - 1.0 / 6.0).abs() < 1e-6);
    }
    let two = solid(" a", 0.0) + &solid(" b", 5.0);
    assert_eq!(
        read_bytes(two.as_bytes(), Format::Stl, "it")
            .unwrap()
            .mesh
            .pieces()
            .len(),
        2
    );
    // A binary file may begin with the word that marks text.
    let mut binary = bytes(Format::Stl, &cube());
    binary[..12].copy_from_slice(b"solid cube\n\0");
    assert_eq!(
        read_bytes(&binary, Format::Stl, "it")
            .unwrap()
            .mesh
            .volume(),
        1.0
    );
}

#[test]
fn obj_in_its_many_forms() {
    let text = "\u{feff}# a pyramid\r\nmtllib none.mtl\no first\nv 0 0 0 # here\nv 1 0 0 0.5 0.5 0.5\nv 1 0 1 1.0\nv 0 0 1 1 0 0 1\n\
        vt 0 0\nvn 0 1 0\nusemtl red\ng side\nv .5 1 .5\nf -5/1/1 -4/1/1 -3//1 \\\n -2\nf 5 2 1\ns off\no second\nf 5 3 2\nf 5 4 3\nf 5 1 4\nl 1 2\np 1\n";
    let back = read_bytes(text.as_bytes(), Format::Obj, "it").unwrap();
    let report = check(&back.mesh);
    assert!(report.is_faultless(), "{report}");
    assert!((report.volume - 1.0 / 3.0).abs() < 1e-6);
    assert_eq!(back.warnings, ["2 points and lines were left out"]);
}

#[test]
fn ply_in_its_many_forms() {
    let head = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty double x\nproperty float64 y\nproperty float z\nproperty uchar red\n\
        element face 5\nproperty list uchar int vertex_index\nproperty int label\nelement edge 1\nproperty int a\nend_header\n";
    let text = format!("{head}0 0 0 1\n1 0 0 1\n1 0 1 2\n0 0 1 3\n0.5 1e0 .5 4\n4 0 1 2 3 7\n3 4 1 0 7\n3 4 2 1 7\n3 4 3 2 7\n3 4 0 3 7\n9\n").replace(" .5", " 0.5");
    let back = read_bytes(text.as_bytes(), Format::Ply, "it").unwrap().mesh;
    assert!(check(&back).is_faultless() && (back.volume() - 1.0 / 3.0).abs() < 1e-6);
    // Big-endian, written byte by byte.
    let mut big = b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n".to_vec();
    for p in [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z] {
        big.extend(p.to_array().iter().flat_map(|x| x.to_be_bytes()));
    }
    for t in [[0_i32, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        big.push(3);
        big.extend(t.iter().flat_map(|v| v.to_be_bytes()));
    }
    let back = read_bytes(&big, Format::Ply, "it").unwrap().mesh;
    assert!(check(&back).is_faultless());
}

/// A glTF text with one buffer of a fan, a strip, loose triangles and points, under turned nodes.
fn gltf_text(uri: &str) -> (String, Vec<u8>) {
    let mut buffer = Vec::new();
    for p in cube().positions {
        buffer.extend(p.to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    buffer.extend(cube().triangles.iter().flatten().map(|&v| v as u8));
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"children":[1,2],"translation":[10,0,0]}},{{"mesh":0,"scale":[-2,1,1]}},{{"mesh":1,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1]}},{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}},{{"attributes":{{"POSITION":0}},"mode":0}}]}},
                  {{"primitives":[{{"attributes":{{"POSITION":2}},"mode":5}},{{"attributes":{{"POSITION":2}},"mode":6}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]}},
                     {{"bufferView":1,"componentType":5121,"count":36,"type":"SCALAR"}},
                     {{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]}}],
        "bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":36}}],
        "buffers":[{{"byteLength":{},"uri":"{uri}"}}]}}"#,
        buffer.len()
    );
    (text, buffer)
}

#[test]
fn gltf_nodes_and_buffers() {
    use base64::Engine;
    let folder = tempfile::tempdir().unwrap();
    let (text, buffer) = gltf_text("my%20data.bin");
    std::fs::write(folder.path().join("it.gltf"), &text).unwrap();
    std::fs::write(folder.path().join("my data.bin"), &buffer).unwrap();
    let beside = read(&folder.path().join("it.gltf")).unwrap();
    let inline = format!(
        "data:application/octet-stream;base64,{}",
        base64::engine::general_purpose::STANDARD.encode(&buffer)
    );
    let inside = read_bytes(gltf_text(&inline).0.as_bytes(), Format::Gltf, "it.gltf").unwrap();
    assert_eq!(beside.mesh, inside.mesh);
    let refused = read_bytes(text.as_bytes(), Format::Gltf, "it.gltf")
        .unwrap_err()
        .to_string();
    assert_eq!(
        refused,
        "it.gltf needs the file my%20data.bin, which is not in the archive. Keep the two together, or export it as GLB."
    );

    // The mirrored and stretched box, then two triangles each of strip and fan, one of them in both; the last node is in no scene.
    assert_eq!(beside.mesh.triangles.len(), 12 + 2 + 2 - 1);
    assert_eq!(
        beside.warnings,
        [
            "1 sets of points were left out",
            "1 triangles are there more than once and were kept once"
        ]
    );
    let solid = &beside.mesh.pieces()[0];
    assert!(check(solid).is_faultless());
    assert!((solid.volume() - 2.0).abs() < 1e-6);
    assert_eq!(solid.bounds().centre(), Vec3::new(10.0, 0.0, 0.0));
    assert!(beside.mesh.bounds().max.x == 15.5);
}

#[test]
fn a_unit_can_be_forced_on_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("it.obj");
    write(
        &path,
        &[Named::new("it", &cube())],
        &WriteOptions::default(),
    )
    .unwrap();
    let inches = read_as(&path, Some(Unit::Inch)).unwrap().mesh;
    assert!((inches.bounds().size().x - 0.0254).abs() < 1e-8);
}

#[test]
fn a_million_triangles() {
    let mesh = torus(1000, 500);
    for format in [Format::Glb, Format::Stl, Format::Ply, Format::Obj] {
        let start = std::time::Instant::now();
        let file = bytes(format, &mesh);
        let written = start.elapsed();
        let back = read_bytes(&file, format, "it").unwrap();
        println!(
            "{format}: written in {written:.2?}, read in {:.2?}",
            start.elapsed() - written
        );
        assert_eq!(
            (back.mesh.triangles.len(), back.mesh.positions.len()),
            (1_000_000, 500_000)
        );
    }
}

#[test]
fn places_on_a_picture_are_kept_by_obj_and_glb() {
    let mesh = cube();
    let uv: Vec<Vec2> = mesh.positions.iter().map(|p| p.truncate()).collect();
    let bare = Named::new("bare", &mesh);
    let mapped = Named::new("mapped", &mesh).mapped(uv.clone());
    // Those that do not fit are left out, and the file is sound.
    let odd = Named::new("odd", &mesh).mapped(vec![Vec2::ZERO]);
    let meshes = [bare, mapped, odd];
    let options = WriteOptions::default();
    let obj = encode(Format::Obj, &meshes, &options).unwrap();
    let text = String::from_utf8(obj.clone()).unwrap();
    let count = |start: &str| text.lines().filter(|l| l.starts_with(start)).count();
    assert_eq!(count("vt "), uv.len());
    let own = text
        .lines()
        .filter(|l| l.starts_with("f ") && l.contains('/'));
    assert_eq!(own.count(), mesh.triangles.len());
    assert_eq!(count("f "), 3 * mesh.triangles.len());
    let first = mesh.positions.len() as u32 + 1;
    let [a, b, c] = mesh.triangles[0];
    let face = format!(
        "f {}/{} {}/{} {}/{}",
        a + first,
        a + 1,
        b + first,
        b + 1,
        c + first,
        c + 1
    );
    assert!(text.contains(&face), "{face}");
    let glb = encode(Format::Glb, &meshes, &options).unwrap();
    let read = gltf::Gltf::from_slice(&glb).unwrap();
    let with: Vec<bool> = read
        .meshes()
        .map(|m| {
            let first = m.primitives().next().unwrap();
            first.get(&gltf::Semantic::TexCoords(0)).is_some()
        })
        .collect();
    assert_eq!(with, [false, true, false]);
    // Three in one place are one.
    for (format, bytes) in [(Format::Obj, obj), (Format::Glb, glb)] {
        let back = read_bytes(&bytes, format, "it").unwrap().mesh;
        assert_eq!(back.triangles.len(), mesh.triangles.len(), "{format}");
    }
}
