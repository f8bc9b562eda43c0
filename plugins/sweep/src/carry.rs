//! What is carried into Sweep, and surfaces that are carried where only solids are of use.

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use midair_document::Edit;
use midair_field::{Op, Profile, Sweep};
use midair_studio::{
    carry::{Carried, Carrying},
    command::Command,
    hands::{Action, Hands, Haptic, Side},
    hold::Reserved,
    notice::Notices,
    project::{Project, Selection},
    settings::{Settings, SweepItem, SweepShape},
    show::{to_bevy_mesh, transform},
    tools::{Hint, HintKey, Hints, ToolId},
    units::length,
};

use crate::phase::{Draft, Offer, Phase};
use crate::write::kind_of;
use crate::{SWEEP, ask, ends::Rail};

/// Where what is carried becomes an operand.
const ASSEMBLE: ToolId = ToolId::new("csg");
/// Where it becomes a brush.
const BRUSH: ToolId = ToolId::new("brush");

/// Surfaces that are carried where only solids are of use are offered the thickness, or the caps, that
/// would close them.
pub(crate) fn answer(
    mut carrying: On<Carrying>,
    project: Res<Project>,
    mut draft: ResMut<Draft>,
    mut notices: ResMut<Notices>,
) {
    draft.offer = None;
    if carrying.to != ASSEMBLE && carrying.to != BRUSH {
        return;
    }
    let document = project.document();
    let open: Vec<_> = carrying
        .objects
        .iter()
        .filter_map(|&id| {
            let object = document.object(id)?;
            Some((id, object.name.clone(), object.sheet()?.profile))
        })
        .collect();
    let Some((_, name, profile)) = open.first() else {
        return;
    };
    let thickness = (2.0 * document.step()).max(0.01);
    let mm = thickness * 1e3;
    notices.info(match (open.len(), profile) {
        (1, Profile::Sheet) => format!(
            "{name} is open. Finish makes it {mm:.0} mm thick, as the ghost shows; cancel leaves it."
        ),
        (1, Profile::Tube) => format!(
            "{name} is open. Finish caps its ends, as the ghost shows; cancel leaves it."
        ),
        (more, _) => format!(
            "{name} and {} more are open. Finish makes surfaces {mm:.0} mm thick and caps tubes, as the ghosts show; cancel leaves them.",
            more - 1
        ),
    });
    let objects: Vec<_> = open.into_iter().map(|o| o.0).collect();
    carrying.answered.extend(&objects);
    draft.offer = Some(Offer {
        objects,
        thickness,
        to: carrying.to.clone(),
    });
}

/// A stroke or a line becomes the rail of the next free end, a solid what is cloned, a surface the
/// sweep whose curves are bent.
pub(crate) fn take(
    carried: On<Carried>,
    project: Res<Project>,
    mut settings: ResMut<Settings>,
    mut selection: ResMut<Selection>,
    mut draft: ResMut<Draft>,
    mut notices: ResMut<Notices>,
) {
    if carried.to != SWEEP {
        return;
    }
    let document = project.document();
    for &id in &carried.objects {
        let Some(object) = document.object(id) else {
            continue;
        };
        let name = &object.name;
        if let Some(line) = ask::stroke(object) {
            let free = [0, 1].into_iter().find(|&k| draft.rails[k].is_none());
            let k = free.unwrap_or(0);
            draft.rails[k] = Some(Rail { object: id, line });
            let side = if k == 0 { "left" } else { "right" };
            notices.info(format!("The {side} end follows {name} now."));
        } else if object.sheet().is_some() {
            selection.set_if_neq(Selection(vec![id]));
            draft.phase = Phase::Editing {
                object: id,
                at: 0,
                grip: None,
            };
            notices.info(format!("The curves of {name} are in hand."));
        } else if object.operand().is_some() {
            let item = SweepItem::Object(id.0);
            if settings.sweep.item != item || settings.sweep.shape != SweepShape::Clones {
                settings.sweep.item = item;
                settings.sweep.shape = SweepShape::Clones;
            }
            notices.info(format!("{name} is what is cloned now."));
        } else {
            notices.warn(format!(
                "{name} can neither be cloned nor followed. Carry a solid, a surface or a stroke."
            ));
        }
    }
}

/// Finish is the offer's while there is one, whatever mode one is in.
pub(crate) fn claim(draft: Res<Draft>, mut reserved: ResMut<Reserved>) {
    if draft.offer.is_some() {
        for side in Side::BOTH {
            reserved.claim(side, Action::Finish);
        }
    }
}

/// While there is an offer, every mode says which buttons answer it.
pub(crate) fn say(
    draft: Res<Draft>,
    project: Res<Project>,
    settings: Res<Settings>,
    mut hints: ResMut<Hints>,
) {
    let Some(offer) = &draft.offer else { return };
    let sheets = || {
        let objects = offer.objects.iter();
        objects.filter_map(|&id| project.document().object(id)?.sheet())
    };
    let thick = length(offer.thickness, settings.units.length);
    let does = match (
        sheets().any(|s| s.profile == Profile::Sheet),
        sheets().any(|s| s.profile == Profile::Tube),
    ) {
        (true, false) => format!("make it {thick} thick"),
        (false, _) => "cap its ends".to_owned(),
        (true, true) => format!("make surfaces {thick} thick, cap tubes"),
    };
    hints.buttons.retain(|h| {
        ![Action::Finish, Action::Cancel]
            .map(HintKey::Action)
            .contains(&h.action)
    });
    "It is open: the ghost closes it".clone_into(&mut hints.status);
    let answers = [
        (Action::Finish, does),
        (Action::Cancel, "leave it".to_owned()),
    ];
    let answers = answers.map(|(action, does)| Hint {
        side: None,
        action: HintKey::Action(action),
        does,
    });
    hints.buttons.splice(0..0, answers);
}

/// What it would be with its thickness.
fn closed(sweep: &Sweep, thickness: f32) -> Sweep {
    match sweep.profile {
        Profile::Sheet => Sweep {
            thickness,
            ..sweep.clone()
        },
        Profile::Tube => Sweep {
            caps: true,
            ..sweep.clone()
        },
    }
}

/// Finish closes the surface, and marks it where it was carried into Assemble: one step.
pub(crate) fn accept(
    mut hands: ResMut<Hands>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
    mut commands: MessageWriter<Command>,
) {
    let Some(offer) = &draft.offer else {
        return;
    };
    let document = project.document();
    let open: Vec<_> = offer
        .objects
        .iter()
        .filter_map(|&id| Some((id, closed(document.object(id)?.sheet()?, offer.thickness))))
        .collect();
    if open.is_empty() {
        draft.offer = None;
        return;
    }
    if hands.pressed(Action::Cancel).is_some() {
        draft.offer = None;
        return;
    }
    let Some(side) = hands.pressed(Action::Finish) else {
        return;
    };
    let to = offer.to.clone();
    draft.offer = None;
    let objects: Vec<_> = open.iter().map(|o| o.0).collect();
    let kinds: Result<Vec<_>, String> = open
        .iter()
        .map(|(id, next)| {
            Ok(Edit::SetKind {
                id: *id,
                kind: kind_of(next)?,
            })
        })
        .collect();
    let done = match kinds {
        Ok(mut edits) => {
            if to == ASSEMBLE {
                let mut pending = project.document().pending().to_vec();
                pending.retain(|(o, _)| !objects.contains(o));
                pending.extend(objects.iter().map(|&o| (o, Op::Union)));
                edits.push(Edit::SetPending { pending });
            }
            project.commit("Make solid", edits, &mut notices)
        }
        Err(reason) => {
            notices.warn(reason);
            false
        }
    };
    if done && to != ASSEMBLE {
        // Closed it is of use there.
        commands.write(Command::Carry { objects, to });
    }
    hands.pulse(side, Haptic::of(done));
}

/// The ghosts of what is offered, and what they were made for.
#[derive(Resource, Default)]
pub(crate) struct Ghost(Option<(Offer, Vec<Entity>)>);

pub(crate) fn ghost(
    draft: Res<Draft>,
    project: Res<Project>,
    mut ghost: ResMut<Ghost>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    if ghost.0.as_ref().map(|g| &g.0) == draft.offer.as_ref() {
        return;
    }
    for entity in ghost.0.take().into_iter().flat_map(|g| g.1) {
        commands.entity(entity).try_despawn();
    }
    let Some(offer) = &draft.offer else {
        return;
    };
    let look = materials.add(StandardMaterial {
        base_color: Color::srgba(0.8, 0.84, 0.95, 0.35),
        alpha_mode: AlphaMode::Blend,
        cull_mode: None,
        ..default()
    });
    let made = offer.objects.iter().filter_map(|&id| {
        let object = project.document().object(id)?;
        let solid = closed(object.sheet()?, offer.thickness).solid().ok()?;
        let mesh = Mesh3d(meshes.add(to_bevy_mesh(&solid.mesh)));
        let at = transform(&object.placement);
        let shadowless = (NotShadowCaster, NotShadowReceiver);
        let drawn = (mesh, MeshMaterial3d(look.clone()), at, shadowless);
        Some(commands.spawn((Name::new("Thickness"), drawn)).id())
    });
    ghost.0 = Some((offer.clone(), made.collect()));
}
