//! What is carried into Sweep, and a surface that is carried where only solids are of use.

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use midair_document::{Edit, ObjectId};
use midair_field::{Op, Profile, Sweep};
use midair_studio::{
    carry::Carried,
    hands::{Action, Hands, Haptic, Side},
    hold::Reserved,
    notice::Notices,
    project::{Project, Selection},
    settings::{Settings, SweepItem, SweepShape},
    show::{to_bevy_mesh, transform},
    tools::{ToolId, Tools},
};

use crate::phase::{Draft, Phase};
use crate::write::kind_of;
use crate::{SWEEP, ask, ends::Rail};

/// Where what is carried becomes an operand.
const ASSEMBLE: ToolId = ToolId::new("csg");

/// A stroke becomes the rail of the next free end, a solid what is cloned, a surface the sweep whose
/// curves are bent. A surface carried into Assemble is offered the thickness that would close it.
pub(crate) fn take(
    carried: On<Carried>,
    project: Res<Project>,
    mut settings: ResMut<Settings>,
    mut selection: ResMut<Selection>,
    mut draft: ResMut<Draft>,
    mut notices: ResMut<Notices>,
) {
    let document = project.document();
    if carried.to != SWEEP {
        if carried.to != ASSEMBLE {
            return;
        }
        let open = carried.objects.iter().find_map(|&id| {
            let object = document.object(id)?;
            let sheet = object.sheet()?;
            Some((id, object.name.clone(), sheet.profile))
        });
        if let Some((id, name, profile)) = open {
            let thickness = (2.0 * document.step()).max(0.01);
            draft.offer = Some((id, thickness));
            let how = match profile {
                Profile::Sheet => {
                    let mm = thickness * 1e3;
                    format!("makes it {mm:.0} mm thick, as the ghost shows")
                }
                Profile::Tube => "caps its ends, as the ghost shows".to_owned(),
            };
            notices.info(format!("{name} is open. Finish {how}; cancel leaves it."));
        }
        return;
    }
    for &id in &carried.objects {
        let Some(object) = document.object(id) else {
            continue;
        };
        let name = &object.name;
        if let Some(line) = ask::stroke(&project, id) {
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
    tools: Res<Tools>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
) {
    let Some((id, thickness)) = draft.offer else {
        return;
    };
    let Some(sheet) = project.document().object(id).and_then(|o| o.sheet()) else {
        draft.offer = None;
        return;
    };
    if hands.pressed(Action::Cancel).is_some() {
        draft.offer = None;
        return;
    }
    let Some(side) = hands.pressed(Action::Finish) else {
        return;
    };
    let next = closed(sheet, thickness);
    draft.offer = None;
    let done = match kind_of(&next) {
        Ok(kind) => {
            let mut edits = vec![Edit::SetKind { id, kind }];
            if tools.active().is_some_and(|t| t.id == ASSEMBLE) {
                let mut pending = project.document().pending().to_vec();
                pending.retain(|(o, _)| *o != id);
                pending.push((id, Op::Union));
                edits.push(Edit::SetPending { pending });
            }
            project.commit("Close", edits, &mut notices)
        }
        Err(reason) => {
            notices.warn(reason);
            false
        }
    };
    hands.pulse(side, Haptic::of(done));
}

/// The ghost of the thickness that is offered.
#[derive(Resource, Default)]
pub(crate) struct Ghost(Option<(ObjectId, Entity)>);

pub(crate) fn ghost(
    draft: Res<Draft>,
    project: Res<Project>,
    mut ghost: ResMut<Ghost>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut commands: Commands,
) {
    let wanted = draft.offer.map(|o| o.0);
    if ghost.0.map(|g| g.0) == wanted {
        return;
    }
    if let Some((_, entity)) = ghost.0.take() {
        commands.entity(entity).try_despawn();
    }
    let Some((id, thickness)) = draft.offer else {
        return;
    };
    let made = project.document().object(id).and_then(|object| {
        let solid = closed(object.sheet()?, thickness).solid().ok()?;
        Some((solid.mesh, transform(&object.placement)))
    });
    let Some((mesh, at)) = made else { return };
    let look = materials.add(StandardMaterial {
        base_color: Color::srgba(0.8, 0.84, 0.95, 0.35),
        alpha_mode: AlphaMode::Blend,
        cull_mode: None,
        ..default()
    });
    let mesh = Mesh3d(meshes.add(to_bevy_mesh(&mesh)));
    let shadowless = (NotShadowCaster, NotShadowReceiver);
    let drawn = (mesh, MeshMaterial3d(look), at, shadowless);
    let entity = commands.spawn((Name::new("Thickness"), drawn)).id();
    ghost.0 = Some((id, entity));
}
