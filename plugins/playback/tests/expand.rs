//! Steps become frames: exact ends, bounded speeds, buttons that last.

use std::sync::Arc;

use bevy::math::{Quat, Vec2, Vec3};
use midair_playback::{Beat, FrameBeat, HandsOnlyFault, Session, check_hands_only};
use midair_studio::{
    command::Command,
    hands::{Action, DOUBLE_PRESS, HOLD, Side},
};

fn session(steps: &str) -> Arc<Session> {
    let text =
        format!("(format: 1, hands: (left: (-0.2, 1, 0), right: (0.2, 1, 0)), steps: [{steps}])");
    Arc::new(Session::parse(&text, "t.ron").expect("a session"))
}

fn frames(steps: &str) -> Vec<FrameBeat> {
    let session = session(steps);
    let frames: Vec<_> = session
        .cursor()
        .filter_map(|b| match b {
            Beat::Frame(f) => Some(f),
            Beat::Check(_) => None,
        })
        .collect();
    assert_eq!(frames.len() as u64, session.frames(), "frames are foretold");
    let sum: std::time::Duration = frames.iter().map(|f| f.dt).sum();
    assert_eq!(sum, session.duration(), "time is foretold");
    frames
}

fn positions(frames: &[FrameBeat], side: Side) -> Vec<Vec3> {
    let pose = |f: &FrameBeat| {
        f.input.frames[side as usize]
            .pose
            .expect("tracked")
            .position
    };
    frames.iter().map(pose).collect()
}

#[test]
fn a_move_ends_exactly_where_it_is_to_and_takes_its_time() {
    let frames = frames("Move(hand: Right, to: (0.3, 1.7, -0.123), turn: (10, 20, 30), over: 0.6)");
    assert_eq!(frames.len(), 54);
    let last = frames[53].input.frames[1].pose.expect("tracked");
    assert_eq!(last.position, Vec3::new(0.3, 1.7, -0.123));
    let mut before = Vec3::new(0.2, 1.0, 0.0);
    let mean = before.distance(last.position) / 0.6;
    for at in positions(&frames, Side::Right) {
        let speed = at.distance(before) * 90.0;
        assert!(speed <= mean * 4.0 / 3.0 * 1.001, "{speed}");
        before = at;
    }
    assert!(
        frames
            .iter()
            .all(|f| f.input.frames[1].pose.is_some_and(|p| p.is_sound()))
    );
    assert!(positions(&frames, Side::Left).iter().all(|p| p.x == -0.2));
}

#[test]
fn a_move_without_a_time_is_calm() {
    for way in ["(5, 0, 0)", "(0.001, 0, 0)", "(0, -0.4, 0.3)"] {
        let frames = frames(&format!("Move(hand: Left, by: {way})"));
        let mut before = Vec3::new(-0.2, 1.0, 0.0);
        for at in positions(&frames, Side::Left) {
            assert!(at.distance(before) * 90.0 < 0.82);
            before = at;
        }
    }
}

#[test]
fn a_turn_alone_keeps_every_bit_of_the_place() {
    let frames = frames("Move(hand: Right, turn: (0, 90, 0), over: 0.5)");
    assert!(
        positions(&frames, Side::Right)
            .iter()
            .all(|&p| p == Vec3::new(0.2, 1.0, 0.0))
    );
    let end = frames
        .last()
        .and_then(|f| f.input.frames[1].pose)
        .expect("tracked");
    let want = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2);
    assert!(end.rotation.angle_between(want) < 1e-3);
}

#[test]
fn both_hands_arrive_together() {
    let frames = frames("Both(left: (by: (-0.2, 0, 0)), right: (to: (0.5, 1, 0)), over: 0.5)");
    let last = frames.last().expect("frames");
    assert_eq!(frames.len(), 45);
    assert_eq!(last.input.frames[0].pose.map(|p| p.position.x), Some(-0.4));
    assert_eq!(last.input.frames[1].pose.map(|p| p.position.x), Some(0.5));
}

#[test]
fn clicks_holds_and_double_clicks_last_as_long_as_their_names_say() {
    let downs = |steps, action| -> Vec<f32> {
        let frames = frames(steps);
        let mut runs = Vec::new();
        let mut was = false;
        for f in &frames {
            let down = f.input.frames[1].down.has(action);
            if down && !was {
                runs.push(0.0);
            }
            if down && let Some(run) = runs.last_mut() {
                *run += f.dt.as_secs_f32();
            }
            was = down;
        }
        assert!(!was, "let go at the end");
        runs
    };
    let click = downs("Click(Right, Act)", Action::Act);
    assert!(click.len() == 1 && click[0] < HOLD);
    let hold = downs("Hold(Right, Centre)", Action::Centre);
    assert!(hold.len() == 1 && hold[0] > HOLD + 0.05);
    let double = downs("DoubleClick(Right, Centre)", Action::Centre);
    assert!(double.len() == 2 && double[0] * 2.0 < DOUBLE_PRESS);
    let pressed = frames("Press(Right, Grab), Wait(1)");
    assert!(
        pressed
            .iter()
            .all(|f| f.input.frames[1].down.has(Action::Grab))
    );
}

#[test]
fn the_pad_is_touched_and_slid_over() {
    let frames = frames(
        "Touch(Right, (0, -1)), Slide(hand: Right, to: (0.5, 1), over: 0.2), Untouch(Right)",
    );
    let swipe = |f: &FrameBeat| f.input.frames[1].swipe;
    assert_eq!(swipe(&frames[0]), Some(Vec2::new(0.0, -1.0)));
    assert_eq!(swipe(&frames[frames.len() - 2]), Some(Vec2::new(0.5, 1.0)));
    assert_eq!(frames.last().and_then(swipe), None);
}

#[test]
fn what_is_asked_for_is_asked_once_in_one_frame() {
    let frames = frames(
        "Ask(Undo), Wait(0.1), Asked([Redo, ToggleLibrary]), Click(Right, Act), Asked([Undo])",
    );
    let asked: Vec<_> = frames
        .iter()
        .enumerate()
        .flat_map(|(i, f)| f.commands.iter().map(move |c| (i, c.clone())))
        .collect();
    let last = frames.len() - 1;
    assert_eq!(
        asked,
        [
            (0, Command::Undo),
            (10, Command::Redo),
            (10, Command::ToggleLibrary),
            (last, Command::Undo)
        ]
    );
}

#[test]
fn a_lost_hand_goes_on_from_where_it_was() {
    let frames = frames("Lose(Right), Wait(0.5), Move(hand: Right, by: (0.1, 0, 0), over: 0.5)");
    assert!(frames[0].input.frames[1].pose.is_none());
    let end = frames
        .last()
        .and_then(|f| f.input.frames[1].pose)
        .expect("back");
    assert_eq!(end.position, Vec3::new(0.2, 1.0, 0.0) + Vec3::X * 0.1);
}

#[test]
fn a_jump_may_be_unsound_and_a_move_after_it_is_not() {
    let frames = frames(
        "Jump(hand: Left, to: (NaN, 0, 0), turn: (0, 0, 0, 0)), Move(hand: Left, to: (0, 1, 0))",
    );
    let pose = frames[0].input.frames[0].pose.expect("passed on");
    assert!(pose.position.x.is_nan() && !pose.is_sound());
    assert!(
        frames[1..]
            .iter()
            .all(|f| f.input.frames[0].pose.is_some_and(|p| p.is_sound()))
    );
}

fn refused(steps: &str) -> HandsOnlyFault {
    check_hands_only(&session(steps)).expect_err(steps)
}

#[test]
fn hands_only_takes_what_hands_can_do() {
    let ok = |steps| check_hands_only(&session(steps)).expect(steps);
    ok("Move(hand: Right, by: (5, 0, 0)), Click(Right, Act), Ask(Undo), Ask(Mode(\"csg\"))");
    // 1.5 m/s at the mean is 2 m/s at the peak.
    ok("Move(hand: Right, by: (1.5, 0, 0), over: 1)");
    ok(
        "Jump(hand: Right, to: (0.21, 1, 0)), Lose(Left), Wait(1), Move(hand: Left, by: (0, 0, 0.1))",
    );
    ok("Lose(Right), Wait(2), Jump(hand: Right, to: (1, 1, 0))");
}

#[test]
fn hands_only_refuses_speed_jumps_and_poses_that_are_none() {
    let fast = refused("Wait(1), Move(hand: Right, by: (0, 1.6, 0), over: 1)");
    assert!(matches!(fast, HandsOnlyFault::TooFast { .. }));
    let line = fast.to_string();
    assert!(
        line.contains("t.ron:1:") && line.contains("step 2, Move"),
        "{line}"
    );
    assert!(
        line.contains("right hand") && line.contains("2 m/s"),
        "{line}"
    );
    for steps in [
        "Jump(hand: Left, to: (1, 1, 0))",
        "Wait(1), Jump(hand: Left, to: (1, 1, 0))",
        // Losing a hand is no way round.
        "Lose(Left), Jump(hand: Left, to: (1, 1, 0))",
        "Wait(5), Lose(Left), Wait(0.2), Jump(hand: Left, to: (1, 1, 0))",
    ] {
        assert!(
            matches!(refused(steps), HandsOnlyFault::TooFast { .. }),
            "{steps}"
        );
    }
    for to in ["(NaN, 0, 0)", "(0, inf, 0)"] {
        let fault = refused(&format!("Jump(hand: Left, to: {to})"));
        assert!(matches!(fault, HandsOnlyFault::NoPose { .. }), "{to}");
    }
}
