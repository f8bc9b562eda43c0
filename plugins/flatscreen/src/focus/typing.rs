//! The keyboard on the screen: A types, X erases, Y space, Start done.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiInput, egui};
use midair_studio::panel::{self, Key, Keyboard};

use super::Focus;
use super::drive::key;
use crate::bindings::{Bindings, Control, Controls, Device};
use crate::panels::Screen;

/// Whether it is up, and where one is on it.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Typing {
    /// Whether it is up.
    pub open: bool,
    /// Which key one is on.
    pub state: Keyboard,
    /// A key that was clicked with the mouse.
    clicked: Option<Key>,
}

impl Typing {
    /// Puts it up.
    pub(super) fn begin(&mut self) {
        *self = Self {
            open: true,
            ..default()
        };
    }

    /// Reads the gamepad and types into the field that has the focus.
    pub(super) fn drive(
        &mut self,
        controls: &Controls,
        focus: &mut Focus,
        input: &mut EguiInput,
        copied: impl FnOnce() -> Option<String>,
    ) {
        if !focus.is_text() {
            self.open = false;
            return;
        }
        for (control, right, down) in [
            (Control::TypeUp, 0, -1),
            (Control::TypeRight, 1, 0),
            (Control::TypeDown, 0, 1),
            (Control::TypeLeft, -1, 0),
        ] {
            if controls.fired(control) {
                self.state.step(right, down);
            }
        }
        let pressed = [
            (Control::TypeErase, Key::Erase),
            (Control::TypeSpace, Key::Space),
            (Control::TypeShift, Key::Shift),
            (Control::TypeDone, Key::Done),
        ]
        .into_iter()
        .filter(|&(control, _)| controls.fired(control))
        .map(|(_, key)| key);
        let chosen = controls.fired(Control::TypeKey).then_some(self.state.key());
        let keys: Vec<_> = pressed.chain(chosen).chain(self.clicked.take()).collect();
        let mut copied = Some(copied);
        for pressed in keys {
            let tap = match pressed {
                Key::Letter(letter) => {
                    input.events.push(egui::Event::Text(letter.to_string()));
                    continue;
                }
                Key::Space => {
                    input.events.push(egui::Event::Text(" ".to_owned()));
                    continue;
                }
                Key::Paste => {
                    let text = copied.take().and_then(|copied| copied());
                    if let Some(text) = text.map(|t| one_line(&t)).filter(|t| !t.is_empty()) {
                        input.events.push(egui::Event::Paste(text));
                    }
                    continue;
                }
                Key::Shift => {
                    self.state.capitals = !self.state.capitals;
                    continue;
                }
                Key::Erase => egui::Key::Backspace,
                Key::Done => {
                    self.open = false;
                    egui::Key::Enter
                }
            };
            input.events.extend([key(tap, true), key(tap, false)]);
        }
        if controls.just_pressed(Control::TypeCancel) {
            self.open = false;
        }
    }
}

/// The most that is pasted at once, in letters.
const PASTED: usize = 4096;

/// What a field of one line can hold of what was copied.
fn one_line(text: &str) -> String {
    let letters = text
        .trim()
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c });
    letters.take(PASTED).collect()
}

pub(crate) fn show(
    mut contexts: EguiContexts,
    screen: Res<Screen>,
    bindings: Res<Bindings>,
    mut typing: ResMut<Typing>,
) -> Result {
    let Some(view) = screen.view().filter(|_| typing.open) else {
        return Ok(());
    };
    let named = |control| bindings.label(control, Device::Pad);
    let names = [
        Control::TypeKey,
        Control::TypeErase,
        Control::TypeSpace,
        Control::TypeDone,
    ]
    .map(named);
    let ctx = contexts.ctx_mut()?;
    let shown = egui::Area::new("keyboard".into())
        .order(egui::Order::Foreground)
        .pivot(egui::Align2::CENTER_BOTTOM)
        .fixed_pos(view.center_bottom() - egui::vec2(0.0, 16.0))
        .constrain(true)
        .show(ctx, |ui| {
            let frame = egui::Frame::window(ui.style()).inner_margin(12.0);
            frame
                .show(ui, |ui| {
                    panel::keyboard(ui, &typing.state, names.each_ref().map(String::as_str))
                })
                .inner
        });
    if shown.inner.is_some() {
        typing.clicked = shown.inner;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_pasted_is_one_line_of_bearable_length() {
        assert_eq!(one_line("  ab\n\tcd \0"), "ab  cd  ");
        assert_eq!(one_line(&"é".repeat(9000)).chars().count(), PASTED);
        assert_eq!(one_line("\n \t"), "");
    }
}
