//! Live symmetry: across which plane, how many around.

use bevy::prelude::World;
use bevy_egui::egui::{self, DragValue, Ui};

use super::{Panel, icon, kit};
use crate::command::Command;
use crate::help::Keys;
use crate::settings::{MirrorPlane, Settings, SymmetrySettings};

/// The number that is being dragged or typed: sent once when it is let go.
#[derive(Default)]
pub(super) struct Symmetry {
    count: Option<u32>,
}

/// Plane, what people read, what it does.
const PLANES: [(MirrorPlane, &str, &str); 4] = [
    (MirrorPlane::None, "None", "Nothing is mirrored"),
    (MirrorPlane::X, "X", "Left and right"),
    (MirrorPlane::Y, "Y", "Above and below"),
    (MirrorPlane::Z, "Z", "Front and back"),
];

impl Panel for Symmetry {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let now = &world.resource::<Settings>().symmetry;
        let keys = world.resource::<Keys>();
        ui.set_min_width(ui.available_width().min(280.0));
        egui::Grid::new("symmetry")
            .num_columns(2)
            .spacing([16.0, 8.0])
            .show(ui, |ui| {
                ui.label("Mirror");
                ui.horizontal(|ui| {
                    for (plane, name, about) in PLANES {
                        let row = ui.selectable_label(now.mirror == plane, name);
                        if row.on_hover_text(about).clicked() {
                            asks.push(Settings::command("symmetry.mirror", plane));
                        }
                    }
                });
                ui.end_row();
                ui.label("Around");
                let mut count = self.count.unwrap_or(now.count);
                let field = ui
                    .add(DragValue::new(&mut count).range(1..=64).speed(0.05))
                    .on_hover_text("How many around the vertical through the middle");
                if field.changed() {
                    self.count = Some(count);
                }
                if !field.dragged()
                    && !field.has_focus()
                    && let Some(count) = self.count.take()
                {
                    asks.push(Settings::command("symmetry.count", count));
                }
                ui.end_row();
            });
        let mut planes = now.planes;
        if ui.checkbox(&mut planes, "Show the planes").changed() {
            asks.push(Settings::command("symmetry.planes", planes));
        }
        ui.add_space(8.0);
        ui.label(egui::RichText::new(
            "What is made, moved, marked, coloured or deleted on one side is so on the others, as one step. \
             What lies on the plane or the axis stays single.",
        ).weak());
        ui.horizontal_wrapped(|ui| {
            let off = egui::Button::new(format!("{}  Off", icon::X));
            if ui.add_enabled(now.is_on(), off).clicked() {
                let usual = SymmetrySettings {
                    planes: now.planes,
                    ..SymmetrySettings::default()
                };
                asks.push(Settings::command("symmetry", usual));
            }
            if let Some(key) = super::snaps::label(keys, "symmetry") {
                kit::key_cap(ui, key);
                ui.weak("on and off");
            }
        });
    }
}
