//! Recorded frames come back bit for bit, and bad ones are refused.

use std::time::Duration;

use bevy::math::{Quat, Vec2, Vec3};
use midair_playback::{Frame, FrameRun, FrameRunBuilder};
use midair_studio::hands::{Action, ActionSet, HandFrame, HandsInput, Pose};
use proptest::prelude::*;

/// Any 32 bits as a number: NaNs of all kinds, infinities, −0 and the smallest included.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        any::<u32>().prop_map(f32::from_bits),
        Just(f32::NAN),
        Just(-0.0),
        Just(f32::NEG_INFINITY),
        -2.0f32..2.0,
    ]
}

fn pose() -> impl Strategy<Value = Pose> {
    prop::array::uniform7(number()).prop_map(|[x, y, z, i, j, k, w]| Pose {
        position: Vec3::new(x, y, z),
        rotation: Quat::from_xyzw(i, j, k, w),
    })
}

fn hand() -> impl Strategy<Value = HandFrame> {
    let swipe = prop::array::uniform2(number()).prop_map(Vec2::from_array);
    (
        prop::option::of(pose()),
        prop::collection::vec(prop::sample::select(Action::ALL.to_vec()), 0..4),
        prop::option::of(swipe),
    )
        .prop_map(|(pose, down, swipe)| HandFrame {
            pose,
            down: down.into_iter().collect::<ActionSet>(),
            swipe,
        })
}

fn frame() -> impl Strategy<Value = Frame> {
    (
        any::<u32>(),
        prop::array::uniform2(hand()),
        prop::option::of(pose()),
        number(),
    )
        .prop_map(|(nanos, frames, head, metres_per_world)| Frame {
            dt: Duration::from_nanos(u64::from(nanos)),
            input: HandsInput {
                frames,
                head,
                metres_per_world,
                pixel: 1e-3 * metres_per_world,
            },
        })
}

/// Frames as bits, for comparison.
fn bits(f: &Frame) -> String {
    let pose = |p: &Option<Pose>| {
        p.map(|p| {
            (
                p.position.to_array().map(f32::to_bits),
                p.rotation.to_array().map(f32::to_bits),
            )
        })
    };
    let hands = f.input.frames.map(|h| {
        (
            pose(&h.pose),
            h.down,
            h.swipe.map(|s| s.to_array().map(f32::to_bits)),
        )
    });
    let scale = f.input.metres_per_world.to_bits();
    let head = (pose(&f.input.head), f.input.pixel.to_bits());
    format!("{:?}{hands:?}{head:?}{scale}", f.dt)
}

fn pack(frames: &[Frame]) -> FrameRun {
    let mut builder = FrameRunBuilder::default();
    frames.iter().for_each(|f| builder.push(f));
    builder.take()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn frames_come_back_bit_for_bit(
        parts in prop::collection::vec((frame(), 1usize..4), 0..12),
    ) {
        let frames: Vec<Frame> = parts
            .iter()
            .flat_map(|(f, n)| std::iter::repeat_n(*f, *n))
            .collect();
        let run = pack(&frames);
        prop_assert_eq!(run.frames(), frames.len() as u64);
        let text = ron::to_string(&run).expect("text");
        let read: FrameRun = ron::from_str(&text).expect("read again");
        prop_assert_eq!(&read, &run);
        let back: Vec<String> = read.iter().map(|f| bits(&f)).collect();
        let want: Vec<String> = frames.iter().map(bits).collect();
        prop_assert_eq!(back, want);
        prop_assert_eq!(read.duration(), frames.iter().map(|f| f.dt).sum::<Duration>());
    }

    #[test]
    fn any_bytes_are_frames_or_a_fault(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Ok(run) = FrameRun::from_bytes(bytes) {
            prop_assert!(run.iter().take(1000).count() as u64 <= run.frames());
        }
    }

    #[test]
    fn a_run_cut_anywhere_is_a_shorter_run_or_a_fault(
        frames in prop::collection::vec(frame(), 1..6),
        cut in any::<prop::sample::Index>(),
    ) {
        let whole = pack(&frames);
        let text = whole.to_base64();
        let part = &text[..cut.index(text.len())];
        if let Ok(run) = ron::from_str::<FrameRun>(&format!("\"{part}\"")) {
            prop_assert!(run.frames() <= whole.frames());
        }
    }
}

#[test]
fn still_hands_cost_nothing() {
    let still = Frame {
        dt: Duration::from_nanos(11_111_111),
        input: HandsInput::default(),
    };
    let run = pack(&vec![still; 100_000]);
    assert!(run.to_base64().len() < 20, "{}", run.to_base64());
    assert_eq!(run.iter().count(), 100_000);
}
