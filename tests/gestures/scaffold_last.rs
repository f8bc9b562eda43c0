//! What was drawn last, through undo and redo.

use midair_document::ObjectId;
use midair_scaffold::{Ask, Draft, Last};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};
use midair_studio::objects;
use midair_studio::project::Selection;

use crate::scaffold::{square, v};
use crate::studio::Studio;

const R: Side = Side::Right;

impl Studio {
    fn drawn_last(&self) -> Option<Last> {
        self.world().resource::<Draft>().last.clone()
    }

    fn undone(&mut self, times: usize) {
        for _ in 0..times {
            self.ask(Command::Undo);
            self.frame();
        }
    }

    fn redone(&mut self, times: usize) {
        for _ in 0..times {
            self.ask(Command::Redo);
            self.frame();
        }
    }
}

/// A square, and a line with several readings: nearly the diagonal's way, and an end near two keypoints.
fn with_diagonal() -> (Studio, Last) {
    let mut s = Studio::drawing();
    square(&mut s);
    s.pull(v(-0.19, 0.81, 0.01), v(0.03, 1.22, -0.01));
    let last = s.drawn_last().expect("a line was drawn");
    assert!(last.readings.len() > 1);
    (s, last)
}

#[test]
fn what_was_drawn_last_is_what_the_document_has_of_it() {
    let (mut s, diagonal) = with_diagonal();
    s.undone(1);
    // The one before it is what is spoken of …
    let before = s.drawn_last().expect("the square's last side");
    assert_eq!(before.id, ObjectId(diagonal.id.0 - 1));
    s.asked(Ask::Length(0.3));
    let side = s.lines()[3].clone();
    assert!((side.a.distance(side.b) - 0.3).abs() < 1e-9, "{side:?}");
    s.undone(1);
    // … and its ghosts are not in the way of what is drawn next.
    assert!(before.age > 5.0);
    s.pull(v(0.5, 1.0, 0.1), v(0.5, 1.3, 0.1));
    let other = s.drawn_last().expect("another line");
    // It has the id that the undo set free.
    assert_eq!(other.id, diagonal.id);
    assert_ne!(other.readings, diagonal.readings);
    s.undone(1);
    assert_eq!(s.drawn_last().map(|l| l.id), Some(before.id));
    s.undone(4);
    assert_eq!((s.lines().len(), s.drawn_last()), (0, None));
    s.redone(1);
    assert_eq!(s.drawn_last().map(|l| l.id), Some(ObjectId(1)));
    assert!(s.warnings().is_empty(), "{:?}", s.warnings());
}

#[test]
fn redo_brings_the_other_readings_back() {
    let (mut s, diagonal) = with_diagonal();
    let best = s.lines()[4].clone();
    s.pass(20.0);
    s.undone(1);
    s.redone(1);
    let again = s.drawn_last().expect("it is back");
    assert_eq!(
        (again.id, &again.readings),
        (diagonal.id, &diagonal.readings)
    );
    // Its ghosts as well, and a press picks one.
    let place = again.places[1].as_vec3();
    s.reach(R, place);
    s.click(R, Action::Act);
    let next = s.lines()[4].clone();
    assert_ne!(next, best);
    // The choice is a step of its own, and known after either.
    s.undone(1);
    assert_eq!(s.drawn_last().map(|l| l.chosen), Some(0));
    s.undone(1);
    s.redone(2);
    assert_eq!(s.drawn_last().map(|l| l.chosen), Some(1));
    assert_eq!(s.lines()[4], next);
    s.click(R, Action::Left);
    assert_eq!(s.lines()[4], best);
}

#[test]
fn what_is_deleted_is_last_again_when_that_is_undone() {
    let (mut s, diagonal) = with_diagonal();
    s.world_mut().resource_mut::<Selection>().0 = vec![diagonal.id];
    s.ask(Command::Objects(objects::Ask::Delete));
    s.frame();
    assert_eq!(s.lines().len(), 4);
    assert_eq!(s.drawn_last().map(|l| l.id), Some(ObjectId(4)));
    s.undone(1);
    assert_eq!(s.drawn_last().map(|l| l.id), Some(diagonal.id));
    s.world_mut().resource_mut::<Selection>().0.clear();
    let best = s.lines()[4].clone();
    s.click(R, Action::Right);
    assert_ne!(s.lines()[4], best);
}

#[test]
fn a_point_that_was_picked_goes_with_its_line() {
    let mut s = Studio::drawing();
    s.pull(v(0.0, 1.0, 0.0), v(0.6, 1.0, 0.0));
    s.pull(v(0.2, 1.4, 0.3), v(0.5, 1.6, 0.3));
    let end = s.lines()[1].b.as_vec3();
    s.reach(R, end);
    s.click(R, Action::Act);
    assert!(s.world().resource::<Draft>().picked.is_some());
    s.undone(1);
    assert_eq!(s.world().resource::<Draft>().picked, None);
    // The next press is a first one.
    let end = s.lines()[0].b.as_vec3();
    s.reach(R, end);
    s.click(R, Action::Act);
    assert_eq!(s.lines().len(), 1);
    assert!(s.world().resource::<Draft>().picked.is_some());
}
