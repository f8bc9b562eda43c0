//! The parts that panels are made of, so that the same thing looks the same everywhere.

use bevy_egui::egui::{
    Align, Button, Context, FontFamily, Id, Label, Layout, Margin, Response, RichText, Sense,
    Stroke, StrokeKind, TextEdit, TextStyle, Ui, Vec2, Widget, WidgetInfo, WidgetType,
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

/// A field for what one looks for, so many points wide.
pub fn search(ui: &mut Ui, query: &mut String, hint: &str, width: f32) -> Response {
    let field = TextEdit::singleline(query)
        .hint_text(format!("{}  {hint}", super::icon::MAGNIFYING_GLASS))
        .margin(Margin::symmetric(8, 6))
        .desired_width(width);
    ui.add(field)
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

/// Points across the names at the left of [`row`]s, in a column or a board of the usual width.
const NAMES: f32 = 112.0;
/// Points across the number beside a slider, with its unit, until a wider one was shown.
const NUMBER: f32 = 84.0;

/// One thing to set: its name at the left, what sets it at the right, below that of the row above. Sliders take what room
/// there is.
pub fn row<R>(ui: &mut Ui, name: &str, show: impl FnOnce(&mut Ui) -> R) -> R {
    wide_row(ui, NAMES.min(0.38 * ui.available_width()), name, show)
}

/// The same with names of so many points across, where they are longer.
pub fn wide_row<R>(ui: &mut Ui, across: f32, name: &str, show: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        let across = across.min(0.6 * ui.available_width());
        let size = Vec2::new(across, ui.spacing().interact_size.y);
        let left = Layout::left_to_right(Align::Center);
        ui.allocate_ui_with_layout(size, left, |ui| {
            ui.set_min_size(size);
            ui.add(Label::new(name).truncate());
        });
        beside_number(ui, name, show)
    })
    .inner
}

/// Shows a slider as wide as its number leaves room for: a row that is too wide would push its panel apart, further in each
/// frame. The widest number counts, so that one that comes and goes does so only once.
fn beside_number<R>(ui: &mut Ui, name: &str, show: impl FnOnce(&mut Ui) -> R) -> R {
    let key = ui.id().with(("number", name));
    let widest = ui.data(|d| d.get_temp(key)).unwrap_or(NUMBER + UNIT);
    let room = (ui.available_width() - widest).clamp(36.0, 240.0);
    ui.spacing_mut().slider_width = room;
    let from = ui.cursor().left();
    let shown = show(ui);
    let wide = (ui.min_rect().right() - from - room).max(widest);
    // What is no slider may be as wide as it likes.
    if wide > widest && wide < 2.0 * NUMBER {
        ui.data_mut(|d| d.insert_temp(key, wide));
    }
    shown
}

/// The same for what has a response of its own, which screen readers call by the name of the row.
pub fn field(ui: &mut Ui, name: &str, widget: impl Widget) -> Response {
    row(ui, name, |ui| {
        let response = ui.add(widget);
        let id = response.id;
        ui.ctx()
            .accesskit_node_builder(id, |node| node.set_label(name));
        response
    })
}

/// The same with the name above, for names of any length.
pub fn tall_field(ui: &mut Ui, name: &str, widget: impl Widget) -> Response {
    ui.add(Label::new(name).truncate());
    ui.horizontal(|ui| {
        let response = beside_number(ui, name, |ui| ui.add(widget));
        let id = response.id;
        ui.ctx()
            .accesskit_node_builder(id, |node| node.set_label(name));
        response
    })
    .inner
}

/// How wide a text is in a style, in points.
pub fn width(ui: &Ui, text: &str, style: TextStyle) -> f32 {
    let font = style.resolve(ui.style());
    let painter = ui.painter();
    let galley = painter.layout_no_wrap(text.to_owned(), font, ui.visuals().text_color());
    galley.size().x
}

/// How wide the cap of a key is, in points.
pub fn key_cap_width(ui: &Ui, key: &str) -> f32 {
    (width(ui, key, TextStyle::Small) + 12.0).max(20.0)
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
    let named = || WidgetInfo::labeled(WidgetType::Label, true, key);
    response.widget_info(named);
    let edge = Stroke::new(1.0, palette.line);
    ui.painter()
        .rect(rect, 4.0, palette.raised, edge, StrokeKind::Inside);
    ui.painter()
        .galley(rect.center() - 0.5 * galley.size(), galley, palette.text);
    response
}

/// By how many tabs the panel `id` is to be turned in this frame. A panel that asks has tabs.
pub fn turned(ctx: &Context, id: &str) -> i32 {
    let key = Id::new(("tabs", id));
    let by = ctx.data(|d| d.get_temp(key)).unwrap_or(0);
    ctx.data_mut(|d| d.insert_temp(key, 0));
    by
}

/// Turns the tabs of a panel; says whether it has any.
pub fn turn(ctx: &Context, id: &str, by: i32) -> bool {
    let key = Id::new(("tabs", id));
    let has = ctx.data(|d| d.get_temp::<i32>(key)).is_some();
    if has {
        ctx.data_mut(|d| d.insert_temp(key, by));
    }
    has
}

/// What one most likely wants of a panel: there the focus of a gamepad begins.
pub fn begin_at(ctx: &Context, panel: &str, widget: Id) {
    ctx.data_mut(|d| d.insert_temp(Id::new(("begin", panel)), widget));
}

/// What [`begin_at`] named last.
pub fn begins_at(ctx: &Context, panel: &str) -> Option<Id> {
    ctx.data(|d| d.get_temp(Id::new(("begin", panel))))
}

/// How far something that is shown has appeared, from 0 to 1: it eases in within the style's time.
/// To be asked in every frame in which it is shown.
pub fn appeared(ui: &Ui, id: Id) -> f32 {
    let key = id.with("appeared");
    let (now, pass) = (ui.input(|i| i.time), ui.ctx().cumulative_pass_nr());
    let (since, last): (f64, u64) = ui.data(|d| d.get_temp(key)).unwrap_or((now, 0));
    // Not shown in the pass before: it begins anew.
    let since = if last + 2 < pass { now } else { since };
    ui.data_mut(|d| d.insert_temp(key, (since, pass)));
    let takes = f64::from(ui.style().animation_time);
    let part = if takes > 0.0 {
        ((now - since) / takes).clamp(0.0, 1.0) as f32
    } else {
        1.0
    };
    if part < 1.0 {
        ui.ctx().request_repaint();
    }
    1.0 - (1.0 - part).powi(3)
}
