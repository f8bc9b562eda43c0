//! Materials that are written in WGSL: chosen, set, kept, exported, and read again while the app runs.

use std::path::PathBuf;

use bevy::prelude::*;
use midair_brush::BRUSH;
use midair_document::{Dials, ObjectId};
use midair_field::Op;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};
use midair_studio::materials::{DialDraft, Living, MaterialShelf};
use midair_studio::objects::Ask;
use midair_studio::project::{Places, Project};
use midair_studio::show::{ObjectEntity, ObjectMap};

use crate::studio::Studio;

const HERE: Vec3 = Vec3::new(0.2, 1.0, 0.1);

fn material(s: &mut Studio, id: ObjectId, name: &str) {
    s.ask(Command::Objects(Ask::Material {
        ids: vec![id],
        material: Some(name.into()),
        dials: Dials::new(),
    }));
}

fn dial(s: &mut Studio, id: ObjectId, dial: &str, value: f32, done: bool) {
    s.ask(Command::Objects(Ask::Dial {
        ids: vec![id],
        dial: dial.into(),
        value,
        done,
    }));
}

/// What is drawn with, if it is written in WGSL.
fn living(s: &Studio, id: ObjectId) -> Option<Living> {
    let entity = s.world().resource::<ObjectMap>().get(id).unwrap();
    let plain = s.world().get::<MeshMaterial3d<StandardMaterial>>(entity);
    let living = s.world().get::<MeshMaterial3d<Living>>(entity);
    assert!(plain.is_some() != living.is_some(), "one of the two");
    let handle = &living?.0;
    Some(
        s.world()
            .resource::<Assets<Living>>()
            .get(handle)
            .unwrap()
            .clone(),
    )
}

fn shown(s: &Studio, id: ObjectId) -> String {
    format!("{:?}", living(s, id).map(|l| l.extension))
}

#[test]
fn a_painting_is_given_a_material_and_its_numbers_in_single_steps() {
    let mut s = Studio::new();
    s.ask(Command::Mode(BRUSH));
    s.ask(Command::Set {
        key: "brush.material".into(),
        value: "\"jelly\"".into(),
    });
    let steps = s.undo_len();
    s.reach(Side::Right, HERE);
    s.click(Side::Right, Action::Act);
    s.settle();
    // What was chosen before the first stroke is what it is made of, in the same step.
    let id = s.only();
    assert_eq!(s.object(id).material.as_deref(), Some("jelly"));
    assert_eq!(s.undo_len(), steps + 1);
    let jelly = living(&s, id).expect("drawn by its file");
    assert!(jelly.base.perceptual_roughness < 0.2);

    // A number that is dragged is shown, and one step when it is let go.
    let before = shown(&s, id);
    dial(&mut s, id, "height", 0.03, false);
    dial(&mut s, id, "height", 0.04, false);
    let dragged = shown(&s, id);
    assert_ne!(dragged, before);
    assert_eq!((s.undo_len(), s.object(id).dials.len()), (steps + 1, 0));
    dial(&mut s, id, "height", 0.04, true);
    assert_eq!(shown(&s, id), dragged);
    assert_eq!(*s.world().resource::<DialDraft>(), DialDraft::default());
    assert_eq!(s.undo_len(), steps + 2);
    assert_eq!(s.object(id).dials["height"], 0.04);
    let set = s.document().to_ron();
    s.ask(Command::Undo);
    assert_eq!(shown(&s, id), before);
    s.ask(Command::Redo);
    assert_eq!(s.document().to_ron(), set);
    assert_eq!(shown(&s, id), dragged);

    // Beyond its bounds, none, not of this material.
    dial(&mut s, id, "height", 1e9, true);
    assert_eq!(s.object(id).dials["height"], 0.05);
    dial(&mut s, id, "height", f32::NAN, true);
    assert_eq!(s.object(id).dials["height"], 0.004);
    let steps = s.undo_len();
    dial(&mut s, id, "shimmer", 0.5, true);
    assert_eq!(s.undo_len(), steps);
    // Another material begins as usual.
    material(&mut s, id, "aurora");
    assert!(s.object(id).dials.is_empty());
    assert_eq!(s.warnings(), [] as [String; 0]);
}

/// What the engine sees where it looks for things to draw anew: whether each object wears what it is made of.
#[derive(Resource, Default)]
struct Late(Vec<ObjectId>);

fn look_for_late(
    project: Res<Project>,
    shelf: Res<MaterialShelf>,
    objects: Query<(&ObjectEntity, Has<MeshMaterial3d<Living>>)>,
    mut late: ResMut<Late>,
) {
    for (id, lives) in &objects {
        let object = project.document().object(id.0);
        let wgsl = object.map(|o| shelf.all().at(shelf.all().place(o)).wgsl.is_some());
        if wgsl.is_some_and(|wgsl| wgsl != lives) {
            late.0.push(id.0);
        }
    }
}

/// Where it changes later in the frame, the card is given the new material with the old one's pipeline, and is lost.
#[test]
fn a_material_is_worn_before_the_engine_looks_at_what_is_drawn_anew() {
    let mut s = Studio::with(|app| {
        app.init_resource::<Late>().add_systems(
            PostUpdate,
            look_for_late.after(bevy::asset::AssetEventSystems),
        );
    });
    let a = s.place("solid/cube", HERE);
    s.place("solid/sphere", HERE + Vec3::X);
    for name in ["aurora", "matte", "jelly"] {
        material(&mut s, a, name);
        s.frames(2);
    }
    s.ask(Command::Undo);
    s.frames(2);
    assert_eq!(s.world().resource::<Late>().0, [], "dressed a frame late");
}

#[test]
fn an_operand_is_seen_as_one_and_a_result_as_what_it_is_made_of() {
    let mut s = Studio::new();
    let a = s.place("solid/cube", Vec3::new(0.0, 0.5, 0.0));
    let b = s.place("solid/sphere", Vec3::new(0.2, 0.5, 0.0));
    for id in [a, b] {
        material(&mut s, id, "pearl");
        assert!(living(&s, id).is_some(), "objects of every mode");
    }
    s.operate();
    s.mark(Vec3::new(0.0, 0.5, 0.0), Action::Up);
    assert_eq!(s.marks(), [(a, Op::Union)]);
    s.frames(2);
    assert!(living(&s, a).is_none(), "its colour says what it does");
    assert!(living(&s, b).is_some());
    s.ask(Command::Undo);
    s.frames(2);
    assert!(living(&s, a).is_some());
}

#[test]
fn a_file_keeps_it_and_gltf_has_its_nearest() {
    let mut s = Studio::new();
    let id = s.place("solid/sphere", HERE);
    material(&mut s, id, "aurora");
    dial(&mut s, id, "speed", 0.75, true);
    s.settle();
    let (file, glb) = (s.home.path().join("a.midair"), s.home.path().join("a.glb"));
    s.ask(Command::SaveAs(file.clone()));
    s.ask(Command::Export {
        path: glb.clone(),
        step: None,
        unit: None,
        up: None,
        only: None,
    });
    s.settle();
    let before = s.object(id).clone();
    s.ask(Command::New);
    s.settle();
    assert!(s.document().is_empty());
    s.ask(Command::Open(file));
    s.settle();
    assert_eq!(*s.object(id), before);
    assert!(living(&s, id).is_some());

    let bytes = std::fs::read(glb).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    let pbr = &json["materials"][0]["pbrMetallicRoughness"];
    let info = s
        .world()
        .resource::<MaterialShelf>()
        .all()
        .find("aurora")
        .unwrap();
    let roughness = pbr["roughnessFactor"].as_f64().unwrap();
    assert!(
        (roughness - f64::from(info.roughness)).abs() < 1e-6,
        "{pbr}"
    );
    // The file's own colour, linear: more blue than red.
    let colour = pbr["baseColorFactor"].as_array().unwrap();
    assert!(colour[2].as_f64() > colour[0].as_f64(), "{pbr}");
}

/// Frames until something has come to be.
const MOSS: &str = "//! name: Moss\n//! dial damp: 0 to 1, usually 0.5\n\
    fn surface(at: Point, plain: Surface) -> Surface {\n    var made = plain;\n    \
    made.roughness = dial.damp;\n    return made;\n}\n";

fn moss(s: &Studio, text: &str) -> PathBuf {
    let folder = Places::below(s.home.path()).library.materials();
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("moss.wgsl");
    std::fs::write(&file, text).unwrap();
    file
}

#[test]
fn a_file_is_read_again_while_the_app_runs_and_a_broken_one_changes_nothing() {
    let mut s = Studio::new();
    let id = s.place("solid/sphere", HERE);
    material(&mut s, id, "moss");
    s.frames(2);
    // Not here yet: one line, and it looks plain.
    assert!(living(&s, id).is_none());
    assert_eq!(s.warnings().len(), 1, "{:?}", s.warnings());
    assert!(
        s.warnings()[0].contains("made of \"moss\"") && s.warnings()[0].contains("moss.wgsl into")
    );
    s.frames(20);
    assert_eq!(s.warnings().len(), 1);

    let file = moss(&s, MOSS);
    s.until("read", |s| living(s, id).is_some());
    dial(&mut s, id, "damp", 0.25, true);
    let version = |s: &Studio| {
        let shelf = s.world().resource::<MaterialShelf>();
        let place = shelf.all().place(s.object(id));
        (shelf.version(place), shelf.all().at(place).wgsl.clone())
    };
    let (first, _) = version(&s);

    // A mistake in the fifth line.
    moss(&s, &MOSS.replace("dial.damp", "dial.dump + 1"));
    s.until("told", |s| s.warnings().len() == 2);
    let told = s.warnings()[1].clone();
    assert!(told.contains(&file.display().to_string()), "{told}");
    assert!(told.contains("line 5") && told.contains("dump"), "{told}");
    assert!(told.contains("stays as it was"), "{told}");
    assert_eq!(version(&s), (first, Some(MOSS.to_owned())));
    assert!(living(&s, id).is_some());
    s.frames(60);
    assert_eq!(s.warnings().len(), 2, "one line for one mistake");

    // A head that is none; then it is mended, with one dial more.
    moss(&s, &MOSS.replace("usually 0.5", "often 0.5"));
    s.until("told", |s| s.warnings().len() == 3);
    assert!(s.warnings()[2].contains("line 2"), "{:?}", s.warnings());
    let mended = MOSS.replace("//! dial", "//! dial age: 0 to 9, usually 1\n//! dial");
    moss(&s, &mended);
    s.until("mended", |s| version(s).1.as_deref() == Some(&mended));
    assert_eq!(version(&s).0, first + 1);
    s.frames(2);
    // What was set of it stays set, under its name.
    assert_eq!(s.object(id).dials["damp"], 0.25);
    let drawn = shown(&s, id);
    assert!(drawn.contains("1.0, 0.25"), "{drawn}");
}
