use bevy::prelude::World;
use bevy_egui::egui::Ui;

use super::Panel;
use crate::command::Command;
use crate::project::{Answer, Leaving, Project, Then};

/// Asks what becomes of work that is not saved.
#[derive(Default)]
pub(super) struct Leave;

impl Panel for Leave {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let project = world.resource::<Project>();
        let steps = project.history().undo_len();
        let before = match world.resource::<Leaving>().then() {
            Some(Then::New) => "before a new one is begun",
            Some(Then::Open(_)) => "before the other one is opened",
            Some(Then::Restore) => "before the earlier work is restored",
            Some(Then::Quit) | None => "before Midair ends",
        };
        ui.set_max_width(360.0);
        ui.label(format!(
            "{} has changes that are not saved ({steps} step{}). Save it {before}?",
            project.title(),
            if steps == 1 { "" } else { "s" },
        ));
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            for (text, answer) in [
                ("Save", Answer::Save),
                ("Don't save", Answer::Discard),
                ("Cancel", Answer::Stay),
            ] {
                let mut button = bevy_egui::egui::Button::new(text);
                if answer == Answer::Save {
                    button = button.selected(true);
                }
                if ui.add(button).clicked() {
                    asks.push(Command::Answer(answer));
                }
            }
        });
    }
}
