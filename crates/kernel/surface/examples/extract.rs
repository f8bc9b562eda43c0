//! Measures extraction on 256³ grids: `extract [--threads N] [--runs N]`.
//!
//! The grids are those that marching cubes are commonly compared on: a sphere of radius 0.4 and a
//! gyroid of four periods in the unit cube.

use std::time::Instant;

use glam::{IVec3, Vec3};
use midair_field::Grid;
use midair_surface::{Surface, grid_from_fn};

fn main() {
    let option = |name: &str| {
        let mut args = std::env::args().skip_while(|a| a != name);
        args.nth(1).and_then(|a| a.parse().ok())
    };
    let runs = option("--runs").unwrap_or(15);
    let threads = option("--threads").map_or(vec![1, 2], |n| vec![n]);
    let k = 4.0 * std::f32::consts::TAU;
    let gyroid = move |p: Vec3| {
        let (s, c) = ((k * p).map(f32::sin), (k * p).map(f32::cos));
        s.x * c.y + s.y * c.z + s.z * c.x
    };
    let sphere = |p: Vec3| p.distance(Vec3::splat(0.5)) - 0.4;
    let step = 1.0 / 255.0;
    let fields = [
        ("sphere", grid_from_fn([256; 3], step, 8.0 * step, sphere)),
        (
            "sphere dense",
            grid_from_fn([256; 3], step, f32::INFINITY, sphere),
        ),
        (
            "gyroid",
            grid_from_fn([256; 3], step, f32::INFINITY, gyroid),
        ),
    ];
    for threads in threads {
        let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() else {
            continue;
        };
        for (name, grid) in &fields {
            pool.install(|| measure(name, grid, threads, runs));
        }
    }
}

fn measure(name: &str, grid: &Grid, threads: usize, runs: usize) {
    let time = |label: &str, work: &mut dyn FnMut()| {
        let mut all: Vec<f64> = (0..runs)
            .map(|_| {
                let start = Instant::now();
                work();
                start.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        all.sort_by(f64::total_cmp);
        println!(
            "{name:13} {threads} threads  {label:26} best {:8.3} ms  median {:8.3} ms",
            all[0],
            all[runs / 2]
        );
    };
    let mut surface = Surface::extract(grid);
    println!(
        "{name:13} {} bricks, {} triangles, {} vertices, {:.1} MB",
        grid.bricks().count(),
        surface.triangles(),
        surface.vertices(),
        surface.bytes() as f64 / 1e6
    );
    time("extract + mesh", &mut || {
        std::hint::black_box(Surface::extract(grid).mesh());
    });
    time("extract", &mut || {
        std::hint::black_box(Surface::extract(grid));
    });
    time("mesh", &mut || {
        std::hint::black_box(surface.mesh());
    });
    time("all chunk meshes", &mut || {
        for c in surface.chunks() {
            std::hint::black_box(surface.chunk_mesh(c.key));
        }
    });
    // 64³ nodes: 8³ bricks, around a place where the sphere's surface is.
    let low = IVec3::new(12, 12, 2);
    let dirty: Vec<_> = (0..512)
        .map(|i| low + IVec3::new(i % 8, i / 8 % 8, i / 64))
        .collect();
    time("update of 64³", &mut || surface.update(grid, &dirty));
    time("update of one brick", &mut || {
        surface.update(grid, &dirty[..1])
    });
}
