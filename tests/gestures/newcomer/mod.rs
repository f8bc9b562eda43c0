//! A newcomer: reads the tutorial's card on the screen and does what it says, at a person's pace, with mouse and
//! keyboard or with a gamepad. Nothing here knows the names of steps or what they wait for.
//!
//! The pace is that of the keystroke-level model (Card, Moran, Newell 1980): 1.35 s to make up one's mind at each
//! sentence (what a sentence asks for is one unit of thought: the model's rule 2), 1.1 s to point, 0.28 s for a key, 0.1 s to press or release a mouse button, 0.4 s from mouse to
//! keyboard and back; a card is read at 250 words a minute. Sticks take the time they take.

mod mouse;
mod pad;
mod screen;
mod words;

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use bevy::math::Vec3;
use bevy::time::TimeUpdateStrategy;
use midair::{Stage, probe};
use midair_document::ObjectId;
use midair_playback::{PlayOptions, PlayerPlugin, RecorderPlugin, Session, play};
use midair_studio::help::{GuidePlugin, Tutorial};
use midair_studio::objects::extent;
use midair_studio::project::{Begin, Places};
use midair_studio::settings::{Lesson, Settings, SnapSettings};

use crate::desk::{Desk, FRAME};
use words::{Act, acts};

/// Seconds of the model.
const THINKS: f32 = 1.35;
const POINTS: f32 = 1.1;
const KEYS: f32 = 0.28;
const BUTTONS: f32 = 0.1;
const HOMES: f32 = 0.4;
const WORD: f32 = 60.0 / 250.0;
/// A frame in which nothing happens may last so long.
const IDLE: f32 = 0.1;

/// What EasyVRModeling's volunteers took on average to learn it (§6.3).
const PAPER: f32 = 233.0;

struct Newcomer {
    desk: Desk,
    /// What the cards have called things.
    names: BTreeMap<String, ObjectId>,
    /// Acts done.
    acts: usize,
    /// Whether the hand is at the keyboard.
    at_keys: bool,
    /// Which of several things it is at.
    nth: usize,
    /// It does the same once more.
    again: bool,
    /// Seconds spent reading.
    read: f32,
}

impl Newcomer {
    fn new(desk: Desk) -> Self {
        Self {
            desk,
            names: BTreeMap::new(),
            acts: 0,
            at_keys: false,
            nth: 0,
            again: false,
            read: 0.0,
        }
    }

    /// Waits until what was asked for is made, as long as that takes on this machine.
    fn settle(&mut self) {
        self.pace(Duration::from_millis(3));
        self.desk.settle();
        self.pace(FRAME);
    }

    /// Time goes by.
    fn rest(&mut self, seconds: f32) {
        let whole = (seconds / IDLE) as usize;
        self.pace(Duration::from_secs_f32(IDLE));
        self.desk.wait(whole);
        self.pace(FRAME);
        let left = seconds - whole as f32 * IDLE;
        self.desk.wait((left / FRAME.as_secs_f32()) as usize);
    }

    fn pace(&mut self, frame: Duration) {
        let world = self.desk.app.world_mut();
        world.insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    }

    /// The things that a word stands for.
    fn things(&self, word: &str) -> Vec<ObjectId> {
        let word = word.trim_start_matches("each ").trim_start_matches("the ");
        if let Some(&id) = self.names.get(word)
            && self.desk.document().object(id).is_some()
        {
            return vec![id];
        }
        let objects = self.desk.document().objects();
        let named: Vec<_> = objects
            .filter(|(_, o)| o.name.to_lowercase().contains(word))
            .map(|(id, _)| id)
            .collect();
        match named.is_empty() {
            // "The piece", "the chair": there is only one thing.
            true if self.desk.document().len() == 1 => {
                vec![self.desk.document().objects().next().unwrap().0]
            }
            true => panic!("what is a {word}?"),
            false => named,
        }
    }

    fn thing(&self, word: &str) -> ObjectId {
        *self.things(word).last().unwrap()
    }

    fn size(&self, id: ObjectId) -> (Vec3, Vec3) {
        extent(self.desk.document(), [id]).unwrap()
    }

    /// By how much a thing has to go to a place that a card describes; `nth` of several.
    fn way(&self, id: ObjectId, place: &str, nth: usize) -> Vec3 {
        let (low, high) = self.size(id);
        let (middle, half) = (low.midpoint(high), 0.5 * (high - low));
        let words = place.trim_start_matches("halfway into ");
        let words = words.trim_start_matches("to ").trim_start_matches("under ");
        let words = words.trim_start_matches("into ");
        let of = words.split(" of the ").last().unwrap();
        let of = of.split(',').next().unwrap();
        let (l, h) = self.size(self.thing(of));
        let (there, reach) = (l.midpoint(h), 0.5 * (h - l));
        let level = |to: Vec3| (to - middle).with_y(0.0);
        if place.starts_with("to a corner") || place == "into the cube" {
            // The corner that is nearest to it, in front.
            let side = (middle.x - there.x).signum();
            return level(there + Vec3::new(side * reach.x, 0.0, reach.z));
        }
        if words.starts_with("a corner") {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let (x, z) = corners[nth % 4];
            return level(there + Vec3::new(x * 0.6 * reach.x, 0.0, z * 0.6 * reach.z));
        }
        if words.starts_with("the rear edge") {
            return level(there - Vec3::Z * (reach.z - half.z));
        }
        if words.starts_with("the side") {
            return level(there + Vec3::X * (reach.x + 0.2 * half.x));
        }
        if place.starts_with("into") {
            let up = if place.contains("higher") { 0.1 } else { 0.0 };
            return level(there) + Vec3::Y * up;
        }
        panic!("where is \"{place}\"?")
    }

    /// How far up a thing is to go to be as high as a card says.
    fn height(&self, id: ObjectId, words: &str) -> f32 {
        let (low, high) = self.size(id);
        let middle = 0.5 * (low.y + high.y);
        match words.trim_start_matches("as high as ") {
            "a seat is" => 0.42 - middle,
            "the seat" => self.size(self.thing("seat")).1.y - 0.05 - low.y,
            "the middle of the body" => {
                let (l, h) = self.size(self.thing("body"));
                0.5 * (l.y + h.y) - middle
            }
            other => panic!("how high is \"{other}\"?"),
        }
    }

    /// Names what was made last.
    fn called(&mut self, name: &str) {
        let last = self.desk.document().objects().next_back().unwrap().0;
        self.names.insert(name.to_owned(), last);
    }
}

/// How a way in does an act.
type Does = fn(&mut Newcomer, &Act);

/// Does everything that a card says; what is said of each of several things is done with each.
fn all(person: &mut Newcomer, todo: &[Act], does: Does) {
    let mut i = 0;
    while let Some(one) = todo.get(i) {
        match one {
            Act::PointAt(word) if word.starts_with("each ") => {
                let rest = &todo[i + 1..];
                let until = rest.iter().position(|a| *a == Act::Mind);
                let rest = &rest[..until.unwrap_or(rest.len())];
                for (nth, id) in person.things(word).into_iter().enumerate() {
                    person.nth = nth;
                    person.names.insert("one".to_owned(), id);
                    does(person, &Act::PointAt("one".to_owned()));
                    rest.iter().for_each(|a| does(person, a));
                    if rest.iter().any(|a| matches!(a, Act::Hold(_))) {
                        does(person, &Act::LetGo);
                    }
                }
                i += rest.len();
            }
            Act::Again(times) => {
                person.again = true;
                (0..*times).for_each(|_| all(person, &todo[..i], does));
                person.again = false;
            }
            // What is done once more needs no new plan.
            Act::Mind if person.again => {}
            Act::Mind => person.rest(THINKS),
            one => {
                person.acts += 1;
                does(person, one);
            }
        }
        i += 1;
    }
}

/// Follows the tutorial to its end; says how many cards there were.
fn follow(person: &mut Newcomer, act: Does) -> usize {
    let mut before = String::new();
    let mut cards = 0;
    loop {
        let card = person.desk.card().expect("the card is on the screen");
        if card.starts_with("That is all") {
            return cards;
        }
        let boxes = || {
            let objects = person.desk.document().objects();
            let each = objects.map(|(id, o)| (o.name.clone(), person.size(id)));
            each.collect::<Vec<_>>()
        };
        assert_ne!(card, before, "done, and it says the same: {:?}", boxes());
        cards += 1;
        // The sign of a key is one word.
        let words = card.replace("D-pad ", "");
        let reads = words.split_whitespace().count() as f32 * WORD;
        person.read += reads;
        person.rest(reads);
        let todo = acts(&card);
        assert!(!todo.is_empty(), "nobody can tell what to do: {card}");
        all(person, &todo, act);
        // Nobody holds on when nothing is left to do.
        if !todo.contains(&Act::LetGo) {
            act(person, &Act::LetGo);
        }
        person.settle();
        person.desk.wait(6);
        before = card;
    }
}

/// The tutorial as recorded while it is followed, and what came of it.
/// `within` seconds, reading included.
fn record(title: &str, within: f32, begin: fn(&mut Newcomer), act: Does) {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("tutorial.ron");
    let recorder = RecorderPlugin::create(&recording, title).unwrap();
    let mut desk = Desk::with(move |app| {
        // As a person finds it.
        let mut settings = app.world_mut().resource_mut::<Settings>();
        settings.snap = SnapSettings::of_a_person();
        // The words as they stand in the files, which the app has built in.
        let words = ["1-cube-sphere", "2-chair", "3-cup"].map(|name| {
            let folder = env!("CARGO_MANIFEST_DIR");
            std::fs::read_to_string(format!("{folder}/assets/tutorial/{name}.ron")).unwrap()
        });
        app.insert_resource(Tutorial::of(words.iter().map(String::as_str)));
        app.add_plugins((recorder, GuidePlugin));
    });
    desk.open_eyes();
    let mut person = Newcomer::new(desk);
    begin(&mut person);
    let cards = follow(&mut person, act);
    let Newcomer {
        desk, acts, read, ..
    } = person;
    assert_eq!(desk.warnings(), [] as [String; 0]);
    let progress = desk.world().resource::<Settings>().help.tutorial;
    assert_eq!(progress.state, Lesson::Done);
    println!(
        "{title}: {cards} cards, {acts} acts, {} presses and pushes, {:.0} s, of them {read:.0} s reading",
        desk.presses, progress.seconds
    );
    assert!(progress.seconds < within, "{} s", progress.seconds);
    let Desk { app, home, .. } = desk;
    // The recording ends with the app.
    drop(app);
    let (recorded, played) = (document(home.path()), replayed(&recording));
    assert!(recorded == played, "the same bytes");
    if let Some(kept) = std::env::var_os("MIDAIR_RECORDINGS") {
        let name = title
            .to_lowercase()
            .replace([' ', ','], "-")
            .replace("--", "-");
        let kept = Path::new(&kept).join(name).with_extension("ron");
        std::fs::copy(&recording, kept).unwrap();
    }
}

/// The document that was saved at the end.
fn document(home: &Path) -> Vec<u8> {
    let work = Places::below(home).work;
    let files = std::fs::read_dir(&work).unwrap().map(|e| e.unwrap().path());
    let mut saved: Vec<_> = files
        .filter(|p| p.extension().is_some_and(|e| e == "midair"))
        .collect();
    assert_eq!(saved.len(), 1, "{saved:?}");
    std::fs::read(saved.remove(0)).unwrap()
}

/// Plays a recording elsewhere: the document it saves, after its one solid was looked at.
fn replayed(recording: &Path) -> Vec<u8> {
    let home = tempfile::tempdir().unwrap();
    let mut player = midair::app(Stage::Bare, Places::below(home.path()), Begin::default());
    player.add_plugins(PlayerPlugin);
    let options = PlayOptions {
        probe,
        ..PlayOptions::default()
    };
    let report = play(&mut player, Session::load(recording).unwrap(), options).unwrap();
    assert_eq!(report.objects.len(), 1, "a cup is left");
    assert_eq!(report.objects[0].closed, Some(true));
    document(home.path())
}

#[test]
fn the_tutorial_by_mouse_and_keyboard_by_what_it_says() {
    record(
        "Tutorial, by mouse and keyboard",
        PAPER,
        mouse::begin,
        mouse::act,
    );
}

#[test]
fn the_tutorial_by_gamepad_by_what_it_says() {
    record("Tutorial, by gamepad", PAPER, pad::begin, pad::act);
}

#[test]
fn the_recorded_tutorials_play_to_a_cup() {
    for name in ["tutorial-by-mouse-and-keyboard", "tutorial-by-gamepad"] {
        let file = format!("{}/assets/sessions/{name}.ron", env!("CARGO_MANIFEST_DIR"));
        let bytes = replayed(Path::new(&file));
        assert!(!bytes.is_empty());
    }
}
