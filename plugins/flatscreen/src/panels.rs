//! The panels on screen.

use bevy::ecs::system::SystemState;
use bevy::prelude::*;
use bevy::window::WindowCloseRequested;
use bevy_egui::{EguiContexts, egui};
use midair_studio::{
    command::Command,
    evaluate::Evaluations,
    notice::Notices,
    panel::{self, Bar, Dock, Host, PanelInfo, Panels},
    project::{Project, Then},
    settings::{LookSettings, Settings},
};

use crate::bindings::{Controls, Cursor};
use crate::column::column;
use crate::focus::{Focus, Map};
use crate::gamepad::Pad;
use crate::hints;
use crate::keys::key_name;
use crate::pointer::Pointer;

/// What is being typed and dragged in panels, and what of the window they take.
#[derive(Resource, Default)]
pub(crate) struct Screen {
    bar: Bar,
    /// The look that the panels have.
    look: Option<LookSettings>,
    /// Logical pixels of the window per point of a panel.
    scale: f32,
    /// What the panels leave free.
    view: Option<egui::Rect>,
    /// A menu, a list or a slider has the pointer wherever it is.
    busy: bool,
    typing: bool,
    /// A field takes letters.
    text: bool,
    /// Where what floats over the view lies.
    layers: Option<egui::Context>,
}

impl Screen {
    /// Whether a panel has the pointer, or it is nowhere.
    pub fn covers(&self, cursor: Option<Vec2>) -> bool {
        let (Some(cursor), Some(view)) = (cursor, self.view) else {
            return true;
        };
        let at = self.point(cursor);
        let floats = |layer: egui::LayerId| layer.order != egui::Order::Background;
        let over = self.layers.as_ref().and_then(|ctx| ctx.layer_id_at(at));
        self.busy || over.is_some_and(floats) || !view.contains(at)
    }

    /// Whether keys are a panel's and not shortcuts.
    pub fn is_typing(&self) -> bool {
        self.typing
    }

    /// Whether keys are letters.
    pub fn is_text(&self) -> bool {
        self.text
    }

    /// Where a place in the window is among the panels.
    pub fn point(&self, at: Vec2) -> egui::Pos2 {
        let scale = if self.scale > 0.0 { self.scale } else { 1.0 };
        egui::pos2(at.x / scale, at.y / scale)
    }

    /// What the panels leave free, in points.
    pub fn view(&self) -> Option<egui::Rect> {
        self.view
    }

    /// The middle of what the panels leave free, in pixels of the window.
    pub fn centre(&self) -> Option<Vec2> {
        self.view
            .map(|v| Vec2::new(v.center().x, v.center().y) * self.scale)
    }
}

/// Below these many points a window has no room for columns, and below these for more than the bar.
const NARROW: f32 = 420.0;
const LOW: f32 = 240.0;

/// Points of one line of hints.
const HINTS: f32 = 36.0;

pub(crate) fn style(
    mut contexts: EguiContexts,
    settings: Res<Settings>,
    mut screen: ResMut<Screen>,
) -> Result {
    if screen.look.as_ref() == Some(&settings.look) {
        return Ok(());
    }
    let ctx = contexts.ctx_mut()?;
    // Fonts that are asked for are there in the next frame.
    if !panel::has_fonts(ctx) {
        panel::install_fonts(ctx);
        return Ok(());
    }
    panel::apply_style(ctx, &settings.look);
    screen.look = Some(settings.look.clone());
    Ok(())
}

/// Every open panel, where it stands; what is left in the middle is the view.
pub(crate) fn show(world: &mut World, contexts: &mut SystemState<EguiContexts<'static, 'static>>) {
    let Some(ctx) = contexts
        .get_mut(world)
        .ok()
        .and_then(|mut c| c.ctx_mut().ok().cloned())
    else {
        return;
    };
    if world.resource::<Screen>().look.is_none() {
        return;
    }
    let mut asks = Vec::new();
    world.resource_scope(|world, mut screen: Mut<Screen>| {
        world.resource_scope(|world, mut panels: Mut<Panels>| {
            world.resource_scope(|world, mut focus: Mut<Focus>| {
                draw(
                    &ctx,
                    world,
                    screen.bypass_change_detection(),
                    panels.bypass_change_detection(),
                    focus.bypass_change_detection(),
                    &mut asks,
                );
            });
        });
    });
    for ask in asks {
        match ask {
            // Let go over the view: it stands where the pointer is.
            Command::Place { component, .. } if let Some(at) = dropped_at(&ctx, world) => {
                world.resource_mut::<Pointer>().put(component, at);
            }
            // At the pointer is the panel itself: it is put where one looks, in the next frame.
            Command::Place { component, .. } => {
                if world.resource::<Pad>().leads() {
                    world.resource_mut::<Pad>().picked.push(component);
                    // The hands go on with it; the panel stays for the next one.
                    world.resource_mut::<Focus>().leave();
                } else {
                    world.resource_mut::<Pointer>().pick(component);
                }
            }
            other => {
                // The lesson begins: what it says is done outside of panels.
                if matches!(&other, Command::Set { key, .. } if key == "help.tutorial") {
                    world.resource_mut::<Focus>().leave();
                }
                world.write_message(other);
            }
        }
    }
}

/// Where in the window a drag ended in this frame, if it ended over the view.
fn dropped_at(ctx: &egui::Context, world: &World) -> Option<Vec2> {
    let screen = world.resource::<Screen>();
    let released = ctx.input(|i| i.pointer.any_released());
    let at = ctx
        .input(|i| i.pointer.interact_pos())
        .filter(|_| released)?;
    let at = screen.view()?.contains(at).then_some(at)?;
    Some(Vec2::new(at.x, at.y) * screen.scale)
}

fn draw(
    ctx: &egui::Context,
    world: &World,
    screen: &mut Screen,
    panels: &mut Panels,
    focus: &mut Focus,
    asks: &mut Vec<Command>,
) {
    // Whoever wears a headset has them there.
    let on_screen = *world.resource::<Host>() == Host::Screen;
    let open_in = |panels: &Panels, dock| {
        if on_screen {
            panels.open_in(dock)
        } else {
            Vec::new()
        }
    };
    focus.begin(ctx);
    screen.scale = ctx.zoom_factor();
    let mut map = Map::new(ctx);
    let mut root = egui::Ui::new(
        ctx.clone(),
        "root".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    let window = ctx.viewport_rect().size();
    egui::Panel::top("bar").show(&mut root, |ui| {
        ui.add_space(4.0);
        let mut bar = |ui: &mut egui::Ui| {
            asks.extend(panel::bar(ui, &mut screen.bar, world, panels));
        };
        if window.y < LOW {
            // The bar is what stays: it scrolls where it has more lines than there is room.
            let scroll = egui::ScrollArea::vertical().max_height((window.y - 16.0).max(24.0));
            scroll.show(ui, bar);
        } else {
            bar(ui);
        }
        ui.add_space(2.0);
    });
    map.end("bar", false);
    if window.y >= LOW {
        // Of one height: the view does not jump as hints come and go.
        let marks = !world.resource::<Project>().document().pending().is_empty();
        let high = if marks { 2.0 * HINTS } else { HINTS };
        let hints = egui::Panel::bottom("hints").exact_size(high + 13.0);
        hints.show(&mut root, |ui| {
            ui.add_space(4.0);
            panel::operands(ui, world.resource::<Project>().document());
            let (bindings, device) = (world.resource(), world.resource::<Controls>().device());
            let (hints, more) = hints::with_keys(world, focus.is_inside(), bindings, device);
            let names = |action| key_name(action, bindings, device);
            panel::hints(ui, &hints, &names, &more);
            ui.add_space(4.0);
        });
        map.end("hints", false);
    }
    for (dock, side) in [
        (Dock::Left, egui::Panel::left("left").default_size(288.0)),
        (Dock::Right, egui::Panel::right("right").default_size(288.0)),
    ] {
        let open = open_in(panels, dock);
        // In a narrow window the view comes first; the panels are there again when it grows.
        if !open.is_empty() && root.available_width() >= NARROW && window.y >= LOW {
            column(&mut root, side, &open, world, panels, &mut map, asks);
        }
    }
    let left = root.available_rect_before_wrap();
    let view = egui::Rect::from_min_size(left.min, left.size().max(egui::Vec2::ZERO));
    screen.view = Some(view);
    for info in open_in(panels, Dock::Corner) {
        let shown = egui::Window::new(format!("{}  {}", info.icon, info.title))
            .id(egui::Id::new(info.id))
            .title_bar(false)
            .resizable(false)
            .constrain_to(view)
            .pivot(egui::Align2::LEFT_BOTTOM)
            .fixed_pos(view.left_bottom() + egui::vec2(16.0, -16.0))
            // A window that scrolls keeps its height: only where there is no room for its own.
            .vscroll(view.height() < 400.0)
            .max_height((view.height() - 64.0).max(32.0))
            .show(ctx, |ui| fill(ui, &info, world, panels, asks));
        if let Some(shown) = shown {
            map.corner(info.id, shown.response.layer_id);
        }
    }
    for info in open_in(panels, Dock::Window) {
        let room = (view.height() - 96.0).max(64.0);
        let shown = egui::Window::new(format!("{}  {}", info.icon, info.title))
            .id(egui::Id::new(info.id))
            .title_bar(false)
            .resizable(false)
            .default_height(room + 64.0)
            .constrain_to(view)
            // Beside the middle, where the work is.
            .default_pos(view.right_center() - egui::vec2(24.0, 0.0))
            .pivot(egui::Align2::RIGHT_CENTER)
            .show(ctx, |ui| {
                heading(ui, &info, asks);
                ui.add_space(4.0);
                // As tall as what it shows, where there is room for that.
                egui::ScrollArea::vertical()
                    .max_height(room)
                    .show(ui, |ui| fill(ui, &info, world, panels, asks));
            });
        if let Some(shown) = shown {
            map.layer(info.id, shown.response.layer_id);
        }
    }
    for info in open_in(panels, Dock::Modal) {
        let shown = egui::Modal::new(egui::Id::new(info.id)).show(ctx, |ui| {
            ui.heading(format!("{}  {}", info.icon, info.title));
            ui.add_space(8.0);
            fill(ui, &info, world, panels, asks);
        });
        map.layer(info.id, shown.response.layer_id);
        if shown.should_close() {
            asks.push(close(&info));
        }
    }
    notices(ctx, view, world);
    focus.settle(ctx, map);
    screen.text = ctx.text_edit_focused();
    screen.typing = screen.text || ctx.any_popup_open() || focus.is_inside();
    screen.busy = ctx.egui_is_using_pointer() || ctx.any_popup_open();
    screen.layers = Some(ctx.clone());
}

fn close(info: &PanelInfo) -> Command {
    Command::Panel {
        id: info.id.to_owned(),
        open: false,
    }
}

/// What a panel is for, and what closes it.
pub(crate) fn heading(ui: &mut egui::Ui, info: &PanelInfo, asks: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        ui.heading(format!("{}  {}", info.icon, info.title));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if panel::kit::icon_button(ui, panel::icon::X, "Close", false).clicked() {
                asks.push(close(info));
            }
        });
    });
}

pub(crate) fn fill(
    ui: &mut egui::Ui,
    info: &PanelInfo,
    world: &World,
    panels: &mut Panels,
    asks: &mut Vec<Command>,
) {
    if let Some(mut panel) = panels.take(info.id) {
        panel.show(ui, world, asks);
        panels.put_back(info.id, panel);
    }
}

/// What the studio has to say, in a corner of the view above the hints.
fn notices(ctx: &egui::Context, view: egui::Rect, world: &World) {
    let notices = world.resource::<Notices>();
    let busy = world.resource::<Evaluations>().outstanding();
    if notices.recent(panel::STAYS).next().is_none() && busy == 0 {
        return;
    }
    egui::Area::new("notices".into())
        .order(egui::Order::Middle)
        .pivot(egui::Align2::RIGHT_BOTTOM)
        .fixed_pos(view.right_bottom() - egui::vec2(16.0, 16.0))
        .interactable(false)
        .show(ctx, |ui| {
            egui::Frame::window(ui.style())
                .inner_margin(12.0)
                .show(ui, |ui| {
                    ui.set_max_width(360.0);
                    panel::notices(ui, notices);
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

/// Files that are dropped on the window: documents are opened, anything else is brought into the
/// library, and into the scene where it was dropped on the view; pictures stand in the scene.
pub(crate) fn drop(
    mut dropped: MessageReader<FileDragAndDrop>,
    screen: Res<Screen>,
    pointer: Res<Pointer>,
    cursor: Res<Cursor>,
    mut commands: MessageWriter<Command>,
) {
    let (mut meshes, mut pictures) = (Vec::new(), Vec::new());
    for file in dropped.read() {
        if let FileDragAndDrop::DroppedFile { path_buf, .. } = file {
            if path_buf.extension().is_some_and(|e| e == "midair") {
                commands.write(Command::Leave(Then::Open(path_buf.clone())));
            } else if panel::has_ending(path_buf, &panel::PICTURES) {
                pictures.push(path_buf.clone());
            } else {
                meshes.push(path_buf.clone());
            }
        }
    }
    let cursor = cursor.at();
    if !pictures.is_empty() {
        let at = pointer.pose(pointer.leading).position;
        commands.write(Command::Reference {
            paths: pictures,
            at: (!screen.covers(cursor)).then_some(at),
        });
    }
    if meshes.is_empty() {
        return;
    }
    commands.write(if screen.covers(cursor) {
        Command::Import(meshes)
    } else {
        Command::Bring {
            paths: meshes,
            at: pointer.pose(pointer.leading).position,
        }
    });
}

/// The window's own button asks like any other way to leave.
pub(crate) fn close_window(
    mut asked: MessageReader<WindowCloseRequested>,
    mut commands: MessageWriter<Command>,
) {
    if asked.read().count() > 0 {
        commands.write(Command::Leave(Then::Quit));
    }
}
