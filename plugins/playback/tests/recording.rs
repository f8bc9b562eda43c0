//! Recordings: streamed, bounded, playable wherever they end.

use std::{fs, path::Path, sync::Arc, time::Duration};

use bevy::math::{Quat, Vec3};
use midair_playback::{Beat, Frame, FrameBeat, MAX_FRAMES, Recording, Session};
use midair_studio::{
    command::Command,
    evaluate::Job,
    hands::{Action, HandsInput, Pose, Side},
};

/// Two hands that move like hands: smooth, with the jitter of a tracker and of a clock.
fn live(i: u64) -> Frame {
    let t = i as f32 / 90.0;
    let jitter = |salt: u64| {
        let mixed = (i ^ (salt << 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed >> 40) as f32 / (1 << 24) as f32 - 0.5
    };
    let mut input = HandsInput::default();
    for (n, side) in Side::BOTH.into_iter().enumerate() {
        let n = n as u64 * 8;
        let wave = Vec3::new(
            (t * 1.1).sin(),
            1.0 + 0.1 * (t * 0.7).cos(),
            0.2 * (t * 0.3).sin(),
        );
        let noise = Vec3::new(jitter(n + 1), jitter(n + 2), jitter(n + 3)) * 1e-4;
        input.side(side).pose = Some(Pose {
            position: wave + noise,
            rotation: Quat::from_rotation_y((t * 0.5).sin() + jitter(n + 4) * 1e-4).normalize(),
        });
        input.side(side).down.set(Action::Grab, (i / 200) % 2 == 1);
    }
    Frame {
        dt: Duration::from_nanos(11_111_111 + (jitter(99) * 4e5) as u64),
        input,
    }
}

fn frames(session: &Arc<Session>) -> impl Iterator<Item = FrameBeat> {
    session.cursor().filter_map(|b| match b {
        Beat::Frame(f) => Some(f),
        Beat::Check(_) => None,
    })
}

fn record(path: &Path, count: u64) -> Recording {
    let mut recording = Recording::create(path, "a test").expect("a file");
    for i in 0..count {
        let asked: &[Command] = match i {
            50 => &[Command::Undo, Command::Redo],
            120 => &[Command::Save],
            _ => &[],
        };
        let ready: &[Job] = match i {
            60 => &[Job(7), Job(u64::MAX)],
            120 => &[Job(3)],
            _ => &[],
        };
        recording.push(&live(i), asked, ready);
    }
    recording
}

fn load(path: &Path) -> Arc<Session> {
    Arc::new(Session::load(path).expect("a session"))
}

#[test]
fn what_is_recorded_is_what_is_played() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("a.ron");
    record(&path, 500).finish().expect("written");
    let session = load(&path);
    assert!(session.is_recorded() && !session.is_truncated());
    assert_eq!(session.title(), "a test");
    let played: Vec<_> = frames(&session).collect();
    assert_eq!(played.len(), 500);
    for (i, f) in played.iter().enumerate() {
        let want = live(i as u64);
        assert_eq!((f.dt, f.input), (want.dt, want.input), "frame {i}");
        assert_eq!(
            f.commands.len(),
            match i {
                50 => 2,
                120 => 1,
                _ => 0,
            }
        );
        assert_eq!(
            f.ready.len(),
            match i {
                60 => 2,
                120 => 1,
                _ => 0,
            }
        );
    }
    assert_eq!(played[60].ready, [Job(7), Job(u64::MAX)]);
}

#[test]
fn a_recording_cut_anywhere_plays_up_to_its_end() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("a.ron");
    record(&path, 400).finish().expect("written");
    let whole = fs::read(&path).expect("read");
    let first = whole
        .windows(8)
        .position(|w| w == b"Frames(\"")
        .expect("frames");
    let first_line = first
        + whole[first..]
            .iter()
            .position(|&b| b == b'\n')
            .expect("a line");
    let cut = dir.path().join("cut.ron");
    for at in (first_line..whole.len())
        .step_by(37)
        .chain(whole.len() - 4..whole.len())
    {
        fs::write(&cut, &whole[..at]).expect("written");
        let session = load(&cut);
        assert!(
            session.is_truncated() || at + 1 >= whole.len(),
            "cut at {at}"
        );
        let played = frames(&session).count();
        assert_eq!(played as u64, session.frames());
        assert!((50..=400).contains(&played), "{played} frames at {at}");
    }
    // What a file system leaves behind after a crash.
    let mut zeros = whole[..whole.len() / 2].to_vec();
    zeros.resize(zeros.len() + 4096, 0);
    fs::write(&cut, zeros).expect("written");
    assert!(load(&cut).is_truncated());
    // A fault in the middle is not an end.
    let mut bad = whole.clone();
    bad[first_line - 1] = b'?';
    fs::write(&cut, bad).expect("written");
    let e = Session::load(&cut).expect_err("broken").to_string();
    assert!(e.contains("cut.ron:"), "{e}");
}

#[test]
fn a_recording_that_is_dropped_is_whole() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("a.ron");
    drop(record(&path, 130));
    let session = load(&path);
    assert!(!session.is_truncated());
    assert_eq!(session.frames(), 130);
}

#[test]
fn a_crash_leaves_what_was_written() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("a.ron");
    let recording = record(&path, 1000);
    // No end is written: as after a kill, at most a second is missing once the writer is idle.
    let patience = std::time::Instant::now();
    let played = loop {
        let played = Session::load(&path).map_or(0, |s| s.frames());
        if played >= 900 || patience.elapsed() > Duration::from_secs(10) {
            break played;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    assert!((900..=1000).contains(&played), "{played}");
    drop(recording);
}

#[test]
fn a_million_frames_stream_and_stay_small() {
    const MILLION: u64 = 1_000_000;
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("a.ron");
    // Every fourth second moves: three hours of work at 90 Hz.
    let frame = |i: u64| {
        if (i / 90) % 4 == 1 {
            live(i)
        } else {
            live(i / 360 * 360)
        }
    };
    let mut recording = Recording::create(&path, "long").expect("a file");
    for i in 0..MILLION {
        recording.push(&frame(i), &[], &[]);
    }
    recording.finish().expect("written");
    let bytes = fs::metadata(&path).expect("a file").len();
    assert!(bytes < 30 * MILLION, "{bytes} bytes");
    let session = load(&path);
    assert_eq!(session.frames(), MILLION);
    for (i, f) in frames(&session).enumerate() {
        let want = frame(i as u64);
        assert!((f.dt, f.input) == (want.dt, want.input), "frame {i}");
    }
}

#[test]
fn a_recording_ends_by_itself_at_the_limit() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("a.ron");
    let mut recording = Recording::create(&path, "too long").expect("a file");
    let mut pushed = 0;
    while recording.is_open() {
        recording.push(
            &Frame {
                dt: Duration::ZERO,
                input: HandsInput::default(),
            },
            &[],
            &[],
        );
        pushed += 1;
    }
    assert_eq!(pushed, MAX_FRAMES + 1);
    let line = recording.finish().expect_err("ended").to_string();
    assert!(line.contains("a.ron") && line.contains("4 hours"), "{line}");
}

#[test]
fn a_file_that_cannot_be_made_is_named() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("no").join("a.ron");
    let line = Recording::create(&path, "")
        .err()
        .expect("no folder")
        .to_string();
    assert!(
        line.contains("a.ron") && line.contains("cannot be recorded to"),
        "{line}"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_recording_with_one_line() {
    let full = Path::new("/dev/full");
    let said = match Recording::create(full, "full") {
        Err(e) => e.to_string(),
        Ok(mut recording) => {
            for i in 0..200 {
                recording.push(&live(i), &[], &[]);
            }
            recording.finish().expect_err("full").to_string()
        }
    };
    assert!(
        said.contains("/dev/full") && said.contains("space"),
        "{said}"
    );
}

#[test]
fn titles_and_paths_are_written_so_that_they_are_read_again() {
    let dir = tempfile::tempdir().expect("a folder");
    let path = dir.path().join("a.ron");
    let title = "a \"title\"\nwith \\ and ü";
    let mut recording = Recording::create(&path, title).expect("a file");
    let asked = [
        Command::Open("a \"b\"\n/c.midair".into()),
        Command::Step(0.1),
    ];
    recording.push(&live(0), &asked, &[]);
    recording.finish().expect("written");
    let session = load(&path);
    assert_eq!(session.title(), title);
    assert_eq!(
        frames(&session).next().map(|f| f.commands),
        Some(asked.to_vec())
    );
}
