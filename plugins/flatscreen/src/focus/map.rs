//! Where the focus can go: every widget of every panel, by panel.

use bevy_egui::egui::{self, Id, LayerId, Order, Rect, Sense, Vec2};

/// One widget that takes the focus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Its name in egui.
    pub id: Id,
    /// Where it is, in points.
    pub rect: Rect,
}

/// One panel, or another part of the window, with its widgets in the order in which they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// The panel's id; `bar` and `hints` for what is always there, `popup` for a menu or list.
    pub name: &'static str,
    /// Whether it can be closed.
    pub closes: bool,
    /// Whether it floats over the view, so that leaving it closes it.
    pub floats: bool,
    /// Its widgets.
    pub spots: Vec<Spot>,
}

impl Region {
    /// The widget that one is on at first; not the one that closes the panel again.
    pub(crate) fn first(&self) -> Spot {
        let own = usize::from(self.closes && self.name != "popup" && self.spots.len() > 1);
        self.spots[own]
    }
}

/// Collects the regions while panels are drawn.
pub(crate) struct Map {
    ctx: egui::Context,
    regions: Vec<Region>,
    begun: usize,
}

/// Smaller things are edges to drag and no widgets.
const LEAST: f32 = 10.0;

impl Map {
    pub fn new(ctx: &egui::Context) -> Self {
        Self {
            ctx: ctx.clone(),
            regions: Vec::new(),
            begun: 0,
        }
    }

    /// What is drawn on the background from here on is one region.
    pub fn begin(&mut self) {
        self.begun = self.count();
    }

    /// Up to here.
    pub fn end(&mut self, name: &'static str, closes: bool) {
        let begun = self.begun;
        let spots = self.spots(LayerId::background(), begun);
        self.push(name, closes, false, spots);
        self.begun = self.count();
    }

    /// Everything on a layer is one region.
    pub fn layer(&mut self, name: &'static str, layer: LayerId) {
        let spots = self.spots(layer, 0);
        self.push(name, true, true, spots);
    }

    /// The same for what stays where it is when one leaves it.
    pub fn corner(&mut self, name: &'static str, layer: LayerId) {
        let spots = self.spots(layer, 0);
        self.push(name, false, true, spots);
    }

    /// With the menu or list that is open, if one is.
    pub fn finish(mut self) -> Vec<Region> {
        if self.ctx.any_popup_open() {
            let top = self
                .ctx
                .memory(|m| m.areas().top_layer_id(Order::Foreground));
            if let Some(layer) = top {
                let spots = self.spots(layer, 0);
                self.push("popup", true, true, spots);
            }
        }
        // Whatever a plugin draws elsewhere is reached as well.
        let known: Vec<Id> = self
            .regions
            .iter()
            .flat_map(|r| &r.spots)
            .map(|s| s.id)
            .collect();
        let mut layers: Vec<LayerId> = self
            .ctx
            .viewport(|v| v.this_pass.widgets.layer_ids().collect());
        layers.sort_by_key(|l| (l.order, l.id.value()));
        let rest = layers
            .into_iter()
            .filter(|l| l.order < Order::Tooltip)
            .flat_map(|l| self.spots(l, 0))
            .filter(|s| !known.contains(&s.id))
            .collect();
        self.push("rest", false, false, rest);
        self.regions
    }

    fn push(&mut self, name: &'static str, closes: bool, floats: bool, spots: Vec<Spot>) {
        if !spots.is_empty() {
            self.regions.push(Region {
                name,
                closes,
                floats,
                spots,
            });
        }
    }

    fn count(&self) -> usize {
        let background = LayerId::background();
        self.ctx
            .viewport(|v| v.this_pass.widgets.get_layer(background).count())
    }

    fn spots(&self, layer: LayerId, skip: usize) -> Vec<Spot> {
        let found: Vec<(Spot, Sense)> = self.ctx.viewport(|v| {
            v.this_pass
                .widgets
                .get_layer(layer)
                .skip(skip)
                .filter(|w| w.enabled && w.sense.is_focusable())
                .filter(|w| w.rect.width() >= LEAST && w.rect.height() >= LEAST)
                .map(|w| {
                    let spot = Spot {
                        id: w.id,
                        rect: w.rect,
                    };
                    (spot, w.sense)
                })
                .collect()
        });
        let held = |spot: &Spot| {
            let others = found.iter().filter(|(other, _)| other.id != spot.id);
            others
                .filter(|(o, _)| spot.rect.contains_rect(o.rect))
                .count()
        };
        let all = found.len().saturating_sub(1);
        found
            .iter()
            // What lies behind all others is their ground; what is only dragged and lies behind any moves
            // a window.
            .filter(|(spot, sense)| match held(spot) {
                0 => true,
                some => sense.senses_click() && some < all,
            })
            .map(|(spot, _)| *spot)
            .collect()
    }
}

/// The spot next to `from` in a direction: what lies straight ahead, and aside only what lies more ahead
/// than aside.
pub(crate) fn next(spots: &[Spot], from: Rect, along: Vec2) -> Option<Spot> {
    let upright = along.x == 0.0;
    let score = |spot: &Spot| {
        let gap = spot.rect.center() - from.center();
        let ahead = gap.dot(along);
        let (overlap, least) = if upright {
            (
                spot.rect.x_range().intersection(from.x_range()).span(),
                from.height().min(spot.rect.height()),
            )
        } else {
            (
                spot.rect.y_range().intersection(from.y_range()).span(),
                from.width().min(spot.rect.width()),
            )
        };
        if ahead <= 0.4 * least.min(20.0) {
            return None;
        }
        if overlap > 1.0 {
            // A row begins at its left.
            let aside = if upright {
                (spot.rect.left() - from.left()).abs()
            } else {
                gap.y.abs()
            };
            return Some(ahead + 0.1 * aside);
        }
        let (one, other) = if upright {
            (spot.rect.x_range(), from.x_range())
        } else {
            (spot.rect.y_range(), from.y_range())
        };
        // Between their edges, so that a small arrow leads to the broad rows under it.
        let aside = (one.min - other.max).max(other.min - one.max).max(0.0);
        // In a row what lies straight ahead comes before anything above or below it.
        let row = if upright { 0.0 } else { 1e4 };
        (2.0 * aside <= ahead).then_some(ahead + 3.0 * aside + row)
    };
    spots
        .iter()
        .filter_map(|s| score(s).map(|score| (score, s)))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, s)| *s)
}

/// The spot nearest to where one was.
pub(crate) fn nearest(spots: &[Spot], to: Rect) -> Option<Spot> {
    let far = |s: &Spot| s.rect.center().distance_sq(to.center());
    spots
        .iter()
        .min_by(|a, b| far(a).total_cmp(&far(b)))
        .copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{pos2, vec2};

    /// Two columns of three buttons under a wide field.
    fn grid() -> Vec<Spot> {
        let mut spots = vec![Spot {
            id: Id::new("field"),
            rect: Rect::from_min_size(pos2(0.0, 0.0), vec2(210.0, 30.0)),
        }];
        for row in 0..3 {
            for column in 0..2 {
                let at = pos2(110.0 * column as f32, 40.0 + 40.0 * row as f32);
                spots.push(Spot {
                    id: Id::new((row, column)),
                    rect: Rect::from_min_size(at, vec2(100.0, 30.0)),
                });
            }
        }
        spots
    }

    #[test]
    fn the_focus_walks_a_grid() {
        let spots = grid();
        let step = |from: usize, along: Vec2| {
            next(&spots, spots[from].rect, along)
                .and_then(|s| spots.iter().position(|o| o.id == s.id))
        };
        assert_eq!(step(1, vec2(1.0, 0.0)), Some(2));
        assert_eq!(step(1, vec2(0.0, 1.0)), Some(3));
        assert_eq!(step(4, vec2(0.0, -1.0)), Some(2));
        assert_eq!(step(2, vec2(0.0, -1.0)), Some(0));
        assert_eq!(step(2, vec2(1.0, 0.0)), None);
        assert_eq!(step(6, vec2(0.0, 1.0)), None);
        assert_eq!(step(0, vec2(0.0, 1.0)), Some(1));
    }
}
