//! Binding by pressing: the next key, button or stick is the control's.

use std::sync::{Arc, Mutex};

use bevy::input::gamepad::{Gamepad, GamepadAxis};
use bevy::prelude::*;
use midair_studio::notice::Notices;

use super::{Attention, Binding, Bindings, Control, Device, Part, Stick};

/// What the list of controls asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rebind {
    /// Waits for what is pressed next.
    Await(Control, Device),
    /// Binds it to nothing on that device.
    Clear(Control, Device),
    /// Back to the usual keys.
    Reset(Control),
    /// All of them back to the usual keys.
    ResetAll,
}

/// What the list has asked for and nobody has done yet: a panel sees the world and cannot change it.
#[derive(Resource, Clone, Default)]
pub(crate) struct Asked(Arc<Mutex<Vec<Rebind>>>);

impl Asked {
    pub fn push(&self, rebind: Rebind) {
        if let Ok(mut asked) = self.0.lock() {
            asked.push(rebind);
        }
    }

    fn take(&self) -> Vec<Rebind> {
        self.0
            .lock()
            .map(|mut a| std::mem::take(&mut *a))
            .unwrap_or_default()
    }
}

/// Whose key is awaited.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Rebinding {
    awaited: Option<(Control, Device)>,
    /// What is down of it so far, in the order in which it went down.
    held: Vec<Part>,
    /// What was down when it began is up again.
    clear: bool,
}

impl Rebinding {
    /// The control and device that wait for a key.
    pub fn awaited(&self) -> Option<(Control, Device)> {
        self.awaited
    }

    /// Takes in what is down; says what it comes to once something is let go or no modifier went down.
    fn advance(&mut self, down: &[Part]) -> Option<Binding> {
        if !self.clear {
            self.clear = down.is_empty();
            return None;
        }
        for &part in down {
            if !self.held.contains(&part) {
                self.held.push(part);
            }
        }
        let modifier = |part: &Part| matches!(part, Part::Modifier(_));
        let on_pad = self.held.first().is_some_and(|p| p.device() == Device::Pad);
        let whole = match self.held.last() {
            None => false,
            // Pad buttons, modifiers and the mouse's own may lead a chord: what is let go ends it.
            Some(last) if on_pad || modifier(last) || matches!(last, Part::Mouse(_)) => {
                self.held.iter().any(|p| !down.contains(p))
            }
            Some(_) => true,
        };
        whole.then(|| Binding::Chord(std::mem::take(&mut self.held)))
    }
}

/// Carries out what the list asked for, and listens for the key it waits for.
pub(crate) fn rebind(
    (keys, mouse, pads): (
        Res<ButtonInput<KeyCode>>,
        Res<ButtonInput<MouseButton>>,
        Query<&Gamepad>,
    ),
    asked: Res<Asked>,
    mut rebinding: ResMut<Rebinding>,
    mut bindings: ResMut<Bindings>,
    mut attention: ResMut<Attention>,
    mut notices: ResMut<Notices>,
) {
    for ask in asked.take() {
        match ask {
            Rebind::Await(control, device) => {
                *rebinding = Rebinding {
                    awaited: Some((control, device)),
                    ..default()
                };
            }
            Rebind::Clear(control, device) => bindings.bind(control, device, None),
            Rebind::Reset(control) => bindings.reset(control),
            Rebind::ResetAll => bindings.reset_all(),
        }
    }
    attention.rebinding = rebinding.awaited.is_some();
    let Some((control, device)) = rebinding.awaited else {
        return;
    };
    if keys.just_pressed(KeyCode::Escape) && control != Control::Cancel {
        rebinding.awaited = None;
        return;
    }
    let found = if control.is_stick() {
        pads.iter().find_map(pushed).map(Binding::Stick)
    } else {
        let down = down(device, &keys, &mouse, &pads);
        rebinding.advance(&down)
    };
    if let Some(binding) = found {
        rebinding.awaited = None;
        bindings.bind(control, device, Some(binding.clone()));
        let others = bindings.conflicts(control);
        if let Some((other, shared)) = others.first() {
            notices.info(format!(
                "{shared} is also \"{}\". Both happen; change one of them in Controls.",
                other.words()
            ));
        }
    }
}

/// The named parts of a device that are down.
fn down(
    device: Device,
    keys: &ButtonInput<KeyCode>,
    mouse: &ButtonInput<MouseButton>,
    pads: &Query<&Gamepad>,
) -> Vec<Part> {
    let is_down = |part: &Part| match *part {
        Part::Modifier(m) => keys.any_pressed(m.keycodes()),
        Part::Key(k) => keys.pressed(k),
        Part::Mouse(m) => mouse.pressed(m),
        Part::Pad(b) => pads.iter().any(|p| p.pressed(b)),
    };
    let mut down: Vec<_> = Part::all(device).into_iter().filter(is_down).collect();
    // What is held stands before what it is held for.
    down.sort_by_key(|p| !matches!(p, Part::Modifier(_)));
    down
}

/// The stick that is pushed.
fn pushed(pad: &Gamepad) -> Option<Stick> {
    let far = |x, y| Vec2::new(pad.get(x).unwrap_or(0.0), pad.get(y).unwrap_or(0.0)).length() > 0.7;
    if far(GamepadAxis::LeftStickX, GamepadAxis::LeftStickY) {
        Some(Stick::Left)
    } else if far(GamepadAxis::RightStickX, GamepadAxis::RightStickY) {
        Some(Stick::Right)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::input::gamepad::GamepadButton;
    use leafwing_input_manager::user_input::ModifierKey;

    fn run(frames: &[&[Part]]) -> Option<String> {
        let mut rebinding = Rebinding::default();
        frames
            .iter()
            .find_map(|down| rebinding.advance(down))
            .map(|b| b.to_string())
    }

    #[test]
    fn what_is_pressed_is_what_is_bound() {
        let (ctrl, z) = (
            Part::Modifier(ModifierKey::Control),
            Part::Key(KeyCode::KeyZ),
        );
        let enter = Part::Key(KeyCode::Enter);
        // The Enter that began it is not meant.
        assert_eq!(
            run(&[&[enter], &[], &[ctrl], &[ctrl, z]]).unwrap(),
            "Ctrl+Z"
        );
        assert_eq!(run(&[&[], &[z]]).unwrap(), "Z");
        assert_eq!(run(&[&[], &[ctrl], &[]]).unwrap(), "Ctrl");
        assert_eq!(run(&[&[z], &[z]]), None);
        let (lb, x) = (
            Part::Pad(GamepadButton::LeftTrigger),
            Part::Pad(GamepadButton::West),
        );
        assert_eq!(run(&[&[], &[lb], &[lb, x], &[lb]]).unwrap(), "Pad LB+X");
        assert_eq!(run(&[&[], &[x], &[]]).unwrap(), "Pad X");
    }
}
