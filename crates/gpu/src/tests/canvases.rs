//! Paintings of the reference suite.

use glam::{Quat, Vec3};
use midair_field::{Canvas, Node, Placement, Primitive, Recipe, Skeleton, Stroke};
use midair_mesh::{Aabb, MeshHash};

use super::support::nested;

/// Every skeleton alone and melted with others, erased, squeezed, and with every kind of blending.
pub fn paintings() -> Vec<(&'static str, Canvas)> {
    let led = |n: u32, radius: f32| {
        let point = |i: u32| {
            let t = i as f32 / n as f32;
            let at = Vec3::new(0.2 * (5.0 * t).sin(), 0.3 * t - 0.15, 0.2 * (7.0 * t).cos());
            at.extend(1.0 - 0.5 * t)
        };
        Stroke::new(Skeleton::Points((0..=n).map(point).collect()), radius)
    };
    let line = Stroke::new(
        Skeleton::Line(Vec3::new(-0.2, 0.0, 0.1), Vec3::new(0.25, 0.1, 0.0)),
        0.04,
    );
    let bay = [
        (-0.2, -0.1),
        (0.2, -0.15),
        (0.05, 0.0),
        (0.2, 0.15),
        (-0.15, 0.1),
    ];
    let bay = bay.map(|(x, y)| Vec3::new(x, 0.3 * x, y));
    let area = Stroke::new(Skeleton::Polygon(bay.into()), 0.05);
    let point = Stroke::point(Vec3::new(0.1, 0.05, 0.02), 0.07);
    // Felt over three steps and more: where less is felt than rounding, the scales of strokes are anybody's guess.
    let wide = |s: &Stroke| Stroke {
        radius: 0.075,
        ..s.clone()
    };
    let with = |strokes: Vec<Stroke>, blend: f32| Canvas {
        strokes,
        blend,
        ..Canvas::default()
    };
    let bite = Stroke {
        erase: true,
        weight: 1.3,
        ..Stroke::point(Vec3::new(0.05, 0.1, 0.05), 0.06)
    };
    let squeezed = Stroke {
        placement: Placement {
            translation: Vec3::new(0.0, 0.1, 0.0),
            rotation: Quat::from_rotation_z(0.4),
            scale: Vec3::new(1.0, 0.8, 1.2),
        },
        ..area.clone()
    };
    let all = || {
        vec![
            led(60, 0.06),
            wide(&line),
            wide(&area),
            bite.clone(),
            wide(&point),
            wide(&squeezed),
        ]
    };
    vec![
        ("a point", with(vec![point.clone()], 1.0)),
        ("a led point", with(vec![led(100, 0.04)], 1.0)),
        ("a line", with(vec![line.clone()], 1.0)),
        ("an area", with(vec![area.clone()], 1.0)),
        ("a squeezed area", with(vec![squeezed.clone()], 1.0)),
        ("strokes that add up", with(all(), 1.0)),
        ("strokes that melt", with(all(), 2.5)),
        ("strokes that do not", with(all(), 20.0)),
    ]
}

/// Solids, baked meshes and paintings as brushes, and strokes that are one; felt over three steps of 0.0125 and more.
pub fn volume_brushes() -> Vec<(&'static str, Canvas)> {
    let mesh = || {
        Recipe::new(Node::Mesh {
            mesh: MeshHash([0; 32]),
            bounds: Aabb::around(Vec3::ZERO, Vec3::splat(0.5)),
        })
    };
    let volume = |r: Recipe, melt: f32| Stroke::new(Skeleton::Volume(r), melt);
    let placed = |at: [f32; 3], turn: f32, scale: [f32; 3]| Placement {
        translation: at.into(),
        rotation: Quat::from_scaled_axis(Vec3::new(turn, 0.4 * turn, -0.7 * turn)),
        scale: scale.into(),
    };
    let at = |s: Stroke, placement: Placement| Stroke { placement, ..s };
    let less = |s: Stroke| Stroke { erase: true, ..s };
    let twin = |s: Stroke, twin: u32| Stroke { twin, ..s };
    let with = |strokes: Vec<Stroke>, blend: f32| Canvas {
        strokes,
        blend,
        ..Canvas::default()
    };
    let led = |n: u32, radius: f32| {
        let point = |i: u32| {
            let t = i as f32 / n as f32;
            let at = Vec3::new(0.3 * (3.0 * t).cos(), 0.3 * (3.0 * t).sin(), 0.16 - 0.1 * t);
            at.extend(1.0)
        };
        Stroke::new(Skeleton::Points((0..=n).map(point).collect()), radius)
    };
    let ball = Primitive::Sphere { radius: 0.12 };
    let inner = || Canvas {
        reach: 2.0,
        ..with(
            vec![
                led(40, 0.075),
                twin(Stroke::point(Vec3::new(0.1, 0.0, 0.1), 0.1), 1),
                twin(Stroke::point(Vec3::new(0.14, 0.03, 0.1), 0.1), 1),
                less(Stroke::point(Vec3::new(0.3, 0.05, 0.15), 0.07)),
            ],
            2.0,
        )
    };
    let painting = |c: Canvas| Recipe::new(Node::Canvas(c));
    let mirrored = |s: &Stroke| {
        let over = placed([0.0; 3], 0.0, [-1.0, 1.0, 1.0]);
        [twin(s.clone(), 7), twin(at(s.clone(), over), 7)]
    };
    let line = Stroke::new(
        Skeleton::Line(Vec3::new(0.02, -0.2, 0.1), Vec3::new(0.25, 0.1, 0.0)),
        0.08,
    );
    let [one, other] = mirrored(&line);
    let [hole, holes] = mirrored(&less(Stroke::point(Vec3::new(0.03, 0.0, 0.1), 0.06)));
    let [a, b] = mirrored(&volume(painting(inner()), 0.05));
    vec![
        ("a mesh as a brush", with(vec![volume(mesh(), 0.09)], 1.0)),
        (
            "a mesh that was painted on",
            with(
                vec![
                    volume(mesh(), 0.09),
                    led(60, 0.075),
                    less(Stroke::point(Vec3::new(0.2, 0.2, 0.1), 0.08)),
                ],
                2.0,
            ),
        ),
        (
            "solids as brushes",
            with(
                vec![
                    at(
                        volume(nested(), 0.1),
                        placed([0.05, 0.0, 0.0], 0.4, [1.0, 0.9, 1.1]),
                    ),
                    volume(ball.clone().into(), 0.09),
                    less(at(
                        volume(mesh(), 0.05),
                        placed([-0.1, 0.1, 0.0], 1.0, [0.4; 3]),
                    )),
                ],
                1.0,
            ),
        ),
        (
            "a painting as a brush",
            with(
                vec![
                    at(
                        volume(painting(inner()), 0.05),
                        placed([0.05, 0.1, 0.0], 0.3, [1.0, 0.8, 1.2]),
                    ),
                    at(line.clone(), placed([0.0; 3], 0.0, [1.2; 3])),
                ],
                3.0,
            ),
        ),
        (
            "a painting that has a painting in it",
            with(
                vec![
                    volume(
                        painting(with(
                            vec![
                                at(
                                    volume(painting(inner()), 0.05),
                                    placed([0.0, 0.05, 0.0], -0.4, [0.9; 3]),
                                ),
                                volume(ball.into(), 0.09),
                            ],
                            1.0,
                        )),
                        0.05,
                    ),
                    less(Stroke::point(Vec3::new(0.1, 0.1, 0.1), 0.07)),
                ],
                1.5,
            ),
        ),
        (
            "strokes that are one",
            with(vec![one, other, hole, holes], 1.0),
        ),
        ("paintings that are one", with(vec![a, b], 2.0)),
    ]
}
