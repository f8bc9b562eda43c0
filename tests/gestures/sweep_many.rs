//! Random sweeps, each united with a ball through Assemble. Sixty of them; as many as `MIDAIR_MANY` says.

use bevy::prelude::*;
use midair_document::{Edit, Object, ObjectId};
use midair_field::{Node, Op, Primitive, Profile, Recipe, Sweep};
use midair_mesh::check;
use midair_studio::command::Command;
use midair_swept::Rib;

use crate::studio::Studio;

/// SplitMix64: the same numbers every time.
struct Dice(u64);

impl Dice {
    /// From −1 to 1.
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }

    fn turn(&mut self, most: f32) -> Quat {
        let axis = self.vector(1.0).normalize_or(Vec3::X);
        Quat::from_axis_angle(axis, self.next() * most)
    }
}

/// Two hands on smooth ways, turning as they go, and what they leave.
fn swept(dice: &mut Dice, kind: usize) -> Sweep {
    let from = [Vec3::X * -0.25, Vec3::X * 0.25].map(|p| p + dice.vector(0.1));
    let to = from.map(|p| p + dice.vector(0.4));
    let bow = [dice.vector(0.1), dice.vector(0.1)];
    let first = [dice.turn(1.0), dice.turn(1.3)];
    let last = first.map(|q| dice.turn(0.5) * q);
    let ribs = (0..=24).map(|i| {
        let t = i as f32 / 24.0;
        let hand = |k: usize| from[k].lerp(to[k], t) + bow[k] * (4.0 * t * (1.0 - t));
        let points = [hand(0), hand(1)];
        let length = points[0].distance(points[1]);
        let along = |k: usize| first[k].slerp(last[k], t) * Vec3::X * length;
        Rib {
            points,
            tangents: [along(0), along(1)],
            slopes: [1.0; 2],
            start: first[0].slerp(last[0], t).normalize(),
            twist: 0.0,
        }
    });
    let (profile, thickness, caps) = match kind % 3 {
        0 => (Profile::Sheet, 0.03, false),
        1 => (Profile::Tube, 0.0, true),
        _ => (Profile::Tube, 0.03, false),
    };
    Sweep {
        ribs: ribs.collect(),
        count: 24,
        profile,
        thickness,
        caps,
    }
}

#[test]
fn every_random_sweep_unites_with_a_ball_through_assemble() {
    let many = std::env::var("MIDAIR_MANY").ok();
    let many: usize = many.and_then(|n| n.parse().ok()).unwrap_or(60);
    let mut dice = Dice(7);
    let mut s = Studio::new();
    let ball = Recipe::from(Primitive::Sphere { radius: 0.08 });
    let mut united = 0;
    for i in 0..many {
        let sweep = swept(&mut dice, i);
        // Turned anyhow a tube may lie flat at once: that is no solid to begin with.
        if sweep.solid().is_err() {
            continue;
        }
        let end = sweep.ribs[12].points[1];
        let next = s.document().next_id();
        let recipes = [Recipe::new(Node::Sweep(sweep)), ball.clone()];
        for (k, recipe) in recipes.into_iter().enumerate() {
            let at = if k == 1 { end } else { Vec3::ZERO };
            let object = Object::solid("Operand", recipe);
            let object = object.placed(midair_field::Placement::at(at)).into();
            let id = ObjectId(next + k as u64);
            s.ask(Command::Edit(Edit::Add { id, object }));
        }
        let pending = vec![(ObjectId(next), Op::Union), (ObjectId(next + 1), Op::Union)];
        s.ask(Command::Edit(Edit::SetPending { pending }));
        s.ask(Command::Tool {
            tool: midair_csg::ASSEMBLE,
            ask: "update".to_owned(),
        });
        s.settle();
        let id = s.only();
        let report = check(&s.mesh(id, 0.015));
        assert!(report.is_faultless(), "{i}: {:?}", report.faults());
        let alone = 4.0 / 3.0 * std::f64::consts::PI * 0.08f64.powi(3);
        assert!(report.volume > 0.95 * alone, "{i}: {}", report.volume);
        united += 1;
        s.ask(Command::Edit(Edit::Remove { id }));
    }
    println!("{united} of {many} random sweeps united with a ball, none with a fault");
    assert!(united * 10 > many * 9, "{united} of {many}");
    assert_eq!(s.warnings(), [] as [String; 0]);
}
