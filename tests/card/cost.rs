//! What an update costs the frame: measured, not asserted.

use std::time::Instant;

use bevy::prelude::*;
use midair_document::Edit;
use midair_field::{Node, Op, Operand, Placement, Primitive, Recipe};
use midair_studio::StudioSet;
use midair_studio::evaluate::{Choice, Delivered};

use super::{Drawn, commit};

/// When the entities began to follow the document, and how long that took, frame by frame.
#[derive(Resource, Default)]
struct Rebuilt(Option<Instant>, Vec<(f64, bool)>);

/// What an update costs the main schedule (EasyVRModeling Table 1): everything that takes in what was made and shows
/// it. Printed, not asserted: `cargo test -p midair --test card -- --ignored --nocapture`.
#[test]
#[ignore = "a measurement of minutes"]
fn what_an_update_costs_the_main_schedule() {
    let measured = |app: &mut App| {
        app.init_resource::<Rebuilt>().add_systems(
            Update,
            (
                (|mut rebuilt: ResMut<Rebuilt>| rebuilt.0 = Some(Instant::now()))
                    .after(StudioSet::Commit)
                    .before(StudioSet::Rebuild),
                (|mut rebuilt: ResMut<Rebuilt>, delivered: Res<Delivered>| {
                    let took = rebuilt.0.take().map_or(0.0, |t| t.elapsed().as_secs_f64());
                    rebuilt.1.push((1e3 * took, !delivered.0.is_empty()));
                })
                .after(StudioSet::Rebuild)
                .before(StudioSet::Cue),
            ),
        );
    };
    for (name, text) in [
        ("cube-sphere", include_str!("../../benches/cube-sphere.ron")),
        ("chair", include_str!("../../benches/chair.ron")),
        ("cup", include_str!("../../benches/cup.ron")),
    ] {
        let task: Recipe = ron::from_str(text).unwrap();
        let Some(mut card) = Drawn::of(Choice::Card, task.clone(), measured) else {
            return;
        };
        for step in [0.012, 0.010, 0.008, 0.006] {
            commit(&mut card.app, Edit::SetStep { step });
            let mut figures: Vec<f64> = Vec::new();
            let mut quiet: Vec<f64> = Vec::new();
            let mut writes = 0;
            for n in 0..8 {
                let dab = Operand {
                    op: Op::Subtract,
                    placement: Placement::at(Vec3::Y * (0.1 + 0.01 * n as f32)),
                    recipe: Primitive::Sphere { radius: 0.03 }.into(),
                    muted: false,
                };
                let whole = Operand {
                    op: Op::Union,
                    placement: Placement::IDENTITY,
                    recipe: task.clone(),
                    muted: false,
                };
                card.become_of(Recipe::new(Node::Solid(vec![whole, dab])));
                let before = card.written();
                card.app.world_mut().resource_mut::<Rebuilt>().1.clear();
                card.settle();
                // The first makes room.
                if n < 2 {
                    continue;
                }
                writes += card.written() - before;
                for &(ms, took_in) in &card.app.world().resource::<Rebuilt>().1 {
                    if took_in { &mut figures } else { &mut quiet }.push(ms);
                }
            }
            let of = |all: &mut Vec<f64>| {
                all.sort_by(f64::total_cmp);
                let at = |q: f64| all.get((q * all.len() as f64) as usize).copied();
                format!(
                    "median {:.3}, 90 % {:.3}, most {:.3} ms of {}",
                    at(0.5).unwrap_or(f64::NAN),
                    at(0.9).unwrap_or(f64::NAN),
                    all.last().copied().unwrap_or(f64::NAN),
                    all.len()
                )
            };
            println!(
                "{name}/{step}: taking in {}; other frames {}; {writes} drawn where they lie",
                of(&mut figures),
                of(&mut quiet)
            );
        }
    }
}
