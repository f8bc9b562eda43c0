//! An updated surface is the one a full extraction gives.

mod common;

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use common::{Random, any_brick, any_grid, assert_sound};
use glam::{IVec3, Vec3};
use midair_field::Grid;
use midair_mesh::TriMesh;
use midair_surface::{Cancelled, ChunkKey, Surface, grid_from_fn};
use proptest::prelude::*;

/// As bytes, so that equal means equal.
fn bytes(mesh: &TriMesh) -> [Vec<u8>; 3] {
    [
        bytemuck::cast_slice(&mesh.positions).to_vec(),
        bytemuck::cast_slice(&mesh.normals).to_vec(),
        bytemuck::cast_slice(&mesh.triangles).to_vec(),
    ]
}

fn chunk_meshes(surface: &Surface) -> BTreeMap<ChunkKey, TriMesh> {
    let mesh = |k| Some((k, surface.chunk_mesh(k)?));
    surface.chunks().filter_map(|c| mesh(c.key)).collect()
}

/// The triangles as points, in order.
fn soup(mesh: &TriMesh) -> Vec<[Vec3; 6]> {
    let corner = |t: [u32; 3], k: usize| {
        let v = t[k % 3] as usize;
        if k < 3 {
            mesh.positions[v]
        } else {
            mesh.normals[v]
        }
    };
    mesh.triangles
        .iter()
        .map(|&t| std::array::from_fn(|k| corner(t, k)))
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn updates_equal_a_full_extraction(
        kinds in prop::collection::vec(0u64..12, 12),
        low in prop::array::uniform3(-4i32..4),
        edits in prop::collection::vec((prop::array::uniform3(-1i32..4), 0u64..12), 1..12),
        seed: u64,
    ) {
        let low = IVec3::from(low);
        let mut grid = any_grid(&kinds, low, 0.01, seed);
        let mut surface = Surface::extract(&grid);
        let mut shown = chunk_meshes(&surface);
        let mut r = Random(seed);
        for pair in edits.chunks(2) {
            let changed: Vec<_> = pair.iter().map(|e| low + IVec3::from(e.0)).collect();
            for (c, e) in changed.iter().zip(pair) {
                grid.set(*c, any_brick(e.1, 0.01, &mut r));
            }
            let seen = surface.generation();
            surface.update(&grid, &changed);
            let full = Surface::extract(&grid);
            prop_assert_eq!(bytes(&surface.mesh()), bytes(&full.mesh()));
            prop_assert_eq!(surface.triangles(), full.triangles());
            prop_assert_eq!(surface.vertices(), full.vertices());
            // A renderer that replaces just what changed shows the same.
            for c in surface.changed_since(seen) {
                match surface.chunk_mesh(c.key) {
                    Some(mesh) => shown.insert(c.key, mesh),
                    None => shown.remove(&c.key),
                };
            }
            prop_assert_eq!(&shown, &chunk_meshes(&full));
        }
        assert_sound(&surface.mesh());
    }
}

fn blobs() -> Grid {
    let step = 1.0 / 95.0;
    grid_from_fn([96; 3], step, f32::INFINITY, |p| {
        (p * 20.0).map(f32::sin).element_sum() * 0.05
    })
}

#[test]
fn chunk_meshes_make_up_the_whole() {
    let surface = Surface::extract(&blobs());
    let whole = surface.mesh();
    assert_sound(&whole);
    let mut parts = Vec::new();
    for c in surface.chunks() {
        let Some(mesh) = surface.chunk_mesh(c.key) else {
            assert_eq!(c.triangles, 0);
            continue;
        };
        assert_eq!(mesh.triangles.len(), c.triangles);
        let mut used = vec![false; mesh.positions.len()];
        for &v in mesh.triangles.as_flattened() {
            used[v as usize] = true;
        }
        // Some vertices at the border are used by triangles of other chunks alone.
        assert!(used.iter().filter(|u| !**u).count() * 4 < used.len().max(400));
        parts.extend(soup(&mesh));
    }
    assert_eq!(parts, soup(&whole));
    assert_eq!(surface.triangles(), whole.triangles.len());
    assert_eq!(surface.vertices(), whole.positions.len());
}

#[test]
fn the_number_of_threads_does_not_show() {
    let grid = blobs();
    let on = |n| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .unwrap();
        bytes(&pool.install(|| Surface::extract(&grid).mesh()))
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(5));
}

#[test]
fn an_update_without_a_change_changes_no_chunk() {
    let grid = blobs();
    let mut surface = Surface::extract(&grid);
    let seen = surface.generation();
    let all: Vec<_> = grid.bricks().map(|b| b.0).collect();
    surface.update(&grid, &all);
    assert_eq!(surface.changed_since(seen).count(), 0);
}

#[test]
fn a_small_edit_touches_few_chunks() {
    let mut grid = blobs();
    let mut surface = Surface::extract(&grid);
    let seen = surface.generation();
    // In the middle of a chunk: the bricks that read this one are not at its border.
    let c = IVec3::splat(6);
    grid.set(c, None);
    surface.update(&grid, &[c]);
    assert_eq!(surface.changed_since(seen).count(), 1);
    assert_eq!(
        bytes(&surface.mesh()),
        bytes(&Surface::extract(&grid).mesh())
    );
}

#[test]
fn another_step_replaces_everything() {
    let mut surface = Surface::extract(&blobs());
    let seen = surface.generation();
    let grid = any_grid(&[2; 12], IVec3::splat(40), 0.002, 9);
    surface.update(&grid, &[]);
    assert_eq!(
        bytes(&surface.mesh()),
        bytes(&Surface::extract(&grid).mesh())
    );
    assert!(surface.chunks().all(|c| c.version > seen));
}

#[test]
fn a_cancelled_extraction_leaves_the_surface_alone() {
    let mut grid = blobs();
    let mut surface = Surface::extract(&grid);
    let before = bytes(&surface.mesh());
    let cancel = AtomicBool::new(true);
    assert_eq!(
        Surface::extract_unless(&grid, &cancel).err(),
        Some(Cancelled)
    );
    let c = IVec3::splat(5);
    grid.set(c, None);
    assert_eq!(surface.update_unless(&grid, &[c], &cancel), Err(Cancelled));
    assert_eq!(bytes(&surface.mesh()), before);
}
