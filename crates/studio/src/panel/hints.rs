use bevy_egui::egui::{RichText, Ui};

use crate::hands::Action;
use crate::tools::{HintKey, Hints};

/// What a way in calls an action: the key or button that does it.
pub type KeyNames = fn(Action) -> &'static str;

/// What each button does now, on one line.
pub fn hints(ui: &mut Ui, hints: &Hints, names: KeyNames) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(&hints.status).strong());
        for hint in &hints.buttons {
            let key = match hint.action {
                HintKey::Action(action) => names(action),
                HintKey::Move => "move",
                HintKey::Swipe => "swipe",
            };
            if key.is_empty() {
                continue;
            }
            ui.separator();
            ui.label(RichText::new(key).strong().monospace());
            ui.label(&hint.does);
        }
    });
}
