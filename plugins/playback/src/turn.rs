use std::fmt;

use bevy::math::{EulerRot, Quat};
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{self, SeqAccess, Visitor},
    ser::SerializeTuple,
};

/// How a hand is turned: absolute, not relative to where it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// Written `(pitch, yaw, roll)` in degrees: yaw about +Y, then pitch about the hand's +X, then
    /// roll about its +Z.
    Degrees([f32; 3]),
    /// Written `(x, y, z, w)`; need not have length one.
    Quat([f32; 4]),
}

impl Turn {
    /// The rotation, or `None` where the numbers make none (not finite, or of no length).
    pub fn rotation(self) -> Option<Quat> {
        let q = match self {
            Self::Degrees(d) => {
                let [pitch, yaw, roll] = d.map(f32::to_radians);
                Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll)
            }
            Self::Quat(q) => Quat::from_array(q),
        };
        let length = q.length();
        (q.is_finite() && length > 1e-6 && length.is_finite()).then(|| q.normalize())
    }

    /// The rotation as it is written, sound or not.
    pub fn raw(self) -> Quat {
        match self {
            Self::Quat(q) => self.rotation().unwrap_or(Quat::from_array(q)),
            Self::Degrees(_) => self.rotation().unwrap_or(Quat::NAN),
        }
    }
}

impl Serialize for Turn {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        let numbers: &[f32] = match self {
            Self::Degrees(d) => d,
            Self::Quat(q) => q,
        };
        let mut tuple = s.serialize_tuple(numbers.len())?;
        for n in numbers {
            tuple.serialize_element(n)?;
        }
        tuple.end()
    }
}

impl<'de> Deserialize<'de> for Turn {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Numbers;

        impl<'de> Visitor<'de> for Numbers {
            type Value = Turn;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("(pitch, yaw, roll) in degrees or a quaternion (x, y, z, w)")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Turn, A::Error> {
                let mut n = [0.0; 4];
                let mut len = 0;
                while let Some(x) = seq.next_element()? {
                    *n.get_mut(len)
                        .ok_or_else(|| de::Error::invalid_length(len + 1, &self))? = x;
                    len += 1;
                }
                match len {
                    3 => Ok(Turn::Degrees([n[0], n[1], n[2]])),
                    4 => Ok(Turn::Quat(n)),
                    _ => Err(de::Error::invalid_length(len, &self)),
                }
            }
        }

        d.deserialize_any(Numbers)
    }
}
