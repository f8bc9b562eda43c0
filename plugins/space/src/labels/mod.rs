//! Short texts in the room: lengths and scales, signs of operands, what the studio has to say, names of buttons.
//!
//! Each frame says which labels there are; what stays the same keeps its mesh. A label has the same size in the eye
//! wherever it stands, and is turned to the eyes.

mod buttons;
mod letters;
mod sayings;

use std::collections::BTreeMap;

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_studio::hands::Side;
use midair_studio::panel::egui::Color32;
use midair_studio::settings::Settings;

pub(crate) use buttons::buttons;
pub(crate) use sayings::{empty, notices, operands, readouts};

use crate::DMM_PER_POINT;
use crate::hands::Part;
use crate::ink::{Ink, Over};
use crate::room::{Root, Stance, facing};
use letters::Letters;

/// Which label.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum LabelKey {
    Readout(usize),
    Operand(ObjectId),
    Notice,
    Empty,
    Budget,
    Button(bool, Part),
}

impl LabelKey {
    fn button(side: Side, part: Part) -> Self {
        Self::Button(side == Side::Right, part)
    }
}

/// How it is said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Weight {
    #[default]
    Plain,
    Warning,
}

/// One label.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Label {
    pub key: LabelKey,
    /// Its middle, in metres of the room.
    pub at: Vec3,
    /// Points that it stands above that.
    pub lift: f32,
    pub text: String,
    pub weight: Weight,
    /// Of its edge.
    pub edge: Option<Color32>,
    /// Points across at which it breaks into lines.
    pub wrap: f32,
}

impl Default for Label {
    fn default() -> Self {
        Self {
            key: LabelKey::Notice,
            at: Vec3::ZERO,
            lift: 0.0,
            text: String::new(),
            weight: Weight::Plain,
            edge: None,
            wrap: 320.0,
        }
    }
}

struct Shown {
    entity: Entity,
    text: String,
    weight: Weight,
    edge: Option<Color32>,
    /// Of the letters that it was printed with.
    print: u32,
    dark: bool,
}

/// The labels of this frame, and what is shown of them.
#[derive(Resource, Default)]
pub(crate) struct Labels {
    wanted: Vec<Label>,
    shown: BTreeMap<LabelKey, Shown>,
    letters: Letters,
    ink: Handle<Ink>,
    /// The same before everything else.
    front: Handle<Ink>,
}

impl Labels {
    /// Says something in this frame.
    pub fn say(&mut self, label: Label) {
        if label.at.is_finite() && !label.text.is_empty() {
            self.wanted.push(label);
        }
    }
}

pub(crate) fn begin(mut labels: ResMut<Labels>) {
    labels.bypass_change_detection().wanted.clear();
}

/// Shows what was said.
pub(crate) fn draw(
    mut labels: ResMut<Labels>,
    (stance, settings): (Res<Stance>, Res<Settings>),
    root: Single<Entity, With<Root>>,
    (mut meshes, mut inks, mut images): (
        ResMut<Assets<Mesh>>,
        ResMut<Assets<Ink>>,
        ResMut<Assets<Image>>,
    ),
    mut places: Query<(&mut Transform, &mut Mesh3d)>,
    mut commands: Commands,
) {
    let labels = labels.bypass_change_detection();
    let wanted = std::mem::take(&mut labels.wanted);
    labels.shown.retain(|key, shown| {
        let stays = wanted.iter().any(|l| l.key == *key);
        if !stays {
            commands.entity(shown.entity).despawn();
        }
        stays
    });
    let eyes = stance.head.position;
    let dark = settings.look.room == midair_studio::settings::RoomKind::Dusk;
    let scale = settings.comfort.interface_scale.clamp(0.5, 2.5);
    for label in &wanted {
        let per_point = 1e-3 * DMM_PER_POINT * scale * label.at.distance(eyes).clamp(0.15, 20.0);
        let rotation = facing(label.at, eyes);
        let place = Transform {
            translation: label.at + rotation * Vec3::Y * (label.lift * per_point),
            rotation,
            scale: Vec3::splat(per_point),
        };
        let same = labels.shown.get(&label.key).is_some_and(|s| {
            s.text == label.text
                && s.weight == label.weight
                && s.edge == label.edge
                && s.dark == dark
                && s.print == labels.letters.print()
        });
        let entity = labels.shown.get(&label.key).map(|s| s.entity);
        if same {
            if let Some((mut transform, _)) = entity.and_then(|e| places.get_mut(e).ok()) {
                transform.set_if_neq(place);
            }
            continue;
        }
        let (mesh, fresh) = labels.letters.print_label(label, dark);
        if fresh || labels.ink == Handle::default() {
            let page = labels.letters.page(&mut images);
            let Labels { ink, front, .. } = &mut *labels;
            for (handle, over) in [(ink, Over::Clear), (front, Over::Front)] {
                let page = page.clone();
                // Set anew, so that the renderer takes the new letters.
                if *handle == Handle::default() {
                    *handle = inks.add(Ink { page, over });
                } else if let Some(mut known) = inks.get_mut(&*handle) {
                    *known = Ink { page, over };
                }
            }
        }
        // What stands in the middle of a thing, or of a stroke that grows, would be hidden by it.
        let ink = match label.key {
            LabelKey::Readout(_) | LabelKey::Operand(_) => &labels.front,
            _ => &labels.ink,
        };
        let mesh = meshes.add(mesh);
        let entity = match entity {
            Some(entity) => {
                if let Ok((mut transform, mut shown)) = places.get_mut(entity) {
                    *transform = place;
                    shown.0 = mesh;
                }
                entity
            }
            None => commands
                .spawn((
                    Name::new("label"),
                    Mesh3d(mesh),
                    MeshMaterial3d(ink.clone()),
                    NotShadowCaster,
                    NotShadowReceiver,
                    place,
                    ChildOf(*root),
                ))
                .id(),
        };
        labels.shown.insert(
            label.key,
            Shown {
                entity,
                text: label.text.clone(),
                weight: label.weight,
                edge: label.edge,
                print: labels.letters.print(),
                dark,
            },
        );
    }
}
