use bevy_egui::egui::{Color32, RichText, Ui};

use crate::hands::Action;
use crate::tools::{HintKey, Hints};

/// What a way in calls an action: the key or button that does it.
pub type KeyNames<'a> = &'a dyn Fn(Action) -> String;

/// What each button does now, on one line; `more` is what only this way in has, as key and meaning.
pub fn hints(ui: &mut Ui, hints: &Hints, names: KeyNames<'_>, more: &[(String, String)]) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.label(RichText::new(&hints.status).strong());
        let tools = hints.buttons.iter().map(|hint| {
            let key = match hint.action {
                HintKey::Action(action) => names(action),
                HintKey::Move => "move".to_owned(),
                HintKey::Swipe => "swipe".to_owned(),
            };
            (key, hint.does.as_str())
        });
        let more = more.iter().map(|(key, does)| (key.clone(), does.as_str()));
        for (key, does) in tools.chain(more) {
            if key.is_empty() {
                continue;
            }
            ui.add_space(10.0);
            let cap = RichText::new(format!(" {key} "))
                .color(Color32::from_gray(0xf2))
                .monospace()
                .background_color(Color32::from_rgb(0x3c, 0x40, 0x4b));
            ui.label(cap);
            ui.label(RichText::new(does).color(Color32::from_gray(0xc4)));
        }
    });
}
