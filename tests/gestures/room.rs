//! Panels in a room, clicked by wands: the whole studio as somebody in a headset has it, without one.

use bevy::prelude::*;
use midair::wear;
use midair_playback::{PlayOptions, PlayerPlugin, RecorderPlugin, Session, play};
use midair_space::{BoardId, Boards, Stance, Wands};
use midair_studio::command::{Command, Dialog};
use midair_studio::hands::{Action, Hands, Pose, Side};
use midair_studio::panel::Panels;
use midair_studio::project::{Begin, Places, Project};
use midair_studio::settings::Settings;
use midair_studio::world::WorldView;

use crate::studio::{Studio, near};

const WRIST: BoardId = BoardId::Wrist;
const LIBRARY: BoardId = BoardId::Panel("library");

/// Somebody stands there, hands held before the body.
fn worn() -> Studio {
    standing(Studio::with(wear))
}

fn standing(mut studio: Studio) -> Studio {
    studio.input().head = Some(Pose {
        position: Vec3::new(0.0, 1.6, 0.5),
        rotation: Quat::from_rotation_x(-0.35),
    });
    studio.put(Side::Left, Pose::at(Vec3::new(-0.22, 1.15, 0.1)));
    studio.put(Side::Right, Pose::at(Vec3::new(0.25, 1.15, 0.1)));
    studio.frames(12);
    studio
}

fn boards(studio: &Studio) -> &Boards {
    studio.world().resource::<Boards>()
}

fn is_open(studio: &Studio, panel: &str) -> bool {
    studio.world().resource::<Panels>().is_open(panel)
}

/// The right wand points at a text on a board, from in front of it.
fn aim(studio: &mut Studio, id: BoardId, text: &str) {
    let board = boards(studio)
        .get(id)
        .unwrap_or_else(|| panic!("{id:?} is not open"));
    let at = board
        .find(text)
        .unwrap_or_else(|| panic!("{id:?} has no \"{text}\""));
    let front = board.pose.rotation * Vec3::Z;
    aim_at(studio, board.at(at), front);
}

fn aim_at(studio: &mut Studio, point: Vec3, front: Vec3) {
    let world = studio.world().resource::<WorldView>().world_from_room();
    let from = point + 0.3 * front + Vec3::new(0.02, -0.06, 0.0);
    let pose = Transform::from_translation(from).looking_at(point, Vec3::Y);
    let pose = Pose {
        position: pose.translation,
        rotation: pose.rotation,
    };
    studio.put(Side::Right, world.pose(&pose));
    studio.frames(3);
}

fn trigger(studio: &mut Studio) {
    studio.press(Side::Right, Action::Act);
    studio.frames(4);
    studio.let_go(Side::Right, Action::Act);
    studio.frames(6);
}

fn click(studio: &mut Studio, id: BoardId, text: &str) {
    aim(studio, id, text);
    trigger(studio);
}

#[test]
fn the_wrist_opens_the_library_and_a_shape_that_is_picked_appears_in_the_hand() {
    let mut studio = worn();
    assert!(boards(&studio).get(WRIST).unwrap().shown);
    let button = library_button(&studio);
    click(&mut studio, WRIST, &button);
    assert!(is_open(&studio, "library"));
    let eyes = studio.world().resource::<Stance>().head.position;
    let board = boards(&studio).get(LIBRARY).unwrap();
    let away = board.pose.position.distance(eyes);
    assert!((0.5..=0.7).contains(&away), "{away} m from the eyes");
    studio.frames(30);
    click(&mut studio, LIBRARY, "Sphere");
    let id = studio.only();
    let hand = studio.pose(Side::Right).position;
    near(studio.placement(id).translation, hand, 1e-4);
    assert!(studio.warnings().is_empty(), "{:?}", studio.warnings());
}

/// The library's button on the wrist, as it is written there.
fn library_button(studio: &Studio) -> String {
    let panels = studio.world().resource::<Panels>();
    let info = panels.all().iter().find(|i| i.id == "library").unwrap();
    format!("{} {}", info.icon, info.title)
}

#[test]
fn a_press_on_a_panel_is_no_press_for_the_tool_and_a_press_in_the_scene_is_none_on_a_panel() {
    let mut studio = worn();
    let button = library_button(&studio);
    aim(&mut studio, WRIST, &button);
    assert!(
        studio
            .world()
            .resource::<Wands>()
            .get(Side::Right)
            .met
            .is_some()
    );
    studio.input().side(Side::Right).swipe = Some(Vec2::Y);
    studio.press(Side::Right, Action::Act);
    let hand = studio.world().resource::<Hands>().get(Side::Right);
    assert!(!hand.held(Action::Act) && hand.swipe.is_none());
    // It stays the panel's until it is let go, wherever the hand is.
    studio.put(Side::Right, Pose::at(Vec3::new(0.4, 1.0, 0.0)));
    studio.frame();
    assert!(
        !studio
            .world()
            .resource::<Hands>()
            .get(Side::Right)
            .held(Action::Act)
    );
    studio.let_go(Side::Right, Action::Act);
    studio.frames(2);
    assert!(
        !is_open(&studio, "library"),
        "a press that is dragged away clicks nothing"
    );

    // The other way round.
    studio.press(Side::Right, Action::Act);
    assert!(
        studio
            .world()
            .resource::<Hands>()
            .get(Side::Right)
            .held(Action::Act)
    );
    let board = boards(&studio).get(WRIST).unwrap();
    let (point, front) = (
        board.at(board.find(&button).unwrap()),
        board.pose.rotation * Vec3::Z,
    );
    aim_at(&mut studio, point, front);
    assert!(
        studio
            .world()
            .resource::<Hands>()
            .get(Side::Right)
            .held(Action::Act)
    );
    assert_eq!(
        studio.world().resource::<Wands>().get(Side::Right).met,
        None
    );
    studio.let_go(Side::Right, Action::Act);
    studio.frames(4);
    assert!(!is_open(&studio, "library"));
}

#[test]
fn a_board_is_moved_by_its_bar_and_closed_by_its_cross() {
    let mut studio = worn();
    studio.ask(Command::ToggleLibrary);
    studio.frames(20);
    let panels = studio.world().resource::<Panels>();
    let info = panels.all().iter().find(|i| i.id == "library").unwrap();
    let title = format!("{}  {}", info.icon, info.title);
    aim(&mut studio, LIBRARY, &title);
    let before = boards(&studio).get(LIBRARY).unwrap().pose.position;
    studio.press(Side::Right, Action::Act);
    let hand = studio.pose(Side::Right);
    let by = Vec3::new(0.1, 0.15, -0.05);
    studio.carry(
        None,
        Some(Pose {
            position: hand.position + by,
            ..hand
        }),
    );
    studio.let_go(Side::Right, Action::Act);
    let board = boards(&studio).get(LIBRARY).unwrap();
    near(board.pose.position, before + by, 0.01);
    // It goes on facing the eyes.
    let eyes = studio.world().resource::<Stance>().head.position;
    let front = board.pose.rotation * Vec3::Z;
    assert!(front.dot((eyes - board.pose.position).normalize()) > 0.99);
    studio.frames(5);
    click(&mut studio, LIBRARY, midair_studio::panel::icon::X);
    assert!(!is_open(&studio, "library"));
    assert!(boards(&studio).get(LIBRARY).is_none());
}

#[test]
fn a_document_is_saved_under_a_name_typed_with_the_wand() {
    let mut studio = worn();
    studio.ask(Command::ToggleLibrary);
    studio.place("solid/cube", Vec3::new(0.0, 0.8, -0.4));
    studio.ask(Command::ToggleLibrary);
    let folder = studio.home.path().join("models");
    std::fs::create_dir_all(&folder).unwrap();
    studio.ask(Command::Dialog(Dialog::SaveAs));
    studio.frames(30);
    let name = studio.world().resource::<Project>().title();
    // The field holds the name that the document has.
    aim(&mut studio, BoardId::Files, &name);
    trigger(&mut studio);
    studio.frames(10);
    assert!(
        boards(&studio).get(BoardId::Keyboard).is_some(),
        "no keyboard"
    );
    for key in ["c", "u", "p"] {
        click(&mut studio, BoardId::Keyboard, key);
    }
    studio.frames(10);
    click(&mut studio, BoardId::Files, "Save");
    studio.settle();
    let saved = studio
        .world()
        .resource::<Project>()
        .path()
        .map(ToOwned::to_owned);
    let saved = saved.expect("it was saved");
    assert!(
        saved.to_string_lossy().contains("cup"),
        "{}",
        saved.display()
    );
    assert!(saved.is_file());
    assert!(boards(&studio).get(BoardId::Files).is_none());
}

#[test]
fn what_is_done_in_the_room_is_recorded_and_plays_back_without_one() {
    let home = tempfile::tempdir().unwrap();
    let file = home.path().join("room.ron");
    let recorder = RecorderPlugin::create(&file, "In a room").unwrap();
    let mut studio = standing(Studio::with(|app| {
        wear(app);
        app.add_plugins(recorder);
    }));
    let button = library_button(&studio);
    click(&mut studio, WRIST, &button);
    studio.frames(30);
    click(&mut studio, LIBRARY, "Cube");
    studio.settle();
    // And it is moved, by hand.
    let id = studio.only();
    studio.reach(Side::Right, studio.placement(id).translation);
    studio.press(Side::Right, Action::Grab);
    studio.carry_right(Vec3::new(0.1, 0.9, -0.3));
    studio.let_go(Side::Right, Action::Grab);
    studio.settle();
    let made = studio.placement(id);
    drop(studio);

    let places = Places::below(home.path());
    let mut app = midair::app(midair::Stage::Bare, places, Begin::default());
    app.add_plugins(PlayerPlugin);
    let session = Session::load(&file).unwrap();
    let report = play(&mut app, session, PlayOptions::default()).unwrap();
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
    let document = app.world().resource::<Project>().document();
    assert_eq!(document.len(), 1);
    assert_eq!(document.object(id).unwrap().placement, made);
}

#[test]
fn boards_stay_in_the_room_when_the_world_is_scaled_under_them() {
    let mut studio = worn();
    studio.ask(Command::ToggleLibrary);
    studio.frames(10);
    let before = boards(&studio).get(LIBRARY).unwrap().pose;
    // The hands pull the world to twice its size.
    for (side, x) in [(Side::Left, -0.1), (Side::Right, 0.1)] {
        studio.put(side, Pose::at(Vec3::new(x, 0.7, 0.1)));
    }
    studio.frames(3);
    studio.press(Side::Left, Action::Grab);
    studio.press(Side::Right, Action::Grab);
    for i in 1..=20 {
        let x = 0.1 + 0.005 * i as f32;
        let world = studio.world().resource::<WorldView>().world_from_room();
        let scale = studio.world().resource::<WorldView>().scale();
        for (side, x) in [(Side::Left, -x), (Side::Right, x)] {
            studio.put(side, world.pose(&Pose::at(Vec3::new(x, 0.7, 0.1))));
        }
        let head = Pose {
            position: Vec3::new(0.0, 1.6, 0.5),
            rotation: Quat::from_rotation_x(-0.35),
        };
        studio.input().head = Some(world.pose(&head));
        studio.input().metres_per_world = scale;
        studio.frame();
    }
    let scale = studio.world().resource::<WorldView>().scale();
    assert!((1.8..2.2).contains(&scale), "{scale}");
    let after = boards(&studio).get(LIBRARY).unwrap().pose;
    near(after.position, before.position, 1e-4);
}

#[test]
fn a_grip_on_nothing_and_the_stick_turn_the_world_in_steps() {
    let mut studio = worn();
    let at = Vec3::new(0.3, 0.7, 0.1);
    studio.put(Side::Right, Pose::at(at));
    studio.frames(3);
    let before = studio.world().resource::<WorldView>().room_from_world;
    studio.press(Side::Right, Action::Grab);
    for _ in 0..2 {
        studio.swipe(Some(Vec2::new(0.9, 0.1)));
        studio.frames(5);
        studio.swipe(Some(Vec2::ZERO));
        studio.frames(2);
    }
    studio.swipe(None);
    studio.let_go(Side::Right, Action::Grab);
    let after = studio.world().resource::<WorldView>().room_from_world;
    let turned = before.rotation.angle_between(after.rotation).to_degrees();
    assert!((turned - 60.0).abs() < 0.5, "{turned}");
    // Without a grip the stick is the tool's.
    studio.swipe(Some(Vec2::new(0.9, 0.1)));
    studio.frames(5);
    assert_eq!(
        studio.world().resource::<WorldView>().room_from_world,
        after
    );
    let hand = studio.world().resource::<Hands>().get(Side::Right);
    assert_eq!(hand.swipe, Some(Vec2::new(0.9, 0.1)));
}

#[test]
fn who_has_one_hand_finds_what_the_wrist_has_before_the_body() {
    let mut studio = worn();
    studio.input().side(Side::Left).pose = None;
    studio.pass(2.2);
    let board = boards(&studio).get(WRIST).unwrap();
    let eyes = studio.world().resource::<Stance>().head.position;
    assert!(board.shown);
    assert!((0.5..=0.7).contains(&board.pose.position.distance(eyes)));
    let button = library_button(&studio);
    click(&mut studio, WRIST, &button);
    assert!(is_open(&studio, "library"));
    studio.put(Side::Left, Pose::at(Vec3::new(-0.22, 1.15, 0.1)));
    studio.frames(3);
    let board = boards(&studio).get(WRIST).unwrap();
    assert!(board.pose.position.x < -0.2, "back on the wrist");
}

#[test]
fn one_hand_alone_moves_the_world_where_that_is_set() {
    let mut studio = worn();
    let pose = Pose::at(Vec3::new(0.3, 0.7, 0.1));
    studio.put(Side::Right, pose);
    studio.frames(3);
    let pull = |studio: &mut Studio| {
        studio.press(Side::Right, Action::Grab);
        let world = studio.world().resource::<WorldView>().world_from_room();
        let moved = Pose::at(pose.position + Vec3::new(0.0, 0.1, -0.2));
        studio.put(Side::Right, world.pose(&moved));
        studio.frame();
        studio.let_go(Side::Right, Action::Grab);
        studio.world().resource::<WorldView>().room_from_world
    };
    let still = pull(&mut studio);
    assert_eq!(still.translation, Vec3::ZERO);
    studio.put(Side::Right, pose);
    studio.ask(Settings::command("world.one_handed", true));
    let moved = pull(&mut studio);
    near(moved.translation, Vec3::new(0.0, 0.1, -0.2), 1e-4);
}
