//! The parts that panels are made of, so that the same thing looks the same everywhere.

use std::ops::RangeInclusive;

use bevy_egui::egui::{
    self, Align, Align2, Button, Color32, DragValue, FontFamily, FontId, Layout, Rect, Response,
    RichText, Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo, WidgetType,
};

use super::style::{ACCENT, FILLED, Palette, RADIUS, STRONG, UNIT};

/// Text in the heavier weight.
pub fn strong(text: impl Into<String>) -> RichText {
    RichText::new(text).family(FontFamily::Name(STRONG.into()))
}

/// An icon: filled where what it stands for is on.
pub fn icon(glyph: &str, on: bool) -> RichText {
    let text = RichText::new(glyph).size(18.0);
    if on {
        text.family(FontFamily::Name(FILLED.into()))
    } else {
        text
    }
}

/// The title of a part of a panel.
pub fn section(ui: &mut Ui, title: &str) {
    ui.add_space(UNIT);
    ui.label(strong(title));
}

/// A name on the left and what belongs to it on the right.
pub fn row<R>(ui: &mut Ui, name: &str, value: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        ui.label(name);
        ui.with_layout(Layout::right_to_left(Align::Center), value)
            .inner
    })
    .inner
}

/// A button that is an icon; `does` is what it is for.
pub fn icon_button(ui: &mut Ui, glyph: &str, does: &str, on: bool) -> Response {
    let button = Button::new(icon(glyph, on))
        .selected(on)
        .min_size(Vec2::splat(28.0));
    let response = ui.add(button).on_hover_text(does);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), does));
    response
}

/// A switch with its name; says whether it was thrown.
pub fn toggle(ui: &mut Ui, on: &mut bool, name: &str) -> bool {
    row(ui, name, |ui| {
        let (rect, mut response) = ui.allocate_exact_size(Vec2::new(36.0, 20.0), Sense::click());
        if response.clicked() {
            *on = !*on;
            response.mark_changed();
        }
        response
            .widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, ui.is_enabled(), *on, name));
        let palette = Palette::of(ui.visuals());
        let visuals = ui.style().interact(&response);
        let along = ui.ctx().animate_bool_responsive(response.id, *on);
        let fill = visuals.bg_fill.lerp_to_gamma(palette.accent_fill, along);
        let edge = if response.has_focus() {
            Stroke::new(2.0, ACCENT)
        } else {
            Stroke::new(1.0, palette.line)
        };
        let painter = ui.painter();
        painter.rect(rect, 10.0, fill, edge, StrokeKind::Outside);
        let x = egui::lerp(rect.left() + 10.0..=rect.right() - 10.0, along);
        let knob = palette.weak.lerp_to_gamma(palette.on_fill, along);
        painter.circle_filled(egui::pos2(x, rect.center().y), 7.0, knob);
        response.changed()
    })
}

/// One of a few; says whether another was chosen.
pub fn choice<T: PartialEq + Copy>(ui: &mut Ui, value: &mut T, all: &[(T, &str)]) -> bool {
    let before = *value;
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for &(one, name) in all {
            ui.selectable_value(value, one, name);
        }
    });
    *value != before
}

/// A number with its unit: dragged, or typed.
pub fn number(
    ui: &mut Ui,
    value: &mut f32,
    range: RangeInclusive<f32>,
    speed: f32,
    unit: &str,
) -> Response {
    let drag = DragValue::new(value)
        .range(range)
        .speed(speed)
        .max_decimals(3)
        .suffix(unit);
    ui.add_sized(Vec2::new(80.0, ui.spacing().interact_size.y), drag)
}

/// A card with a picture, or with `glyph` until there is one, and a name below.
pub fn tile(
    ui: &mut Ui,
    side: f32,
    picture: Option<egui::TextureId>,
    glyph: &str,
    name: &str,
    chosen: bool,
) -> Response {
    let line = ui.text_style_height(&TextStyle::Small);
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(side, side + line + UNIT), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        let palette = Palette::of(ui.visuals());
        let visuals = ui.style().interact(&response);
        let edge = if chosen || response.has_focus() {
            Stroke::new(2.0, ACCENT)
        } else {
            visuals.bg_stroke
        };
        let fill = if chosen {
            palette.hovered
        } else {
            visuals.bg_fill
        };
        let painter = ui.painter_at(rect.expand(2.0));
        painter.rect(rect, RADIUS, fill, edge, StrokeKind::Inside);
        let inner = Rect::from_min_size(rect.min, Vec2::splat(side)).shrink(4.0);
        match picture {
            Some(picture) => {
                let uv = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
                painter.image(picture, inner, uv, Color32::WHITE);
            }
            None => {
                let font = FontId::proportional(0.4 * side);
                painter.text(
                    inner.center(),
                    Align2::CENTER_CENTER,
                    glyph,
                    font,
                    palette.weak,
                );
            }
        }
        let mut job = egui::text::LayoutJob::simple_singleline(
            name.to_owned(),
            TextStyle::Small.resolve(ui.style()),
            palette.text,
        );
        job.wrap = egui::text::TextWrapping::truncate_at_width(side - UNIT);
        let galley = painter.layout_job(job);
        let at = egui::pos2(
            rect.center().x - 0.5 * galley.size().x,
            rect.bottom() - galley.size().y - 5.0,
        );
        painter.galley(at, galley, palette.text);
    }
    response.on_hover_text(name)
}

/// What stands where nothing is yet, and what to do about it.
pub fn empty(ui: &mut Ui, text: &str) {
    ui.add_space(UNIT);
    ui.label(RichText::new(text).weak());
}

/// What comes first among buttons.
pub fn primary(ui: &mut Ui, text: &str) -> Response {
    filled(ui, text, |p| p.accent_fill)
}

/// What cannot be taken back.
pub fn danger(ui: &mut Ui, text: &str) -> Response {
    filled(ui, text, |p| p.danger_fill)
}

fn filled(ui: &mut Ui, text: &str, fill: fn(&Palette) -> Color32) -> Response {
    let palette = Palette::of(ui.visuals());
    let text = strong(text).color(palette.on_fill);
    ui.add(Button::new(text).fill(fill(&palette)))
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

/// A row of a list over the whole width.
pub fn list_row(ui: &mut Ui, glyph: &str, text: &str, chosen: bool) -> Response {
    let size = Vec2::new(ui.available_width(), ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::SelectableLabel, ui.is_enabled(), chosen, text)
    });
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact_selectable(&response, chosen);
        if chosen || response.hovered() || response.has_focus() {
            let (fill, edge) = (visuals.weak_bg_fill, visuals.bg_stroke);
            ui.painter()
                .rect(rect, RADIUS, fill, edge, StrokeKind::Inside);
        }
        let colour = visuals.text_color();
        let painter = ui.painter_at(rect);
        let body = TextStyle::Body.resolve(ui.style());
        let left = rect.left_center() + Vec2::new(UNIT, 0.0);
        painter.text(left, Align2::LEFT_CENTER, glyph, body.clone(), colour);
        let text_at = left + Vec2::new(3.0 * UNIT, 0.0);
        painter.text(text_at, Align2::LEFT_CENTER, text, body, colour);
    }
    response
}
