//! What objects can be made of: the plain materials, and those that are written in WGSL.
//!
//! The files lie in `assets/materials` and in the person's own folder, and are read again while the app runs. One that
//! naga finds fault with is told in a line, and what was there before stays.

mod living;
mod text;
mod watch;

use std::collections::BTreeSet;

use bevy::prelude::*;
use bevy::shader::Shader;
use midair_document::ObjectId;
use midair_solid::{MaterialInfo, Materials};

pub use living::{Living, Written};

use crate::StudioSet;
use crate::notice::Notices;
use crate::project::{Places, Project};

/// All materials at hand.
#[derive(Resource, Debug, Default)]
pub struct MaterialShelf {
    all: Materials,
    /// How often each was read, by its place.
    read: Vec<u32>,
    /// Whether its shader was made.
    compiled: Vec<bool>,
    /// Which of them move what is made of them.
    shifts: Vec<bool>,
}

impl MaterialShelf {
    /// They themselves.
    pub fn all(&self) -> &Materials {
        &self.all
    }

    /// How often the file at a place was read: what was made of it before is old.
    pub fn version(&self, place: usize) -> u32 {
        self.read.get(place).copied().unwrap_or(0)
    }

    /// Takes in a file's text under its name. Where it is no material, what was there stays.
    fn take(
        &mut self,
        id: &str,
        text: &str,
        shaders: &mut Assets<Shader>,
    ) -> Result<(), text::Fault> {
        let known = self.all.find(id);
        if known.is_some_and(|k| k.wgsl.as_deref() == Some(text)) {
            return Ok(());
        }
        if known.is_some_and(|k| k.wgsl.is_none()) {
            return Err(text::Fault {
                line: 1,
                why: format!(
                    "{id} is a plain material, which stays as it is; give the file another name"
                ),
            });
        }
        let info = text::read(id, text)?;
        if let Some(place) = self.all.put(info) {
            grow(&mut self.read, place);
            self.read[place] += 1;
            if self.compiled.get(place) == Some(&true) {
                self.compile(place, shaders);
            }
        }
        Ok(())
    }

    /// Whether the material at a place moves what is made of it, so that it is seen elsewhere than it was modelled.
    pub(crate) fn shifts(&self, place: usize) -> bool {
        self.shifts.get(place) == Some(&true)
    }

    /// The material at a place is about to be drawn with.
    pub(crate) fn ready(&mut self, place: usize, shaders: &mut Assets<Shader>) {
        grow(&mut self.compiled, place);
        if !std::mem::replace(&mut self.compiled[place], true) {
            self.compile(place, shaders);
        }
    }

    fn compile(&mut self, place: usize, shaders: &mut Assets<Shader>) {
        let info = self.all.at(place);
        grow(&mut self.shifts, place);
        self.shifts[place] = info.wgsl.as_deref().is_some_and(text::shifts);
        living::compile(place, info, shaders);
    }
}

fn grow<T: Default + Clone>(list: &mut Vec<T>, place: usize) {
    if list.len() <= place {
        list.resize(place + 1, T::default());
    }
}

/// Numbers of materials while they are dragged: shown, and not in the document yet.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct DialDraft {
    /// Whose.
    pub ids: Vec<ObjectId>,
    /// Which, and what it is for now.
    pub dial: Option<(String, f32)>,
}

/// A material's numbers for an object, with what is being dragged.
pub(crate) fn values(
    info: &MaterialInfo,
    id: ObjectId,
    object: &midair_document::Object,
    draft: &DialDraft,
) -> Vec<f32> {
    let mut values = info.values(object);
    if let Some((name, value)) = &draft.dial
        && draft.ids.contains(&id)
        && let Some(at) = info.dials.iter().position(|d| d.id == *name)
    {
        values[at] = info.dials[at].bound(*value);
    }
    values
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<MaterialShelf>()
        .init_resource::<DialDraft>()
        .add_systems(
            Update,
            miss.run_if(resource_changed::<Project>)
                .in_set(StudioSet::Cue),
        );
    living::plugin(app);
    watch::plugin(app);
}

/// What an object is made of may be at another place: it is told once, and the object keeps it.
fn miss(
    project: Res<Project>,
    shelf: Res<MaterialShelf>,
    places: Option<Res<Places>>,
    mut said: Local<BTreeSet<String>>,
    mut notices: ResMut<Notices>,
) {
    for (_, object) in project.document().objects() {
        let Some(id) = &object.material else { continue };
        if shelf.all.find(id).is_some() || !said.insert(id.clone()) {
            continue;
        }
        let way = match &places {
            Some(places) => format!(
                " Put {id}.wgsl into {}, or choose another.",
                places.library.materials().display()
            ),
            None => String::new(),
        };
        notices.warn(format!(
            "{} is made of \"{id}\", a material that is not here; it looks plain.{way}",
            object.name
        ));
    }
}
