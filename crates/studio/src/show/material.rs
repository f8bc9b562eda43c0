use bevy::{platform::collections::HashMap, prelude::*};

use super::{Cue, Cues, ObjectEntity, Tint};

/// One material per look, made when first needed.
#[derive(Resource, Default)]
struct Looks(HashMap<Look, Handle<StandardMaterial>>);

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Look {
    tint: Tint,
    touched: bool,
    selected: bool,
}

impl Look {
    fn material(self) -> StandardMaterial {
        let base = self.tint.colour();
        let glow = match (self.touched, self.selected) {
            (true, _) => 0.16,
            (false, true) => 0.07,
            (false, false) => 0.0,
        };
        StandardMaterial {
            base_color: base,
            emissive: base.to_linear() * glow,
            perceptual_roughness: 0.62,
            reflectance: 0.35,
            ..default()
        }
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Looks>()
        // After the tools have said how things should look in this frame.
        .add_systems(PostUpdate, paint);
}

fn paint(
    cues: Res<Cues>,
    mut looks: ResMut<Looks>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut objects: Query<(&ObjectEntity, &mut MeshMaterial3d<StandardMaterial>)>,
) {
    let plain = Cue::default();
    for (object, mut material) in &mut objects {
        let cue = cues.0.get(&object.0).unwrap_or(&plain);
        let look = Look {
            tint: cue.tint,
            touched: cue.touched,
            selected: cue.selected,
        };
        let wanted = looks
            .0
            .entry(look)
            .or_insert_with(|| materials.add(look.material()));
        if material.0 != *wanted {
            material.0 = wanted.clone();
        }
    }
}
