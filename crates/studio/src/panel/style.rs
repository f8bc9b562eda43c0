use bevy_egui::egui::{
    self, Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, TextStyle, Vec2,
};

/// The one accent: none of the operands' colours.
pub const ACCENT: Color32 = Color32::from_rgb(0x8f, 0x7a, 0xe6);

/// One spacing unit, one radius, one shadow, two weights: every panel looks the same.
pub fn apply_style(ctx: &egui::Context) {
    let mut fonts = egui::FontDefinitions::default();
    if let Some(family) = fonts.families.get_mut(&FontFamily::Proportional) {
        // The only bundled font that has ∪ and ∩.
        family.push("Hack".to_owned());
    }
    egui_phosphor::add_to_fonts(&mut fonts, egui_phosphor::Variant::Regular);
    ctx.set_fonts(fonts);
    let mut style = (*ctx.global_style()).clone();
    style.text_styles = [
        (TextStyle::Heading, 18.0),
        (TextStyle::Body, 14.0),
        (TextStyle::Button, 14.0),
        (TextStyle::Small, 12.0),
    ]
    .map(|(s, size)| (s, FontId::new(size, FontFamily::Proportional)))
    .into_iter()
    .chain([(
        TextStyle::Monospace,
        FontId::new(13.0, FontFamily::Monospace),
    )])
    .collect();
    style.spacing.item_spacing = Vec2::splat(8.0);
    style.spacing.button_padding = Vec2::new(10.0, 5.0);
    style.spacing.interact_size.y = 28.0;
    let mut visuals = egui::Visuals::dark();
    let radius = CornerRadius::same(6);
    visuals.window_corner_radius = radius;
    visuals.menu_corner_radius = radius;
    visuals.window_fill = Color32::from_rgb(0x22, 0x24, 0x2a);
    visuals.panel_fill = Color32::from_rgb(0x22, 0x24, 0x2a);
    visuals.extreme_bg_color = Color32::from_rgb(0x17, 0x18, 0x1c);
    visuals.window_stroke = Stroke::new(1.0, Color32::from_rgb(0x38, 0x3b, 0x44));
    visuals.window_shadow = Shadow {
        offset: [0, 4],
        blur: 16,
        spread: 0,
        color: Color32::from_black_alpha(90),
    };
    visuals.popup_shadow = visuals.window_shadow;
    visuals.selection.bg_fill = ACCENT.gamma_multiply(0.65);
    visuals.override_text_color = Some(Color32::from_rgb(0xe6, 0xe4, 0xe0));
    for widget in [
        &mut visuals.widgets.noninteractive,
        &mut visuals.widgets.inactive,
        &mut visuals.widgets.hovered,
        &mut visuals.widgets.active,
        &mut visuals.widgets.open,
    ] {
        widget.corner_radius = radius;
    }
    visuals.widgets.inactive.weak_bg_fill = Color32::from_rgb(0x33, 0x36, 0x3f);
    visuals.widgets.hovered.weak_bg_fill = Color32::from_rgb(0x41, 0x45, 0x50);
    visuals.widgets.active.weak_bg_fill = ACCENT.gamma_multiply(0.8);
    style.visuals = visuals;
    style.spacing.window_margin = Margin::same(16);
    ctx.set_global_style(style);
}
