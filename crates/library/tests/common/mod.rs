use std::path::PathBuf;

use glam::Vec3;
use midair_field::{Placement, Program, Recipe};
use midair_library::Folders;
use midair_mesh::Aabb;

/// A solid counted on a lattice.
#[allow(dead_code)]
pub struct Samples {
    /// Metres between samples.
    pub step: f32,
    /// The box around the samples inside.
    pub inside: Aabb,
    /// Cubic metres, each sample weighted by how much of its cell the distance says is inside.
    pub volume: f32,
}

/// Samples a recipe of primitives over its box.
#[allow(dead_code)]
pub fn sample(recipe: &Recipe) -> Samples {
    let step = 0.008;
    let program = Program::compile(recipe, &Placement::IDENTITY, step, &()).unwrap();
    let bounds = recipe.bounds().grown(step);
    let count = (bounds.size() / step).ceil().as_uvec3();
    let mut inside = Aabb::EMPTY;
    let mut cells = 0.0_f64;
    for z in 0..=count.z {
        for y in 0..=count.y {
            for x in 0..=count.x {
                let p = bounds.min + Vec3::new(x as f32, y as f32, z as f32) * step;
                let phi = program.at(p);
                assert!(phi.is_finite());
                if phi < 0.0 {
                    inside = inside.including(p);
                }
                cells += f64::from((0.5 - phi / step).clamp(0.0, 1.0));
            }
        }
    }
    Samples {
        step,
        inside,
        volume: (cells * f64::from(step).powi(3)) as f32,
    }
}

/// An empty home of its own.
#[allow(dead_code)]
pub fn home() -> (tempfile::TempDir, Folders) {
    let dir = tempfile::tempdir().unwrap();
    let folders = Folders::below(dir.path());
    (dir, folders)
}

/// The real meshes named by `MIDAIR_MESHES`, or none with a line saying so.
#[allow(dead_code)]
pub fn real_meshes() -> Vec<PathBuf> {
    let Some(folder) = std::env::var_os("MIDAIR_MESHES") else {
        println!("MIDAIR_MESHES is not set: real meshes are skipped");
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "obj"))
        .collect();
    paths.sort();
    paths
}
