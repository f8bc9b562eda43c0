//! What is pressed: analogue things with hysteresis, arms of sticks and pads.

use bevy::math::Vec2;
use midair_studio::hands::{Action, ActionSet};

use super::bindings::{Arm, Arms, Source};

/// A trigger is pulled from here on, and let go from the other one on.
const PULLED: (f32, f32) = (0.55, 0.4);
/// The same for a grip: hands that hold things loosely do not drop them.
const SQUEEZED: (f32, f32) = (0.6, 0.35);
/// A stick is flicked from here on, and back from the other one on.
const FLICKED: (f32, f32) = (0.7, 0.4);
/// Nearer to the middle of a pad than this it is the middle that is pressed.
const MIDDLE: f32 = 0.4;
/// A stick that rests is no farther from its middle.
const RESTS: f32 = 0.15;

/// What one controller says in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Raw {
    pub act: f32,
    pub grab: f32,
    pub stick: Vec2,
    pub pad: Vec2,
    /// `None` for a pad that does not feel touches.
    pub pad_touch: Option<bool>,
    pub pad_click: bool,
    /// Buttons that are actions by themselves.
    pub buttons: ActionSet,
}

/// What one controller's buttons did so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Keys {
    act: bool,
    grab: bool,
    flick: Option<Arm>,
    press: Option<Arm>,
}

impl Keys {
    /// The actions that are down, and the swipe.
    pub fn advance(
        &mut self,
        raw: &Raw,
        arms: &Arms,
        swipe: Option<Source>,
    ) -> (ActionSet, Option<Vec2>) {
        self.act = past(self.act, raw.act, PULLED);
        self.grab = past(self.grab, raw.grab, SQUEEZED);
        let stick = sound(raw.stick);
        let far = stick.length();
        self.flick = match self.flick {
            // The arm that was flicked first stays until the stick is back.
            Some(arm) if far > FLICKED.1 => Some(arm),
            _ if far >= FLICKED.0 => Some(arm_of(stick)),
            _ => None,
        };
        let pad = sound(raw.pad);
        self.press = match (raw.pad_click, self.press) {
            (true, Some(arm)) => Some(arm),
            (true, None) if pad.length() < MIDDLE => Some(Arm::Middle),
            (true, None) => Some(arm_of(pad)),
            (false, _) => None,
        };
        let mut down = raw.buttons;
        down.set(Action::Act, self.act);
        down.set(Action::Grab, self.grab);
        let pressed = [(Source::Stick, self.flick), (Source::Pad, self.press)];
        for (source, arm) in pressed {
            for action in arm.into_iter().flat_map(|arm| arms.of(source, arm)) {
                down.set(action, true);
            }
        }
        let swipe = match swipe {
            Some(Source::Pad) => {
                let touched = raw.pad_touch.unwrap_or(pad.length() > RESTS);
                touched.then_some(pad)
            }
            Some(Source::Stick) => (far > RESTS).then_some(stick),
            None => None,
        };
        (down, swipe.map(|s| s.clamp(Vec2::NEG_ONE, Vec2::ONE)))
    }
}

fn past(was: bool, value: f32, (on, off): (f32, f32)) -> bool {
    if was { value > off } else { value >= on }
}

fn sound(v: Vec2) -> Vec2 {
    if v.is_finite() { v } else { Vec2::ZERO }
}

fn arm_of(v: Vec2) -> Arm {
    if v.x.abs() > v.y.abs() {
        if v.x > 0.0 { Arm::Right } else { Arm::Left }
    } else if v.y > 0.0 {
        Arm::Up
    } else {
        Arm::Down
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::bindings::{Bindings, Profile};
    use midair_studio::hands::Side;

    fn arms(profile: &str, side: Side) -> (Arms, Option<Source>) {
        let bindings = Bindings::default();
        let profile = Profile::named(profile).unwrap();
        let arms = bindings.arms(profile, side, Side::Right);
        (arms, bindings.swipe(profile, side, Side::Right))
    }

    #[test]
    fn a_trigger_that_trembles_is_pulled_once() {
        let mut keys = Keys::default();
        let mut presses = 0;
        let mut was = false;
        for value in [
            0.0, 0.3, 0.5, 0.56, 0.52, 0.57, 0.45, 0.58, 0.41, 0.39, 0.5, 0.0,
        ] {
            let raw = Raw {
                act: value,
                ..Raw::default()
            };
            let down = keys
                .advance(&raw, &Arms::default(), None)
                .0
                .has(Action::Act);
            presses += i32::from(down && !was);
            was = down;
        }
        assert_eq!(presses, 1);
        assert!(!was);
    }

    #[test]
    fn a_flick_is_one_arm_until_the_stick_is_back() {
        let (arms, swipe) = arms("valve/index_controller", Side::Right);
        let mut keys = Keys::default();
        let mut at = |x: f32, y: f32| {
            let raw = Raw {
                stick: Vec2::new(x, y),
                ..Raw::default()
            };
            let (down, _) = keys.advance(&raw, &arms, swipe);
            down.iter().collect::<Vec<_>>()
        };
        assert_eq!(at(0.0, 0.5), []);
        assert_eq!(at(0.1, 0.9), [Action::Up]);
        // Rolled along the edge it is still that arm.
        assert_eq!(at(0.9, 0.3), [Action::Up]);
        assert_eq!(at(0.2, 0.2), []);
        assert_eq!(at(-0.8, 0.0), [Action::Left]);
        assert_eq!(at(f32::NAN, 1.0), []);
    }

    #[test]
    fn a_vive_pad_has_arms_a_middle_and_a_swipe() {
        let (arms, swipe) = arms("htc/vive_controller", Side::Left);
        let mut keys = Keys::default();
        let mut at = |x: f32, y: f32, click: bool| {
            let raw = Raw {
                pad: Vec2::new(x, y),
                pad_touch: Some(true),
                pad_click: click,
                ..Raw::default()
            };
            let (down, swipe) = keys.advance(&raw, &arms, swipe);
            (down.iter().collect::<Vec<_>>(), swipe)
        };
        assert_eq!(at(0.1, 0.8, false), (vec![], Some(Vec2::new(0.1, 0.8))));
        assert_eq!(at(0.1, 0.8, true).0, [Action::Up]);
        // The finger slides while it presses.
        assert_eq!(at(-0.8, 0.1, true).0, [Action::Up]);
        assert_eq!(at(-0.8, 0.1, false).0, []);
        // The off hand's ← is undo.
        assert_eq!(at(-0.8, 0.1, true).0, [Action::Undo]);
        at(0.0, 0.0, false);
        assert_eq!(at(0.1, -0.1, true).0, [Action::Centre]);
    }

    #[test]
    fn a_stick_that_rests_swipes_nothing() {
        let (arms, swipe) = arms("oculus/touch_controller", Side::Right);
        let mut keys = Keys::default();
        for (x, touched) in [(0.1, false), (0.3, true)] {
            let raw = Raw {
                stick: Vec2::new(x, 0.0),
                ..Raw::default()
            };
            let (_, swipe) = keys.advance(&raw, &arms, swipe);
            assert_eq!(swipe.is_some(), touched);
        }
    }
}
