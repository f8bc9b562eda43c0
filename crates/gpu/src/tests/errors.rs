//! Everything that can be missing is a value.

use std::sync::Arc;

use glam::Vec3;
use midair_field::{Canvas, Node, Op, Primitive, Recipe, Skeleton, Stroke};

use super::support::*;
use crate::kernels::sources;
use crate::{Gpu, GpuError, GpuOptions, GpuSolid, can_make};

fn software() -> GpuOptions {
    GpuOptions {
        software: true,
        ..GpuOptions::default()
    }
}

fn ball(radius: f32) -> Recipe {
    Primitive::Sphere { radius }.into()
}

#[test]
fn without_an_adapter_there_is_a_line() {
    let text = GpuError::NoAdapter.to_string();
    assert!(text.contains("processor") && !text.contains('\n'));
}

#[test]
fn software_is_no_graphics_card() {
    let all = Gpu::adapters();
    let Some(first) = all.first() else {
        assert_eq!(Gpu::open(&software()).unwrap_err(), GpuError::NoAdapter);
        return;
    };
    let opened = Gpu::open(&GpuOptions::default());
    if first.software {
        assert_eq!(opened.unwrap_err(), GpuError::Software(first.name.clone()));
    } else {
        assert!(opened.is_ok());
    }
}

#[test]
fn an_adapter_that_is_too_small_is_named() {
    if gpu().is_none() {
        return;
    }
    let limits = wgpu::Limits {
        max_storage_buffers_per_shader_stage: 1 << 30,
        ..wgpu::Limits::default()
    };
    let refused = Gpu::open_with(&software(), &sources(), &limits).unwrap_err();
    let GpuError::Limit { what, needs, .. } = &refused else {
        panic!("{refused:?}");
    };
    assert_eq!((*what, *needs), ("storage buffers in a pass", 1 << 30));
    assert!(refused.to_string().contains("storage buffers"));
}

#[test]
fn a_shader_that_does_not_compile_is_named() {
    if gpu().is_none() {
        return;
    }
    for (name, broken) in [
        ("fuse.wgsl", "fn fuse( {"),
        ("extract.wgsl", "fn other() {}"),
    ] {
        let mut all = sources();
        for (n, text) in &mut all {
            if n == name {
                *text = broken.to_owned();
            }
        }
        let refused = Gpu::open_with(&software(), &all, &wgpu::Limits::default()).unwrap_err();
        let GpuError::Shader { name: told, reason } = &refused else {
            panic!("{refused:?}");
        };
        assert!(told.starts_with(name) && !reason.is_empty(), "{refused}");
        assert_eq!(refused.to_string().lines().count(), 1, "{refused}");
    }
}

#[test]
fn a_solid_beyond_its_budget_is_refused_and_the_device_goes_on() {
    if gpu().is_none() {
        return;
    }
    let options = GpuOptions {
        budget: 24 << 20,
        ..software()
    };
    let small = Arc::new(Gpu::open(&options).unwrap());
    let mut solid = GpuSolid::make(&small, &compile(&ball(0.1), 0.01)).unwrap();
    // An edit that outgrows it.
    let refused = solid.update(&compile(&ball(2.0), 0.01)).unwrap_err();
    assert!(matches!(refused, GpuError::Budget { .. }), "{refused:?}");
    // And one that fits again.
    solid.update(&compile(&ball(0.12), 0.01)).unwrap();
    assert_sound(&solid.mesh().unwrap(), "after an edit that did not fit");
}

#[test]
fn more_room_is_found_where_the_guess_was_too_small() {
    let Some(gpu) = gpu() else { return };
    // Far more surface than its box has.
    let parts = (0..60).map(|i| {
        let at = 0.06 * Vec3::new((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32);
        operand(Op::Union, at, ball(0.025))
    });
    let program = compile(&Recipe::new(Node::Solid(parts.collect())), 0.003);
    let solid = GpuSolid::make(&gpu, &program).unwrap();
    assert_sound(&solid.mesh().unwrap(), "sixty balls");
}

#[test]
fn a_lost_device_is_an_error_and_no_panic() {
    if gpu().is_none() {
        return;
    }
    let gpu = Arc::new(Gpu::open(&software()).unwrap());
    let program = compile(&ball(0.1), 0.01);
    let mut solid = GpuSolid::make(&gpu, &program).unwrap();
    gpu.lose();
    assert!(matches!(gpu.check(), Err(GpuError::Lost(_))));
    assert!(matches!(solid.mesh(), Err(GpuError::Lost(_))));
    assert!(matches!(solid.grid(), Err(GpuError::Lost(_))));
    let edit = compile(&ball(0.12), 0.01);
    assert!(matches!(solid.update(&edit), Err(GpuError::Lost(_))));
    assert!(matches!(
        GpuSolid::make(&gpu, &program),
        Err(GpuError::Lost(_))
    ));
}

/// In the middle of whatever it is at.
#[test]
fn a_device_that_is_lost_while_it_works_keeps_nobody_waiting() {
    if gpu().is_none() {
        return;
    }
    for after in [0, 3, 10, 30, 100] {
        let gpu = Arc::new(Gpu::open(&software()).unwrap());
        let (tell, told) = std::sync::mpsc::channel();
        let worker = gpu.clone();
        std::thread::spawn(move || {
            let made = || -> Result<(), GpuError> {
                let mut solid = GpuSolid::make(&worker, &compile(&ball(0.3), 0.005))?;
                for i in 0..1000 {
                    let radius = 0.3 + 0.001 * (i % 10) as f32;
                    solid.update(&compile(&ball(radius), 0.005))?;
                    solid.mesh()?;
                }
                Ok(())
            };
            let _ = tell.send(made());
        });
        std::thread::sleep(std::time::Duration::from_millis(after));
        gpu.lose();
        let came = told.recv_timeout(std::time::Duration::from_secs(60));
        let refused = came.expect("it waits for ever").unwrap_err();
        assert!(matches!(refused, GpuError::Lost(_)), "{refused:?}");
    }
}

#[test]
fn what_the_device_does_not_know_is_said() {
    let Some(gpu) = gpu() else { return };
    let mut deep = ball(0.1);
    for _ in 0..50 {
        deep = Recipe::new(Node::Solid(vec![
            operand(Op::Union, Vec3::ZERO, ball(0.1)),
            operand(Op::Union, Vec3::X * 0.01, deep),
        ]));
    }
    let refused = GpuSolid::make(&gpu, &compile(&deep, 0.01)).err().unwrap();
    assert!(matches!(refused, GpuError::Unsupported(_)), "{refused:?}");
    // A solid as a brush that was painted itself: told from the recipe already.
    let canvas = |brush: Recipe| {
        let strokes = vec![Stroke::new(Skeleton::Volume(brush), 0.05)];
        let canvas = Canvas {
            strokes,
            ..Canvas::default()
        };
        Recipe::new(Node::Canvas(canvas))
    };
    let painted = operand(Op::Union, Vec3::ZERO, canvas(ball(0.1)));
    let painted = canvas(Recipe::new(Node::Solid(vec![painted])));
    assert!(can_make(&canvas(ball(0.1))) && can_make(&canvas(canvas(ball(0.1)))));
    assert!(!can_make(&painted) && !can_make(&canvas(painted.clone())));
    let refused = GpuSolid::make(&gpu, &compile(&painted, 0.01))
        .err()
        .unwrap();
    assert!(refused.to_string().contains("painting"), "{refused}");
    // Brushes within brushes.
    let mut within = ball(0.1);
    for _ in 0..6 {
        within = canvas(within);
    }
    let refused = GpuSolid::make(&gpu, &compile(&within, 0.01)).err().unwrap();
    assert!(matches!(refused, GpuError::Unsupported(_)), "{refused:?}");
    let far = operand(Op::Union, Vec3::X * 9.0e4, ball(0.1));
    let far = compile(&Recipe::new(Node::Solid(vec![far])), 0.01);
    assert_eq!(
        GpuSolid::make(&gpu, &far).err(),
        Some(GpuError::TooFine(0.01))
    );
}
