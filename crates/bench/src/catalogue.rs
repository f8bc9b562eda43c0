use midair_field::bake::BakeError;
use midair_field::{CompileError, FuseError};
use midair_mesh::ReadError;
use midair_solid::SolidError;

use crate::figure::Figure;
use crate::measure::Budget;
use crate::{bake, brush, csg, fuse, many, scaffold, surface, sweep};

/// A workload that could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// One of the bundled recipes is not one.
    #[error("the bundled recipe {0} cannot be read: {1}")]
    Recipe(&'static str, ron::error::SpannedError),
    /// A solid could not be made.
    #[error(transparent)]
    Solid(#[from] SolidError),
    /// A recipe could not be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A field could not be held.
    #[error(transparent)]
    Fuse(#[from] FuseError),
    /// A mesh could not be baked.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// The graphics card refused it.
    #[error("{0}")]
    Card(String),
    /// A mesh could not be read.
    #[error(transparent)]
    Mesh(#[from] ReadError),
}

/// No workload begins with this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no benchmark begins with {name}; there are {}", known.join(", "))]
pub struct UnknownName {
    /// What was asked for.
    pub name: String,
    /// What there is.
    pub known: Vec<String>,
}

/// What came of a workload.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// It was measured.
    Figure(Figure),
    /// It needs what this machine has not; says what.
    Skipped(String),
}

/// A piece of work under a name that does not change.
#[derive(Clone, Debug)]
pub struct Workload {
    name: String,
    paper: Option<f64>,
    work: Work,
}

#[derive(Clone, Copy, Debug)]
enum Work {
    Csg(csg::Task, f32),
    Many(usize, f32),
    Bake(bake::Subject),
    Surface(surface::Subject),
    Fuse,
    Scaffold(scaffold::Subject),
    Sweep(sweep::Subject),
    Brush(brush::Subject),
}

impl Workload {
    fn new(name: impl Into<String>, work: Work) -> Self {
        Self {
            name: name.into(),
            paper: None,
            work,
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the paper gives for it, milliseconds.
    pub(crate) fn paper(&self) -> Option<f64> {
        self.paper
    }

    /// Carries it out, on as many threads as the current rayon pool has.
    ///
    /// # Errors
    /// [`BenchError`]; a bundled workload fails only where the memory or a mesh file does.
    pub fn run(&self, budget: &Budget) -> Result<Outcome, BenchError> {
        let measured = match self.work {
            Work::Csg(task, step) => csg::run(&task.recipe()?, step, budget)?,
            Work::Many(count, step) => csg::run(&many::recipe(count)?, step, budget)?,
            Work::Bake(subject) => match subject.mesh()? {
                Ok(mesh) => bake::run(&mesh, subject, budget)?,
                Err(reason) => return Ok(Outcome::Skipped(reason)),
            },
            Work::Surface(subject) => surface::run(subject, budget)?,
            Work::Fuse => fuse::run(budget)?,
            Work::Scaffold(subject) => scaffold::run(subject, budget)?,
            Work::Sweep(subject) => sweep::run(subject, budget)?,
            Work::Brush(subject) => brush::run(subject, budget)?,
        };
        let (times, details) = measured;
        let figure = Figure::new(&self.name, self.paper, &times, details);
        Ok(Outcome::Figure(figure))
    }
}

/// The steps of EasyVRModeling Table 1, metres, as names spell them.
pub(crate) const STEPS: [(&str, f32); 4] = [
    ("0.012", 0.012),
    ("0.010", 0.010),
    ("0.008", 0.008),
    ("0.006", 0.006),
];

/// How many operands a heap has.
pub(crate) const MANY: [usize; 2] = [12, 30];

/// Every workload there is.
pub fn workloads() -> Vec<Workload> {
    let mut all = Vec::new();
    for task in csg::Task::ALL {
        for ((spelt, step), paper) in STEPS.into_iter().zip(task.paper()) {
            let name = format!("csg/{}/{spelt}", task.name());
            all.push(Workload {
                paper: Some(paper),
                ..Workload::new(name, Work::Csg(task, step))
            });
        }
    }
    for count in MANY {
        for (spelt, step) in STEPS {
            let name = format!("csg/many-{count}/{spelt}");
            all.push(Workload::new(name, Work::Many(count, step)));
        }
    }
    for subject in bake::Subject::ALL {
        all.push(Workload::new(subject.name(), Work::Bake(subject)));
    }
    for subject in surface::Subject::ALL {
        all.push(Workload::new(subject.name(), Work::Surface(subject)));
    }
    all.push(Workload::new("fuse/5x64-in-256", Work::Fuse));
    for subject in scaffold::Subject::ALL {
        all.push(Workload {
            paper: subject.paper(),
            ..Workload::new(subject.name(), Work::Scaffold(subject))
        });
    }
    for subject in sweep::Subject::ALL {
        all.push(Workload {
            paper: Some(subject.paper()),
            ..Workload::new(subject.name(), Work::Sweep(subject))
        });
    }
    for subject in brush::Subject::all() {
        all.push(Workload {
            paper: subject.paper(),
            ..Workload::new(subject.name(), Work::Brush(subject))
        });
    }
    all
}

/// The workloads whose names begin with one of `names`, each once; all of them where none is named.
///
/// # Errors
/// A name that no workload begins with.
pub fn select(names: &[String]) -> Result<Vec<Workload>, UnknownName> {
    let all = workloads();
    for name in names {
        if !all.iter().any(|w| w.name.starts_with(name.as_str())) {
            return Err(UnknownName {
                name: name.clone(),
                known: all.into_iter().map(|w| w.name).collect(),
            });
        }
    }
    let wanted = |w: &Workload| {
        names.is_empty() || names.iter().any(|name| w.name.starts_with(name.as_str()))
    };
    Ok(all.into_iter().filter(wanted).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(of: &[&str]) -> Result<Vec<String>, UnknownName> {
        let asked: Vec<_> = of.iter().map(|&n| n.to_owned()).collect();
        let found = select(&asked)?;
        Ok(found.into_iter().map(|w| w.name).collect())
    }

    #[test]
    fn a_name_stands_for_all_that_begin_with_it() {
        assert_eq!(names(&[]).unwrap().len(), workloads().len());
        assert_eq!(names(&["csg/cup"]).unwrap().len(), 4);
        assert_eq!(names(&["fuse", "fuse/5x64"]).unwrap(), ["fuse/5x64-in-256"]);
        let unknown = names(&["csg/cup", "csg/teapot"]).unwrap_err().to_string();
        assert!(unknown.contains("csg/teapot") && unknown.contains("csg/chair/0.006"));
        assert!(!unknown.contains('\n'));
    }

    #[test]
    fn no_name_is_there_twice_or_begins_another() {
        let all = names(&[]).unwrap();
        for a in &all {
            assert_eq!(all.iter().filter(|b| b.starts_with(a)).count(), 1, "{a}");
        }
    }
}
