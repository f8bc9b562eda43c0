//! What appears or jumps eases in. Only what is seen: the document, drafts and colliders are where they are
//! at once, so sessions and picks know nothing of it.

use bevy::prelude::*;

use super::{Drafts, ObjectEntity};
use crate::project::Project;
use crate::settings::Settings;
use crate::snap::SnapPreview;

/// Seconds in which something appears.
const APPEARS: f32 = 0.14;
/// Seconds in which something that jumped arrives.
const ARRIVES: f32 = 0.12;
/// Seconds in which a snap takes hold.
const SNAPS: f32 = 0.08;
/// How large a thing is when it begins to appear.
const BEGINS: f32 = 0.8;
/// What jumps farther than this many metres is there at once.
const FARTHEST: f32 = 4.0;
/// A snap moves a thing by more than this between two frames, in metres, or turns it by more, in radians.
const JUMP: f32 = 0.015;
const TURN: f32 = 0.05;

/// On its way to where it stands.
#[derive(Component)]
struct Easing {
    from: Transform,
    to: Transform,
    /// As it was written last: when it is otherwise, somebody has moved it.
    shown: Transform,
    /// Seconds since it set out, and that it takes.
    time: [f32; 2],
}

impl Easing {
    fn new(from: Transform, to: Transform, seconds: f32) -> Self {
        Self {
            from,
            to,
            shown: from,
            time: [0.0, seconds],
        }
    }
}

/// Where a thing was seen last, to tell a jump.
#[derive(Component, Clone, Copy)]
struct Seen(Transform);

pub(super) fn plugin(app: &mut App) {
    app.add_systems(
        PostUpdate,
        (set_out, go)
            .chain()
            .before(TransformSystems::Propagate)
            .run_if(|settings: Res<Settings>| settings.look.motion),
    );
}

/// What has jumped since the last frame sets out.
fn set_out(
    project: Res<Project>,
    drafts: Res<Drafts>,
    preview: Res<SnapPreview>,
    mut moved: Query<
        (
            Entity,
            &ObjectEntity,
            &mut Transform,
            Option<&mut Easing>,
            Option<&mut Seen>,
        ),
        Or<(Changed<Transform>, Added<Mesh3d>)>,
    >,
    meshes: Query<(), With<Mesh3d>>,
    mut commands: Commands,
) {
    for (entity, object, mut at, easing, seen) in &mut moved {
        if let Some(easing) = &easing
            && *at == easing.shown
        {
            continue;
        }
        let target = *at;
        let Some(mut seen) = seen else {
            // It appears with its first mesh; what was fused stands in its operands' place already.
            if meshes.contains(entity) {
                commands.entity(entity).insert(Seen(target));
                let fresh = project.document().object(object.0).is_some_and(|o| o.fresh);
                if !fresh {
                    let from = target.with_scale(target.scale * BEGINS);
                    at.set_if_neq(from);
                    commands
                        .entity(entity)
                        .insert(Easing::new(from, target, APPEARS));
                }
            }
            continue;
        };
        let before = std::mem::replace(&mut seen.0, target);
        let held = drafts.get(object.0).is_some();
        if let Some(mut easing) = easing {
            // Where it is going it is going already; what a hand moves on is followed.
            if held || easing.to == target {
                easing.to = target;
                at.set_if_neq(easing.shown);
                continue;
            }
            at.set_if_neq(easing.shown);
            *easing = Easing::new(easing.shown, target, ARRIVES);
            continue;
        }
        let far = before.translation.distance(target.translation);
        let turned = before.rotation.angle_between(target.rotation);
        let grown = before.scale.distance(target.scale);
        let takes = if held {
            // What a hand moves stays in the hand, unless it snaps.
            let jumps = far > JUMP || turned > TURN;
            if jumps && snaps(&preview, &target) {
                SNAPS
            } else {
                continue;
            }
        } else if far < 1e-4 && turned < 1e-3 && grown < 1e-4 || far > FARTHEST {
            continue;
        } else {
            ARRIVES
        };
        at.set_if_neq(before);
        commands
            .entity(entity)
            .insert(Easing::new(before, target, takes));
    }
}

fn snaps(preview: &SnapPreview, target: &Transform) -> bool {
    preview.0.iter().any(|s| {
        let here = s.placement.translation.distance(target.translation) < 1e-4;
        here && (s.grid.is_some() || s.angle.is_some() || s.surface.is_some())
    })
}

/// What is on its way goes on.
fn go(
    time: Res<Time>,
    mut going: Query<(Entity, &mut Transform, &mut Easing)>,
    mut commands: Commands,
) {
    for (entity, mut at, mut easing) in &mut going {
        if *at != easing.shown {
            continue;
        }
        let [since, takes] = easing.time;
        let since = since + time.delta_secs();
        let left = (1.0 - since / takes).clamp(0.0, 1.0);
        let part = 1.0 - left.powi(3);
        let (from, to) = (easing.from, easing.to);
        let shown = if left == 0.0 {
            to
        } else {
            Transform {
                translation: from.translation.lerp(to.translation, part),
                rotation: from.rotation.slerp(to.rotation, part),
                scale: from.scale.lerp(to.scale, part),
            }
        };
        easing.time[0] = since;
        easing.shown = shown;
        at.set_if_neq(shown);
        if left == 0.0 {
            commands.entity(entity).remove::<Easing>();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_document::{Document, History, MeshStore, ObjectId};
    use std::path::PathBuf;
    use std::time::Duration;

    /// An app that knows nothing but this, and one thing in it.
    fn room(motion: bool) -> (App, Entity) {
        let mut app = App::new();
        let mut settings = Settings::default();
        settings.look.motion = motion;
        app.insert_resource(settings)
            .insert_resource(Project::new(
                History::new(Document::default(), MeshStore::default()),
                None,
                PathBuf::new(),
            ))
            .init_resource::<Drafts>()
            .init_resource::<SnapPreview>()
            .init_resource::<Time>();
        plugin(&mut app);
        let thing = (
            ObjectEntity(ObjectId(1)),
            Transform::IDENTITY,
            Mesh3d::default(),
        );
        let thing = app.world_mut().spawn(thing).id();
        (app, thing)
    }

    fn frame(app: &mut App, seconds: f32) {
        let step = Duration::from_secs_f32(seconds);
        app.world_mut().resource_mut::<Time>().advance_by(step);
        app.update();
    }

    fn at(app: &App, thing: Entity) -> Transform {
        *app.world().get::<Transform>(thing).unwrap()
    }

    #[test]
    fn a_jump_takes_its_time_and_ends_exactly_where_it_was_to() {
        let (mut app, thing) = room(true);
        frame(&mut app, 0.01);
        frame(&mut app, 0.2);
        let there = Transform::from_xyz(0.5, 0.0, 0.0);
        *app.world_mut().get_mut::<Transform>(thing).unwrap() = there;
        let mut before = 0.0;
        for _ in 0..11 {
            frame(&mut app, 0.01);
            let x = at(&app, thing).translation.x;
            assert!(x > before && x < 0.5, "{x}");
            before = x;
        }
        frame(&mut app, 0.02);
        assert_eq!(at(&app, thing), there);
        frame(&mut app, 0.02);
        assert!(app.world().get::<Easing>(thing).is_none());
    }

    #[test]
    fn without_motion_everything_is_there_at_once() {
        let (mut app, thing) = room(false);
        frame(&mut app, 0.01);
        let there = Transform::from_xyz(0.5, 0.0, 0.0);
        *app.world_mut().get_mut::<Transform>(thing).unwrap() = there;
        frame(&mut app, 0.01);
        assert_eq!(at(&app, thing), there);
    }

    #[test]
    fn what_a_hand_holds_stays_in_the_hand() {
        let (mut app, thing) = room(true);
        frame(&mut app, 0.01);
        frame(&mut app, 0.2);
        let there = midair_field::Placement::at(Vec3::X);
        app.world_mut()
            .resource_mut::<Drafts>()
            .set(ObjectId(1), there);
        let there = super::super::transform(&there);
        *app.world_mut().get_mut::<Transform>(thing).unwrap() = there;
        frame(&mut app, 0.01);
        assert_eq!(at(&app, thing), there);
    }
}
