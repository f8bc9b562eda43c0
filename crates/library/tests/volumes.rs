//! Baked meshes: baked once, kept within a limit, cancelled cleanly.

mod common;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use common::home;
use glam::Vec3;
use midair_field::MeshSource as _;
use midair_field::bake::{BakeCache, BakeError, BakeOptions, Progress};
use midair_library::{VolumeError, Volumes};
use midair_mesh::{MeshHash, TriMesh};

fn tetrahedron(size: f32) -> Arc<TriMesh> {
    Arc::new(TriMesh {
        positions: [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]
            .map(|p| (p - 0.25) * size)
            .to_vec(),
        normals: vec![],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    })
}

#[test]
fn two_threads_bake_one_volume_once() {
    let (_dir, folders) = home();
    let mesh = tetrahedron(0.4);
    let hash = mesh.hash();
    let asked = Arc::new(AtomicUsize::new(0));
    let volumes = Volumes::with_cache(BakeCache::new(folders.bakes()), 64 << 20);
    let count = asked.clone();
    volumes.add_meshes(move |h| {
        count.fetch_add(1, Ordering::Relaxed);
        (*h == hash).then(|| mesh.clone())
    });
    let all: Vec<_> = std::thread::scope(|s| {
        let ask = || volumes.get(&hash, 0.01, &Progress::new()).unwrap();
        let threads: Vec<_> = (0..8).map(|_| s.spawn(ask)).collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert!(all.iter().all(|v| Arc::ptr_eq(v, &all[0])));
    assert_eq!(asked.load(Ordering::Relaxed), 1);
    assert!(volumes.baking().is_empty());
    assert_eq!(volumes.bytes(), all[0].bytes());
    assert!(volumes.ready(&hash, 0.01).is_some() && volumes.ready(&hash, 0.005).is_none());
}

#[test]
fn the_one_used_longest_ago_makes_room() {
    let (_dir, folders) = home();
    let meshes: Vec<_> = [0.4, 0.39, 0.38].map(tetrahedron).into();
    let step = 0.01;
    let measure = Volumes::with_cache(BakeCache::new(folders.bakes()), usize::MAX);
    for m in &meshes {
        measure.bake(m, step, &Progress::new()).unwrap();
    }
    // Room for two, not for three.
    let limit = measure.bytes() - 1;
    let volumes = Volumes::with_cache(BakeCache::new(folders.bakes()), limit);
    let [a, b, c] = [0, 1, 2].map(|i: usize| meshes[i].hash());
    let bake = |i: usize| drop(volumes.bake(&meshes[i], step, &Progress::new()).unwrap());
    bake(0);
    bake(1);
    bake(0);
    bake(2);
    assert!(volumes.bytes() <= limit);
    assert!(volumes.ready(&a, step).is_some());
    assert!(volumes.ready(&b, step).is_none());
    assert!(volumes.ready(&c, step).is_some());
}

#[test]
fn what_is_on_disk_is_not_baked_again() {
    let (_dir, folders) = home();
    let mesh = tetrahedron(0.4);
    let first = Volumes::new(&folders)
        .bake(&mesh, 0.01, &Progress::new())
        .unwrap();
    assert!(folders.bakes().read_dir().unwrap().next().is_some());
    let second = Volumes::new(&folders)
        .bake(&mesh, 0.01, &Progress::new())
        .unwrap();
    for i in 0..200 {
        let p = Vec3::new(
            (i * 37 % 101) as f32,
            (i * 53 % 103) as f32,
            (i * 71 % 107) as f32,
        ) * 0.004
            - 0.2;
        assert_eq!(first.sample(p), second.sample(p));
    }
}

#[test]
fn many_are_kept_while_others_are_baked() {
    let (_dir, folders) = home();
    let volumes = Volumes::new(&folders);
    let steps: Vec<f32> = (0..12).map(|i| 0.01 + 0.001 * i as f32).collect();
    let mesh = tetrahedron(0.4);
    for step in &steps {
        volumes.bake(&mesh, *step, &Progress::new()).unwrap();
    }
    drop(volumes);
    let cache = BakeCache::new(folders.bakes());
    for step in steps {
        let options = BakeOptions::with_step(step);
        assert!(cache.find(mesh.hash(), &options).is_some(), "{step}");
    }
}

#[test]
fn what_cannot_be_had_says_why() {
    let (_dir, folders) = home();
    let volumes = Volumes::new(&folders);
    let absent = MeshHash([7; 32]);
    assert_eq!(
        volumes.get(&absent, 0.01, &Progress::new()).unwrap_err(),
        VolumeError::MeshGone(absent)
    );
    assert!(volumes.volume(&absent, 0.01).is_none());
    assert_eq!(
        volumes.failure(&absent),
        Some(VolumeError::MeshGone(absent))
    );
    let nothing = TriMesh::default();
    let error = volumes.bake(&nothing, 0.01, &Progress::new()).unwrap_err();
    assert_eq!(error, VolumeError::Bake(BakeError::NoTriangles));
    let mesh = tetrahedron(0.4);
    let cancelled = Progress::new();
    cancelled.cancel();
    let error = volumes.bake(&mesh, 0.01, &cancelled).unwrap_err();
    assert_eq!(error, VolumeError::Bake(BakeError::Cancelled));
    assert!(
        volumes
            .watched(&cancelled)
            .volume(&mesh.hash(), 0.01)
            .is_none()
    );
    assert_eq!(volumes.failure(&mesh.hash()), None);
    // And none of that stands in the way.
    volumes.bake(&mesh, 0.01, &Progress::new()).unwrap();
    assert_eq!(volumes.failure(&mesh.hash()), None);
    for step in [0.0, -1.0, f32::NAN, 1e-9] {
        assert!(
            volumes.bake(&mesh, step, &Progress::new()).is_err(),
            "{step}"
        );
    }
}

#[test]
fn a_disk_that_keeps_no_volume_is_told_of_once() {
    let (dir, _) = home();
    let file = dir.path().join("taken");
    std::fs::write(&file, "no folder").unwrap();
    let volumes = Volumes::with_cache(BakeCache::new(file), 64 << 20);
    assert!(volumes.take_warning().is_none());
    volumes
        .bake(&tetrahedron(0.4), 0.01, &Progress::new())
        .unwrap();
    volumes.finish_keeping();
    let line = volumes.take_warning().unwrap();
    assert!(line.contains("taken"), "{line}");
    assert!(volumes.take_warning().is_none());
}
