//! What an object is made of, and what can be set of it: rows for any panel.

use bevy_egui::egui::{Slider, Ui};
use midair_document::{Dials, Object, ObjectId};
use midair_solid::MaterialInfo;

use super::kit;
use crate::materials::MaterialShelf;
use crate::objects::Ask;

/// The rows, with a number while it is dragged.
#[derive(Debug, Default)]
pub struct MaterialRows {
    dragged: Option<(String, f32)>,
}

impl MaterialRows {
    /// The materials to choose from and the dials of the one that `first` has; what is asked is for all of `ids`.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        shelf: &MaterialShelf,
        first: &Object,
        ids: &[ObjectId],
        asks: &mut Vec<Ask>,
    ) {
        let now = shelf.all().at(shelf.all().place(first));
        let missing = first
            .material
            .as_deref()
            .filter(|id| shelf.all().find(id).is_none());
        if let Some(chosen) = choose(ui, shelf, missing.is_none().then_some(now.id.as_str())) {
            asks.push(Ask::Material {
                ids: ids.to_vec(),
                material: Some(chosen.id.clone()),
                dials: Dials::new(),
            });
        }
        if let Some(missing) = missing {
            ui.weak(format!("\"{missing}\" is not here; it looks plain."));
        }
        for (dial, set) in now.dials.iter().zip(now.values(first)) {
            let held = self.dragged.as_ref().filter(|(id, _)| *id == dial.id);
            let mut value = held.map_or(set, |(_, value)| *value);
            let slider = Slider::new(&mut value, dial.range()).max_decimals(3);
            let response = kit::tall_field(ui, &dial.name, slider);
            let ended = response.drag_stopped() || (response.changed() && !response.dragged());
            if !response.changed() && !ended {
                continue;
            }
            self.dragged = (!ended).then(|| (dial.id.clone(), value));
            asks.push(Ask::Dial {
                ids: ids.to_vec(),
                dial: dial.id.clone(),
                value,
                done: ended,
            });
        }
    }
}

/// All materials, that of the name `now` marked; which one was pressed.
pub fn choose<'a>(
    ui: &mut Ui,
    shelf: &'a MaterialShelf,
    now: Option<&str>,
) -> Option<&'a MaterialInfo> {
    let mut chosen = None;
    ui.label("Material");
    ui.horizontal_wrapped(|ui| {
        for info in shelf.all().iter() {
            let row = ui.selectable_label(now == Some(&info.id), &info.name);
            let row = if info.about.is_empty() {
                row
            } else {
                row.on_hover_text(&info.about)
            };
            if row.clicked() {
                chosen = Some(info);
            }
        }
    });
    chosen
}
