//! What hands draw.

use bevy::ecs::system::SystemParam;
use bevy::math::DVec3;
use bevy::prelude::*;
use midair_beautify::Line;
use midair_document::{Edit, Kind, MAX_POINTS, ObjectId};
use midair_studio::command::Command;
use midair_studio::drawing::{Drawing, on_piece};
use midair_studio::hands::{Action, Cross, Hands, Haptic, Side};
use midair_studio::notice::Notices;
use midair_studio::pick::Touch;
use midair_studio::plane::WorkPlane;
use midair_studio::project::{Project, Selection};
use midair_studio::settings::{Draws, Settings};

use crate::ghost;
use crate::lift::lift;
use crate::make;
use crate::memory;
use crate::phase::{Draft, Options, PIXELS, Phase, Sample};
use crate::read::{self, Reading, Scene};

/// Shorter than this, in physical metres and in pixels, a line is a tick mark or the pick of a point.
const SHORT: (f64, f64) = (0.03, 7.0);
/// Shorter than this it is a press on one spot.
const CLICK: (f64, f64) = (0.006, 3.5);
/// A pointer is caught from so far beside what catches it.
const CAUGHT: (f64, f64) = (0.0, 10.5);
/// A pick takes a keypoint within this.
const PICK: (f64, f64) = (0.02, 8.0);
/// The tip leaves a sample whenever it went so far.
const SAMPLE: (f64, f64) = (0.001, 1.0);

/// The cross: what the trigger draws, auto-correct, the other readings.
pub(crate) fn turn(
    mut hands: ResMut<Hands>,
    settings: Res<Settings>,
    mut draft: ResMut<Draft>,
    mut project: ResMut<Project>,
    mut notices: ResMut<Notices>,
    mut commands: MessageWriter<Command>,
    drawing: Res<Drawing>,
) {
    if project.is_changed() {
        memory::follow(&project, &mut draft);
        // A point of a line that is gone is none.
        let there = |picked: DVec3| drawing.keypoints().any(|p| p == picked);
        draft.picked = draft.picked.filter(|p| there(*p));
    }
    for side in Side::BOTH {
        let Some(cross) = hands.get(side).cross() else {
            continue;
        };
        let mut done = true;
        match cross {
            Cross::Up if draft.phase == Phase::Idle => {
                let next = match settings.scaffold.draws {
                    Draws::Line => Draws::Stroke,
                    Draws::Stroke => Draws::Line,
                };
                commands.write(Settings::command("scaffold.draws", next));
            }
            Cross::Up => done = false,
            Cross::Down => {
                commands.write(Settings::command("scaffold.auto", !settings.scaffold.auto));
            }
            Cross::Left | Cross::Right => {
                if side != settings.hands.main() {
                    continue;
                }
                let count = draft.last.as_ref().map_or(0, |l| l.readings.len());
                let at = draft.last.as_ref().map_or(0, |l| l.chosen);
                let by = if cross == Cross::Right {
                    1
                } else {
                    count.max(1) - 1
                };
                let to = if count > 0 { (at + by) % count } else { 0 };
                done = make::choose(to, &mut project, &mut notices, &mut draft);
            }
        }
        hands.pulse(side, if done { Haptic::Tick } else { Haptic::Refused });
    }
}

/// What drawing is about.
#[derive(SystemParam)]
pub(crate) struct Room<'w> {
    hands: ResMut<'w, Hands>,
    settings: Res<'w, Settings>,
    drawing: Res<'w, Drawing>,
    plane: Res<'w, WorkPlane>,
    time: Res<'w, Time>,
    project: ResMut<'w, Project>,
    touch: Res<'w, Touch>,
    selection: ResMut<'w, Selection>,
    notices: ResMut<'w, Notices>,
}

/// The trigger.
pub(crate) fn draw(mut room: Room, mut draft: ResMut<Draft>) {
    let draft = &mut *draft;
    room.look_back(draft);
    let Some(side) = draft.side() else {
        room.begin(draft);
        return;
    };
    if room.hands.pressed(Action::Cancel).is_some() {
        draft.phase = Phase::Idle;
        draft.preview = None;
        return;
    }
    let tip = room.follow(side, draft);
    if room.hands.get(side).held(Action::Act) {
        room.preview(side, draft);
        return;
    }
    draft.preview = None;
    let done = match std::mem::take(&mut draft.phase) {
        Phase::Line {
            from,
            to,
            farthest,
            raw,
            ..
        } => {
            let gesture = Gesture {
                side,
                from,
                to,
                raw,
            };
            if from.distance(to) < room.reach(side, SHORT)
                && farthest < 2.0 * room.reach(side, SHORT)
            {
                room.short(&gesture, draft)
            } else {
                draft.picked = None;
                room.line(&gesture, draft)
            }
        }
        Phase::Stroke {
            mut points, raw, ..
        } => {
            if points.last().is_some_and(|p| p.at != tip) && points.len() < MAX_POINTS {
                let eye = room.eye();
                points.push(Sample { at: tip, eye });
            }
            room.stroke(&points, (side, raw), draft)
        }
        Phase::Idle => false,
    };
    let pulse = if done { Haptic::Done } else { Haptic::Refused };
    room.hands.pulse(side, pulse);
}

/// One line that was drawn.
struct Gesture {
    side: Side,
    from: DVec3,
    to: DVec3,
    raw: bool,
}

impl Room<'_> {
    /// Metres of world that are so much of the hand, or so many pixels.
    fn reach(&self, side: Side, (physical, pixels): (f64, f64)) -> f64 {
        self.hands.reach(side, physical, pixels)
    }

    fn eye(&self) -> Option<DVec3> {
        self.hands.head.map(|h| h.position.as_dvec3())
    }

    /// What was drawn last grows old, but not while a hand is at one of its ghosts.
    fn look_back(&self, draft: &mut Draft) {
        let over = Side::BOTH.into_iter().find_map(|side| {
            let hand = self.hands.get(side);
            let tip = hand.pose.position.as_dvec3();
            let near = self.reach(side, ghost::PICK);
            hand.tracked.then(|| ghost::at(draft, tip, near)).flatten()
        });
        if draft.over != over {
            draft.over = over;
        }
        if let Some(last) = draft.last.as_mut().filter(|_| over.is_none()) {
            last.age += self.time.delta_secs();
        }
    }

    fn begin(&self, draft: &mut Draft) {
        for (side, hand) in self.hands.both() {
            if !hand.pressed(Action::Act) || hand.held(Action::Grab) || !hand.tracked {
                continue;
            }
            let at = hand.pose.position.as_dvec3();
            draft.under = self.touch.get(side).map(|t| t.object);
            draft.phase = match self.settings.scaffold.draws {
                Draws::Line => Phase::Line {
                    side,
                    from: at,
                    to: at,
                    farthest: 0.0,
                    raw: false,
                },
                Draws::Stroke => Phase::Stroke {
                    side,
                    points: vec![Sample {
                        at,
                        eye: self.eye(),
                    }],
                    raw: false,
                },
            };
            return;
        }
    }

    /// The line or stroke goes on to where the tip is; says where that is.
    fn follow(&self, side: Side, draft: &mut Draft) -> DVec3 {
        let hands = &self.hands;
        let alt = hands.get(side.other()).held(Action::Act) || hands.get(side).held(Action::Free);
        let tip = hands.get(side).pose.position.as_dvec3();
        match &mut draft.phase {
            Phase::Line {
                from,
                to,
                farthest,
                raw,
                ..
            } => {
                *to = tip;
                *farthest = farthest.max(tip.distance(*from));
                *raw |= alt;
            }
            Phase::Stroke { points, raw, .. } => {
                *raw |= alt;
                let step = self.reach(side, SAMPLE);
                let far = points.last().is_none_or(|p| p.at.distance(tip) >= step);
                if far && points.len() < MAX_POINTS {
                    let eye = self.eye();
                    points.push(Sample { at: tip, eye });
                }
            }
            Phase::Idle => {}
        }
        tip
    }

    /// What the elastic line would become if it were let go now.
    fn preview(&self, side: Side, draft: &mut Draft) {
        draft.preview = match draft.phase {
            Phase::Line { from, to, raw, .. }
                if !raw
                    && self.settings.scaffold.auto
                    && from.distance(to) >= self.reach(side, SHORT) =>
            {
                let options =
                    Options::of(&self.settings.scaffold, &self.hands, side).and_at(draft.own_angle);
                let scene = Scene::of(&self.drawing, &[]);
                read::best_line(&Line::new(from, to), &scene, &options.line)
            }
            _ => None,
        };
    }

    fn line(&mut self, gesture: &Gesture, draft: &mut Draft) -> bool {
        let options =
            Options::of(&self.settings.scaffold, &self.hands, gesture.side).and_at(draft.own_angle);
        let drawn = Line::new(gesture.from, gesture.to);
        let (readings, refused) = read::line(&drawn, &Scene::of(&self.drawing, &[]), &options.line);
        let raw = gesture.raw || !self.settings.scaffold.auto;
        if refused && !raw {
            self.notices.info(
                "The line stays as drawn: correcting it would have moved it farther than a hand errs. \
                 Zoom in, or choose another reading.",
            );
        }
        self.add(readings, raw, draft)
    }

    fn stroke(&mut self, points: &[Sample], (side, raw): (Side, bool), draft: &mut Draft) -> bool {
        let points: Vec<DVec3> = if self.hands.pixel > 0.0 && !self.plane.shown {
            let keypoints: Vec<DVec3> = self.drawing.keypoints().collect();
            lift(points, &keypoints, PIXELS[1] * f64::from(self.hands.pixel))
        } else {
            points.iter().map(|p| p.at).collect()
        };
        let long: f64 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
        // What caught the pointer where it was pressed is no way that it went.
        let caught = match points[..] {
            [first, second, ..] if self.hands.pixel > 0.0 => {
                Some(first.distance(second)).filter(|far| *far < self.reach(side, CAUGHT))
            }
            _ => None,
        };
        let long = long - caught.unwrap_or(0.0);
        if points.len() < 2 || long < self.reach(side, SHORT) * 0.3 {
            if let Some(done) = self.pick_ghost(points.first().copied(), side, draft) {
                return done;
            }
            if self.choose(draft.under) {
                return true;
            }
            self.notices
                .info("That was a point. Hold, and move to draw a stroke.");
            return false;
        }
        let set = self.settings.scaffold.sound();
        let options = Options::of(&set, &self.hands, side);
        let scene = Scene::of(&self.drawing, &[]);
        let (readings, refused) = read::stroke(&points, set.width, &scene, &options.stroke);
        let raw = raw || !set.auto;
        if refused && !raw {
            self.notices.info(
                "The stroke stays as drawn: a fair curve through these points would leave it. \
                 Draw it slower, or with fewer turns between two points.",
            );
        }
        self.add(readings, raw, draft)
    }

    fn add(&mut self, readings: Vec<Reading>, raw: bool, draft: &mut Draft) -> bool {
        let chosen = if raw { readings.len() - 1 } else { 0 };
        let (project, notices) = (&mut self.project, &mut self.notices);
        make::add(readings, chosen, &self.drawing, project, notices, draft)
    }

    /// A press at the place of a ghost makes it what was drawn; says whether it did, where there is one.
    fn pick_ghost(&mut self, at: Option<DVec3>, side: Side, draft: &mut Draft) -> Option<bool> {
        let reach = self.reach(side, ghost::PICK);
        let reading = ghost::at(draft, at?, reach)?;
        draft.picked = None;
        Some(make::choose(
            reading,
            &mut self.project,
            &mut self.notices,
            draft,
        ))
    }

    /// A press on one spot of a thing selects that, so that it can be changed; says whether there is one.
    fn choose(&mut self, object: Option<ObjectId>) -> bool {
        if let Some(object) = object {
            self.selection.set_if_neq(Selection(vec![object]));
        }
        object.is_some()
    }

    /// A press on one spot, or nearly: a tick mark across a line, or one of two points that a line is to join.
    fn short(&mut self, gesture: &Gesture, draft: &mut Draft) -> bool {
        let side = gesture.side;
        let clicked = gesture.from.distance(gesture.to) < self.reach(side, CLICK);
        if clicked
            && draft.picked.is_none()
            && let Some(done) = self.pick_ghost(Some(gesture.from), side, draft)
        {
            return done;
        }
        let reach = self.reach(side, PICK);
        let near = |p: &DVec3| p.distance(gesture.to).min(p.distance(gesture.from));
        let key = self
            .drawing
            .keypoints()
            .filter(|p| near(p) < reach)
            .min_by(|a, b| near(a).total_cmp(&near(b)));
        let crossed = crossed(gesture, &self.drawing, reach);
        let second = key
            .or(crossed.map(|c| c.2))
            .or(clicked.then_some(gesture.to));
        match (draft.picked.take(), second) {
            (Some(first), Some(second)) if first.distance(second) > 1e-6 => {
                let between = Gesture {
                    from: first,
                    to: second,
                    ..*gesture
                };
                return self.line(&between, draft);
            }
            (Some(_), Some(_)) => {
                self.notices
                    .info("The same point twice: nothing is picked now.");
                return false;
            }
            _ => {}
        }
        match (key, crossed) {
            (Some(point), _) => {
                draft.picked = Some(point);
                self.notices
                    .info("Press on a second point: a line joins the two.");
                true
            }
            (None, Some((id, at, _))) => tick(id, at, &mut self.project, &mut self.notices),
            (None, None) if clicked && self.choose(draft.under) => true,
            (None, None) => {
                self.notices.info(
                    "Too short for a line. Across a line it is a tick mark, on a keypoint it picks that; \
                     otherwise hold and pull.",
                );
                false
            }
        }
    }
}

/// The line that a short gesture crosses, how far along it as a share, and where.
fn crossed(gesture: &Gesture, drawing: &Drawing, reach: f64) -> Option<(ObjectId, f64, DVec3)> {
    let middle = gesture.from.midpoint(gesture.to);
    drawing
        .lines()
        .iter()
        .map(|l| {
            // Where the two come nearest: seen from the middle of the gesture, then from there.
            let on = on_piece(middle, l.a, l.b);
            let across = on_piece(on, gesture.from, gesture.to);
            let on = on_piece(across, l.a, l.b);
            let share = on.distance(l.a) / l.a.distance(l.b).max(1e-300);
            ((l.id, share, on), on.distance(across))
        })
        .filter(|((_, share, _), off)| *off < reach && *share > 1e-6 && *share < 1.0 - 1e-6)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(found, _)| found)
}

/// A tick mark on a line.
pub(crate) fn tick(id: ObjectId, at: f64, project: &mut Project, notices: &mut Notices) -> bool {
    let Some(line) = project.document().object(id).and_then(|o| o.line()) else {
        return false;
    };
    let mut line = line.clone();
    let place = line.ticks.partition_point(|&t| t < at);
    line.ticks.insert(place, at);
    let kind = Kind::Line(line);
    project.commit_live("Tick mark", [Edit::SetKind { id, kind }], notices)
}
