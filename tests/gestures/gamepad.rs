//! The gamepad, through Bevy's own messages.

use bevy::input::gamepad::GamepadButton as Button;
use bevy::math::{Vec2, Vec3};
use bevy::prelude::*;
use midair_document::ObjectId;
use midair_flatscreen::focus::Typing;
use midair_studio::hands::Side;
use midair_studio::panel::{Key, Keyboard};

use crate::desk::Desk;

impl Desk {
    /// Types on the keyboard on the screen, by the shortest ways.
    fn type_text(&mut self, text: &str) {
        for letter in text.chars() {
            if letter == ' ' {
                self.tap(Button::North);
                continue;
            }
            let from = self.world().resource::<Typing>().state;
            for button in way(from, Key::Letter(letter)) {
                self.tap(button);
            }
            self.tap(Button::South);
        }
    }

    /// Into the library, by the way that is shortest.
    fn enter_library(&mut self) {
        if !self.is_open("library") {
            self.tap(Button::Start);
        } else if !self.focus().is_inside() {
            self.tap(Button::LeftThumb);
        }
        self.wait(3);
        assert!(self.focus().is_inside(), "in the library");
    }

    /// Takes a component out of the library, by its name: it is at the leading hand then.
    pub fn take(&mut self, name: &str) -> ObjectId {
        let before = self.document().len();
        self.enter_library();
        // RB turns from category to category.
        for _ in 0..8 {
            if self.button_called(name).is_some() {
                break;
            }
            self.tap(Button::RightTrigger);
            self.wait(3);
        }
        self.walk_to(name);
        self.tap(Button::South);
        self.settle();
        assert_eq!(self.document().len(), before + 1, "{:?}", self.warnings());
        let (id, object) = self.document().objects().next_back().unwrap();
        assert_eq!(object.name, name);
        id
    }

    /// The same by typing its name on the keyboard on the screen.
    fn take_by_typing(&mut self, name: &str) -> ObjectId {
        let before = self.document().len();
        self.enter_library();
        for _ in 0..60 {
            if self.focus().is_text() {
                break;
            }
            self.tap(Button::DPadUp);
        }
        assert!(self.focus().is_text(), "on the search field");
        self.tap(Button::South);
        assert!(self.world().resource::<Typing>().open, "the keyboard is up");
        let word = name.to_lowercase();
        self.type_text(&word);
        self.tap(Button::Start);
        self.wait(3);
        self.walk_to(name);
        self.tap(Button::South);
        self.settle();
        assert_eq!(self.document().len(), before + 1, "{:?}", self.warnings());
        self.document().objects().next_back().unwrap().0
    }

    /// The D-pad to what is called so on the screen.
    pub fn walk_to(&mut self, name: &str) {
        self.wait(3);
        assert!(self.focus().is_inside(), "in a panel, for {name}");
        for _ in 0..40 {
            let seen = self.button_called(name);
            let seen = seen.unwrap_or_else(|| panic!("there is no \"{name}\" on the screen"));
            let goal = seen.rect;
            let at = self.focus().spot().expect("somewhere").rect;
            if at.intersect(goal).is_positive()
                && at.intersect(goal).area() > 0.5 * goal.area().min(at.area())
            {
                return;
            }
            let by = goal.center() - at.center();
            let apart = 0.6 * goal.height().min(at.height());
            let button = match (by.x > 0.0, by.y > 0.0) {
                (_, true) if by.y > apart => Button::DPadDown,
                (_, false) if -by.y > apart => Button::DPadUp,
                (true, _) => Button::DPadRight,
                (false, _) => Button::DPadLeft,
            };
            self.tap(button);
            self.wait(2);
        }
        panic!("the D-pad does not lead to {name}");
    }

    /// Moves the leading hand to a point of the world with the sticks, as one does who looks.
    pub fn aim(&mut self, at: Vec3) {
        let side = self.pad_hands().leading();
        for round in 0..4 {
            self.presses += 1;
            for _ in 0..400 {
                let hand = self.hand(side);
                let gap = self.seen(at) - self.seen(hand);
                let flat = gap.truncate() / self.seen(hand).z.max(0.1);
                if flat.length() < 4e-4 {
                    break;
                }
                self.stick(false, (flat * 12.0).clamp_length_max(1.0).map(firm));
                self.frame();
            }
            self.stick(false, Vec2::ZERO);
            self.wait(2);
            let hand = self.hand(side);
            if hand.distance(at) < 2e-3 {
                return;
            }
            assert!(round < 3, "{hand} is not {at}");
            self.down(Button::LeftTrigger2);
            for _ in 0..400 {
                let hand = self.hand(side);
                let gap = self.seen(at).z - self.seen(hand).z;
                if gap.abs() < 4e-4 {
                    break;
                }
                let push = firm((gap * 8.0).clamp(-1.0, 1.0));
                self.stick(false, Vec2::new(0.0, push));
                self.frame();
            }
            self.stick(false, Vec2::ZERO);
            self.frame();
            self.up(Button::LeftTrigger2);
        }
    }

    /// Points at an object: the surface gives the depth.
    pub fn point(&mut self, at: Vec3) {
        let side = self.pad_hands().leading();
        self.presses += 1;
        for _ in 0..400 {
            let hand = self.hand(side);
            let (to, from) = (self.seen(at), self.seen(hand));
            let gap = to.truncate() / to.z - from.truncate() / from.z;
            if gap.length() < 1e-3 {
                break;
            }
            self.stick(false, (gap * 12.0).clamp_length_max(1.0).map(firm));
            self.frame();
        }
        self.stick(false, Vec2::ZERO);
        self.wait(2);
    }

    /// Carries what the leading hand touches by so much.
    pub fn carry(&mut self, by: Vec3) {
        let side = self.pad_hands().leading();
        self.down(Button::RightTrigger);
        let from = self.hand(side);
        self.aim(from + by);
        self.up(Button::RightTrigger);
        self.wait(2);
    }
}

/// Beyond the dead zone, and finer near the middle.
fn firm(push: f32) -> f32 {
    push.signum() * (0.12 + 0.88 * push.abs().sqrt()).min(1.0) * f32::from(push != 0.0)
}

fn way(from: Keyboard, to: Key) -> Vec<Button> {
    let mut reached = vec![(from, Vec::new())];
    for i in 0.. {
        let (at, steps): (Keyboard, Vec<Button>) = reached[i].clone();
        if at.key() == to {
            return steps;
        }
        for (button, right, down) in [
            (Button::DPadUp, 0, -1),
            (Button::DPadRight, 1, 0),
            (Button::DPadDown, 0, 1),
            (Button::DPadLeft, -1, 0),
        ] {
            let mut next = at;
            next.step(right, down);
            if reached.iter().all(|(k, _)| *k != next) {
                let mut steps = steps.clone();
                steps.push(button);
                reached.push((next, steps));
            }
        }
    }
    unreachable!()
}

#[test]
fn start_opens_the_library_and_the_focus_is_in_it() {
    let mut desk = Desk::new();
    desk.plug();
    desk.tap(Button::Start);
    desk.wait(4);
    assert!(desk.is_open("library"));
    assert!(desk.focus().is_inside());
    let first = desk.focus().spot();
    desk.tap(Button::DPadDown);
    assert_ne!(desk.focus().spot(), first);
    desk.tap(Button::East);
    desk.wait(4);
    assert!(!desk.is_open("library"));
    assert!(!desk.focus().is_inside());
}

#[test]
fn a_component_is_found_by_typing_and_carried() {
    let mut desk = Desk::new();
    desk.plug();
    let first = desk.take_by_typing("Sphere");
    // What is typed the next time takes the place of it.
    let id = desk.take_by_typing("Cube");
    assert_ne!(first, id);
    let at = desk.document().object(id).unwrap().placement.translation;
    let hand = desk.hand(Side::Right);
    assert!(hand.distance(at) < 1e-4, "the hand is at it: {hand} {at}");
    desk.carry(Vec3::new(0.1, 0.2, 0.05));
    let now = desk.document().object(id).unwrap().placement.translation;
    assert!(
        now.distance(at + Vec3::new(0.1, 0.2, 0.05)) < 3e-3,
        "{at} {now}"
    );
    desk.tap(Button::West);
    let now = desk.document().object(id).unwrap().placement.translation;
    assert!(now.distance(at) < 1e-6, "X undoes");
    assert_eq!(desk.warnings(), [] as [String; 0]);
}

#[test]
fn both_hands_scale_after_a_swap_and_a_pulled_plug_drops_nothing() {
    let mut desk = Desk::new();
    desk.plug();
    let id = desk.take("Cube");
    let before = desk.document().object(id).unwrap().placement;
    desk.push(false, Vec2::new(-1.0, 0.0), 6);
    desk.down(Button::RightTrigger);
    desk.tap(Button::North);
    assert_eq!(desk.pad_hands().leading(), Side::Left);
    assert!(desk.pad_hands().is_latched(Side::Right));
    // The button that was down all the time takes hold with the other hand once it is pressed anew.
    desk.up(Button::RightTrigger);
    desk.push(false, Vec2::new(1.0, 0.0), 12);
    assert_eq!(desk.touched(Side::Left), Some(id));
    desk.down(Button::RightTrigger);
    desk.push(false, Vec2::new(1.0, 0.0), 12);
    desk.up(Button::RightTrigger);
    // The other hand still holds it.
    assert!(desk.pad_hands().is_latched(Side::Right));
    let shown = {
        let map = desk.world().resource::<midair_studio::show::Drafts>();
        *map.get(id).expect("held")
    };
    assert!(shown.scale.x > 1.05 * before.scale.x, "{}", shown.scale);
    desk.unplug();
    desk.wait(2);
    let after = desk.document().object(id).unwrap().placement;
    assert!(after.translation.distance(shown.translation) < 1e-4);
    assert!(
        after.scale.distance(shown.scale) < 1e-4,
        "{} {}",
        after.scale,
        shown.scale
    );
    assert!(!desk.pad_hands().holds());
    assert_eq!(desk.warnings().len(), 1, "{:?}", desk.warnings());
    assert!(desk.warnings()[0].contains("not connected"));
    // It comes back and goes on.
    desk.plug();
    desk.tap(Button::West);
    let undone = desk.document().object(id).unwrap().placement;
    assert_eq!(undone, before);
}

#[test]
fn undo_repeats_while_it_is_held() {
    let mut desk = Desk::new();
    desk.plug();
    desk.take("Cube");
    for _ in 0..6 {
        desk.carry(Vec3::new(0.05, 0.0, 0.0));
    }
    let steps = |d: &Desk| {
        let project = d.world().resource::<midair_studio::project::Project>();
        project.history().undo_len()
    };
    assert_eq!(steps(&desk), 7);
    desk.down(Button::West);
    assert_eq!(steps(&desk), 6);
    desk.wait(85);
    desk.up(Button::West);
    assert!(steps(&desk) <= 2, "{}", steps(&desk));
    // With LB it is redo.
    let left = steps(&desk);
    desk.down(Button::LeftTrigger);
    desk.tap(Button::West);
    desk.up(Button::LeftTrigger);
    assert_eq!(steps(&desk), left + 1);
}

#[test]
fn the_ring_of_modes_is_held_open_and_chooses_when_let_go() {
    let elsewhere = midair_studio::tools::ToolId::new("test/elsewhere");
    let mut desk = Desk::with(|app| {
        use midair_studio::tools::{AddTool, Tool, ToolId};
        app.add_tool(Tool {
            id: ToolId::new("test/elsewhere"),
            name: "Elsewhere",
            about: "Nothing",
            order: 90,
        });
    });
    let mode = |d: &Desk| {
        let tools = d.world().resource::<midair_studio::tools::Tools>();
        tools.active().unwrap().id.clone()
    };
    let first = mode(&desk);
    assert_ne!(first, elsewhere);
    desk.plug();
    // Held, it opens the ring and not the library; of five modes the last is to the left and above.
    desk.down(Button::Start);
    desk.wait(45);
    let hand = desk.hand(Side::Right);
    desk.stick(false, Vec2::new(-0.95, 0.31));
    desk.wait(3);
    desk.up(Button::Start);
    desk.stick(false, Vec2::ZERO);
    desk.wait(2);
    assert_eq!(mode(&desk), elsewhere);
    assert!(!desk.is_open("library"));
    assert!(
        desk.hand(Side::Right).distance(hand) < 1e-4,
        "the stick was the ring's"
    );
    // By keyboard: Q and an arrow.
    use bevy::input::keyboard::{Key, NativeKey};
    let unnamed = Key::Unidentified(NativeKey::Unidentified);
    desk.key(KeyCode::KeyQ, unnamed.clone(), true);
    desk.wait(3);
    desk.strike_one(KeyCode::ArrowUp);
    desk.key(KeyCode::KeyQ, unnamed, false);
    desk.wait(3);
    assert_eq!(mode(&desk), first);
}

#[test]
fn the_sticks_turn_the_view_about_the_hand_and_the_hand_in_depth() {
    let mut desk = Desk::new();
    desk.plug();
    let id = desk.take("Cube");
    let hand = desk.hand(Side::Right);
    let before = desk.seen(hand);
    desk.push(true, Vec2::new(0.8, 0.3), 30);
    let after = desk.seen(hand);
    assert!(desk.hand(Side::Right).distance(hand) < 1e-4);
    assert!(
        before.distance(after) < 2e-3,
        "it stays on its place: {before} {after}"
    );
    // With LT the held thing goes away and turns.
    desk.down(Button::RightTrigger);
    let hand = desk.hand(Side::Right);
    let near = desk.seen(hand).z;
    desk.down(Button::LeftTrigger2);
    desk.push(false, Vec2::Y, 20);
    desk.push(true, Vec2::X, 30);
    desk.up(Button::LeftTrigger2);
    desk.up(Button::RightTrigger);
    desk.wait(2);
    let placed = desk.document().object(id).unwrap().placement;
    let far = desk.seen(desk.hand(Side::Right)).z;
    assert!(far > near + 0.05, "{near} {far}");
    let turned = placed.rotation.angle_between(Quat::IDENTITY);
    assert!((0.3..1.2).contains(&turned), "{turned}");
    // Y held shows the work, pressed twice the right stick deletes.
    desk.down(Button::RightThumb);
    desk.up(Button::RightThumb);
    desk.down(Button::RightThumb);
    desk.up(Button::RightThumb);
    desk.wait(2);
    assert_eq!(desk.document().len(), 0);
}

#[test]
fn a_click_is_where_the_mouse_is_however_slowly_it_went_there() {
    // With the click alone in its frame, and with a move after it in the same one.
    for goes_on in [false, true] {
        let mut desk = Desk::new();
        let cube = desk.thing("solid/cube");
        desk.wait(3);
        let at = desk.hover(cube);
        let from = at + Vec2::new(0.0, -250.0);
        desk.glide(from);
        desk.click();
        assert_eq!(desk.selected(), []);
        desk.plug();
        desk.tap(Button::DPadUp);
        assert!(desk.pad_hands().leads());
        // A mouse that moves so slowly trembles on the table.
        for i in 1..=125 {
            desk.cursor(from.lerp(at, i as f32 / 125.0));
            desk.frame();
        }
        assert!(desk.pad_hands().leads());
        desk.mouse(MouseButton::Left, true);
        if goes_on {
            desk.cursor(at + Vec2::X);
        }
        desk.wait(4);
        assert!(!desk.pad_hands().leads());
        desk.mouse(MouseButton::Left, false);
        desk.wait(3);
        assert_eq!(desk.selected(), [cube], "{goes_on}");
    }
}
