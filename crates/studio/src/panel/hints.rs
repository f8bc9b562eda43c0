use bevy_egui::egui::{Label, RichText, TextStyle, Ui};

use super::kit;
use crate::hands::Action;
use crate::tools::{HintKey, Hints};

/// What a way in calls an action: the key or button that does it.
pub type KeyNames<'a> = &'a dyn Fn(Action) -> String;

/// Points between two hints.
const GAP: f32 = 10.0;

/// What each button does now, on one line; `more` is what only this way in has, as key and meaning. What stands
/// first is the most useful; what has no room at the end is left out.
pub fn hints(ui: &mut Ui, hints: &Hints, names: KeyNames<'_>, more: &[(String, String)]) {
    let said = |action| {
        let mut all = hints.buttons.iter();
        all.any(|h| h.action == HintKey::Action(action))
    };
    let tools = hints.buttons.iter().filter_map(|hint| {
        let key = match hint.action {
            HintKey::Action(action) => {
                let two = hints.pairs.iter().find(|(two, _)| two.contains(&action));
                match two.filter(|(two, _)| two.iter().all(|&a| said(a))) {
                    Some(&([first, second], does)) if action == first => {
                        return Some((format!("{} {}", names(first), names(second)), does));
                    }
                    Some(_) => return None,
                    None => names(action),
                }
            }
            HintKey::Move => "move".to_owned(),
            HintKey::Swipe => "swipe".to_owned(),
        };
        Some((key, hint.does.as_str()))
    });
    let more = more.iter().map(|(key, does)| (key.clone(), does.as_str()));
    let all: Vec<_> = tools
        .chain(more)
        .filter(|(key, _)| !key.trim().is_empty())
        .collect();
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.add(Label::new(kit::strong(&hints.status)).truncate());
        let dots = kit::width(ui, "…", TextStyle::Body) + GAP;
        for (i, (key, does)) in all.iter().enumerate() {
            let wide = GAP
                + kit::key_cap_width(ui, key)
                + kit::width(ui, does, TextStyle::Body)
                + 3.0 * ui.spacing().item_spacing.x;
            let last = i + 1 == all.len();
            if ui.available_width() < wide + if last { 0.0 } else { dots } {
                ui.label(RichText::new("…").weak());
                return;
            }
            ui.add_space(GAP);
            kit::key_cap(ui, key);
            ui.label(RichText::new(*does).weak());
        }
    });
}
