//! The properties of what is selected: name, place, size, colour, material.

use bevy::math::{EulerRot, Quat, Vec3};
use bevy::prelude::World;
use bevy_egui::egui::{self, DragValue, Ui};
use midair_document::{Colour, Document, Object, ObjectId, Reference};
use midair_field::Placement;
use midair_mesh::Unit;

use super::palettes::Palettes;
use super::{MaterialRows, Panel, icon, kit};
use crate::command::Command;
use crate::materials::MaterialShelf;
use crate::objects::{Ask, Axis, extent};
use crate::project::{Project, Selection};
use crate::settings::Settings;
use crate::units;

/// What is being dragged or typed; sent once when it is let go.
#[derive(Default)]
pub(super) struct Properties {
    /// The object whose numbers are in hand, and where they put it.
    place: Option<(ObjectId, Numbers)>,
    colour: Option<[u8; 3]>,
    hex: Option<String>,
    fault: Option<String>,
    around: Option<u32>,
    palettes: Palettes,
    material: MaterialRows,
    /// The picture whose numbers are in hand: its width in metres, its opacity.
    picture: Option<(ObjectId, f32, f32)>,
}

/// Points across a number.
const FIELD: f32 = 60.0;

/// A place in the numbers a person reads: the chosen unit, degrees, factors.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Numbers {
    position: Vec3,
    degrees: Vec3,
    scale: Vec3,
}

impl Numbers {
    fn of(placement: &Placement, unit: Unit) -> Self {
        let (x, y, z) = placement.rotation.to_euler(EulerRot::XYZ);
        Self {
            position: (placement.translation * unit.per_metre() as f32).map(shown),
            degrees: (Vec3::new(x, y, z) * 180.0 / std::f32::consts::PI).map(shown),
            scale: placement.scale,
        }
    }

    fn placement(&self, unit: Unit) -> Placement {
        let r = self.degrees * std::f32::consts::PI / 180.0;
        Placement {
            translation: self.position * unit.metres() as f32,
            rotation: Quat::from_euler(EulerRot::XYZ, r.x, r.y, r.z).normalize(),
            scale: self.scale,
        }
    }
}

/// What is less than is shown is nothing, and nothing has no sign.
fn shown(value: f32) -> f32 {
    if value.abs() < 5e-4 { 0.0 } else { value }
}

impl Panel for Properties {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let document = world.resource::<Project>().document();
        let selection = &world.resource::<Selection>().0;
        let unit = world.resource::<Settings>().units.length;
        let mut ask = Vec::new();
        let Some(first) = selection.first().and_then(|&id| document.object(id)) else {
            kit::empty(
                ui,
                "Nothing is selected. Click an object, or its row in the outline.",
            );
            return;
        };
        egui::ScrollArea::vertical()
            .auto_shrink([false, true])
            .show(ui, |ui| {
                match selection.as_slice() {
                    &[id] => {
                        ui.strong(&first.name);
                        self.place(ui, id, first, unit, &mut ask);
                    }
                    several => {
                        ui.strong(format!("{} objects", several.len()));
                    }
                }
                if let Some((low, high)) = extent(document, selection.iter().copied()) {
                    ui.horizontal(|ui| {
                        ui.label("Size");
                        ui.label(units::size(high - low, unit))
                            .on_hover_text("Width, height, depth");
                    });
                }
                ui.separator();
                match (selection.as_slice(), first.reference()) {
                    (&[id], Some(reference)) => {
                        self.picture(ui, id, first, reference, unit, &mut ask);
                    }
                    (_, Some(_)) => {}
                    (_, None) => {
                        self.look(ui, document, selection, first, &mut ask);
                        let kept = &world.resource::<Settings>().palettes;
                        self.palettes.show(ui, kept, first, asks);
                        let shelf = world.resource::<MaterialShelf>();
                        self.material.show(ui, shelf, first, selection, &mut ask);
                    }
                }
                ui.separator();
                self.more(ui, &mut ask);
            });
        asks.extend(ask.into_iter().map(Command::Objects));
    }
}

impl Properties {
    fn place(
        &mut self,
        ui: &mut Ui,
        id: ObjectId,
        object: &Object,
        unit: Unit,
        ask: &mut Vec<Ask>,
    ) {
        let before = Numbers::of(&object.placement, unit);
        let held = self.place.filter(|(of, _)| *of == id);
        let mut now = held.map_or(before, |(_, n)| n);
        let mut busy = false;
        // Digits after the point: a tenth of a millimetre, of a degree.
        let fine = (4.0 - unit.per_metre().log10()).round().clamp(1.0, 4.0) as usize;
        let mut row = |ui: &mut Ui, name: &str, values: &mut Vec3, speed: f32, suffix: &str| {
            ui.label(name);
            let digits = match name {
                "Position" => fine,
                "Rotation" => 1,
                _ => 3,
            };
            for (axis, value) in
                ["X", "Y", "Z"]
                    .into_iter()
                    .zip([&mut values.x, &mut values.y, &mut values.z])
            {
                let drag = DragValue::new(value)
                    .speed(speed)
                    .max_decimals(digits)
                    .suffix(suffix);
                let field = ui
                    .add_enabled_ui(!object.locked, |ui| ui.add_sized([FIELD, 26.0], drag))
                    .inner
                    .on_hover_text(format!("{name} {axis}"));
                busy |= field.dragged() || field.has_focus();
            }
            ui.end_row();
        };
        egui::Grid::new("place")
            .num_columns(4)
            .spacing([6.0, 6.0])
            .show(ui, |ui| {
                row(
                    ui,
                    "Position",
                    &mut now.position,
                    0.5e-3 * unit.per_metre() as f32,
                    "",
                );
                row(ui, "Rotation", &mut now.degrees, 1.0, "°");
                row(ui, "Scale", &mut now.scale, 0.01, "");
            });
        ui.weak(format!("in {unit}"));
        // A scale of nothing would be no thing at all.
        for axis in 0..3 {
            if now.scale[axis].abs() < 1e-3 {
                now.scale[axis] = 1e-3_f32.copysign(before.scale[axis]);
            }
        }
        self.place = if busy {
            Some((id, now))
        } else {
            if now != before && held.is_some() {
                ask.push(Ask::Place(vec![(id, now.placement(unit))]));
            }
            None
        };
        if !busy && held.is_none() && now != before {
            ask.push(Ask::Place(vec![(id, now.placement(unit))]));
        }
    }

    fn look(
        &mut self,
        ui: &mut Ui,
        document: &Document,
        selection: &[ObjectId],
        first: &Object,
        ask: &mut Vec<Ask>,
    ) {
        let own = first.colour.map(|c| c.0);
        let mixed = selection
            .iter()
            .filter_map(|&id| document.object(id))
            .any(|o| o.colour != first.colour);
        ui.horizontal(|ui| {
            ui.label("Colour");
            let mut rgb = self.colour.or(own).unwrap_or([0xc9, 0xc4, 0xbc]);
            let picker = ui.color_edit_button_srgb(&mut rgb);
            let open = egui::Popup::is_any_open(ui.ctx());
            if picker.changed() {
                self.colour = Some(rgb);
            }
            // The picker changes it many times; one step is made when it is put away.
            if !open && let Some(chosen) = self.colour.take() {
                ask.push(colour(Some(chosen)));
            }
            let text = own.map_or(String::new(), hex);
            let mut typed = self.hex.clone().unwrap_or_else(|| text.clone());
            let field = ui.add(
                egui::TextEdit::singleline(&mut typed)
                    .hint_text(if mixed { "mixed" } else { "#rrggbb" })
                    .desired_width(72.0),
            );
            if field.changed() {
                self.hex = Some(typed.clone());
            }
            if field.lost_focus()
                && let Some(typed) = self.hex.take()
                && typed != text
            {
                match parse_hex(&typed) {
                    Some(rgb) => {
                        self.fault = None;
                        ask.push(colour(Some(rgb)));
                    }
                    None => {
                        self.fault = Some(format!(
                            "\"{typed}\" is no colour. Write six digits: #c04030."
                        ))
                    }
                }
            }
            let does = "Eyedropper: take the look of another object";
            if kit::icon_button(ui, icon::EYEDROPPER, does, false).clicked() {
                ask.push(Ask::Dropper { on: true });
            }
            if own.is_some()
                && ui
                    .button(icon::ARROW_COUNTER_CLOCKWISE)
                    .on_hover_text("No colour of its own")
                    .clicked()
            {
                ask.push(colour(None));
            }
        });
        if let Some(fault) = &self.fault {
            ui.colored_label(ui.visuals().warn_fg_color, fault);
        }
    }

    /// A picture to work from: how large it is, how much is seen through it.
    fn picture(
        &mut self,
        ui: &mut Ui,
        id: ObjectId,
        object: &Object,
        reference: &Reference,
        unit: Unit,
        ask: &mut Vec<Ask>,
    ) {
        let scale = object.placement.scale.abs();
        let before = (reference.size[0] * scale.x, reference.opacity);
        let held = self.picture.filter(|(of, ..)| *of == id);
        let (mut width, mut opacity) = held.map_or(before, |(_, w, o)| (w, o));
        let per_metre = unit.per_metre() as f32;
        let slope = reference.size[1] * scale.y / (reference.size[0] * scale.x);
        let mut busy = false;
        egui::Grid::new("picture")
            .num_columns(2)
            .spacing([16.0, 8.0])
            .show(ui, |ui| {
                let (least, most) = Reference::SIZES;
                for (name, factor) in [("Width", 1.0), ("Height", slope)] {
                    ui.label(name);
                    let mut value = width * factor * per_metre;
                    let drag = DragValue::new(&mut value)
                        .range(least * per_metre..=most * per_metre)
                        .speed(1e-3 * per_metre)
                        .max_decimals(3)
                        .suffix(format!(" {unit}"));
                    let field = ui
                        .add_enabled(!object.locked, drag)
                        .on_hover_text("The other side keeps the proportion");
                    if field.changed() && factor > 0.0 {
                        width = value / (factor * per_metre);
                    }
                    busy |= field.dragged() || field.has_focus();
                    ui.end_row();
                }
                ui.label("Opacity");
                let mut percent = opacity * 100.0;
                let slider = egui::Slider::new(&mut percent, 0.0..=100.0)
                    .suffix(" %")
                    .fixed_decimals(0);
                let field = ui.add(slider);
                if field.changed() {
                    opacity = percent / 100.0;
                }
                busy |= field.dragged() || field.has_focus();
                ui.end_row();
            });
        let mut locked = object.locked;
        if ui
            .checkbox(&mut locked, "Locked: hands pass through it")
            .changed()
        {
            ask.push(Ask::Locked {
                ids: Vec::new(),
                locked,
            });
        }
        let now = (width, opacity);
        if busy {
            self.picture = Some((id, width, opacity));
        } else {
            self.picture = None;
            if now != before {
                ask.push(Ask::Picture {
                    id,
                    width: (now.0 != before.0).then_some(now.0),
                    opacity: (now.1 != before.1).then_some(now.1),
                });
            }
        }
    }

    fn more(&mut self, ui: &mut Ui, ask: &mut Vec<Ask>) {
        ui.horizontal_wrapped(|ui| {
            for (text, hover, what) in [
                (icon::COPY, "Duplicate", Ask::Duplicate),
                (icon::FOLDER_SIMPLE_PLUS, "Group", Ask::Group),
                (icon::FOLDER_SIMPLE_MINUS, "Ungroup", Ask::Ungroup),
                (
                    icon::ARROW_LINE_DOWN,
                    "Put on the ground",
                    Ask::Ground { ids: Vec::new() },
                ),
                (icon::TRASH, "Delete", Ask::Delete),
            ] {
                if ui.button(text).on_hover_text(hover).clicked() {
                    ask.push(what);
                }
            }
        });
        ui.horizontal_wrapped(|ui| {
            ui.label("Mirror copy");
            for (name, axis) in [("X", Axis::X), ("Y", Axis::Y), ("Z", Axis::Z)] {
                if ui
                    .button(name)
                    .on_hover_text(format!(
                        "A mirror image across the plane through the origin, along {name}"
                    ))
                    .clicked()
                {
                    ask.push(Ask::Mirror { axis });
                }
            }
        });
        ui.horizontal_wrapped(|ui| {
            let count = self.around.get_or_insert(6);
            ui.label("Around the middle");
            ui.add(DragValue::new(count).range(2..=64));
            if ui
                .button("Copy")
                .on_hover_text("Copies evenly around the vertical through the origin")
                .clicked()
            {
                ask.push(Ask::Around { count: *count });
            }
        });
    }
}

fn colour(rgb: Option<[u8; 3]>) -> Ask {
    Ask::Colour {
        ids: Vec::new(),
        colour: rgb.map(Colour),
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn parse_hex(text: &str) -> Option<[u8; 3]> {
    let digits = text.trim().trim_start_matches('#');
    if digits.len() != 6 || !digits.is_ascii() {
        return None;
    }
    let part = |i: usize| u8::from_str_radix(digits.get(i..i + 2)?, 16).ok();
    Some([part(0)?, part(2)?, part(4)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_written_and_read() {
        assert_eq!(parse_hex("#c04030"), Some([0xc0, 0x40, 0x30]));
        assert_eq!(parse_hex(&hex([1, 2, 255])), Some([1, 2, 255]));
        for bad in ["", "#12", "#gggggg", "c040301", "ééé"] {
            assert_eq!(parse_hex(bad), None, "{bad}");
        }
    }

    #[test]
    fn nothing_has_no_sign() {
        let turned = Placement {
            rotation: Quat::from_euler(EulerRot::XYZ, -1e-7, -0.0, 1e-9),
            ..Placement::IDENTITY
        };
        let degrees = Numbers::of(&turned, Unit::Mm).degrees;
        for d in degrees.to_array() {
            assert!(d == 0.0 && d.is_sign_positive(), "{degrees}");
        }
        assert_eq!(shown(-14.9999), -14.9999);
    }

    #[test]
    fn numbers_say_where_a_thing_stands() {
        let placement = Placement {
            rotation: Quat::from_euler(EulerRot::XYZ, 0.3, -0.4, 1.0),
            ..Placement::at(Vec3::new(0.1, 0.2, -0.3))
        };
        let there = Numbers::of(&placement, Unit::Inch).placement(Unit::Inch);
        assert!(there.translation.distance(placement.translation) < 1e-6);
        assert!(there.rotation.angle_between(placement.rotation) < 1e-3);
    }
}
