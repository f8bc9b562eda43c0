use bevy_egui::egui::{RichText, Ui};

use super::kit;
use crate::hands::Action;
use crate::tools::{HintKey, Hints};

/// What a way in calls an action: the key or button that does it.
pub type KeyNames<'a> = &'a dyn Fn(Action) -> String;

/// What each button does now, on one line; `more` is what only this way in has, as key and meaning.
pub fn hints(ui: &mut Ui, hints: &Hints, names: KeyNames<'_>, more: &[(String, String)]) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.label(kit::strong(&hints.status));
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
            kit::key_cap(ui, &key);
            ui.label(RichText::new(does).weak());
        }
    });
}
