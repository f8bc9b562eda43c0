//! What every board has: a bar to move it by, and a cross to close it.

use midair_studio::panel::egui::{self, Color32, Pos2, Rect, RichText, Sense, Ui, UiBuilder, vec2};
use midair_studio::panel::{Palette, icon};

/// Points from the top that belong to the bar.
pub const BAR: f32 = 44.0;
/// Points within the edge.
const MARGIN: f32 = 14.0;

/// What was pressed in the bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Pressed {
    pub close: bool,
}

/// Whether a press here moves the board.
pub(crate) fn moves(point: Pos2, size: egui::Vec2) -> bool {
    point.y < BAR && point.x < size.x - BAR
}

/// Draws the ground and the bar, then the body below it; says what was pressed and how tall all of it is.
pub(super) fn framed(
    ui: &mut Ui,
    sign: &str,
    title: &str,
    closable: bool,
    grows: bool,
    body: impl FnOnce(&mut Ui),
) -> (Pressed, f32) {
    let whole = ui.max_rect();
    let palette = Palette::of(ui.visuals());
    let painter = ui.painter().clone();
    painter.rect_filled(whole, 0.0, palette.panel);
    let bar = Rect::from_min_size(whole.min, vec2(whole.width(), BAR));
    painter.rect_filled(bar, 0.0, palette.raised);
    // A handle, as on everything that can be taken.
    let grip = Rect::from_center_size(bar.center_top() + vec2(0.0, 7.0), vec2(56.0, 4.0));
    painter.rect_filled(grip, 2.0, palette.weak.gamma_multiply(0.6));
    let text = bar.shrink2(vec2(MARGIN, 0.0));
    let mut row = ui.new_child(
        UiBuilder::new()
            .max_rect(text)
            .layout(egui::Layout::left_to_right(egui::Align::Center)),
    );
    row.add(
        egui::Label::new(RichText::new(format!("{sign}  {title}")).heading()).selectable(false),
    );
    let mut pressed = Pressed::default();
    if closable {
        let at = Rect::from_min_size(bar.right_top() - vec2(BAR, 0.0), vec2(BAR, BAR));
        let response = ui.interact(at, ui.id().with("close"), Sense::click());
        let fill = if response.hovered() {
            palette.hovered
        } else {
            Color32::TRANSPARENT
        };
        painter.rect_filled(at, 0.0, fill);
        painter.text(
            at.center(),
            egui::Align2::CENTER_CENTER,
            icon::X,
            egui::FontId::proportional(18.0),
            palette.text,
        );
        pressed.close = response.clicked();
    }
    let below = Rect::from_min_max(whole.min + vec2(0.0, BAR), whole.max).shrink(MARGIN);
    let mut inner = ui.new_child(UiBuilder::new().max_rect(below));
    let used = if grows {
        let shown = egui::ScrollArea::vertical()
            .auto_shrink([false, true])
            .show(&mut inner, |ui| {
                ui.set_width(ui.available_width());
                body(ui);
            });
        shown.content_size.y
    } else {
        body(&mut inner);
        below.height()
    };
    (pressed, BAR + 2.0 * MARGIN + used)
}
