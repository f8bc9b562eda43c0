use std::sync::atomic::AtomicBool;

use midair_field::{Brick, Placement, Recipe};
use midair_solid::Solid;
use serde_json::json;

use crate::catalogue::BenchError;
use crate::figure::Details;
use crate::measure::{Budget, Run, Times, repeat};

/// What lies between two updates, at the least.
const REST: std::time::Duration = std::time::Duration::from_millis(12);

/// The training tasks of EasyVRModeling Fig. 7.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Task {
    CubeSphere,
    Chair,
    Cup,
}

impl Task {
    pub const ALL: [Self; 3] = [Self::CubeSphere, Self::Chair, Self::Cup];

    pub fn name(self) -> &'static str {
        match self {
            Self::CubeSphere => "cube-sphere",
            Self::Chair => "chair",
            Self::Cup => "cup",
        }
    }

    /// The total times of EasyVRModeling Table 1 at steps of 0.012, 0.010, 0.008 and 0.006 m, on
    /// a GTX 1070, milliseconds.
    pub fn paper(self) -> [f64; 4] {
        match self {
            Self::CubeSphere => [22.0, 31.0, 57.0, 110.0],
            Self::Chair => [53.0, 62.0, 111.0, 231.0],
            Self::Cup => [39.0, 61.0, 104.0, 229.0],
        }
    }

    pub fn recipe(self) -> Result<Recipe, BenchError> {
        let text = match self {
            Self::CubeSphere => include_str!("../../../benches/cube-sphere.ron"),
            Self::Chair => include_str!("../../../benches/chair.ron"),
            Self::Cup => include_str!("../../../benches/cup.ron"),
        };
        ron::from_str(text).map_err(|e| BenchError::Recipe(self.name(), e))
    }
}

/// One update of the whole solid: fuse and extract, as the studio does it.
pub(crate) fn run(
    recipe: &Recipe,
    step: f32,
    budget: &Budget,
) -> Result<(Times, Details), BenchError> {
    let go = AtomicBool::new(false);
    let make = || Solid::make(recipe, &Placement::IDENTITY, step, &(), &go);
    let times = repeat(budget, || {
        // In the app an update comes out of rest: the cores sleep and the caches hold other things.
        std::thread::sleep(REST);
        let started = std::time::Instant::now();
        let solid = make()?;
        let whole = started.elapsed();
        Ok::<_, BenchError>(Run {
            total: solid.fuse + solid.extract,
            parts: [
                ("fuse_ms", solid.fuse),
                ("extract_ms", solid.extract),
                ("make_ms", whole),
            ],
        })
    })?;
    let solid = make()?;
    let near = |(_, b): &(_, &Brick)| matches!(b, Brick::Values { .. });
    // The sharp edges come once the update is there; the median of a few, so that a lent core does not count.
    let mut crisp: Vec<f64> = (0..9)
        .map(|_| {
            let started = std::time::Instant::now();
            std::hint::black_box(solid.crisp());
            started.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    crisp.sort_by(f64::total_cmp);
    let mut details = Details::new();
    details.insert("crisp_ms".into(), json!(crisp[crisp.len() / 2]));
    details.insert("operands".into(), json!(recipe.leaves()));
    details.insert("triangles".into(), json!(solid.surface().triangles()));
    details.insert(
        "bricks".into(),
        json!(solid.grid().bricks().filter(near).count()),
    );
    Ok((times, details))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::many;
    use midair_field::Node;
    use midair_mesh::check;

    /// The part of a component's file that says what it is.
    #[derive(serde::Deserialize)]
    struct Shelved {
        id: String,
        recipe: Recipe,
    }

    fn all() -> Vec<(&'static str, Recipe)> {
        let tasks = Task::ALL.map(|t| (t.name(), t.recipe().unwrap()));
        let many = [12, 30].map(|n| ("many", many::recipe(n).unwrap()));
        tasks.into_iter().chain(many).collect()
    }

    #[test]
    fn the_solids_are_closed() {
        for (name, recipe) in all() {
            let go = AtomicBool::new(false);
            let solid = Solid::make(&recipe, &Placement::IDENTITY, 0.012, &(), &go).unwrap();
            for mesh in [solid.mesh(), solid.crisp()] {
                let report = check(&mesh);
                assert!(report.is_faultless(), "{name}: {report:?}");
            }
            assert!(solid.mesh().volume() > 1e-3, "{name}");
        }
    }

    #[test]
    fn the_parts_are_those_of_the_library() {
        let shelf = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/components");
        for (name, recipe) in all() {
            let Node::Solid(operands) = recipe.node() else {
                panic!("{name} is no sequence");
            };
            for operand in operands {
                let Node::Component { id, recipe } = operand.recipe.node() else {
                    panic!("{name} holds what is no component");
                };
                let text = std::fs::read_to_string(format!("{shelf}/{id}.ron")).unwrap();
                let shelved: Shelved = ron::from_str(&text).unwrap();
                assert_eq!((&shelved.id, &shelved.recipe), (id, recipe), "{name}");
            }
        }
    }
}
