//! Everything by keyboard alone.

use std::collections::HashSet;

use bevy::input::keyboard::{Key, NativeKey};
use bevy::prelude::*;
use midair_flatscreen::bindings::{Binding, Bindings, Control, Device};
use midair_studio::panel::egui::Id;
use midair_studio::panel::{Dock, Panels};
use midair_studio::project::Project;
use midair_studio::settings::Settings;

use crate::desk::Desk;

const PLAIN: Key = Key::Unidentified(NativeKey::Unidentified);

impl Desk {
    fn panel(&mut self, id: &str, open: bool) {
        let mut panels = self.app.world_mut().resource_mut::<Panels>();
        panels.set_open(id, open);
        self.wait(3);
    }

    /// Walks with Tab until nothing new comes; what had the focus on the way.
    fn walk(&mut self) -> HashSet<Id> {
        let mut seen = HashSet::new();
        let mut stale = 0;
        while stale < 12 {
            self.key(KeyCode::Tab, Key::Tab, true);
            self.frame();
            self.key(KeyCode::Tab, Key::Tab, false);
            self.wait(2);
            let fresh = self.focus().spot().is_some_and(|s| seen.insert(s.id));
            stale = if fresh { 0 } else { stale + 1 };
        }
        seen
    }
}

#[test]
fn the_focus_reaches_every_widget_of_every_panel() {
    let mut desk = Desk::new();
    let panels: Vec<_> = desk.world().resource::<Panels>().all().to_vec();
    assert!(panels.iter().any(|p| p.id == "library"));
    for info in &panels {
        for other in &panels {
            desk.panel(other.id, other.id == info.id);
        }
        desk.strike_one(KeyCode::F6);
        assert!(desk.focus().is_inside(), "F6 goes into {}", info.id);
        let names: Vec<_> = desk.focus().regions().iter().map(|r| r.name).collect();
        let drawn = desk.focus().regions().iter().find(|r| r.name == info.id);
        // A panel that has nothing to press at the moment has nothing to reach.
        let Some(region) = drawn else {
            assert_ne!(info.id, "library", "{names:?}");
            continue;
        };
        let mut wanted: HashSet<_> = region.spots.iter().map(|s| s.id).collect();
        if info.dock != Dock::Modal {
            let bar = desk.focus().regions().iter().find(|r| r.name == "bar");
            wanted.extend(bar.expect("the bar").spots.iter().map(|s| s.id));
        }
        let seen = desk.walk();
        let missed: Vec<_> = wanted.difference(&seen).collect();
        let spots: Vec<_> = desk
            .focus()
            .regions()
            .iter()
            .flat_map(|r| &r.spots)
            .filter(|s| missed.contains(&&s.id))
            .collect();
        assert!(spots.is_empty(), "{}: not reached: {spots:?}", info.id);
        println!("{}: {} widgets", info.id, wanted.len());
        desk.strike_one(KeyCode::Escape);
    }
}

#[test]
fn f6_goes_round_and_escape_leaves_and_tab_stays_the_hands() {
    let mut desk = Desk::new();
    let leading = |d: &Desk| d.world().resource::<midair_flatscreen::Pointer>().leading;
    let before = leading(&desk);
    desk.strike_one(KeyCode::Tab);
    assert_ne!(leading(&desk), before, "Tab swaps the hands");
    desk.strike_one(KeyCode::F6);
    let first = desk.focus().spot().expect("in the panels");
    let now = leading(&desk);
    desk.strike_one(KeyCode::Tab);
    assert_eq!(leading(&desk), now, "in a panel it does not");
    assert_ne!(desk.focus().spot(), Some(first));
    desk.strike_one(KeyCode::Escape);
    assert!(!desk.focus().is_inside());
}

/// A frame that takes long has all of a quick Ctrl+Z in it but the first key: it must not become Z.
#[test]
fn a_chord_that_ends_within_one_frame_is_still_a_chord() {
    let mut desk = Desk::new();
    let first = desk.thing("solid/cube");
    desk.wait(3);
    desk.key(KeyCode::ControlLeft, Key::Control, true);
    desk.frame();
    for (code, down) in [(KeyCode::KeyZ, true), (KeyCode::KeyZ, false)] {
        desk.key(code, PLAIN, down);
    }
    desk.key(KeyCode::ControlLeft, Key::Control, false);
    desk.wait(3);
    let document = desk.world().resource::<Project>().document();
    assert!(document.object(first).is_none(), "undone");
    // What comes after the modifier is up is no chord.
    let second = desk.thing("solid/cube");
    desk.key(KeyCode::ControlLeft, Key::Control, true);
    desk.frame();
    desk.key(KeyCode::ControlLeft, Key::Control, false);
    for (code, down) in [(KeyCode::KeyZ, true), (KeyCode::KeyZ, false)] {
        desk.key(code, PLAIN, down);
    }
    desk.wait(3);
    let document = desk.world().resource::<Project>().document();
    assert!(document.object(second).is_some());
}

#[test]
fn escape_shuts_the_window_over_the_view_where_it_means_nothing_else() {
    let mut desk = Desk::new();
    let open = |d: &Desk| d.world().resource::<Panels>().is_open("help");
    let measures = |d: &Desk| d.world().resource::<midair_studio::ruler::Ruler>().on;
    desk.strike_one(KeyCode::F1);
    assert!(open(&desk));
    desk.strike_one(KeyCode::KeyK);
    assert!(measures(&desk));
    desk.strike_one(KeyCode::Escape);
    assert!(!measures(&desk) && open(&desk), "first what one is at");
    desk.strike_one(KeyCode::Escape);
    assert!(!open(&desk));
    desk.panel("library", true);
    desk.strike_one(KeyCode::Escape);
    assert!(desk.world().resource::<Panels>().is_open("library"));
}

#[test]
fn a_menu_is_opened_and_used_by_keys() {
    let mut desk = Desk::new();
    desk.panel("library", true);
    desk.strike_one(KeyCode::F6);
    for _ in 0..4 {
        if desk.focus().region().is_some_and(|r| r.name == "bar") {
            break;
        }
        desk.strike_one(KeyCode::F6);
    }
    for _ in 0..12 {
        if desk.focus().label().contains("File") {
            break;
        }
        desk.strike_one(KeyCode::ArrowLeft);
    }
    assert!(
        desk.focus().label().contains("File"),
        "{}",
        desk.focus().label()
    );
    desk.strike_one(KeyCode::Enter);
    desk.wait(3);
    assert_eq!(desk.focus().region().map(|r| r.name), Some("popup"));
    let first = desk.focus().spot();
    desk.strike_one(KeyCode::ArrowDown);
    assert_ne!(desk.focus().spot(), first);
    assert_eq!(desk.focus().region().map(|r| r.name), Some("popup"));
    desk.strike_one(KeyCode::Escape);
    desk.wait(3);
    assert_ne!(desk.focus().region().map(|r| r.name), Some("popup"));
}

#[test]
fn a_key_is_bound_anew_by_pressing_it_and_kept() {
    let mut desk = Desk::new();
    desk.strike_one(KeyCode::F3);
    assert!(desk.is_open("controls"));
    desk.strike_one(KeyCode::F6);
    for _ in 0..6 {
        if desk.focus().region().is_some_and(|r| r.name == "controls") {
            break;
        }
        desk.strike_one(KeyCode::F6);
    }
    // To the button that has the keys of "Undo".
    let seen = (0..400).any(|_| {
        desk.strike_one(KeyCode::Tab);
        desk.focus().label() == "Ctrl+Z"
    });
    assert!(seen, "the list shows Ctrl+Z");
    desk.strike_one(KeyCode::Enter);
    desk.wait(2);
    desk.strike_one(KeyCode::KeyF);
    desk.wait(4);
    let bindings = desk.world().resource::<Bindings>().clone();
    assert_eq!(bindings.of(Control::Undo)[0], Binding::parse("F").unwrap());
    assert_eq!(bindings.label(Control::Undo, Device::Keys), "F");
    assert_eq!(
        bindings.conflicts(Control::Undo)[0].0,
        Control::FrameSelection
    );
    // It is in the user's file, and in the next run.
    let file = midair_studio::project::Places::below(desk.home.path())
        .library
        .config()
        .join("bindings.ron");
    let since = std::time::Instant::now();
    while !file.exists() && since.elapsed().as_secs() < 20 {
        std::thread::sleep(std::time::Duration::from_millis(20));
        desk.frame();
    }
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(text.contains("undo: [\"F\", \"Pad X\"]"), "{text}");
    let Desk { app, home, .. } = desk;
    drop(app);
    let again = Desk::at_home(home, |_| {});
    assert_eq!(*again.world().resource::<Bindings>(), bindings);
}

#[test]
fn a_file_of_bindings_with_a_mistake_is_one_line_and_costs_only_that_line() {
    let home = tempfile::tempdir().unwrap();
    let folder = midair_studio::project::Places::below(home.path())
        .library
        .config()
        .to_path_buf();
    std::fs::create_dir_all(&folder).unwrap();
    let text = "(\n    undo: [\"Ctrl+U\"],\n    redo: [\"Ctrl+Quux\"],\n)\n";
    std::fs::write(folder.join("bindings.ron"), text).unwrap();
    let desk = Desk::at_home(home, |_| {});
    let bindings = desk.world().resource::<Bindings>();
    assert_eq!(bindings.label(Control::Undo, Device::Keys), "Ctrl+U");
    assert_eq!(bindings.label(Control::Redo, Device::Keys), "Ctrl+Shift+Z");
    let [line] = desk.warnings() else {
        panic!("{:?}", desk.warnings());
    };
    for part in ["bindings.ron", "line 3", "Ctrl+Quux", "Controls"] {
        assert!(line.contains(part), "{part}: {line}");
    }
    assert!(!line.contains('\n'));
}

#[test]
fn the_left_handed_switch_mirrors_the_hands() {
    let mut desk = Desk::new();
    let command = Settings::command("hands.left_handed", true);
    desk.app.world_mut().write_message(command);
    desk.plug();
    desk.wait(2);
    use bevy::input::gamepad::GamepadButton as Button;
    use midair_studio::hands::Side;
    let id = desk.take("Cube");
    assert_eq!(desk.pad_hands().leading(), Side::Left);
    assert_eq!(desk.touched(Side::Left), Some(id));
    // The right stick moves the hand now.
    let before = desk.hand(Side::Left);
    desk.push(false, Vec2::X, 10);
    assert!(desk.hand(Side::Left).distance(before) < 1e-4);
    desk.push(true, Vec2::X, 10);
    assert!(desk.hand(Side::Left).distance(before) > 1e-2);
    desk.push(true, Vec2::NEG_X, 10);
    // Save is the right hand's.
    desk.tap(Button::Select);
    desk.settle();
    assert_eq!(desk.warnings(), [] as [String; 0]);
    let work = midair_studio::project::Places::below(desk.home.path()).work;
    assert_eq!(std::fs::read_dir(work).unwrap().count(), 1);
}

#[test]
fn the_arrows_reach_what_a_long_list_does_not_show() {
    let mut desk = Desk::new();
    desk.plug();
    desk.take("Cube");
    for name in ["Sphere", "Cone"] {
        desk.take(name);
    }
    let press = |desk: &mut Desk, code: KeyCode, letter: &str| {
        let control = (KeyCode::ControlLeft, Key::Control);
        desk.strike(&[control, (code, Key::Character(letter.into()))]);
    };
    for _ in 0..4 {
        press(&mut desk, KeyCode::KeyA, "a");
        press(&mut desk, KeyCode::KeyD, "d");
    }
    let objects = desk.document().len();
    assert!(objects >= 40, "{objects}");
    desk.panel("library", false);
    desk.panel("outline", true);
    for _ in 0..6 {
        desk.strike_one(KeyCode::F6);
        if desk.focus().region().is_some_and(|r| r.name == "outline") {
            break;
        }
    }
    let mut seen = HashSet::new();
    for _ in 0..objects + 20 {
        desk.strike_one(KeyCode::ArrowDown);
        seen.extend(desk.focus().spot().map(|s| s.id));
    }
    assert_eq!(desk.focus().region().map(|r| r.name), Some("outline"));
    assert!(seen.len() >= objects, "{} of {objects}", seen.len());
}

impl Desk {
    pub fn mode(&self) -> String {
        let tools = self.world().resource::<midair_studio::tools::Tools>();
        tools.active().unwrap().id.as_str().to_owned()
    }
}

/// The four modes, by the keys that take them and by what the arrow upwards changes in them.
const MODES: [(KeyCode, &str, &str); 4] = [
    (KeyCode::Digit1, "csg", ""),
    (KeyCode::Digit2, "scaffold", "scaffold.draws"),
    (KeyCode::Digit3, "sweep", "sweep.shape"),
    (KeyCode::Digit4, "brush", "brush.radius"),
];

#[test]
fn every_mode_is_taken_and_worked_by_keys_and_has_its_panel_in_the_bar() {
    let mut desk = Desk::new();
    desk.open_eyes();
    let panels: Vec<_> = desk.world().resource::<Panels>().all().to_vec();
    for (key, id, changes) in MODES {
        desk.strike_one(key);
        desk.wait(3);
        assert_eq!(desk.mode(), id);
        for other in &panels {
            desk.panel(other.id, other.id == id);
        }
        // One line, and of the modes' panels only this one's.
        let bar = desk.focus().regions().iter().find(|r| r.name == "bar");
        let heights: Vec<_> = bar
            .unwrap()
            .spots
            .iter()
            .map(|s| s.rect.center().y)
            .collect();
        let low = heights.iter().copied().fold(f32::INFINITY, f32::min);
        let high = heights.iter().copied().fold(0.0, f32::max);
        assert!(high - low < 4.0, "{id}: the bar has one line: {heights:?}");
        let named = |desk: &mut Desk, name: &str| {
            let seen = desk.screen().into_iter();
            let bar = seen.filter(|s| s.rect.center().y < high + 10.0);
            bar.filter(|s| s.name().eq_ignore_ascii_case(name)).count()
        };
        for (_, other, _) in &MODES[1..] {
            let count = if *other == id { 2 } else { 1 };
            assert_eq!(named(&mut desk, other), count, "{other} in {id}");
        }
        // Its cross is on the arrows.
        if !changes.is_empty() {
            let value = |d: &Desk| {
                let all = serde_json::to_value(d.world().resource::<Settings>()).unwrap();
                let (part, name) = changes.split_once('.').unwrap();
                all[part][name].clone()
            };
            let before = value(&desk);
            desk.strike_one(KeyCode::ArrowUp);
            desk.wait(3);
            assert_ne!(value(&desk), before, "{id}: the arrow changes {changes}");
            // And every widget of its panel is reached.
            desk.strike_one(KeyCode::F6);
            let region = desk.focus().regions().iter().find(|r| r.name == id);
            let wanted: HashSet<_> = region.unwrap().spots.iter().map(|s| s.id).collect();
            let seen = desk.walk();
            assert!(wanted.is_subset(&seen), "{id}: everything is reached");
            desk.strike_one(KeyCode::Escape);
        }
    }
}

#[test]
fn everything_that_is_not_a_gamepads_alone_has_a_key() {
    let desk = Desk::new();
    let bindings = desk.world().resource::<Bindings>();
    // Sticks and what goes with them; the keyboard on the screen, which a keyboard needs least; and what a key does
    // by another name: delete, the library, the focus in panels.
    let pads = [
        "stick",
        "Stick",
        "Deep",
        "Roam",
        "Type",
        "Centre",
        "Menu",
        "Alt",
        "PanelUp",
        "PanelRight",
        "PanelDown",
        "PanelLeft",
        "PanelPress",
    ];
    for &control in Control::ALL {
        let name = format!("{control:?}");
        if pads.iter().any(|p| name.contains(p)) {
            continue;
        }
        assert!(
            !bindings.label(control, Device::Keys).is_empty(),
            "{name} has no key"
        );
    }
}
