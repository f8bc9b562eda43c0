use bevy::asset::AssetEventSystems;
use bevy::shader::Shader;
use bevy::{platform::collections::HashMap, prelude::*, render::render_resource::Face};
use midair_document::{Kind, Object, ObjectId};
use midair_solid::{INK, MOST_DIALS, MaterialInfo};

use super::follow::CloneOf;
use super::{Cue, Cues, ObjectEntity, Tint};
use crate::materials::{DialDraft, Living, MaterialShelf, Written, values};
use crate::project::Project;
use crate::settings::{LinesShown, RoomKind, Settings};

/// One material per look, made when first needed.
#[derive(Resource, Default)]
struct Looks {
    plain: HashMap<Look, Handle<StandardMaterial>>,
    living: HashMap<Look, Handle<Living>>,
}

/// Looks that are kept although nothing wears them at the moment.
const KEPT: usize = 64;

/// What an entity is drawn with.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Dress {
    Plain(Handle<StandardMaterial>),
    Living(Handle<Living>),
}

impl Default for Dress {
    fn default() -> Self {
        Self::Plain(Handle::default())
    }
}

/// What an entity is drawn with, as it is found.
pub(super) type Worn = (
    Option<&'static MeshMaterial3d<StandardMaterial>>,
    Option<&'static MeshMaterial3d<Living>>,
);

impl Dress {
    pub(super) fn of(
        worn: (
            Option<&MeshMaterial3d<StandardMaterial>>,
            Option<&MeshMaterial3d<Living>>,
        ),
    ) -> Self {
        match worn {
            (_, Some(living)) => Self::Living(living.0.clone()),
            (Some(plain), None) => Self::Plain(plain.0.clone()),
            (None, None) => Self::default(),
        }
    }

    /// Puts it on, in place of what was worn.
    pub(super) fn put_on(&self, entity: &mut EntityCommands) {
        match self {
            Self::Plain(handle) => entity
                .try_remove::<MeshMaterial3d<Living>>()
                .try_insert(MeshMaterial3d(handle.clone())),
            Self::Living(handle) => entity
                .try_remove::<MeshMaterial3d<StandardMaterial>>()
                .try_insert(MeshMaterial3d(handle.clone())),
        };
    }
}

/// What decides how a thing looks; things that look alike share one material.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Look {
    tint: Tint,
    touched: bool,
    selected: bool,
    ghost: bool,
    own: Option<[u8; 3]>,
    /// The place of its material, how often that was read, and the bits of what is set of it.
    material: usize,
    version: u32,
    dials: [u32; MOST_DIALS],
    /// Whether time changes it.
    moves: bool,
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
            // Lighter than the lines of the floor.
            (true, false) => [0xc9, 0xcb, 0xd2],
            (true, true) => [0xf1, 0xef, 0xea],
        };
        Color::srgb_u8(r, g, b)
    }
}

impl Look {
    fn of(
        id: ObjectId,
        object: &Object,
        cue: &Cue,
        settings: &Settings,
        shelf: &MaterialShelf,
        draft: &DialDraft,
    ) -> Self {
        let material = shelf.all().place(object);
        let mut dials = [0; MOST_DIALS];
        let set = values(shelf.all().at(material), id, object, draft);
        for (slot, value) in dials.iter_mut().zip(set) {
            *slot = value.to_bits();
        }
        Self {
            tint: cue.tint,
            touched: cue.touched,
            selected: cue.selected,
            ghost: cue.ghost,
            own: object.colour.map(|c| c.0),
            material,
            version: shelf.version(material),
            dials,
            moves: settings.look.motion,
            mirrored: object.placement.scale.to_array().iter().product::<f32>() < 0.0,
            ink: Ink::of(&object.kind, settings),
            open: object.sheet().is_some(),
        }
    }

    /// Whether what its file says is drawn: not where an operand's colour or a shell says something else.
    fn lives(self, info: &MaterialInfo) -> bool {
        let says = matches!(self.tint, Tint::Plain | Tint::Fresh);
        info.wgsl.is_some() && says && !self.ghost && self.ink.is_none()
    }

    fn living(self, info: &MaterialInfo) -> Living {
        let worn = Self {
            tint: Tint::Plain,
            ..self
        };
        Living {
            base: worn.material(info),
            extension: Written::new(self.material, &self.dials.map(f32::from_bits), self.moves),
        }
    }

    fn material(self, info: &MaterialInfo) -> StandardMaterial {
        // An operand's colour says what it does and comes before its own.
        let base = match (self.tint, self.own) {
            (Tint::Plain, Some([r, g, b])) => Color::srgb_u8(r, g, b),
            (Tint::Plain, None) if let Some(ink) = self.ink => ink.colour(),
            (Tint::Plain, None) if let Some([r, g, b]) = info.colour => Color::srgb_u8(r, g, b),
            (tint, _) => tint.colour(),
        };
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
        // Ink has no sheen: a bright room would make it grey.
        let matt = self.ink.is_some() && self.own.is_none();
        let glow = match (self.touched, self.selected) {
            (true, _) => 0.16,
            (false, true) => 0.07,
            (false, false) => 0.0,
        };
        StandardMaterial {
            base_color: base.with_alpha(alpha),
            emissive: base.to_linear() * glow,
            perceptual_roughness: if matt { 1.0 } else { info.roughness },
            metallic: info.metallic,
            reflectance: if matt { 0.0 } else { 0.35 },
            // A shell that coincides with the result lies on it like a skin, also where the lattice moved the result outwards: by a
            // thousandth of a step at most. A sixth of a millimetre at an arm's length.
            depth_bias: if self.ghost { 1024.0 } else { 0.0 },
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
        // After the tools have said how things should look in this frame; and before the engine looks at what is drawn
        // anew: of what changes its kind of material later, it would draw the new one with the old one's pipeline.
        .add_systems(
            PostUpdate,
            paint.before(AssetEventSystems).run_if(
                resource_changed::<Cues>
                    .or_else(resource_changed::<Project>)
                    .or_else(resource_changed::<Settings>)
                    .or_else(resource_changed::<MaterialShelf>)
                    .or_else(resource_changed::<DialDraft>)
                    .or_else(any_match_filter::<Added<ObjectEntity>>),
            ),
        );
}

fn paint(
    (cues, project, settings): (Res<Cues>, Res<Project>, Res<Settings>),
    draft: Res<DialDraft>,
    mut shelf: ResMut<MaterialShelf>,
    mut looks: ResMut<Looks>,
    mut plain: ResMut<Assets<StandardMaterial>>,
    mut living: ResMut<Assets<Living>>,
    mut shaders: ResMut<Assets<Shader>>,
    objects: Query<(Entity, Ref<ObjectEntity>, Worn), Without<CloneOf>>,
    clones: Query<(Entity, &CloneOf)>,
    mut painted: Local<Cues>,
    mut commands: Commands,
) {
    let mut changed = Vec::new();
    let usual = Cue::default();
    // Where nothing but cues changed, only what has another one than in the frame before is looked at.
    let all =
        project.is_changed() || settings.is_changed() || shelf.is_changed() || draft.is_changed();
    let other = |id: &ObjectId| painted.0.get(id) != cues.0.get(id);
    for (entity, object, worn) in &objects {
        if !all && !other(&object.0) && !object.is_added() {
            continue;
        }
        let cue = cues.0.get(&object.0).unwrap_or(&usual);
        let Some(thing) = project.document().object(object.0) else {
            continue;
        };
        if thing.reference().is_some() {
            continue;
        }
        let look = Look::of(object.0, thing, cue, &settings, &shelf, &draft);
        let info = shelf.all().at(look.material);
        let wanted = if look.lives(info) {
            let handle = match looks.living.get(&look) {
                Some(handle) => handle.clone(),
                None => {
                    let handle = living.add(look.living(info));
                    looks.living.insert(look, handle.clone());
                    shelf
                        .bypass_change_detection()
                        .ready(look.material, &mut shaders);
                    handle
                }
            };
            Dress::Living(handle)
        } else {
            let made = || plain.add(look.material(info));
            Dress::Plain(looks.plain.entry(look).or_insert_with(made).clone())
        };
        if Dress::of(worn) != wanted {
            wanted.put_on(&mut commands.entity(entity));
            changed.push((object.0, wanted));
        }
    }
    if *painted != *cues {
        painted.clone_from(&cues);
    }
    if looks.living.len() > KEPT {
        looks.living.retain(|_, handle| match handle {
            Handle::Strong(strong) => std::sync::Arc::strong_count(strong) > 1,
            Handle::Uuid(..) => true,
        });
    }
    if changed.is_empty() || clones.is_empty() {
        return;
    }
    for (entity, of) in &clones {
        if let Some((_, look)) = changed.iter().find(|(id, _)| *id == of.0) {
            look.put_on(&mut commands.entity(entity));
        }
    }
}
