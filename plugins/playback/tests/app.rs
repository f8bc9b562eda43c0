//! Whole apps: what is recorded plays back bit for bit, and plays back into the same recording.

use std::{fs, path::Path, time::Duration};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use midair_playback::{
    Arrivals, ObjectReport, OffFrame, PlayError, PlayOptions, PlayerPlugin, RecorderPlugin, Report,
    Session, play,
};
use midair_studio::{
    StudioSet,
    command::Command,
    evaluate::{Delivery, Job},
    hands::{Action, AdvanceHands, Hands, HandsInput, Pose, Side},
    notice::Notices,
};

/// The studio's hands, without the rest of it.
fn hands_only_app() -> App {
    let mut app = App::new();
    app.add_plugins(MinimalPlugins)
        .init_resource::<HandsInput>()
        .init_resource::<Hands>()
        .init_resource::<Notices>()
        .init_resource::<Seen>()
        .add_message::<Command>()
        .configure_sets(
            Update,
            (
                StudioSet::Gather,
                StudioSet::Ask,
                StudioSet::Act,
                StudioSet::Rebuild,
                StudioSet::Cue,
            )
                .chain(),
        )
        .add_systems(
            Update,
            (
                advance.in_set(StudioSet::Gather).in_set(AdvanceHands),
                note.in_set(StudioSet::Ask),
                follow.in_set(StudioSet::Act),
            ),
        );
    app
}

fn advance(input: Res<HandsInput>, time: Res<Time>, mut hands: ResMut<Hands>) {
    hands.advance(&input, time.delta_secs());
}

/// All that the app came to know, frame by frame.
#[derive(Resource, Default, PartialEq, Debug, Clone)]
struct Seen(Vec<String>);

fn note(
    hands: Res<Hands>,
    time: Res<Time>,
    mut asked: MessageReader<Command>,
    mut seen: ResMut<Seen>,
) {
    let bits = |p: &Pose| {
        (
            p.position.to_array().map(f32::to_bits),
            p.rotation.to_array().map(f32::to_bits),
        )
    };
    let hands = hands.both().map(|(_, h)| {
        let held: Vec<Action> = Action::ALL.into_iter().filter(|&a| h.held(a)).collect();
        (bits(&h.pose), h.tracked, held, h.swipe)
    });
    let asked: Vec<&Command> = asked.read().collect();
    let (dt, elapsed) = (time.delta(), time.elapsed());
    seen.0
        .push(format!("{dt:?} {elapsed:?} {hands:?} {asked:?}"));
}

/// A tool that asks for something when a button goes down: not to be recorded.
fn follow(hands: Res<Hands>, mut ask: MessageWriter<Command>) {
    if hands.pressed(Action::Undo).is_some() {
        ask.write(Command::Undo);
    }
}

/// A device: hands that move, press and are lost, and a panel that asks.
fn device(mut input: ResMut<HandsInput>, mut frame: Local<u64>, mut ask: MessageWriter<Command>) {
    let t = *frame as f32 * 0.013;
    for side in Side::BOTH {
        let hand = input.side(side);
        let lost = (*frame / 40) % 5 == 3 && side == Side::Left;
        hand.pose = (!lost).then(|| Pose {
            position: Vec3::new(
                t.sin(),
                1.0 + (t * 3.7).cos() * 0.1,
                side as u8 as f32 - t * 0.01,
            ),
            rotation: Quat::from_rotation_y(t * 0.7),
        });
        hand.down.set(Action::Grab, (*frame / 25) % 2 == 1);
        hand.down.set(Action::Undo, (*frame / 10) % 3 == 2);
        hand.down.set(Action::Centre, (*frame / 7) % 4 == 1);
        hand.swipe = ((*frame / 30) % 2 == 1).then(|| Vec2::new(t.cos(), t.sin()));
    }
    if *frame == 33 {
        ask.write(Command::Save);
        ask.write(Command::Redo);
    }
    *frame += 1;
}

fn panel(mut frame: Local<u64>, mut ask: MessageWriter<Command>) {
    if *frame % 100 == 57 {
        ask.write(Command::ToggleLibrary);
    }
    *frame += 1;
}

/// Runs a live app for `frames` frames at an uneven pace.
fn live(path: &Path, frames: u64) -> Seen {
    let mut app = hands_only_app();
    app.add_plugins(RecorderPlugin::create(path, "live").expect("a file"))
        .add_systems(
            Update,
            device.in_set(StudioSet::Gather).before(AdvanceHands),
        )
        .add_systems(PostUpdate, panel);
    app.finish();
    app.cleanup();
    for i in 0..frames {
        let dt = Duration::from_nanos(11_111_111 + (i * 7919) % 300_001);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(dt));
        app.update();
    }
    app.world().resource::<Seen>().clone()
}

fn played(path: &Path, again: Option<&Path>) -> (Seen, Report) {
    let mut app = hands_only_app();
    app.add_plugins(PlayerPlugin);
    if let Some(again) = again {
        app.add_plugins(RecorderPlugin::create(again, "live").expect("a file"));
    }
    let session = Session::load(path).expect("a session");
    let report = play(&mut app, session, PlayOptions::default()).expect("played");
    let seen = app.world().resource::<Seen>().clone();
    (seen, report)
}

#[test]
fn a_recording_plays_back_bit_for_bit_and_records_the_same_bytes() {
    let dir = tempfile::tempdir().expect("a folder");
    let (a, b) = (dir.path().join("a.ron"), dir.path().join("b.ron"));
    let frames = 700;
    let was = live(&a, frames);
    let (is, report) = played(&a, Some(&b));
    assert_eq!(report.frames, frames);
    for (i, (was, is)) in was.0.iter().zip(&is.0).enumerate() {
        assert_eq!(was, is, "frame {i}");
    }
    assert_eq!(fs::read(&a).expect("read"), fs::read(&b).expect("read"));
}

#[test]
fn a_cut_recording_plays_up_to_its_end_and_the_report_says_so() {
    let dir = tempfile::tempdir().expect("a folder");
    let a = dir.path().join("a.ron");
    let was = live(&a, 500);
    let text = fs::read(&a).expect("read");
    fs::write(&a, &text[..text.len() / 2]).expect("written");
    let (is, report) = played(&a, None);
    let n = report.frames as usize;
    assert!((80..500).contains(&n), "{n}");
    assert_eq!(was.0[..n], is.0[..n]);
    assert!(
        report
            .warnings
            .iter()
            .any(|w| w.contains("ends in the middle"))
    );
}

fn run(app: &mut App, text: &str, options: PlayOptions) -> Result<Report, PlayError> {
    app.add_plugins(PlayerPlugin);
    play(
        app,
        Session::parse(text, "t.ron").expect("a session"),
        options,
    )
}

#[test]
fn the_first_frame_takes_its_time_and_the_report_counts() {
    let mut app = hands_only_app();
    let text = "(format: 1, title: \"T\", dt: 0.01, steps: [Wait(0.5), Click(Right, Act)])";
    let report = run(&mut app, text, PlayOptions::default()).expect("played");
    assert_eq!((report.frames, report.steps), (65, 2));
    assert!((report.seconds - 0.65).abs() < 1e-9);
    assert!(report.frame_ms.max >= report.frame_ms.median);
    assert!(app.world().resource::<Seen>().0[0].starts_with("10ms 10ms"));
    let json = serde_json::to_value(&report).expect("json");
    for field in [
        "objects", "lines", "strokes", "edits", "undo", "redo", "updates", "frames", "warnings",
    ] {
        assert!(json.get(field).is_some(), "{field}");
    }
}

#[test]
fn expectations_end_a_session_with_the_line_of_the_step() {
    let probe = |_: &mut World| Report {
        objects: vec![ObjectReport {
            name: "Sphere".into(),
            volume: Some(0.5),
            closed: Some(true),
            ..Default::default()
        }],
        edits: 2,
        ..Default::default()
    };
    let options = PlayOptions {
        probe,
        ..Default::default()
    };
    let ok = |expect: &str| {
        let text = format!("(format: 1, steps: [Wait(0.1), Expect({expect})])");
        run(&mut hands_only_app(), &text, options).map_err(|e| e.to_string())
    };
    ok("objects: 1, closed: true, volume: (0.4, 0.6), edits: 2, warnings: 0").expect("holds");
    for (expect, part) in [
        ("objects: 2", "objects: 1 instead of 2"),
        ("closed: false", "`Sphere` is closed"),
        ("volume: (0, 0.1)", "volume: 0.5"),
        ("undo: 1", "undo: 0 instead of 1"),
    ] {
        let line = ok(expect).expect_err(expect);
        assert!(
            line.contains("t.ron:1:") && line.contains("step 2, Expect"),
            "{line}"
        );
        assert!(line.contains(part), "{line}");
    }
}

#[test]
fn hands_only_refuses_before_the_first_frame() {
    let mut app = hands_only_app();
    let text = "(format: 1, steps: [Wait(1), Jump(hand: Left, to: (9, 9, 9))])";
    let options = PlayOptions {
        hands_only: true,
        ..Default::default()
    };
    let line = run(&mut app, text, options)
        .expect_err("refused")
        .to_string();
    assert!(
        line.contains("step 2, Jump") && line.contains("--hands-only"),
        "{line}"
    );
    assert!(app.world().resource::<Seen>().0.is_empty());
}

#[test]
fn poses_that_are_none_are_passed_on() {
    let mut app = hands_only_app();
    let text = "(format: 1, steps: [Jump(hand: Left, to: (NaN, 0, 0)), Wait(0.1)])";
    run(&mut app, text, PlayOptions::default()).expect("played");
    assert!(!app.world().resource::<Hands>().get(Side::Left).tracked);
}

/// Background work in which a job takes some polls to finish.
#[derive(Resource, Default)]
struct Work {
    /// Each with the polls it still needs.
    running: Vec<(Job, std::sync::atomic::AtomicU32)>,
    delivery: Delivery,
    delivered: Vec<Job>,
    log: Vec<(u64, Job)>,
    frame: u64,
    /// Jobs finish after so many polls; never where `None`.
    polls: Option<u32>,
}

struct Seam;

impl OffFrame for Seam {
    fn unfinished(&self, world: &World) -> usize {
        use std::sync::atomic::Ordering::Relaxed;
        let work = world.resource::<Work>();
        for (_, left) in &work.running {
            let _ = left.fetch_update(Relaxed, Relaxed, |n| {
                work.polls.map(|_| n.saturating_sub(1))
            });
        }
        work.running
            .iter()
            .filter(|(_, n)| n.load(Relaxed) > 0)
            .count()
    }
    fn waiting(&self, world: &World) -> usize {
        let work = world.resource::<Work>();
        work.running.len() - self.unfinished(world).min(work.running.len())
    }
    fn is_waiting(&self, world: &World, job: Job) -> bool {
        self.unfinished(world);
        let done =
            |n: &std::sync::atomic::AtomicU32| n.load(std::sync::atomic::Ordering::Relaxed) == 0;
        world
            .resource::<Work>()
            .running
            .iter()
            .any(|(j, n)| *j == job && done(n))
    }
    fn deliver(&self, world: &mut World, delivery: Delivery) {
        world.resource_mut::<Work>().delivery = delivery;
    }
    fn delivered(&self, world: &World) -> Vec<Job> {
        world.resource::<Work>().delivered.clone()
    }
}

/// Takes in, then starts: a press of act starts a job.
fn work(mut work: ResMut<Work>, hands: Res<Hands>) {
    use std::sync::atomic::Ordering::Relaxed;
    let work = &mut *work;
    let (frame, delivery) = (work.frame, work.delivery.clone());
    work.delivered.clear();
    let mut left = Vec::new();
    for (job, n) in work.running.drain(..) {
        let due = match &delivery {
            Delivery::Exactly(jobs) => jobs.contains(&job),
            _ => n.load(Relaxed) == 0,
        };
        if due {
            work.delivered.push(job);
            work.log.push((frame, job));
        } else {
            left.push((job, n));
        }
    }
    work.running = left;
    if hands.pressed(Action::Act).is_some() {
        work.running
            .push((Job(frame), work.polls.unwrap_or(1).into()));
    }
    work.frame += 1;
}

fn working_app(polls: Option<u32>) -> App {
    let mut app = hands_only_app();
    app.insert_resource(Work {
        polls,
        ..Default::default()
    })
    .insert_resource(Arrivals(Box::new(Seam)))
    .add_systems(Update, work.in_set(StudioSet::Rebuild));
    app
}

const CLICKS: &str =
    "(format: 1, steps: [Click(Right, Act), Click(Left, Act), Wait(0.2), Click(Right, Act)])";

#[test]
fn a_written_session_waits_for_what_it_asked_for() {
    let mut app = working_app(Some(5));
    run(&mut app, CLICKS, PlayOptions::default()).expect("played");
    let log = app.world().resource::<Work>().log.clone();
    // Each arrives in the frame after it was asked for, the last one after the last step.
    assert_eq!(log.len(), 3);
    assert!(
        log.iter().all(|&(frame, job)| frame == job.0 + 1),
        "{log:?}"
    );
}

#[test]
fn recorded_results_arrive_in_the_frames_they_came_in() {
    let dir = tempfile::tempdir().expect("a folder");
    let (a, b) = (dir.path().join("a.ron"), dir.path().join("b.ron"));
    // Live: jobs come some frames late.
    let mut app = working_app(Some(9));
    app.add_plugins(RecorderPlugin::create(&a, "late").expect("a file"))
        .add_systems(
            Update,
            device_clicks.in_set(StudioSet::Gather).before(AdvanceHands),
        );
    app.finish();
    app.cleanup();
    for _ in 0..200 {
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(
            10,
        )));
        app.update();
        Seam.unfinished(app.world());
    }
    let live = app.world().resource::<Work>().log.clone();
    assert!(
        live.len() > 3 && live.iter().all(|(f, j)| *f > j.0 + 3),
        "{live:?}"
    );
    drop(app);
    // Slower and faster machines.
    for polls in [1, 40] {
        let mut app = working_app(Some(polls));
        app.add_plugins((
            PlayerPlugin,
            RecorderPlugin::create(&b, "late").expect("a file"),
        ));
        let session = Session::load(&a).expect("a session");
        play(&mut app, session, PlayOptions::default()).expect("played");
        let log = app.world().resource::<Work>().log.clone();
        assert_eq!(log[..live.len()], live, "with {polls} polls");
        drop(app);
        assert_eq!(fs::read(&a).expect("read"), fs::read(&b).expect("read"));
    }
}

fn device_clicks(mut input: ResMut<HandsInput>, mut frame: Local<u64>) {
    let down = (*frame / 13) % 3 == 1;
    input.side(Side::Right).down.set(Action::Act, down);
    *frame += 1;
}

#[test]
fn work_that_never_ends_ends_the_session_with_a_line() {
    let mut app = working_app(None);
    let options = PlayOptions {
        patience: Duration::from_millis(30),
        ..Default::default()
    };
    let line = run(&mut app, CLICKS, options)
        .expect_err("stuck")
        .to_string();
    assert!(
        line.contains("t.ron:1:") && line.contains("background work"),
        "{line}"
    );
}

#[test]
fn a_recording_of_something_else_is_said_to_be_one() {
    let text = "(format: 1, recorded: true, steps: [Ready([5]), Wait(0.1)])";
    let line = run(&mut working_app(Some(1)), text, PlayOptions::default())
        .expect_err("diverged")
        .to_string();
    assert!(
        line.contains("t.ron:1:") && line.contains("nobody asked for"),
        "{line}"
    );
}

#[test]
fn a_full_disk_is_a_notice_and_the_app_goes_on() {
    if !cfg!(target_os = "linux") {
        return;
    }
    // Creating may fail at once, which is as good.
    let Ok(recorder) = RecorderPlugin::create(Path::new("/dev/full"), "full") else {
        return;
    };
    let mut app = hands_only_app();
    app.add_plugins(recorder);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(
        100,
    )));
    let since = std::time::Instant::now();
    while app.world().resource::<Notices>().warnings().is_empty() {
        assert!(since.elapsed() < Duration::from_secs(20), "no notice");
        app.update();
    }
    assert!(app.world().resource::<Notices>().warnings()[0].contains("/dev/full"));
}
