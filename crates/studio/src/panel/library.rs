use bevy_egui::egui::{self, Ui};

use crate::command::Command;
use crate::hands::Side;
use crate::project::Shelf;

/// The library: search, then every component by category. Picking one places it at `side`.
///
/// `query` is the search text, edited in place.
pub fn library(ui: &mut Ui, shelf: &Shelf, query: &mut String, side: Side) -> Vec<Command> {
    let mut asks = Vec::new();
    ui.horizontal(|ui| {
        let search = egui::TextEdit::singleline(query)
            .hint_text("Search")
            .desired_width(ui.available_width() - 8.0);
        ui.add(search);
    });
    egui::ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            let mut shown = 0;
            if query.trim().is_empty() {
                for (category, components) in shelf.library.categories() {
                    egui::CollapsingHeader::new(category)
                        .default_open(shown == 0)
                        .show(ui, |ui| {
                            buttons(ui, components.iter(), side, &mut asks);
                        });
                    shown += components.len();
                }
            } else {
                let found = shelf.library.search(query);
                shown = found.len();
                buttons(ui, found.into_iter(), side, &mut asks);
            }
            if shown == 0 {
                ui.label("Nothing is called that. Try a shape: cube, leg, handle, star.");
            }
        });
    asks
}

fn buttons<'a>(
    ui: &mut Ui,
    components: impl Iterator<Item = &'a midair_library::Component>,
    side: Side,
    asks: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        for component in components {
            let button = egui::Button::new(&component.name).min_size([96.0, 30.0].into());
            let response = ui.add_enabled(!component.missing, button);
            if response.clicked() {
                asks.push(Command::Place {
                    component: component.id.clone(),
                    side,
                });
            }
            response.on_disabled_hover_text("Its mesh is gone. Import it again.");
        }
    });
}
