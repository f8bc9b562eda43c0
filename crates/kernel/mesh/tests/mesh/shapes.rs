use glam::{Affine3A, Quat, Vec3};
use midair_mesh::{BytesError, TriMesh, check, from_bytes, to_bytes};

use crate::solids::{cube, cuboid, sphere, together};

#[test]
fn volume_and_area_do_not_depend_on_the_place() {
    let far = cuboid(Vec3::splat(1000.0), Vec3::splat(1000.5));
    assert!((far.volume() - 0.125).abs() < 1e-12 && (far.area() - 1.5).abs() < 1e-12);
    assert_eq!(
        (TriMesh::default().volume(), TriMesh::default().area()),
        (0.0, 0.0)
    );
}

#[test]
fn normals_of_a_sphere_point_outwards() {
    let mut mesh = sphere(1e-20, 4);
    mesh.compute_normals();
    for (n, p) in mesh.normals.iter().zip(&mesh.positions) {
        assert!(n.dot((*p * 1e20).normalize()) > 0.999 && n.is_normalized());
    }
    // A cube's corner looks the same however its faces are cut.
    let mut mesh = cube();
    mesh.compute_normals();
    assert!(
        mesh.normals
            .iter()
            .zip(&mesh.positions)
            .all(|(n, p)| n.dot(p.normalize()) > 0.9999)
    );
}

#[test]
fn moving_keeps_a_solid_a_solid() {
    let mut mesh = sphere(1.0, 3);
    mesh.compute_normals();
    let turned = Affine3A::from_scale_rotation_translation(
        Vec3::new(-1.0, 2.0, 0.5),
        Quat::from_rotation_x(1.0),
        Vec3::ONE,
    );
    let moved = mesh.transformed(&turned);
    assert!(check(&moved).is_faultless());
    assert!((moved.volume() - mesh.volume()).abs() < 1e-5);
    let mut again = moved.clone();
    again.compute_normals();
    assert!(
        moved
            .normals
            .iter()
            .zip(&again.normals)
            .all(|(a, b)| a.dot(*b) > 0.97 && a.is_normalized())
    );
    assert_eq!(mesh.transformed(&Affine3A::IDENTITY).hash(), mesh.hash());
}

#[test]
fn normalised_meshes_are_centred_and_sized() {
    let mesh = cuboid(Vec3::new(3.0, 1.0, 1.0), Vec3::new(5.0, 2.0, 1.5));
    let (normal, scale, centre) = mesh.normalised(0.4);
    assert_eq!((scale, centre), (0.2, Vec3::new(4.0, 1.5, 1.25)));
    assert!((normal.bounds().size().max_element() - 0.4).abs() < 1e-6);
    assert!(normal.bounds().centre().length() < 1e-6);
    let (point, scale, _) = TriMesh {
        positions: vec![Vec3::ONE; 3],
        ..TriMesh::default()
    }
    .normalised(0.4);
    assert_eq!((scale, point.positions[0]), (1.0, Vec3::ZERO));
    assert_eq!(TriMesh::default().normalised(0.4).1, 1.0);
}

#[test]
fn pieces_come_apart_whole() {
    let [a, b] = [cube(), cuboid(Vec3::splat(2.0), Vec3::splat(3.0))];
    let mut both = together(&[&a, &b], false);
    both.compute_normals();
    let pieces = both.pieces();
    assert_eq!(pieces.len(), 2);
    assert_eq!(
        (&pieces[0].positions, &pieces[0].triangles),
        (&a.positions, &a.triangles)
    );
    assert_eq!(
        (&pieces[1].positions, &pieces[1].triangles),
        (&b.positions, &b.triangles)
    );
    assert_eq!(pieces[1].normals.len(), 8);
}

#[test]
fn bytes_give_the_same_mesh_bit_for_bit() {
    let mut mesh = sphere(0.3, 3);
    mesh.positions[0] = Vec3::new(-0.0, f32::MIN_POSITIVE / 4.0, 1.0 / 3.0);
    // What reading a file would weld, drop or turn is kept here.
    mesh.positions.push(mesh.positions[1]);
    mesh.triangles.extend([[0, 1, 2], [0, 1, 2], [7, 7, 8]]);
    for with_normals in [false, true] {
        if with_normals {
            mesh.compute_normals();
        }
        let back = from_bytes(&to_bytes(&mesh)).unwrap();
        assert_eq!(back, mesh);
        assert_eq!(back.hash(), mesh.hash());
        assert!(back.positions[0].x.is_sign_negative());
    }
    let none = TriMesh::default();
    assert_eq!(from_bytes(&to_bytes(&none)).unwrap(), none);
}

#[test]
fn damaged_bytes_are_refused() {
    let bytes = to_bytes(&cube());
    for n in 0..bytes.len() {
        assert!(from_bytes(&bytes[..n]).is_err(), "{n}");
    }
    let mut wrong = cube();
    wrong.triangles[0][0] = 8;
    assert_eq!(
        from_bytes(&to_bytes(&wrong)),
        Err(BytesError::IndexOutOfRange)
    );
}
