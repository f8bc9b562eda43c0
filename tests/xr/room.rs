//! Everything with the headset on: panels opened from the wrist, clicked, dragged and scrolled by a wand; letters typed with its
//! keys; modes from the ring. Words are found where the app says that they stand.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use bevy::math::{Vec2, Vec3};
use bevy::prelude::Transform;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::panel::icon;
use serde_json::Value;

use crate::life::focus;
use crate::perform::Performer;
use crate::stage::{App, Runtime, midair};

/// Metres before a panel from where a wand points at it.
const AWAY: f32 = 0.3;
pub const WRIST: &str = "Wrist";
pub const LIBRARY: &str = "Panel(\"library\")";
const SETTINGS: &str = "Panel(\"settings\")";
const EXPORT: &str = "Panel(\"export\")";
const RING: &str = "Ring";
pub const TUTORIAL: &str = "Panel(\"tutorial\")";

/// A person's right hand, with a wand in it.
pub struct Wand {
    pub performer: Performer,
    pub app: App,
}

impl Wand {
    /// Waits until a panel is there and has been laid out.
    pub fn opened(&mut self, board: &str) -> Result<()> {
        self.app.until(&format!("{board} is open"), |now| {
            found(now, board).is_some_and(|b| {
                b["shown"] == true && b["texts"].as_array().is_some_and(|t| !t.is_empty())
            })
        })?;
        Ok(())
    }

    fn closed(&mut self, board: &str) -> Result<()> {
        self.app.until(&format!("{board} is closed"), |now| {
            found(now, board).is_none()
        })?;
        Ok(())
    }

    /// Points at the shortest text on a panel that has this one in it, and has the wand there.
    fn aim(&mut self, board: &str, text: &str) -> Result<()> {
        let what = format!("\"{text}\" on {board}");
        self.app
            .until(&what, |now| place(now, board, text).is_some())?;
        // A panel that opens, grows or is laid out anew moves what is on it: it is aimed at again until it stays.
        for _ in 0..40 {
            let Some((at, front)) = place(&self.app.now, board, text) else {
                self.performer.frames(&mut self.app, 1)?;
                continue;
            };
            let from = at + AWAY * front + Vec3::new(0.02, -0.06, 0.0);
            let to = Transform::from_translation(from).looking_at(at, Vec3::Y);
            let to = Pose {
                position: to.translation,
                rotation: to.rotation,
            };
            self.performer.go(&mut self.app, Side::Right, to)?;
            self.performer.frames(&mut self.app, 2)?;
            let stays =
                place(&self.app.now, board, text).is_some_and(|(now, _)| now.distance(at) < 2e-3);
            if stays && self.app.now["hands"][1]["on"] == board {
                return Ok(());
            }
        }
        bail!(
            "the wand does not come to {what}: it is on {}, and there is {}",
            self.app.now["hands"][1]["on"],
            found(&self.app.now, board).unwrap_or(&Value::Null)
        );
    }

    /// Clicks a text on a panel.
    pub fn click(&mut self, board: &str, text: &str) -> Result<()> {
        self.aim(board, text)?;
        self.trigger(true)?;
        self.trigger(false)
    }

    /// Pushes the stick, the wand at one text of a panel, until another one farther down is seen.
    pub fn scrolled(&mut self, board: &str, from: &str, to: &str) -> Result<()> {
        let seen = |now: &Value| place(now, board, to).is_some();
        if seen(&self.app.now) {
            return Ok(());
        }
        self.aim(board, from)?;
        let push = |wand: &mut Self, y: f32| {
            let hand = &mut wand.performer.rig.hands[1];
            (hand.pad_touch, hand.pad) = (y != 0.0, Vec2::new(0.0, y));
            wand.performer.rig.send()
        };
        push(self, -0.5)?;
        self.app.until(&format!("{board} scrolls to {to}"), seen)?;
        push(self, 0.0)?;
        self.performer.settle(&mut self.app)
    }

    /// The trigger goes down or up on a panel, which has had it since.
    fn trigger(&mut self, down: bool) -> Result<()> {
        self.performer
            .press(&mut self.app, Side::Right, Action::Act, down)?;
        let has = self.app.now["hands"][1]["captured"]
            .to_string()
            .contains("Act");
        if has != down {
            bail!("no panel has the trigger: {}", self.app.now["hands"][1]);
        }
        self.performer.frames(&mut self.app, 3)
    }

    /// The hand goes somewhere in the room, level.
    fn go(&mut self, at: Vec3) -> Result<()> {
        self.performer
            .go(&mut self.app, Side::Right, Pose::at(at))?;
        self.performer.frames(&mut self.app, 2)
    }

    /// Waits until there are so many objects and nothing is under way.
    fn objects(&mut self, count: u64) -> Result<()> {
        self.app
            .until(&format!("there are {count} objects"), |now| {
                now["objects"] == count && now["busy"] == 0
            })?;
        Ok(())
    }
}

fn found<'a>(now: &'a Value, board: &str) -> Option<&'a Value> {
    now["boards"].as_array()?.iter().find(|b| b["id"] == board)
}

/// Where a text stands, in metres of world, and which way its panel faces.
fn place(now: &Value, board: &str, text: &str) -> Option<(Vec3, Vec3)> {
    let board = found(now, board)?;
    let vector = |v: &Value| {
        let number = |i: usize| v[i].as_f64().unwrap_or(f64::NAN) as f32;
        Vec3::new(number(0), number(1), number(2))
    };
    let texts = board["texts"].as_array()?.iter();
    let with = texts.filter_map(|t| Some((t[0].as_str()?, &t[1])));
    let (_, at) = with
        .filter(|(t, _)| t.contains(text))
        // A button that is called as its panel is stands below the heading.
        .rev()
        .min_by_key(|(t, _)| t.len())?;
    Some((vector(at), vector(&board["front"])))
}

/// Nothing is under way, and no dot stands beside the document's name on the wrist.
fn is_saved(now: &Value) -> bool {
    now["busy"] == 0 && place(now, WRIST, "Midair").is_some() && place(now, WRIST, "•").is_none()
}

/// From an empty document to a saved, exported, reopened one, without taking the headset off.
pub fn room(folder: &Path) -> Result<()> {
    let file = |name: &str| folder.join(name).display().to_string();
    let record = file("recorded.ron");
    let config = folder.join("home/config");
    fs::create_dir_all(&config)?;
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    performer.rig.head = Pose {
        position: Vec3::new(0.0, 1.6, 0.5),
        rotation: bevy::math::Quat::from_rotation_x(-0.35),
    };
    performer.rig.send()?;
    let mut app = App::start(folder, &["--vr", "--record", &record])?;
    focus(&mut app)?;
    app.say("boards")?;
    performer.go(&mut app, Side::Left, Pose::at(Vec3::new(-0.22, 1.15, 0.1)))?;
    performer.go(&mut app, Side::Right, Pose::at(Vec3::new(0.25, 1.15, 0.1)))?;
    let mut wand = Wand { performer, app };

    // The tutorial that greets a newcomer is closed by its cross.
    wand.opened(TUTORIAL)?;
    wand.click(TUTORIAL, icon::X)?;
    wand.closed(TUTORIAL)?;

    // The library, from the wrist; scrolled, then a shape clicked and one dragged out.
    wand.opened(WRIST)?;
    wand.click(WRIST, "Library")?;
    wand.opened(LIBRARY)?;
    wand.aim(LIBRARY, "Cube")?;
    let before = place(&wand.app.now, LIBRARY, "Cube")
        .context("the cube's tile")?
        .0;
    let pad = |wand: &mut Wand, y: f32| {
        let hand = &mut wand.performer.rig.hands[1];
        (hand.pad_touch, hand.pad) = (y != 0.0, Vec2::new(0.0, y));
        wand.performer.rig.send()
    };
    pad(&mut wand, -1.0)?;
    wand.app.until("the library scrolls", |now| {
        place(now, LIBRARY, "Cube").is_none_or(|(at, _)| at.y > before.y + 0.02)
    })?;
    pad(&mut wand, 1.0)?;
    wand.app.until("the library scrolls back", |now| {
        place(now, LIBRARY, "Cube").is_some_and(|(at, _)| at.distance(before) < 2e-3)
    })?;
    pad(&mut wand, 0.0)?;
    wand.click(LIBRARY, "Cube")?;
    wand.objects(1)?;
    // It is in the hand, which means it and no longer the panel behind it: taken, and put where it is to be.
    wand.app
        .until("the hand is in the cube", |now| now["hands"][1]["on"] == "")?;
    wand.performer
        .press(&mut wand.app, Side::Right, Action::Grab, true)?;
    wand.app
        .until("the cube is dragged", |now| now["dragging"] == true)?;
    wand.go(Vec3::new(0.05, 0.95, -0.25))?;
    wand.performer
        .press(&mut wand.app, Side::Right, Action::Grab, false)?;
    wand.app
        .until("the cube is let go", |now| now["dragging"] == false)?;
    wand.aim(LIBRARY, "Sphere")?;
    wand.trigger(true)?;
    // Off the panel's lower edge.
    wand.go(Vec3::new(0.1, 1.0, 0.0))?;
    wand.trigger(false)?;
    wand.objects(2)?;

    // A step back and forward again, from the wrist.
    wand.click(WRIST, "Undo")?;
    wand.objects(1)?;
    wand.click(WRIST, "Redo")?;
    wand.objects(2)?;

    // Saved under a name that is typed with the wand.
    wand.click(WRIST, "Files")?;
    wand.click(WRIST, "Save as")?;
    wand.opened("Files")?;
    // The name is selected already: the first key takes its place.
    wand.opened("Keyboard")?;
    for key in ["c", "u", "p"] {
        wand.click("Keyboard", key)?;
    }
    wand.click("Files", "Save")?;
    wand.closed("Files")?;
    wand.app.until("it is saved", is_saved)?;

    // Exported, from a panel.
    wand.click(WRIST, "Export")?;
    wand.opened(EXPORT)?;
    wand.click(EXPORT, "Export")?;
    wand.closed(EXPORT)?;
    wand.app.until("it is exported", |now| now["busy"] == 0)?;

    // A setting.
    wand.click(WRIST, "Work")?;
    wand.click(WRIST, icon::GEAR)?;
    wand.opened(SETTINGS)?;
    wand.click(SETTINGS, "Comfort")?;
    wand.click(SETTINGS, "Show the time of a frame")?;
    wand.click(SETTINGS, icon::X)?;
    wand.closed(SETTINGS)?;

    wand.click(LIBRARY, icon::X)?;
    wand.closed(LIBRARY)?;

    // The ring of modes, at the hand.
    wand.go(Vec3::new(0.25, 1.15, 0.1))?;
    wand.performer
        .press(&mut wand.app, Side::Right, Action::Menu, true)?;
    wand.opened(RING)?;
    let (brush, _) = place(&wand.app.now, RING, "Brush").context("Brush on the ring")?;
    wand.go(brush)?;
    wand.performer
        .press(&mut wand.app, Side::Right, Action::Menu, false)?;
    wand.app
        .until("the mode is Brush", |now| now["mode"] == "brush")?;

    // Away from the work and back to it.
    wand.click(WRIST, "Files")?;
    wand.click(WRIST, "Save")?;
    wand.app.until("it is saved again", is_saved)?;
    wand.click(WRIST, "New")?;
    wand.objects(0)?;
    wand.click(WRIST, "cup.midair")?;
    wand.objects(2)?;
    let made = saved(&folder.join("home"), "cup.midair")?;
    wand.app.kill(&record)?;
    let made = made.display().to_string();
    midair(&["export", &made, "--to", &file("saved.stl")])?;
    midair(&["play", &record, "--export", &file("played.stl")])?;
    if fs::read(file("saved.stl"))? != fs::read(file("played.stl"))? {
        bail!("the recording, played without a headset, makes another mesh");
    }
    // Both shapes stand for themselves and may cross; the document has to be sound.
    midair(&["check", &made])?;
    Ok(())
}

/// A file whose name ends so, somewhere below a folder.
fn saved(folder: &Path, name: &str) -> Result<PathBuf> {
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.to_string_lossy().ends_with(name) {
                return Ok(path);
            }
        }
    }
    bail!("there is no {name} below {}", folder.display());
}
