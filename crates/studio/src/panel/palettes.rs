//! Colours to choose from: a usual palette, and a person's own.

use bevy_egui::egui::{self, Color32, Ui};
use midair_document::{Colour, Object};

use super::{icon, kit};
use crate::command::Command;
use crate::objects::Ask;
use crate::settings::{PaletteSettings, Settings, Swatch};

/// What is being changed.
#[derive(Default)]
pub(super) struct Palettes {
    /// A click on a colour takes it away.
    editing: bool,
    /// The name that is being typed.
    name: Option<String>,
}

/// A few that go together, none of them an operand's.
const USUAL: [(&str, [u8; 3]); 12] = [
    ("Chalk", [0xe9, 0xe4, 0xda]),
    ("Stone", [0xa8, 0xa2, 0x98]),
    ("Slate", [0x5d, 0x63, 0x6b]),
    ("Ink", [0x2b, 0x2e, 0x35]),
    ("Clay", [0xb0, 0x6a, 0x4c]),
    ("Brick", [0x96, 0x3c, 0x36]),
    ("Rose", [0xc9, 0x7f, 0x8d]),
    ("Plum", [0x75, 0x4a, 0x72]),
    ("Denim", [0x44, 0x5d, 0x7e]),
    ("Lagoon", [0x4a, 0x8c, 0x93]),
    ("Moss", [0x6f, 0x7d, 0x46]),
    ("Straw", [0xcf, 0xb4, 0x74]),
];

/// What the usual palette is called.
const USUAL_NAME: &str = "Midair";

impl Palettes {
    /// The swatches and what can be done with them; `first` is what is selected.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        settings: &PaletteSettings,
        first: &Object,
        asks: &mut Vec<Command>,
    ) {
        self.choose(ui, settings, first, asks);
        self.swatches(ui, settings, asks);
        if self.editing && settings.current().is_some() {
            self.edit(ui, settings, asks);
        }
    }

    fn choose(
        &mut self,
        ui: &mut Ui,
        settings: &PaletteSettings,
        first: &Object,
        asks: &mut Vec<Command>,
    ) {
        ui.horizontal_wrapped(|ui| {
            let name = |at: usize| match at.checked_sub(1).and_then(|at| settings.own.get(at)) {
                Some(own) => own.name.as_str(),
                None => USUAL_NAME,
            };
            egui::ComboBox::from_id_salt("palette")
                .selected_text(name(settings.shown))
                .width(120.0)
                .show_ui(ui, |ui| {
                    for at in 0..=settings.own.len() {
                        if ui
                            .selectable_label(at == settings.shown, name(at))
                            .clicked()
                        {
                            asks.push(Settings::command("palettes.shown", at));
                        }
                    }
                });
            if kit::icon_button(ui, icon::PLUS, "Keep this colour and material", false).clicked() {
                let swatch = Swatch {
                    colour: first.colour.unwrap_or(Colour(midair_solid::PLAIN)),
                    material: first.material.clone(),
                };
                change(settings.with(swatch), asks);
            }
            if kit::icon_button(ui, icon::FOLDER_SIMPLE_PLUS, "New palette", false).clicked() {
                self.editing = true;
                change(settings.with_palette(), asks);
            }
            let own = settings.current().is_some();
            ui.add_enabled_ui(own, |ui| {
                let does = if self.editing {
                    "Done with changing the palette"
                } else {
                    "Change the palette: its name, what is in it"
                };
                let editing = self.editing && own;
                if kit::icon_button(ui, icon::PENCIL_SIMPLE, does, editing).clicked() {
                    self.editing = !self.editing;
                    self.name = None;
                }
            });
        });
    }

    fn swatches(&self, ui: &mut Ui, settings: &PaletteSettings, asks: &mut Vec<Command>) {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
            let Some(own) = settings.current() else {
                for (name, rgb) in USUAL {
                    if swatch(ui, rgb, name) {
                        asks.push(colour(Colour(rgb)));
                    }
                }
                return;
            };
            if own.swatches.is_empty() {
                ui.weak(format!(
                    "Nothing kept yet: {} keeps what is selected.",
                    icon::PLUS
                ));
            }
            for (at, kept) in own.swatches.iter().enumerate() {
                let Colour([r, g, b]) = kept.colour;
                let what = match &kept.material {
                    Some(material) => format!("#{r:02x}{g:02x}{b:02x}, {material}"),
                    None => format!("#{r:02x}{g:02x}{b:02x}"),
                };
                let does = if self.editing {
                    format!("Take {what} away")
                } else {
                    what
                };
                if !swatch(ui, kept.colour.0, &does) {
                    continue;
                }
                if self.editing {
                    change(settings.without(at), asks);
                } else if kept.material.is_some() {
                    asks.push(Command::Objects(Ask::Look {
                        ids: Vec::new(),
                        colour: Some(kept.colour),
                        material: kept.material.clone(),
                    }));
                } else {
                    asks.push(colour(kept.colour));
                }
            }
        });
    }

    fn edit(&mut self, ui: &mut Ui, settings: &PaletteSettings, asks: &mut Vec<Command>) {
        let Some(own) = settings.current() else {
            return;
        };
        ui.horizontal_wrapped(|ui| {
            let name = self.name.get_or_insert_with(|| own.name.clone());
            let field = ui
                .add(egui::TextEdit::singleline(name).desired_width(140.0))
                .on_hover_text("What the palette is called");
            if field.lost_focus()
                && let Some(name) = self.name.take()
            {
                change(settings.renamed(&name), asks);
            }
            if kit::icon_button(ui, icon::TRASH, "Take the whole palette away", false).clicked() {
                self.name = None;
                self.editing = false;
                change(settings.without_palette(), asks);
            }
        });
        ui.weak("Click a colour to take it away.");
    }
}

fn change(next: Option<PaletteSettings>, asks: &mut Vec<Command>) {
    if let Some(next) = next {
        asks.push(Settings::command("palettes", next));
    }
}

fn colour(colour: Colour) -> Command {
    Command::Objects(Ask::Colour {
        ids: Vec::new(),
        colour: Some(colour),
    })
}

/// A colour to press; says whether it was.
fn swatch(ui: &mut Ui, [r, g, b]: [u8; 3], does: &str) -> bool {
    let button = egui::Button::new("")
        .fill(Color32::from_rgb(r, g, b))
        .min_size(egui::vec2(24.0, 24.0));
    let response = ui.add(button).on_hover_text(does);
    let enabled = ui.is_enabled();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, enabled, does));
    response.clicked()
}
