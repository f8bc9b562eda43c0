use bevy::{platform::collections::HashMap, prelude::*, render::render_resource::Face};
use midair_document::Object;
use midair_solid::{MATERIALS, MaterialInfo};

use super::{Cue, Cues, ObjectEntity, Tint};
use crate::project::Project;

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
}

impl Look {
    fn of(object: &Object, cue: &Cue) -> Self {
        Self {
            tint: cue.tint,
            touched: cue.touched,
            selected: cue.selected,
            ghost: cue.ghost,
            own: object.colour.map(|c| c.0),
            material: MaterialInfo::index_of(object),
            mirrored: object.placement.scale.to_array().iter().product::<f32>() < 0.0,
        }
    }

    fn material(self) -> StandardMaterial {
        // An operand's colour says what it does and comes before its own.
        let base = match (self.tint, self.own) {
            (Tint::Plain, Some([r, g, b])) => Color::srgb_u8(r, g, b),
            (tint, _) => tint.colour(),
        };
        let info = MATERIALS[self.material];
        let alpha = match (self.ghost, self.touched || self.selected) {
            (true, true) => 0.42,
            (true, false) => 0.2,
            (false, _) => 1.0 - info.clear,
        };
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
            cull_mode: Some(if self.mirrored {
                Face::Front
            } else {
                Face::Back
            }),
            ..default()
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Looks>()
        // After the tools have said how things should look in this frame.
        .add_systems(
            PostUpdate,
            paint.run_if(resource_changed::<Cues>.or_else(resource_changed::<Project>)),
        );
}

fn paint(
    cues: Res<Cues>,
    project: Res<Project>,
    mut looks: ResMut<Looks>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut objects: Query<(&ObjectEntity, &mut MeshMaterial3d<StandardMaterial>)>,
) {
    let plain = Cue::default();
    for (object, mut material) in &mut objects {
        let cue = cues.0.get(&object.0).unwrap_or(&plain);
        let Some(thing) = project.document().object(object.0) else {
            continue;
        };
        if thing.reference().is_some() {
            continue;
        }
        let look = Look::of(thing, cue);
        let wanted = looks
            .0
            .entry(look)
            .or_insert_with(|| materials.add(look.material()));
        if material.0 != *wanted {
            material.0 = wanted.clone();
        }
    }
}
