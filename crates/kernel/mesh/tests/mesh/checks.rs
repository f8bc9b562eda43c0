use glam::Vec3;
use midair_mesh::{TriMesh, check};
use proptest::prelude::*;

use crate::solids::{cube, cuboid, sphere, together, torus};

#[test]
fn a_cube_has_no_fault() {
    let report = check(&cube());
    assert!(report.is_faultless(), "{report}");
    assert_eq!(
        (report.vertices, report.edges, report.triangles),
        (8, 18, 12)
    );
    assert_eq!((report.pieces, report.euler, report.genus), (1, 2, Some(0)));
    assert!((report.volume - 1.0).abs() < 1e-12 && (report.area - 6.0).abs() < 1e-12);
    assert_eq!(report.bounds.size(), Vec3::ONE);
}

#[test]
fn a_sphere_and_a_torus_have_no_fault() {
    let report = check(&sphere(0.3, 5));
    assert!(report.is_faultless(), "{report}");
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.3_f64.powi(3);
    assert!((report.volume / exact - 1.0).abs() < 2e-3);
    let report = check(&torus(60, 20));
    assert!(report.is_faultless(), "{report}");
    assert_eq!((report.genus, report.euler), (Some(1), 0));
}

#[test]
fn an_empty_mesh_is_a_fault() {
    let report = check(&TriMesh::default());
    assert!(!report.watertight);
    assert_eq!(report.faults(), ["1 mesh without triangles"]);
}

#[test]
fn an_open_box_shows_its_rim() {
    let mut mesh = cube();
    mesh.triangles.truncate(10);
    let report = check(&mesh);
    assert!(!report.watertight && report.consistently_wound && report.edge_manifold);
    assert_eq!((report.open_edges, report.genus), (4, None));
    assert_eq!(report.faults(), ["4 open edges"]);
}

#[test]
fn a_flipped_face_is_miswound() {
    let mut mesh = cube();
    mesh.triangles[3].swap(0, 1);
    let report = check(&mesh);
    assert!(report.watertight && !report.consistently_wound);
    assert_eq!(report.miswound_edges, 3);
}

#[test]
fn a_cube_inside_out_has_no_volume() {
    let mut mesh = cube();
    mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let report = check(&mesh);
    assert!(report.consistently_wound && !report.outward);
    assert_eq!(report.faults(), ["1 piece turned inside out"]);
}

#[test]
fn a_hollow_is_no_fault_and_an_inverted_neighbour_is() {
    let turned = |min, max| {
        let mut mesh = cuboid(min, max);
        mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1));
        mesh
    };
    let hollow = together(
        &[&cube(), &turned(Vec3::splat(-0.25), Vec3::splat(0.25))],
        true,
    );
    let report = check(&hollow);
    assert!(report.is_faultless(), "{report}");
    assert!(report.pieces == 2 && (report.volume - 0.875).abs() < 1e-12);
    let beside = together(
        &[&cube(), &turned(Vec3::splat(2.0), Vec3::splat(2.5))],
        true,
    );
    assert_eq!(check(&beside).faults(), ["1 piece turned inside out"]);
}

#[test]
fn cubes_that_share_an_edge_or_a_vertex() {
    let at = |x: f32, y: f32, z: f32| cuboid(Vec3::new(x, y, z), Vec3::new(x, y, z) + 1.0);
    let report = check(&together(&[&at(0.0, 0.0, 0.0), &at(1.0, 1.0, 0.0)], true));
    assert!(report.watertight && report.consistently_wound && !report.edge_manifold);
    assert_eq!(
        (report.crowded_edges, report.self_touching, report.pieces),
        (1, 0, 1)
    );
    let report = check(&together(&[&at(0.0, 0.0, 0.0), &at(1.0, 1.0, 1.0)], true));
    assert!(report.watertight && report.edge_manifold && !report.vertex_manifold);
    assert_eq!(
        (report.pinched_vertices, report.self_touching, report.pieces),
        (1, 0, 2)
    );
    // The same with vertices of their own: they touch instead.
    let apart = together(&[&at(0.0, 0.0, 0.0), &at(1.0, 1.0, 1.0)], false);
    let report = check(&apart);
    assert!(report.vertex_manifold && report.self_touching > 0);
}

#[test]
fn cubes_that_cross_or_touch_are_found() {
    let a = cube();
    for (shift, touches) in [
        (0.5, true),
        (1.0, true),
        (1.0 + f32::EPSILON, false),
        (3.0, false),
    ] {
        let b = cuboid(
            Vec3::splat(-0.5) + Vec3::new(shift, 0.25, 0.125),
            Vec3::splat(0.5) + Vec3::new(shift, 0.25, 0.125),
        );
        let report = check(&together(&[&a, &b], false));
        assert_eq!(report.self_touching > 0, touches, "{shift}\n{report}");
        assert!(report.watertight && report.pieces == 2);
    }
}

#[test]
fn triangles_that_cross_from_a_shared_vertex_are_found() {
    let mut mesh = TriMesh {
        positions: vec![
            Vec3::ZERO,
            Vec3::new(2.0, -1.0, 0.0),
            Vec3::new(2.0, 1.0, 0.0),
            Vec3::new(1.0, 0.0, -1.0),
            Vec3::new(1.0, 0.0, 1.0),
        ],
        normals: vec![],
        triangles: vec![[0, 1, 2], [3, 0, 4]],
    };
    assert_eq!(check(&mesh).self_touching_pairs, [[0, 1]]);
    mesh.positions[3].x = -1.0;
    mesh.positions[4].x = -1.0;
    assert_eq!(check(&mesh).self_touching, 0);
    // In one plane, from one corner: beside each other, then over each other.
    mesh.positions[3] = Vec3::new(2.0, 2.0, 0.0);
    mesh.positions[4] = Vec3::new(0.0, 2.0, 0.0);
    assert_eq!(check(&mesh).self_touching, 0);
    mesh.positions[3] = Vec3::new(2.0, 0.0, 0.0);
    assert_eq!(check(&mesh).self_touching, 1);
}

#[test]
fn a_face_folded_onto_its_neighbour_is_found() {
    let mut mesh = TriMesh {
        positions: vec![
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(0.3, 1.0, 0.0),
            Vec3::new(0.6, 0.5, 0.0),
        ],
        normals: vec![],
        triangles: vec![[0, 1, 2], [1, 0, 3]],
    };
    assert_eq!(check(&mesh).self_touching, 1);
    mesh.positions[3].y = -0.5;
    assert_eq!(check(&mesh).self_touching, 0);
}

#[test]
fn duplicate_and_degenerate_faces_are_counted() {
    let mut mesh = cube();
    mesh.triangles.push(mesh.triangles[0]);
    let [a, b, c] = mesh.triangles[1];
    mesh.triangles.push([c, b, a]);
    assert_eq!(check(&mesh).duplicate_faces, 2);
    let sliver = |height: f32| TriMesh {
        positions: vec![
            Vec3::ONE,
            Vec3::ONE + Vec3::X,
            Vec3::new(1.5, 1.0 + height, 1.0),
        ],
        normals: vec![],
        triangles: vec![[0, 1, 2]],
    };
    assert_eq!(check(&sliver(0.0)).degenerate_faces, 1);
    assert_eq!(check(&sliver(4.0 * f32::EPSILON)).degenerate_faces, 0);
    // Tiny is not degenerate: the rule is relative.
    let tiny = TriMesh {
        positions: vec![Vec3::ZERO, Vec3::X * 1e-20, Vec3::Y * 1e-20],
        normals: vec![],
        triangles: vec![[0, 1, 2]],
    };
    assert_eq!(check(&tiny).degenerate_faces, 0);
}

#[test]
fn corners_without_a_place_are_counted() {
    let mut mesh = cube();
    mesh.positions[0].x = f32::NAN;
    mesh.triangles.push([1, 2, 99]);
    let report = check(&mesh);
    assert!(report.unsound_triangles > 1 && !report.is_faultless());
    assert!(report.volume.is_finite());
}

#[test]
fn a_heap_of_equal_triangles_does_not_hang() {
    let t = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let n = 20_000;
    let mesh = TriMesh {
        positions: (0..n).flat_map(|_| t).collect(),
        normals: vec![],
        triangles: (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    };
    let report = check(&mesh);
    assert!(!report.self_touching_complete && report.self_touching >= 1000);
}

#[test]
fn a_report_prints_one_line_per_fact_and_serialises() {
    let report = check(&cube());
    let text = report.to_string();
    assert!(text.ends_with("no fault found"), "{text}");
    assert!(
        text.lines()
            .all(|line| line.is_char_boundary(20) && !line[18..20].is_empty() && line.len() > 20),
        "{text}"
    );
    let json = serde_json::to_value(&report).unwrap();
    assert_eq!(json["watertight"], true);
    assert_eq!(json["bounds"]["max"][0], 0.5);
}

/// Whether the boxes of two triangles overlap and a fine sampling of one comes close to the other:
/// a slow stand-in for the exact test.
fn near(a: [Vec3; 3], b: [Vec3; 3]) -> f32 {
    let points = |t: [Vec3; 3]| {
        (0..=24)
            .flat_map(move |i| {
                (0..=24 - i).map(move |j| {
                    t[0] + (t[1] - t[0]) * (i as f32 / 24.0) + (t[2] - t[0]) * (j as f32 / 24.0)
                })
            })
            .collect::<Vec<_>>()
    };
    let (a, b) = (points(a), points(b));
    a.iter()
        .flat_map(|p| b.iter().map(|q| p.distance_squared(*q)))
        .fold(f32::MAX, f32::min)
        .sqrt()
}

fn corner() -> impl Strategy<Value = Vec3> {
    (-8_i8..=8, -8_i8..=8, -8_i8..=8)
        .prop_map(|(x, y, z)| Vec3::new(x.into(), y.into(), z.into()) / 8.0)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn touching_agrees_with_sampling(p in prop::array::uniform6(corner())) {
        let mesh = TriMesh { positions: p.to_vec(), normals: vec![], triangles: vec![[0, 1, 2], [3, 4, 5]] };
        let real = |t: usize| { let [a, b, c] = mesh.corners(t); (b - a).cross(c - a).length() > 0.05 };
        prop_assume!(real(0) && real(1));
        let report = check(&mesh);
        let gap = near(mesh.corners(0), mesh.corners(1));
        // Samples lie at most 0.15 apart, so a gap beyond that is one, and touching implies less.
        if report.self_touching == 1 { prop_assert!(gap < 0.15); } else { prop_assert!(gap > 0.0); }
        // Either order and any turn give the same answer.
        let turned = TriMesh { triangles: vec![[5, 3, 4], [2, 0, 1]], ..mesh.clone() };
        prop_assert_eq!(check(&turned).self_touching, report.self_touching);
    }

    #[test]
    fn crossing_segments_are_never_missed(p in prop::array::uniform6(corner()), s in 0.05_f32..0.9, t in 0.05_f32..0.45, u in 0.05_f32..0.45) {
        // The second triangle's first edge runs through a point inside the first triangle.
        let inside = p[0] + (p[1] - p[0]) * t + (p[2] - p[0]) * u;
        let far = inside + (inside - p[3]) * (1.0 / s);
        let mesh = TriMesh { positions: vec![p[0], p[1], p[2], p[3], far, p[5]], normals: vec![], triangles: vec![[0, 1, 2], [3, 4, 5]] };
        let real = |t: usize| { let [a, b, c] = mesh.corners(t); (b - a).cross(c - a).length() > 0.05 };
        let normal = (p[1] - p[0]).cross(p[2] - p[0]);
        prop_assume!(real(0) && real(1) && normal.dot(p[3] - p[0]).abs() > 0.05);
        prop_assert_eq!(check(&mesh).self_touching, 1);
    }
}
