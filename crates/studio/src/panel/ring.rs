//! The ring of modes: held open, it follows a stick, a pad or the pointer, and letting go chooses.

use std::f32::consts::TAU;

use bevy::math::Vec2;
use bevy_egui::egui::{self, Align2, FontId, Painter, Pos2, Stroke, TextStyle};

use super::{ACCENT, Palette};
use crate::tools::Tools;

/// Nearer to the middle than this part of its radius, nothing is chosen.
const MIDDLE: f32 = 0.35;

/// Which of `count` sectors lies in a direction, the first above, then clockwise; `None` near the middle.
/// `towards` has y up and is at most about 1 long.
pub fn sector(towards: Vec2, count: usize) -> Option<usize> {
    if count == 0 || towards.length() < MIDDLE {
        return None;
    }
    let around = towards.x.atan2(towards.y).rem_euclid(TAU);
    let each = TAU / count as f32;
    Some(((around / each).round() as usize) % count)
}

/// Draws the ring about `middle`: every mode, the one at hand, and the one that would be chosen.
pub fn ring(
    painter: &Painter,
    style: &egui::Style,
    middle: Pos2,
    radius: f32,
    tools: &Tools,
    chosen: Option<usize>,
) {
    let visuals = &style.visuals;
    let palette = Palette::of(visuals);
    painter.circle(
        middle,
        radius * 1.45,
        visuals.window_fill.gamma_multiply(0.94),
        visuals.window_stroke,
    );
    let all = tools.all();
    let font: FontId = TextStyle::Heading.resolve(style);
    for (i, tool) in all.iter().enumerate() {
        let around = TAU * i as f32 / all.len() as f32;
        let at = middle + radius * egui::vec2(around.sin(), -around.cos());
        let active = tools.active().is_some_and(|t| t.id == tool.id);
        let (fill, text) = if chosen == Some(i) {
            (palette.accent_fill, palette.on_fill)
        } else {
            (visuals.widgets.inactive.weak_bg_fill, visuals.text_color())
        };
        let galley = painter.layout_no_wrap(tool.name.to_owned(), font.clone(), text);
        let rect = egui::Rect::from_center_size(at, galley.size() + egui::vec2(28.0, 18.0));
        let edge = if active {
            Stroke::new(2.0, ACCENT)
        } else {
            visuals.window_stroke
        };
        painter.rect(rect, 6.0, fill, edge, egui::StrokeKind::Inside);
        painter.galley(rect.center() - 0.5 * galley.size(), galley, text);
    }
    let about = chosen
        .and_then(|i| all.get(i))
        .map_or("Let go over a mode", |t| t.about);
    painter.text(
        middle + egui::vec2(0.0, radius * 1.45 + 18.0),
        Align2::CENTER_CENTER,
        about,
        TextStyle::Body.resolve(style),
        visuals.text_color(),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_choose_clockwise_from_above() {
        assert_eq!(sector(Vec2::Y, 4), Some(0));
        assert_eq!(sector(Vec2::X, 4), Some(1));
        assert_eq!(sector(Vec2::NEG_Y, 4), Some(2));
        assert_eq!(sector(Vec2::NEG_X, 4), Some(3));
        assert_eq!(sector(Vec2::new(-0.1, 0.9), 4), Some(0));
        assert_eq!(sector(Vec2::new(0.1, 0.1), 4), None);
        assert_eq!(sector(Vec2::Y, 0), None);
        assert_eq!(sector(Vec2::NEG_X, 1), Some(0));
    }
}
