//! What hands do in Sweep.

use bevy::prelude::*;
use midair_curve::End;
use midair_document::{Link, ObjectId};
use midair_studio::{
    evaluate::Evaluations,
    hands::{Action, Cross, Hand, Hands, Haptic, Side},
    hold::Reserved,
    notice::Notices,
    pick::Touch,
    project::{Project, Selection, Shelf},
    settings::{Settings, SweepHands, SweepShape},
};
use midair_swept::{MAX_RIBS, Rib, smoothed};

use crate::ends::{aimed, end, is_there};
use crate::phase::{Draft, Phase};
use crate::solo::{Doing, Solo, Then};
use crate::{EPSILON, Wires, ask, edit, write};

/// How far one click of the cross moves w.
const CLICK: f32 = 0.25;
/// How far a swipe over half the pad moves w.
const SWIPE: f32 = 1.5;
/// A press within this, in physical metres and in pixels, is one on one spot: a pointer may have been caught from beside it.
const SPOT: (f64, f64) = (0.006, 7.0);
/// α of Eq. 12.
pub(crate) const ALPHA: f32 = 0.1;

/// The cross: shape, smoothing, w; while a sweep is edited, what is done with the curve at hand.
pub(crate) fn cross(
    mut hands: ResMut<Hands>,
    mut settings: ResMut<Settings>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    selection: Res<Selection>,
    mut notices: ResMut<Notices>,
) {
    swipes(&hands, &mut draft);
    for side in Side::BOTH {
        let Some(arm) = hands.get(side).cross() else {
            continue;
        };
        let done = match (&draft.phase, arm) {
            (&Phase::Editing { object, at, .. }, Cross::Left) => {
                edit::cut_at(&mut project, &mut notices, object, at)
            }
            (&Phase::Editing { object, .. }, Cross::Right) => {
                draft.extends = Some(object);
                draft.phase = Phase::Idle;
                true
            }
            (&Phase::Editing { object, .. }, Cross::Down) => {
                edit::smooth(&mut project, &mut notices, object, 1)
            }
            (Phase::Editing { .. }, Cross::Up) => continue,
            (Phase::Sweeping { .. }, Cross::Down) => {
                let smooth = smoothed(&draft.ribs, ALPHA, 1);
                draft.ribs = smooth.to_vec();
                true
            }
            (_, Cross::Down) => match target(&project, &selection) {
                Some(object) => edit::smooth(&mut project, &mut notices, object, 1),
                None => {
                    notices.info("Sweep something, or select a sweep, then smooth it.");
                    false
                }
            },
            (_, Cross::Up) => {
                settings.sweep.shape = settings.sweep.shape.next();
                true
            }
            (_, Cross::Left | Cross::Right) => {
                let by = if arm == Cross::Right { CLICK } else { -CLICK };
                let w = &mut draft.slopes[side as usize];
                let next = (*w + by).clamp(0.0, 3.0);
                std::mem::replace(w, next) != next
            }
        };
        let felt = if done { Haptic::Tick } else { Haptic::Refused };
        hands.pulse(side, felt);
    }
}

/// The sweep that is selected.
pub(crate) fn target(project: &Project, selection: &Selection) -> Option<ObjectId> {
    let document = project.document();
    let is_sweep = |id: &&ObjectId| document.object(**id).is_some_and(|o| o.sweep().is_some());
    selection.0.iter().find(is_sweep).copied()
}

/// An outward swipe raises that end's w, an inward one lowers it. Only a touch that goes away from the
/// middle counts, so that a stick that springs back takes nothing back.
fn swipes(hands: &Hands, draft: &mut Draft) {
    for (side, hand) in hands.both() {
        let outward = if side == Side::Left { -1.0 } else { 1.0 };
        let now = hand.swipe.map(|s| s.x * outward);
        let before = std::mem::replace(&mut draft.swipes[side as usize], now);
        let (Some(now), Some(before)) = (now, before) else {
            continue;
        };
        let away = if now.signum() == before.signum() || before == 0.0 {
            now.abs() - before.abs()
        } else {
            now.abs()
        };
        if away > 0.0 {
            let w = &mut draft.slopes[side as usize];
            *w = (*w + away * now.signum() * SWIPE).clamp(0.0, 3.0);
        }
    }
}

/// Where the ends are, and the curve between them.
pub(crate) fn ends(
    mut hands: ResMut<Hands>,
    settings: Res<Settings>,
    time: Res<Time>,
    (touch, mut reserved): (Res<Touch>, ResMut<Reserved>),
    mut draft: ResMut<Draft>,
    project: Res<Project>,
    mut selection: ResMut<Selection>,
    mut notices: ResMut<Notices>,
) {
    let draft = &mut *draft;
    let (main, off) = (settings.hands.main(), settings.hands.off());
    let unit = 1.0 / hands.metres_per_world;
    if hands.pressed(Action::Cancel).is_some() {
        cancel(draft);
    }
    if let Some(side) = hands.pressed(Action::Finish)
        && !reserved.has(side, Action::Finish)
    {
        let done = finish(draft, &settings, &project, &selection, &mut notices);
        hands.pulse(side, if done { Haptic::Tick } else { Haptic::Refused });
    }
    if !draft.is_sweeping() {
        let alone = match settings.sweep.hands {
            SweepHands::Auto => !is_there(hands.get(off), hands.head),
            SweepHands::Two => false,
            SweepHands::One => true,
        };
        if alone != draft.alone {
            draft.alone = alone;
            draft.live = None;
            draft.solo = Solo::default();
        }
    }
    if project.is_changed() {
        // A stroke that is drawn otherwise is a rail as it is now.
        for rail in draft.rails.iter_mut().flatten() {
            if let Some(line) = project.document().object(rail.object).and_then(ask::stroke) {
                rail.line = line;
            }
        }
    }
    let dt = time.delta_secs();
    if draft.alone {
        if !matches!(draft.phase, Phase::Editing { .. }) {
            // Grab takes what is touched in hand, and elsewhere the whole curve.
            let carries = matches!(draft.solo, Solo::Carried { .. })
                || matches!(draft.solo, Solo::Ready { .. }) && touch.get(main).is_none();
            if carries {
                reserved.claim(main, Action::Grab);
            }
            if hands.get(main).pressed(Action::Act) {
                draft.under = touch.get(main).map(|t| t.object);
            }
            let spot = hands.reach(main, SPOT.0, SPOT.1) as f32;
            let reach = Reach { unit, spot, dt };
            if solo(draft, hands.get(main), &reach, carries, &settings) == Then::Choose {
                let there = choose(draft.under, &mut selection, &mut notices);
                hands.pulse(main, if there { Haptic::Tick } else { Haptic::Refused });
            }
        }
    } else {
        if hands.get(off).pressed(Action::Act) && !matches!(draft.phase, Phase::Editing { .. }) {
            let i = off as usize;
            draft.pinned[i] = match draft.pinned[i] {
                None => draft.ends[i],
                Some(_) => None,
            };
            hands.pulse(off, Haptic::Tick);
        }
        for (side, hand) in hands.both() {
            let i = side as usize;
            let mut at = end(&hand.pose);
            if let Some(rail) = &draft.rails[i] {
                at = rail.onto(&at);
            }
            if settings.sweep.springy {
                at = draft.springs[i].follow(&at, f64::from(dt), f64::from(unit));
            } else {
                draft.springs[i] = Default::default();
            }
            draft.ends[i] = Some(draft.pinned[i].unwrap_or(at));
        }
        hang(draft);
    }
}

/// How far the one hand reaches, and for how long.
struct Reach {
    /// Metres of world in a physical one.
    unit: f32,
    /// Metres within which a press is one on one spot.
    spot: f32,
    /// Seconds of the frame.
    dt: f32,
}

/// What was clicked is selected, so that it can be changed; whether something was.
fn choose(
    under: Option<ObjectId>,
    selection: &mut ResMut<Selection>,
    notices: &mut Notices,
) -> bool {
    match under {
        Some(object) => drop(selection.set_if_neq(Selection(vec![object]))),
        None => notices.info(
            "That was a press on one spot: hold and draw the way of the left end. On a thing it selects that.",
        ),
    }
    under.is_some()
}

/// The one hand places the ends or moves them.
fn solo(
    draft: &mut Draft,
    hand: &Hand,
    &Reach { unit, spot, dt }: &Reach,
    carries: bool,
    settings: &Settings,
) -> Then {
    let doing = Doing {
        at: hand.pose.position,
        dt,
        spot,
        pressed: hand.pressed(Action::Act),
        held: hand.held(Action::Act),
        grabbed: carries && hand.pressed(Action::Grab),
        grabs: hand.held(Action::Grab),
        middle: is_at_middle(draft.live.as_ref(), hand.pose.position, unit),
    };
    let then = draft.solo.advance(&doing, unit);
    draft.ends = draft.solo.ends();
    if let Some((from, to)) = draft.solo.pulled(doing.at) {
        let pulled = aimed(from, to - from);
        match draft.solo {
            Solo::LeftTangent { .. } => draft.ends[0] = Some(pulled),
            _ => draft.ends[1] = Some(pulled),
        }
    }
    rails(draft);
    hang(draft);
    let count = settings.sweep.count as usize;
    match then {
        Then::Wait | Then::Choose => {}
        Then::Begin => begin(draft),
        Then::End => {
            // The left end's way is played to its end.
            while let Some(rest) = draft.solo.rest() {
                draft.solo.play(rest.clamp(1e-4, 1.0 / 90.0));
                draft.ends = draft.solo.ends();
                rails(draft);
                hang(draft);
                append(draft, count, unit);
            }
            draft.done = true;
            draft.solo.rests();
        }
    }
    then
}

/// Whether a hand is at the curve and not near its ends.
fn is_at_middle(rib: Option<&Rib>, at: Vec3, unit: f32) -> bool {
    let Some(rib) = rib else { return false };
    let curve = rib.curve();
    (5..=15).any(|i| {
        let p = curve.at(f64::from(i) / 20.0).as_vec3();
        let apart = (rib.points[0].distance(rib.points[1]) / 20.0).max(0.015 * unit);
        p.distance(at) <= apart
    })
}

fn rails(draft: &mut Draft) {
    for (end, rail) in draft.ends.iter_mut().zip(&draft.rails) {
        if let (Some(end), Some(rail)) = (end, rail) {
            *end = rail.onto(end);
        }
    }
}

/// The curve between the ends as they are now.
fn hang(draft: &mut Draft) {
    let [Some(left), Some(right)] = draft.ends else {
        draft.live = None;
        return;
    };
    if !(left.is_sound() && right.is_sound()) {
        return;
    }
    // Hands that appear have their curve at once; after that it settles as the paper's does.
    if draft.live.is_none() {
        draft.lengths.settle(&left, &right);
    } else {
        draft.lengths.adapt(&left, &right);
    }
    let rib = held(draft, &left, &right);
    if rib.is_sound() {
        draft.live = Some(rib);
    }
}

fn held(draft: &Draft, left: &End, right: &End) -> Rib {
    Rib::held(left, right, draft.lengths, draft.slopes, draft.twist())
}

fn begin(draft: &mut Draft) {
    if let Some(live) = draft.live {
        draft.phase = Phase::Sweeping {
            onto: draft.extends.take(),
        };
        draft.ribs = vec![live];
    }
}

fn append(draft: &mut Draft, count: usize, unit: f32) {
    if let (Some(live), Some(last)) = (draft.live, draft.ribs.last())
        && last.apart(&live, count) > EPSILON * unit
        && draft.ribs.len() < MAX_RIBS
    {
        draft.ribs.push(live);
    }
}

/// The leading hand's trigger sweeps.
pub(crate) fn sweep(hands: Res<Hands>, settings: Res<Settings>, mut draft: ResMut<Draft>) {
    let draft = &mut *draft;
    let main = hands.get(settings.hands.main());
    if draft.phase == Phase::Idle && !draft.alone && main.pressed(Action::Act) {
        begin(draft);
    }
    if draft.is_sweeping() {
        append(
            draft,
            settings.sweep.count as usize,
            1.0 / hands.metres_per_world,
        );
        if !draft.alone && !main.held(Action::Act) {
            draft.done = true;
        }
    }
}

fn cancel(draft: &mut Draft) {
    if draft.is_sweeping() {
        draft.drop_sweep();
        draft.solo.back();
        return;
    }
    draft.offer = None;
    match &mut draft.phase {
        Phase::Editing { grip, .. } if grip.is_some() => *grip = None,
        Phase::Editing { .. } => draft.phase = Phase::Idle,
        _ if draft.extends.take().is_some() => {}
        _ if draft.alone => {
            draft.solo.back();
        }
        _ => draft.pinned = [None; 2],
    }
}

/// Whether a row of clones hangs between the ends that can be kept where it does: one hand alone has to draw no way
/// for it.
pub(crate) fn hangs(draft: &Draft, settings: &Settings) -> bool {
    let row = settings.sweep.shape == SweepShape::Clones && !settings.sweep.spread;
    let ready = draft.alone && matches!(draft.solo, Solo::Ready { .. }) && draft.live.is_some();
    row && ready && draft.phase == Phase::Idle && draft.extends.is_none()
}

/// Takes up a sweep to edit its curves, or puts it down; or keeps the row of clones that hangs there.
fn finish(
    draft: &mut Draft,
    settings: &Settings,
    project: &Project,
    selection: &Selection,
    notices: &mut Notices,
) -> bool {
    if draft.is_sweeping() {
        return false;
    }
    if let Phase::Editing { .. } = draft.phase {
        draft.phase = Phase::Idle;
        return true;
    }
    match target(project, selection) {
        Some(object) => {
            draft.phase = Phase::Editing {
                object,
                at: 0,
                grip: None,
            };
            true
        }
        None if hangs(draft, settings) => {
            let there = |kept: Rib| draft.live.is_some_and(|l| kept.apart(&l, 16) < 1e-3);
            if draft.kept.is_some_and(there) {
                notices.info("The row stands there already. Carry the curve on, or place its ends anew, for another.");
                return false;
            }
            begin(draft);
            draft.kept = draft.live;
            draft.done = true;
            true
        }
        None => {
            notices.info("Select a sweep first, then finish takes up its curves.");
            false
        }
    }
}

/// What was let go becomes one step.
pub(crate) fn commit(
    mut draft: ResMut<Draft>,
    settings: Res<Settings>,
    mut hands: ResMut<Hands>,
    mut project: ResMut<Project>,
    mut selection: ResMut<Selection>,
    (shelf, evaluations): (Res<Shelf>, Res<Evaluations>),
    (mut looks, mut wires): (ResMut<write::Looks>, ResMut<Wires>),
    mut notices: ResMut<Notices>,
) {
    if !draft.done {
        return;
    }
    let onto = match draft.phase {
        Phase::Sweeping { onto } => onto,
        _ => None,
    };
    let mut ribs = std::mem::take(&mut draft.ribs);
    if let (Some(live), Some(last)) = (draft.live, ribs.last())
        && last.apart(&live, 16) > 1e-4
    {
        ribs.push(live);
    }
    draft.drop_sweep();
    // Its ends follow the strokes they ran along.
    let links = [0, 1].into_iter().filter_map(|k| {
        let rail = draft.rails[k].as_ref();
        let source = rail.filter(|_| draft.pinned[k].is_none())?.object;
        Some(Link {
            source,
            part: k as u32,
        })
    });
    let links = links
        .filter(|l| project.document().object(l.source).is_some())
        .collect();
    let made = write::make(
        &ribs,
        onto,
        links,
        &settings.sweep,
        &project,
        &shelf,
        &evaluations,
    );
    let done = match made {
        Ok(made) => {
            let sweep = made.sweep.clone();
            let name = made.name.clone();
            // Its images come with it, as one step.
            let done = project.commit_live(made.step, made.edits, &mut notices);
            if done {
                selection.set_if_neq(Selection(vec![made.object]));
                wires.wait_for(made.object);
                looks.look(name, sweep);
            }
            done
        }
        Err(reason) => {
            notices.warn(reason);
            false
        }
    };
    let felt = if done { Haptic::Done } else { Haptic::Refused };
    hands.pulse(settings.hands.main(), felt);
}
