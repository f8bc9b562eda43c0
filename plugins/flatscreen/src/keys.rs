//! Shortcuts that people know.

use bevy::prelude::*;
use midair_studio::{command::Command, hands::Action, tools::Tools};

use crate::panels::Screen;
use crate::pointer::Pointer;

/// What the keyboard calls an action; empty where there is no key.
pub fn key_name(action: Action) -> &'static str {
    match action {
        Action::Act => "click",
        Action::Grab => "drag",
        Action::Finish => "Enter",
        Action::Cancel => "Esc",
        Action::Undo => "Ctrl+Z",
        Action::Redo => "Ctrl+Shift+Z",
        Action::Library => "L",
        Action::Save => "E",
        Action::Delete => "Del",
        Action::Up => "↑",
        Action::Right => "→",
        Action::Down => "↓",
        Action::Left => "←",
        Action::Modes => "1–4",
        Action::Centre | Action::Menu => "",
    }
}

pub(crate) fn commands(
    keys: Res<ButtonInput<KeyCode>>,
    screen: Res<Screen>,
    pointer: Res<Pointer>,
    tools: Res<Tools>,
    mut commands: MessageWriter<Command>,
) {
    if screen.is_typing() {
        return;
    }
    let shift = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let ctrl = keys.any_pressed([
        KeyCode::ControlLeft,
        KeyCode::ControlRight,
        KeyCode::SuperLeft,
        KeyCode::SuperRight,
    ]);
    if ctrl {
        if keys.just_pressed(KeyCode::KeyZ) {
            commands.write(if shift { Command::Redo } else { Command::Undo });
        }
        if keys.just_pressed(KeyCode::KeyY) {
            commands.write(Command::Redo);
        }
        if keys.just_pressed(KeyCode::KeyS) {
            commands.write(Command::Save);
        }
        return;
    }
    // Its keys mean axes then.
    if pointer.stretching {
        return;
    }
    for (key, mark) in [
        (KeyCode::KeyU, "mark union"),
        (KeyCode::KeyI, "mark intersect"),
        (KeyCode::KeyM, "mark subtract"),
        (KeyCode::KeyN, "mark cancel"),
    ] {
        if keys.just_pressed(key)
            && let Some(tool) = tools.active()
        {
            commands.write(Command::Tool {
                tool: tool.id.clone(),
                ask: mark.to_owned(),
            });
        }
    }
    let digits = [
        KeyCode::Digit1,
        KeyCode::Digit2,
        KeyCode::Digit3,
        KeyCode::Digit4,
    ];
    for (key, tool) in digits.into_iter().zip(tools.all()) {
        if keys.just_pressed(key) {
            commands.write(Command::Mode(tool.id.clone()));
        }
    }
}
