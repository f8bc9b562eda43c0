//! Everything that can be set, a page for each part; a new setting has its row at once.

use bevy::prelude::World;
use bevy_egui::egui::{self, DragValue, TextStyle, Ui};
use serde_json::Value;

use super::{Panel, icon, kit};
use crate::command::Command;
use crate::evaluate::Evaluations;
use crate::settings::Settings;

/// Parts that are remembered rather than set.
const REMEMBERED: [&str; 3] = ["help", "files", "palettes"];

/// The pages that stand first.
const FIRST: [&str; 4] = ["look", "hands", "units", "snap"];

/// What one chooses from.
const CHOICES: [(&str, &[&str]); 5] = [
    ("compute.backend", &["Auto", "Card", "Processor"]),
    ("comfort.desktop", &["Mirror", "Spectator"]),
    ("look.room", &["Dusk", "Day", "Paper"]),
    ("units.length", &["mm", "cm", "m", "inch"]),
    ("symmetry.mirror", &["None", "X", "Y", "Z"]),
];

/// Bounds of numbers that have sensible ones.
const RANGES: [(&str, f64, f64); 11] = [
    ("comfort.interface_scale", 0.6, 2.0),
    ("comfort.sharpness", 0.5, 2.0),
    ("comfort.pointer_angle", -30.0, 60.0),
    ("comfort.haptics", 0.0, 1.0),
    ("comfort.snap_turn", 0.0, 90.0),
    ("comfort.vignette", 0.0, 1.0),
    ("world.lowered", 0.0, 1.0),
    ("look.interface_scale", 0.5, 3.0),
    ("snap.grid.step", 0.001, 1.0),
    ("snap.angle.step", 1.0, 90.0),
    ("symmetry.count", 1.0, 64.0),
];

/// Points across the names of settings, and across everything.
const NAMES: f32 = 208.0;
const WIDTH: f32 = 384.0;

#[derive(Default)]
pub(super) struct SettingsPanel {
    page: String,
    /// What is looked for.
    query: String,
    /// The number that is being dragged or typed: sent once when it is let go.
    number: Option<(String, f64)>,
}

impl Panel for SettingsPanel {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let now = serde_json::to_value(world.resource::<Settings>());
        let usual = serde_json::to_value(Settings::default());
        let (Ok(Value::Object(now)), Ok(usual)) = (now, usual) else {
            return;
        };
        let parts: Vec<_> = now
            .iter()
            .filter(|(part, _)| !REMEMBERED.contains(&part.as_str()))
            .collect();
        // What one looks for most comes first.
        let rank = |part: &str| FIRST.iter().position(|f| *f == part);
        let mut parts = parts;
        parts.sort_by_key(|(part, _)| rank(part).unwrap_or(FIRST.len()));
        ui.set_width(WIDTH.min(ui.ctx().viewport_rect().width() - 64.0));
        kit::search(ui, &mut self.query, "Find a setting", f32::INFINITY);
        let query = self.query.trim().to_lowercase();
        if query.is_empty() {
            ui.horizontal_wrapped(|ui| {
                for (part, _) in &parts {
                    if self.page.is_empty() {
                        self.page.clone_from(part);
                    }
                    let open = self.page == **part;
                    if ui.selectable_label(open, title(part)).clicked() {
                        self.page.clone_from(part);
                    }
                }
            });
            ui.separator();
        }
        for (part, value) in parts {
            if query.is_empty() && self.page != *part {
                continue;
            }
            self.rows(ui, part, value, &query, asks);
            if part == "compute"
                && let Some(evaluations) = world.get_resource::<Evaluations>()
            {
                ui.weak(evaluations.backend.says());
            }
            if query.is_empty() {
                ui.add_space(8.0);
                self.foot(ui, part, value, &usual, asks);
            }
        }
    }
}

impl SettingsPanel {
    /// Every value below `key`, one row each.
    fn rows(
        &mut self,
        ui: &mut Ui,
        key: &str,
        value: &Value,
        query: &str,
        asks: &mut Vec<Command>,
    ) {
        if let Value::Object(parts) = value {
            // The room comes before what is set more seldom.
            let mut parts: Vec<_> = parts.iter().collect();
            parts.sort_by_key(|(name, _)| *name != "room");
            for (name, value) in parts {
                self.rows(ui, &format!("{key}.{name}"), value, query, asks);
            }
            return;
        }
        let label = label(key);
        if !format!("{key} {label}").to_lowercase().contains(query) {
            return;
        }
        match value {
            Value::Bool(on) => {
                let mut on = *on;
                if ui.checkbox(&mut on, label).changed() {
                    asks.push(Settings::command(key, on));
                }
            }
            Value::Number(number) => {
                let kept = number.as_f64().unwrap_or_default();
                kit::wide_row(ui, NAMES, &label, |ui| {
                    self.number(ui, key, kept, number.is_f64(), &label, asks);
                });
            }
            Value::String(chosen) => {
                let Some((_, choices)) = CHOICES.iter().find(|(k, _)| *k == key) else {
                    return;
                };
                // What one chooses from comes before the room for its name: the panel stays as wide as it is.
                let spacing = ui.spacing();
                let around = 2.0 * spacing.button_padding.x + spacing.item_spacing.x;
                let least = spacing.interact_size.x + spacing.item_spacing.x;
                let wide =
                    |c: &&str| f32::max(kit::width(ui, c, TextStyle::Button) + around, least);
                let needs: f32 = choices.iter().map(wide).sum();
                let names = NAMES.min(ui.available_width() - needs);
                kit::wide_row(ui, names, &label, |ui| {
                    for &choice in *choices {
                        let is = chosen == choice;
                        if ui.selectable_label(is, choice).clicked() && !is {
                            asks.push(Settings::command(key, choice));
                        }
                    }
                });
            }
            Value::Null | Value::Array(_) | Value::Object(_) => {}
        }
    }

    fn number(
        &mut self,
        ui: &mut Ui,
        key: &str,
        kept: f64,
        broken: bool,
        name: &str,
        asks: &mut Vec<Command>,
    ) {
        let own = self.number.as_ref().filter(|(k, _)| k == key);
        let mut value = own.map_or(kept, |(_, v)| *v);
        let range = RANGES.iter().find(|(k, ..)| *k == key);
        let (low, high) = range.map_or((0.0, 1e3), |(_, low, high)| (*low, *high));
        let drag = DragValue::new(&mut value)
            .range(low..=high)
            .speed((high - low).min(10.0) * 0.004)
            .max_decimals(if broken { 3 } else { 0 });
        let response = ui.add(drag);
        ui.ctx()
            .accesskit_node_builder(response.id, |node| node.set_label(name));
        if response.changed() {
            self.number = Some((key.to_owned(), value));
        }
        if !response.dragged()
            && !response.has_focus()
            && let Some((_, value)) = self.number.take_if(|(k, _)| k == key)
        {
            asks.push(if broken {
                // As short as it was typed.
                Settings::command(key, (value * 1e3).round() / 1e3)
            } else {
                Settings::command(key, value as i64)
            });
        }
    }

    fn foot(&self, ui: &mut Ui, part: &str, value: &Value, usual: &Value, asks: &mut Vec<Command>) {
        ui.horizontal_wrapped(|ui| {
            if let Some(before) = usual.get(part) {
                let reset =
                    egui::Button::new(format!("{} As usual", icon::ARROW_COUNTER_CLOCKWISE));
                let response = ui.add_enabled(before != value, reset);
                if response.on_hover_text("Resets this page").clicked() {
                    asks.push(Settings::command(part, before));
                }
            }
            if part == "hands" && ui.button("Keys and buttons…").clicked() {
                asks.push(Command::Panel {
                    id: "controls".to_owned(),
                    open: true,
                });
            }
        });
    }
}

fn title(part: &str) -> String {
    match part {
        "snap" => "Snaps".to_owned(),
        _ => words(part),
    }
}

/// What people read for a setting.
fn label(key: &str) -> String {
    match key {
        "look.interface_scale" => "Size of panels and text".to_owned(),
        "look.motion" => "Things ease into their places".to_owned(),
        "compute.backend" => "Solids are made by".to_owned(),
        "comfort.interface_scale" => "Size of panels in a headset".to_owned(),
        "comfort.sharpness" => "Sharpness, from when the headset is entered".to_owned(),
        "comfort.pointer_angle" => "Wands point down by (degrees)".to_owned(),
        "comfort.haptics" => "Strength of pulses".to_owned(),
        "comfort.snap_turn" => "Turn by grip and stick (degrees)".to_owned(),
        "comfort.vignette" => "Darken the edge while the world moves".to_owned(),
        "comfort.wrist" => "Panel on the wrist".to_owned(),
        "comfort.labels" => "Name the buttons of a controller near the face".to_owned(),
        "comfort.budget" => "Show the time of a frame".to_owned(),
        "comfort.desktop" => "The window meanwhile".to_owned(),
        "world.one_handed" => "One hand moves the world".to_owned(),
        "world.seated" => "I sit".to_owned(),
        "world.lowered" => "Lower the floor by (m)".to_owned(),
        "hands.left_handed" => "The left hand leads".to_owned(),
        "units.length" => "Lengths in".to_owned(),
        "look.orthographic" => "Without perspective".to_owned(),
        "symmetry.mirror" => "Mirror across the plane of".to_owned(),
        "symmetry.count" => "How many around the vertical".to_owned(),
        "symmetry.planes" => "Show the planes".to_owned(),
        "preview.on" => "Show the result while operands are marked".to_owned(),
        _ => {
            let rest = key.split_once('.').map_or(key, |(_, rest)| rest);
            words(&rest.trim_end_matches(".on").replace('.', ": "))
        }
    }
}

fn words(name: &str) -> String {
    let spaced = name.replace('_', " ");
    let mut letters = spaced.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_choice_is_one_that_can_be_set() {
        for (key, choices) in CHOICES {
            for choice in choices {
                let value = serde_json::to_string(choice).unwrap();
                let fits = Settings::default().set(key, &value).is_ok();
                assert!(fits, "{key} = {choice}");
            }
        }
    }

    #[test]
    fn a_page_goes_back_to_what_is_usual_by_one_command() {
        let mut settings = Settings::default();
        settings.set("hands.left_handed", "true").unwrap();
        let usual = serde_json::to_value(Settings::default()).unwrap();
        let Command::Set { key, value } = Settings::command("hands", &usual["hands"]) else {
            panic!("a setting");
        };
        settings.set(&key, &value).unwrap();
        assert_eq!(settings, Settings::default());
    }
}
