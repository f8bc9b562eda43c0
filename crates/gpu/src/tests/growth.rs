//! What memory and time grow with.

use super::support::gpu;
use crate::SolidOptions;
use crate::measure::{Work, all, growth};

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

/// An edit of 32³ nodes in 256³ costs next to nothing beside the whole.
#[test]
fn a_dab_is_a_small_part_of_the_whole() {
    let Some(gpu) = gpu() else { return };
    let ratio = || {
        let times: Vec<f64> = work(&["gpu/dab-32-in-256", "gpu/full-256"])
            .iter()
            .map(|w| w.run(&gpu, SolidOptions::default(), 3).unwrap().total_ms)
            .collect();
        times[0] / times[1]
    };
    // Other work on the machine disturbs a short time more than a long one: the best of a few counts.
    let best = (0..3).map(|_| ratio()).fold(f64::INFINITY, f64::min);
    println!("{best:.4} of the whole");
    assert!(best <= 0.1, "{best}");
}
