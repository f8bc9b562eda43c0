//! What sweeps become, and what can be done with the selected one.

use bevy::prelude::World;
use midair_document::Object;
use midair_studio::{
    command::Command,
    panel::{
        Panel,
        egui::{Button, ComboBox, Slider, Ui},
        kit,
    },
    project::{Project, Selection, Shelf},
    settings::{Settings, SweepHands, SweepItem, SweepSettings, SweepShape},
};
use midair_swept::Profile;

use crate::act::target;
use crate::ask::SweepAsk;
use crate::free;
use crate::phase::{Draft, Phase};

/// The number that is being dragged, until it is let go.
#[derive(Default)]
pub(crate) struct SweepPanel {
    held: Option<(&'static str, f32)>,
}

impl Panel for SweepPanel {
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let settings = &world.resource::<Settings>().sweep;
        let before = settings.clone();
        let mut now = before.clone();
        ui.horizontal(|ui| {
            for shape in SweepShape::ALL {
                ui.selectable_value(&mut now.shape, shape, capital(shape.name()));
            }
        });
        if now.shape == SweepShape::Clones {
            self.clones(ui, world, &mut now);
        } else {
            self.number(ui, "Points along it", &mut now.count, 2.0..=256.0, 0, "");
            if now.shape == SweepShape::Tube {
                ui.checkbox(&mut now.caps, "Caps: closed and full");
            }
            if now.shape == SweepShape::Surface || !now.caps {
                let mut mm = now.thickness * 1e3;
                self.number(ui, "Thickness", &mut mm, 0.0..=100.0, 1, " mm");
                now.thickness = mm * 1e-3;
            }
            self.number(ui, "Smoothing", &mut now.smooth, 0.0..=20.0, 0, "");
        }
        ui.separator();
        kit::row(ui, "Hands", |ui| {
            for (hands, name) in [
                (SweepHands::Auto, "any"),
                (SweepHands::Two, "two"),
                (SweepHands::One, "one"),
            ] {
                ui.selectable_value(&mut now.hands, hands, name);
            }
        });
        ui.checkbox(&mut now.springy, "Springy: the ends swing and sink");
        changes(&before, &now, asks);
        ui.separator();
        self.selected(ui, world, asks);
    }
}

impl SweepPanel {
    fn clones(&mut self, ui: &mut Ui, world: &World, now: &mut SweepSettings) {
        let library = &world.resource::<Shelf>().library;
        let document = world.resource::<Project>().document();
        let name = match &now.item {
            SweepItem::Component(id) => library.get(id).map_or(id.clone(), |c| c.name.clone()),
            SweepItem::Object(id) => document
                .object(midair_document::ObjectId(*id))
                .map_or("gone".to_owned(), |o| o.name.clone()),
        };
        kit::row(ui, "Clone", |ui| {
            ComboBox::from_id_salt("Clone")
                .selected_text(name)
                .show_ui(ui, |ui| {
                    for (id, object) in document.objects().filter(|(_, o)| o.recipe().is_some()) {
                        let item = SweepItem::Object(id.0);
                        ui.selectable_value(&mut now.item, item, &object.name);
                    }
                    for component in library.categories().flat_map(|(_, all)| all) {
                        let item = SweepItem::Component(component.id.clone());
                        ui.selectable_value(&mut now.item, item, &component.name);
                    }
                });
        });
        self.number(ui, "How many", &mut now.clones, 1.0..=256.0, 0, "");
        let mut mm = now.clone_size * 1e3;
        self.number(ui, "Longest side", &mut mm, 1.0..=400.0, 0, " mm");
        now.clone_size = mm * 1e-3;
        ui.checkbox(&mut now.paced, "Smaller where they stand closer");
        ui.checkbox(&mut now.spread, "All over the surface");
    }

    fn selected(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>) {
        let project = world.resource::<Project>();
        let draft = world.resource::<Draft>();
        let selection = world.resource::<Selection>();
        let found = target(project, selection);
        let clones = free::selected_row(project.document(), selection);
        if let (None, Some((_, object, row, _))) = (found, clones) {
            let (count, each) = (row.len(), row.count);
            ui.label(kit::strong(&object.name));
            ui.weak(format!("{count} clones"));
            let mut next = each;
            if self.number(ui, "How many of it", &mut next, 1.0..=256.0, 0, "") && next != each {
                asks.push(SweepAsk::Clones(next).command());
            }
            follows(ui, project, object, asks);
            let few = count <= free::MOST;
            let does = "Each becomes an object on its own";
            let button = ui.add_enabled(few, Button::new("Take it apart"));
            if button.on_hover_text(does).clicked() {
                asks.push(SweepAsk::Apart.command());
            }
            return;
        }
        let Some(object) = found.and_then(|id| project.document().object(id)) else {
            kit::empty(ui, "Select a sweep to change it.");
            return;
        };
        let Some(sweep) = object.sweep() else { return };
        ui.label(kit::strong(&object.name));
        ui.weak(format!("{} curves", sweep.ribs.len()));
        follows(ui, project, object, asks);
        let mut count = sweep.count;
        if self.number(ui, "Points of it", &mut count, 2.0..=256.0, 0, "") && count != sweep.count {
            asks.push(SweepAsk::Count(count).command());
        }
        if sweep.profile == Profile::Tube {
            let mut caps = sweep.caps;
            if ui.checkbox(&mut caps, "Closed and full").changed() {
                asks.push(SweepAsk::Caps(caps).command());
            }
        }
        if sweep.profile == Profile::Sheet || !sweep.caps {
            let mut mm = sweep.thickness * 1e3;
            if self.number(ui, "Its thickness", &mut mm, 0.0..=100.0, 1, " mm")
                && (mm - sweep.thickness * 1e3).abs() > 1e-3
            {
                asks.push(SweepAsk::Thickness(mm * 1e-3).command());
            }
        }
        ui.horizontal_wrapped(|ui| {
            if ui.button("Smooth").clicked() {
                asks.push(SweepAsk::Smooth(1).command());
            }
            let editing = matches!(draft.phase, Phase::Editing { .. });
            let bend = Button::new("Bend its curves").selected(editing);
            if ui.add(bend).clicked() {
                asks.push(SweepAsk::Edit.command());
            }
            if ui.button("Sweep on").clicked() {
                asks.push(SweepAsk::Extend.command());
            }
            if ui.button("Cut in the middle").clicked() {
                asks.push(SweepAsk::Cut(sweep.ribs.len() / 2).command());
            }
        });
    }

    /// A slider that changes its number when it is let go. Whether it did in this frame.
    fn number<N: midair_studio::panel::egui::emath::Numeric>(
        &mut self,
        ui: &mut Ui,
        name: &'static str,
        value: &mut N,
        range: std::ops::RangeInclusive<f32>,
        decimals: usize,
        unit: &str,
    ) -> bool {
        let held = self.held.filter(|(n, _)| *n == name).map(|h| h.1);
        let mut now = held.unwrap_or(value.to_f64() as f32);
        let slider = Slider::new(&mut now, range)
            .fixed_decimals(decimals)
            .suffix(unit);
        let response = kit::field(ui, name, slider);
        if response.dragged() || response.has_focus() && response.changed() {
            self.held = Some((name, now));
            return false;
        }
        if response.drag_stopped()
            || response.changed()
            || (held.is_some() && !response.has_focus())
        {
            self.held = None;
            *value = N::from_f64(f64::from(now));
            return true;
        }
        false
    }
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or(String::new(), |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// One command for each number that changed.
fn changes(before: &SweepSettings, now: &SweepSettings, asks: &mut Vec<Command>) {
    macro_rules! each {
        ($($field:ident),*) => {
            $(
                if before.$field != now.$field {
                    let key = concat!("sweep.", stringify!($field));
                    asks.push(Settings::command(key, &now.$field));
                }
            )*
        };
    }
    each!(
        shape, count, thickness, caps, hands, springy, smooth, item, clones, clone_size, paced,
        spread
    );
}

/// What it follows, and the way to end that.
fn follows(ui: &mut Ui, project: &Project, object: &Object, asks: &mut Vec<Command>) {
    if object.links.is_empty() {
        return;
    }
    let names = object.links.iter();
    let names = names.filter_map(|l| Some(&*project.document().object(l.source)?.name));
    let names: Vec<_> = names.collect();
    ui.horizontal_wrapped(|ui| {
        ui.label(format!("Follows {}", names.join(" and ")));
        if ui.button("Free it").clicked() {
            asks.push(SweepAsk::Free.command());
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changed_is_asked_for_and_nothing_else() {
        let before = SweepSettings::default();
        let now = SweepSettings {
            count: 64,
            item: SweepItem::Object(3),
            ..before.clone()
        };
        let mut asks = Vec::new();
        changes(&before, &now, &mut asks);
        let mut settings = Settings::default();
        for ask in &asks {
            let Command::Set { key, value } = ask else {
                panic!("a setting");
            };
            settings.set(key, value).unwrap();
        }
        assert_eq!(asks.len(), 2);
        assert_eq!(settings.sweep, now);
    }
}
