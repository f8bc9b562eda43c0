//! Holds and double presses, told apart by time and never by frames.

use super::{Action, ActionSet};

/// Two presses within this many seconds are one double press.
pub const DOUBLE_PRESS: f32 = 0.4;
/// A button down this many seconds is held.
pub const HOLD: f32 = 0.35;
/// So much of a frame counts towards a hold: while the app itself stands still, a tap is not yet held.
pub const COUNTED: f32 = 1.0 / 30.0;

/// What one hand's physical buttons stand for.
#[derive(Clone, Debug, Default)]
pub(super) struct Presses {
    centre: Button,
    menu: Button,
}

impl Presses {
    /// The actions that the physical buttons in `down` make, `dt` seconds after the last call.
    pub fn recognise(&mut self, down: ActionSet, dt: f32) -> ActionSet {
        let mut actions = ActionSet::NONE;
        match self.centre.advance(down.has(Action::Centre), dt) {
            Press::Held => actions.set(Action::Finish, true),
            Press::Double => actions.set(Action::Delete, true),
            Press::None | Press::Tap => {}
        }
        match self.menu.advance(down.has(Action::Menu), dt) {
            Press::Held => actions.set(Action::Modes, true),
            Press::Tap => actions.set(Action::Library, true),
            Press::None | Press::Double => {}
        }
        actions
    }
}

#[derive(Clone, Debug, Default)]
struct Button {
    down: bool,
    /// Seconds since it went down.
    held_for: f32,
    /// Seconds since the press before this one began; infinite where there was none.
    since_press: Option<f32>,
}

#[derive(Debug, PartialEq)]
enum Press {
    None,
    /// Let go before it was held: true for the frame in which it went up.
    Tap,
    /// Pressed a second time soon enough: true for the frame in which it went down again.
    Double,
    /// Down longer than [`HOLD`]: true until it goes up.
    Held,
}

impl Button {
    fn advance(&mut self, down: bool, dt: f32) -> Press {
        let was_down = std::mem::replace(&mut self.down, down);
        self.since_press = self.since_press.map(|s| s + dt);
        if down && !was_down {
            self.held_for = 0.0;
            let double = self.since_press.is_some_and(|s| s <= DOUBLE_PRESS);
            // A third press begins a new pair.
            self.since_press = (!double).then_some(0.0);
            return if double { Press::Double } else { Press::None };
        }
        if down {
            self.held_for += dt.min(COUNTED);
            if self.held_for >= HOLD {
                return Press::Held;
            }
        } else if was_down && self.held_for < HOLD {
            return Press::Tap;
        }
        Press::None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(frames: &[(bool, f32)]) -> Vec<Press> {
        let mut button = Button::default();
        frames.iter().map(|&(d, t)| button.advance(d, t)).collect()
    }

    #[test]
    fn a_hold_is_told_by_time_at_any_frame_rate() {
        for dt in [1.0 / 30.0, 1.0 / 90.0, 1.0 / 240.0] {
            let mut button = Button::default();
            let mut t = 0.0;
            button.advance(true, dt);
            while button.advance(true, dt) == Press::None {
                t += dt;
            }
            assert!((t - HOLD).abs() <= 2.0 * dt, "{t} at {dt}");
        }
    }

    #[test]
    fn a_frame_that_hangs_makes_no_hold_of_a_tap() {
        let taps = run(&[(true, 0.01), (true, 0.8), (true, 0.3), (false, 0.3)]);
        assert_eq!(taps[3], Press::Tap);
    }

    #[test]
    fn two_taps_are_a_double_press_only_when_quick() {
        let quick = run(&[(true, 0.1), (false, 0.1), (true, 0.2)]);
        assert_eq!(quick.last(), Some(&Press::Double));
        let slow = run(&[(true, 0.1), (false, 0.1), (true, 0.5)]);
        assert_eq!(slow.last(), Some(&Press::None));
    }

    #[test]
    fn a_third_tap_starts_again() {
        let taps = run(&[
            (true, 0.1),
            (false, 0.05),
            (true, 0.05),
            (false, 0.05),
            (true, 0.05),
        ]);
        assert_eq!(taps[2], Press::Double);
        assert_eq!(taps[4], Press::None);
    }

    #[test]
    fn a_tap_ends_when_let_go() {
        assert_eq!(run(&[(true, 0.1), (false, 0.1)])[1], Press::Tap);
    }
}
