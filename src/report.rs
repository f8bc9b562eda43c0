//! What a session made, for `--report`.

use std::collections::HashMap;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use bevy::math::DVec3;
use bevy::prelude::*;
use midair_csg::Preview;
use midair_document::{Kind, Object, affine};
use midair_field::{MeshSource, Placement, RecipeHash};
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
    // Copies that are turned and scaled alike have one surface.
    let mut known = HashMap::new();
    let objects = document
        .objects()
        .map(|(id, object)| {
            let measure = || {
                let mesh = mesh_of(object, project, &*evaluations.volumes, document.step())?;
                Some(Measured {
                    triangles: mesh.triangles.len(),
                    volume: mesh.volume(),
                    closed: check(&mesh).watertight,
                })
            };
            let measured = match shape_of(object) {
                Some(shape) => *known.entry(shape).or_insert_with(measure),
                None => measure(),
            };
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
                triangles: measured.map_or(0, |m| m.triangles),
                volume: measured.map(|m| m.volume),
                closed: measured.map(|m| m.closed),
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

/// What is told of a surface.
#[derive(Clone, Copy)]
struct Measured {
    triangles: usize,
    volume: f64,
    closed: bool,
}

/// What a surface depends on, wherever it stands: the recipe, and how it is turned and scaled.
fn shape_of(object: &Object) -> Option<(RecipeHash, [u32; 4], [u32; 3])> {
    let (Kind::Solid(recipe) | Kind::Sheet(recipe)) = &object.kind else {
        return None;
    };
    let at = &object.placement;
    let turned = at.rotation.to_array().map(f32::to_bits);
    let scaled = at.scale.to_array().map(f32::to_bits);
    Some((recipe.hash(), turned, scaled))
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
