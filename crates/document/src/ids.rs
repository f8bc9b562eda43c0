use std::fmt;

use serde::{Deserialize, Serialize};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u64);

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// Names an object within its document, for good: an id is never handed out twice.
    ObjectId
);
id!(
    /// Names a layer. Layers, groups and objects draw their ids from one counter.
    LayerId
);
id!(
    /// Names a group.
    GroupId
);

impl LayerId {
    /// The layer that every document has.
    pub const BASE: Self = Self(0);
}
