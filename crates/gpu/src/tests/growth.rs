//! What memory and time grow with.

use std::sync::{Arc, OnceLock};
use std::time::Instant;

use super::support::gpu;
use crate::layout::counter;
use crate::measure::{Work, all, dab, growth};
use crate::{Gpu, GpuSolid, SolidOptions};

fn work(names: &[&str]) -> Vec<Work> {
    let all = all();
    let find = |n: &&str| {
        all.iter()
            .find(|w| w.name == *n)
            .expect("a workload")
            .clone()
    };
    names.iter().map(find).collect()
}

/// Bytes grow with the surface, not with the box.
#[test]
fn memory_grows_with_the_surface() {
    let Some(gpu) = gpu() else { return };
    let mut figures = Vec::new();
    for work in work(&[
        "gpu/memory/chair-128",
        "gpu/memory/chair-256",
        "gpu/memory/chair-512",
    ]) {
        figures.push(work.run(&gpu, SolidOptions::default(), 1).unwrap());
    }
    let exponent = growth(&figures).unwrap();
    println!(
        "{exponent:.2}: {:?}",
        figures.iter().map(|f| f.bytes).collect::<Vec<_>>()
    );
    assert!(exponent < 2.15, "{exponent}");
}

/// Of a field that fills its box of 128³ an edit of 16³ nodes runs few bricks again.
#[test]
fn a_dab_is_a_small_part_of_the_whole() {
    let Some(gpu) = gpu() else { return };
    let (before, after) = dab(16, 128);
    let mut solid = GpuSolid::make(&gpu, &before).unwrap();
    let whole = solid.memory().bricks;
    // The first one may find that there is too little room, and makes it whole with more.
    for program in [&after, &before, &after] {
        solid.update(program).unwrap();
    }
    let edit = solid.counters[counter::WORK];
    println!("{edit} of {whole} bricks");
    assert!(edit > 0 && f64::from(edit) <= 0.1 * f64::from(whole));
}

/// The figure of the issue; takes half a minute of processor time on software.
#[test]
#[ignore = "long on software: cargo test -p midair-gpu --lib -- --ignored --test-threads 1 --nocapture"]
fn a_dab_of_32_in_256() {
    let Some(gpu) = gpu() else { return };
    assert!(share(&gpu, 32, 256) <= 0.02);
}

/// An edit's part of the whole. On software the processor's own time is taken, which other work on the machine
/// does not lengthen.
fn share(gpu: &Arc<Gpu>, nodes: u32, within: u32) -> f64 {
    let (before, after) = dab(nodes, within);
    let mut solid = GpuSolid::make(gpu, &before).unwrap();
    let (mut edit, mut whole) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..3 {
        let started = spent(gpu);
        solid.update(&after).unwrap();
        edit = edit.min(spent(gpu) - started);
        solid.update(&before).unwrap();
    }
    for _ in 0..2 {
        let started = spent(gpu);
        solid.make_again(&after).unwrap();
        whole = whole.min(spent(gpu) - started);
    }
    println!(
        "{:.1} ms of {:.1} ms: {:.4}",
        1e3 * edit,
        1e3 * whole,
        edit / whole
    );
    edit / whole
}

/// Seconds that this process was at work, where the device is the processor; else seconds.
fn spent(gpu: &Gpu) -> f64 {
    let tasks = std::fs::read_dir("/proc/self/task").ok();
    let at_work = tasks.filter(|_| gpu.adapter().software).map(|tasks| {
        let one = |t: std::io::Result<std::fs::DirEntry>| {
            let text = std::fs::read_to_string(t.ok()?.path().join("schedstat")).ok()?;
            text.split(' ').next()?.parse::<f64>().ok()
        };
        tasks.filter_map(one).sum::<f64>() * 1e-9
    });
    at_work.unwrap_or_else(|| {
        static START: OnceLock<Instant> = OnceLock::new();
        START.get_or_init(Instant::now).elapsed().as_secs_f64()
    })
}
