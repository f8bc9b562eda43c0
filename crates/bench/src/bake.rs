use std::path::Path;

use glam::Vec3;
use midair_field::bake::{BakeOptions, LONGEST_SIDE, PADDING, Progress, bake};
use midair_mesh::{TriMesh, read};
use serde_json::json;

use crate::catalogue::BenchError;
use crate::figure::Details;
use crate::measure::{Budget, Times, repeat, timed};

/// What is baked.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Subject {
    /// A torus of 25,600 triangles, 128 cells along its box of 2 m.
    Torus,
    /// The same, its grid holding the whole cube [−1, 1]³ m and more.
    TorusCube,
    /// The Stanford bunny as an import scales it, 128 cells along its longest side.
    Bunny,
}

impl Subject {
    pub const ALL: [Self; 3] = [Self::Torus, Self::TorusCube, Self::Bunny];

    pub fn name(self) -> &'static str {
        match self {
            Self::Torus => "bake/torus-25k/128",
            Self::TorusCube => "bake/torus-25k-cube/128",
            Self::Bunny => "bake/bunny/128",
        }
    }

    fn options(self) -> BakeOptions {
        let (step, padding) = match self {
            Self::Torus => (2.0 / 128.0, 0.15),
            Self::TorusCube => (2.0 / 128.0, 0.75),
            Self::Bunny => ((LONGEST_SIDE + 2.0 * PADDING) / 128.0, PADDING),
        };
        BakeOptions { step, padding }
    }

    /// The mesh, or in one line why there is none.
    pub fn mesh(self) -> Result<Result<TriMesh, String>, BenchError> {
        match self {
            Self::Torus | Self::TorusCube => Ok(Ok(torus(160, 80, 0.6, 0.25))),
            Self::Bunny => {
                let Some(folder) = std::env::var_os("MIDAIR_MESHES") else {
                    let missing = "set MIDAIR_MESHES to a folder with stanford-bunny.obj";
                    return Ok(Err(missing.to_owned()));
                };
                let mesh = read(&Path::new(&folder).join("stanford-bunny.obj"))?.mesh;
                Ok(Ok(mesh.normalised(LONGEST_SIDE).0))
            }
        }
    }
}

/// A torus around z: `around` × `across` quads, each two triangles.
pub(crate) fn torus(around: u32, across: u32, major: f32, minor: f32) -> TriMesh {
    let angle = |i: u32, n: u32| i as f32 / n as f32 * std::f32::consts::TAU;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..around {
        for j in 0..across {
            let (a, b) = (angle(i, around), angle(j, across));
            let out = major + minor * b.cos();
            positions.push(Vec3::new(out * a.cos(), out * a.sin(), minor * b.sin()));
            let at = |i: u32, j: u32| i % around * across + j % across;
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[p, q, r], [p, r, s]]);
        }
    }
    TriMesh {
        positions,
        normals: Vec::new(),
        triangles,
    }
}

pub(crate) fn run(
    mesh: &TriMesh,
    subject: Subject,
    budget: &Budget,
) -> Result<(Times, Details), BenchError> {
    let options = subject.options();
    let times = repeat(budget, || {
        let mut failed = None;
        let took = timed(|| bake(mesh, &options, &Progress::new()).map_err(|e| failed = Some(e)));
        match failed {
            Some(error) => Err(BenchError::Bake(error)),
            None => Ok(took.into()),
        }
    })?;
    let volume = bake(mesh, &options, &Progress::new())?;
    let mut details = Details::new();
    details.insert("triangles".into(), json!(mesh.triangles.len()));
    details.insert("cells".into(), json!(volume.cells().to_array()));
    details.insert("bytes".into(), json!(volume.bytes()));
    Ok((times, details))
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_mesh::check;

    #[test]
    fn the_torus_is_one() {
        let mesh = torus(160, 80, 0.6, 0.25);
        assert_eq!(mesh.triangles.len(), 25_600);
        assert!(check(&mesh).is_faultless());
        let exact = 2.0 * std::f64::consts::PI.powi(2) * 0.6 * 0.0625;
        assert!((mesh.volume() / exact - 1.0).abs() < 0.01);
    }
}
