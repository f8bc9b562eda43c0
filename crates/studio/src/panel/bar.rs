use bevy::prelude::World;
use bevy_egui::egui::{self, Ui};
use midair_document::Document;

use super::style::UNIT;
use super::{Dock, Files, Host, PanelInfo, Panels, icon, kit};
use crate::carry::in_hands;
use crate::command::{Command, Dialog, Dialogs, Errands};
use crate::hold::Held;
use crate::project::{Project, Recoverables, Then};
use crate::settings::Settings;
use crate::tools::Tools;

/// What the bar remembers between frames: what is being chosen and dragged.
#[derive(Default)]
pub struct Bar {
    files: Files,
    /// The file dialog that was shown last.
    seen: u64,
    /// The step while its slider is dragged; one command is sent when it is let go.
    step: Option<f32>,
}

/// Modes, files, undo, the step of the grid.
pub fn bar(ui: &mut Ui, state: &mut Bar, world: &World, panels: &Panels) -> Vec<Command> {
    let project = world.resource::<Project>();
    let tools = world.resource::<Tools>();
    let left_behind = world.resource::<Recoverables>();
    let errands = world.resource::<Errands>();
    let held = world.resource::<Held>();
    let mut asks = Vec::new();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 0.5 * UNIT;
        ui.spacing_mut().button_padding.x = UNIT;
        // As tall as the tallest, so that the first stands no higher than the others.
        ui.spacing_mut().interact_size.y = 4.0 * UNIT;
        let shown = buttons(tools, panels);
        let named_panels = fits(ui, tools, &shown);
        ui.menu_button("File", |ui| files(ui, world, &mut asks));
        let history = project.history();
        let named = |verb: &str, name: Option<&str>, keys: &str| match name {
            Some(name) => format!("{verb}: {name}   {keys}"),
            None => format!("{verb}   {keys}"),
        };
        let undo = named("Undo", history.undo_names().next(), "Ctrl+Z");
        let redo = named("Redo", history.redo_names().next(), "Ctrl+Shift+Z");
        let can = history.undo_len() > 0;
        let sign = icon::ARROW_COUNTER_CLOCKWISE;
        let button = egui::Button::new(egui::RichText::new(sign).size(18.0));
        let button = ui.add_enabled(can, button.frame_when_inactive(false));
        if button.on_hover_text(undo).clicked() {
            asks.push(Command::Undo);
        }
        let can = history.redo_len() > 0;
        let sign = icon::ARROW_CLOCKWISE;
        let button = egui::Button::new(egui::RichText::new(sign).size(18.0));
        let button = ui.add_enabled(can, button.frame_when_inactive(false));
        if button.on_hover_text(redo).clicked() {
            asks.push(Command::Redo);
        }
        ui.separator();
        for tool in tools.all() {
            let active = tools.active().is_some_and(|t| t.id == tool.id);
            let button = ui
                .selectable_label(active, tool.name)
                .on_hover_text(tool.about);
            let over = !held.is_empty() && button.contains_pointer();
            if over {
                button.show_tooltip_text(format!("Let go: carried into {}", tool.name));
            }
            let dropped = over && ui.input(|i| i.pointer.any_released());
            if dropped {
                asks.push(Command::Carry {
                    objects: in_hands(held),
                    to: tool.id.clone(),
                });
            } else if button.clicked() {
                asks.push(Command::Mode(tool.id.clone()));
            }
        }
        ui.separator();
        for info in shown {
            let open = panels.is_open(info.id);
            let text = if named_panels && has_word(tools, info) {
                format!("{} {}", info.icon, info.title)
            } else {
                info.icon.to_owned()
            };
            let button = ui.selectable_label(open, text).on_hover_text(info.title);
            button.widget_info(|| {
                egui::WidgetInfo::selected(egui::WidgetType::Button, true, open, info.title)
            });
            if button.clicked() {
                asks.push(Command::Panel {
                    id: info.id.to_owned(),
                    open: !open,
                });
            }
        }
        ui.separator();
        step(ui, state, project, &mut asks);
        title(ui, project);
    });
    if !left_behind.0.is_empty() {
        ui.horizontal(|ui| {
            let (number, verb) = match left_behind.0.len() {
                1 => (String::new(), "was"),
                n => (format!(" ({n} documents)"), "were"),
            };
            let text = format!("Work from an earlier run{number} {verb} not saved.");
            ui.label(egui::RichText::new(text).strong());
            if kit::primary(ui, "Restore it").clicked() {
                asks.push(Command::Leave(Then::Restore));
            }
            if ui
                .button("Throw it away")
                .on_hover_text("For good: it will not be offered again")
                .clicked()
            {
                asks.push(Command::Dismiss);
            }
        });
    }
    for row in errands.rows() {
        ui.horizontal(|ui| {
            match row.fraction {
                Some(fraction) => {
                    ui.add(
                        egui::ProgressBar::new(fraction)
                            .text(row.what)
                            .desired_width(320.0),
                    );
                }
                None => {
                    ui.spinner();
                    ui.label(row.what);
                }
            }
            if ui.button("Cancel").clicked() {
                asks.push(Command::CancelErrand(row.id));
            }
        });
    }
    if let Some((number, dialog)) = world.resource::<Dialogs>().after(state.seen) {
        state.seen = number;
        // In a room its own host asks.
        if *world.resource::<Host>() == Host::Screen {
            state.files.ask(dialog, project);
        }
    }
    asks.extend(state.files.show(ui.ctx()));
    asks
}

/// The panels that have a button now: those of other modes have none.
fn buttons<'a>(tools: &Tools, panels: &'a Panels) -> Vec<&'a PanelInfo> {
    let of_mode = |id: &str| tools.all().iter().any(|t| t.id.as_str() == id);
    let active = tools.active().map(|t| t.id.as_str());
    let mut shown: Vec<_> = panels.all().iter().filter(|i| i.in_bar).collect();
    shown.retain(|i| !of_mode(i.id) || active == Some(i.id));
    // That of the mode stands beside the modes.
    shown.sort_by_key(|i| !of_mode(i.id));
    shown
}

/// What is looked at now and then is an icon, and so is the panel of the mode, which is named beside it.
fn has_word(tools: &Tools, info: &PanelInfo) -> bool {
    matches!(info.dock, Dock::Left | Dock::Right)
        && tools.all().iter().all(|t| t.id.as_str() != info.id)
}

/// Whether the bar stays on one line with the names of panels on their buttons.
fn fits(ui: &Ui, tools: &Tools, shown: &[&PanelInfo]) -> bool {
    let spacing = ui.spacing();
    let gap = spacing.item_spacing.x;
    let button = |text: &str| {
        kit::width(ui, text, egui::TextStyle::Button) + 2.0 * spacing.button_padding.x + gap
    };
    let mut wide = button("File") + 2.0 * (18.0 + 2.0 * spacing.button_padding.x + gap);
    wide += tools.all().iter().map(|t| button(t.name)).sum::<f32>();
    wide += shown
        .iter()
        .map(|i| {
            if has_word(tools, i) {
                button(&format!("{} {}", i.icon, i.title))
            } else {
                button(i.icon)
            }
        })
        .sum::<f32>();
    // The step with its word, and three lines between the parts.
    wide += kit::width(ui, "Step", egui::TextStyle::Body) + button("20.0 mm") + gap;
    wide += 3.0 * (6.0 + gap);
    wide <= ui.max_rect().width()
}

/// What one works on, where the line has room for it: the window says it as well.
fn title(ui: &mut Ui, project: &Project) {
    let unsaved = if project.history().is_unsaved() {
        " •"
    } else {
        ""
    };
    let text = format!("{}{unsaved}", project.title());
    let room = ui.max_rect().right() - ui.cursor().left() - 24.0;
    if room < 64.0 {
        return;
    }
    ui.separator();
    ui.scope(|ui| {
        ui.set_max_width(room);
        ui.add(egui::Label::new(text).truncate());
    });
}

fn files(ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
    let recent = &world.resource::<Settings>().files.recent;
    ui.set_min_width(240.0);
    item(
        asks,
        ui,
        icon::FILE,
        "New",
        "Ctrl+N",
        Command::Leave(Then::New),
    );
    item(
        asks,
        ui,
        icon::FOLDER_OPEN,
        "Open…",
        "Ctrl+O",
        Command::Dialog(Dialog::Open),
    );
    ui.menu_button(
        format!("{}  Open recent", icon::CLOCK_COUNTER_CLOCKWISE),
        |ui| {
            if recent.is_empty() {
                ui.weak("Nothing was opened or saved yet");
            }
            for path in recent {
                let name = path
                    .file_name()
                    .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
                let open = ui
                    .add_enabled(path.exists(), egui::Button::new(name))
                    .on_hover_text(path.display().to_string())
                    .on_disabled_hover_text(format!("{} is not there any more", path.display()));
                if open.clicked() {
                    asks.push(Command::Leave(Then::Open(path.clone())));
                    ui.close();
                }
            }
        },
    );
    ui.separator();
    item(asks, ui, icon::FLOPPY_DISK, "Save", "Ctrl+S", Command::Save);
    item(
        asks,
        ui,
        icon::FLOPPY_DISK_BACK,
        "Save as…",
        "Ctrl+Shift+S",
        Command::Dialog(Dialog::SaveAs),
    );
    ui.separator();
    let export = Command::Panel {
        id: "export".into(),
        open: true,
    };
    item(asks, ui, icon::EXPORT, "Export a mesh…", "Ctrl+E", export);
    item(
        asks,
        ui,
        icon::DOWNLOAD_SIMPLE,
        "Import meshes…",
        "Ctrl+I",
        Command::Dialog(Dialog::Import),
    );
    item(
        asks,
        ui,
        icon::IMAGE,
        "Reference images…",
        "Ctrl+Shift+I",
        Command::Dialog(Dialog::Reference),
    );
    ui.separator();
    let worn = *world.resource::<Host>() == Host::Room;
    let text = if worn {
        "Leave the headset"
    } else {
        "Enter the headset"
    };
    item(asks, ui, icon::GOGGLES, text, "", Command::Headset(!worn));
    item(
        asks,
        ui,
        icon::SIGN_OUT,
        "Quit",
        "",
        Command::Leave(Then::Quit),
    );
}

/// A row of the menu, with the keys that do the same.
fn item(asks: &mut Vec<Command>, ui: &mut Ui, sign: &str, text: &str, keys: &str, ask: Command) {
    let button = egui::Button::new(format!("{sign}  {text}")).shortcut_text(keys);
    if ui.add(button).clicked() {
        asks.push(ask);
        ui.close();
    }
}

fn step(ui: &mut Ui, state: &mut Bar, project: &Project, asks: &mut Vec<Command>) {
    let (least, most) = Document::STEPS;
    let mut millimetres = state.step.unwrap_or(project.document().step()) * 1e3;
    ui.label("Step");
    let slider = ui
        .add(
            egui::DragValue::new(&mut millimetres)
                .range(least * 1e3..=most * 1e3)
                .suffix(" mm")
                .fixed_decimals(1)
                .speed(0.1),
        )
        .on_hover_text(
            "How fine solids are made: smaller is finer and slower. Drag, or click and type",
        );
    if slider.changed() {
        state.step = Some(millimetres * 1e-3);
    }
    if !slider.dragged()
        && let Some(step) = state.step.take()
        && step != project.document().step()
    {
        asks.push(Command::Step(step));
    }
}
