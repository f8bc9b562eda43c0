//! Pictures of what both eyes see, for somebody to look at: panels and model, the keys, the ring, names of buttons, the vignette.
//! Checked by itself is that the eyes are two and stand as eyes do.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use bevy::math::{Quat, Vec3};
use image::GrayImage;
use midair_studio::command::{Command, Dialog};
use midair_studio::hands::{Action, Pose, Side};

use crate::life::{focus, quit};
use crate::perform::Performer;
use crate::stage::{App, Runtime, midair};

/// Pixels of an eye along an edge, as a multiple of what this runtime asks for: 320 x 240.
const SHARPNESS: f32 = 2.5;

/// Where the hands are held, left and right.
fn held() -> [Pose; 2] {
    let left = Pose {
        position: Vec3::new(-0.20, 1.08, 0.3),
        rotation: Quat::from_rotation_y(-0.2),
    };
    let right = Pose {
        position: Vec3::new(0.06, 1.12, 0.28),
        rotation: Quat::from_rotation_y(0.4) * Quat::from_rotation_x(0.1),
    };
    [left, right]
}

/// Somebody in the headset, before the chair, both hands held.
fn worn(
    folder: &Path,
    comfort: &str,
    environment: &[(&str, &str)],
) -> Result<(Runtime, Performer, App)> {
    let chair = folder.join("chair.midair").display().to_string();
    midair(&["play", "/job/assets/sessions/chair.ron", "--save", &chair])?;
    let config = folder.join("home/config");
    fs::create_dir_all(&config)?;
    fs::write(
        config.join("settings.ron"),
        format!("(comfort: (sharpness: {SHARPNESS:?}, {comfort}))"),
    )?;
    let runtime = Runtime::remote()?;
    let mut performer = Performer::new()?;
    performer.rig.head = Pose {
        position: Vec3::new(0.0, 1.45, 0.75),
        rotation: Quat::from_rotation_x(-0.35),
    };
    performer.rig.send()?;
    let mut app = App::start_with(folder, &["--vr", &chair], environment)?;
    focus(&mut app)?;
    for (side, pose) in Side::BOTH.into_iter().zip(held()) {
        performer.go(&mut app, side, pose)?;
    }
    panel(&mut app, "tutorial", false)?;
    app.until("the chair is drawn", |now| now["busy"] == 0)?;
    Ok((runtime, performer, app))
}

fn panel(app: &mut App, id: &str, open: bool) -> Result<()> {
    app.ask(&Command::Panel {
        id: id.to_owned(),
        open,
    })
}

/// What stands on the desk meanwhile: the window as a mirror and as a spectator sees it; and what the eyes see in the white room,
/// with the left hand leading, and while the world turns in steps and is moved.
pub fn desk(folder: &Path) -> Result<()> {
    let _display = crate::stage::display()?;
    let (_runtime, mut performer, mut app) = worn(folder, "snap_turn: 30.0", &[("DISPLAY", ":7")])?;
    panel(&mut app, "library", true)?;
    performer.frames(&mut app, 16)?;
    let set = |app: &mut App, key: &str, value: &str| {
        app.ask(&Command::Set {
            key: key.to_owned(),
            value: value.to_owned(),
        })
    };
    for (value, name) in [("Mirror", "mirror.png"), ("Spectator", "spectator.png")] {
        set(&mut app, "comfort.desktop", &format!("\"{value}\""))?;
        performer.frames(&mut app, 8)?;
        let seen = written(&app);
        app.say(&format!("window {}", folder.join(name).display()))?;
        app.until("a picture of the window", |now| now["eyes"] == seen + 1)?;
    }
    let [mirror, spectator] = ["mirror.png", "spectator.png"].map(|name| {
        let path = folder.join(name);
        image::open(&path).with_context(|| path.display().to_string())
    });
    let apart = unlikeness(&mirror?.to_luma8(), &spectator?.to_luma8(), 0);
    if apart < 1000 {
        bail!("mirror and spectator see the same: {apart}");
    }
    set(&mut app, "look.room", "\"Paper\"")?;
    performer.frames(&mut app, 8)?;
    look(&mut app, &folder.join("paper.png"))?;
    set(&mut app, "look.room", "\"Dusk\"")?;
    set(&mut app, "hands.left_handed", "true")?;
    performer.frames(&mut app, 8)?;
    look(&mut app, &folder.join("left-handed.png"))?;
    set(&mut app, "hands.left_handed", "false")?;
    panel(&mut app, "library", false)?;

    // A grip on nothing and a push of the stick, again and again: some of the pictures are of the frame of a turn.
    let air = Pose::at(Vec3::new(0.25, 1.0, 0.45));
    performer.go(&mut app, Side::Right, air)?;
    performer.frames(&mut app, 4)?;
    performer.press(&mut app, Side::Right, Action::Grab, true)?;
    for i in 0..3 {
        let seen = written(&app);
        app.say(&format!(
            "eyes {}",
            folder.join(format!("turn-{i}.png")).display()
        ))?;
        for step in 0..60 {
            let hand = &mut performer.rig.hands[1];
            let pushed = step % 2 == 0;
            (hand.pad_touch, hand.pad.x) = (pushed, if pushed { 1.0 } else { 0.0 });
            performer.rig.send()?;
            performer.frames(&mut app, 1)?;
            if written(&app) > seen {
                break;
            }
        }
    }
    // Nothing of the window's is drawn in an eye: above both there is air.
    let turned = image::open(folder.join("turn-0.png"))
        .context("turn-0.png")?
        .to_luma8();
    let width = turned.width() / 2;
    let above = |x| image::imageops::crop_imm(&turned, x, 0, width, 40).to_image();
    let apart = unlikeness(&above(0), &above(width), 0);
    if apart > 4000 {
        bail!("the eyes do not see the same air: {apart}");
    }
    let hand = &mut performer.rig.hands[1];
    (hand.pad_touch, hand.pad.x, hand.squeeze) = (false, 0.0, 0.0);
    performer.rig.send()?;
    performer.frames(&mut app, 4)?;
    println!("     pictures are in {}", folder.display());
    quit(&mut app)
}

/// Takes them all.
pub fn looks(folder: &Path) -> Result<()> {
    let (_runtime, mut performer, mut app) = worn(folder, "budget: true", &[])?;
    let [_, right] = held();
    panel(&mut app, "library", true)?;
    performer.frames(&mut app, 16)?;
    // As somebody looks who looks at it: the library is at the side of the hand that does not lead.
    performer.rig.head.rotation = Quat::from_rotation_y(0.35) * Quat::from_rotation_x(-0.3);
    performer.rig.send()?;
    performer.frames(&mut app, 4)?;
    let eyes = folder.join("eyes.png");
    look(&mut app, &eyes)?;
    stereo(&eyes)?;
    performer.rig.head.rotation = Quat::from_rotation_x(-0.35);
    performer.rig.send()?;

    // The ring of modes at the right hand, pushed towards one.
    panel(&mut app, "library", false)?;
    performer.press(&mut app, Side::Right, Action::Menu, true)?;
    performer.frames(&mut app, 14)?;
    let pushed = Pose {
        position: right.position + Vec3::new(0.06, 0.02, 0.0),
        ..right
    };
    performer.go(&mut app, Side::Right, pushed)?;
    performer.frames(&mut app, 4)?;
    look(&mut app, &folder.join("ring.png"))?;
    performer.go(&mut app, Side::Right, right)?;
    performer.press(&mut app, Side::Right, Action::Menu, false)?;

    // A controller near the face names its buttons.
    let near = Pose {
        position: Vec3::new(0.05, 1.33, 0.42),
        rotation: Quat::from_rotation_x(0.9),
    };
    performer.go(&mut app, Side::Right, near)?;
    performer.frames(&mut app, 6)?;
    look(&mut app, &folder.join("labels.png"))?;
    performer.go(&mut app, Side::Right, right)?;

    // Settings, where they are read.
    panel(&mut app, "settings", true)?;
    performer.frames(&mut app, 8)?;
    look(&mut app, &folder.join("settings.png"))?;
    panel(&mut app, "settings", false)?;

    // Both hands pull at the world: it is darker at the edge, and how large the world is stands between them.
    for (side, x) in [(Side::Left, -0.25), (Side::Right, 0.25)] {
        performer.go(&mut app, side, Pose::at(Vec3::new(x, 0.95, 0.45)))?;
    }
    for side in Side::BOTH {
        performer.press(&mut app, side, Action::Grab, true)?;
    }
    let seen = written(&app);
    app.say(&format!("eyes {}", folder.join("world.png").display()))?;
    for step in 0..200_u8 {
        let apart = 0.25 + 0.002 * f32::from(step);
        for (side, x) in [(Side::Left, -apart), (Side::Right, apart)] {
            performer.rig.hands[side as usize].pose = Pose::at(Vec3::new(x, 0.95, 0.45));
        }
        performer.rig.send()?;
        performer.frames(&mut app, 1)?;
        if written(&app) > seen {
            break;
        }
    }
    for side in Side::BOTH {
        performer.rig.hands[side as usize].squeeze = 0.0;
    }
    performer.rig.send()?;
    // A file's name, and the keys below.
    performer.frames(&mut app, 4)?;
    app.ask(&Command::Dialog(Dialog::SaveAs))?;
    performer.frames(&mut app, 8)?;
    look(&mut app, &folder.join("files.png"))?;
    println!("     pictures of both eyes are in {}", folder.display());
    quit(&mut app)
}

fn written(app: &App) -> u64 {
    app.now["eyes"].as_u64().unwrap_or(0)
}

/// What both eyes see, as a file.
pub fn look(app: &mut App, file: &Path) -> Result<()> {
    let seen = written(app);
    app.say(&format!("eyes {}", file.display()))?;
    app.until("a picture of both eyes", |now| now["eyes"] == seen + 1)?;
    Ok(())
}

/// The right eye sees what the left one sees farther to the left: by how much at best, as a share of the width.
fn stereo(file: &Path) -> Result<()> {
    let both = image::open(file)
        .with_context(|| file.display().to_string())?
        .to_luma8();
    let (width, height) = (both.width() / 2, both.height());
    let cut = |x| image::imageops::crop_imm(&both, x, 0, width, height).to_image();
    let (left, right) = (cut(0), cut(width));
    let unlike = |shift: i32| unlikeness(&left, &right, shift);
    let most = width as i32 / 6;
    let best = (-most..=most)
        .min_by_key(|&shift| unlike(shift))
        .unwrap_or(0);
    let share = 100.0 * f64::from(best) / f64::from(width);
    println!(
        "     what is before the eyes lies {share:.1} % of the width farther left in the right one"
    );
    if best <= 0 || unlike(0) <= unlike(best) {
        bail!("the eyes do not stand as eyes do: {best} pixels of {width}");
    }
    Ok(())
}

/// How unlike both are where the right one is taken from `shift` pixels farther left: the mean difference of every fourth pixel.
fn unlikeness(left: &GrayImage, right: &GrayImage, shift: i32) -> u64 {
    let (mut sum, mut count) = (0, 0);
    for y in (0..left.height()).step_by(4) {
        for x in (0..left.width()).step_by(4) {
            let Some(other) = x.checked_add_signed(-shift) else {
                continue;
            };
            if other >= right.width() {
                continue;
            }
            let (a, b) = (left.get_pixel(x, y).0[0], right.get_pixel(other, y).0[0]);
            sum += u64::from(a.abs_diff(b));
            count += 1;
        }
    }
    sum * 1000 / u64::max(count, 1)
}
