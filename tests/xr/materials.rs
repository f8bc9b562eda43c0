//! What things are made of, with the headset on: chosen with the wand on the panels, for a painting and for a solid of another
//! mode; looked at by both eyes at two times, which have to see one surface that moves.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use bevy::math::{Quat, Vec3};
use image::RgbImage;
use midair_studio::command::Command;
use midair_studio::hands::{Action, Pose, Side};
use midair_studio::panel::icon;

use crate::life::{focus, quit};
use crate::looks::look;
use crate::perform::Performer;
use crate::room::{TUTORIAL, WRIST, Wand};
use crate::stage::{App, Runtime, midair};

const BRUSH: &str = "Panel(\"brush\")";
const PROPERTIES: &str = "Panel(\"properties\")";
/// Where the solid stands, and the ends of the line that is painted beside it.
const SOLID: Vec3 = Vec3::new(0.2, 0.86, -0.12);
const LINE: [Vec3; 2] = [Vec3::new(-0.15, 0.86, 0.02), Vec3::new(0.04, 0.98, 0.02)];
/// What of an eye's picture is looked at, as shares of it: the things and the ground around them.
const ACROSS: [f32; 2] = [0.34, 0.84];
const DOWN: [f32; 2] = [0.48, 0.82];
/// Of three times 255: so much a pixel has to change to have moved.
const MOVES: i32 = 24;

/// Jelly for a painting and Aurora for a solid. The document has both, and both eyes see what moves at one time.
pub fn materials(folder: &Path) -> Result<()> {
    let file = |name: &str| folder.join(name).display().to_string();
    let (session, solid) = (file("solid.ron"), file("solid.midair"));
    fs::write(
        &session,
        format!(
            "(format: 1, steps: [Click(Right, Library), Wait(0.3), Move(hand: Right, to: ({}, {}, {})), \
             Ask(Place(component: \"solid/egg\", side: Right)), Ask(Objects(SelectNone)), Wait(0.3)])",
            SOLID.x, SOLID.y, SOLID.z
        ),
    )?;
    midair(&["play", &session, "--save", &solid])?;
    let config = folder.join("home/config");
    fs::create_dir_all(&config)?;
    fs::write(config.join("settings.ron"), "(comfort: (sharpness: 2.5))")?;
    let _runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    performer.rig.head = ahead();
    performer.rig.send()?;
    let mut app = App::start(folder, &["--vr", &solid])?;
    focus(&mut app)?;
    app.say("boards")?;
    performer.go(&mut app, Side::Left, Pose::at(Vec3::new(-0.27, 1.12, 0.25)))?;
    performer.go(&mut app, Side::Right, aside())?;
    let mut wand = Wand { performer, app };
    wand.opened(TUTORIAL)?;
    wand.click(TUTORIAL, icon::X)?;

    // A line, dragged, and what it is made of from the panel of its mode.
    wand.click(WRIST, "Brush")?;
    wand.opened(BRUSH)?;
    wand.click(BRUSH, icon::LINE_SEGMENT)?;
    paint(&mut wand, &folder.join("painting.png"))?;
    wand.scrolled(BRUSH, "Radius", "Jelly")?;
    wand.click(BRUSH, "Jelly")?;
    towards(&mut wand, -0.5, &folder.join("brush-panel.png"))?;
    let jelly = twice(&mut wand, folder, "jelly")?;

    // A solid, selected where solids are put together, and its panel.
    wand.click(WRIST, "Assemble")?;
    let Wand { performer, app } = &mut wand;
    performer.go(app, Side::Right, Pose::at(SOLID))?;
    performer.frames(app, 2)?;
    performer.press(app, Side::Right, Action::Act, true)?;
    performer.press(app, Side::Right, Action::Act, false)?;
    app.until("the solid is selected", |now| now["selected"] == 1)?;
    wand.click(WRIST, icon::SLIDERS_HORIZONTAL)?;
    wand.opened(PROPERTIES)?;
    wand.scrolled(PROPERTIES, "Size", "Aurora")?;
    wand.click(PROPERTIES, "Aurora")?;
    towards(&mut wand, -0.5, &folder.join("properties-panel.png"))?;
    let aurora = twice(&mut wand, folder, "aurora")?;

    let saved = folder.join("made.midair");
    wand.app.ask(&Command::SaveAs(saved.clone()))?;
    wand.app.until("it is saved", |now| {
        now["busy"] == 0 && fs::metadata(&saved).is_ok()
    })?;
    let document = midair_document::open(&saved)?.document;
    let made: Vec<_> = document
        .objects()
        .map(|(_, o)| o.material.as_deref())
        .collect();
    if made != [Some("aurora"), Some("jelly")] {
        bail!("the document says that they are made of {made:?}");
    }
    one_surface("jelly", &jelly)?;
    one_surface("aurora", &aurora)?;
    // The line around what is selected, as wide as before.
    for (eye, time) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let marked = part(&jelly[time], eye)
            .pixels()
            .filter(|p| {
                let [r, g, b] = p.0.map(i32::from);
                b > r + 40 && r > g + 10
            })
            .count();
        if !(150..4000).contains(&marked) {
            bail!("{marked} pixels mark the selected painting in eye {eye} at time {time}");
        }
    }
    println!("     pictures of both eyes are in {}", folder.display());
    quit(&mut wand.app)
}

/// The head of somebody who looks at the work.
fn ahead() -> Pose {
    Pose {
        position: Vec3::new(0.0, 1.45, 0.65),
        rotation: Quat::from_rotation_x(-0.45),
    }
}

/// Where the right hand is out of the way.
fn aside() -> Pose {
    Pose::at(Vec3::new(0.45, 1.0, 0.45))
}

/// Paints the line; half way a picture of it is taken.
fn paint(wand: &mut Wand, file: &Path) -> Result<()> {
    let Wand { performer, app } = wand;
    performer.go(app, Side::Right, Pose::at(LINE[0]))?;
    performer.frames(app, 2)?;
    performer.press(app, Side::Right, Action::Act, true)?;
    performer.go(app, Side::Right, Pose::at(LINE[1]))?;
    performer.frames(app, 6)?;
    look(app, file)?;
    performer.press(app, Side::Right, Action::Act, false)?;
    app.until("it is painted", |now| {
        now["objects"] == 2 && now["busy"] == 0
    })?;
    Ok(())
}

/// A picture of what lies to a side, radians to the left.
fn towards(wand: &mut Wand, yaw: f32, file: &Path) -> Result<()> {
    let Wand { performer, app } = wand;
    performer.go(app, Side::Right, aside())?;
    performer.rig.head.rotation = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(-0.2);
    performer.rig.send()?;
    performer.frames(app, 4)?;
    look(app, file)?;
    performer.rig.head = ahead();
    performer.rig.send()?;
    performer.frames(app, 4)
}

/// What both eyes see at two times.
fn twice(wand: &mut Wand, folder: &Path, name: &str) -> Result<[RgbImage; 2]> {
    let mut taken = Vec::new();
    for time in 1..=2 {
        let path = folder.join(format!("{name}-{time}.png"));
        look(&mut wand.app, &path)?;
        let image = image::open(&path).with_context(|| path.display().to_string())?;
        taken.push(image.to_rgb8());
        wand.performer.frames(&mut wand.app, 3)?;
    }
    taken
        .try_into()
        .map_err(|_| anyhow::anyhow!("two pictures"))
}

/// The part of an eye's picture that is looked at.
fn part(both: &RgbImage, eye: u32) -> RgbImage {
    let (width, height) = (both.width() as f32 / 2.0, both.height() as f32);
    let [x, y] = [ACROSS[0] * width, DOWN[0] * height].map(|v| v as u32);
    let across = ((ACROSS[1] - ACROSS[0]) * width) as u32;
    let down = ((DOWN[1] - DOWN[0]) * height) as u32;
    image::imageops::crop_imm(both, x + eye * both.width() / 2, y, across, down).to_image()
}

fn unlike(a: &RgbImage, b: &RgbImage, (x, y): (u32, u32), shift: u32) -> Option<i32> {
    let (a, b) = (a.get_pixel(x, y).0, b.get_pixel(x.checked_sub(shift)?, y).0);
    Some(
        (0..3)
            .map(|i| (i32::from(a[i]) - i32::from(b[i])).abs())
            .sum(),
    )
}

/// What moves is seen by both eyes, each time at one time: they are more alike then than across the times. Nothing is black.
fn one_surface(name: &str, taken: &[RgbImage; 2]) -> Result<()> {
    let eyes: [[RgbImage; 2]; 2] = [0, 1].map(|eye| [part(&taken[0], eye), part(&taken[1], eye)]);
    let [left, right] = &eyes;
    let places = |eye: &[RgbImage; 2]| -> Vec<(u32, u32)> {
        let all = (0..eye[0].height()).flat_map(|y| (0..eye[0].width()).map(move |x| (x, y)));
        let moved = |at| unlike(&eye[0], &eye[1], at, 0).is_some_and(|d| d > MOVES);
        all.filter(|at| moved(*at)).collect()
    };
    let moved = places(left);
    let also = places(right).len();
    let mean = |a: &RgbImage, b: &RgbImage, shift| {
        let all: Vec<i32> = moved
            .iter()
            .filter_map(|at| unlike(a, b, *at, shift))
            .collect();
        f64::from(all.iter().sum::<i32>()) / all.len().max(1) as f64
    };
    let same = |shift| mean(&left[0], &right[0], shift) + mean(&left[1], &right[1], shift);
    let across = |shift| mean(&left[0], &right[1], shift) + mean(&left[1], &right[0], shift);
    let most = left[0].width() / 4;
    let shift = (0..most)
        .min_by(|a, b| same(*a).total_cmp(&same(*b)))
        .unwrap_or(0);
    println!(
        "     {name}: {} and {also} pixels move; {shift} pixels apart both eyes differ by {:.0} at one time, by {:.0} across two",
        moved.len(),
        same(shift),
        across(shift)
    );
    if moved.len() < 200 || also < 200 {
        bail!("{name} does not move in both eyes");
    }
    if shift == 0 || across(shift) < 1.3 * same(shift) {
        bail!("{name} is not one surface in both eyes");
    }
    let black = eyes.iter().flatten().flat_map(|eye| eye.pixels());
    let black = black.filter(|p| p.0.iter().all(|c| *c < 6)).count();
    if black > 20 {
        bail!("{name}: {black} pixels are black");
    }
    Ok(())
}
