use midair_document::{Kind, Object};
use midair_mesh::Finish;

/// A material a person can choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialInfo {
    /// Its name in documents, never changed.
    pub id: &'static str,
    /// What people read.
    pub name: &'static str,
    /// 0 as a mirror, 1 as chalk.
    pub roughness: f32,
    /// 0 or 1.
    pub metallic: f32,
    /// How much of it one sees through.
    pub clear: f32,
}

/// The materials for judging form; the first is every object's that has none of its own.
pub const MATERIALS: &[MaterialInfo] = &[
    MaterialInfo {
        id: "matte",
        name: "Matte",
        roughness: 0.62,
        metallic: 0.0,
        clear: 0.0,
    },
    MaterialInfo {
        id: "clay",
        name: "Clay",
        roughness: 0.95,
        metallic: 0.0,
        clear: 0.0,
    },
    MaterialInfo {
        id: "gloss",
        name: "Gloss",
        roughness: 0.18,
        metallic: 0.0,
        clear: 0.0,
    },
    MaterialInfo {
        id: "metal",
        name: "Metal",
        roughness: 0.32,
        metallic: 1.0,
        clear: 0.0,
    },
    MaterialInfo {
        id: "glass",
        name: "Glass",
        roughness: 0.08,
        metallic: 0.0,
        clear: 0.65,
    },
];

/// The colours of construction lines and of strokes that have none of their own: as pencil and ink.
pub const INK: [[u8; 3]; 2] = [[0x8c, 0x8f, 0x96], [0x16, 0x17, 0x1a]];

/// The colour of an object that has none of its own.
pub const PLAIN: [u8; 3] = [0xc9, 0xc4, 0xbc];

impl MaterialInfo {
    /// The place of an object's material in [`MATERIALS`]. A material of a plugin that is missing is
    /// shown as the first, and kept.
    pub fn index_of(object: &Object) -> usize {
        let named = |m: &Self| Some(m.id) == object.material.as_deref();
        MATERIALS.iter().position(named).unwrap_or(0)
    }
}

/// How an object looks, as far as a file can say it.
pub fn finish(object: &Object) -> Finish {
    let info = MATERIALS[MaterialInfo::index_of(object)];
    let plain = match object.kind {
        Kind::Line(_) => INK[0],
        Kind::Stroke(_) => INK[1],
        _ => PLAIN,
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

    #[test]
    fn what_a_person_chose_is_what_a_file_gets() {
        let mut object = Object::solid("Ball", Primitive::Sphere { radius: 0.1 });
        assert_eq!(finish(&object).colour, PLAIN);
        object.colour = Some(Colour([200, 10, 30]));
        object.material = Some("metal".into());
        let of = finish(&object);
        assert_eq!((of.colour, of.metallic), ([200, 10, 30], 1.0));
        object.material = Some("made by a plugin that is gone".into());
        assert_eq!(finish(&object).roughness, MATERIALS[0].roughness);
    }
}
