//! Sweeps and rows of clones as operands.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DQuat, DVec3, Vec3};
use midair_mesh::{MeshHash, TriMesh};
use midair_swept::{Profile, Rib, Row, Sweep};

use crate::bake::{BakeOptions, Progress, Volume, bake};
use crate::{
    FuseOptions, MeshSource, Node, Op, Operand, Placement, Primitive, Program, Recipe, fuse,
};

fn rib(z: f64, bend: f64) -> Rib {
    let end = |x: f64| midair_curve::End {
        position: DVec3::new(x, 0.0, z),
        rotation: DQuat::from_rotation_z(-x.signum() * bend),
    };
    let mut lengths = midair_curve::Lengths::default();
    lengths.settle(&end(-0.1), &end(0.1));
    Rib::held(&end(-0.1), &end(0.1), lengths, [1.0; 2], 0.0)
}

fn swept(profile: Profile, thickness: f32, caps: bool, bend: f64) -> Sweep {
    Sweep {
        ribs: (0..=20).map(|i| rib(f64::from(i) * 0.01, bend)).collect(),
        count: 24,
        profile,
        thickness,
        caps,
    }
}

fn unite(a: Recipe, b: Recipe, op: Op) -> Recipe {
    let operand = |op, recipe| Operand {
        op,
        placement: Placement::IDENTITY,
        recipe,
        muted: false,
    };
    Recipe::new(Node::Solid(vec![operand(Op::Union, a), operand(op, b)]))
}

fn at(recipe: &Recipe, p: Vec3) -> f32 {
    let placement = Placement::IDENTITY;
    Program::compile(recipe, &placement, 0.005, &())
        .unwrap()
        .at(p)
}

#[test]
fn a_plate_and_a_tube_unite_with_a_ball_and_cut_it() {
    let plate = swept(Profile::Sheet, 0.02, false, 0.0);
    let tube = swept(Profile::Tube, 0.0, true, 1.0);
    for sweep in [plate, tube] {
        let recipe = Recipe::checked(Node::Sweep(sweep)).unwrap();
        let middle = recipe.bounds().centre();
        assert!(at(&recipe, middle) < 0.0);
        assert!(at(&recipe, middle + Vec3::Z * 0.2) > 0.05);
        let ball = Recipe::from(Primitive::Sphere { radius: 0.05 });
        let both = unite(ball.clone(), recipe.clone(), Op::Union);
        assert!(at(&both, Vec3::Y * 0.045) < 0.0 && at(&both, middle) < 0.0);
        let cut = unite(ball, recipe, Op::Subtract);
        assert!(at(&cut, Vec3::new(0.0, 0.0, -0.04)) < 0.0);
        assert!(at(&cut, Vec3::new(0.0, 0.0, 0.03)) > 0.0, "cut away");
        let program = Program::compile(&both, &Placement::IDENTITY, 0.01, &()).unwrap();
        assert!(
            fuse(&program, &FuseOptions::default())
                .unwrap()
                .bricks()
                .count()
                > 0
        );
    }
}

#[test]
fn an_open_one_is_refused_and_every_number_is_in_the_name() {
    let open = swept(Profile::Sheet, 0.0, false, 0.3);
    let open = Recipe::checked(Node::Sweep(open)).unwrap();
    let e = Program::compile(&open, &Placement::IDENTITY, 0.01, &()).unwrap_err();
    assert!(e.to_string().contains("give it a thickness"), "{e}");
    let plate = swept(Profile::Sheet, 0.02, false, 0.3);
    let names: Vec<_> = [
        plate.clone(),
        Sweep {
            count: 25,
            ..plate.clone()
        },
        Sweep {
            thickness: 0.021,
            ..plate.clone()
        },
        Sweep {
            profile: Profile::Tube,
            ..plate.clone()
        },
        Sweep {
            profile: Profile::Tube,
            caps: true,
            ..plate.clone()
        },
        Sweep {
            ribs: plate.ribs[1..].into(),
            ..plate.clone()
        },
    ]
    .into_iter()
    .map(|s| Recipe::new(Node::Sweep(s)).hash())
    .collect();
    for (i, a) in names.iter().enumerate() {
        assert!(names[..i].iter().all(|b| a != b), "{i}");
    }
    let text = ron::to_string(&Recipe::new(Node::Sweep(plate.clone()))).unwrap();
    let back: Recipe = ron::from_str(&text).unwrap();
    assert_eq!(back, Recipe::new(Node::Sweep(plate)));
}

#[test]
fn a_row_of_clones_is_what_its_clones_are_together() {
    let row = Row {
        ribs: vec![rib(0.0, 0.4)].into(),
        count: 7,
        size: 1.0,
        paced: false,
    };
    let ball = Recipe::from(Primitive::Sphere { radius: 0.01 });
    let clones = Recipe::checked(Node::Clones {
        row: row.clone(),
        recipe: ball,
    })
    .unwrap();
    assert_eq!(clones.leaves(), 7);
    let block = Recipe::from(Primitive::Cuboid {
        half: Vec3::new(0.15, 0.1, 0.03),
        rounding: 0.0,
    });
    let drilled = unite(block, clones.clone(), Op::Subtract);
    for place in row.places() {
        assert!(clones.bounds().grown(1e-4).distance(place.translation) == 0.0);
        assert!(at(&clones, place.translation) < -0.009);
        assert!(
            at(&drilled, place.translation) > 0.009,
            "a hole at {}",
            place.translation
        );
    }
    assert!(at(&drilled, Vec3::new(0.0, -0.05, 0.0)) < 0.0);
}

/// Keeps what it baked, and counts.
#[derive(Default)]
struct Keeping {
    kept: std::sync::Mutex<Vec<(MeshHash, Arc<Volume>)>>,
    baked: AtomicUsize,
}

impl MeshSource for Keeping {
    fn volume(&self, _: &MeshHash, _: f32) -> Option<Arc<Volume>> {
        None
    }

    fn baked(&self, name: &MeshHash, step: f32, make: &dyn Fn() -> TriMesh) -> Option<Arc<Volume>> {
        let mut kept = self.kept.lock().unwrap();
        if let Some((_, volume)) = kept.iter().find(|(n, _)| n == name) {
            return Some(volume.clone());
        }
        self.baked.fetch_add(1, Ordering::Relaxed);
        let made = bake(&make(), &BakeOptions::with_step(step), &Progress::new()).unwrap();
        kept.push((*name, Arc::new(made)));
        kept.last().map(|(_, v)| v.clone())
    }
}

#[test]
fn it_is_baked_once_by_its_name() {
    let keeping = Keeping::default();
    let plate = Recipe::new(Node::Sweep(swept(Profile::Sheet, 0.02, false, 0.0)));
    let ball = Recipe::from(Primitive::Sphere { radius: 0.05 });
    for recipe in [&plate, &unite(ball, plate.clone(), Op::Union)] {
        Program::compile(recipe, &Placement::IDENTITY, 0.01, &keeping).unwrap();
    }
    assert_eq!(keeping.baked.load(Ordering::Relaxed), 1);
}

#[test]
fn one_that_lies_in_a_plane_with_itself_says_so() {
    let still = Sweep {
        ribs: vec![rib(0.0, 0.3); 5].into(),
        ..swept(Profile::Sheet, 0.01, false, 0.3)
    };
    let recipe = Recipe::new(Node::Sweep(still));
    let e = Program::compile(&recipe, &Placement::IDENTITY, 0.01, &()).unwrap_err();
    assert!(e.to_string().contains("encloses nothing"), "{e}");
}
