//! A keyboard to point at: for a gamepad, and for wands.

use bevy_egui::egui::{self, RichText, Sense, Ui, Vec2};

use super::{Palette, icon};

/// One key of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Types a letter, a digit or a sign.
    Letter(char),
    /// Capitals on or off.
    Shift,
    /// Types a space.
    Space,
    /// Takes the last one away.
    Erase,
    /// Types what was copied elsewhere.
    Paste,
    /// What is typed is accepted.
    Done,
}

const ROWS: [&str; 4] = ["1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm_./"];
const LAST: [Key; 5] = [Key::Shift, Key::Space, Key::Paste, Key::Erase, Key::Done];
const COLUMNS: usize = 10;
/// The side of a key, in points.
const SIDE: f32 = 40.0;
const GAP: f32 = 6.0;

/// Where one is on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Keyboard {
    row: usize,
    column: usize,
    /// Whether letters are capitals.
    pub capitals: bool,
}

impl Keyboard {
    /// One key to the right and down, around the edges.
    pub fn step(&mut self, right: i32, down: i32) {
        let rows = ROWS.len() as i32 + 1;
        self.row = (self.row as i32 + down).rem_euclid(rows) as usize;
        // The last row has fewer and broader keys.
        let by = if self.row == ROWS.len() && right != 0 {
            let at = self.column * LAST.len() / COLUMNS;
            let to = (at as i32 + right).rem_euclid(LAST.len() as i32);
            self.column = (to as usize * COLUMNS).div_ceil(LAST.len());
            0
        } else {
            right
        };
        self.column = (self.column as i32 + by).rem_euclid(COLUMNS as i32) as usize;
    }

    /// The key one is on.
    pub fn key(&self) -> Key {
        match ROWS.get(self.row) {
            Some(row) => self.letter(row.as_bytes()[self.column] as char),
            None => LAST[self.column * LAST.len() / COLUMNS],
        }
    }

    fn letter(&self, letter: char) -> Key {
        Key::Letter(if self.capitals {
            letter.to_ascii_uppercase()
        } else {
            letter
        })
    }
}

/// Draws it; says which key was clicked. `names` are what presses, erases, types a space and ends.
pub fn keyboard(ui: &mut Ui, state: &Keyboard, names: [&str; 4]) -> Option<Key> {
    let mut clicked = None;
    // Only where something presses the key one is on; a wand points.
    let chosen = (!names[0].is_empty()).then(|| state.key());
    ui.spacing_mut().item_spacing = Vec2::splat(GAP);
    for row in ROWS {
        ui.horizontal(|ui| {
            for letter in row.chars() {
                let key = state.letter(letter);
                if let Key::Letter(shown) = key
                    && cap(ui, &shown.to_string(), SIDE, chosen == Some(key))
                {
                    clicked = Some(key);
                }
            }
        });
    }
    let [press, erase, space, done] = names;
    let gaps = LAST.len() as f32 * GAP;
    let width = (COLUMNS as f32 * (SIDE + GAP) - gaps) / LAST.len() as f32;
    ui.horizontal(|ui| {
        for key in LAST {
            let text = match key {
                Key::Shift => format!("{} ABC", icon::ARROW_FAT_UP),
                Key::Space => format!("Space  {space}"),
                Key::Paste => format!("{} Paste", icon::CLIPBOARD_TEXT),
                Key::Erase => format!("{}  {erase}", icon::BACKSPACE),
                _ => format!("{}  {done}", icon::CHECK),
            };
            if cap(ui, text.trim(), width, chosen == Some(key)) {
                clicked = Some(key);
            }
        }
    });
    if !press.is_empty() {
        ui.label(RichText::new(format!("{press} types")).small());
    }
    clicked
}

/// One key; the field that is typed into keeps the focus.
fn cap(ui: &mut Ui, text: &str, width: f32, chosen: bool) -> bool {
    let (rect, response) = ui.allocate_exact_size(Vec2::new(width, SIDE), Sense::CLICK);
    let visuals = ui.visuals();
    let palette = Palette::of(visuals);
    let fill = if chosen {
        palette.accent_fill
    } else if response.hovered() {
        visuals.widgets.hovered.weak_bg_fill
    } else {
        visuals.widgets.inactive.weak_bg_fill
    };
    let colour = if chosen {
        palette.on_fill
    } else {
        visuals.text_color()
    };
    let painter = ui.painter();
    painter.rect_filled(rect, 6.0, fill);
    painter.text(
        rect.center(),
        egui::Align2::CENTER_CENTER,
        text,
        egui::TextStyle::Body.resolve(ui.style()),
        colour,
    );
    response.clicked()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_reached_by_steps() {
        let mut seen = Vec::new();
        let mut keyboard = Keyboard::default();
        for row in 0..=ROWS.len() {
            // The last row has fewer keys: so many steps lead round it once.
            let keys = ROWS.get(row).map_or(LAST.len(), |_| COLUMNS);
            for _ in 0..keys {
                seen.push(keyboard.key());
                keyboard.step(1, 0);
            }
            keyboard.step(0, 1);
        }
        for letter in ROWS.concat().chars() {
            assert!(seen.contains(&Key::Letter(letter)), "{letter}");
        }
        for key in LAST {
            assert!(seen.contains(&key), "{key:?}");
        }
        assert_eq!(keyboard, Keyboard::default());
    }
}
