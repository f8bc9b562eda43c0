//! Tells the studio what keys and buttons are called, by the device that was used last.

use bevy::prelude::*;
use midair_studio::{
    hands::Action,
    help::{KeyLine, Keys, Way},
    panel::Host,
};

use crate::bindings::{Bindings, Control, Controls, Device};
use crate::keys::key_name;

pub(crate) fn tell(
    bindings: Res<Bindings>,
    controls: Res<Controls>,
    host: Res<Host>,
    mut keys: ResMut<Keys>,
    mut told: Local<Option<Device>>,
) {
    // Who wears a headset sees no keyboard: its controllers are spoken of.
    if *host == Host::Room {
        *told = None;
        return;
    }
    let device = controls.device();
    if *told == Some(device) && !bindings.is_changed() {
        return;
    }
    *told = Some(device);
    let mut labels: std::collections::BTreeMap<_, _> = Control::ALL
        .iter()
        .map(|&c| (c.name(), bindings.label(c, device)))
        .collect();
    // What a device does by another control than its own.
    for (name, action) in [
        ("grab", Action::Grab),
        ("library", Action::Library),
        ("delete", Action::Delete),
    ] {
        labels.insert(name, key_name(action, &bindings, device));
    }
    let lines = Control::ALL.iter().map(|&control| KeyLine {
        name: control.name(),
        group: control.group().title(),
        does: control.words(),
        keys: bindings.on(control, device).map(|b| b.label()).collect(),
    });
    let next = Keys {
        way: match device {
            Device::Keys => Way::Mouse,
            Device::Pad => Way::Gamepad,
        },
        labels,
        lines: lines.collect(),
    };
    keys.set_if_neq(next);
}
