//! Colours and materials: the eyedropper, and palettes that are kept.

use bevy::prelude::*;
use midair_document::{Colour, ObjectId};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};
use midair_studio::objects::{Ask, Dropper, How};
use midair_studio::project::Selection;
use midair_studio::settings::{PaletteSettings, Settings, Swatch};

use crate::desk::Desk;
use crate::studio::Studio;

const RED: Colour = Colour([200, 40, 30]);

fn look(ids: Vec<ObjectId>) -> Command {
    Command::Objects(Ask::Look {
        ids,
        colour: Some(RED),
        material: Some("metal".into()),
    })
}

fn select(ids: Vec<ObjectId>) -> Command {
    let how = How::Set;
    Command::Objects(Ask::Select { ids, how })
}

#[test]
fn the_eyedropper_takes_the_look_of_what_the_hand_touches() {
    let mut s = Studio::new();
    let a = s.place("solid/cube", Vec3::new(0.0, 0.5, 0.0));
    let b = s.place("solid/cube", Vec3::new(0.8, 0.5, 0.0));
    s.ask(look(vec![a]));
    s.ask(select(vec![b]));
    let steps = s.undo_len();
    s.ask(Command::Objects(Ask::Dropper { on: true }));
    s.reach(Side::Right, Vec3::new(0.0, 0.5, 0.0));
    s.press(Side::Right, Action::Act);
    s.frames(3);
    s.let_go(Side::Right, Action::Act);
    s.frames(2);
    assert_eq!(s.object(b).colour, Some(RED));
    assert_eq!(s.object(b).material.as_deref(), Some("metal"));
    assert_eq!(s.undo_len(), steps + 1, "one step");
    // Its click selected nothing else, and it is put away.
    assert_eq!(s.world().resource::<Selection>().0, [b]);
    assert!(!s.world().resource::<Dropper>().is_on());
    s.press(Side::Right, Action::Act);
    s.let_go(Side::Right, Action::Act);
    assert_eq!(s.world().resource::<Selection>().0, [a]);
}

#[test]
fn it_is_put_away_by_cancel_and_by_a_click_on_nothing() {
    let mut s = Studio::new();
    let a = s.place("solid/cube", Vec3::new(0.0, 0.5, 0.0));
    s.ask(select(vec![a]));
    for (at, action) in [
        (Vec3::new(0.0, 0.5, 0.0), Action::Cancel),
        (Vec3::new(0.0, 3.0, 0.0), Action::Act),
    ] {
        s.ask(Command::Objects(Ask::Dropper { on: true }));
        s.frame();
        assert!(s.world().resource::<Dropper>().is_on());
        s.reach(Side::Right, at);
        s.press(Side::Right, action);
        s.frames(2);
        s.let_go(Side::Right, action);
        s.frames(2);
        assert!(!s.world().resource::<Dropper>().is_on());
        assert_eq!(s.world().resource::<Selection>().0, [a]);
    }
    s.ask(Command::Objects(Ask::SelectNone));
    s.ask(Command::Objects(Ask::Dropper { on: true }));
    assert!(
        !s.world().resource::<Dropper>().is_on(),
        "there is nothing to give it to"
    );
}

#[test]
fn by_key_and_mouse_it_is_two_clicks() {
    let mut desk = Desk::new();
    let (a, b) = (desk.thing("solid/cube"), desk.thing("solid/sphere"));
    desk.app.world_mut().write_message(look(vec![a]));
    desk.wait(2);
    desk.hover(b);
    desk.click();
    assert_eq!(desk.selected(), [b]);
    desk.hold(KeyCode::ShiftLeft, true);
    desk.strike_one(KeyCode::KeyC);
    desk.hold(KeyCode::ShiftLeft, false);
    let before = desk.stands(a);
    desk.hover(a);
    desk.click();
    assert_eq!(desk.document().object(b).unwrap().colour, Some(RED));
    assert_eq!(desk.selected(), [b]);
    assert_eq!(desk.stands(a), before);
}

#[test]
fn palettes_are_settings_and_recordings_do_without_them() {
    let mut s = Studio::new();
    let swatch = Swatch {
        colour: RED,
        material: Some("clay".into()),
    };
    let kept = PaletteSettings::default().with(swatch).unwrap();
    s.ask(Settings::command("palettes", &kept));
    let settings = s.world().resource::<Settings>();
    assert_eq!(settings.palettes, kept);
    assert!(settings.shaping().is_empty());
    let text = serde_json::to_string(settings).unwrap();
    let back: Settings = serde_json::from_str(&text).unwrap();
    assert_eq!(back.palettes, kept);
}
