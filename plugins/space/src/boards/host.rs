//! Which boards there are, and what is laid out on them in a frame.

use std::mem;
use std::time::Instant;

use bevy::prelude::*;
use bevy_egui::EguiClipboard;
use midair_studio::command::{Command, Dialogs};
use midair_studio::hands::{Hands, Haptic};
use midair_studio::panel::{self, Dock, Host, Key, Panels, egui};
use midair_studio::project::{Project, Recoverables, Selection, Shelf};
use midair_studio::settings::Settings;
use midair_studio::tools::Tools;

use super::content::{self, Shown, Stage, TALLEST};
use super::picture::{self, TEXELS};
use super::{AWAY, Anchor, Board, BoardId, Boards, keys, place};
use crate::DMM_PER_POINT;
use crate::ring::Ring;
use crate::room::Stance;

/// Seconds after which a board is laid out again though nothing seems to have happened.
const IDLE: f64 = 0.3;
/// Seconds after which a hand that is not seen counts as none.
const MISSED: f32 = 1.5;
/// The least that a board is tall, in points.
const LOWEST: f32 = 140.0;

/// Opens and closes boards as panels, questions and fields ask for it.
pub(crate) fn arrange(
    mut boards: ResMut<Boards>,
    panels: Res<Panels>,
    settings: Res<Settings>,
    (dialogs, project): (Res<Dialogs>, Res<Project>),
    (stance, ring, time): (Res<Stance>, Res<Ring>, Res<Time>),
    mut missed: Local<f32>,
) {
    let boards = boards.bypass_change_detection();
    if let Some((number, dialog)) = dialogs.after(boards.seen) {
        boards.seen = number;
        boards.files.ask(dialog, &project);
        if let Some(board) = boards.all.get_mut(&BoardId::Files) {
            board.stale = true;
        }
    }
    let mut wanted = vec![BoardId::Wrist];
    let open = |i: &&panel::PanelInfo| panels.is_open(i.id);
    wanted.extend(
        panels
            .all()
            .iter()
            .filter(open)
            .map(|i| BoardId::Panel(i.id)),
    );
    if boards.files.is_open() {
        wanted.push(BoardId::Files);
    }
    if boards.typing.is_some() {
        wanted.push(BoardId::Keyboard);
    }
    if ring.is_open() {
        wanted.push(BoardId::Ring);
    }
    let now = time.elapsed_secs_f64();
    for board in boards.all.values_mut() {
        let open = wanted.contains(&board.id);
        if board.open != open {
            board.open = open;
            board.pointer = None;
            board.events.clear();
            if open {
                board.opened = now;
                board.stale = true;
                board.anchor = Anchor::Room;
                board.fresh = true;
            }
        }
    }
    for id in wanted {
        boards.all.entry(id).or_insert_with(|| Board::new(id, now));
    }
    let scale = settings.comfort.interface_scale.clamp(0.5, 2.5);
    let off = settings.hands.off();
    let fresh: Vec<_> = boards
        .all
        .values()
        .filter(|b| b.open && b.fresh)
        .map(|b| b.id)
        .collect();
    for id in fresh {
        let taken: Vec<_> = boards
            .all
            .values()
            .filter(|b| b.open && !b.fresh && b.anchor == Anchor::Room)
            .map(|b| (b.pose.position, 0.5 * b.metres().x))
            .collect();
        let typing = boards.typing;
        let Some(board) = boards.all.get_mut(&id) else {
            continue;
        };
        board.scale = 1e-3 * DMM_PER_POINT * AWAY * scale;
        board.fresh = false;
        match id {
            BoardId::Wrist if !boards.pinned => board.anchor = Anchor::Hand(off),
            BoardId::Keyboard if let Some(typing) = typing => board.anchor = Anchor::Below(typing),
            BoardId::Ring => board.pose = place::at_hand(ring.at(), &stance),
            _ => {
                let dock = match id {
                    BoardId::Panel(id) => panels.all().iter().find(|i| i.id == id).map(|i| i.dock),
                    _ => None,
                };
                let dock = dock.unwrap_or(Dock::Modal);
                board.pose = place::spot(dock, off, board.metres(), &stance, &taken);
            }
        }
    }
    // Somebody with one hand has no wrist to look at.
    *missed = if stance.tracked[off as usize] {
        0.0
    } else {
        *missed + time.delta_secs()
    };
    let alone = *missed > MISSED && stance.tracked[off.other() as usize];
    let pinned = boards.pinned;
    for board in boards.all.values_mut() {
        board.scale = 1e-3 * DMM_PER_POINT * AWAY * scale;
        if board.id == BoardId::Wrist && !pinned {
            // When the other hand leads it changes sides.
            match (alone, board.anchor) {
                (true, Anchor::Hand(_)) => {
                    board.anchor = Anchor::Room;
                    board.pose = place::low(&stance);
                }
                (true, _) => {}
                (false, _) => board.anchor = Anchor::Hand(off),
            }
        }
        if board.id == BoardId::Ring && ring.is_changed() {
            board.stale = true;
        }
    }
}

/// Lays out and draws what is to be drawn, and hands on what was asked for.
pub(crate) fn paint(world: &mut World) {
    if *world.resource::<Host>() != Host::Room {
        return;
    }
    let changed = is_changed(world);
    let now = world.resource::<Time>().elapsed_secs_f64();
    let mut asks = Vec::new();
    world.resource_scope(|world, mut boards: Mut<Boards>| {
        let boards = boards.bypass_change_detection();
        let ids: Vec<_> = boards.all.keys().copied().collect();
        // Of those to which nothing happened one is looked at in a frame.
        let mut idle = true;
        for id in ids {
            let Some(mut board) = boards.all.remove(&id) else {
                continue;
            };
            if board.open {
                let due = board.stale || changed || !board.events.is_empty();
                let waited = now >= board.next;
                if due || waited && mem::take(&mut idle) {
                    let began = Instant::now();
                    lay_out(world, boards, &mut board, now, &mut asks);
                    boards.laid_out.0 += 1;
                    boards.laid_out.1 += began.elapsed();
                }
            }
            picture::update(world, &mut board);
            boards.all.insert(id, board);
        }
    });
    for ask in asks {
        world.write_message(ask);
    }
}

/// Whether anything that panels show is otherwise than in the frame before.
fn is_changed(world: &World) -> bool {
    world.is_resource_changed::<Project>()
        || world.is_resource_changed::<Settings>()
        || world.is_resource_changed::<Panels>()
        || world.is_resource_changed::<Selection>()
        || world.is_resource_changed::<Shelf>()
        || world.is_resource_changed::<Tools>()
        || world.is_resource_changed::<Recoverables>()
        || world.is_resource_changed::<Dialogs>()
}

fn lay_out(
    world: &mut World,
    boards: &mut Boards,
    board: &mut Board,
    now: f64,
    asks: &mut Vec<Command>,
) {
    let look = &world.resource::<Settings>().look;
    dress(board, look);
    let mut input = egui::RawInput {
        screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, board.size)),
        max_texture_side: Some(4096),
        time: Some(now),
        predicted_dt: 1.0 / 90.0,
        events: mem::take(&mut board.events),
        focused: true,
        ..Default::default()
    };
    input
        .viewports
        .entry(egui::ViewportId::ROOT)
        .or_default()
        .native_pixels_per_point = Some(TEXELS);
    board.stale = false;
    let mut shown = Shown::default();
    let first = asks.len();
    let output = world.resource_scope(|world, mut panels: Mut<Panels>| {
        let mut stage = Stage {
            world: &*world,
            panels: panels.bypass_change_detection(),
            files: &mut boards.files,
            keyboard: &boards.keyboard,
            page: &mut boards.page,
            pinned: boards.pinned,
            asks: &mut *asks,
        };
        board.ctx.run_ui(input, |ui| {
            let pass = content::show(ui, board.id, &mut stage);
            shown.close |= pass.close;
            shown.height = pass.height.or(shown.height);
            shown.key = pass.key.or(shown.key.take());
        })
    });
    let egui::FullOutput {
        textures_delta,
        shapes,
        viewport_output,
        ..
    } = output;
    let delay = viewport_output
        .get(&egui::ViewportId::ROOT)
        .map_or(IDLE, |v| v.repaint_delay.as_secs_f64());
    board.next = now + delay.min(IDLE);
    board.stale |= delay <= 0.0;
    let differs = shapes != board.shapes;
    if differs {
        board.shapes.clone_from(&shapes);
    }
    board
        .picture
        .take(&board.ctx, textures_delta, differs.then_some(shapes));
    if let Some(height) = shown.height {
        let height = height.ceil().clamp(LOWEST, TALLEST);
        if (height - board.size.y).abs() > 1.0 {
            board.size.y = height;
            board.stale = true;
        }
    }
    came_of_it(world, boards, board, &shown);
    // What is picked appears at the hand that picked it.
    let main = world.resource::<Settings>().hands.main();
    let picker = board.pointer.map_or(main, |(side, _)| side);
    for ask in &mut asks[first..] {
        if let Command::Place { side, .. } = ask {
            *side = picker;
        }
    }
}

/// The look of the room, and fonts before the first letter.
fn dress(board: &mut Board, look: &midair_studio::settings::LookSettings) {
    if board.look.as_ref() == Some(look) {
        return;
    }
    if board.look.is_none() {
        panel::install_fonts(&board.ctx);
        // Fonts that are asked for are there in the next pass.
        let output = board.ctx.run_ui(egui::RawInput::default(), |_| {});
        board.picture.take(&board.ctx, output.textures_delta, None);
    }
    content::style(&board.ctx, look);
    board.look = Some(look.clone());
}

/// Fields that were entered or left, keys that were pressed, crosses.
fn came_of_it(world: &mut World, boards: &mut Boards, board: &mut Board, shown: &Shown) {
    if board.id != BoardId::Keyboard {
        if board.ctx.text_edit_focused() {
            boards.typing = Some(board.id);
        } else if boards.typing == Some(board.id) {
            boards.typing = None;
        }
    }
    if let Some(key) = shown.key {
        let copied = (key == Key::Paste)
            .then(|| world.get_resource_mut::<EguiClipboard>())
            .flatten()
            .and_then(|mut clipboard| clipboard.get_text());
        let (events, done) = keys::typed(key, &mut boards.keyboard, copied);
        board.stale = true;
        if let Some(field) = boards.typing.and_then(|t| boards.all.get_mut(&t)) {
            field.events.extend(events);
            field.stale = true;
        }
        if done {
            // Enter leaves the field as well.
            boards.typing = None;
        }
        if let Some((side, _)) = board.pointer {
            world.resource_mut::<Hands>().pulse(side, Haptic::Tick);
        }
    }
    if !shown.close {
        return;
    }
    match board.id {
        BoardId::Files => boards.files.close(),
        BoardId::Keyboard => {
            if let Some(field) = boards.typing.take().and_then(|t| boards.all.get_mut(&t)) {
                field.ctx.memory_mut(egui::Memory::stop_text_input);
                field.stale = true;
            }
        }
        BoardId::Wrist => boards.pinned = false,
        BoardId::Panel(_) | BoardId::Ring => {}
    }
}
