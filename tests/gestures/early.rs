//! A solid is seen as soon as there is anything of it to see, and gets its sharp edges a moment later.

use std::sync::atomic::AtomicBool;

use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use midair_document::{Edit, ObjectId};
use midair_field::Placement;
use midair_mesh::TriMesh;
use midair_solid::Solid;
use midair_studio::command::Command;
use midair_studio::evaluate::{Delivery, Evaluations, Key};
use midair_studio::show::{ObjectMap, display_steps};

use crate::studio::Studio;

/// What draws an object.
fn drawn(s: &Studio, id: ObjectId) -> Handle<Mesh> {
    let entity = s.world().resource::<ObjectMap>().get(id).unwrap();
    s.world()
        .get::<Mesh3d>(entity)
        .expect("it is drawn")
        .0
        .clone()
}

fn points(s: &Studio, mesh: &Handle<Mesh>) -> Vec<Vec3> {
    let mesh = s.world().resource::<Assets<Mesh>>().get(mesh).unwrap();
    let Some(VertexAttributeValues::Float32x3(at)) = mesh.attribute(Mesh::ATTRIBUTE_POSITION)
    else {
        panic!("no points")
    };
    at.iter().map(|p| Vec3::from_array(*p)).collect()
}

/// The finest of an object's solids: its key, and its surface without its edges and with them.
fn finest(s: &Studio, id: ObjectId) -> (Key, TriMesh, TriMesh) {
    let object = s.object(id);
    let recipe = object.recipe().unwrap();
    let step = display_steps(s.document(), object, recipe)[0];
    let go = AtomicBool::new(false);
    let solid = Solid::make(recipe, &Placement::IDENTITY, step, &(), &go).unwrap();
    (Key::new(recipe, step), solid.mesh(), solid.crisp())
}

#[test]
fn a_solid_is_seen_before_its_edges_are_there() {
    let mut s = Studio::new();
    let id = s.place("solid/cube", Vec3::new(0.3, 0.6, 0.0));
    let old = drawn(&s, id);
    // Nothing is taken in: whatever is drawn anew is drawn before it is finished.
    s.world_mut().insert_resource(Delivery::Exactly(Vec::new()));
    s.ask(Command::Edit(Edit::SetStep { step: 0.014 }));
    let (key, plain, crisp) = finest(&s, id);
    assert!(plain.positions.len() < crisp.positions.len());
    s.until("seen early", |s| drawn(s, id) != old);
    assert_eq!(points(&s, &drawn(&s, id)), plain.positions);
    assert!(s.world().resource::<Evaluations>().made(&key).is_none());

    // Taken back before it is finished: what was there is drawn again.
    s.ask(Command::Undo);
    s.until("the old one", |s| drawn(s, id) == old);
    s.ask(Command::Redo);
    s.until("seen early", |s| drawn(s, id) != old);
    assert_eq!(points(&s, &drawn(&s, id)), plain.positions);

    s.world_mut().insert_resource(Delivery::AsTheyCome);
    s.settle();
    let made = s.world().resource::<Evaluations>().made(&key).unwrap();
    assert_eq!(*made.mesh, crisp);
    // Its edges are parted for drawing: what stands there is that, and the first points are those of the mesh.
    let sharp = points(&s, &drawn(&s, id));
    assert_eq!(sharp[..crisp.positions.len()], crisp.positions);
}
