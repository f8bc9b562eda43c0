//! The list of controls: what each is bound to, bound anew by pressing, and where two share a key.

use bevy::prelude::*;
use midair_studio::{
    command::Command,
    panel::{
        AddPanel, Dock, Panel, PanelInfo,
        egui::{self, RichText, Ui},
        icon, kit,
    },
    settings::Settings,
};

use crate::bindings::{Asked, Bindings, Control, Device, Group, Rebind, Rebinding};

/// Points for the words, and for each device's keys.
const WORDS: f32 = 300.0;
const KEYS: f32 = 150.0;

struct ControlsPanel {
    asked: Asked,
    /// What is looked for.
    query: String,
}

pub(crate) fn plugin(app: &mut App) {
    let asked = app.world_mut().get_resource_or_init::<Asked>().clone();
    app.add_panel(
        PanelInfo {
            id: "controls",
            title: "Controls",
            icon: icon::GAME_CONTROLLER,
            dock: Dock::Window,
            order: 80,
            open: false,
            in_bar: true,
        },
        ControlsPanel {
            asked,
            query: String::new(),
        },
    );
}

impl Panel for ControlsPanel {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let bindings = world.resource::<Bindings>();
        let awaited = world.resource::<Rebinding>().awaited();
        self.head(ui, world, asks);
        let wanted = self.query.trim().to_lowercase();
        let fits = |control: &Control| {
            let keys = bindings.of(*control).iter().map(ToString::to_string);
            wanted.is_empty()
                || control.words().to_lowercase().contains(&wanted)
                || keys.into_iter().any(|k| k.to_lowercase() == wanted)
        };
        egui::ScrollArea::vertical()
            .max_height(440.0)
            .show(ui, |ui| {
                for group in Group::ALL {
                    let controls: Vec<_> = Control::ALL
                        .iter()
                        .copied()
                        .filter(|c| c.group() == group && fits(c))
                        .collect();
                    if controls.is_empty() {
                        continue;
                    }
                    ui.add_space(8.0);
                    ui.label(RichText::new(group.title()).strong());
                    for control in controls {
                        self.row(ui, control, bindings, awaited);
                    }
                }
            });
    }
}

impl ControlsPanel {
    fn head(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        ui.horizontal(|ui| {
            kit::search(ui, &mut self.query, "Find by name or key", WORDS - 16.0);
            let mut left = world.resource::<Settings>().hands.left_handed;
            if ui
                .checkbox(&mut left, "Left-handed")
                .on_hover_text("The left hand leads and has the library, the right one saves; sticks change places")
                .changed()
            {
                asks.push(Settings::command("hands.left_handed", left));
            }
            let changed = world.resource::<Bindings>().is_any_changed();
            let reset = egui::Button::new(format!(
                "{} Reset all",
                icon::ARROW_COUNTER_CLOCKWISE
            ));
            if ui.add_enabled(changed, reset).clicked() {
                self.asked.push(Rebind::ResetAll);
            }
        });
        ui.horizontal(|ui| {
            for (text, width) in [
                (String::new(), WORDS),
                (format!("{} Mouse and keyboard", icon::KEYBOARD), KEYS),
                (format!("{} Gamepad", icon::GAME_CONTROLLER), KEYS),
            ] {
                ui.add_sized([width, 20.0], egui::Label::new(RichText::new(text).small()));
            }
        });
    }

    fn row(
        &self,
        ui: &mut Ui,
        control: Control,
        bindings: &Bindings,
        awaited: Option<(Control, Device)>,
    ) {
        let conflicts = bindings.conflicts(control);
        ui.push_id(control.name(), |ui| {
            ui.horizontal(|ui| {
                let words = egui::Label::new(control.words()).truncate();
                ui.allocate_ui_with_layout(
                    egui::vec2(WORDS, 24.0),
                    egui::Layout::left_to_right(egui::Align::Center),
                    |ui| {
                        ui.set_min_width(WORDS);
                        ui.add(words);
                    },
                );
                for device in [Device::Keys, Device::Pad] {
                    self.keys(ui, control, device, bindings, awaited);
                }
                if bindings.is_changed(control)
                    && ui
                        .button(icon::ARROW_COUNTER_CLOCKWISE)
                        .on_hover_text("Back to the usual keys")
                        .clicked()
                {
                    self.asked.push(Rebind::Reset(control));
                }
            });
            for (other, shared) in conflicts {
                // In words and by its sign, never by colour alone.
                let text = format!("{} {shared} is also \"{}\"", icon::WARNING, other.words());
                ui.label(RichText::new(text).small().strong());
            }
        });
    }

    /// What a control has on one device: pressed, it waits for another key.
    fn keys(
        &self,
        ui: &mut Ui,
        control: Control,
        device: Device,
        bindings: &Bindings,
        awaited: Option<(Control, Device)>,
    ) {
        // The mouse has no sticks.
        if control.is_stick() && device == Device::Keys {
            ui.add_sized([KEYS, 24.0], egui::Label::new("–"));
            return;
        }
        let waits = awaited == Some((control, device));
        let names: Vec<_> = bindings.on(control, device).map(|b| b.label()).collect();
        let text = match (waits, names.is_empty()) {
            (true, _) if control.is_stick() => "Push a stick…".to_owned(),
            (true, _) => "Press it…".to_owned(),
            (false, true) => "–".to_owned(),
            (false, false) => names.join(", "),
        };
        let mut button = egui::Button::new(text).truncate();
        if waits {
            button = button.selected(true);
        }
        let clears = !names.is_empty() && !waits;
        let width = if clears { KEYS - 32.0 } else { KEYS };
        let response = ui.add_sized([width, 24.0], button);
        if response
            .on_hover_text("Click, then press the new key; Esc leaves it as it is")
            .clicked()
        {
            self.asked.push(Rebind::Await(control, device));
        }
        if clears {
            let clear = egui::Button::new(icon::X).frame(false);
            let sized = ui.add_sized([24.0, 24.0], clear);
            if sized.on_hover_text("Bind it to nothing").clicked() {
                self.asked.push(Rebind::Clear(control, device));
            }
        }
    }
}
