use bevy_egui::egui::{self, Ui};

use crate::command::Command;
use crate::hands::Side;
use crate::project::Shelf;

/// A column of the shelf is at least this wide, in points.
const COLUMN: f32 = 112.0;

/// The shelf as a panel.
#[derive(Default)]
pub(super) struct LibraryPanel {
    /// What is typed into the search field.
    query: String,
}

impl super::Panel for LibraryPanel {
    fn show(&mut self, ui: &mut Ui, world: &bevy::prelude::World, asks: &mut Vec<Command>) {
        // At which hand is the way in's to say.
        let shelf = world.resource::<Shelf>();
        asks.extend(library(ui, shelf, &mut self.query, Side::Right));
    }
}

/// The library: search, then every component by category. Picking one places it at `side`.
///
/// `query` is the search text, edited in place.
pub fn library(ui: &mut Ui, shelf: &Shelf, query: &mut String, side: Side) -> Vec<Command> {
    let mut asks = Vec::new();
    let search = egui::TextEdit::singleline(query)
        .hint_text("Search")
        .margin(egui::Margin::symmetric(8, 6))
        .desired_width(f32::INFINITY);
    ui.add(search);
    ui.add_space(4.0);
    egui::ScrollArea::vertical()
        .auto_shrink([false, false])
        .show(ui, |ui| {
            let mut shown = 0;
            if query.trim().is_empty() {
                for (category, components) in shelf.library.categories() {
                    // What the user made is what is looked for.
                    let open = shown == 0 || category == midair_library::OWN;
                    egui::CollapsingHeader::new(egui::RichText::new(category).strong())
                        .default_open(open)
                        .show_unindented(ui, |ui| {
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
            ui.add_space(8.0);
        });
    asks
}

fn buttons<'a>(
    ui: &mut Ui,
    components: impl Iterator<Item = &'a midair_library::Component>,
    side: Side,
    asks: &mut Vec<Command>,
) {
    let gap = ui.spacing().item_spacing.x;
    let room = ui.available_width() - 4.0;
    let columns = ((room + gap) / (COLUMN + gap)).floor().max(1.0);
    let width = (room + gap) / columns - gap;
    let components: Vec<_> = components.collect();
    for row in components.chunks(columns as usize) {
        ui.horizontal(|ui| {
            for component in row {
                let button = egui::Button::new(&component.name)
                    .truncate()
                    .min_size([width, 30.0].into());
                let sized = |ui: &mut Ui| ui.add_sized([width, 30.0], button);
                let response = ui.add_enabled_ui(!component.missing, sized).inner;
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
}
