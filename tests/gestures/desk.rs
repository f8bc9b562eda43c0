//! The whole app as in its window, driven by messages of devices alone.

use std::time::{Duration, Instant};

use bevy::input::ButtonState;
use bevy::input::gamepad::{
    GamepadAxis, GamepadButton, GamepadConnection, GamepadConnectionEvent,
    RawGamepadAxisChangedEvent, RawGamepadButtonChangedEvent, RawGamepadEvent,
};
use bevy::input::keyboard::{Key, KeyboardInput, NativeKey};
use bevy::input::mouse::MouseButtonInput;
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy::window::{PrimaryWindow, WindowEvent, WindowResized};
use midair::{Stage, app};
use midair_document::{Document, ObjectId};
use midair_flatscreen::focus::Focus;
use midair_flatscreen::{Orbit, Pad};
use midair_studio::command::Errands;
use midair_studio::evaluate::Evaluations;
use midair_studio::hands::{Hands, Side};
use midair_studio::notice::Notices;
use midair_studio::panel::Panels;
use midair_studio::pick::Touch;
use midair_studio::project::{Begin, Places, Project};

/// The time of a frame.
pub const FRAME: Duration = Duration::from_nanos(11_111_111);

pub struct Desk {
    pub app: App,
    pub home: tempfile::TempDir,
    pad: Entity,
    window: Entity,
    /// Presses of buttons and keys, and pushes of sticks.
    pub presses: usize,
    pub frames: usize,
}

impl Desk {
    /// An empty document, no device connected.
    pub fn new() -> Self {
        Self::with(|_| {})
    }

    /// The same, with a file of the user's or a plugin put there first.
    pub fn with(prepare: impl FnOnce(&mut App)) -> Self {
        Self::at_home(tempfile::tempdir().unwrap(), prepare)
    }

    pub fn at_home(home: tempfile::TempDir, prepare: impl FnOnce(&mut App)) -> Self {
        let mut app = app(Stage::Unseen, Places::below(home.path()), Begin::default());
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        prepare(&mut app);
        app.finish();
        app.cleanup();
        let pad = app.world_mut().spawn_empty().id();
        let window = {
            let world = app.world_mut();
            let mut windows = world.query_filtered::<Entity, With<PrimaryWindow>>();
            windows.single(world).unwrap()
        };
        let mut desk = Self {
            app,
            home,
            pad,
            window,
            presses: 0,
            frames: 0,
        };
        desk.wait(3);
        desk
    }

    pub fn world(&self) -> &World {
        self.app.world()
    }

    pub fn window_entity(&self) -> Entity {
        self.window
    }

    pub fn document(&self) -> &Document {
        self.world().resource::<Project>().document()
    }

    pub fn warnings(&self) -> &[String] {
        self.world().resource::<Notices>().warnings()
    }

    pub fn focus(&self) -> &Focus {
        self.world().resource::<Focus>()
    }

    pub fn pad_hands(&self) -> &Pad {
        self.world().resource::<Pad>()
    }

    pub fn hand(&self, side: Side) -> Vec3 {
        self.world().resource::<Hands>().get(side).pose.position
    }

    pub fn touched(&self, side: Side) -> Option<ObjectId> {
        self.world().resource::<Touch>().get(side).map(|t| t.object)
    }

    pub fn is_open(&self, panel: &str) -> bool {
        self.world().resource::<Panels>().is_open(panel)
    }

    pub fn seconds(&self) -> f32 {
        self.frames as f32 * FRAME.as_secs_f32()
    }

    /// One frame; the document is sound after it.
    pub fn frame(&mut self) {
        self.app.update();
        self.frames += 1;
        let faults = self.document().check();
        assert!(faults.is_empty(), "{faults:?}");
    }

    pub fn wait(&mut self, frames: usize) {
        for _ in 0..frames {
            self.frame();
        }
    }

    /// Frames until nothing is on its way.
    pub fn settle(&mut self) {
        let since = Instant::now();
        let mut quiet = 0;
        while quiet < 4 {
            self.frame();
            let world = self.world();
            let busy = world.resource::<Evaluations>().progress().next().is_some()
                || !world.resource::<Errands>().is_empty();
            quiet = if busy { 0 } else { quiet + 1 };
            if busy {
                std::thread::sleep(Duration::from_millis(2));
            }
            assert!(since.elapsed() < Duration::from_secs(120), "never done");
        }
    }

    pub fn plug(&mut self) {
        let connected = GamepadConnection::Connected {
            name: "pad".to_owned(),
            vendor_id: None,
            product_id: None,
        };
        self.connection(connected);
        self.open_eyes();
    }

    pub fn unplug(&mut self) {
        self.connection(GamepadConnection::Disconnected);
    }

    fn connection(&mut self, connection: GamepadConnection) {
        let event = GamepadConnectionEvent {
            gamepad: self.pad,
            connection,
        };
        self.app
            .world_mut()
            .write_message(RawGamepadEvent::Connection(event.clone()));
        self.app.world_mut().write_message(event);
        self.wait(2);
    }

    pub fn down(&mut self, button: GamepadButton) {
        self.presses += 1;
        self.button(button, 1.0);
        self.frame();
    }

    pub fn up(&mut self, button: GamepadButton) {
        self.button(button, 0.0);
        self.frame();
    }

    pub fn button(&mut self, button: GamepadButton, value: f32) {
        let gamepad = self.pad;
        let event = RawGamepadButtonChangedEvent::new(gamepad, button, value);
        self.app
            .world_mut()
            .write_message(RawGamepadEvent::Button(event));
    }

    /// Down for a tenth of a second, and up for as long.
    pub fn tap(&mut self, button: GamepadButton) {
        self.down(button);
        self.wait(8);
        self.up(button);
        self.wait(8);
    }

    pub fn stick(&mut self, right: bool, to: Vec2) {
        let (x, y) = if right {
            (GamepadAxis::RightStickX, GamepadAxis::RightStickY)
        } else {
            (GamepadAxis::LeftStickX, GamepadAxis::LeftStickY)
        };
        for (axis, value) in [(x, to.x), (y, to.y)] {
            let event = RawGamepadAxisChangedEvent::new(self.pad, axis, value);
            self.app
                .world_mut()
                .write_message(RawGamepadEvent::Axis(event));
        }
    }

    /// A stick pushed for some frames, then let go.
    pub fn push(&mut self, right: bool, to: Vec2, frames: usize) {
        self.presses += 1;
        self.stick(right, to);
        self.wait(frames);
        self.stick(right, Vec2::ZERO);
        self.frame();
    }

    pub fn key(&mut self, key_code: KeyCode, logical: Key, down: bool) {
        let window = self.window;
        let text = match &logical {
            Key::Character(c) if down => Some(c.clone()),
            _ => None,
        };
        let input = KeyboardInput {
            key_code,
            logical_key: logical,
            state: if down {
                ButtonState::Pressed
            } else {
                ButtonState::Released
            },
            text,
            repeat: false,
            window,
        };
        let world = self.app.world_mut();
        world.write_message(WindowEvent::KeyboardInput(input.clone()));
        world.write_message(input);
    }

    /// Keys down one after the other, and up again.
    pub fn strike(&mut self, keys: &[(KeyCode, Key)]) {
        self.presses += 1;
        for (code, logical) in keys {
            self.key(*code, logical.clone(), true);
            self.frame();
        }
        self.wait(2);
        for (code, logical) in keys.iter().rev() {
            self.key(*code, logical.clone(), false);
            self.frame();
        }
        self.wait(2);
    }

    /// One key without a name of its own.
    pub fn strike_one(&mut self, code: KeyCode) {
        let logical = match code {
            KeyCode::Tab => Key::Tab,
            KeyCode::F1 => Key::F1,
            KeyCode::F3 => Key::F3,
            KeyCode::F6 => Key::F6,
            KeyCode::Escape => Key::Escape,
            KeyCode::Enter => Key::Enter,
            KeyCode::ArrowDown => Key::ArrowDown,
            KeyCode::ArrowUp => Key::ArrowUp,
            KeyCode::ArrowLeft => Key::ArrowLeft,
            KeyCode::ArrowRight => Key::ArrowRight,
            _ => Key::Unidentified(NativeKey::Unidentified),
        };
        self.strike(&[(code, logical)]);
    }

    /// The pointer is there, in pixels of the window.
    pub fn cursor(&mut self, to: Vec2) {
        let window = self.window;
        let world = self.app.world_mut();
        let mut shown = world.get_mut::<Window>(window).unwrap();
        let before = shown.cursor_position();
        shown.set_cursor_position(Some(to));
        let moved = CursorMoved {
            window,
            position: to,
            delta: before.map(|b| to - b),
        };
        // Panels and buttons read the window's own stream of events.
        world.write_message(WindowEvent::CursorMoved(moved.clone()));
        world.write_message(moved);
    }

    /// The pointer is nowhere, or at no place that is one.
    pub fn leave(&mut self, to: Option<Vec2>) {
        let window = self.window;
        let world = self.app.world_mut();
        let mut shown = world.get_mut::<Window>(window).unwrap();
        shown.set_cursor_position(to);
        if let Some(position) = to {
            let moved = CursorMoved {
                window,
                position,
                delta: Some(position),
            };
            world.write_message(WindowEvent::CursorMoved(moved.clone()));
            world.write_message(moved);
        }
    }

    /// The window has another size.
    pub fn resize(&mut self, width: f32, height: f32) {
        let window = self.window;
        let world = self.app.world_mut();
        let mut shown = world.get_mut::<Window>(window).unwrap();
        shown.resolution.set(width, height);
        world.write_message(WindowResized {
            window,
            width,
            height,
        });
    }

    pub fn mouse(&mut self, button: MouseButton, down: bool) {
        let window = self.window;
        let input = MouseButtonInput {
            button,
            state: if down {
                ButtonState::Pressed
            } else {
                ButtonState::Released
            },
            window,
        };
        let world = self.app.world_mut();
        world.write_message(WindowEvent::MouseButtonInput(input));
        world.write_message(input);
    }

    /// Where a point of the world is seen, in metres right and up of the middle and in front of the eye.
    pub fn seen(&mut self, at: Vec3) -> Vec3 {
        let world = self.app.world_mut();
        let mut eyes = world.query_filtered::<&Transform, With<Orbit>>();
        let eye = *eyes.single(world).unwrap();
        let from = at - eye.translation;
        Vec3::new(
            from.dot(*eye.right()),
            from.dot(*eye.up()),
            from.dot(*eye.forward()),
        )
    }
}
