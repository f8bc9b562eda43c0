//! What stands out: edges around what is touched and selected, and the edges of triangles.

use bevy::pbr::wireframe::{WireframeConfig, WireframePlugin};
use bevy::prelude::*;
use bevy::render::render_resource::WgpuFeatures;
use bevy::render::renderer::RenderDevice;
use bevy_mod_outline::{OutlineFace, OutlinePlugin, OutlineStencil, OutlineVolume};

use crate::StudioSet;
use crate::materials::{Living, MaterialShelf};
use crate::notice::Notices;
use crate::project::Project;
use crate::settings::{RoomKind, Settings};
use crate::show::{Cue, Cues, ObjectEntity};

pub(super) fn plugin(app: &mut App) {
    app.add_plugins((OutlinePlugin::EXTRUDE_VERTEX, WireframePlugin::default()))
        .add_systems(Update, (edges, super::hull::hulls).after(StudioSet::Cue))
        .add_systems(Update, triangles.run_if(resource_changed::<Settings>));
}

/// Of the line around what is selected, and around what is touched: in the accent, and in the colour of
/// text; width in logical pixels.
pub(super) fn line(room: RoomKind, cue: &Cue) -> Option<(Color, f32)> {
    let selected = Color::srgb_u8(0x8f, 0x7a, 0xe6);
    let touched = match room {
        RoomKind::Dusk => Color::srgb_u8(0xf2, 0xf0, 0xec),
        RoomKind::Day | RoomKind::Paper => Color::srgb_u8(0x26, 0x28, 0x2e),
    };
    match (cue.selected, cue.touched) {
        // Both at once: the accent, wider.
        (true, true) => Some((selected, 4.5)),
        (true, false) => Some((selected, 3.0)),
        (false, true) => Some((touched, 2.0)),
        (false, false) => None,
    }
}

/// Only what has a line carries one, so a thousand objects that have none cost nothing.
fn edges(
    cues: Res<Cues>,
    settings: Res<Settings>,
    (shelf, materials, project): (Res<MaterialShelf>, Res<Assets<Living>>, Res<Project>),
    mut objects: Query<
        (
            Entity,
            &ObjectEntity,
            Option<&MeshMaterial3d<Living>>,
            Option<&mut OutlineVolume>,
            Option<&OutlineFace>,
        ),
        With<Mesh3d>,
    >,
    fresh: Query<(), Or<(Added<Mesh3d>, Changed<MeshMaterial3d<Living>>)>>,
    mut undressed: RemovedComponents<MeshMaterial3d<Living>>,
    mut commands: Commands,
) {
    let other = undressed.read().count() > 0 || !fresh.is_empty() || shelf.is_changed();
    if !cues.is_changed() && !settings.is_changed() && !other {
        return;
    }
    let plain = Cue::default();
    for (entity, object, living, volume, face) in &mut objects {
        let cue = cues.0.get(&object.0).unwrap_or(&plain);
        // What a material moves has a line of the material's own.
        let moved = living
            .and_then(|m| materials.get(&m.0))
            .is_some_and(|m| shelf.shifts(m.extension.place()));
        let wanted = line(settings.look.room, cue).filter(|_| !moved);
        // An open surface is seen from behind as well.
        let object = project.document().object(object.0);
        let open = object.is_some_and(|o| o.sheet().is_some());
        let sides = || {
            if open {
                OutlineFace::DoubleSided
            } else {
                OutlineFace::Front
            }
        };
        if volume.is_some() && open != matches!(face, Some(OutlineFace::DoubleSided)) {
            commands.entity(entity).insert(sides());
        }
        match (wanted, volume) {
            (None, None) => {}
            (None, Some(_)) => {
                commands
                    .entity(entity)
                    .remove::<(OutlineVolume, OutlineStencil, OutlineFace)>();
            }
            (Some((colour, width)), Some(mut volume)) => {
                if volume.colour != colour || volume.width != width {
                    volume.colour = colour;
                    volume.width = width;
                }
            }
            (Some((colour, width)), None) => {
                commands.entity(entity).insert((
                    OutlineVolume {
                        visible: true,
                        width,
                        colour,
                    },
                    OutlineStencil::default(),
                    sides(),
                ));
            }
        }
    }
}

/// Edges of triangles, where the graphics card draws lines.
fn triangles(
    settings: Res<Settings>,
    device: Option<Res<RenderDevice>>,
    config: Option<ResMut<WireframeConfig>>,
    mut notices: ResMut<Notices>,
    mut said: Local<bool>,
) {
    let Some(mut config) = config else { return };
    let wanted = settings.look.wireframe;
    let needs = WgpuFeatures::POLYGON_MODE_LINE | WgpuFeatures::IMMEDIATES;
    if !device.is_some_and(|d| d.features().contains(needs)) {
        if wanted && !std::mem::replace(&mut *said, true) {
            notices.warn(
                "Edges of triangles cannot be drawn: this graphics driver has no line mode. \
                 A newer driver may have it.",
            );
        }
        *said &= wanted;
        return;
    }
    let colour = match settings.look.room {
        RoomKind::Dusk => Color::srgba(0.05, 0.05, 0.07, 0.6),
        RoomKind::Day | RoomKind::Paper => Color::srgba(0.10, 0.10, 0.13, 0.5),
    };
    if config.global != wanted || config.default_color != colour {
        config.global = wanted;
        config.default_color = colour;
    }
}
