use std::path::PathBuf;

use bevy::prelude::World;
use bevy_egui::egui::{self, Ui};
use midair_document::Document;

use super::Panels;
use crate::command::{Command, Errands};
use crate::project::{Project, Recoverables};
use crate::tools::Tools;

/// What the bar remembers between frames: the fields that are being typed into.
#[derive(Clone, Debug, Default)]
pub struct Bar {
    path: String,
    asking: Asking,
    /// The field has just appeared and takes the keyboard.
    fresh: bool,
    /// The step while its slider is dragged; one command is sent when it is let go.
    step: Option<f32>,
}

/// Which file is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Asking {
    /// None.
    #[default]
    Nothing,
    /// A document to open.
    Open,
    /// A name for the document.
    SaveAs,
    /// A mesh file to write.
    Export,
    /// A mesh file to bring in.
    Import,
}

impl Bar {
    /// Asks for a file, with a name filled in beforehand where there is one to offer.
    pub fn ask(&mut self, asking: Asking, project: &Project) {
        let ending = match asking {
            Asking::SaveAs => "midair",
            Asking::Export => "stl",
            Asking::Nothing | Asking::Open | Asking::Import => "",
        };
        self.asking = asking;
        self.fresh = true;
        self.path = if ending.is_empty() {
            String::new()
        } else {
            let name = format!("{}.{ending}", project.title());
            project.work_folder().join(name).display().to_string()
        };
    }
}

/// Modes, files, undo, the step of the grid.
pub fn bar(ui: &mut Ui, state: &mut Bar, world: &World, panels: &Panels) -> Vec<Command> {
    let project = world.resource::<Project>();
    let tools = world.resource::<Tools>();
    let left_behind = world.resource::<Recoverables>();
    let errands = world.resource::<Errands>();
    let mut asks = Vec::new();
    ui.horizontal_wrapped(|ui| {
        ui.menu_button("File", |ui| files(ui, state, project, &mut asks));
        let history = project.history();
        if ui
            .add_enabled(history.undo_len() > 0, egui::Button::new("⟲ Undo"))
            .on_hover_text("Ctrl+Z")
            .clicked()
        {
            asks.push(Command::Undo);
        }
        if ui
            .add_enabled(history.redo_len() > 0, egui::Button::new("⟳ Redo"))
            .on_hover_text("Ctrl+Shift+Z")
            .clicked()
        {
            asks.push(Command::Redo);
        }
        ui.separator();
        for tool in tools.all() {
            let active = tools.active().is_some_and(|t| t.id == tool.id);
            if ui
                .selectable_label(active, tool.name)
                .on_hover_text(tool.about)
                .clicked()
            {
                asks.push(Command::Mode(tool.id.clone()));
            }
        }
        ui.separator();
        for info in panels.all().iter().filter(|i| i.in_bar) {
            let open = panels.is_open(info.id);
            if ui
                .selectable_label(open, format!("{} {}", info.icon, info.title))
                .clicked()
            {
                asks.push(Command::Panel {
                    id: info.id.to_owned(),
                    open: !open,
                });
            }
        }
        ui.separator();
        step(ui, state, project, &mut asks);
        ui.separator();
        let unsaved = if history.is_unsaved() { " •" } else { "" };
        ui.label(format!("{}{unsaved}", project.title()));
    });
    if !left_behind.0.is_empty() {
        ui.horizontal(|ui| {
            let (number, verb) = match left_behind.0.len() {
                1 => (String::new(), "was"),
                n => (format!(" ({n} documents)"), "were"),
            };
            let text = format!("Work from an earlier run{number} {verb} not saved.");
            ui.label(egui::RichText::new(text).strong());
            let restore = egui::Button::new("Restore it").fill(super::ACCENT.gamma_multiply(0.65));
            if ui.add(restore).clicked() {
                asks.push(Command::Restore);
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
    for (what, fraction) in errands.progress() {
        ui.horizontal(|ui| {
            ui.add(
                egui::ProgressBar::new(fraction)
                    .text(what)
                    .desired_width(320.0),
            );
            if ui.button("Cancel").clicked() {
                asks.push(Command::CancelErrands);
            }
        });
    }
    ask_path(ui, state, &mut asks);
    asks
}

fn files(ui: &mut Ui, state: &mut Bar, project: &Project, asks: &mut Vec<Command>) {
    for (text, asking) in [
        ("Open…", Asking::Open),
        ("Save as…", Asking::SaveAs),
        ("Export a mesh…", Asking::Export),
        ("Import a mesh…", Asking::Import),
    ] {
        if ui.button(text).clicked() {
            state.ask(asking, project);
            ui.close();
        }
    }
    for (text, ask) in [("New", Command::New), ("Save   Ctrl+S", Command::Save)] {
        if ui.button(text).clicked() {
            asks.push(ask);
            ui.close();
        }
    }
}

fn ask_path(ui: &mut Ui, state: &mut Bar, asks: &mut Vec<Command>) {
    let (verb, hint) = match state.asking {
        Asking::Nothing => return,
        Asking::Open => ("Open", "a document: *.midair"),
        Asking::SaveAs => ("Save", "a document: *.midair"),
        Asking::Export => (
            "Export",
            "a mesh: .stl or .3mf for printing, .glb, .obj, .ply",
        ),
        Asking::Import => ("Import", "a mesh: .glb, .obj, .stl, .ply"),
    };
    let mut done = false;
    ui.horizontal(|ui| {
        ui.label(verb);
        let field = ui.add(
            egui::TextEdit::singleline(&mut state.path)
                .hint_text(hint)
                .desired_width(480.0),
        );
        if std::mem::take(&mut state.fresh) {
            field.request_focus();
        }
        done |= field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Escape));
        let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if (ui.button(verb).clicked() || entered) && !state.path.trim().is_empty() {
            let path = from_home(state.path.trim());
            asks.push(match state.asking {
                Asking::Open => Command::Open(path),
                Asking::SaveAs => Command::SaveAs(path),
                Asking::Import => Command::Import(vec![path]),
                _ => Command::Export {
                    path,
                    step: None,
                    unit: None,
                },
            });
            done = true;
        }
        done |= ui.button("Cancel").clicked();
    });
    if done {
        state.asking = Asking::Nothing;
    }
}

/// `~/` as shells read it.
fn from_home(path: &str) -> PathBuf {
    match (path.strip_prefix("~/"), std::env::var_os("HOME")) {
        (Some(rest), Some(home)) => PathBuf::from(home).join(rest),
        _ => PathBuf::from(path),
    }
}

fn step(ui: &mut Ui, state: &mut Bar, project: &Project, asks: &mut Vec<Command>) {
    let (least, most) = Document::STEPS;
    let mut millimetres = state.step.unwrap_or(project.document().step()) * 1e3;
    ui.label("Step");
    let slider = ui
        .add(
            egui::Slider::new(&mut millimetres, least * 1e3..=most * 1e3)
                .suffix(" mm")
                .fixed_decimals(1)
                .step_by(0.5),
        )
        .on_hover_text("How fine solids are made: smaller is finer and slower");
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
