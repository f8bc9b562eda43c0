//! Lines and strokes on screen: thin lines with their keypoints, strokes as tubes. Each is a mesh of its own, made
//! anew only when it changes itself.

use bevy::light::NotShadowCaster;
use bevy::math::DVec3;
use bevy::prelude::*;
use midair_document::{ConstructionLine, Kind, affine};
use midair_mesh::TriMesh;
use midair_solid::tube;

use super::{ObjectEntity, to_bevy_mesh};
use crate::hands::Hands;
use crate::project::Project;

/// Metres from the middle of a construction line to its side, as a hand sees it.
const THIN: f64 = 0.0015;
/// The same in pixels of a screen, at least: thinner it would be a row of dots.
const THIN_PIXELS: f64 = 0.8;
/// The eye of a screen has moved when it is in another cube of this side, in metres.
const STEP: f32 = 0.2;
/// Metres from a keypoint to the tips of its mark.
const TICK: f64 = 0.0045;
/// Flat sides around a stroke.
const SIDES: usize = 10;

/// What of a drawing an entity shows, and at which size.
#[derive(Component, Default)]
pub(super) struct Inked(pub(super) Option<(Kind, i32)>);

impl Inked {
    /// What it shows.
    pub(super) fn kind(&self) -> Option<&Kind> {
        self.0.as_ref().map(|(kind, _)| kind)
    }
}

/// By what lines are seen: how the world is scaled, and on a screen from where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sight {
    /// Whole powers of two: lines stay as thin in a scaled world, and few are made anew.
    zoom: i32,
    /// Radians of a pixel, and the eye.
    screen: Option<(f32, Vec3)>,
}

impl Sight {
    fn of(hands: &Hands) -> Self {
        let zoom = f64::from(hands.metres_per_world.max(1e-6)).log2().round() as i32;
        let eye = hands.head.filter(|_| hands.pixel > 0.0);
        Self {
            zoom,
            screen: eye.map(|head| (hands.pixel, (head.position / STEP).round() * STEP)),
        }
    }

    /// How much larger than life a line about here is drawn, in half octaves.
    fn size(&self, at: DVec3) -> i32 {
        let own = -2 * self.zoom;
        let Some((pixel, eye)) = self.screen else {
            return own;
        };
        let wide = THIN_PIXELS * f64::from(pixel) * at.distance(eye.as_dvec3());
        own.max((2.0 * (wide / THIN).max(1e-6).log2()).ceil().min(40.0) as i32)
    }
}

pub(super) fn draw(
    project: Res<Project>,
    hands: Res<Hands>,
    mut drawn_at: Local<Option<Sight>>,
    mut meshes: ResMut<Assets<Mesh>>,
    objects: Query<(Entity, &ObjectEntity, Option<&Inked>)>,
    fresh: Query<(), Added<ObjectEntity>>,
    mut commands: Commands,
) {
    let sight = Sight::of(&hands);
    if !project.is_changed() && *drawn_at == Some(sight) && fresh.is_empty() {
        return;
    }
    *drawn_at = Some(sight);
    let document = project.document();
    for (entity, id, inked) in &objects {
        let Some(object) = document.object(id.0) else {
            continue;
        };
        let drawn = matches!(object.kind, Kind::Line(_) | Kind::Stroke(_));
        let shown = inked.and_then(|i| i.0.as_ref());
        let size = match &object.kind {
            Kind::Line(line) => {
                sight.size(affine(&object.placement).transform_point3(line.a.midpoint(line.b)))
            }
            // A stroke is as wide as it is.
            _ => 0,
        };
        if !drawn || shown.is_some_and(|(kind, at)| *at == size && same(kind, &object.kind)) {
            continue;
        }
        let unit = f64::from(0.5 * size as f32).exp2();
        let mesh = match &object.kind {
            Kind::Line(line) => line_mesh(line, unit),
            Kind::Stroke(stroke) => {
                tube(&stroke.points(), 0.5 * stroke.width, stroke.closed, SIDES)
            }
            _ => continue,
        };
        let handle = meshes.add(to_bevy_mesh(&mesh));
        commands.entity(entity).insert((
            Mesh3d(handle),
            NotShadowCaster,
            Inked(Some((object.kind.clone(), size))),
        ));
    }
}

/// Strokes are shared: the same one needs no look at its points.
fn same(a: &Kind, b: &Kind) -> bool {
    match (a, b) {
        (Kind::Stroke(a), Kind::Stroke(b)) => std::sync::Arc::ptr_eq(a, b) || a == b,
        _ => a == b,
    }
}

/// A line as a thin prism, and an octahedron at each keypoint.
fn line_mesh(line: &ConstructionLine, unit: f64) -> TriMesh {
    let mut mesh = tube(&line.ends(), THIN * unit, false, 6);
    // Ticks of short lines do not hide them.
    let size = (TICK * unit).min(0.1 * line.a.distance(line.b));
    for at in line.keypoints() {
        octahedron(&mut mesh, at, size);
    }
    mesh
}

fn octahedron(mesh: &mut TriMesh, at: DVec3, size: f64) {
    let first = mesh.positions.len() as u32;
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        for side in [axis, -axis] {
            mesh.positions.push((at + side * size).as_vec3());
            mesh.normals.push(side.as_vec3());
        }
    }
    for (x, y, z) in [
        (0, 2, 4),
        (2, 1, 4),
        (1, 3, 4),
        (3, 0, 4),
        (2, 0, 5),
        (1, 2, 5),
        (3, 1, 5),
        (0, 3, 5),
    ] {
        mesh.triangles.push([first + x, first + y, first + z]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_screen_a_line_is_a_line_from_however_far() {
        let pixel = 0.001_f32;
        for far in [0.2, 1.0, 4.0, 30.0] {
            let sight = Sight {
                zoom: 0,
                screen: Some((pixel, Vec3::Z * far)),
            };
            let wide = 2.0 * THIN * (0.5 * f64::from(sight.size(DVec3::ZERO))).exp2();
            let pixels = wide / f64::from(pixel * far);
            assert!(pixels > 1.59, "{far} m away it is {pixels} pixels wide");
            assert!(
                pixels < 2.3 || wide < 2.0 * THIN + 1e-9,
                "{far} m away it is {pixels} pixels wide"
            );
        }
        // In a headset it is as the world is scaled.
        let worn = Sight {
            zoom: 2,
            screen: None,
        };
        assert_eq!(worn.size(DVec3::X * 9.0), -4);
    }

    #[test]
    fn a_line_has_a_mark_at_each_keypoint_and_no_hole() {
        let line = ConstructionLine {
            ticks: vec![0.2],
            ..ConstructionLine::raw(DVec3::ZERO, DVec3::X)
        };
        let mesh = line_mesh(&line, 1.0);
        assert_eq!(
            mesh.triangles.len(),
            tube(&line.ends(), THIN, false, 6).triangles.len() + 4 * 8
        );
        assert!(mesh.volume() > 0.0);
        let mut one = TriMesh::default();
        octahedron(&mut one, DVec3::ZERO, 0.5);
        assert!((one.volume() - 0.5 / 3.0).abs() < 1e-6, "{}", one.volume());
    }
}
