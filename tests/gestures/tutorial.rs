//! The three tasks of the tutorial, by doing what its steps say and nothing else.

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use midair_document::ObjectId;
use midair_field::Node;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::help::Tutorial;
use midair_studio::panel::Panels;
use midair_studio::settings::{Lesson, Progress, Settings};

use crate::studio::Studio;

impl Studio {
    fn progress(&self) -> Progress {
        self.world().resource::<Settings>().help.tutorial
    }

    fn step_name(&self) -> String {
        let tutorial = self.world().resource::<Tutorial>();
        tutorial
            .name(self.progress().step)
            .unwrap_or("the end")
            .to_owned()
    }

    fn begin_tutorial(&mut self) {
        self.ask(Settings::command("help.tutorial.state", Lesson::Going));
    }

    /// The latest of a part.
    fn part(&self, name: &str) -> ObjectId {
        let found = self.document().objects().rev().find(|(_, o)| {
            let node = o.recipe().map(|r| r.node());
            matches!(node, Some(Node::Component { id, .. }) if id.starts_with(name))
        });
        found.expect("the part").0
    }

    /// Picks a component as the wand would, at a place.
    fn pick(&mut self, component: &str, at: Vec3) {
        self.reach(Side::Right, at);
        self.ask(Command::Place {
            component: component.to_owned(),
            side: Side::Right,
        });
        self.settle();
    }

    /// The right hand takes what is at `from` to `to`.
    fn bring(&mut self, from: Vec3, to: Vec3) {
        self.reach(Side::Right, from);
        self.press(Side::Right, Action::Grab);
        self.carry_right(to);
        self.let_go(Side::Right, Action::Grab);
        self.settle();
    }

    fn delete_at(&mut self, at: Vec3) {
        self.reach(Side::Right, at);
        for _ in 0..2 {
            self.press(Side::Right, Action::Centre);
            self.frames(4);
            self.let_go(Side::Right, Action::Centre);
            self.frames(4);
        }
        self.pass(0.5);
    }

    /// What the step of that name says, by hands.
    fn obey(&mut self, step: &str) {
        let legs = [
            Vec3::new(-0.12, 0.19, 0.12),
            Vec3::new(0.12, 0.19, 0.12),
            Vec3::new(0.12, 0.19, -0.12),
            Vec3::new(-0.12, 0.19, -0.12),
        ];
        let aside = |leg: Vec3| Vec3::new(leg.x * 4.0, 0.25, leg.z * 1.4);
        match step {
            "library" => self.click(Side::Right, Action::Library),
            "cube" => self.pick("solid/cube", Vec3::new(-1.0, 0.3, 0.0)),
            "sphere" => self.pick("solid/sphere", Vec3::new(-0.5, 0.3, 0.1)),
            "meet" => self.bring(Vec3::new(-0.5, 0.3, 0.1), Vec3::new(-0.85, 0.45, 0.12)),
            "unite-cube" => {
                self.operate();
                self.mark(Vec3::new(-1.15, 0.15, -0.15), Action::Up);
            }
            "unite-sphere" => self.mark(Vec3::new(-0.72, 0.55, 0.12), Action::Up),
            "unite" | "intersect" | "subtract" | "chair" | "cup" => self.finish(),
            "undo" | "undo-again" => self.click(Side::Left, Action::Undo),
            "intersect-sphere" => {
                self.operate();
                self.mark(Vec3::new(-0.72, 0.55, 0.12), Action::Right);
            }
            "subtract-sphere" => {
                self.operate();
                self.mark(Vec3::new(-0.72, 0.55, 0.12), Action::Down);
            }
            "clear" => self.delete_at(Vec3::new(-1.15, 0.15, -0.15)),
            "seat" => self.pick("chair/seat-cushion", Vec3::new(0.0, 0.42, 0.0)),
            "legs" => {
                for leg in legs {
                    self.pick("chair/leg-round", aside(leg));
                }
            }
            "under" => {
                for leg in legs {
                    self.bring(aside(leg), leg);
                }
            }
            "back" => self.pick("chair/back-panel", Vec3::new(0.0, 0.9, 0.3)),
            "back-on" => self.bring(Vec3::new(0.0, 0.9, 0.3), Vec3::new(0.0, 0.62, -0.18)),
            "mark-seat" => {
                self.operate();
                self.mark(Vec3::new(0.0, 0.42, 0.05), Action::Up);
            }
            "mark-rest" => {
                for leg in legs {
                    self.mark(leg.with_y(0.1), Action::Up);
                }
                self.mark(Vec3::new(0.0, 0.75, -0.18), Action::Up);
            }
            "clear-chair" => self.delete_at(Vec3::new(0.0, 0.42, 0.05)),
            "body" => self.pick("solid/cylinder", Vec3::new(0.0, 0.4, 0.0)),
            "ring" => self.pick("solid/torus", Vec3::new(0.6, 0.4, 0.0)),
            "upright" => self.handle(),
            "second" => self.pick("solid/cylinder", Vec3::new(-0.6, 0.4, 0.0)),
            "narrow" => self.narrow(),
            "mark-cup" => {
                self.operate();
                self.mark(Vec3::new(0.0, 0.22, 0.0), Action::Up);
                self.mark(Vec3::new(0.275, 0.4, 0.0), Action::Up);
            }
            "mark-hollow" => self.mark(Vec3::new(0.0, 0.64, 0.0), Action::Down),
            "save" => {
                self.ask(Command::Save);
                self.settle();
            }
            other => panic!("nobody knows how to do {other}"),
        }
        // What was done along with it is passed over, one step a frame.
        self.frames(5);
    }

    /// The torus is turned upright by the right hand, made smaller by both and carried to the body.
    fn handle(&mut self) {
        let upright = Quat::from_rotation_x(FRAC_PI_2);
        let right = |x: f32, rotation| {
            Some(Pose {
                position: Vec3::new(x, 0.4, 0.0),
                rotation,
            })
        };
        self.reach(Side::Right, Vec3::new(0.75, 0.4, 0.0));
        self.press(Side::Right, Action::Grab);
        self.carry(None, right(0.75, upright));
        self.reach(Side::Left, Vec3::new(0.45, 0.4, 0.0));
        self.press(Side::Left, Action::Grab);
        let left = Some(Pose::at(Vec3::new(0.51, 0.4, 0.0)));
        self.carry(left, right(0.69, upright));
        self.let_go(Side::Left, Action::Grab);
        self.carry(None, right(0.26, upright));
        self.let_go(Side::Right, Action::Grab);
        self.settle();
    }

    /// The second cylinder along X, then along Z; then it goes into the first one.
    fn narrow(&mut self) {
        let at = |x: f32| Some(Pose::at(Vec3::new(x, 0.4, 0.0)));
        self.reach(Side::Left, Vec3::new(-0.7, 0.4, 0.0));
        self.reach(Side::Right, Vec3::new(-0.5, 0.4, 0.0));
        self.press(Side::Left, Action::Grab);
        self.press(Side::Right, Action::Grab);
        self.swipe(Some(Vec2::new(0.0, 0.9)));
        self.carry(at(-0.685), at(-0.515));
        self.swipe(Some(Vec2::new(0.0, -0.9)));
        self.carry(at(-0.6723), at(-0.5278));
        self.swipe(None);
        self.let_go(Side::Left, Action::Grab);
        self.carry_right(Vec3::new(0.0722, 0.46, 0.0));
        self.let_go(Side::Right, Action::Grab);
        self.settle();
    }
}

#[test]
fn whoever_does_what_the_tutorial_says_makes_the_three_models() {
    let mut studio = Studio::new();
    studio.begin_tutorial();
    let steps = studio.world().resource::<Tutorial>().len();
    while studio.progress().state == Lesson::Going {
        let (name, step) = (studio.step_name(), studio.progress().step);
        studio.obey(&name);
        assert!(
            studio.progress().step > step,
            "{name} is done: {:?}",
            studio.warnings()
        );
        if matches!(
            name.as_str(),
            "unite" | "intersect" | "subtract" | "chair" | "cup"
        ) {
            let made = studio.only();
            studio.faultless(made, 0.01);
        }
    }
    assert_eq!(studio.progress().state, Lesson::Done);
    assert_eq!(studio.warnings(), [""; 0]);
    println!("{steps} steps, {:.1} s", studio.progress().seconds);
}

#[test]
fn a_step_that_is_done_is_passed_over_and_any_way_will_do() {
    let mut studio = Studio::new();
    studio.place("solid/cube", Vec3::new(0.0, 0.3, 0.0));
    let sphere = studio.place("solid/sphere", Vec3::new(0.0, 0.3, 0.0));
    studio.begin_tutorial();
    studio.frames(6);
    assert_eq!(studio.step_name(), "unite-cube");
    assert_eq!(studio.part("solid/sphere"), sphere);
}

#[test]
fn a_wrong_turn_is_told_the_way_out() {
    let mut studio = Studio::new();
    studio.place("solid/cube", Vec3::new(0.0, 0.3, 0.0));
    studio.begin_tutorial();
    studio.frames(6);
    assert_eq!(studio.step_name(), "sphere");
    assert_eq!(studio.world().resource::<Tutorial>().wrong(), None);
    studio.click(Side::Right, Action::Library);
    let wrong = studio.world().resource::<Tutorial>().wrong();
    assert!(wrong.is_some_and(|w| w.contains("closed")), "{wrong:?}");
}

#[test]
fn it_is_left_skipped_and_gone_on_with() {
    let mut studio = Studio::new();
    let panel = |open| Command::Panel {
        id: "tutorial".to_owned(),
        open,
    };
    studio.begin_tutorial();
    studio.ask(Settings::command("help.tutorial.step", 20));
    studio.ask(panel(false));
    assert_eq!(studio.progress().state, Lesson::Left);
    studio.click(Side::Right, Action::Library);
    assert_eq!(studio.progress().step, 20, "nothing goes on meanwhile");
    studio.ask(panel(true));
    assert_eq!(studio.progress().state, Lesson::Going);
    assert!(studio.world().resource::<Panels>().is_open("tutorial"));
    let last = studio.world().resource::<Tutorial>().len();
    studio.ask(Settings::command("help.tutorial.step", last));
    assert_eq!(studio.progress().state, Lesson::Done);
}
