use super::*;
use crate::settings::{MirrorPlane, SymmetrySettings};
use crate::symmetry::images;
use bevy::math::{Quat, Vec3};
use midair_document::{Colour, History, MeshStore};
use midair_field::Primitive;

fn mirror() -> Vec<Image> {
    images(&SymmetrySettings {
        mirror: MirrorPlane::X,
        ..SymmetrySettings::default()
    })
}

fn block() -> Object {
    let shape = Primitive::Cuboid {
        half: Vec3::new(0.1, 0.2, 0.05),
        rounding: 0.0,
    };
    Object::solid("Block", shape)
}

fn there() -> Placement {
    Placement {
        translation: Vec3::new(0.4, 0.2, 0.1),
        rotation: Quat::from_rotation_z(0.3),
        scale: Vec3::new(1.0, 1.0, 1.5),
    }
}

fn commit(history: &mut History, images: &[Image], edits: Vec<Edit>) {
    let edits = spread(history.document(), edits, images);
    history.step("Step", edits).unwrap();
    assert_eq!(history.document().check(), [] as [String; 0]);
}

fn with_pair() -> (History, Vec<Image>) {
    let mut history = History::new(Document::new(), MeshStore::new());
    let images = mirror();
    let id = ObjectId(history.document().next_id());
    let object = Arc::new(block().placed(there()));
    commit(&mut history, &images, vec![Edit::Add { id, object }]);
    assert_eq!(history.document().len(), 2);
    (history, images)
}

#[test]
fn what_is_added_has_its_image_and_one_step_takes_both() {
    let (mut history, _) = with_pair();
    let at = |h: &History, id| h.document().object(ObjectId(id)).unwrap().placement;
    let (one, other) = (at(&history, 1), at(&history, 2));
    assert_eq!(
        other.translation,
        one.translation * Vec3::new(-1.0, 1.0, 1.0)
    );
    history.undo();
    assert!(history.document().is_empty());
}

#[test]
fn moving_colouring_and_removing_either_takes_the_other() {
    let (mut history, images) = with_pair();
    for id in [2, 1] {
        let id = ObjectId(id);
        let mut placement = history.document().object(id).unwrap().placement;
        placement.translation += Vec3::new(0.1, 0.3, 0.0);
        placement.rotation *= Quat::from_rotation_x(0.5);
        let colour = Some(Colour([id.0 as u8, 0, 0]));
        let edits = vec![
            Edit::SetPlacement { id, placement },
            Edit::SetColour { id, colour },
        ];
        commit(&mut history, &images, edits);
        let [a, b] = [1, 2].map(|i| history.document().object(ObjectId(i)).unwrap().clone());
        assert_eq!(history.document().len(), 2);
        assert!(stands(&images[0].placement(&a.placement), &b.placement));
        assert_eq!((a.colour, b.colour), (colour, colour));
    }
    let id = ObjectId(2);
    commit(&mut history, &images, vec![Edit::Remove { id }]);
    assert!(history.document().is_empty());
}

#[test]
fn what_lies_on_the_plane_has_no_image_until_it_leaves_it() {
    let mut history = History::new(Document::new(), MeshStore::new());
    let images = mirror();
    let id = ObjectId(1);
    let object = Arc::new(block().placed(Placement::at(Vec3::Y)));
    commit(&mut history, &images, vec![Edit::Add { id, object }]);
    assert_eq!(history.document().len(), 1);
    let placement = Placement::at(Vec3::new(0.3, 1.0, 0.0));
    let moved = vec![Edit::SetPlacement { id, placement }];
    commit(&mut history, &images, moved);
    assert_eq!(history.document().len(), 2);
    // Both moved by hand together: each stays what it was told, and nothing is added.
    let both = [1, 2].map(|id| {
        let id = ObjectId(id);
        let mut placement = history.document().object(id).unwrap().placement;
        placement.translation.x += 1.0;
        Edit::SetPlacement { id, placement }
    });
    commit(&mut history, &images, both.into());
    assert_eq!(history.document().len(), 2);
}

#[test]
fn marks_go_to_images_and_come_off_together() {
    let (mut history, images) = with_pair();
    let pending = vec![(ObjectId(2), Op::Subtract)];
    commit(&mut history, &images, vec![Edit::SetPending { pending }]);
    let both = vec![(ObjectId(2), Op::Subtract), (ObjectId(1), Op::Subtract)];
    assert_eq!(history.document().pending(), both);
    let pending = vec![(ObjectId(2), Op::Subtract), (ObjectId(1), Op::Union)];
    commit(&mut history, &images, vec![Edit::SetPending { pending }]);
    let united = vec![(ObjectId(2), Op::Union), (ObjectId(1), Op::Union)];
    assert_eq!(history.document().pending(), united);
    let pending = vec![(ObjectId(1), Op::Union)];
    commit(&mut history, &images, vec![Edit::SetPending { pending }]);
    assert_eq!(history.document().pending(), [] as [(ObjectId, Op); 0]);
}

#[test]
fn around_an_axis_with_a_mirror_nothing_is_made_twice() {
    let all = images(&SymmetrySettings {
        mirror: MirrorPlane::X,
        count: 4,
        ..SymmetrySettings::default()
    });
    for (at, count) in [
        (Vec3::ZERO, 1),
        (Vec3::new(0.0, 0.0, 0.5), 4),
        (Vec3::new(0.4, 0.0, 0.4), 4),
        (Vec3::new(0.2, 0.0, 0.7), 8),
    ] {
        let mut history = History::new(Document::new(), MeshStore::new());
        let object = Arc::new(block().placed(Placement::at(at)));
        let id = ObjectId(1);
        commit(&mut history, &all, vec![Edit::Add { id, object }]);
        assert_eq!(history.document().len(), count, "{at}");
    }
}
