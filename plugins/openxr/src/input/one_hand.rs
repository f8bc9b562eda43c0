//! One controller alone: with its menu button held it does what the other hand would.
//!
//! Trigger: the other hand's (alt). Cross ←: undo, →: redo, ↑: save what is touched, ↓: delete it. A menu button that
//! was held for one of these is no press of the menu.

use midair_studio::hands::{Action, ActionSet, COUNTED, HOLD};

/// What the menu button of the only hand is doing.
#[derive(Clone, Debug, Default)]
pub(super) struct OneHand {
    held_for: Option<f32>,
    used: bool,
}

impl OneHand {
    /// What the hand and the other one do.
    pub fn advance(&mut self, down: ActionSet, dt: f32) -> (ActionSet, ActionSet) {
        let mut mine = down;
        let mut other = ActionSet::NONE;
        mine.set(Action::Menu, false);
        if !down.has(Action::Menu) {
            let tapped = self.held_for.take().is_some_and(|t| t < HOLD) && !self.used;
            self.used = false;
            // One frame down is a press; the next one lets go.
            mine.set(Action::Menu, tapped);
            return (mine, other);
        }
        let held = self.held_for.get_or_insert(0.0);
        *held += dt.min(COUNTED);
        for (own, becomes) in [
            (Action::Left, Action::Undo),
            (Action::Right, Action::Redo),
            (Action::Up, Action::Save),
            (Action::Down, Action::Delete),
        ] {
            if down.has(own) {
                mine.set(own, false);
                mine.set(becomes, true);
                self.used = true;
            }
        }
        if down.has(Action::Act) {
            mine.set(Action::Act, false);
            other.set(Action::Act, true);
            self.used = true;
        }
        if *held >= HOLD && !self.used {
            mine.set(Action::Menu, true);
        }
        (mine, other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f32 = 1.0 / 90.0;

    fn set(actions: &[Action]) -> ActionSet {
        actions.iter().copied().collect()
    }

    #[test]
    fn a_tap_is_said_when_it_is_over() {
        let mut hand = OneHand::default();
        for _ in 0..5 {
            assert_eq!(hand.advance(set(&[Action::Menu]), DT).0, ActionSet::NONE);
        }
        assert_eq!(hand.advance(ActionSet::NONE, DT).0, set(&[Action::Menu]));
        assert_eq!(hand.advance(ActionSet::NONE, DT).0, ActionSet::NONE);
    }

    #[test]
    fn a_hold_opens_the_ring_all_the_same() {
        let mut hand = OneHand::default();
        let mut last = ActionSet::NONE;
        for _ in 0..40 {
            last = hand.advance(set(&[Action::Menu]), DT).0;
        }
        assert_eq!(last, set(&[Action::Menu]));
    }

    #[test]
    fn held_it_is_the_other_hand() {
        let mut hand = OneHand::default();
        hand.advance(set(&[Action::Menu]), DT);
        let (mine, other) = hand.advance(set(&[Action::Menu, Action::Left]), DT);
        assert_eq!((mine, other), (set(&[Action::Undo]), ActionSet::NONE));
        let (mine, other) = hand.advance(set(&[Action::Menu, Action::Act]), DT);
        assert_eq!((mine, other), (ActionSet::NONE, set(&[Action::Act])));
        // It was used: neither a tap nor a hold.
        for _ in 0..60 {
            assert_eq!(hand.advance(set(&[Action::Menu]), DT).0, ActionSet::NONE);
        }
        assert_eq!(hand.advance(ActionSet::NONE, DT).0, ActionSet::NONE);
    }
}
