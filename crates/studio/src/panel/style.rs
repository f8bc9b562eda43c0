//! How every panel looks: colours, type, spacing.

use bevy::color::ColorToPacked;
use bevy_egui::egui::{
    self, Color32, CornerRadius, FontData, FontDefinitions, FontFamily, FontId, Margin, Shadow,
    Stroke, TextStyle, Vec2, Visuals, style::WidgetVisuals,
};

use crate::settings::{LookSettings, RoomKind};
use crate::show::Tint;

/// The one accent: none of the operands' colours. Lines and rings, on dark and on light.
pub const ACCENT: Color32 = Color32::from_rgb(0x8f, 0x7a, 0xe6);

/// The one spacing unit, in points.
pub const UNIT: f32 = 8.0;

/// The one radius of corners, in points.
pub const RADIUS: u8 = 6;

/// The family of the second, heavier weight.
pub const STRONG: &str = "strong";

/// The family of filled icons: those of what is on.
pub const FILLED: &str = "filled";

/// The colours of panels, dark or light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// Behind everything.
    pub panel: Color32,
    /// Behind what is typed.
    pub sunken: Color32,
    /// Behind what can be pressed.
    pub raised: Color32,
    /// The same under the pointer.
    pub hovered: Color32,
    /// The same while it is pressed.
    pub pressed: Color32,
    /// Boxes to tick and rails of sliders: to be seen on a panel without a word on them.
    pub control: Color32,
    /// Between things.
    pub line: Color32,
    /// What is read.
    pub text: Color32,
    /// What is read second.
    pub weak: Color32,
    /// Behind what is chosen or comes first; [`Palette::on_fill`] is read on it.
    pub accent_fill: Color32,
    /// On that.
    pub on_fill: Color32,
    /// What went wrong, as text.
    pub warn: Color32,
}

const DARK: Palette = Palette {
    panel: Color32::from_rgb(0x22, 0x24, 0x2a),
    sunken: Color32::from_rgb(0x17, 0x18, 0x1c),
    raised: Color32::from_rgb(0x33, 0x36, 0x3f),
    hovered: Color32::from_rgb(0x41, 0x45, 0x50),
    pressed: Color32::from_rgb(0x58, 0x49, 0xa0),
    control: Color32::from_rgb(0x58, 0x5c, 0x68),
    line: Color32::from_rgb(0x3a, 0x3d, 0x46),
    text: Color32::from_rgb(0xe8, 0xe6, 0xe2),
    weak: Color32::from_rgb(0xb6, 0xb8, 0xbf),
    accent_fill: Color32::from_rgb(0x68, 0x55, 0xc4),
    on_fill: Color32::WHITE,
    warn: Color32::from_rgb(0xff, 0xb4, 0x8a),
};

const LIGHT: Palette = Palette {
    panel: Color32::from_rgb(0xf6, 0xf6, 0xf5),
    sunken: Color32::from_rgb(0xff, 0xff, 0xff),
    raised: Color32::from_rgb(0xe5, 0xe5, 0xe6),
    hovered: Color32::from_rgb(0xd8, 0xd8, 0xdb),
    pressed: Color32::from_rgb(0xcd, 0xc4, 0xf3),
    control: Color32::from_rgb(0xb9, 0xba, 0xc1),
    line: Color32::from_rgb(0xce, 0xce, 0xd2),
    text: Color32::from_rgb(0x22, 0x24, 0x2a),
    weak: Color32::from_rgb(0x50, 0x53, 0x5b),
    accent_fill: Color32::from_rgb(0x5e, 0x4a, 0xbe),
    on_fill: Color32::WHITE,
    warn: Color32::from_rgb(0x8f, 0x3f, 0x10),
};

impl Palette {
    /// That of a room: dark panels in the dark one, light ones in the others.
    pub fn of_room(room: RoomKind) -> Self {
        match room {
            RoomKind::Dusk => DARK,
            RoomKind::Day | RoomKind::Paper => LIGHT,
        }
    }

    /// That of what is being drawn.
    pub fn of(visuals: &Visuals) -> Self {
        if visuals.dark_mode { DARK } else { LIGHT }
    }
}

/// An operand's colour as text: lighter on dark panels, darker on light ones, so that it reads.
pub fn operand_text(tint: Tint, dark: bool) -> Color32 {
    let [r, g, b, _] = tint.colour().to_srgba().to_u8_array();
    let shade = |c: u8| {
        if dark {
            c.saturating_add(40)
        } else {
            (u16::from(c) / 2) as u8
        }
    };
    Color32::from_rgb(shade(r), shade(g), shade(b))
}

/// The colours of panels in a room, as egui takes them.
pub fn visuals(room: RoomKind) -> Visuals {
    let palette = Palette::of_room(room);
    let dark = palette == DARK;
    let mut visuals = if dark {
        Visuals::dark()
    } else {
        Visuals::light()
    };
    let radius = CornerRadius::same(RADIUS);
    visuals.window_corner_radius = radius;
    visuals.menu_corner_radius = radius;
    visuals.window_fill = palette.panel;
    visuals.panel_fill = palette.panel;
    visuals.faint_bg_color = palette.panel.lerp_to_gamma(palette.raised, 0.4);
    visuals.extreme_bg_color = palette.sunken;
    visuals.text_edit_bg_color = Some(palette.sunken);
    visuals.code_bg_color = palette.raised;
    visuals.window_stroke = Stroke::new(1.0, palette.line);
    visuals.window_shadow = Shadow {
        offset: [0, 4],
        blur: 16,
        spread: 0,
        color: Color32::from_black_alpha(if dark { 90 } else { 40 }),
    };
    visuals.popup_shadow = visuals.window_shadow;
    visuals.selection.bg_fill = palette.accent_fill;
    visuals.selection.stroke = Stroke::new(1.0, palette.on_fill);
    visuals.weak_text_color = Some(palette.weak);
    visuals.warn_fg_color = palette.warn;
    visuals.error_fg_color = palette.warn;
    visuals.hyperlink_color = if dark {
        Color32::from_rgb(0xc2, 0xb7, 0xf8)
    } else {
        palette.accent_fill
    };
    visuals.slider_trailing_fill = true;
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, palette.line);
    visuals.widgets.noninteractive.fg_stroke = Stroke::new(1.0, palette.text);
    visuals.widgets.noninteractive.corner_radius = radius;
    let widget = |fill: Color32, edge: Stroke| WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: edge,
        corner_radius: radius,
        fg_stroke: Stroke::new(1.5, palette.text),
        expansion: 0.0,
    };
    visuals.widgets.inactive = widget(palette.raised, Stroke::NONE);
    visuals.widgets.inactive.bg_fill = palette.control;
    visuals.widgets.hovered = widget(palette.hovered, Stroke::new(1.0, palette.line));
    visuals.widgets.open = widget(palette.hovered, Stroke::new(1.0, palette.line));
    // The focus by keyboard is drawn as what is pressed: its edge has to be seen.
    visuals.widgets.active = widget(palette.pressed, Stroke::new(1.5, ACCENT));
    visuals
}

/// The typeface, in two weights, with the icons; once, before anything is drawn.
pub fn install_fonts(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
}

/// Whether the typeface is there: until then nothing may be drawn in it.
pub fn has_fonts(ctx: &egui::Context) -> bool {
    let strong = FontFamily::Name(STRONG.into());
    ctx.fonts(|fonts| fonts.definitions().families.contains_key(&strong))
}

fn fonts() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    for (name, bytes) in [
        ("Noto Sans", notosans::REGULAR_TTF),
        ("Noto Sans Bold", notosans::BOLD_TTF),
    ] {
        fonts
            .font_data
            .insert(name.to_owned(), FontData::from_static(bytes).into());
    }
    if let Some(family) = fonts.families.get_mut(&FontFamily::Proportional) {
        family.insert(0, "Noto Sans".to_owned());
        // The only bundled font that has ∪ and ∩.
        family.push("Hack".to_owned());
    }
    egui_phosphor::add_to_fonts(&mut fonts, egui_phosphor::Variant::Regular);
    egui_phosphor::add_font_bytes_as_family(
        &mut fonts,
        FILLED,
        egui_phosphor::Variant::Fill.font_bytes(),
    );
    let mut strong = fonts
        .families
        .get(&FontFamily::Proportional)
        .cloned()
        .unwrap_or_default();
    if let Some(first) = strong.first_mut() {
        "Noto Sans Bold".clone_into(first);
    }
    fonts
        .families
        .insert(FontFamily::Name(STRONG.into()), strong);
    fonts
}

/// One spacing unit, one radius, one shadow, two weights: every panel looks the same. Called again
/// whenever the look is set anew.
pub fn apply_style(ctx: &egui::Context, look: &LookSettings) {
    let visuals = visuals(look.room);
    let theme = if visuals.dark_mode {
        egui::Theme::Dark
    } else {
        egui::Theme::Light
    };
    let mut style = (*ctx.style_of(theme)).clone();
    style.visuals = visuals;
    style.text_styles = [
        (TextStyle::Heading, 17.0, FontFamily::Name(STRONG.into())),
        (TextStyle::Body, 14.0, FontFamily::Proportional),
        (TextStyle::Button, 14.0, FontFamily::Proportional),
        (TextStyle::Small, 12.0, FontFamily::Proportional),
        (TextStyle::Monospace, 13.0, FontFamily::Monospace),
    ]
    .map(|(style, size, family)| (style, FontId::new(size, family)))
    .into();
    style.spacing.item_spacing = Vec2::splat(UNIT);
    style.spacing.button_padding = Vec2::new(10.0, 4.0);
    style.spacing.interact_size = Vec2::new(40.0, 28.0);
    // A box to tick has corners: smaller it would be as round as a dot.
    style.spacing.icon_width = 18.0;
    style.spacing.icon_width_inner = 10.0;
    style.spacing.window_margin = Margin::same(16);
    style.spacing.menu_margin = Margin::same(UNIT as i8);
    style.spacing.scroll.bar_width = UNIT;
    // What appears eases in; nothing does where somebody wants it still.
    style.animation_time = if look.motion { 0.12 } else { 0.0 };
    ctx.set_style_of(theme, style);
    ctx.set_theme(theme);
    // The setting is the one place that says how large things are.
    ctx.options_mut(|o| o.zoom_with_keyboard = false);
    let scale = look.interface_scale;
    ctx.set_zoom_factor(if scale.is_finite() {
        scale.clamp(0.5, 3.0)
    } else {
        1.0
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance, WCAG 2.2.
    fn luminance(c: Color32) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(c.r()) + 0.7152 * linear(c.g()) + 0.0722 * linear(c.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn contrast_is_wcags() {
        assert!((contrast(Color32::BLACK, Color32::WHITE) - 21.0).abs() < 1e-9);
        let grey = contrast(Color32::from_rgb(0x77, 0x77, 0x77), Color32::WHITE);
        assert!((grey - 4.478).abs() < 0.001, "{grey}");
    }

    #[test]
    fn every_text_can_be_read_on_what_is_behind_it() {
        for room in [RoomKind::Dusk, RoomKind::Day, RoomKind::Paper] {
            let v = visuals(room);
            let p = Palette::of_room(room);
            let behind = [
                ("panel", v.panel_fill),
                ("window", v.window_fill),
                ("stripe", v.faint_bg_color),
                ("field", v.text_edit_bg_color()),
                ("well", v.extreme_bg_color),
                ("code", v.code_bg_color),
                ("button", v.widgets.inactive.weak_bg_fill),
                ("button under the pointer", v.widgets.hovered.weak_bg_fill),
            ];
            let mut pairs = Vec::new();
            for (name, fill) in behind {
                pairs.push((format!("text on {name}"), v.text_color(), fill));
                pairs.push((
                    format!("strong text on {name}"),
                    v.strong_text_color(),
                    fill,
                ));
                pairs.push((format!("weak text on {name}"), v.weak_text_color(), fill));
                pairs.push((format!("a warning on {name}"), v.warn_fg_color, fill));
                pairs.push((format!("a fault on {name}"), v.error_fg_color, fill));
                pairs.push((format!("a link on {name}"), v.hyperlink_color, fill));
            }
            for (name, w) in [
                ("a button", v.widgets.inactive),
                ("a button under the pointer", v.widgets.hovered),
                ("a pressed button", v.widgets.active),
                ("an open list", v.widgets.open),
            ] {
                pairs.push((name.to_owned(), w.text_color(), w.weak_bg_fill));
                pairs.push((format!("{name}, filled"), w.text_color(), w.bg_fill));
            }
            pairs.push((
                "what is chosen".into(),
                v.selection.stroke.color,
                v.selection.bg_fill,
            ));
            for tint in [Tint::Union, Tint::Intersect, Tint::Subtract] {
                let text = operand_text(tint, v.dark_mode);
                pairs.push((format!("{tint:?}"), text, v.panel_fill));
            }
            pairs.push(("what comes first".into(), p.on_fill, p.accent_fill));
            for (name, text, fill) in pairs {
                assert_eq!(fill.a(), 255, "{room:?}: {name} is seen through");
                let ratio = contrast(text, fill);
                assert!(ratio >= 4.5, "{room:?}: {name} has {ratio:.2} : 1");
            }
            // Not text, but it has to be found: 3 : 1.
            for fill in [v.panel_fill, v.extreme_bg_color] {
                assert!(contrast(ACCENT, fill) >= 3.0, "{room:?}: the ring");
            }
        }
    }

    #[test]
    fn figures_stand_below_each_other_and_every_sign_is_there() {
        let ctx = egui::Context::default();
        install_fonts(&ctx);
        apply_style(&ctx, &LookSettings::default());
        let _ = ctx.run_ui(egui::RawInput::default(), |ui| {
            for family in [FontFamily::Proportional, FontFamily::Name(STRONG.into())] {
                let font = FontId::new(14.0, family.clone());
                ui.ctx().fonts_mut(|fonts| {
                    let one = fonts.glyph_width(&font, '1');
                    for digit in '0'..='9' {
                        assert_eq!(fonts.glyph_width(&font, digit), one, "{family:?}: {digit}");
                    }
                    // Signs of operands and numbers, and the marks of construction lines.
                    for sign in "∪∩−×°…½∞●○⟂‖=∠·".chars() {
                        assert!(fonts.has_glyph(&font, sign), "{family:?}: {sign}");
                    }
                });
            }
        });
    }
}
