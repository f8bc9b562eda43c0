//! What a newcomer does by mouse with what the documents promise.

use bevy::prelude::*;
use midair_brush::BRUSH;
use midair_document::Edit;
use midair_field::Node;
use midair_studio::command::Command;
use midair_studio::hands::Side;
use midair_studio::objects::Ask;
use midair_studio::settings::{Settings, SweepShape};
use midair_studio::tools::Tools;
use midair_sweep::{SWEEP, SweepAsk};

use crate::desk::Desk;

impl Desk {
    /// The middle of a button, in pixels of the window.
    fn place_of(&mut self, button: &str) -> Vec2 {
        let Some(seen) = self.button_called(button) else {
            let all: Vec<_> = self.screen().into_iter().map(|s| s.text).collect();
            panic!("{button} is not to be seen: {all:?}");
        };
        let at = seen.rect.center();
        Vec2::new(at.x, at.y)
    }

    fn reads(&mut self, words: &str) -> bool {
        self.screen().iter().any(|s| s.text.contains(words))
    }

    fn tells(&mut self, command: Command) {
        self.app.world_mut().write_message(command);
        self.wait(3);
    }

    /// The clones of each row, the latest last.
    fn rows(&self) -> Vec<u32> {
        let recipes = self.document().objects().filter_map(|(_, o)| o.recipe());
        let rows = recipes.filter_map(|r| match r.node() {
            Node::Clones { row, .. } => Some(row.count),
            _ => None,
        });
        rows.collect()
    }
}

#[test]
fn what_is_dragged_onto_a_modes_button_is_carried_into_it() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let cube = desk.thing("solid/cube");
    let (stood, steps) = (desk.stands(cube), desk.steps());
    let from = desk.hover(cube);
    let to = desk.place_of("Brush");
    desk.mouse(MouseButton::Left, true);
    desk.wait(2);
    desk.glide(to);
    assert!(desk.reads("Let go: carried into Brush"), "{from}");
    desk.mouse(MouseButton::Left, false);
    desk.wait(4);
    let tools = desk.world().resource::<Tools>();
    assert_eq!(tools.active().map(|t| t.id.as_str()), Some("brush"));
    assert_eq!(desk.stands(cube), stood, "it goes back to where it stood");
    assert_eq!(desk.steps(), steps, "{:?}", desk.warnings());
}

#[test]
fn what_is_let_go_of_over_another_panel_is_put_down_as_it_was_dragged() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let cube = desk.thing("solid/cube");
    let (stood, steps) = (desk.stands(cube), desk.steps());
    let from = desk.hover(cube);
    desk.drag(MouseButton::Left, from, Vec2::new(120.0, 400.0));
    desk.wait(4);
    assert_eq!(desk.steps(), steps + 1);
    let moved = desk.stands(cube);
    let at = desk.pixel(moved);
    assert!(at.x < 300.0, "under the pointer: {stood}, {moved}, {at}");
}

#[test]
fn what_is_kept_in_the_library_is_placed_again() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let cube = desk.thing("solid/cube");
    desk.hover(cube);
    desk.click();
    let name = "Brick".to_owned();
    desk.tells(Command::Edit(Edit::Rename {
        id: cube,
        name: name.clone(),
    }));
    for (button, things) in [("Keep", 1), (name.as_str(), 2)] {
        let at = desk.place_of(button);
        desk.glide(at);
        desk.click();
        desk.settle();
        assert_eq!(desk.document().len(), things, "{:?}", desk.warnings());
    }
    let own = |desk: &Desk| {
        let shelf = desk.world().resource::<midair_studio::project::Shelf>();
        let mut categories = shelf.library.categories();
        let own = categories.find(|(title, _)| *title == midair_library::OWN);
        own.map_or(0, |(_, all)| all.len())
    };
    assert_eq!(own(&desk), 1);
    // And taken out again; what was placed stays, and so does the file.
    let at = desk.place_of(&name);
    desk.glide(at);
    for down in [true, false] {
        desk.mouse(MouseButton::Right, down);
        desk.wait(4);
    }
    let out = desk.place_of("Take it out of the library");
    desk.glide(out);
    desk.click();
    desk.settle();
    assert_eq!((own(&desk), desk.document().len()), (0, 2));
    let folder = desk.world().resource::<midair_studio::project::Places>();
    let mut files = std::fs::read_dir(folder.library.components()).unwrap();
    assert!(files.all(|f| f.unwrap().path().extension().is_some_and(|e| e == "away")));
}

#[test]
fn the_hand_that_was_left_holding_says_how_it_lets_go() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let cube = desk.thing("solid/cube");
    let steps = desk.steps();
    let at = desk.hover(cube);
    desk.mouse(MouseButton::Left, true);
    desk.wait(3);
    desk.strike_one(KeyCode::Tab);
    desk.mouse(MouseButton::Left, false);
    desk.wait(3);
    assert!(desk.reads("let go of it") && desk.reads("The right hand holds it"));
    // The other one takes it too: pulled apart, it grows.
    desk.glide(at + Vec2::new(30.0, 0.0));
    let (from, to) = (at + Vec2::new(30.0, 0.0), at + Vec2::new(60.0, 0.0));
    desk.drag(MouseButton::Left, from, to);
    assert!(desk.reads("let go of it"));
    desk.strike_one(KeyCode::Tab);
    desk.wait(3);
    assert!(!desk.reads("let go of it"));
    let scale = desk.document().object(cube).unwrap().placement.scale;
    assert!(scale.x > 1.3, "{scale}");
    assert_eq!(desk.steps(), steps + 1);
    assert_eq!(
        desk.world()
            .resource::<midair_studio::hold::Held>()
            .get(Side::Right),
        None
    );
}

#[test]
fn a_row_of_clones_is_kept_as_it_hangs_and_counted_anew() {
    let mut desk = Desk::new();
    desk.open_eyes();
    desk.tells(Command::Mode(SWEEP));
    desk.tells(Settings::command("sweep.shape", SweepShape::Clones));
    let (left, right, up) = (
        Vec2::new(560.0, 460.0),
        Vec2::new(760.0, 460.0),
        Vec2::new(0.0, -60.0),
    );
    desk.drag(MouseButton::Left, left, left + up);
    desk.drag(MouseButton::Left, right, right + up);
    assert!(desk.reads("keep the row as it hangs"));
    desk.strike_one(KeyCode::Enter);
    desk.settle();
    let many = desk.world().resource::<Settings>().sweep.clones;
    assert_eq!(desk.rows(), [many], "{:?}", desk.warnings());
    let (row, object) = desk.document().objects().next().unwrap();
    let near = object.placement.translation;
    let at = desk.pixel(near);
    assert!(at.distance(left.midpoint(right)) < 40.0, "{at}");
    // It is there; another one at the same place would not be seen.
    desk.strike_one(KeyCode::Enter);
    assert_eq!(desk.rows(), [many]);
    let steps = desk.steps();
    desk.tells(Command::Objects(Ask::Select {
        ids: vec![row],
        how: midair_studio::objects::How::Set,
    }));
    desk.tells(SweepAsk::Clones(many + 8).command());
    assert_eq!((desk.rows(), desk.steps()), (vec![many + 8], steps + 1));
    desk.tells(Command::Undo);
    assert_eq!(desk.rows(), [many]);
}

#[test]
fn library_and_brush_have_a_column_each() {
    let mut desk = Desk::new();
    desk.open_eyes();
    desk.tells(Command::Mode(BRUSH));
    for id in ["library", "brush"] {
        desk.tells(Command::Panel {
            id: id.into(),
            open: true,
        });
    }
    desk.wait(30);
    let all = desk.screen();
    let place = |words: &str| {
        let found = all.iter().find(|s| s.text.contains(words));
        found.unwrap_or_else(|| panic!("{words}")).rect
    };
    let (library, radius) = (place("Import"), place("Radius"));
    assert!(
        library.right() < 300.0 && radius.left() > 900.0,
        "{library}, {radius}"
    );
    // Down to its last rows.
    assert!(place("Material").bottom() < 660.0);
}
