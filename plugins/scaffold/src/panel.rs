//! The panel: what the trigger draws, how it is corrected, what was made of it.

use bevy::prelude::World;
use midair_document::affine;
use midair_studio::command::Command;
use midair_studio::panel::egui::{self, DragValue, Slider, Ui};
use midair_studio::panel::{Dock, Panel, PanelInfo, icon, kit};
use midair_studio::project::{Project, Selection};
use midair_studio::settings::{Draws, LinesShown, Settings};

use crate::ask::{Ask, about};
use crate::phase::Draft;
use crate::read::words;

pub(crate) const INFO: PanelInfo = PanelInfo {
    id: "scaffold",
    title: "Scaffold",
    icon: icon::LINE_SEGMENTS,
    dock: Dock::Right,
    order: 14,
    open: false,
    in_bar: true,
};

/// What is being dragged or typed; sent once when it is let go.
#[derive(Default)]
pub(crate) struct ScaffoldPanel {
    dragged: Option<(&'static str, f64)>,
    strength: Option<f64>,
}

impl Panel for ScaffoldPanel {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let (Some(settings), Some(project), Some(selection), Some(draft)) = (
            world.get_resource::<Settings>(),
            world.get_resource::<Project>(),
            world.get_resource::<Selection>(),
            world.get_resource::<Draft>(),
        ) else {
            return;
        };
        egui::ScrollArea::vertical()
            .auto_shrink([false, true])
            .show(ui, |ui| {
                self.drawing(ui, settings, asks);
                ui.separator();
                self.drawn(ui, settings, project, selection, draft, asks);
                ui.separator();
                self.thresholds(ui, settings, draft.own_angle, asks);
                ui.separator();
                ui.horizontal_wrapped(|ui| {
                    if ui.button("Group the scaffold").clicked() {
                        asks.push(Ask::Group.command());
                    }
                    let history = ui
                        .button("Export history")
                        .on_hover_text("Every step, raw and corrected, as JSON in the work folder");
                    if history.clicked() {
                        asks.push(Ask::History(None).command());
                    }
                    let sheet = ui
                        .button("Export sheet")
                        .on_hover_text("Four views to scale, as SVG in the work folder");
                    if sheet.clicked() {
                        asks.push(Ask::Sheet(None).command());
                    }
                });
            });
    }
}

impl ScaffoldPanel {
    fn drawing(&mut self, ui: &mut Ui, settings: &Settings, asks: &mut Vec<Command>) {
        let set = &settings.scaffold;
        ui.horizontal(|ui| {
            for (name, draws) in [("Lines", Draws::Line), ("Strokes", Draws::Stroke)] {
                if ui.selectable_label(set.draws == draws, name).clicked() {
                    asks.push(Settings::command("scaffold.draws", draws));
                }
            }
        });
        let mut auto = set.auto;
        if ui.checkbox(&mut auto, "Auto-correct").changed() {
            asks.push(Settings::command("scaffold.auto", auto));
        }
        self.number(
            ui,
            "scaffold.strength",
            "Strength",
            set.strength,
            (0.1, 3.0),
            "×",
            asks,
        );
        self.number(
            ui,
            "scaffold.width",
            "Stroke width",
            set.width * 1e3,
            (0.5, 100.0),
            " mm",
            asks,
        );
        kit::wide_row(ui, 40.0, "Lines", |ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            for (name, shown) in [
                ("shown", LinesShown::Shown),
                ("dimmed", LinesShown::Dimmed),
                ("hidden", LinesShown::Hidden),
            ] {
                if ui.selectable_label(set.lines == shown, name).clicked() {
                    asks.push(Settings::command("scaffold.lines", shown));
                }
            }
        });
    }

    fn drawn(
        &mut self,
        ui: &mut Ui,
        settings: &Settings,
        project: &Project,
        selection: &Selection,
        draft: &Draft,
        asks: &mut Vec<Command>,
    ) {
        let ids = about(selection, draft, project);
        let objects: Vec<_> = ids
            .iter()
            .filter_map(|&id| project.document().object(id))
            .collect();
        let Some(first) = objects.first() else {
            kit::empty(ui, "Draw something, or select a line or a stroke.");
            return;
        };
        match objects.len() {
            1 => ui.label(kit::strong(&first.name)),
            count => ui.label(kit::strong(format!("{count} lines and strokes"))),
        };
        if let Some(line) = first.line().filter(|_| objects.len() == 1) {
            ui.weak(words(&line.kept));
            let there = affine(&first.placement);
            self.line(ui, line.ends().map(|p| there.transform_point3(p)), asks);
        }
        if objects.len() == 2 && objects.iter().all(|o| o.line().is_some()) {
            self.number_ask(
                ui,
                "Angle between",
                90.0,
                (0.0, 180.0),
                "°",
                Ask::Between,
                asks,
            );
        }
        if let Some(stroke) = first.stroke() {
            let width = stroke.width * 1e3;
            let ask = |mm: f64| Ask::Width(mm * 1e-3);
            self.number_ask(ui, "Width", width, (0.5, 100.0), " mm", ask, asks);
        }
        if let Some(last) = draft.last.as_ref().filter(|l| ids == [l.id]) {
            for (i, reading) in last.readings.iter().enumerate() {
                if ui
                    .selectable_label(i == last.chosen, format!("{} {}", i + 1, reading.words))
                    .clicked()
                {
                    asks.push(Ask::Reading(i).command());
                }
            }
        }
        let mut strength = self.strength.unwrap_or(1.0);
        let slider = Slider::new(&mut strength, 0.1..=4.0).logarithmic(true);
        if kit::field(ui, "Anew with", slider).changed() {
            self.strength = Some(strength);
        }
        ui.horizontal_wrapped(|ui| {
            if ui.button("Correct again").clicked() {
                asks.push(Ask::Again(strength).command());
            }
            if ui.button("As drawn").clicked() {
                asks.push(Ask::Again(0.0).command());
            }
            if ui
                .button("Fill")
                .on_hover_text("What is closed and flat becomes a plate")
                .clicked()
            {
                asks.push(Ask::Fill.command());
            }
            if objects
                .iter()
                .any(|o| o.line().is_some_and(|l| !l.ticks.is_empty()))
                && ui.button("Remove tick marks").clicked()
            {
                asks.push(Ask::Untick.command());
            }
        });
        let plate = settings.scaffold.plate * 1e3;
        self.number(
            ui,
            "scaffold.plate",
            "Plates are",
            plate,
            (1.0, 500.0),
            " mm",
            asks,
        );
    }

    fn line(&mut self, ui: &mut Ui, [a, b]: [bevy::math::DVec3; 2], asks: &mut Vec<Command>) {
        let along = b - a;
        let rise = along.y.atan2(along.x.hypot(along.z)).to_degrees();
        let heading = (-along.z).atan2(along.x).to_degrees();
        let length = along.length() * 1e3;
        self.number_ask(
            ui,
            "Length",
            length,
            (1.0, 1e6),
            " mm",
            |mm| Ask::Length(mm * 1e-3),
            asks,
        );
        self.number_ask(
            ui,
            "Rise",
            rise,
            (-90.0, 90.0),
            "°",
            |rise| Ask::Angles { rise, heading },
            asks,
        );
        self.number_ask(
            ui,
            "Heading",
            heading,
            (-180.0, 180.0),
            "°",
            |heading| Ask::Angles { rise, heading },
            asks,
        );
    }

    fn thresholds(
        &mut self,
        ui: &mut Ui,
        settings: &Settings,
        own_angle: f64,
        asks: &mut Vec<Command>,
    ) {
        let set = &settings.scaffold;
        egui::CollapsingHeader::new("Thresholds")
            .default_open(false)
            .show(ui, |ui| {
                for (key, name, value, range, suffix) in [
                    (
                        "scaffold.distance",
                        "Ends within",
                        set.distance * 1e3,
                        (2.0, 200.0),
                        " mm",
                    ),
                    (
                        "scaffold.angle",
                        "Directions within",
                        set.angle,
                        (0.5, 30.0),
                        "°",
                    ),
                    (
                        "scaffold.length",
                        "Lengths within",
                        set.length * 1e2,
                        (1.0, 60.0),
                        " %",
                    ),
                    (
                        "scaffold.stroke_distance",
                        "Strokes within",
                        set.stroke_distance * 1e3,
                        (2.0, 200.0),
                        " mm",
                    ),
                    (
                        "scaffold.stroke_angle",
                        "Strokes follow within",
                        set.stroke_angle,
                        (1.0, 60.0),
                        "°",
                    ),
                ] {
                    self.number(ui, key, name, value, range, suffix, asks);
                }
                for (key, name, on) in [
                    ("scaffold.vertical", "Upright and level", set.vertical),
                    ("scaffold.part_turns", "30°, 45°, 60°", set.part_turns),
                ] {
                    let mut now = on;
                    if ui.checkbox(&mut now, name).changed() {
                        asks.push(Settings::command(key, now));
                    }
                }
                self.number_ask(
                    ui,
                    "An angle of your own",
                    own_angle,
                    (0.0, 90.0),
                    "°",
                    Ask::OwnAngle,
                    asks,
                );
                ui.weak("Lengths as the hand sees them; on a screen 50 mm are 16 pixels.");
            });
    }

    /// A setting as a number; sent when it is let go.
    #[expect(
        clippy::too_many_arguments,
        reason = "what a row of numbers is made of"
    )]
    fn number(
        &mut self,
        ui: &mut Ui,
        key: &'static str,
        name: &str,
        value: f64,
        range: (f64, f64),
        suffix: &str,
        asks: &mut Vec<Command>,
    ) {
        let factor = match suffix {
            " mm" => 1e-3,
            " %" => 1e-2,
            _ => 1.0,
        };
        if let Some(value) = self.row(ui, key, name, value, range, suffix) {
            asks.push(Settings::command(key, value * factor));
        }
    }

    /// The same for what is asked of the drawing.
    #[expect(
        clippy::too_many_arguments,
        reason = "what a row of numbers is made of"
    )]
    fn number_ask(
        &mut self,
        ui: &mut Ui,
        name: &'static str,
        value: f64,
        range: (f64, f64),
        suffix: &str,
        ask: impl Fn(f64) -> Ask,
        asks: &mut Vec<Command>,
    ) {
        if let Some(value) = self.row(ui, name, name, value, range, suffix) {
            asks.push(ask(value).command());
        }
    }

    fn row(
        &mut self,
        ui: &mut Ui,
        key: &'static str,
        name: &str,
        value: f64,
        (low, high): (f64, f64),
        suffix: &str,
    ) -> Option<f64> {
        let held = self.dragged.filter(|(k, _)| *k == key).map(|(_, v)| v);
        let mut now = held.unwrap_or(value);
        let drag = DragValue::new(&mut now)
            .speed(0.002 * (high - low).min(500.0))
            .range(low..=high)
            .max_decimals(2)
            .suffix(suffix);
        let field = kit::field(ui, name, drag).on_hover_text(name);
        if field.dragged() || field.has_focus() {
            self.dragged = Some((key, now));
            return None;
        }
        if held.is_some() {
            self.dragged = None;
        }
        (now != value).then_some(now)
    }
}
