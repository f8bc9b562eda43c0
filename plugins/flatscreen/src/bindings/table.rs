//! Which keys and buttons each control has: the usual ones, and what a person has changed.

use std::collections::BTreeMap;

use bevy::prelude::*;
use midair_studio::bound::LineFault;

use super::{Binding, Control, Device, file};

/// The usual bindings, as everybody finds them.
const USUAL: &str = include_str!("../../../../assets/bindings/flatscreen.ron");

/// Which keys, buttons and sticks each control has.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Bindings {
    usual: BTreeMap<Control, Vec<Binding>>,
    /// What a person has changed, by control.
    own: BTreeMap<Control, Vec<Binding>>,
}

impl Default for Bindings {
    fn default() -> Self {
        Self {
            usual: file::read(USUAL).0,
            own: BTreeMap::new(),
        }
    }
}

impl Bindings {
    /// The usual ones, with those that a person's file has changed; and what of that file cannot
    /// be used.
    pub fn with_file(text: &str) -> (Self, Vec<LineFault>) {
        let (own, faults) = file::read(text);
        let bindings = Self {
            own,
            ..Self::default()
        };
        (bindings, faults)
    }

    /// What is changed, as a file.
    pub fn to_file(&self) -> String {
        file::write(&self.own)
    }

    /// What a control is bound to.
    pub fn of(&self, control: Control) -> &[Binding] {
        let found = self.own.get(&control).or(self.usual.get(&control));
        found.map_or(&[], Vec::as_slice)
    }

    /// What it is bound to on one device.
    pub fn on(&self, control: Control, device: Device) -> impl Iterator<Item = &Binding> {
        self.of(control)
            .iter()
            .filter(move |b| b.device() == device)
    }

    /// Whether a person has changed it.
    pub fn is_changed(&self, control: Control) -> bool {
        self.own.contains_key(&control)
    }

    /// Whether anything is changed.
    pub fn is_any_changed(&self) -> bool {
        !self.own.is_empty()
    }

    /// Binds a control on one device to something else, or to nothing.
    pub fn bind(&mut self, control: Control, device: Device, binding: Option<Binding>) {
        let mut bindings: Vec<_> = self
            .of(control)
            .iter()
            .filter(|b| b.device() != device)
            .cloned()
            .collect();
        // Keys are read before the gamepad's buttons.
        let at = if device == Device::Keys {
            0
        } else {
            bindings.len()
        };
        bindings.splice(at..at, binding);
        if self.usual.get(&control) == Some(&bindings) {
            self.own.remove(&control);
        } else {
            self.own.insert(control, bindings);
        }
    }

    /// Back to the usual keys.
    pub fn reset(&mut self, control: Control) {
        self.own.remove(&control);
    }

    /// Everything back to the usual keys.
    pub fn reset_all(&mut self) {
        self.own.clear();
    }

    /// The other controls that are heard at the same time and have a binding of `control` too.
    pub fn conflicts(&self, control: Control) -> Vec<(Control, &Binding)> {
        let mut found = Vec::new();
        for &other in Control::ALL {
            let apart = !control.context().meets(other.context());
            if other == control || apart || control.shares_with(other) {
                continue;
            }
            let shared = self.of(control).iter().find(|b| self.of(other).contains(b));
            found.extend(shared.map(|b| (other, b)));
        }
        found
    }

    /// What a hint calls a control on a device; empty where it has nothing there.
    pub fn label(&self, control: Control, device: Device) -> String {
        self.on(control, device)
            .next()
            .map_or(String::new(), Binding::label)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_bindings_are_whole_and_do_not_conflict() {
        let (usual, faults) = file::read(USUAL);
        assert_eq!(faults, []);
        let bindings = Bindings::default();
        for &control in Control::ALL {
            assert!(
                usual.contains_key(&control),
                "{} is not bound",
                control.name()
            );
            assert_eq!(bindings.conflicts(control), [], "{}", control.name());
        }
    }

    #[test]
    fn a_rebound_control_is_kept_and_can_be_reset() {
        let mut bindings = Bindings::default();
        let key = Binding::parse("Ctrl+U").unwrap();
        bindings.bind(Control::Undo, Device::Keys, Some(key.clone()));
        assert_eq!(bindings.of(Control::Undo)[0], key);
        // The gamepad's button stays.
        assert_eq!(bindings.label(Control::Undo, Device::Pad), "X");
        let (again, faults) = Bindings::with_file(&bindings.to_file());
        assert_eq!((again, faults), (bindings.clone(), vec![]));
        bindings.reset(Control::Undo);
        assert_eq!(bindings, Bindings::default());
    }

    #[test]
    fn a_conflict_is_found_from_both_sides_and_only_where_both_are_heard() {
        let mut bindings = Bindings::default();
        let key = Binding::parse("F").ok();
        bindings.bind(Control::Hide, Device::Keys, key);
        let found = bindings.conflicts(Control::Hide);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0, Control::FrameSelection);
        assert_eq!(
            bindings.conflicts(Control::FrameSelection)[0].0,
            Control::Hide
        );
        // Z is an axis while one scales.
        bindings.bind(Control::Hide, Device::Keys, Binding::parse("Z").ok());
        assert_eq!(bindings.conflicts(Control::Hide), []);
    }
}
