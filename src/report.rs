//! What a session made, for `--report`.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_csg::Preview;
use midair_document::{Kind, Object, affine};
use midair_field::{MeshSource, Placement};
use midair_mesh::{TriMesh, check};
use midair_playback::{FrameTimes, LineReport, ObjectReport, Report, StrokeReport, UpdateReport};
use midair_solid::surface_of;
use midair_studio::evaluate::Evaluations;
use midair_studio::project::Project;

/// Reads the world at the end of a session.
pub fn probe(world: &mut World) -> Report {
    let project = world.resource::<Project>();
    let evaluations = world.resource::<Evaluations>();
    let document = project.document();
    let history = project.history();
    let objects = document
        .objects()
        .map(|(id, object)| {
            let mesh = mesh_of(object, project, &*evaluations.volumes, document.step());
            let closed = mesh.as_ref().map(|m| check(m).watertight);
            ObjectReport {
                id: id.0,
                kind: match object.kind {
                    Kind::Solid(_) => "solid".to_owned(),
                    Kind::Foreign { ref tool, .. } => tool.clone(),
                    Kind::Reference(_) => "reference".to_owned(),
                    Kind::Line(_) => "line".to_owned(),
                    Kind::Stroke(_) => "stroke".to_owned(),
                    Kind::Sheet(_) => "sheet".to_owned(),
                },
                name: object.name.clone(),
                transform: Mat4::from(object.placement.affine()).to_cols_array(),
                triangles: mesh.as_ref().map_or(0, |m| m.triangles.len()),
                volume: mesh.as_ref().map(TriMesh::volume),
                closed,
            }
        })
        .collect();
    let world_points = |object: &Object, points: &[DVec3]| {
        let there = affine(&object.placement);
        let single = |p: &DVec3| there.transform_point3(*p).as_vec3().to_array();
        points.iter().map(single).collect::<Vec<_>>()
    };
    let lines = document.objects().filter_map(|(_, object)| {
        let line = object.line()?;
        let ends = world_points(object, &line.ends());
        Some(LineReport {
            a: ends[0],
            b: ends[1],
            kept: line.kept.len(),
        })
    });
    let strokes = document.objects().filter_map(|(_, object)| {
        let points = world_points(object, &object.stroke()?.points());
        Some(StrokeReport { points })
    });
    Report {
        objects,
        lines: lines.collect(),
        strokes: strokes.collect(),
        edits: history.committed() as usize,
        undo: history.undo_len(),
        redo: history.redo_len(),
        updates: evaluations
            .updates()
            .iter()
            .map(|u| UpdateReport {
                fuse_ms: u.fuse_ms,
                extract_ms: u.extract_ms,
                triangles: u.triangles,
            })
            .collect(),
        preview_ms: milliseconds(world.resource::<Preview>().took()),
        preview_apart_ms: milliseconds(world.resource::<Preview>().apart()),
        ..Report::default()
    }
}

fn milliseconds(all: impl Iterator<Item = Duration>) -> FrameTimes {
    FrameTimes::of(all.map(|d| d.as_secs_f32() * 1e3).collect())
}

/// The surface in world size, at the document's step.
fn mesh_of(
    object: &Object,
    project: &Project,
    volumes: &dyn MeshSource,
    step: f32,
) -> Option<TriMesh> {
    let about = Placement {
        translation: Vec3::ZERO,
        ..object.placement
    };
    match &object.kind {
        Kind::Solid(recipe) | Kind::Sheet(recipe) => {
            surface_of(recipe, &about, step, volumes, &AtomicBool::new(false)).ok()
        }
        Kind::Foreign { mesh, .. } => project.mesh(mesh).map(|m| m.transformed(&about.affine())),
        Kind::Reference(_) => None,
        Kind::Line(_) | Kind::Stroke(_) => None,
    }
}
