//! Brush with the headset on, by what its hints say: the ghost of each skeleton before and during the trigger, the size by the
//! stick, a stroke changed later, erasing, the panel, saving.

use std::fs;
use std::path::Path;

use anyhow::{Result, bail};
use bevy::math::{Quat, Vec3};
use midair_brush::canvas;
use midair_field::{Canvas, Skeleton};
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::panel::icon;

use crate::life::{focus, quit};
use crate::looks::look;
use crate::perform::Performer;
use crate::room::{TUTORIAL, WRIST, Wand};
use crate::stage::{App, Runtime};

const BRUSH: &str = "Panel(\"brush\")";
/// Where the line begins and ends, the corners of the area, where the horse stands and where is nothing.
const LINE: [Vec3; 2] = [Vec3::new(-0.12, 0.95, 0.0), Vec3::new(0.14, 1.05, 0.0)];
const CORNERS: [Vec3; 4] = [
    Vec3::new(-0.12, 0.82, 0.0),
    Vec3::new(0.02, 0.80, 0.05),
    Vec3::new(0.02, 0.90, 0.05),
    Vec3::new(-0.12, 0.92, 0.0),
];
const HORSE: Vec3 = Vec3::new(0.22, 0.86, 0.0);
const AIR: Vec3 = Vec3::new(0.1, 1.2, 0.05);

/// Paints with all four, erases, changes, undoes and saves, and looks at the document that came of it.
pub fn brush(folder: &Path) -> Result<()> {
    let config = folder.join("home/config");
    fs::create_dir_all(&config)?;
    fs::write(config.join("settings.ron"), "(comfort: (sharpness: 2.0))")?;
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    performer.rig.head = Pose {
        position: Vec3::new(0.0, 1.45, 0.65),
        rotation: Quat::from_rotation_x(-0.45),
    };
    performer.rig.send()?;
    let mut app = App::start(folder, &["--vr"])?;
    focus(&mut app)?;
    app.say("boards")?;
    performer.go(&mut app, Side::Left, Pose::at(Vec3::new(-0.27, 1.12, 0.25)))?;
    performer.go(&mut app, Side::Right, Pose::at(AIR))?;
    let mut hand = Painter {
        wand: Wand { performer, app },
        edits: 0,
        folder,
    };
    hand.wand.opened(TUTORIAL)?;
    hand.wand.click(TUTORIAL, icon::X)?;
    hand.wand.click(WRIST, "Brush")?;
    hand.wand.opened(BRUSH)?;

    // The size, by the stick held upwards.
    hand.go(AIR)?;
    hand.picture("point-before")?;
    hand.hold(Action::Up, 12)?;
    hand.picture("point-larger")?;
    hand.hold(Action::Down, 12)?;
    hand.press(true)?;
    hand.go(AIR + Vec3::new(0.12, 0.04, 0.0))?;
    hand.picture("point-during")?;
    hand.press(false)?;
    hand.made("a led point")?;

    hand.tap(Action::Right)?;
    hand.go(LINE[0])?;
    hand.press(true)?;
    hand.go(LINE[1])?;
    hand.picture("line-during")?;
    hand.press(false)?;
    hand.made("a line")?;

    hand.tap(Action::Right)?;
    for at in CORNERS {
        hand.go(at)?;
        hand.press(true)?;
        hand.press(false)?;
    }
    hand.go(CORNERS[3] + Vec3::new(-0.05, 0.06, 0.0))?;
    hand.picture("polygon-during")?;
    hand.tap(Action::Finish)?;
    hand.made("an area")?;

    hand.tap(Action::Right)?;
    hand.go(HORSE)?;
    hand.wand
        .app
        .until("the brush is made", |now| now["busy"] == 0)?;
    hand.frames(4)?;
    hand.picture("volume-before")?;
    hand.press(true)?;
    hand.frames(4)?;
    hand.picture("volume-during")?;
    hand.press(false)?;
    hand.made("a horse")?;

    // The other hand's trigger erases: a hole in the line.
    hand.tap(Action::Right)?;
    hand.go(LINE[0].midpoint(LINE[1]) + Vec3::new(0.0, 0.0, 0.03))?;
    hand.alt(true)?;
    hand.picture("erase-before")?;
    hand.press(true)?;
    hand.frames(3)?;
    hand.press(false)?;
    hand.alt(false)?;
    hand.made("what is erased")?;

    // The line, selected later: dragged, larger, heavier, and the led point deleted.
    hand.go(LINE[1])?;
    hand.tap(Action::Finish)?;
    hand.picture("selected")?;
    hand.press(true)?;
    hand.go(LINE[1] + Vec3::new(0.0, 0.03, 0.02))?;
    hand.frames(4)?;
    hand.picture("moving")?;
    hand.press(false)?;
    hand.made("a stroke moved")?;
    hand.tap(Action::Up)?;
    hand.made("a stroke resized")?;
    hand.tap(Action::Right)?;
    hand.made("a stroke weighed")?;
    hand.tap(Action::Finish)?;
    hand.go(AIR)?;
    hand.tap(Action::Finish)?;
    hand.picture("selected-point")?;
    // A double press is told by time, which a test has not: its button on the panel.
    hand.wand.scrolled(BRUSH, "Radius", icon::TRASH)?;
    hand.wand.click(BRUSH, icon::TRASH)?;
    hand.made("a stroke deleted")?;
    hand.picture("deleted")?;

    // Back and forward from the wrist, and saved.
    hand.wand.click(WRIST, "Undo")?;
    let undone = hand.edits - 1;
    hand.wand.app.until("it is undone", |now| {
        now["undo"] == undone && now["redo"] == 1 && now["busy"] == 0
    })?;
    hand.wand.click(WRIST, "Redo")?;
    hand.wand
        .app
        .until("it is done again", |now| now["redo"] == 0)?;
    let saved = folder.join("made.midair");
    hand.wand.app.ask(&Command::SaveAs(saved.clone()))?;
    hand.wand.app.until("it is saved", |now| {
        now["busy"] == 0 && fs::metadata(&saved).is_ok()
    })?;
    let document = midair_document::open(&saved)?.document;
    let painted = document.objects().find_map(|(_, o)| canvas(o));
    as_painted(painted)?;
    if hand.wand.app.now["warnings"] != serde_json::json!([]) {
        bail!("there are warnings: {}", hand.wand.app.now["warnings"]);
    }
    println!("     pictures of both eyes are in {}", folder.display());
    quit(&mut hand.wand.app)
}

/// A line that was moved, made larger and heavier, an area, a horse, and what was erased.
fn as_painted(painted: Option<&Canvas>) -> Result<()> {
    let Some(canvas) = painted else {
        bail!("there is no painting");
    };
    let kinds: Vec<_> = canvas
        .strokes
        .iter()
        .map(|s| match &s.skeleton {
            Skeleton::Points(_) => "points",
            Skeleton::Line(..) => "line",
            Skeleton::Polygon(_) => "area",
            Skeleton::Volume(_) => "solid",
        })
        .collect();
    if kinds != ["line", "area", "solid", "points"] {
        bail!("the strokes are {kinds:?}");
    }
    let line = &canvas.strokes[0].placement;
    let sound = line.scale.x > 1.1 && line.translation.length() > 0.01 && canvas.strokes[3].erase;
    if !sound {
        bail!(
            "the strokes are not as they were changed: {:?}",
            canvas.strokes
        );
    }
    Ok(())
}

struct Painter<'a> {
    wand: Wand,
    /// Steps made so far.
    edits: u64,
    folder: &'a Path,
}

impl Painter<'_> {
    fn frames(&mut self, count: u64) -> Result<()> {
        self.wand.performer.frames(&mut self.wand.app, count)
    }

    fn go(&mut self, at: Vec3) -> Result<()> {
        let Wand { performer, app } = &mut self.wand;
        performer.go(app, Side::Right, Pose::at(at))?;
        performer.frames(app, 3)
    }

    fn press(&mut self, down: bool) -> Result<()> {
        let Wand { performer, app } = &mut self.wand;
        performer.press(app, Side::Right, Action::Act, down)?;
        performer.frames(app, 2)
    }

    fn alt(&mut self, down: bool) -> Result<()> {
        let Wand { performer, app } = &mut self.wand;
        performer.press(app, Side::Left, Action::Act, down)?;
        performer.frames(app, 3)
    }

    fn hold(&mut self, action: Action, frames: u64) -> Result<()> {
        let Wand { performer, app } = &mut self.wand;
        performer.press(app, Side::Right, action, true)?;
        performer.frames(app, frames)?;
        performer.press(app, Side::Right, action, false)?;
        performer.frames(app, 2)
    }

    fn tap(&mut self, action: Action) -> Result<()> {
        self.hold(action, 1)
    }

    /// Waits until one step more is made and shown.
    fn made(&mut self, what: &str) -> Result<()> {
        self.edits += 1;
        let edits = self.edits;
        self.wand
            .app
            .until(what, |now| now["edits"] == edits && now["busy"] == 0)?;
        self.frames(2)
    }

    fn picture(&mut self, name: &str) -> Result<()> {
        let file = self.folder.join(format!("{name}.png"));
        look(&mut self.wand.app, &file)
    }
}
