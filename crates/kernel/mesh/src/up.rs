use std::fmt;
use std::str::FromStr;

use glam::Vec3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::{Format, TriMesh};

/// Which axis points up in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Up {
    /// Y, as in Midair, glTF and most engines.
    #[default]
    Y,
    /// Z, as in slicers and most CAD.
    Z,
}

impl Up {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Y, Self::Z];
}

impl Format {
    /// The axis that programs reading this format take for up: Z for STL and 3MF, which slicers read,
    /// Y for the rest.
    pub const fn up(self) -> Up {
        match self {
            Self::Stl | Self::ThreeMf => Up::Z,
            Self::Glb | Self::Gltf | Self::Obj | Self::Ply => Up::Y,
        }
    }
}

impl TriMesh {
    /// A mesh that stands on its feet where Y is up, turned about X so that it does where `up` is. No
    /// digit is lost.
    #[must_use]
    pub fn standing(self, up: Up) -> Self {
        self.each(up, |v| Vec3::new(v.x, 0.0 - v.z, v.y))
    }

    /// The way back: from a file in which `up` is up.
    #[must_use]
    pub fn stood_up(self, up: Up) -> Self {
        self.each(up, |v| Vec3::new(v.x, v.z, 0.0 - v.y))
    }

    fn each(mut self, up: Up, turn: impl Fn(Vec3) -> Vec3) -> Self {
        if up == Up::Z {
            for v in self.positions.iter_mut().chain(&mut self.normals) {
                *v = turn(*v);
            }
        }
        self
    }
}

impl fmt::Display for Up {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Y => "y",
            Self::Z => "z",
        })
    }
}

/// A word that names no such axis.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0:?} cannot be up. Use y or z.")]
pub struct UnknownUp(pub String);

impl FromStr for Up {
    type Err = UnknownUp;
    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let named = |up: &Self| up.to_string() == s.to_ascii_lowercase();
        Self::ALL
            .into_iter()
            .find(named)
            .ok_or_else(|| UnknownUp(s.into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrow() -> TriMesh {
        TriMesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(0.1, 0.7, 0.3)],
            normals: vec![Vec3::Y; 3],
            triangles: vec![[0, 1, 2]],
        }
    }

    #[test]
    fn what_pointed_up_points_up_and_comes_back_to_the_last_bit() {
        let turned = arrow().standing(Up::Z);
        assert_eq!(turned.positions[2], Vec3::new(0.1, -0.3, 0.7));
        assert_eq!(turned.normals[0], Vec3::Z);
        assert_eq!(turned.stood_up(Up::Z), arrow());
        assert_eq!(arrow().standing(Up::Y), arrow());
        // Nothing becomes a nought with a sign.
        assert!(arrow().standing(Up::Z).positions[0].y.is_sign_positive());
    }

    #[test]
    fn slicers_have_z_up() {
        for (format, up) in [
            (Format::Stl, Up::Z),
            (Format::ThreeMf, Up::Z),
            (Format::Glb, Up::Y),
            (Format::Obj, Up::Y),
            (Format::Ply, Up::Y),
        ] {
            assert_eq!(format.up(), up);
        }
        assert_eq!("Z".parse(), Ok(Up::Z));
        assert!("x".parse::<Up>().is_err());
    }
}
