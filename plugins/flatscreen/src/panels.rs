//! The panels on screen.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use midair_studio::{
    command::{Command, Errands},
    evaluate::Evaluations,
    hands::Action,
    notice::Notices,
    panel::{self, Bar},
    project::{Project, Recoverables, Shelf},
    tools::{HintKey, Hints, Tools},
};

use crate::keys::key_name;
use crate::pointer::Pointer;

/// What is being typed and dragged in panels, and what of the window they take.
#[derive(Resource, Default)]
pub(crate) struct Screen {
    bar: Bar,
    styled: bool,
    /// What the panels leave free.
    view: Option<egui::Rect>,
    /// A menu, a list or a slider has the pointer wherever it is.
    busy: bool,
    typing: bool,
    /// Something that floats over the view lies under the pointer.
    floating: bool,
}

impl Screen {
    /// Whether a panel has the pointer, or it is nowhere.
    pub fn covers(&self, cursor: Option<Vec2>) -> bool {
        let (Some(cursor), Some(view)) = (cursor, self.view) else {
            return true;
        };
        self.busy || self.floating || !view.contains(egui::pos2(cursor.x, cursor.y))
    }

    /// Whether keys are letters and not shortcuts.
    pub fn is_typing(&self) -> bool {
        self.typing
    }

    /// What the panels leave free.
    pub fn view(&self) -> Option<egui::Rect> {
        self.view
    }

    /// The middle of what the panels leave free, in pixels of the window.
    pub fn centre(&self) -> Option<Vec2> {
        self.view.map(|v| Vec2::new(v.center().x, v.center().y))
    }
}

pub(crate) fn style(mut contexts: EguiContexts, mut screen: ResMut<Screen>) -> Result {
    if !screen.styled {
        panel::apply_style(contexts.ctx_mut()?);
        screen.styled = true;
    }
    Ok(())
}

pub(crate) fn show(
    mut contexts: EguiContexts,
    mut screen: ResMut<Screen>,
    project: Res<Project>,
    tools: Res<Tools>,
    hints: Res<Hints>,
    mut shelf: ResMut<Shelf>,
    left_behind: Res<Recoverables>,
    errands: Res<Errands>,
    evaluations: Res<Evaluations>,
    notices: Res<Notices>,
    mut pointer: ResMut<Pointer>,
    mut commands: MessageWriter<Command>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let mut asks = Vec::new();
    let mut root = egui::Ui::new(
        ctx.clone(),
        "root".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    egui::Panel::top("bar").show(&mut root, |ui| {
        ui.add_space(4.0);
        asks.extend(panel::bar(
            ui,
            &mut screen.bar,
            &project,
            &tools,
            &shelf,
            &left_behind,
            &errands,
        ));
        ui.add_space(2.0);
    });
    egui::Panel::bottom("hints").show(&mut root, |ui| {
        ui.add_space(4.0);
        panel::operands(ui, project.document());
        let (hints, more) = with_keys(&hints, &pointer);
        panel::hints(ui, &hints, key_name, &more);
        ui.add_space(4.0);
    });
    if shelf.open {
        // Away from where the leading hand works.
        let mut query = shelf.query.clone();
        egui::Panel::left("library")
            .resizable(true)
            .default_size(272.0)
            .size_range(200.0..=480.0)
            .show(&mut root, |ui| {
                ui.add_space(8.0);
                ui.horizontal(|ui| {
                    ui.heading("Library");
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        ui.weak("L closes it");
                    });
                });
                asks.extend(panel::library(ui, &shelf, &mut query, pointer.leading));
            });
        if shelf.query != query {
            shelf.query = query;
        }
    }
    let view = root.available_rect_before_wrap();
    screen.view = Some(view);
    let busy = evaluations.outstanding();
    if notices.recent(panel::STAYS).next().is_some() || busy > 0 {
        egui::Area::new("notices".into())
            .order(egui::Order::Middle)
            // In a corner of the view, above the hints.
            .pivot(egui::Align2::RIGHT_BOTTOM)
            .fixed_pos(view.right_bottom() - egui::vec2(16.0, 16.0))
            .interactable(false)
            .show(ctx, |ui| {
                egui::Frame::window(ui.style())
                    .inner_margin(12.0)
                    .show(ui, |ui| {
                        ui.set_max_width(360.0);
                        panel::notices(ui, &notices);
                        if busy > 0 {
                            ui.horizontal(|ui| {
                                ui.spinner();
                                ui.label(format!(
                                    "Making {busy} solid{}",
                                    if busy == 1 { "" } else { "s" }
                                ));
                            });
                        }
                    });
            });
    }
    // Tab is the hands': a button that it led to would take every shortcut.
    if !ctx.text_edit_focused()
        && let Some(focused) = ctx.memory(|m| m.focused())
    {
        ctx.memory_mut(|m| m.surrender_focus(focused));
    }
    let at = ctx.input(|i| i.pointer.interact_pos());
    screen.typing = ctx.text_edit_focused() || ctx.any_popup_open();
    screen.busy = ctx.egui_is_using_pointer() || ctx.any_popup_open();
    screen.floating = at
        .and_then(|at| ctx.layer_id_at(at))
        .is_some_and(|layer| layer.order != egui::Order::Background);
    for ask in asks {
        match ask {
            // At the pointer is the panel itself: it is put where one looks, in the next frame.
            Command::Place { component, .. } => pointer.picked.push(component),
            other => {
                commands.write(other);
            }
        }
    }
    Ok(())
}

/// The tool's hints, with what only mouse and keyboard have.
fn with_keys(hints: &Hints, pointer: &Pointer) -> (Hints, Vec<(&'static str, &'static str)>) {
    let mut hints = hints.clone();
    let more: &[_] = if pointer.stretching {
        hints.buttons.clear();
        &[
            ("move", "larger or smaller"),
            ("X Y Z A", "along which axis, all"),
            ("click", "done"),
            ("Esc", "put it back"),
        ]
    } else if pointer.holds() {
        // The other hand is a key away.
        hints
            .buttons
            .retain(|h| h.action != HintKey::Action(Action::Grab));
        &[
            ("wheel", "nearer, farther"),
            ("R", "turn"),
            ("Tab", "other hand"),
        ]
    } else if pointer.is_over() {
        &[("U I M", "mark ∪ ∩ −"), ("N", "unmark"), ("S", "stretch")]
    } else {
        &[
            ("middle drag", "orbit"),
            ("Shift", "pan"),
            ("wheel", "zoom"),
            ("F", "show all"),
        ]
    };
    (hints, more.to_vec())
}

/// The window says what one works on and whether it is saved.
pub(crate) fn title(project: Res<Project>, mut windows: Query<&mut Window>) {
    if !project.is_changed() {
        return;
    }
    let unsaved = if project.history().is_unsaved() {
        "*"
    } else {
        ""
    };
    let title = format!("{}{unsaved} - Midair", project.title());
    for mut window in &mut windows {
        if window.title != title {
            window.title.clone_from(&title);
        }
    }
}

/// Files that are dropped on the window: documents are opened, anything else is brought in.
pub(crate) fn drop(
    mut dropped: MessageReader<FileDragAndDrop>,
    mut commands: MessageWriter<Command>,
) {
    for file in dropped.read() {
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = file {
            let document = path_buf.extension().is_some_and(|e| e == "midair");
            commands.write(if document {
                Command::Open(path_buf.clone())
            } else {
                Command::Import(vec![path_buf.clone()])
            });
        }
    }
}
