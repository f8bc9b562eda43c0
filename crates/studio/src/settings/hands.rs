use serde::{Deserialize, Serialize};

use crate::hands::Side;

/// How the two hands share the work.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct HandsSettings {
    /// Whether everything is mirrored: the left hand leads and has the library, the right one saves.
    pub left_handed: bool,
}

impl HandsSettings {
    /// The hand that leads: it has the library and the menu.
    pub fn main(&self) -> Side {
        if self.left_handed {
            Side::Left
        } else {
            Side::Right
        }
    }

    /// The other one: it saves what it touches.
    pub fn off(&self) -> Side {
        self.main().other()
    }
}
