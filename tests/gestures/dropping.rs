//! Files dropped on the window.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use bevy::window::PrimaryWindow;
use midair_mesh::{Format, Named, TriMesh, WriteOptions, encode};
use midair_studio::command::{Command, Errands};
use midair_studio::notice::Notices;
use midair_studio::project::Shelf;

use crate::desk::Desk;

/// A block `a` wide, as a file.
fn block(folder: &Path, name: &str, a: f32) -> PathBuf {
    let corner = |i: u32| {
        let bit = |n: u32| if i & n == 0 { 0.0 } else { 1.0 };
        Vec3::new(a * bit(1), bit(2), bit(4))
    };
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    let mesh = TriMesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces.into_iter().flat_map(halves).collect(),
        ..TriMesh::default()
    };
    let bytes = encode(
        Format::Obj,
        &[Named::new(name, &mesh)],
        &WriteOptions::default(),
    );
    let path = folder.join(format!("{name}.obj"));
    std::fs::write(&path, bytes.unwrap()).unwrap();
    path
}

impl Desk {
    pub fn drop_files(&mut self, paths: &[PathBuf]) {
        let world = self.app.world_mut();
        let mut windows = world.query_filtered::<Entity, With<PrimaryWindow>>();
        let window = windows.single(world).unwrap();
        for path in paths {
            let path_buf = path.clone();
            world.write_message(FileDragAndDrop::DroppedFile { window, path_buf });
        }
        self.wait(2);
    }

    fn own(&self) -> usize {
        let shelf = self.world().resource::<Shelf>();
        let mut categories = shelf.library.categories();
        let own = categories.find(|(name, _)| *name == midair_library::OWN);
        own.map_or(0, |(_, components)| components.len())
    }

    fn said(&self, text: &str) -> bool {
        let notices = self.world().resource::<Notices>();
        notices.recent(1e9).any(|n| n.text.contains(text))
    }
}

#[test]
fn forty_files_of_which_some_are_broken_come_as_one_batch() {
    let mut desk = Desk::new();
    let folder = desk.home.path().join("dropped");
    std::fs::create_dir_all(&folder).unwrap();
    let mut files: Vec<_> = (0..36)
        .map(|i| block(&folder, &format!("block {i}"), 0.2 + 0.05 * i as f32))
        .collect();
    let whole = std::fs::read(&files[0]).unwrap();
    for (at, (name, bytes)) in [
        (3, ("empty.stl", &b""[..])),
        (9, ("cut.obj", &whole[..whole.len() / 4])),
        (17, ("note.txt", &b"not a mesh"[..])),
        (39, ("noise.glb", &[7; 300][..])),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        files.insert(at, path);
    }
    desk.cursor(Vec2::new(700.0, 400.0));
    desk.wait(3);
    desk.drop_files(&files);
    let rows = desk.world().resource::<Errands>().rows();
    assert_eq!(rows.len(), 1, "one row for all: {rows:?}");
    assert!(rows[0].what.contains("of 40"), "{rows:?}");
    desk.settle();
    assert_eq!(desk.own(), 36);
    // Forty things at one spot are nobody's wish: they are in the library.
    assert_eq!(desk.document().len(), 0);
    for name in ["empty.stl", "cut.obj", "note.txt", "noise.glb"] {
        let lines = desk.warnings().iter().filter(|w| w.contains(name)).count();
        assert_eq!(lines, 1, "{name}: {:?}", desk.warnings());
    }
    assert_eq!(desk.warnings().len(), 4, "{:?}", desk.warnings());
    assert!(desk.said("36 of 40 meshes are in the library now; 4 could not be brought in."));
}

#[test]
fn a_few_stand_where_they_were_dropped_and_what_is_given_up_leaves_nothing() {
    let mut desk = Desk::new();
    let folder = desk.home.path().join("dropped");
    std::fs::create_dir_all(&folder).unwrap();
    let two = [block(&folder, "slab", 4.0), block(&folder, "post", 0.25)];
    let spot = desk.pixel(Vec3::new(0.1, 0.0, 0.05));
    desk.cursor(spot);
    desk.wait(3);
    desk.drop_files(&two);
    desk.settle();
    assert_eq!(desk.warnings(), [] as [String; 0]);
    let boxes: Vec<_> = desk
        .document()
        .objects()
        .map(|(_, o)| {
            let bounds = o.recipe().unwrap().bounds();
            let at = o.placement.translation;
            (at + bounds.min, at + bounds.max)
        })
        .collect();
    assert_eq!(boxes.len(), 2);
    for (low, _) in &boxes {
        assert!(low.y.abs() < 1e-4, "on the ground: {low}");
    }
    let (a, b) = (boxes[0], boxes[1]);
    assert!(a.1.x < b.0.x || b.1.x < a.0.x, "side by side: {boxes:?}");
    assert!(boxes.iter().any(|(low, high)| {
        let middle = low.midpoint(*high);
        middle.distance(Vec3::new(0.1, middle.y, 0.05)) < 1e-3
    }));

    // Over a panel they are meant for the library alone.
    let before = (desk.document().len(), desk.own());
    desk.cursor(Vec2::new(700.0, 10.0));
    desk.wait(3);
    desk.drop_files(&[block(&folder, "plank", 9.0)]);
    desk.settle();
    assert_eq!(
        (desk.document().len(), desk.own()),
        (before.0, before.1 + 1)
    );

    let many: Vec<_> = (0..30)
        .map(|i| block(&folder, &format!("late {i}"), 10.0 + i as f32))
        .collect();
    desk.drop_files(&many);
    desk.app.world_mut().write_message(Command::CancelErrand(0));
    desk.settle();
    assert!(desk.own() < before.1 + 1 + 30);
    assert!(desk.said("were given up"));
    assert_eq!(desk.warnings(), [] as [String; 0]);
}
