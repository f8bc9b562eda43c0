//! Follows what is done and goes on by itself when a step is done.

use bevy::prelude::*;
use midair_document::ObjectId;

use super::course::{COURSE, Look, Step, Task, read};
use super::goal::{Scene, parts};
use super::keys::Keys;
use crate::StudioSet;
use crate::command::Command;
use crate::notice::Notices;
use crate::objects::extent;
use crate::panel::Panels;
use crate::plane::WorkPlane;
use crate::project::{Project, Shelf};
use crate::settings::{Lesson, Progress, Settings};

/// The tutorial's panel.
pub(crate) const TUTORIAL_PANEL: &str = "tutorial";

/// The course and what there is to say about the step one is at. How far one is stands in
/// [`Settings::help`].
#[derive(Resource)]
pub struct Tutorial {
    tasks: Vec<Task>,
    /// The wrong turn that was taken, in words.
    wrong: Option<String>,
    /// Seconds spent at this step.
    seconds: f32,
}

impl Tutorial {
    /// A course, one text for each task, as in `assets/tutorial`; one that cannot be read is left out with a
    /// warning.
    pub fn of<'a>(texts: impl IntoIterator<Item = &'a str>) -> Self {
        Self {
            tasks: read(texts),
            wrong: None,
            seconds: 0.0,
        }
    }

    /// How many steps there are.
    pub fn len(&self) -> usize {
        self.tasks.iter().map(|t| t.steps.len()).sum()
    }

    /// Whether there is nothing to learn.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The name of a step.
    pub fn name(&self, step: usize) -> Option<&str> {
        self.at(step).map(|(_, _, s)| s.id.as_str())
    }

    /// The wrong turn that was taken at this step, and the way out, with keys as `{library}`.
    pub fn wrong(&self) -> Option<&str> {
        self.wrong.as_deref()
    }

    /// A step with its task and its place in it.
    pub(crate) fn at(&self, step: usize) -> Option<(&Task, usize, &Step)> {
        let mut before = 0;
        self.tasks.iter().find_map(|task| {
            let place = step.checked_sub(before)?;
            before += task.steps.len();
            task.steps.get(place).map(|s| (task, place, s))
        })
    }

    /// Which of how many tasks a task is.
    pub(crate) fn number(&self, task: &Task) -> (usize, usize) {
        let at = self.tasks.iter().position(|t| t.title == task.title);
        (at.unwrap_or(0) + 1, self.tasks.len())
    }

    /// What a step points at, as a ring: its middle and how far around it.
    fn ring(&self, step: usize, project: &Project) -> Option<(Vec3, f32)> {
        let (_, _, step) = self.at(step)?;
        let document = project.document();
        match &step.look {
            Look::Nothing => None,
            Look::Place(at, radius) => Some((*at, *radius)),
            Look::Part(part) => {
                let id: ObjectId = parts(document, part).last()?;
                let (low, high) = extent(document, [id])?;
                Some((0.5 * (low + high), 0.6 * (high - low).length()))
            }
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.insert_resource(Tutorial::of(COURSE)).add_systems(
        Update,
        (
            // What was asked for in this frame counts in this frame.
            follow.in_set(StudioSet::Cue),
            leave.in_set(StudioSet::Ask),
        ),
    );
}

/// One step further when it is done; a step that is done already is passed over.
fn follow(
    mut tutorial: ResMut<Tutorial>,
    mut settings: ResMut<Settings>,
    (project, shelf, plane): (Res<Project>, Res<Shelf>, Res<WorkPlane>),
    keys: Res<Keys>,
    time: Res<Time>,
    mut notices: ResMut<Notices>,
) {
    let progress = settings.help.tutorial;
    if progress.state != Lesson::Going {
        return;
    }
    let tutorial = tutorial.bypass_change_detection();
    tutorial.seconds += time.delta_secs();
    let Some((_, _, step)) = tutorial.at(progress.step) else {
        settings.help.tutorial.state = Lesson::Done;
        return;
    };
    let scene = Scene {
        project: &project,
        library_open: shelf.open,
        plane_shown: plane.shown,
    };
    if step.concerns(keys.way) && !step.until.is_met(scene) {
        let mut wrong = step.wrong.iter();
        let wrong = wrong.find(|(goal, _)| goal.is_met(scene));
        tutorial.wrong = wrong.map(|(_, text)| text.clone());
        return;
    }
    let next = Progress {
        state: if progress.step + 1 < tutorial.len() {
            Lesson::Going
        } else {
            Lesson::Done
        },
        step: progress.step + 1,
        seconds: progress.seconds + std::mem::take(&mut tutorial.seconds),
    };
    tutorial.wrong = None;
    settings.help.tutorial = next;
    if next.state == Lesson::Done {
        notices.info(format!("The tutorial is done, in {:.0} s.", next.seconds));
    }
}

/// Closing the panel leaves the tutorial, opening it goes on where one was.
fn leave(mut commands: MessageReader<Command>, mut settings: ResMut<Settings>) {
    for command in commands.read() {
        let Command::Panel { id, open } = command else {
            continue;
        };
        if id != TUTORIAL_PANEL {
            continue;
        }
        let state = match (settings.help.tutorial.state, *open) {
            (Lesson::Left, true) => Lesson::Going,
            (Lesson::Offered | Lesson::Going, false) => Lesson::Left,
            (state, _) => state,
        };
        if state != settings.help.tutorial.state {
            settings.help.tutorial.state = state;
        }
    }
}

/// What a person sees at the first start: the tutorial is offered, or goes on.
pub(super) fn offer(settings: Res<Settings>, mut panels: ResMut<Panels>) {
    if matches!(
        settings.help.tutorial.state,
        Lesson::Offered | Lesson::Going
    ) {
        panels.set_open(TUTORIAL_PANEL, true);
    }
}

/// A soft ring around what the step is about.
pub(super) fn point(
    tutorial: Res<Tutorial>,
    settings: Res<Settings>,
    project: Res<Project>,
    mut gizmos: Gizmos,
) {
    let progress = settings.help.tutorial;
    if progress.state != Lesson::Going {
        return;
    }
    let Some((at, radius)) = tutorial.ring(progress.step, &project) else {
        return;
    };
    let [r, g, b, _] = crate::panel::ACCENT.to_array();
    let level = Isometry3d::new(at, Quat::from_rotation_arc(Vec3::Z, Vec3::Y));
    gizmos
        .circle(level, radius, Color::srgb_u8(r, g, b))
        .resolution(64);
}
