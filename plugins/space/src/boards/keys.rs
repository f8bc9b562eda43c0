//! Keys that a wand presses, typed into the board that asked for letters.

use midair_studio::panel::egui::{Event, Key as Named, Modifiers};
use midair_studio::panel::{Key, Keyboard};

/// What a pressed key types; `None` where it only changes the keyboard. Also whether one is done.
pub(super) fn typed(key: Key, keyboard: &mut Keyboard) -> (Vec<Event>, bool) {
    match key {
        Key::Letter(letter) => (vec![Event::Text(letter.to_string())], false),
        Key::Space => (vec![Event::Text(" ".to_owned())], false),
        Key::Shift => {
            keyboard.capitals = !keyboard.capitals;
            (Vec::new(), false)
        }
        Key::Erase => (tap(Named::Backspace).into(), false),
        Key::Done => (tap(Named::Enter).into(), true),
    }
}

fn tap(key: Named) -> [Event; 2] {
    [true, false].map(|pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_type_letters_and_shift_changes_them() {
        let mut keyboard = Keyboard::default();
        let (events, done) = typed(Key::Letter('a'), &mut keyboard);
        assert_eq!(events, [Event::Text("a".to_owned())]);
        assert!(!done);
        assert!(typed(Key::Shift, &mut keyboard).0.is_empty());
        assert!(keyboard.capitals);
        assert!(typed(Key::Done, &mut keyboard).1);
    }
}
