//! Export: format, unit, fineness, and what comes of them before anything is written.

use bevy::math::Vec3;
use bevy::prelude::World;
use bevy_egui::egui::{self, Ui};
use midair_document::{Document, Object, ObjectId};
use midair_mesh::{Unit, Up};

use super::{Panel, icon};
use crate::command::Command;
use crate::evaluate::{Evaluations, Key};
use crate::objects::extent;
use crate::project::{Project, Selection};
use crate::settings::Settings;
use crate::show::display_steps;
use crate::units;

/// What is being chosen.
#[derive(Default)]
pub(super) struct Export {
    format: usize,
    unit: Option<Unit>,
    up: Option<Up>,
    step: Option<f32>,
    /// Only what is selected.
    selected: bool,
    name: Option<String>,
}

/// Ending, name, what it is for, its own unit and its own axis upwards.
const FORMATS: [(&str, &str, &str, Unit, Up); 5] = [
    (
        "stl",
        "STL",
        "For printing; every slicer reads it",
        Unit::Mm,
        Up::Z,
    ),
    (
        "3mf",
        "3MF",
        "For printing, with its unit and names",
        Unit::Mm,
        Up::Z,
    ),
    (
        "glb",
        "GLB",
        "For viewers and engines, in one file",
        Unit::M,
        Up::Y,
    ),
    ("obj", "OBJ", "For other modellers, as text", Unit::M, Up::Y),
    (
        "ply",
        "PLY",
        "For scanning and research tools",
        Unit::M,
        Up::Y,
    ),
];

/// Axis, name, who wants it.
const UPS: [(Up, &str, &str); 2] = [
    (Up::Y, "Y", "As in glTF, engines and Midair itself"),
    (
        Up::Z,
        "Z",
        "As in slicers and most CAD: it stands on the print bed",
    ),
];

impl Panel for Export {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let project = world.resource::<Project>();
        let document = project.document();
        let selection = &world.resource::<Selection>().0;
        let (ending, _, about, own, own_up) = FORMATS[self.format];
        ui.set_min_width(360.0);
        ui.horizontal(|ui| {
            for (i, (_, name, about, ..)) in FORMATS.iter().enumerate() {
                if ui
                    .selectable_label(self.format == i, *name)
                    .on_hover_text(*about)
                    .clicked()
                {
                    (self.format, self.unit, self.up) = (i, None, None);
                }
            }
        });
        ui.weak(about);
        ui.add_space(8.0);
        // One object can be written alone; several go with everything else.
        let alone = match selection.as_slice() {
            &[id] if document.object(id).is_some_and(is_made) => Some(id),
            _ => None,
        };
        let only = alone.filter(|_| self.selected);
        let ids = chosen(document, only);
        let step = self.step.unwrap_or(document.step());
        let unit = self.unit.unwrap_or(own);
        let up = self.up.unwrap_or(own_up);
        egui::Grid::new("export")
            .num_columns(2)
            .spacing([16.0, 8.0])
            .show(ui, |ui| {
                ui.label("What");
                ui.horizontal(|ui| {
                    if ui
                        .selectable_label(only.is_none(), "All that is visible")
                        .clicked()
                    {
                        self.selected = false;
                    }
                    let one = egui::Button::selectable(only.is_some(), "What is selected");
                    if ui
                        .add_enabled(alone.is_some(), one)
                        .on_disabled_hover_text("Select one object first")
                        .clicked()
                    {
                        self.selected = true;
                    }
                });
                ui.end_row();
                ui.label("Unit");
                ui.horizontal(|ui| {
                    for choice in Unit::ALL {
                        if ui
                            .selectable_label(unit == choice, choice.to_string())
                            .clicked()
                        {
                            self.unit = Some(choice);
                        }
                    }
                });
                ui.end_row();
                ui.label("Up");
                ui.horizontal(|ui| {
                    for (choice, name, about) in UPS {
                        let row = ui.selectable_label(up == choice, name);
                        if row.on_hover_text(about).clicked() {
                            self.up = Some(choice);
                        }
                    }
                });
                ui.end_row();
                ui.label("Fineness");
                let (least, most) = Document::STEPS;
                let mut millimetres = step * 1e3;
                let slider = egui::Slider::new(&mut millimetres, least * 1e3..=most * 1e3)
                    .suffix(" mm")
                    .fixed_decimals(1);
                if ui
                    .add(slider)
                    .on_hover_text("Smaller is finer, larger in the file and slower")
                    .changed()
                {
                    self.step = Some(millimetres * 1e-3);
                }
                ui.end_row();
                ui.label("Triangles");
                match triangles(world.resource(), document, &ids, step) {
                    Some(count) => ui.label(format!("about {}", grouped(count))),
                    None => ui.weak("not known yet"),
                };
                ui.end_row();
                ui.label("Size");
                match extent(document, ids.iter().copied()) {
                    Some((low, high)) => ui
                        .label(units::size(in_file(high - low, up), unit))
                        .on_hover_text("Along X, Y and Z in the file"),
                    None => ui.weak("nothing to write"),
                };
                ui.end_row();
                ui.label("Name");
                let name = self.name.get_or_insert_with(|| project.title());
                ui.horizontal(|ui| {
                    ui.add(egui::TextEdit::singleline(name).desired_width(180.0));
                    ui.label(format!(".{ending}"));
                });
                ui.end_row();
            });
        let folder = world.resource::<Project>().work_folder();
        ui.weak(format!("Goes to {}", folder.display()));
        if let Some((low, high)) = extent(document, ids.iter().copied())
            && let Some(doubt) = doubt(high - low, ending)
        {
            ui.colored_label(
                ui.visuals().warn_fg_color,
                format!("{}  {doubt}", icon::WARNING),
            );
        }
        ui.add_space(12.0);
        let name = self.name.clone().unwrap_or_default();
        let named = !name.trim().is_empty() && !name.contains(['/', '\\']);
        let button = egui::Button::new(format!("{}  Export", icon::EXPORT)).selected(true);
        ui.horizontal(|ui| {
            let why = if named {
                "There is nothing to write"
            } else {
                "Give it a name without slashes"
            };
            if ui
                .add_enabled(named && !ids.is_empty(), button)
                .on_disabled_hover_text(why)
                .clicked()
            {
                let path = folder.join(format!("{}.{ending}", name.trim()));
                asks.push(Command::Export {
                    path,
                    step: self.step,
                    unit: self.unit,
                    up: self.up,
                    only,
                });
                asks.push(close());
            }
            if ui.button("Cancel").clicked() {
                asks.push(close());
            }
        });
        let shown = world.resource::<Settings>().units.length;
        if shown != unit
            && let Some((low, high)) = extent(document, ids.iter().copied())
        {
            ui.weak(format!(
                "That is {}.",
                units::size(in_file(high - low, up), shown)
            ));
        }
    }
}

fn close() -> Command {
    Command::Panel {
        id: "export".into(),
        open: false,
    }
}

fn chosen(document: &Document, only: Option<ObjectId>) -> Vec<ObjectId> {
    match only {
        Some(id) => vec![id],
        None => document
            .objects()
            .map(|(id, _)| id)
            .filter(|&id| document.is_visible(id))
            .filter(|&id| document.object(id).is_some_and(is_made))
            .collect(),
    }
}

/// What was made is written; pictures to work from are not.
fn is_made(object: &Object) -> bool {
    object.reference().is_none()
}

/// Width, then what the file has along Y and along Z.
fn in_file(size: Vec3, up: Up) -> Vec3 {
    match up {
        Up::Y => size,
        Up::Z => Vec3::new(size.x, size.z, size.y),
    }
}

/// About how many triangles a step gives: what is on screen, since their number goes with the inverse
/// square of the step. `None` while something is not made yet.
pub fn triangles(
    evaluations: &Evaluations,
    document: &Document,
    ids: &[ObjectId],
    step: f32,
) -> Option<usize> {
    let mut sum = 0.0;
    for object in ids.iter().filter_map(|&id| document.object(id)) {
        let Some(recipe) = object.recipe() else {
            continue;
        };
        let scale = object.placement.scale.abs();
        let (shown, made) = display_steps(document, object, recipe)
            .into_iter()
            .find_map(|s| Some((s, evaluations.made(&Key::new(recipe, s))?)))?;
        // A surface grows with two of its three scales.
        let spread = (scale.x * scale.y * scale.z).powf(2.0 / 3.0);
        let ratio = f64::from(shown * shown * spread / (step * step));
        sum += made.mesh.triangles.len() as f64 * ratio;
    }
    (!ids.is_empty()).then_some(sum.round() as usize)
}

/// Two digits say what an estimate knows.
fn grouped(count: usize) -> String {
    let digits = count.checked_ilog10().map_or(0, |d| d.saturating_sub(1));
    let round = 10usize.pow(digits);
    let text = ((count + round / 2) / round * round).to_string();
    let mut out = String::new();
    for (i, c) in text.chars().enumerate() {
        if i > 0 && (text.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

/// Printed parts of a hair or of a house are seldom meant.
fn doubt(size: Vec3, ending: &str) -> Option<&'static str> {
    let printed = matches!(ending, "stl" | "3mf");
    let most = size.max_element();
    match () {
        () if printed && most > 2.0 => Some("More than two metres: few printers are as large."),
        () if printed && most < 1e-3 => Some("Less than a millimetre: few printers are as fine."),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_and_grouped() {
        assert_eq!(grouped(123_456), "120,000");
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(1_960), "2,000");
    }

    #[test]
    fn absurd_sizes_are_doubted_only_where_one_prints() {
        assert!(doubt(Vec3::splat(3.0), "stl").is_some());
        assert!(doubt(Vec3::splat(0.0005), "3mf").is_some());
        assert!(doubt(Vec3::splat(0.1), "stl").is_none());
        assert!(doubt(Vec3::splat(30.0), "glb").is_none());
    }
}
