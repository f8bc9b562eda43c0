use bevy::{platform::collections::HashMap, prelude::*, render::render_resource::Face};
use midair_document::{Kind, Object};
use midair_solid::{INK, MATERIALS, MaterialInfo};

use super::follow::CloneOf;
use super::{Cue, Cues, ObjectEntity, Tint};
use crate::project::Project;
use crate::settings::{LinesShown, RoomKind, Settings};

/// One material per look, made when first needed.
#[derive(Resource, Default)]
struct Looks(HashMap<Look, Handle<StandardMaterial>>);

/// What decides how a thing looks; things that look alike share one material.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Look {
    tint: Tint,
    touched: bool,
    selected: bool,
    ghost: bool,
    own: Option<[u8; 3]>,
    /// Which of [`MATERIALS`].
    material: usize,
    /// A mirror image shows the other side of its triangles.
    mirrored: bool,
    ink: Option<Ink>,
    /// A surface without inside is seen from both sides.
    open: bool,
}

/// What decides how something drawn looks.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Ink {
    stroke: bool,
    dimmed: bool,
    /// On dark ground ink is light.
    dark: bool,
}

impl Ink {
    fn of(kind: &Kind, settings: &Settings) -> Option<Self> {
        let stroke = match kind {
            Kind::Line(_) => false,
            Kind::Stroke(_) => true,
            _ => return None,
        };
        Some(Self {
            stroke,
            dimmed: !stroke && settings.scaffold.lines == LinesShown::Dimmed,
            dark: settings.look.room == RoomKind::Dusk,
        })
    }

    fn colour(self) -> Color {
        let [r, g, b] = match (self.dark, self.stroke) {
            (false, stroke) => INK[usize::from(stroke)],
            (true, false) => [0x9a, 0x9d, 0xa6],
            (true, true) => [0xf1, 0xef, 0xea],
        };
        Color::srgb_u8(r, g, b)
    }
}

impl Look {
    fn of(object: &Object, cue: &Cue, settings: &Settings) -> Self {
        Self {
            tint: cue.tint,
            touched: cue.touched,
            selected: cue.selected,
            ghost: cue.ghost,
            own: object.colour.map(|c| c.0),
            material: MaterialInfo::index_of(object),
            mirrored: object.placement.scale.to_array().iter().product::<f32>() < 0.0,
            ink: Ink::of(&object.kind, settings),
            open: object.sheet().is_some(),
        }
    }

    fn material(self) -> StandardMaterial {
        // An operand's colour says what it does and comes before its own.
        let base = match (self.tint, self.own) {
            (Tint::Plain, Some([r, g, b])) => Color::srgb_u8(r, g, b),
            (Tint::Plain, None) if let Some(ink) = self.ink => ink.colour(),
            (tint, _) => tint.colour(),
        };
        let info = MATERIALS[self.material];
        let alpha = match (self.ghost, self.touched || self.selected) {
            (true, true) => 0.42,
            (true, false) => 0.2,
            (false, _) => 1.0 - info.clear,
        };
        // Thin lines have no light and shade.
        if let Some(ink) = self.ink.filter(|ink| !ink.stroke) {
            let alpha = if ink.dimmed || self.ghost { 0.22 } else { 0.9 };
            return StandardMaterial {
                base_color: base.with_alpha(if self.touched || self.selected {
                    1.0
                } else {
                    alpha
                }),
                unlit: true,
                alpha_mode: AlphaMode::Blend,
                ..default()
            };
        }
        let glow = match (self.touched, self.selected) {
            (true, _) => 0.16,
            (false, true) => 0.07,
            (false, false) => 0.0,
        };
        StandardMaterial {
            base_color: base.with_alpha(alpha),
            emissive: base.to_linear() * glow,
            perceptual_roughness: info.roughness,
            metallic: info.metallic,
            reflectance: 0.35,
            // A shell that coincides with the result lies on it like a skin.
            depth_bias: if self.ghost { 32.0 } else { 0.0 },
            alpha_mode: if alpha < 1.0 {
                AlphaMode::Blend
            } else {
                AlphaMode::Opaque
            },
            double_sided: self.open,
            cull_mode: match (self.open, self.mirrored) {
                (true, _) => None,
                (false, true) => Some(Face::Front),
                (false, false) => Some(Face::Back),
            },
            ..default()
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Looks>()
        // After the tools have said how things should look in this frame.
        .add_systems(
            PostUpdate,
            paint.run_if(
                resource_changed::<Cues>
                    .or_else(resource_changed::<Project>)
                    .or_else(resource_changed::<Settings>),
            ),
        );
}

fn paint(
    cues: Res<Cues>,
    project: Res<Project>,
    settings: Res<Settings>,
    mut looks: ResMut<Looks>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut objects: Query<(&ObjectEntity, &mut MeshMaterial3d<StandardMaterial>), Without<CloneOf>>,
    mut clones: Query<(&CloneOf, &mut MeshMaterial3d<StandardMaterial>)>,
) {
    let mut changed = Vec::new();
    let plain = Cue::default();
    for (object, mut material) in &mut objects {
        let cue = cues.0.get(&object.0).unwrap_or(&plain);
        let Some(thing) = project.document().object(object.0) else {
            continue;
        };
        if thing.reference().is_some() {
            continue;
        }
        let look = Look::of(thing, cue, &settings);
        let wanted = looks
            .0
            .entry(look)
            .or_insert_with(|| materials.add(look.material()));
        if material.0 != *wanted {
            material.0 = wanted.clone();
            changed.push((object.0, wanted.clone()));
        }
    }
    if changed.is_empty() || clones.is_empty() {
        return;
    }
    for (of, mut material) in &mut clones {
        if let Some((_, look)) = changed.iter().find(|(id, _)| *id == of.0) {
            material.0 = look.clone();
        }
    }
}
