//! The parts that panels are made of, so that the same thing looks the same everywhere.

use bevy_egui::egui::{
    Button, FontFamily, Response, RichText, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2,
    WidgetInfo, WidgetType,
};

use super::style::{FILLED, Palette, STRONG, UNIT};

/// Text in the heavier weight.
pub fn strong(text: impl Into<String>) -> RichText {
    RichText::new(text).family(FontFamily::Name(STRONG.into()))
}

/// A button that is an icon, filled while what it stands for is on; `does` is what it is for.
pub fn icon_button(ui: &mut Ui, glyph: &str, does: &str, on: bool) -> Response {
    let mut icon = RichText::new(glyph).size(18.0);
    if on {
        icon = icon.family(FontFamily::Name(FILLED.into()));
    }
    let button = Button::new(icon)
        .selected(on)
        .min_size(Vec2::splat(ui.spacing().interact_size.y))
        .frame_when_inactive(on);
    let response = ui.add(button).on_hover_text(does);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), does));
    response
}

/// What stands where nothing is yet, and what to do about it.
pub fn empty(ui: &mut Ui, text: &str) {
    ui.add_space(UNIT);
    ui.label(RichText::new(text).weak());
}

/// What comes first among buttons.
pub fn primary(ui: &mut Ui, text: &str) -> Response {
    let palette = Palette::of(ui.visuals());
    let text = strong(text).color(palette.on_fill);
    ui.add(Button::new(text).fill(palette.accent_fill))
}

/// A key, as a cap.
pub fn key_cap(ui: &mut Ui, key: &str) -> Response {
    let palette = Palette::of(ui.visuals());
    let font = TextStyle::Small.resolve(ui.style());
    let galley = ui
        .painter()
        .layout_no_wrap(key.to_owned(), font, palette.text);
    let size = galley.size() + Vec2::new(12.0, 4.0);
    let (rect, response) = ui.allocate_exact_size(size.max(Vec2::splat(20.0)), Sense::hover());
    let edge = Stroke::new(1.0, palette.line);
    ui.painter()
        .rect(rect, 4.0, palette.raised, edge, StrokeKind::Inside);
    ui.painter()
        .galley(rect.center() - 0.5 * galley.size(), galley, palette.text);
    response
}
