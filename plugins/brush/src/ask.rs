//! What the panel, a session and other modes ask Brush for.

use serde::{Deserialize, Serialize};

/// One thing asked for, as RON in [`Command::Tool`](midair_studio::command::Command::Tool).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Ask {
    /// The next stroke begins a new painting.
    New,
    /// Goes on with this object; one that is no painting becomes one, its solid the first stroke.
    PaintOn(u64),
    /// Takes a solid of the library as the volume brush.
    Volume(String),
    /// Takes what was carried in as the volume brush.
    Carried,
    /// The next press selects the stroke it meets.
    Pick,
    /// Selects a stroke of the painting, from 0; none.
    Select(Option<usize>),
    /// Makes a stroke so many times as large.
    Resize(usize, f32),
    /// Gives a stroke a weight.
    Weight(usize, f32),
    /// Makes a stroke erase, or paint.
    Erase(usize, bool),
    /// Moves a stroke, metres of the painting.
    Move(usize, (f32, f32, f32)),
    /// Takes a stroke out.
    Delete(usize),
    /// How strokes of the painting blend.
    Mix {
        /// 1 melts, 16 unites.
        blend: f32,
        /// How far they feel each other, as a multiple of their radius.
        reach: f32,
        /// Whether this is what stays: otherwise it is only shown.
        done: bool,
    },
    /// No stroke of the painting follows anything any more.
    Free,
    /// Closes the polygon that is being drawn.
    Close,
}

impl Ask {
    /// As the command carries it.
    pub fn command(&self) -> midair_studio::command::Command {
        midair_studio::command::Command::Tool {
            tool: crate::BRUSH,
            ask: ron::to_string(self).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn asks_are_read_as_they_are_written() {
        for ask in [
            Ask::New,
            Ask::Volume("brush/cat".into()),
            Ask::Select(Some(3)),
            Ask::Mix {
                blend: 2.0,
                reach: 1.5,
                done: true,
            },
        ] {
            let text = ron::to_string(&ask).unwrap();
            assert_eq!(ron::from_str::<Ask>(&text).unwrap(), ask, "{text}");
        }
    }
}
