//! Keys that a wand presses, typed into the board that asked for letters.

use midair_studio::panel::egui::{Event, Key as Named, Modifiers};
use midair_studio::panel::{Key, Keyboard};

/// What a pressed key types, with what was `copied` for the one that pastes; nothing where it only
/// changes the keyboard. Also whether one is done.
pub(super) fn typed(
    key: Key,
    keyboard: &mut Keyboard,
    copied: Option<String>,
) -> (Vec<Event>, bool) {
    match key {
        Key::Letter(letter) => (vec![Event::Text(letter.to_string())], false),
        Key::Space => (vec![Event::Text(" ".to_owned())], false),
        Key::Shift => {
            keyboard.capitals = !keyboard.capitals;
            (Vec::new(), false)
        }
        Key::Paste => {
            // Fields hold one line.
            let text = copied.and_then(|t| t.lines().next().map(str::to_owned));
            (text.into_iter().map(Event::Paste).collect(), false)
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
        let (events, done) = typed(Key::Letter('a'), &mut keyboard, None);
        assert_eq!(events, [Event::Text("a".to_owned())]);
        assert!(!done);
        assert!(typed(Key::Shift, &mut keyboard, None).0.is_empty());
        assert!(keyboard.capitals);
        assert!(typed(Key::Done, &mut keyboard, None).1);
        let copied = Some("cup\nsaucer".to_owned());
        let (events, _) = typed(Key::Paste, &mut keyboard, copied);
        assert_eq!(events, [Event::Paste("cup".to_owned())]);
    }
}
