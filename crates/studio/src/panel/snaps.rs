//! What pulls at things that hands move: each snap with its switch, its step and its key.

use bevy::prelude::World;
use bevy_egui::egui::{self, DragValue, Ui};

use super::{Panel, kit};
use crate::command::Command;
use crate::help::Keys;
use crate::settings::Settings;

/// The step that is being dragged or typed: sent once when it is let go.
#[derive(Default)]
pub(super) struct Snaps {
    step: Option<(&'static str, f32)>,
}

/// A row: the setting of its switch, its key, what people read, what it does.
struct Row {
    switch: &'static str,
    control: &'static str,
    name: &'static str,
    about: &'static str,
}

const GRID: Row = Row {
    switch: "snap.grid.on",
    control: "snap_grid",
    name: "Grid",
    about: "The foot of what is moved comes onto the lines of the work plane",
};
const ANGLE: Row = Row {
    switch: "snap.angle.on",
    control: "snap_angle",
    name: "Angle",
    about: "What is turned comes to whole steps",
};
const SURFACE: Row = Row {
    switch: "snap.surface.on",
    control: "snap_surface",
    name: "Surface",
    about: "What is moved comes to rest on the ground or on what is below it",
};

impl Panel for Snaps {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let settings = world.resource::<Settings>();
        let keys = world.resource::<Keys>();
        let snap = &settings.snap;
        let unit = settings.units.length;
        let per_metre = unit.per_metre() as f32;
        ui.set_min_width(ui.available_width().min(280.0));
        egui::Grid::new("snaps")
            .num_columns(3)
            .spacing([16.0, 8.0])
            .show(ui, |ui| {
                switch(ui, &GRID, snap.grid.on, asks);
                let step = self.number(
                    ui,
                    "snap.grid.step",
                    snap.grid.step * per_metre,
                    (0.001 * per_metre, per_metre),
                    &format!(" {unit}"),
                    "Grid step",
                );
                if let Some(step) = step {
                    // As short as it was typed.
                    let metres = f64::from(step) * unit.metres();
                    asks.push(Settings::command(
                        "snap.grid.step",
                        (metres * 1e6).round() / 1e6,
                    ));
                }
                cap(ui, keys, &GRID);
                switch(ui, &ANGLE, snap.angle.on, asks);
                let step = self.number(
                    ui,
                    "snap.angle.step",
                    snap.angle.step,
                    (1.0, 90.0),
                    "°",
                    "Angle step",
                );
                if let Some(step) = step {
                    asks.push(Settings::command(
                        "snap.angle.step",
                        (f64::from(step) * 1e3).round() / 1e3,
                    ));
                }
                cap(ui, keys, &ANGLE);
                switch(ui, &SURFACE, snap.surface.on, asks);
                ui.weak("what lies below");
                cap(ui, keys, &SURFACE);
            });
        ui.add_space(8.0);
        ui.horizontal_wrapped(|ui| {
            match label(keys, "snap_off") {
                Some(key) => {
                    ui.weak("Hold");
                    kit::key_cap(ui, key);
                }
                None => {
                    ui.weak("Hold the button for it");
                }
            }
            ui.weak("to hold all of them off.");
        });
    }
}

impl Snaps {
    fn number(
        &mut self,
        ui: &mut Ui,
        key: &'static str,
        kept: f32,
        (low, high): (f32, f32),
        suffix: &str,
        name: &str,
    ) -> Option<f32> {
        let own = self.step.filter(|(k, _)| *k == key);
        let mut value = own.map_or(kept, |(_, v)| v);
        let drag = DragValue::new(&mut value)
            .range(low..=high)
            .speed((high - low) * 0.002)
            .max_decimals(3)
            .suffix(suffix);
        let response = ui.add(drag).on_hover_text(name);
        if response.changed() {
            self.step = Some((key, value));
        }
        if response.dragged() || response.has_focus() {
            return None;
        }
        self.step.take_if(|(k, _)| *k == key).map(|(_, v)| v)
    }
}

fn switch(ui: &mut Ui, row: &Row, on: bool, asks: &mut Vec<Command>) {
    let mut on = on;
    if ui
        .checkbox(&mut on, row.name)
        .on_hover_text(row.about)
        .changed()
    {
        asks.push(Settings::command(row.switch, on));
    }
}

fn cap(ui: &mut Ui, keys: &Keys, row: &Row) {
    match label(keys, row.control) {
        Some(key) => drop(kit::key_cap(ui, key)),
        None => drop(ui.weak("")),
    }
    ui.end_row();
}

/// What a control is called on the device in use; `None` where it has nothing for it.
pub(super) fn label<'a>(keys: &'a Keys, control: &str) -> Option<&'a str> {
    let label = keys.labels.get(control)?;
    (!label.is_empty()).then_some(label)
}
