use bevy_egui::egui::{RichText, Ui};
use midair_document::Document;
use midair_field::Op;

use super::style::operand_text;
use crate::show::Tint;

/// The marked sequence, read left to right: ((A ∪ B) ∩ C) − D.
pub fn operands(ui: &mut Ui, document: &Document) {
    let pending = document.pending();
    if pending.is_empty() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for (i, &(id, op)) in pending.iter().enumerate() {
            let tint = match if i == 0 { Op::Union } else { op } {
                Op::Union => Tint::Union,
                Op::Intersect => Tint::Intersect,
                Op::Subtract => Tint::Subtract,
            };
            let colour = operand_text(tint, ui.visuals().dark_mode);
            if i > 0 {
                ui.label(
                    RichText::new(tint.sign().unwrap_or(""))
                        .color(colour)
                        .strong(),
                );
            }
            let name = document.object(id).map_or("?", |o| &o.name);
            ui.label(RichText::new(name).color(colour));
        }
    });
}
