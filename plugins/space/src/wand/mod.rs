//! A wand is the ray of a hand: it shows where it would click, clicks, drags and scrolls on boards.
//!
//! What a hand presses while its wand is on a board is the board's from press to release, and is taken out of
//! [`HandsInput`]: neither the tool nor a recording sees it. What it pressed before it came there stays the tool's, and
//! while that is down the wand meets no board.

mod show;

use bevy::prelude::*;
use midair_studio::hands::{Action, ActionSet, Hands, HandsInput, Haptic, Pose, Side};
use midair_studio::panel::egui::{self, Event, Modifiers, MouseWheelUnit, PointerButton, Pos2};
use midair_studio::pick::Touch;
use midair_studio::settings::Settings;

pub(crate) use show::{show, spawn};

use crate::boards::{BoardId, Boards, bar_moves};
use crate::room::{Stance, facing};

/// Metres of the room that a wand reaches.
const REACH: f32 = 2.5;
/// Who has the tip in a thing means the thing: boards farther than this (metres) are not met then.
const BEYOND: f32 = 0.12;
/// Points that a pressed wand may tremble by and still rests.
const TREMBLE: f32 = 12.0;
/// Points a second that a stick scrolls at most.
const SCROLLS: f32 = 900.0;
/// A grip let go within so many seconds, having moved nothing, is the second button.
const TAP: f32 = 0.3;
/// Metres that count as having moved something.
const MOVED: f32 = 0.015;

/// What the scene gets while no board does.
const OWN: [Action; 14] = [
    Action::Act,
    Action::Grab,
    Action::Finish,
    Action::Cancel,
    Action::Save,
    Action::Delete,
    Action::Up,
    Action::Right,
    Action::Down,
    Action::Left,
    Action::Centre,
    Action::Free,
    Action::Undo,
    Action::Redo,
];

/// Where a wand meets a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Which.
    pub board: BoardId,
    /// Where on it, in points.
    pub at: Pos2,
    /// Metres along the ray.
    pub far: f32,
}

/// A board in a hand.
#[derive(Clone, Copy, Debug)]
struct Carried {
    board: BoardId,
    /// Its middle as the hand sees it.
    offset: Vec3,
    /// By the grip; otherwise by the trigger on its bar.
    by_grip: bool,
    since: f32,
    from: Vec3,
    moved: bool,
}

/// What one hand does with boards.
#[derive(Clone, Debug, Default)]
pub struct Wand {
    /// What it is on.
    pub met: Option<Met>,
    /// What was pressed on a board and is still down.
    captured: ActionSet,
    /// What was pressed on the scene and is still down.
    scene: ActionSet,
    /// Which board has the trigger, and where it was pressed.
    pressed: Option<(BoardId, Pos2)>,
    /// Whether it was dragged from there.
    dragged: bool,
    carried: Option<Carried>,
}

impl Wand {
    /// Whether a board has the hand.
    pub fn is_busy(&self) -> bool {
        self.met.is_some() || self.captured != ActionSet::NONE
    }

    /// What was pressed on a board and is still down: neither tools nor recordings see it.
    pub fn captured(&self) -> ActionSet {
        self.captured
    }
}

/// Both wands.
#[derive(Resource, Clone, Debug, Default)]
pub struct Wands([Wand; 2]);

impl Wands {
    /// One of them.
    pub fn get(&self, side: Side) -> &Wand {
        &self.0[side as usize]
    }
}

/// The way a wand points, in metres of the room. How far it points below its controller is in its pose already.
pub(crate) fn ray(hand: &Pose) -> (Vec3, Vec3) {
    (hand.position, hand.rotation * Vec3::NEG_Z)
}

/// Finds what both wands are on, gives boards what they do, and takes it from the scene.
pub(crate) fn point(
    (settings, stance, time): (Res<Settings>, Res<Stance>, Res<Time>),
    touch: Res<Touch>,
    mut wands: ResMut<Wands>,
    mut boards: ResMut<Boards>,
    mut input: ResMut<HandsInput>,
    mut hands: ResMut<Hands>,
) {
    let dt = time.delta_secs();
    let boards = boards.bypass_change_detection();
    for side in Side::BOTH {
        let wand = &mut wands.0[side as usize];
        let frame = input.side(side);
        let hand = stance.hand(side);
        let (origin, direction) = ray(&hand);
        let down: ActionSet = frame.down.iter().filter(|a| OWN.contains(a)).collect();
        let tracked = frame.pose.is_some();
        wand.scene = both(wand.scene, down);
        let before = wand.captured;
        wand.captured = both(before, down);

        let tip_in_thing = touch.get(side).is_some();
        wand.met = if !tracked || wand.scene != ActionSet::NONE {
            None
        } else if let Some((board, _)) = wand.pressed {
            // What was pressed keeps the wand wherever it goes.
            boards.get(board).and_then(|b| {
                let (far, at) = b.meet(origin, direction)?;
                Some(Met { board, at, far })
            })
        } else if let Some(carried) = wand.carried {
            wand.met.filter(|m| m.board == carried.board)
        } else {
            nearest(boards, side, origin, direction).filter(|m| !tip_in_thing || m.far < BEYOND)
        };
        if let (Some(met), Some((_, from))) = (wand.met, wand.pressed) {
            wand.dragged |= from.distance(met.at) > TREMBLE;
        }
        if let Some(met) = wand.met {
            let began = minus(minus(down, wand.captured), wand.scene);
            wand.captured |= began;
            if began.has(Action::Act) {
                hands.pulse(side, Haptic::Tick);
                press(wand, boards, met, &hand);
            } else if began.has(Action::Grab) && wand.carried.is_none() {
                take(wand, boards, met, &hand, true);
            }
        } else {
            wand.scene |= minus(down, wand.captured);
        }
        if before.has(Action::Act) && !wand.captured.has(Action::Act) {
            if let Some((board, at)) = wand.pressed.take() {
                let at = if wand.dragged {
                    wand.met.map_or(at, |m| m.at)
                } else {
                    at
                };
                button(boards, board, at, PointerButton::Primary, false);
            }
            wand.dragged = false;
            wand.carried.take_if(|c| !c.by_grip);
        }
        if let Some(carried) = &mut wand.carried {
            carried.since += dt;
            if carried.by_grip && !wand.captured.has(Action::Grab) {
                let (board, tap) = (carried.board, !carried.moved && carried.since < TAP);
                wand.carried = None;
                if let Some(met) = wand.met.filter(|m| tap && m.board == board) {
                    for down in [true, false] {
                        button(boards, board, met.at, PointerButton::Secondary, down);
                    }
                }
            } else {
                carry(carried, boards, &hand, &stance);
            }
        }
        let frame = input.side(side);
        if wand.is_busy() {
            if let (Some(met), Some(swipe)) = (wand.met, frame.swipe) {
                scroll(boards, met.board, swipe, dt);
            }
            frame.swipe = None;
            for action in wand.captured.iter() {
                frame.down.set(action, false);
            }
        }
    }
    pointers(&wands, boards, settings.hands.main());
}

/// The board that a ray meets first.
fn nearest(boards: &Boards, side: Side, origin: Vec3, direction: Vec3) -> Option<Met> {
    boards
        .all()
        .filter(|b| b.shown && !b.hangs_on(side) && b.id != BoardId::Ring)
        .filter_map(|b| {
            let (far, at) = b.meet(origin, direction)?;
            (far < REACH && b.covers(at)).then_some(Met {
                board: b.id,
                at,
                far,
            })
        })
        .min_by(|a, b| a.far.total_cmp(&b.far))
}

fn press(wand: &mut Wand, boards: &mut Boards, met: Met, hand: &Pose) {
    boards.pressed(met.board);
    let Some(board) = boards.get(met.board) else {
        return;
    };
    if bar_moves(met.at, board.size) {
        take(wand, boards, met, hand, false);
        return;
    }
    wand.pressed = Some((met.board, met.at));
    wand.dragged = false;
    button(boards, met.board, met.at, PointerButton::Primary, true);
}

fn take(wand: &mut Wand, boards: &mut Boards, met: Met, hand: &Pose, by_grip: bool) {
    let Some(board) = boards.get(met.board) else {
        return;
    };
    let from = board.pose.position;
    wand.carried = Some(Carried {
        board: met.board,
        offset: hand.rotation.inverse() * (from - hand.position),
        by_grip,
        since: 0.0,
        from,
        moved: false,
    });
}

/// The board goes along with the hand and goes on facing the eyes.
fn carry(carried: &mut Carried, boards: &mut Boards, hand: &Pose, stance: &Stance) {
    let position = hand.position + hand.rotation * carried.offset;
    if !carried.moved && position.distance(carried.from) < MOVED {
        return;
    }
    if !carried.moved {
        carried.moved = true;
        boards.take_off(carried.board);
    }
    if let Some(board) = boards.get_mut(carried.board)
        && position.is_finite()
    {
        board.pose = Pose {
            position,
            rotation: facing(position, stance.head.position),
        };
    }
}

fn button(boards: &mut Boards, id: BoardId, pos: Pos2, button: PointerButton, pressed: bool) {
    if let Some(board) = boards.get_mut(id) {
        board.events.extend([
            Event::PointerMoved(pos),
            Event::PointerButton {
                pos,
                button,
                pressed,
                modifiers: Modifiers::default(),
            },
        ]);
    }
}

fn scroll(boards: &mut Boards, id: BoardId, swipe: Vec2, dt: f32) {
    // A stick at rest is never quite in its middle.
    let push = |x: f32| x.signum() * ((x.abs() - 0.15) / 0.85).max(0.0);
    let delta = egui::vec2(-push(swipe.x), push(swipe.y)) * SCROLLS * dt;
    if delta != egui::Vec2::ZERO
        && let Some(board) = boards.get_mut(id)
    {
        board.events.push(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta,
            phase: egui::TouchPhase::Move,
            modifiers: Modifiers::default(),
        });
    }
}

/// Each board has one pointer: that of the hand that pressed it, else of the one that was on it, else of the one that leads.
fn pointers(wands: &Wands, boards: &mut Boards, main: Side) {
    let mut moves = Vec::new();
    for board in boards.all() {
        let on = |side: Side| {
            let wand = wands.get(side);
            wand.met
                .filter(|m| m.board == board.id)
                .map(|m| (side, m.at))
        };
        let pressing = Side::BOTH
            .into_iter()
            .find(|&s| wands.get(s).pressed.is_some_and(|(b, _)| b == board.id));
        let now = pressing
            .and_then(on)
            .or_else(|| board.pointer.and_then(|(side, _)| on(side)))
            .or_else(|| on(main))
            .or_else(|| on(main.other()));
        moves.push((board.id, now));
    }
    for (id, now) in moves {
        let Some(board) = boards.get_mut(id) else {
            continue;
        };
        // A pressed wand that trembles rests.
        let held = now.map(|(side, at)| {
            let rests = wands.get(side).pressed.filter(|(b, from)| {
                *b == id && !wands.get(side).dragged && from.distance(at) <= TREMBLE
            });
            (side, rests.map_or(at, |(_, from)| from))
        });
        match (board.pointer, held) {
            (Some(_), None) => board.events.push(Event::PointerGone),
            (before, Some((_, at))) if before.is_none_or(|(_, p)| p.distance(at) > 0.5) => {
                board.events.push(Event::PointerMoved(at));
            }
            // What moved less than can be seen is still where it was.
            (Some(before), Some(_)) => {
                board.pointer = Some(before);
                continue;
            }
            (None, _) => {}
        }
        board.pointer = held;
    }
}

fn both(a: ActionSet, b: ActionSet) -> ActionSet {
    a.iter().filter(|&x| b.has(x)).collect()
}

fn minus(a: ActionSet, b: ActionSet) -> ActionSet {
    a.iter().filter(|&x| !b.has(x)).collect()
}
