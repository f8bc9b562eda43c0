use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use glam::{Quat, Vec3, Vec4};
use midair_field::bake::{BakeOptions, LONGEST_SIDE, Progress, Volume, bake};
use midair_field::{
    Canvas, MeshSource, Node, Placement, Program, Recipe, Skeleton, Stroke, local_step,
};
use midair_gpu::measure::Work;
use midair_mesh::{Aabb, MeshHash, TriMesh};
use midair_solid::Solid;
use serde_json::json;

use crate::catalogue::BenchError;
use crate::figure::Details;
use crate::measure::{Budget, Run, Times, repeat};

/// The drawing space: a cube of one metre, in which steps are 1/128 m, 1/256 m and 1/512 m.
const SPACE: f32 = 1.0;
/// The longest side of a volume brush in it, metres.
const BRUSH: f32 = 0.6;
/// Points of the painting that one more is added to.
const POINTS: usize = 10_000;

/// The volume brushes of 3DBrushVR Table 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Horse,
    Human,
    Wings,
}

impl Shape {
    const ALL: [Self; 3] = [Self::Horse, Self::Human, Self::Wings];

    fn name(self) -> &'static str {
        match self {
            Self::Horse => "horse",
            Self::Human => "human",
            Self::Wings => "wings",
        }
    }

    /// Triangles of the paper's mesh.
    fn triangles(self) -> usize {
        match self {
            Self::Horse => 24_780,
            Self::Human => 24_540,
            Self::Wings => 4_238,
        }
    }

    /// Milliseconds of Table 2 at 128³ on a GTX 1660 Super.
    fn paper(self) -> f64 {
        match self {
            Self::Horse | Self::Human => 23.0,
            Self::Wings => 21.0,
        }
    }

    fn recipe(self) -> Result<Recipe, BenchError> {
        /// The part of a component's file that says what it is.
        #[derive(serde::Deserialize)]
        struct Shelved {
            recipe: Recipe,
        }
        let text = match self {
            Self::Horse => include_str!("../../../assets/components/brush/horse.ron"),
            Self::Human => include_str!("../../../assets/components/brush/human.ron"),
            Self::Wings => include_str!("../../../assets/components/brush/wing.ron"),
        };
        let shelved: Shelved =
            ron::from_str(text).map_err(|e| BenchError::Recipe(self.name(), e))?;
        Ok(shelved.recipe)
    }

    /// Its surface with about as many triangles as the paper's.
    fn mesh(self) -> Result<TriMesh, BenchError> {
        let recipe = self.recipe()?;
        let go = AtomicBool::new(false);
        let make = |step| Solid::make(&recipe, &Placement::IDENTITY, step, &(), &go);
        let first = recipe.bounds().size().max_element() / 96.0;
        let count = make(first)?.surface().triangles().max(1);
        let step = first * (count as f32 / self.triangles() as f32).sqrt();
        Ok(make(step)?.mesh())
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Subject {
    /// A volume brush, baked once, joins a painting: only what it reaches is made again.
    Edit(Shape, u32),
    /// A mesh never seen before becomes a surface: voxelise, smooth, extract.
    Raw(Shape, u32),
    /// The same of a torus of 25,600 triangles, half as large as Blender has it beside it.
    RawTorus(u32),
    /// One more point of a painting of ten thousand.
    Point(u32),
    /// A line joins a painting.
    Line(u32),
    /// A polygon with four corners does.
    Polygon(u32),
    /// A point takes away.
    Erase(u32),
}

impl Subject {
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for shape in Shape::ALL {
            all.extend([128, 256, 512].map(|n| Self::Edit(shape, n)));
        }
        for shape in Shape::ALL {
            all.push(Self::Raw(shape, 128));
        }
        all.push(Self::RawTorus(128));
        all.extend([256, 512].map(Self::Point));
        all.extend([Self::Line(256), Self::Polygon(256), Self::Erase(256)]);
        all
    }

    pub fn name(self) -> String {
        match self {
            Self::Edit(shape, n) => format!("brush/{}/{n}", shape.name()),
            Self::Raw(shape, n) => format!("brush/raw-{}/{n}", shape.name()),
            Self::RawTorus(n) => format!("brush/raw-torus/{n}"),
            Self::Point(n) => format!("brush/point-stroke/{n}"),
            Self::Line(n) => format!("brush/line/{n}"),
            Self::Polygon(n) => format!("brush/polygon/{n}"),
            Self::Erase(n) => format!("brush/erase/{n}"),
        }
    }

    pub fn paper(self) -> Option<f64> {
        match self {
            Self::Edit(shape, 128) | Self::Raw(shape, 128) => Some(shape.paper()),
            // Five frames a second (3DBrushVR §7).
            Self::Edit(_, 256) => Some(200.0),
            _ => None,
        }
    }

    fn step(self) -> f32 {
        let (Self::Edit(_, n)
        | Self::Raw(_, n)
        | Self::RawTorus(n)
        | Self::Point(n)
        | Self::Line(n)
        | Self::Polygon(n)
        | Self::Erase(n)) = self;
        SPACE / n as f32
    }
}

/// The one volume that every mesh names.
struct One(Option<Arc<Volume>>);

impl MeshSource for One {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        self.0.clone()
    }
}

/// A painting to paint on: a body, a neck, a plate, a bite taken out.
fn painting() -> Canvas {
    let line = |a: [f32; 3], b: [f32; 3], r| Stroke::new(Skeleton::Line(a.into(), b.into()), r);
    let bite = Stroke::point(Vec3::new(0.1, 0.16, 0.0), 0.07);
    let corners = [
        [-0.3, -0.2, -0.2],
        [0.3, -0.2, -0.2],
        [0.3, -0.2, 0.2],
        [-0.3, -0.2, 0.2],
    ];
    Canvas {
        strokes: vec![
            Stroke::point(Vec3::ZERO, 0.18),
            line([0.0, 0.1, 0.0], [-0.25, 0.3, 0.0], 0.06),
            Stroke::new(Skeleton::Polygon(corners.map(Vec3::from).into()), 0.04),
            Stroke {
                erase: true,
                ..bite
            },
        ],
        ..Canvas::default()
    }
}

fn with(mut canvas: Canvas, stroke: Stroke) -> Recipe {
    canvas.strokes.push(stroke);
    Recipe::new(Node::Canvas(canvas))
}

/// A brush held a little turned, so that no lattice suits it, its longest side `size` metres.
fn held(bounds: &Aabb, size: f32) -> Placement {
    Placement {
        translation: Vec3::new(0.05, 0.02, 0.01),
        rotation: Quat::from_euler(glam::EulerRot::XYZ, 0.2, 0.5, 0.1),
        scale: Vec3::splat(size / bounds.size().max_element()),
    }
}

fn volume_stroke(mesh: &TriMesh, size: f32) -> Stroke {
    let bounds = mesh.bounds();
    let recipe = Recipe::new(Node::Mesh {
        mesh: MeshHash([0; 32]),
        bounds,
    });
    let radius = 0.08 * bounds.size().max_element();
    Stroke {
        placement: held(&bounds, size),
        ..Stroke::new(Skeleton::Volume(recipe), radius)
    }
}

fn baked(mesh: &TriMesh, size: f32, step: f32) -> Result<One, BenchError> {
    let scale = held(&mesh.bounds(), size).scale.x;
    let options = BakeOptions::with_step(local_step(step, scale));
    Ok(One(Some(Arc::new(bake(mesh, &options, &Progress::new())?))))
}

/// A way through the drawing space that crosses itself.
fn way(n: usize) -> Stroke {
    let at = |i: usize| {
        let t = i as f32 * 0.004;
        let p = Vec3::new((3.1 * t).sin(), (2.3 * t).cos(), (1.7 * t + 0.4).sin());
        (0.4 * p).extend(1.0 + 0.3 * (7.0 * t).sin())
    };
    let points: Vec<Vec4> = (0..n).map(at).collect();
    Stroke::new(Skeleton::Points(points.into()), 0.012)
}

/// A painting before a stroke and after it, and the mesh of that.
struct Scene {
    before: Recipe,
    after: Recipe,
    meshes: One,
}

/// The edits by the card: what is baked and voxelised there has workloads of its own.
pub(crate) fn on_card() -> impl Iterator<Item = Work> {
    let edits = Subject::all()
        .into_iter()
        .filter(|s| !matches!(s, Subject::Raw(..) | Subject::RawTorus(_)));
    edits.map(|subject| {
        Work::new(format!("gpu/{}", subject.name()), move || {
            let step = subject.step();
            let scene = scene(subject, step, &mut Details::new()).map_err(|e| e.to_string())?;
            let compile = |recipe: &Recipe| {
                let at = Placement::IDENTITY;
                Program::compile(recipe, &at, step, &scene.meshes).map_err(|e| e.to_string())
            };
            Ok((Some(compile(&scene.before)?), compile(&scene.after)?))
        })
    })
}

pub(crate) fn run(subject: Subject, budget: &Budget) -> Result<(Times, Details), BenchError> {
    let step = subject.step();
    let go = AtomicBool::new(false);
    let at = Placement::IDENTITY;
    let mut details = Details::new();
    match subject {
        Subject::Raw(shape, _) => return raw(&shape.mesh()?, BRUSH, step, budget),
        Subject::RawTorus(_) => {
            // As an import scales it; 1.7 m of 2/128 m steps are 0.85 m of 1/128 m.
            let torus = crate::bake::torus(160, 80, 0.6, 0.25);
            return raw(&torus.normalised(LONGEST_SIDE).0, 0.85, step, budget);
        }
        _ => {}
    }
    let Scene {
        before,
        after,
        meshes,
    } = scene(subject, step, &mut details)?;
    let base = Solid::make(&before, &at, step, &meshes, &go)?;
    let times = repeat(budget, || {
        let started = Instant::now();
        let solid = base.remake(&after, &at, step, &meshes, &go)?;
        let total = started.elapsed();
        Ok::<_, BenchError>(Run {
            total,
            parts: [("fuse_ms", solid.fuse), ("extract_ms", solid.extract)],
        })
    })?;
    let solid = base.remake(&after, &at, step, &meshes, &go)?;
    details.insert("triangles".into(), json!(solid.surface().triangles()));
    details.insert("bricks".into(), json!(solid.grid().bricks().count()));
    let bytes = solid.surface().bytes() + solid.grid().bricks().count() * 2_100;
    details.insert("bytes".into(), json!(bytes));
    Ok((times, details))
}

fn scene(subject: Subject, step: f32, details: &mut Details) -> Result<Scene, BenchError> {
    let mut meshes = One(None);
    let (before, after) = match subject {
        // Nothing is there before, and nothing is edited.
        Subject::Raw(..) | Subject::RawTorus(_) => {
            let nothing = || Recipe::new(Node::Canvas(Canvas::default()));
            (nothing(), nothing())
        }
        Subject::Edit(shape, _) => {
            let mesh = shape.mesh()?;
            meshes = baked(&mesh, BRUSH, step)?;
            details.insert("mesh triangles".into(), json!(mesh.triangles.len()));
            let before = Recipe::new(Node::Canvas(painting()));
            (before, with(painting(), volume_stroke(&mesh, BRUSH)))
        }
        Subject::Point(_) => {
            let all = |n| {
                let canvas = Canvas {
                    strokes: vec![way(n)],
                    ..Canvas::default()
                };
                Recipe::new(Node::Canvas(canvas))
            };
            (all(POINTS - 1), all(POINTS))
        }
        Subject::Line(_) => {
            let ends = [Vec3::new(-0.2, 0.1, 0.1), Vec3::new(0.25, 0.3, 0.1)];
            let stroke = Stroke::new(Skeleton::Line(ends[0], ends[1]), 0.03);
            let before = Recipe::new(Node::Canvas(painting()));
            (before, with(painting(), stroke))
        }
        Subject::Polygon(_) => {
            let corners = [
                [-0.2, 0.2, -0.1],
                [0.2, 0.2, -0.1],
                [0.2, 0.24, 0.15],
                [-0.2, 0.24, 0.15],
            ];
            let stroke = Stroke::new(Skeleton::Polygon(corners.map(Vec3::from).into()), 0.02);
            let before = Recipe::new(Node::Canvas(painting()));
            (before, with(painting(), stroke))
        }
        Subject::Erase(_) => {
            let bite = Stroke {
                erase: true,
                ..Stroke::point(Vec3::new(-0.1, 0.1, 0.12), 0.06)
            };
            let before = Recipe::new(Node::Canvas(painting()));
            (before, with(painting(), bite))
        }
    };
    Ok(Scene {
        before,
        after,
        meshes,
    })
}

/// From triangles to a closed smooth surface, nothing kept from before.
fn raw(
    mesh: &TriMesh,
    size: f32,
    step: f32,
    budget: &Budget,
) -> Result<(Times, Details), BenchError> {
    let go = AtomicBool::new(false);
    let recipe = with(Canvas::default(), volume_stroke(mesh, size));
    let mut triangles = 0;
    let times = repeat(budget, || {
        let started = Instant::now();
        let meshes = baked(mesh, size, step)?;
        let voxels = started.elapsed();
        let solid = Solid::make(&recipe, &Placement::IDENTITY, step, &meshes, &go)?;
        let total = started.elapsed();
        triangles = solid.surface().triangles();
        Ok::<_, BenchError>(Run {
            total,
            parts: [
                ("voxelise_ms", voxels),
                ("fuse_ms", solid.fuse),
                ("extract_ms", solid.extract),
            ],
        })
    })?;
    let mut details = Details::new();
    details.insert("mesh triangles".into(), json!(mesh.triangles.len()));
    details.insert("triangles".into(), json!(triangles));
    Ok((times, details))
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_mesh::check;

    #[test]
    fn the_brushes_have_about_the_papers_triangles_and_are_closed() {
        for shape in Shape::ALL {
            let mesh = shape.mesh().unwrap();
            let ratio = mesh.triangles.len() as f32 / shape.triangles() as f32;
            assert!((0.8..1.25).contains(&ratio), "{shape:?}: {ratio}");
            assert!(check(&mesh).is_faultless(), "{shape:?}");
        }
    }

    #[test]
    fn an_edit_gives_what_making_it_anew_gives() {
        let mesh = Shape::Wings.mesh().unwrap();
        let step = SPACE / 64.0;
        let meshes = baked(&mesh, BRUSH, step).unwrap();
        let (go, at) = (AtomicBool::new(false), Placement::IDENTITY);
        let before = Recipe::new(Node::Canvas(painting()));
        let after = with(painting(), volume_stroke(&mesh, BRUSH));
        let base = Solid::make(&before, &at, step, &meshes, &go).unwrap();
        let edited = base.remake(&after, &at, step, &meshes, &go).unwrap();
        let anew = Solid::make(&after, &at, step, &meshes, &go).unwrap();
        assert_eq!(edited.mesh(), anew.mesh());
        assert!(check(&edited.mesh()).is_faultless());
    }
}
