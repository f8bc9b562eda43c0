//! Shortcuts: what keys and buttons ask of the studio as a whole.

use bevy::prelude::*;
use midair_studio::{
    command::{Command, Dialog},
    hands::Action,
    hold::Held,
    objects::Ask,
    panel::{Dock, Panels},
    project::{Project, Selection, Then},
    ruler::Ruler,
    settings::Settings,
    tools::{HintKey, Hints, Tools},
};

use crate::bindings::{Bindings, Control, Controls, Device};
use crate::pointer::Pointer;

/// What the device that was used last calls an action; empty where it has nothing for it.
pub fn key_name(action: Action, bindings: &Bindings, device: Device) -> String {
    let own = control(action).map_or(String::new(), |c| bindings.label(c, device));
    match (action, device) {
        // The pointer grabs with the button that it acts with.
        (Action::Grab, Device::Keys) if own == "click" => "drag".to_owned(),
        (Action::Modes, _) if own.is_empty() => hold(bindings, Control::Menu, device),
        (Action::Library, _) if own.is_empty() => bindings.label(Control::Menu, device),
        (Action::Delete, _) if own.is_empty() => {
            match bindings.label(Control::Centre, device).as_str() {
                "" => String::new(),
                centre => format!("{centre} {centre}"),
            }
        }
        _ => own,
    }
}

fn hold(bindings: &Bindings, control: Control, device: Device) -> String {
    match bindings.label(control, device).as_str() {
        "" => String::new(),
        label => format!("hold {label}"),
    }
}

/// The control that stands for an action of the hands.
fn control(action: Action) -> Option<Control> {
    Some(match action {
        Action::Act => Control::Act,
        Action::Grab => Control::Grab,
        Action::Finish => Control::Finish,
        Action::Cancel => Control::Cancel,
        Action::Undo => Control::Undo,
        Action::Redo => Control::Redo,
        Action::Library => Control::Library,
        Action::Modes => Control::Modes,
        Action::Save => Control::SaveObject,
        Action::Delete => Control::Delete,
        Action::Up => Control::CrossUp,
        Action::Right => Control::CrossRight,
        Action::Down => Control::CrossDown,
        Action::Left => Control::CrossLeft,
        Action::Free => Control::SnapOff,
        Action::Centre | Action::Menu => return None,
    })
}

/// Controls that show or hide a panel, by its id.
const PANELS: [(Control, &str); 6] = [
    (Control::Export, "export"),
    (Control::Outline, "outline"),
    (Control::Snaps, "snaps"),
    (Control::Settings, "settings"),
    (Control::Controls, "controls"),
    (Control::Help, "help"),
];

pub(crate) fn commands(
    (controls, settings): (Res<Controls>, Res<Settings>),
    (tools, panels, hints): (Res<Tools>, Res<Panels>, Res<Hints>),
    (pointer, ruler): (Res<Pointer>, Res<Ruler>),
    (project, selection): (Res<Project>, Res<Selection>),
    held: Res<Held>,
    mut commands: MessageWriter<Command>,
) {
    for (control, command) in [
        (Control::Undo, Command::Undo),
        (Control::Redo, Command::Redo),
    ] {
        if controls.fired(control) {
            commands.write(command);
        }
    }
    let brush = tools.active().is_some_and(|t| t.id.as_str() == "brush");
    if brush && controls.just_pressed(Control::Erase) {
        commands.write(Settings::command("brush.erase", !settings.brush.erase));
    }
    let wireframe = Settings::command("look.wireframe", !settings.look.wireframe);
    let orthographic = Settings::command("look.orthographic", !settings.look.orthographic);
    for (control, command) in [
        (Control::Save, Command::Save),
        (Control::Wireframe, wireframe),
        (Control::Orthographic, orthographic),
        (Control::New, Command::Leave(Then::New)),
        (Control::Open, Command::Dialog(Dialog::Open)),
        (Control::SaveAs, Command::Dialog(Dialog::SaveAs)),
        (Control::Import, Command::Dialog(Dialog::Import)),
        (Control::Reference, Command::Dialog(Dialog::Reference)),
    ] {
        if controls.just_pressed(control) {
            commands.write(command);
        }
    }
    for (control, mark) in [
        (Control::MarkUnion, "mark union"),
        (Control::MarkIntersect, "mark intersect"),
        (Control::MarkSubtract, "mark subtract"),
        (Control::Unmark, "mark cancel"),
    ] {
        if controls.just_pressed(control)
            && let Some(tool) = tools.active()
        {
            commands.write(Command::Tool {
                tool: tool.id.clone(),
                ask: mark.to_owned(),
            });
        }
    }
    for (control, ask) in [
        (Control::SelectAll, Ask::SelectAll),
        (Control::Duplicate, Ask::Duplicate),
        (Control::Eyedropper, Ask::Dropper { on: true }),
        (Control::Group, Ask::Group),
        (Control::Ungroup, Ask::Ungroup),
        (Control::ShowAll, Ask::ShowAll),
    ] {
        if controls.just_pressed(control) {
            commands.write(Command::Objects(ask));
        }
    }
    if controls.just_pressed(Control::Hide) {
        let document = project.document();
        let shown = selection.0.iter().any(|&id| document.is_visible(id));
        commands.write(Command::Objects(Ask::Visible {
            ids: Vec::new(),
            visible: !shown,
        }));
    }
    let modes = [
        Control::Mode1,
        Control::Mode2,
        Control::Mode3,
        Control::Mode4,
    ];
    for (control, tool) in modes.into_iter().zip(tools.all()) {
        if controls.just_pressed(control) {
            commands.write(Command::Mode(tool.id.clone()));
        }
    }
    let carries = [
        Control::Carry1,
        Control::Carry2,
        Control::Carry3,
        Control::Carry4,
    ];
    for (control, tool) in carries.into_iter().zip(tools.all()) {
        if controls.just_pressed(control) {
            // As with other keys: what is pointed at, where nothing is held or selected.
            let nothing = held.is_empty() && selection.0.is_empty();
            commands.write(Command::Carry {
                objects: pointer.under().filter(|_| nothing).into_iter().collect(),
                to: tool.id.clone(),
            });
        }
    }
    for (control, id) in PANELS {
        if controls.just_pressed(control) && panels.all().iter().any(|p| p.id == id) {
            commands.write(Command::Panel {
                id: id.to_owned(),
                open: !panels.is_open(id),
            });
        }
    }
    // Where cancel means nothing else, it shuts what was opened last over the view.
    let meant = hints
        .buttons
        .iter()
        .any(|h| h.action == HintKey::Action(Action::Cancel));
    if controls.just_pressed(Control::Cancel)
        && !(meant || pointer.stretching || pointer.holds() || ruler.on)
        && let Some(window) = panels.open_in(Dock::Window).last()
    {
        commands.write(Command::Panel {
            id: window.id.to_owned(),
            open: false,
        });
    }
}
