//! The focus: every button of every panel by keys or gamepad, while Tab and the arrows stay the hands'.
//!
//! F6 (or the left stick's click) goes into the panels and from one to the next; there Tab, the
//! arrows or the D-pad move, Enter, Space or A press, Esc or B leave.

mod drive;
mod map;
mod typing;

use bevy::prelude::*;
use bevy_egui::egui::{self, Rect, WidgetType};

pub(crate) use drive::drive;
pub(crate) use map::Map;
pub use map::{Region, Spot};
use midair_studio::panel::{ACCENT, kit};
pub use typing::Typing;
pub(crate) use typing::show as keyboard;

/// Where the focus is.
#[derive(Resource, Default)]
pub struct Focus {
    inside: bool,
    regions: Vec<Region>,
    /// What has it.
    spot: Option<Spot>,
    /// Of what kind that is.
    kind: Option<WidgetType>,
    /// It takes letters.
    text: bool,
    /// What is written on it.
    label: String,
    /// The region that had it last.
    region: &'static str,
    /// What takes it in the next pass.
    given: Option<egui::Id>,
    /// A panel that was opened by the gamepad and takes the focus once it is drawn.
    wanted: Option<String>,
    /// What was open in the frame before.
    open: Vec<&'static str>,
    /// What of a slider's way is left over, in steps.
    slid: f32,
}

impl Focus {
    /// Whether keys and buttons go to a panel.
    pub fn is_inside(&self) -> bool {
        self.inside
    }

    /// Everything that can have it, as drawn last.
    pub fn regions(&self) -> &[Region] {
        &self.regions
    }

    /// What has it.
    pub fn spot(&self) -> Option<Spot> {
        self.spot.filter(|_| self.inside)
    }

    /// The region that has it.
    pub fn region(&self) -> Option<&Region> {
        self.regions.iter().find(|r| r.name == self.region)
    }

    /// What is written on what has it.
    pub fn label(&self) -> &str {
        if self.inside { &self.label } else { "" }
    }

    /// Whether it is in a field that takes letters.
    pub fn is_text(&self) -> bool {
        self.inside && self.text
    }

    /// The panel takes it as soon as it is there.
    pub fn want(&mut self, panel: &str) {
        self.wanted = Some(panel.to_owned());
    }

    /// Back to the view.
    pub fn leave(&mut self) {
        self.inside = false;
        self.wanted = None;
        self.given = None;
    }

    fn is_slider(&self) -> bool {
        matches!(self.kind, Some(WidgetType::Slider | WidgetType::DragValue))
    }

    /// Before anything is drawn: a widget notices that it gains the focus only within a pass.
    pub(crate) fn begin(&mut self, ctx: &egui::Context) {
        if let Some(id) = self.given.take() {
            ctx.memory_mut(|m| m.request_focus(id));
        }
    }

    /// After everything is drawn: what there is, what has the focus, and the ring around it.
    pub(crate) fn settle(&mut self, ctx: &egui::Context, map: Map) {
        // A menu finds its size in the pass in which it appears.
        let ready = self.regions.iter().any(|r| r.name == "popup");
        self.regions = map.finish();
        let gained = ctx.output(|o| {
            o.events.iter().rev().find_map(|e| match e {
                egui::output::OutputEvent::FocusGained(info) => {
                    Some((info.typ, info.label.clone().unwrap_or_default()))
                }
                _ => None,
            })
        });
        if let Some((kind, label)) = gained {
            self.kind = Some(kind);
            self.label = label;
        }
        if let Some(name) = &self.wanted
            && let Some(region) = self.regions.iter().find(|r| r.name == *name)
        {
            // By gamepad one begins at what one most likely wants.
            let likely = kit::begins_at(ctx, name)
                .and_then(|id| region.spots.iter().find(|s| s.id == id).copied());
            let (name, first) = (region.name, likely.unwrap_or(region.first()));
            self.region = name;
            self.inside = true;
            self.wanted = None;
            self.give(ctx, first);
        }
        if !self.inside {
            // Tab is the hands': a button that it led to would take every shortcut.
            if !ctx.text_edit_focused()
                && let Some(focused) = ctx.memory(|m| m.focused())
            {
                ctx.memory_mut(|m| m.surrender_focus(focused));
            }
            return;
        }
        // A menu that has opened takes it, and gives it back when it closes.
        if ready
            && self.region != "popup"
            && let Some(popup) = self.regions.iter().find(|r| r.name == "popup")
        {
            let first = popup.first();
            self.region = "popup";
            self.give(ctx, first);
        }
        self.text = self.given.is_none() && ctx.text_edit_focused();
        let focused = self.given.or(ctx.memory(|m| m.focused()));
        let found = focused.and_then(|id| {
            self.regions.iter().find_map(|r| {
                let spot = r.spots.iter().find(|s| s.id == id)?;
                Some((r.name, *spot))
            })
        });
        match found {
            Some((region, spot)) => {
                self.region = region;
                self.spot = Some(spot);
            }
            None => self.recover(ctx),
        }
        if let Some(spot) = self.spot {
            ring(ctx, spot.rect);
        }
    }

    /// What had the focus is gone: what stands nearest to it takes it.
    fn recover(&mut self, ctx: &egui::Context) {
        let before = self.spot.map_or(Rect::ZERO, |s| s.rect);
        let spots = self
            .region()
            .or(self.regions.first())
            .map(|r| (r.name, &r.spots));
        match spots.and_then(|(name, spots)| Some((name, map::nearest(spots, before)?))) {
            Some((name, spot)) => {
                self.region = name;
                self.give(ctx, spot);
            }
            None => {
                self.inside = false;
                self.spot = None;
            }
        }
    }

    fn give(&mut self, ctx: &egui::Context, spot: Spot) {
        self.spot = Some(spot);
        self.kind = None;
        self.label.clear();
        self.given = Some(spot.id);
        ctx.request_repaint();
    }
}

/// The ring that shows where the focus is.
fn ring(ctx: &egui::Context, rect: Rect) {
    let layer = egui::LayerId::new(egui::Order::Tooltip, egui::Id::new("focus"));
    let painter = ctx.layer_painter(layer);
    let stroke = egui::Stroke::new(2.0, ACCENT);
    painter.rect_stroke(rect.expand(3.0), 8.0, stroke, egui::StrokeKind::Outside);
}
