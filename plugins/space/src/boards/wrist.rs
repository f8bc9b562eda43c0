//! The panel on the wrist: what the bar of the window has, and what only a room needs.

use midair_studio::command::{Command, Dialog, Errands};
use midair_studio::panel::egui::{self, Button, RichText, Ui};
use midair_studio::panel::{icon, kit};
use midair_studio::project::{Project, Recoverables, Then};
use midair_studio::settings::Settings;
use midair_studio::tools::{Hints, Tools};
use midair_studio::world::{WorldAsk, WorldView};

use super::content::Stage;
use crate::room::Stance;

/// What of it is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Page {
    /// Modes, undo, panels.
    #[default]
    Work,
    /// Open, save, export.
    Files,
    /// How the world stands in the room.
    World,
}

pub(super) fn show(ui: &mut Ui, stage: &mut Stage) {
    let project = stage.world.resource::<Project>();
    let unsaved = if project.history().is_unsaved() {
        " •"
    } else {
        ""
    };
    ui.horizontal(|ui| {
        for (page, text) in [
            (Page::Work, "Work"),
            (Page::Files, "Files"),
            (Page::World, "World"),
        ] {
            if ui.selectable_label(*stage.page == page, text).clicked() {
                *stage.page = page;
            }
        }
    });
    ui.add(
        egui::Label::new(RichText::new(format!("{}{unsaved}", project.title())).weak()).truncate(),
    );
    left_behind(ui, stage);
    match *stage.page {
        Page::Work => work(ui, stage),
        Page::Files => files(ui, stage),
        Page::World => world(ui, stage),
    }
    errands(ui, stage);
}

fn work(ui: &mut Ui, stage: &mut Stage) {
    let history = stage.world.resource::<Project>().history();
    let tools = stage.world.resource::<Tools>();
    ui.horizontal_wrapped(|ui| {
        for tool in tools.all() {
            let active = tools.active().is_some_and(|t| t.id == tool.id);
            if ui.selectable_label(active, tool.name).clicked() {
                stage.asks.push(Command::Mode(tool.id.clone()));
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        for (sign, text, on, ask) in [
            (
                icon::ARROW_COUNTER_CLOCKWISE,
                "Undo",
                history.undo_len() > 0,
                Command::Undo,
            ),
            (
                icon::ARROW_CLOCKWISE,
                "Redo",
                history.redo_len() > 0,
                Command::Redo,
            ),
            (icon::FLOPPY_DISK, "Save", true, Command::Save),
        ] {
            if ui
                .add_enabled(on, Button::new(format!("{sign} {text}")))
                .clicked()
            {
                stage.asks.push(ask);
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        for info in stage.panels.all().iter().filter(|i| i.in_bar) {
            let open = stage.panels.is_open(info.id);
            // What is used all the time is named, the rest are signs.
            let text = if info.id == "library" {
                format!("{} {}", info.icon, info.title)
            } else {
                info.icon.to_owned()
            };
            let button = ui.selectable_label(open, text).on_hover_text(info.title);
            if button.clicked() {
                stage.asks.push(Command::Panel {
                    id: info.id.to_owned(),
                    open: !open,
                });
            }
        }
    });
    let status = &stage.world.resource::<Hints>().status;
    if !status.is_empty() {
        ui.label(RichText::new(status).weak());
    }
}

fn files(ui: &mut Ui, stage: &mut Stage) {
    let recent = &stage.world.resource::<Settings>().files.recent;
    ui.horizontal_wrapped(|ui| {
        for (sign, text, ask) in [
            (icon::FILE, "New", Command::Leave(Then::New)),
            (icon::FOLDER_OPEN, "Open…", Command::Dialog(Dialog::Open)),
            (icon::FLOPPY_DISK, "Save", Command::Save),
            (
                icon::FLOPPY_DISK_BACK,
                "Save as…",
                Command::Dialog(Dialog::SaveAs),
            ),
            (
                icon::EXPORT,
                "Export…",
                Command::Panel {
                    id: "export".to_owned(),
                    open: true,
                },
            ),
            (
                icon::DOWNLOAD_SIMPLE,
                "Import…",
                Command::Dialog(Dialog::Import),
            ),
            (icon::SIGN_OUT, "Quit", Command::Leave(Then::Quit)),
        ] {
            if ui.button(format!("{sign} {text}")).clicked() {
                stage.asks.push(ask);
            }
        }
    });
    for path in recent.iter().filter(|p| p.exists()).take(3) {
        let name = path
            .file_name()
            .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        if ui
            .button(format!("{} {name}", icon::CLOCK_COUNTER_CLOCKWISE))
            .clicked()
        {
            stage.asks.push(Command::Leave(Then::Open(path.clone())));
        }
    }
}

fn world(ui: &mut Ui, stage: &mut Stage) {
    let view = stage.world.resource::<WorldView>();
    let stance = stage.world.resource::<Stance>();
    let settings = stage.world.resource::<Settings>();
    ui.label(kit::strong(format!("Shown at {:.2}×", view.scale())));
    let about = view
        .world_from_room()
        .point(stance.head.position + 0.5 * stance.ahead());
    ui.horizontal_wrapped(|ui| {
        let recentre = WorldAsk::Recentre {
            at: stance.head.position,
            yaw: stance.yaw(),
        };
        let scale = |factor: f32| WorldAsk::Scale { factor, about };
        for (text, ask) in [
            (format!("{} Before me", icon::CROSSHAIR), recentre),
            (
                format!("{} As it was", icon::ARROW_COUNTER_CLOCKWISE),
                WorldAsk::Reset,
            ),
            ("Half".to_owned(), scale(0.5 * view.scale())),
            ("1 : 1".to_owned(), scale(1.0)),
            ("Twice".to_owned(), scale(2.0 * view.scale())),
        ] {
            if ui.button(text).clicked() {
                stage.asks.push(Command::World(ask));
            }
        }
    });
    for (key, text, on) in [
        ("world.seated", "I sit", settings.world.seated),
        (
            "world.one_handed",
            "One hand moves the world",
            settings.world.one_handed,
        ),
        ("world.tilt", "The world may be tilted", settings.world.tilt),
    ] {
        let mut now = on;
        if ui.checkbox(&mut now, text).changed() {
            stage.asks.push(Settings::command(key, now));
        }
    }
}

fn left_behind(ui: &mut Ui, stage: &mut Stage) {
    if stage.world.resource::<Recoverables>().0.is_empty() {
        return;
    }
    ui.label(kit::strong("Work from an earlier run was not saved."));
    ui.horizontal_wrapped(|ui| {
        if kit::primary(ui, "Restore it").clicked() {
            stage.asks.push(Command::Leave(Then::Restore));
        }
        if ui.button("Throw it away").clicked() {
            stage.asks.push(Command::Dismiss);
        }
    });
}

fn errands(ui: &mut Ui, stage: &mut Stage) {
    for row in stage.world.resource::<Errands>().rows() {
        ui.horizontal(|ui| {
            match row.fraction {
                Some(fraction) => {
                    ui.add(
                        egui::ProgressBar::new(fraction)
                            .text(row.what)
                            .desired_width(200.0),
                    );
                }
                None => {
                    ui.label(row.what);
                }
            }
            if ui.button("Cancel").clicked() {
                stage.asks.push(Command::CancelErrand(row.id));
            }
        });
    }
}
