//! Everything can be taken back, to the byte.

use bevy::prelude::*;
use midair_document::{Colour, Document, Edit, Group, GroupId, Layer, LayerId, Object, ObjectId};
use midair_field::{Op, Placement, Primitive};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Side};

use crate::studio::Studio;

/// Undoes everything, then redoes it: the document is the same at both ends.
fn there_and_back(s: &mut Studio, start: &str) {
    let end = s.document().to_ron();
    let steps = s.undo_len();
    for _ in 0..steps {
        s.ask(Command::Undo);
    }
    assert_eq!(s.undo_len(), 0);
    assert_eq!(s.document().to_ron(), start);
    for _ in 0..steps {
        s.ask(Command::Redo);
    }
    assert_eq!(s.redo_len(), 0);
    assert_eq!(s.document().to_ron(), end);
    s.settle();
    assert!(s.warnings().is_empty(), "{:?}", s.warnings());
}

#[test]
fn a_whole_piece_of_work_is_taken_back_and_done_again() {
    let mut s = Studio::new();
    s.ask(Command::Undo);
    let start = s.document().to_ron();
    assert_eq!(start, Document::new().to_ron());
    let (a, b, c) = (
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(0.25, 1.0, 0.0),
        Vec3::new(0.9, 1.0, 0.0),
    );
    s.place("solid/cube", a);
    s.place("solid/sphere", b);
    let torus = s.place("solid/torus", c);
    s.reach(Side::Right, c + Vec3::X * 0.15);
    s.press(Side::Right, Action::Grab);
    s.carry_right(c + Vec3::new(0.15, 0.2, 0.0));
    s.let_go(Side::Right, Action::Grab);
    s.operate();
    s.mark(a - Vec3::X * 0.15, Action::Up);
    s.mark(b + Vec3::X * 0.12, Action::Down);
    s.finish();
    assert_eq!(s.document().len(), 2);
    s.operate();
    s.mark(a - Vec3::X * 0.15, Action::Up);
    s.finish();
    assert_eq!(s.document().len(), 3, "copied");
    s.settle();
    s.reach(Side::Left, s.placement(torus).translation + Vec3::X * 0.15);
    s.click(Side::Left, Action::Delete);
    assert_eq!(s.document().len(), 2);
    there_and_back(&mut s, &start);
}

/// A small generator, the same in every run.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n.max(1)
    }

    fn of<T: Clone>(&mut self, all: &[T]) -> Option<T> {
        (!all.is_empty()).then(|| all[self.roll(all.len())].clone())
    }

    fn metres(&mut self) -> f32 {
        self.roll(2001) as f32 / 1000.0 - 1.0
    }
}

fn any_edit(document: &Document, dice: &mut Dice) -> Option<Edit> {
    let objects: Vec<ObjectId> = document.objects().map(|(id, _)| id).collect();
    let layers: Vec<LayerId> = document.layers().map(|(id, _)| id).collect();
    let groups: Vec<GroupId> = document.groups().map(|(id, _)| id).collect();
    let on = dice.roll(2) == 0;
    let next = document.next_id();
    let pick = dice.of(&objects);
    Some(match dice.roll(18) {
        0..=3 => Edit::Add {
            id: ObjectId(next),
            object: {
                let half = Vec3::splat(0.02 * (1 + dice.roll(3)) as f32);
                let cuboid = Primitive::Cuboid {
                    half,
                    rounding: 0.0,
                };
                Object::solid(format!("Thing {next}"), cuboid).into()
            },
        },
        4 => Edit::Remove { id: pick? },
        5..=7 => {
            let at = Vec3::new(dice.metres(), dice.metres(), dice.metres());
            let placement = Placement {
                rotation: Quat::from_rotation_y(dice.metres()),
                scale: Vec3::splat(1.5 + dice.metres()),
                ..Placement::at(at)
            };
            Edit::SetPlacement {
                id: pick?,
                placement,
            }
        }
        8 => Edit::Rename {
            id: pick?,
            name: format!("Name {}", dice.roll(50)),
        },
        9 => Edit::SetVisible {
            id: pick?,
            visible: on,
        },
        10 => Edit::SetLocked {
            id: pick?,
            locked: on,
        },
        11 => Edit::SetColour {
            id: pick?,
            colour: on.then_some(Colour([dice.roll(256) as u8, 0, 7])),
        },
        12 => {
            let op = [Op::Union, Op::Intersect, Op::Subtract][dice.roll(3)];
            Edit::SetMark {
                id: pick?,
                op: on.then_some(op),
            }
        }
        13 => Edit::AddLayer {
            id: LayerId(next),
            layer: Layer::new(format!("Layer {next}")),
        },
        14 => Edit::SetLayer {
            id: pick?,
            layer: dice.of(&layers)?,
        },
        15 => Edit::AddGroup {
            id: GroupId(next),
            group: Group {
                name: format!("Group {next}"),
                parent: dice.of(&groups).filter(|_| on),
            },
        },
        16 => Edit::SetGroup {
            id: pick?,
            group: dice.of(&groups).filter(|_| on),
        },
        _ => {
            let size = 0.02 * (1 + dice.roll(3)) as f32;
            Edit::set_recipe(pick?, Primitive::Sphere { radius: size })
        }
    })
}

#[test]
fn a_thousand_mixed_edits_are_taken_back_to_the_byte() {
    let mut s = Studio::new();
    s.ask(Command::Undo);
    let start = s.document().to_ron();
    let mut dice = Dice(7);
    let mut asked = 0;
    while asked < 1000 {
        let Some(edit) = any_edit(s.document(), &mut dice) else {
            continue;
        };
        s.ask(Command::Edit(edit));
        asked += 1;
        // Now and then the user changes their mind.
        if dice.roll(40) == 0 {
            for _ in 0..dice.roll(5) {
                s.ask(Command::Undo);
            }
            s.ask(Command::Redo);
        }
    }
    assert!(s.undo_len() > 700, "{}", s.undo_len());
    there_and_back(&mut s, &start);
}
