//! What the marked operands will come to, shown before it is made: coarse while a hand moves one of
//! them, as fine as the result at rest.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use midair_studio::{
    evaluate::{Delivery, Evaluations, Key, Live},
    hold::Ghosted,
    project::Project,
    settings::Settings,
    show::{CardWrites, Drafts, Drawn, Latest, Seen, StandIn},
};

use crate::fuse::drafted_recipe;

/// The preview of the marked sequence.
#[derive(Resource, Default)]
pub struct Preview {
    live: Live,
    picture: StandIn,
    /// Where the frame of what is asked for stands.
    origin: Option<Vec3>,
    shown: Option<Key>,
    /// When the last picture came while a hand was moving an operand.
    before: Option<Instant>,
    apart: Latest,
}

impl Preview {
    /// Whether it can be seen.
    pub fn is_shown(&self) -> bool {
        self.picture.is_shown()
    }

    /// What can be seen: of which recipe, at which step.
    pub fn shown(&self) -> Option<Key> {
        self.shown
    }

    /// Whether one is on its way.
    pub fn is_busy(&self) -> bool {
        self.live.is_busy()
    }

    /// How long the latest pictures took to make.
    pub fn took(&self) -> impl Iterator<Item = Duration> + '_ {
        self.picture.took.iter()
    }

    /// How far apart they came while a hand moved an operand.
    pub fn apart(&self) -> impl Iterator<Item = Duration> + '_ {
        self.apart.iter()
    }

    pub(crate) fn clear(&mut self, commands: &mut Commands) {
        self.live.clear();
        self.origin = None;
        self.shown = None;
        self.before = None;
        self.picture.clear(commands);
    }

    fn note(&mut self, took: Duration, moving: bool) {
        let now = Instant::now();
        self.picture.took.push(took);
        if let Some(before) = self.before.replace(now).filter(|_| moving) {
            self.apart.push(now - before);
        }
    }

    fn show(
        &mut self,
        key: Key,
        seen: &Seen,
        origin: Vec3,
        materials: &mut Assets<StandardMaterial>,
        commands: &mut Commands,
    ) {
        self.shown = Some(key);
        let at = Transform::from_translation(origin);
        self.picture.show("Preview", seen, at, materials, commands);
    }
}

/// Shows what the marks come to. Nothing that a session makes depends on it, so a session that is
/// played without a pace of its own, where nobody looks, goes without.
pub(crate) fn follow(
    (project, drafts): (Res<Project>, Res<Drafts>),
    (settings, delivery): (Res<Settings>, Res<Delivery>),
    mut evaluations: ResMut<Evaluations>,
    mut preview: ResMut<Preview>,
    (mut drawn, mut writes): (ResMut<Drawn>, ResMut<CardWrites>),
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let document = project.document();
    let wanted = settings.preview.on && *delivery == Delivery::AsTheyCome;
    let sequence = wanted.then(|| drafted_recipe(document, &drafts)).flatten();
    let Some((recipe, origin)) = sequence else {
        if preview.is_shown() || preview.is_busy() {
            preview.clear(&mut commands);
        }
        return;
    };
    let moving = !drafts.is_empty();
    let fine = Key::new(&recipe, document.step());
    if !moving {
        preview.before = None;
        if preview.shown == Some(fine) {
            return;
        }
        // It is being made ahead for update: the same solid, at the same step.
        if let Some(made) = evaluations.peek(&fine) {
            // A sketch on its way comes too late; nobody would take it in.
            preview.live.rest();
            let mesh = drawn.handle(fine, &made, &mut meshes);
            preview.show(fine, &mesh.into(), origin, &mut materials, &mut commands);
            return;
        }
    }
    // What was asked for in another frame would be shown in the wrong place.
    if preview.origin.replace(origin).is_some_and(|o| o != origin) {
        preview.live.clear();
    }
    if let Some(sketch) = preview.live.ask(&recipe, document.step(), &evaluations) {
        preview.note(sketch.took, moving);
        let key = sketch.key;
        if let Some(seen) = preview.live.draw(sketch, &mut meshes, &mut writes) {
            preview.show(key, &seen, origin, &mut materials, &mut commands);
        }
    }
}

/// What is previewed is drawn in place of the operands, which stay as shells.
pub(crate) fn ghost(project: Res<Project>, preview: Res<Preview>, mut ghosted: ResMut<Ghosted>) {
    let next = if preview.is_shown() {
        let pending = project.document().pending();
        pending.iter().map(|&(id, _)| id).collect()
    } else {
        Vec::new()
    };
    ghosted.set_if_neq(Ghosted(next));
}
