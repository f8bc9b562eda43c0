//! Which panels there are and which are open.

use std::collections::{BTreeMap, BTreeSet};

use bevy::prelude::*;
use bevy_egui::egui::Ui;

use crate::command::Command;

/// Where a panel stands on a screen; in a room each is a quad of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dock {
    /// A column beside the view, away from the leading hand.
    Left,
    /// A column on the other side, stacked with others.
    Right,
    /// A window that floats over the view.
    Window,
    /// A small window in the lower left corner of the view, out of the way of the work.
    Corner,
    /// A question that is answered before anything else.
    Modal,
}

/// What the studio knows of a panel without showing it.
#[derive(Clone, Copy, Debug)]
pub struct PanelInfo {
    /// Its name in sessions and settings, never changed.
    pub id: &'static str,
    /// What people read.
    pub title: &'static str,
    /// One of [`icon`](super::icon).
    pub icon: &'static str,
    /// Where it stands.
    pub dock: Dock,
    /// Its place among its neighbours, smallest first.
    pub order: i32,
    /// Whether it is open at the start.
    pub open: bool,
    /// Whether the bar has a button for it.
    pub in_bar: bool,
}

/// A panel: a function of the world to what it asks for. What it holds is what is being typed or
/// dragged in it, never the truth.
pub trait Panel: Send + Sync + 'static {
    /// Draws it once and says what was asked for.
    fn show(&mut self, ui: &mut Ui, world: &World, asks: &mut Vec<Command>);
}

/// The panels that are plugged in.
#[derive(Resource, Default)]
pub struct Panels {
    infos: Vec<PanelInfo>,
    open: BTreeMap<&'static str, bool>,
    // Apart from the rest, so that one can be shown while the world is read.
    shows: BTreeMap<&'static str, Box<dyn Panel>>,
    /// Those of modes that were left with their panel open.
    left: BTreeSet<&'static str>,
}

impl Panels {
    /// All of them, in order.
    pub fn all(&self) -> &[PanelInfo] {
        &self.infos
    }

    /// Those of a dock that are open, in order.
    pub fn open_in(&self, dock: Dock) -> Vec<PanelInfo> {
        let open = |i: &&PanelInfo| i.dock == dock && self.is_open(i.id);
        self.infos.iter().filter(open).copied().collect()
    }

    /// Whether a panel is to be seen.
    pub fn is_open(&self, id: &str) -> bool {
        self.open.get(id).copied().unwrap_or(false)
    }

    /// Shows or hides a panel; says whether there is one of that name.
    pub fn set_open(&mut self, id: &str, open: bool) -> bool {
        match self.open.get_mut(id) {
            Some(slot) => {
                *slot = open;
                self.left.remove(id);
                true
            }
            None => false,
        }
    }

    /// Another mode is taken: the panel of the one that is left goes, since it sets nothing there, and is there again
    /// with its mode.
    pub(super) fn turn_to(&mut self, mode: &str, is_mode: impl Fn(&str) -> bool) {
        for info in &self.infos {
            let Some(open) = self.open.get_mut(info.id).filter(|_| is_mode(info.id)) else {
                continue;
            };
            if info.id == mode {
                *open |= self.left.remove(info.id);
            } else if std::mem::replace(open, false) {
                self.left.insert(info.id);
            }
        }
    }

    /// Takes what draws a panel out while the world is read; [`Panels::put_back`] returns it.
    pub fn take(&mut self, id: &'static str) -> Option<Box<dyn Panel>> {
        self.shows.remove(id)
    }

    /// Returns what [`Panels::take`] took.
    pub fn put_back(&mut self, id: &'static str, panel: Box<dyn Panel>) {
        self.shows.insert(id, panel);
    }
}

/// Plugs a panel in.
pub trait AddPanel {
    /// Adds `panel`; one of the same id is replaced.
    fn add_panel(&mut self, info: PanelInfo, panel: impl Panel) -> &mut Self;
}

impl AddPanel for App {
    fn add_panel(&mut self, info: PanelInfo, panel: impl Panel) -> &mut Self {
        let mut panels = self.world_mut().get_resource_or_init::<Panels>();
        panels.infos.retain(|i| i.id != info.id);
        panels.infos.push(info);
        panels.infos.sort_by_key(|i| (i.order, i.id));
        panels.open.insert(info.id, info.open);
        panels.shows.insert(info.id, Box::new(panel));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Bare;

    impl Panel for Bare {
        fn show(&mut self, _: &mut Ui, _: &World, _: &mut Vec<Command>) {}
    }

    #[test]
    fn the_panel_of_a_mode_that_is_left_goes_and_comes_with_it() {
        let mut app = App::new();
        for id in ["sweep", "brush", "outline"] {
            let info = PanelInfo {
                id,
                title: id,
                icon: "",
                dock: Dock::Right,
                order: 0,
                open: false,
                in_bar: true,
            };
            app.add_panel(info, Bare);
        }
        let mut panels = app.world_mut().resource_mut::<Panels>();
        let is_mode = |id: &str| id != "outline";
        panels.set_open("sweep", true);
        panels.set_open("outline", true);
        panels.turn_to("brush", is_mode);
        assert!(!panels.is_open("sweep") && panels.is_open("outline"));
        panels.turn_to("sweep", is_mode);
        assert!(panels.is_open("sweep") && !panels.is_open("brush"));
        panels.set_open("sweep", false);
        panels.turn_to("brush", is_mode);
        panels.turn_to("sweep", is_mode);
        assert!(!panels.is_open("sweep"), "what was shut stays shut");
    }
}
