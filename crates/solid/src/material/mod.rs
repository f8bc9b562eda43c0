//! What objects are made of: plain materials for judging form, and those that are written in WGSL.

mod written;

use std::path::Path;

use midair_document::{Kind, Object};
use midair_mesh::Finish;

pub use written::{Dial, HeadFault, MOST_DIALS};

/// A material a person can choose.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialInfo {
    /// Its name in documents, never changed.
    pub id: String,
    /// What people read.
    pub name: String,
    /// What it does, in a line.
    pub about: String,
    /// The colour of what has none of its own; [`PLAIN`] where `None`.
    pub colour: Option<[u8; 3]>,
    /// 0 as a mirror, 1 as chalk.
    pub roughness: f32,
    /// 0 or 1.
    pub metallic: f32,
    /// How much of it one sees through.
    pub clear: f32,
    /// What a person can set of it.
    pub dials: Vec<Dial>,
    /// Where it is written in WGSL: the whole text of its file. Roughness and the like are then the nearest that other
    /// programs can be told.
    pub wgsl: Option<String>,
}

impl MaterialInfo {
    fn plain(id: &str, name: &str, roughness: f32, metallic: f32, clear: f32) -> Self {
        Self {
            id: id.to_owned(),
            name: name.to_owned(),
            about: String::new(),
            colour: None,
            roughness,
            metallic,
            clear,
            dials: Vec::new(),
            wgsl: None,
        }
    }

    /// The numbers of its dials for an object, in their order: what is set of it, within bounds, and the usual for the
    /// rest.
    pub fn values(&self, object: &Object) -> Vec<f32> {
        let value = |d: &Dial| object.dials.get(&d.id).map_or(d.usual, |v| d.bound(*v));
        self.dials.iter().map(value).collect()
    }
}

/// The files of `assets/materials`, as they were when this was built.
const BUNDLED: [(&str, &str); 4] = [
    (
        "plush",
        include_str!("../../../../assets/materials/plush.wgsl"),
    ),
    (
        "pearl",
        include_str!("../../../../assets/materials/pearl.wgsl"),
    ),
    (
        "aurora",
        include_str!("../../../../assets/materials/aurora.wgsl"),
    ),
    (
        "jelly",
        include_str!("../../../../assets/materials/jelly.wgsl"),
    ),
];

/// All materials there are. The set is open: what a document names and is not here is shown as the first, and kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Materials(Vec<MaterialInfo>);

impl Default for Materials {
    fn default() -> Self {
        let plain = MaterialInfo::plain;
        let mut all = Self(vec![
            plain("matte", "Matte", 0.62, 0.0, 0.0),
            plain("clay", "Clay", 0.95, 0.0, 0.0),
            plain("gloss", "Gloss", 0.18, 0.0, 0.0),
            plain("metal", "Metal", 0.32, 1.0, 0.0),
            plain("glass", "Glass", 0.08, 0.0, 0.65),
        ]);
        for (id, text) in BUNDLED {
            // A test reads every one of them.
            if let Ok(info) = MaterialInfo::read(id, text) {
                all.put(info);
            }
        }
        all
    }
}

impl Materials {
    /// All of them, in the order in which they are offered; the first is every object's that has none of its own.
    pub fn iter(&self) -> impl Iterator<Item = &MaterialInfo> {
        self.0.iter()
    }

    /// The material of that name.
    pub fn find(&self, id: &str) -> Option<&MaterialInfo> {
        self.0.iter().find(|m| m.id == id)
    }

    /// The one at a place that [`Materials::place`] or [`Materials::put`] gave.
    pub fn at(&self, place: usize) -> &MaterialInfo {
        &self.0[place.min(self.0.len() - 1)]
    }

    /// The place of an object's material. A material that is missing is shown as the first.
    pub fn place(&self, object: &Object) -> usize {
        let named = |m: &MaterialInfo| Some(m.id.as_str()) == object.material.as_deref();
        self.0.iter().position(named).unwrap_or(0)
    }

    /// Takes a material in, in the place of one of the same name. Places stay as they are. The plain ones cannot be
    /// replaced: they are what form is judged by.
    pub fn put(&mut self, info: MaterialInfo) -> Option<usize> {
        match self.0.iter().position(|m| m.id == info.id) {
            Some(at) if self.0[at].wgsl.is_none() => None,
            Some(at) => {
                self.0[at] = info;
                Some(at)
            }
            None => {
                self.0.push(info);
                Some(self.0.len() - 1)
            }
        }
    }

    /// The text of a bundled material, as it was when this was built.
    pub fn bundled(id: &str) -> Option<&'static str> {
        BUNDLED
            .iter()
            .find(|(b, _)| *b == id)
            .map(|(_, text)| *text)
    }

    /// Takes in every material of a folder whose head can be read; whether its WGSL is sound is for those to say who
    /// draw with it.
    #[must_use]
    pub fn with_folder(mut self, folder: &Path) -> Self {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.extension().is_none_or(|e| e != "wgsl") {
                continue;
            }
            let (Some(id), Ok(text)) = (
                path.file_stem().and_then(|s| s.to_str()),
                std::fs::read_to_string(&path),
            ) else {
                continue;
            };
            if let Ok(info) = MaterialInfo::read(id, &text) {
                self.put(info);
            }
        }
        self
    }
}

/// The colours of construction lines and of strokes that have none of their own: as pencil and ink.
pub const INK: [[u8; 3]; 2] = [[0x8c, 0x8f, 0x96], [0x16, 0x17, 0x1a]];

/// The colour of an object that has none of its own.
pub const PLAIN: [u8; 3] = [0xc9, 0xc4, 0xbc];

/// How an object looks, as far as a file can say it: one that is written in WGSL as the nearest that its file names.
pub fn finish(object: &Object, materials: &Materials) -> Finish {
    let info = materials.at(materials.place(object));
    let plain = match object.kind {
        Kind::Line(_) => INK[0],
        Kind::Stroke(_) => INK[1],
        _ => info.colour.unwrap_or(PLAIN),
    };
    Finish {
        colour: object.colour.map_or(plain, |c| c.0),
        opacity: 1.0 - info.clear,
        roughness: info.roughness,
        metallic: info.metallic,
    }
}

#[cfg(test)]
mod tests {
    use midair_document::Colour;
    use midair_field::Primitive;

    use super::*;

    fn ball() -> Object {
        Object::solid("Ball", Primitive::Sphere { radius: 0.1 })
    }

    #[test]
    fn what_a_person_chose_is_what_a_file_gets() {
        let all = Materials::default();
        let mut object = ball();
        assert_eq!(finish(&object, &all).colour, PLAIN);
        object.colour = Some(Colour([200, 10, 30]));
        object.material = Some("metal".into());
        let of = finish(&object, &all);
        assert_eq!((of.colour, of.metallic), ([200, 10, 30], 1.0));
        object.material = Some("made by a plugin that is gone".into());
        assert_eq!(finish(&object, &all).roughness, 0.62);
    }

    #[test]
    fn one_written_in_wgsl_is_its_nearest_in_a_file() {
        let all = Materials::default();
        let mut object = ball();
        for (id, _) in BUNDLED {
            let info = all
                .find(id)
                .unwrap_or_else(|| panic!("{id} cannot be read"));
            assert!(info.wgsl.is_some() && !info.dials.is_empty() && !info.about.is_empty());
            object.material = Some(id.into());
            let of = finish(&object, &all);
            assert_eq!(Some(of.colour), info.colour);
            assert_eq!((of.roughness, of.metallic), (info.roughness, info.metallic));
        }
        object.colour = Some(Colour([1, 2, 3]));
        assert_eq!(finish(&object, &all).colour, [1, 2, 3]);
    }

    #[test]
    fn what_is_set_stays_within_bounds_and_the_rest_is_usual() {
        let all = Materials::default();
        let jelly = all.find("jelly").unwrap();
        let mut object = ball();
        let usual: Vec<_> = jelly.dials.iter().map(|d| d.usual).collect();
        assert_eq!(jelly.values(&object), usual);
        object.dials.insert(jelly.dials[0].id.clone(), 1e9);
        object.dials.insert("of another version".into(), 3.0);
        assert_eq!(jelly.values(&object)[0], jelly.dials[0].most);
        assert_eq!(jelly.values(&object)[1..], usual[1..]);
    }

    #[test]
    fn a_folder_adds_and_replaces_but_never_the_plain_ones() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text).unwrap();
        };
        write("moss.wgsl", "//! name: Moss\n//! colour: #336622\n");
        write("metal.wgsl", "//! name: Not metal\n");
        write("plush.wgsl", "//! name: My plush\n");
        write("bad.wgsl", "//! no head\n");
        write("notes.txt", "//! name: Notes\n");
        let all = Materials::default().with_folder(folder.path());
        assert_eq!(all.find("moss").unwrap().colour, Some([0x33, 0x66, 0x22]));
        assert_eq!(all.find("metal").unwrap().name, "Metal");
        assert_eq!(all.find("plush").unwrap().name, "My plush");
        assert!(all.find("bad").is_none() && all.find("notes").is_none());
    }
}
