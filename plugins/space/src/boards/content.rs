//! What is on each board, and how large things on it are.

use bevy::prelude::World;
use midair_studio::command::Command;
use midair_studio::panel::egui::{self, Context, FontFamily, FontId, TextStyle, Ui, Vec2, vec2};
use midair_studio::panel::{self, Dock, Files, PanelInfo, Panels, icon};
use midair_studio::settings::LookSettings;
use midair_studio::tools::Tools;

use super::bar::{BAR, framed};
use super::{BoardId, wrist};
use crate::ring::Ring;

/// The most that a board is tall, in points; what has more scrolls.
pub(super) const TALLEST: f32 = 660.0;

/// How large a board is before it was drawn, in points.
pub(super) fn size(id: BoardId) -> Vec2 {
    match id {
        BoardId::Wrist => vec2(352.0, 320.0),
        BoardId::Panel(_) => vec2(380.0, 480.0),
        BoardId::Files => FILES,
        BoardId::Keyboard => vec2(500.0, 320.0),
        BoardId::Ring => vec2(420.0, 460.0),
    }
}

const FILES: Vec2 = vec2(720.0, 540.0);

/// The dialog that fills its board below the bar.
pub(super) fn files() -> Files {
    Files::filling(egui::Rect::from_min_max(
        egui::pos2(0.0, BAR),
        egui::pos2(FILES.x, FILES.y),
    ))
}

/// As on a screen, but everything that is pressed is as large as a wand needs it.
pub(super) fn style(ctx: &Context, look: &LookSettings) {
    panel::apply_style(ctx, look);
    // A board is as large as it is in the room; points stay points.
    ctx.set_zoom_factor(1.0);
    let theme = ctx.theme();
    let mut style = (*ctx.style_of(theme)).clone();
    style.text_styles.insert(
        TextStyle::Small,
        FontId::new(13.5, FontFamily::Proportional),
    );
    if let Some(heading) = style.text_styles.get_mut(&TextStyle::Heading) {
        heading.size = 18.0;
    }
    let spacing = &mut style.spacing;
    spacing.interact_size = vec2(48.0, 44.0);
    spacing.item_spacing = vec2(11.0, 11.0);
    spacing.button_padding = vec2(14.0, 8.0);
    spacing.icon_width = 24.0;
    spacing.icon_width_inner = 14.0;
    spacing.icon_spacing = 10.0;
    spacing.slider_width = 160.0;
    spacing.slider_rail_height = 10.0;
    spacing.combo_width = 140.0;
    spacing.scroll.bar_width = 18.0;
    spacing.scroll.floating = false;
    // Words on a board are not for copying; a drag over them is the board's.
    style.interaction.selectable_labels = false;
    style.interaction.tooltip_delay = 0.6;
    ctx.set_style_of(theme, style);
    // A hand trembles more than a mouse.
    ctx.options_mut(|o| {
        o.input_options.max_click_dist = 14.0;
        // Who aims with a wand takes as long as it takes: a press that is let go on a button is a click.
        o.input_options.max_click_duration = f64::from(u16::MAX);
    });
}

/// What a board shows in one pass, and what came of it.
#[derive(Default)]
pub(super) struct Shown {
    pub close: bool,
    /// How tall it wants to be, in points; `None` where it keeps its size.
    pub height: Option<f32>,
    pub key: Option<panel::Key>,
}

/// What there is to draw with.
pub(super) struct Stage<'a> {
    pub world: &'a World,
    pub panels: &'a mut Panels,
    pub files: &'a mut Files,
    pub keyboard: &'a panel::Keyboard,
    pub page: &'a mut wrist::Page,
    pub pinned: bool,
    pub asks: &'a mut Vec<Command>,
}

pub(super) fn show(ui: &mut Ui, id: BoardId, stage: &mut Stage) -> Shown {
    match id {
        BoardId::Wrist => {
            let (title, pinned) = ("Midair", stage.pinned);
            let (pressed, height) = framed(ui, icon::CUBE_FOCUS, title, pinned, true, |ui| {
                wrist::show(ui, stage)
            });
            Shown {
                close: pressed.close,
                height: Some(height),
                ..Shown::default()
            }
        }
        BoardId::Panel(id) => {
            let info = stage.panels.all().iter().find(|i| i.id == id).copied();
            info.map_or_else(Shown::default, |info| registered(ui, &info, stage))
        }
        BoardId::Files => {
            let (pressed, _) = framed(
                ui,
                icon::FOLDER_OPEN,
                stage.files.title(),
                true,
                false,
                |_| {},
            );
            stage.asks.extend(stage.files.show(ui.ctx()));
            Shown {
                close: pressed.close,
                ..Shown::default()
            }
        }
        BoardId::Keyboard => {
            let mut key = None;
            let (pressed, height) = framed(ui, icon::KEYBOARD, "Type", true, true, |ui| {
                key = panel::keyboard(ui, stage.keyboard, [""; 4]);
            });
            Shown {
                close: pressed.close,
                height: Some(height),
                key,
            }
        }
        BoardId::Ring => {
            let ring = stage.world.resource::<Ring>();
            let tools = stage.world.resource::<Tools>();
            let rect = ui.max_rect();
            let middle = rect.center_top() + vec2(0.0, 0.5 * rect.width());
            let palette = panel::Palette::of(ui.visuals());
            ui.painter().rect_filled(rect, 0.0, palette.panel);
            panel::ring(
                ui.painter(),
                ui.style(),
                middle,
                0.32 * rect.width(),
                tools,
                ring.chosen(),
            );
            Shown::default()
        }
    }
}

/// A panel of the registry, as a screen would show it.
fn registered(ui: &mut Ui, info: &PanelInfo, stage: &mut Stage) -> Shown {
    // Columns fill their height; windows are as tall as what they say.
    let grows = !matches!(info.dock, Dock::Left | Dock::Right);
    let (pressed, height) = framed(ui, info.icon, info.title, true, grows, |ui| {
        if let Some(mut panel) = stage.panels.take(info.id) {
            ui.push_id(info.id, |ui| panel.show(ui, stage.world, stage.asks));
            stage.panels.put_back(info.id, panel);
        }
    });
    if pressed.close {
        stage.asks.push(Command::Panel {
            id: info.id.to_owned(),
            open: false,
        });
    }
    Shown {
        height: grows.then_some(height),
        ..Shown::default()
    }
}
