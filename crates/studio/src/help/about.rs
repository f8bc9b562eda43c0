//! Every key by what it is for, and where Midair keeps things.

use bevy::prelude::World;

use super::Keys;
use crate::command::Command;
use crate::panel::egui::{self, RichText, Ui};
use crate::panel::{Panel, icon, kit};
use crate::project::Places;

/// Points for the keys.
const KEYS: f32 = 150.0;

#[derive(Default)]
pub(super) struct Help {
    /// What is looked for.
    query: String,
}

impl Panel for Help {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let keys = world.resource::<Keys>();
        ui.set_min_width(ui.available_width().min(480.0));
        ui.horizontal_wrapped(|ui| {
            kit::search(ui, &mut self.query, "Find by name or key", 200.0);
            for (text, id) in [("Tutorial", "tutorial"), ("Change keys…", "controls")] {
                if ui.button(text).clicked() {
                    asks.push(Command::Panel {
                        id: id.to_owned(),
                        open: true,
                    });
                }
            }
        });
        ui.add_space(8.0);
        self.list(ui, keys);
        ui.add_space(8.0);
        egui::CollapsingHeader::new("About Midair").show(ui, |ui| about(ui, world));
    }
}

impl Help {
    fn list(&self, ui: &mut Ui, keys: &Keys) {
        let query = self.query.trim().to_lowercase();
        let found = |text: &str| text.to_lowercase().contains(&query);
        let mut group = "";
        for line in &keys.lines {
            let bound = line.keys.join(", ");
            if bound.is_empty() || !(found(line.does) || found(line.group) || found(&bound)) {
                continue;
            }
            if line.group != group {
                group = line.group;
                ui.add_space(4.0);
                ui.label(RichText::new(group).strong());
            }
            ui.horizontal_top(|ui| {
                column(ui, KEYS, RichText::new(bound).monospace());
                // What does not fit goes on below its own beginning, not below the keys.
                let rest = ui.available_width();
                column(ui, rest, RichText::new(line.does));
            });
        }
        if group.is_empty() {
            ui.label("No key is called that. Change keys… lists everything that can be bound.");
        }
    }
}

/// Text in a column of its own, so many points wide.
fn column(ui: &mut Ui, width: f32, text: RichText) {
    let down = egui::Layout::top_down(egui::Align::Min);
    ui.allocate_ui_with_layout(egui::vec2(width, 0.0), down, |ui| {
        ui.set_width(width);
        ui.add(egui::Label::new(text).wrap());
    });
}

/// What one is asked for when something does not work.
fn about(ui: &mut Ui, world: &World) {
    let places = world.resource::<Places>();
    let lines = [
        ("Version", env!("CARGO_PKG_VERSION").to_owned()),
        (
            "System",
            format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        ),
        ("Settings", places.settings().display().to_string()),
        (
            "Your library",
            places.library.components().display().to_string(),
        ),
        (
            "Your materials",
            places.library.materials().display().to_string(),
        ),
        ("Autosaves", places.autosaves.display().to_string()),
        ("Saved work", places.work.display().to_string()),
    ]
    .map(|(what, value)| format!("{what}: {value}"));
    for line in &lines {
        ui.add(egui::Label::new(line).wrap());
    }
    if ui.button(format!("{} Copy", icon::COPY)).clicked() {
        ui.ctx().copy_text(format!("Midair\n{}", lines.join("\n")));
    }
}
