//! Whose the hands are: the gamepad's once it is used, the pointer's again once that is, and never while
//! something is held.

use bevy::prelude::*;
use midair_studio::{hands::Side, notice::Notices, settings::Settings};

use super::Pad;
use crate::bindings::{Controls, Device};
use crate::focus::Focus;
use crate::pointer::Pointer;

/// The hand that leads unless it was swapped.
pub(crate) struct Usual(Side);

impl Default for Usual {
    fn default() -> Self {
        Self(Side::Right)
    }
}

pub(crate) fn lead(
    controls: Res<Controls>,
    settings: Res<Settings>,
    mut pointer: ResMut<Pointer>,
    mut focus: ResMut<Focus>,
    mut pad: ResMut<Pad>,
    mut notices: ResMut<Notices>,
    mut usual: Local<Usual>,
) {
    let connected = controls.pad().is_some();
    if std::mem::replace(&mut pad.connected, connected) && !connected {
        let held = if pad.holds() {
            " What it held was put down where it was."
        } else {
            ""
        };
        notices.warn(format!(
            "The gamepad is not connected any more.{held} Plug it in again, or go on with mouse and keyboard."
        ));
        // Its buttons are up; what another hand held on to is let go with them.
        pad.latched = [false; 2];
        focus.leave();
    }
    let main = settings.hands.main();
    if main != usual.0 && !pad.holds() && !pointer.holds() {
        usual.0 = main;
        pad.leading = main;
        pointer.leading = main;
    }
    match controls.device() {
        Device::Pad if !pad.leads && !pointer.holds() => {
            pad.leads = true;
            pad.leading = pointer.leading;
            pad.poses = Side::BOTH.map(|s| pointer.pose(s));
            // What hangs on the other hand goes on hanging there.
            pad.latched = Side::BOTH.map(|s| pointer.is_latched(s));
            pad.held = pad.latched;
            pad.turn = Quat::IDENTITY;
        }
        Device::Keys if pad.leads && !pad.holds() => {
            pad.leads = false;
            pointer.leading = pad.leading;
            pointer.let_go();
        }
        _ => {}
    }
}
