//! The bottom line: what each key or button does now, by the device that was used last.

use bevy::prelude::*;
use midair_studio::{
    hands::{Action, Side},
    project::Project,
    tools::{HintKey, Hints},
};

use crate::bindings::{Bindings, Control, Device};
use crate::gamepad::Pad;
use crate::pointer::Pointer;

/// The tool's hints, with what only this way in has.
pub(crate) fn with_keys(
    world: &World,
    in_panels: bool,
    bindings: &Bindings,
    device: Device,
) -> (Hints, Vec<(String, String)>) {
    let mut hints = world.resource::<Hints>().clone();
    let (pointer, pad) = (world.resource::<Pointer>(), world.resource::<Pad>());
    let named = |control| bindings.label(control, device);
    let joined = |controls: &[Control]| {
        let names: Vec<_> = controls.iter().map(|&c| named(c)).collect();
        names.join(" ")
    };
    let beside = |first, second| format!("{}+{}", named(first), named(second));
    let more: Vec<(String, &str)> = if in_panels {
        hints.begin("In the panels");
        vec![
            (panel_arrows(device).to_owned(), "move"),
            (panel_press(bindings, device), "press"),
            (named(Control::PanelNext), "next panel"),
            (named(Control::PanelLeave), "back to the view"),
        ]
    } else if pad.leads() && pad.holds() {
        vec![
            (named(Control::HandStick), "move"),
            (beside(Control::Deep, Control::HandStick), "depth, roll"),
            (beside(Control::Deep, Control::ViewStick), "turn"),
            (named(Control::SwapHands), "other hand"),
        ]
    } else if pad.leads() {
        vec![
            (named(Control::HandStick), "move"),
            (named(Control::ViewStick), "orbit"),
            (beside(Control::Deep, Control::HandStick), "depth"),
            (beside(Control::Roam, Control::HandStick), "pan"),
            (format!("hold {}", named(Control::SwapHands)), "show all"),
            (named(Control::PanelNext), "panels"),
        ]
    } else if pointer.stretching {
        hints.buttons.clear();
        vec![
            ("move".to_owned(), "larger or smaller"),
            (
                joined(&[
                    Control::AxisX,
                    Control::AxisY,
                    Control::AxisZ,
                    Control::AxisAll,
                ]),
                "along which axis, all",
            ),
            (named(Control::Act), "done"),
            (named(Control::Cancel), "put it back"),
        ]
    } else if pointer.holds() {
        // The other hand is a key away.
        hints
            .buttons
            .retain(|h| h.action != HintKey::Action(Action::Grab));
        vec![
            ("wheel".to_owned(), "nearer, farther"),
            (named(Control::Turn), "turn"),
            (named(Control::SwapHands), "other hand"),
        ]
    } else if pointer.is_over() {
        // The keys do at once what the cross does in two steps.
        hints
            .buttons
            .retain(|h| h.action != HintKey::Action(Action::Up) || h.does != "mark operands");
        vec![
            (
                joined(&[
                    Control::MarkUnion,
                    Control::MarkIntersect,
                    Control::MarkSubtract,
                ]),
                "mark ∪ ∩ −",
            ),
            (named(Control::Unmark), "unmark"),
            (named(Control::Stretch), "stretch"),
        ]
    } else {
        vec![
            (named(Control::Orbit), "orbit"),
            (named(Control::Pan), "pan"),
            ("wheel".to_owned(), "zoom"),
            (named(Control::FrameSelection), "show all"),
        ]
    };
    let more = more.into_iter().map(|(key, does)| (key, does.to_owned()));
    let mut more: Vec<_> = more.collect();
    let other = pointer.leading.other();
    let left_holding = pointer.is_latched(other) && !pointer.holds();
    if left_holding && !in_panels && !pad.leads() {
        // No button is down that could be let go.
        let hand = match other {
            Side::Left => "left",
            Side::Right => "right",
        };
        hints.status = format!("The {hand} hand holds it");
        more.insert(0, (named(Control::SwapHands), "let go of it".to_owned()));
    }
    // What ends what one is at comes first; then what the thing under the pointer is marked by.
    let empty = world.resource::<Project>().document().is_empty();
    hints.buttons.sort_by_key(|h| match h.action {
        HintKey::Action(Action::Finish) => 0,
        HintKey::Action(Action::Library) if empty => 1,
        _ => 2,
    });
    if empty {
        // There is nothing to mark yet.
        hints.buttons.retain(|h| h.does != "mark operands");
    }
    let help = named(Control::Help);
    if !in_panels && !help.is_empty() {
        more.push((help, "all keys".to_owned()));
    }
    (hints, more)
}

/// What moves the focus.
fn panel_arrows(device: Device) -> &'static str {
    match device {
        Device::Keys => "Tab ↑ ↓ ← →",
        Device::Pad => "D-pad",
    }
}

/// What presses what has the focus.
fn panel_press(bindings: &Bindings, device: Device) -> String {
    match device {
        Device::Keys => "Enter".to_owned(),
        Device::Pad => bindings.label(Control::PanelPress, device),
    }
}
