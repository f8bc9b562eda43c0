use bevy_egui::egui::{RichText, TextStyle, Ui};
use midair_document::Document;
use midair_field::Op;

use super::kit;
use super::style::operand_text;
use crate::show::Tint;

/// The marked sequence, read left to right: ((A ∪ B) ∩ C) − D.
pub fn operands(ui: &mut Ui, document: &Document) {
    let pending = document.pending();
    if pending.is_empty() {
        return;
    }
    // One line: the view is not to jump while one marks.
    ui.horizontal(|ui| {
        for (i, &(id, op)) in pending.iter().enumerate() {
            let name = document.object(id).map_or("?", |o| &o.name);
            let left = pending.len() - i;
            let wide = kit::width(ui, name, TextStyle::Body) + 24.0;
            if ui.available_width() < wide + if left > 1 { 80.0 } else { 0.0 } {
                ui.label(RichText::new(format!("… and {left} more")).weak());
                return;
            }
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
            ui.label(RichText::new(name).color(colour));
        }
    });
}
