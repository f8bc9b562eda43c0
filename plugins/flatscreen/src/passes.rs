//! What panels see of the mouse in one pass. They look for what lies under the pointer once, where it is
//! at the end: where it went on after a click, in a frame that takes long, that waits for the next pass.

use bevy::prelude::*;
use bevy_egui::{EguiInput, PrimaryEguiContext, egui::Event};

pub(crate) fn divide(
    mut waiting: Local<Vec<Event>>,
    mut input: Single<&mut EguiInput, With<PrimaryEguiContext>>,
) {
    let said: Vec<_> = waiting.drain(..).chain(input.events.drain(..)).collect();
    let (now, later) = up_to_a_click(said);
    input.events = now;
    *waiting = later;
}

/// What belongs to this pass, and what of the pointer waits. Keys and letters wait for nothing.
fn up_to_a_click(said: Vec<Event>) -> (Vec<Event>, Vec<Event>) {
    let (mut clicked, mut over) = (false, false);
    said.into_iter().partition(|event| match event {
        Event::PointerMoved(_) | Event::PointerGone => {
            over |= clicked;
            !over
        }
        Event::PointerButton { .. } => {
            clicked = true;
            !over
        }
        _ => true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui::{Modifiers, PointerButton, Pos2};

    #[test]
    fn a_click_is_the_last_of_its_pass_where_the_pointer_went_on() {
        let to = |x| Event::PointerMoved(Pos2::new(x, 0.0));
        let click = |pressed| Event::PointerButton {
            pos: Pos2::ZERO,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let letter = Event::Text("a".into());
        let said = vec![
            to(1.0),
            click(true),
            to(2.0),
            letter.clone(),
            click(false),
            to(3.0),
        ];
        let (now, later) = up_to_a_click(said);
        assert_eq!(now, [to(1.0), click(true), letter]);
        let (now, later) = up_to_a_click(later);
        assert_eq!(now, [to(2.0), click(false)]);
        assert_eq!(up_to_a_click(later), (vec![to(3.0)], vec![]));
        // A whole click in one place is one pass.
        assert_eq!(up_to_a_click(vec![click(true), click(false)]).1, []);
    }
}
