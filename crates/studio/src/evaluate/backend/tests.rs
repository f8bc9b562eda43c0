use super::*;
use bevy::math::Vec3;
use midair_field::{Node, Op, Operand, Primitive};

/// Nothing is given up here.
static GO: AtomicBool = AtomicBool::new(false);

fn ball(radius: f32) -> Recipe {
    Primitive::Sphere { radius }.into()
}

fn made(asked: Asked) -> Option<OnCard> {
    match asked {
        Asked::Made(made) => Some(made),
        Asked::Processor => None,
    }
}

#[test]
fn the_processor_is_asked_where_it_was_chosen() {
    let backend = Backend::forced(Choice::Processor);
    assert!(matches!(
        backend.make(&ball(0.1), 0.01, &(), &Early::default(), &GO),
        Asked::Processor
    ));
    backend.follow(Choice::Card);
    assert_eq!(backend.says(), "The processor makes solids.");
}

#[test]
fn nobody_waits_for_a_card_that_is_optional() {
    let backend = Backend::following(Choice::Auto);
    assert!(matches!(
        backend.make(&ball(0.1), 0.01, &(), &Early::default(), &GO),
        Asked::Processor
    ));
}

#[test]
fn a_lost_card_is_told_once_and_the_processor_goes_on() {
    let backend = Backend::forced(Choice::Card);
    let Some(first) = made(backend.make(&ball(0.1), 0.01, &(), &Early::default(), &GO)) else {
        // No adapter, not even software: said, and left to the processor.
        assert!(backend.says().contains("processor"), "{}", backend.says());
        eprintln!("skipped: {}", backend.says());
        return;
    };
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 1e-3;
    assert!((first.mesh.volume() / exact - 1.0).abs() < 0.02);
    // The next takes over its buffers.
    let second = made(backend.make(&ball(0.12), 0.01, &(), &Early::default(), &GO)).unwrap();
    assert!(second.mesh.volume() > 1.5 * first.mesh.volume());
    backend.lose();
    assert!(made(backend.make(&ball(0.1), 0.01, &(), &Early::default(), &GO)).is_none());
    let [line] = &backend.untold()[..] else {
        panic!("it is told once");
    };
    assert!(
        line.contains("lost") && line.contains("processor"),
        "{line}"
    );
    assert!(matches!(
        backend.make(&ball(0.1), 0.01, &(), &Early::default(), &GO),
        Asked::Processor
    ));
    assert!(backend.untold().is_empty());
    assert!(backend.says().contains("lost"), "{}", backend.says());
}

/// A sketch that finds no memory is the processor's, and so is what is made of it; the card is asked again.
#[test]
fn a_sketch_that_finds_no_memory_is_told_once() {
    let backend = Backend::forced(Choice::Card);
    let Some((solid, _)) = backend.sketch(&ball(0.1), 0.01, &(), None) else {
        eprintln!("skipped: {}", backend.says());
        return;
    };
    let card = backend.in_use().unwrap();
    card.starve(Some(1024));
    assert!(backend.sketch(&ball(0.2), 0.01, &(), Some(solid)).is_none());
    assert!(made(backend.make(&ball(0.2), 0.01, &(), &Early::default(), &GO)).is_none());
    let [line] = &backend.untold()[..] else {
        panic!("it is told once");
    };
    assert!(
        line.contains("left") && line.contains("processor"),
        "{line}"
    );
    card.starve(None);
    assert!(backend.sketch(&ball(0.2), 0.01, &(), None).is_some());
    assert!(made(backend.make(&ball(0.2), 0.01, &(), &Early::default(), &GO)).is_some());
    assert!(backend.untold().is_empty());
}

/// Two objects, each at two steps: an edit of one at either makes a part of it again.
#[test]
fn an_edit_makes_a_part_again_whatever_was_made_between() {
    let backend = Backend::forced(Choice::Card);
    let dabbed = |half: f32, x: f32| {
        let part = |op, x: f32, p: Primitive| Operand {
            op,
            placement: Placement::at(Vec3::X * x),
            recipe: p.into(),
            muted: false,
        };
        let whole = Primitive::Cuboid {
            half: Vec3::splat(half),
            rounding: 0.0,
        };
        let dab = Primitive::Sphere { radius: 0.04 };
        Recipe::new(Node::Solid(vec![
            part(Op::Union, 0.0, whole),
            part(Op::Subtract, x, dab),
        ]))
    };
    let renewed = |half: f32, x: f32, step: f32| {
        made(backend.make(&dabbed(half, x), step, &(), &Early::default(), &GO))?;
        let kept = backend.0.kept.lock().unwrap();
        let last = kept.last().unwrap();
        Some((last.renewed(), last.memory().bricks))
    };
    for into in [0.0, 0.01, 0.02] {
        for half in [0.3, 0.35] {
            for step in [0.01, 0.015] {
                let Some((again, all)) = renewed(half, half - into, step) else {
                    eprintln!("skipped: {}", backend.says());
                    return;
                };
                assert!(all > 50, "{all}");
                if into > 0.0 {
                    assert!(2 * again < all, "{half} {into} {step}: {again} of {all}");
                }
            }
        }
    }
}

/// Whatever keeps a card from being opened is one line that names it, and the processor's work.
#[test]
fn a_card_that_cannot_be_opened_is_told_once() {
    let adapter = || "a card".to_owned();
    for (error, names) in [
        (GpuError::NoAdapter, "no graphics card"),
        (
            GpuError::Limit {
                adapter: adapter(),
                what: "storage buffers in a pass",
                has: 4,
                needs: 8,
            },
            "storage buffers in a pass",
        ),
        (
            GpuError::Device {
                adapter: adapter(),
                reason: "it is busy".to_owned(),
            },
            "busy",
        ),
        (
            GpuError::Shader {
                name: "fuse.wgsl".to_owned(),
                reason: "expected a name".to_owned(),
            },
            "fuse.wgsl",
        ),
    ] {
        let backend = Backend::forced(Choice::Card);
        *backend.0.broken.lock().unwrap() = Some(error);
        for _ in 0..2 {
            assert!(made(backend.make(&ball(0.1), 0.01, &(), &Early::default(), &GO)).is_none());
            assert!(backend.sketch(&ball(0.1), 0.01, &(), None).is_none());
        }
        let [line] = &backend.untold()[..] else {
            panic!("{names} is told once");
        };
        assert!(line.contains(names) && !line.contains('\n'), "{line}");
        assert!(backend.says().contains(names), "{}", backend.says());
    }
}
