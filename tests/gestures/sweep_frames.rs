//! What Sweep costs a frame.

use std::time::Instant;

use bevy::prelude::*;
use midair_document::ObjectId;
use midair_field::Node;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::project::Selection;
use midair_studio::settings::SweepShape;
use midair_sweep::Wires;

use crate::studio::Studio;
use crate::sweep::{LEFT, RIGHT};

#[test]
fn a_frame_sends_what_is_new_and_not_the_surface() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Surface);
    studio.press(Side::Right, Action::Act);
    let mut bytes = Vec::new();
    for i in 0..300 {
        for (side, at) in [(Side::Left, LEFT), (Side::Right, RIGHT)] {
            studio.put(side, Pose::at(at + Vec3::Z * (-0.0105 * i as f32)));
        }
        let before = Instant::now();
        studio.frame();
        let _ = before.elapsed();
        bytes.push(studio.world().resource::<Wires>().bytes());
    }
    let ribs = studio.swinging().ribs.len();
    assert!(ribs > 250, "{ribs}");
    let (early, late) = (
        bytes[20..60].iter().max().unwrap(),
        bytes[240..].iter().max().unwrap(),
    );
    println!("bytes sent in a frame at 20 to 60 curves {early}, at 240 to {ribs} {late}");
    assert_eq!(early, late);
    studio.let_go(Side::Right, Action::Act);
    // Once its surface is there and was seen for a moment.
    studio.settle();
    studio.frames(20);
    assert_eq!(
        studio.world().resource::<Wires>().pieces(),
        0,
        "the net is put away"
    );
    assert_eq!(studio.world().resource::<Selection>().0.len(), 1);
}

/// Measured where nothing is drawn: what the main schedule does.
#[test]
fn a_hundred_thousand_clones_cost_a_frame_nothing() {
    let mut studio = Studio::new();
    studio.sweeping(SweepShape::Clones);
    studio.set("spread", true);
    studio.set("clones", 256);
    studio.set("clone_size", 0.004);
    studio.set("paced", false);
    // Thinned to the clones' own distance: 400 curves and more.
    studio.both(LEFT, RIGHT, 0.3);
    let ribs: Vec<_> = (0..400)
        .map(|i| {
            studio
                .swinging()
                .live
                .unwrap()
                .shifted(Vec3::Z * (-0.004 * i as f32))
        })
        .collect();
    let ball = midair_field::Recipe::from(midair_field::Primitive::Sphere { radius: 0.002 });
    let row = midair_field::Row {
        ribs: ribs.into(),
        count: 256,
        size: 1.0,
        paced: false,
    };
    let recipe = midair_field::Recipe::new(Node::Clones { row, recipe: ball });
    let id = ObjectId(studio.document().next_id());
    let object = midair_document::Object::solid("Clones", recipe).into();
    studio.ask(Command::Edit(midair_document::Edit::Add { id, object }));
    studio.settle();
    let at = studio
        .world()
        .resource::<midair_studio::show::ObjectMap>()
        .get(id)
        .unwrap();
    let pieces = studio.world().get::<Children>(at).map_or(0, |c| c.len());
    assert!((1..200).contains(&pieces), "{pieces}");
    studio.frames(10);
    // Frames alone: what the tests look at after each would be measured with it.
    let mut times: Vec<f64> = (0..400)
        .map(|i| {
            let turn = Quat::from_rotation_y(i as f32 * 0.01);
            let position = LEFT + Vec3::Y;
            let rotation = turn;
            studio.put(Side::Left, Pose { position, rotation });
            let before = Instant::now();
            studio.app_update();
            before.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!(
        "102,400 clones in {pieces} pieces: a frame takes {:.2} ms undisturbed, {:.2} in the median, {:.2} at the 99th, {:.2} at most",
        times[40], times[200], times[396], times[399]
    );
    // For a machine that has other things to do.
    assert!(times[40] < 20.0, "{}", times[40]);
    assert!(studio.warnings().is_empty(), "{:?}", studio.warnings());
}

/// Table 1 of the paper, as far as the processor is concerned: frames of the whole main schedule while
/// the last of so many curves is dragged, against frames in which the curve only hangs there.
#[test]
fn a_frame_while_sweeping_costs_little_more_than_one_at_rest() {
    for (count, ribs, clones) in [
        (48, 271, false),
        (48, 2131, false),
        (64, 125, true),
        (64, 644, true),
    ] {
        let mut studio = Studio::new();
        studio.sweeping(if clones {
            SweepShape::Clones
        } else {
            SweepShape::Surface
        });
        studio.set("count", count);
        studio.set("clones", count);
        studio.set("spread", true);
        studio.frames(20);
        studio.settle();
        let mut at = 0.0f32;
        let mut frame = |studio: &mut Studio, by: f32| {
            at += by;
            for (side, x) in [(Side::Left, -0.2), (Side::Right, 0.2)] {
                let position = Vec3::new(x, 1.0 + 0.05 * (at * 9.0).sin(), -at);
                let rotation = Quat::from_rotation_z(-x * (3.0 + (at * 7.0).sin()));
                studio.put(side, Pose { position, rotation });
            }
            let before = Instant::now();
            studio.app_update();
            before.elapsed().as_secs_f64() * 1e3
        };
        // Frames that nothing else on the machine came into, and the median.
        let figures = |mut times: Vec<f64>| {
            times.sort_by(f64::total_cmp);
            [times[times.len() / 10], times[times.len() / 2]]
        };
        let rest = figures((0..200).map(|_| frame(&mut studio, 0.0005)).collect());
        studio.press(Side::Right, Action::Act);
        while studio.swinging().ribs.len() < ribs {
            frame(&mut studio, 0.0101);
        }
        let mut bytes = 0;
        // Slowly: the surface stays about as large as the table says.
        let sweeping: Vec<f64> = (0..200)
            .map(|_| {
                let took = frame(&mut studio, 0.0005);
                bytes = bytes.max(studio.world().resource::<Wires>().bytes());
                took
            })
            .collect();
        let sweeping = figures(sweeping);
        let made = studio.swinging().ribs.len();
        println!(
            "n = {count}, {made} curves, clones: {clones}: a frame of the main schedule takes {:.3} ms undisturbed and {:.3} in the median while sweeping, {:.3} and {:.3} at rest; {bytes} bytes sent at most",
            sweeping[0], sweeping[1], rest[0], rest[1]
        );
        assert!(made < ribs + 40, "{made}");
        assert!(sweeping[0] < rest[0] + 10.0, "{sweeping:?} {rest:?}");
    }
}
