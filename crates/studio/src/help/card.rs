//! The tutorial's small window: what to do now.

use bevy::prelude::World;

use super::{Keys, Tutorial};
use crate::command::Command;
use crate::panel::egui::{self, RichText, Sense, Ui, Vec2};
use crate::panel::{ACCENT, Panel, icon, kit};
use crate::settings::{Lesson, Progress, Settings};

use super::tutorial::TUTORIAL_PANEL;

pub(super) struct Card;

/// Points across.
const WIDTH: f32 = 320.0;

impl Panel for Card {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let progress = world.resource::<Settings>().help.tutorial;
        ui.set_width(WIDTH.min(ui.available_width()));
        match progress.state {
            Lesson::Offered => offer(ui, asks),
            Lesson::Done => done(ui, progress, asks),
            Lesson::Going | Lesson::Left => {
                let (tutorial, keys) = (world.resource::<Tutorial>(), world.resource::<Keys>());
                step(ui, progress, tutorial, keys, asks);
            }
        }
    }
}

fn set(progress: Progress) -> Command {
    Settings::command("help.tutorial", progress)
}

fn close() -> Command {
    Command::Panel {
        id: TUTORIAL_PANEL.to_owned(),
        open: false,
    }
}

fn begun() -> Progress {
    Progress {
        state: Lesson::Going,
        ..Progress::default()
    }
}

fn offer(ui: &mut Ui, asks: &mut Vec<Command>) {
    ui.label(RichText::new("New here?").strong());
    ui.label("Three small models in a few minutes: a cube and a sphere, a chair, a cup. You can leave at any time and go on later.");
    ui.horizontal_wrapped(|ui| {
        if kit::primary(ui, "Show me").clicked() {
            asks.push(set(begun()));
        }
        if ui
            .button("Not now")
            .on_hover_text("The cap in the bar above brings it back")
            .clicked()
        {
            asks.push(close());
        }
    });
}

fn step(
    ui: &mut Ui,
    progress: Progress,
    tutorial: &Tutorial,
    keys: &Keys,
    asks: &mut Vec<Command>,
) {
    let Some((task, place, step)) = tutorial.at(progress.step) else {
        return;
    };
    let (number, of) = tutorial.number(task);
    ui.label(RichText::new(format!("{number} of {of}: {}", task.title)).small());
    dots(ui, place, task.steps.len());
    ui.add_space(4.0);
    ui.label(RichText::new(step.text(keys)).size(16.0));
    if let Some(wrong) = tutorial.wrong() {
        ui.label(format!("{}  {}", icon::LIGHTBULB, keys.spell(wrong)));
    }
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        let back = egui::Button::new(format!("{} Back", icon::ARROW_LEFT));
        if ui.add_enabled(progress.step > 0, back).clicked() {
            asks.push(set(Progress {
                step: progress.step.saturating_sub(1),
                ..progress
            }));
        }
        let skip = ui.button(format!("Skip {}", icon::ARROW_RIGHT));
        if skip.on_hover_text("Go on without doing it").clicked() {
            let last = progress.step + 1 >= tutorial.len();
            asks.push(set(Progress {
                step: progress.step + 1,
                state: if last { Lesson::Done } else { Lesson::Going },
                ..progress
            }));
        }
        let later = ui.button("Later");
        if later
            .on_hover_text("It goes on here when you open it again")
            .clicked()
        {
            asks.push(close());
        }
    });
}

fn done(ui: &mut Ui, progress: Progress, asks: &mut Vec<Command>) {
    ui.label(RichText::new("That is all you need.").strong());
    ui.label(format!(
        "It took you {:.0} s. Newcomers of EasyVRModeling took 233 s on average.",
        progress.seconds
    ));
    ui.label("Next: drop a mesh of your own on the window, give parts a colour under Properties, or write an STL with File, Export.");
    ui.horizontal_wrapped(|ui| {
        if kit::primary(ui, "Close").clicked() {
            asks.push(close());
        }
        if ui.button("Once more").clicked() {
            asks.push(set(begun()));
        }
    });
}

/// One dot for each step of the task; those that are done are full.
fn dots(ui: &mut Ui, at: usize, of: usize) {
    let size = Vec2::new(14.0 * of as f32, 12.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    for i in 0..of {
        let centre = rect.left_center() + Vec2::new(14.0 * i as f32 + 6.0, 0.0);
        let painter = ui.painter();
        if i <= at {
            let radius = if i == at { 5.0 } else { 3.5 };
            painter.circle_filled(centre, radius, ACCENT);
        } else {
            let stroke = egui::Stroke::new(1.0, ui.visuals().weak_text_color());
            painter.circle_stroke(centre, 3.5, stroke);
        }
    }
    response.on_hover_text(format!("Step {} of {of}", at + 1));
}
