//! Signs beside operands, and the hands.

use bevy::color::ColorToPacked;
use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use midair_studio::{
    hands::{Action, Hands, Side},
    panel::{ACCENT, Palette},
    project::{Project, Shelf},
    show::{Cues, ObjectMap, Readouts},
    tools::{HintKey, Hints, Tools},
};

use crate::bindings::{Bindings, Controls};
use crate::gamepad::Pad;
use crate::keys::key_name;
use crate::orbit::Orbit;
use crate::panels::Screen;
use crate::pointer::Pointer;

/// Each operand carries its place and its sign, since colour alone is no cue for everyone.
pub(crate) fn objects(
    mut contexts: EguiContexts,
    cues: Res<Cues>,
    map: Res<ObjectMap>,
    transforms: Query<&GlobalTransform>,
    camera: Single<(&Camera, &GlobalTransform), With<Orbit>>,
    screen: Res<Screen>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let (camera, eye) = *camera;
    let Some(view) = screen.view() else {
        return Ok(());
    };
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let palette = Palette::of(&ctx.global_style().visuals);
    for (&id, cue) in &cues.0 {
        let Some(label) = &cue.label else { continue };
        let Some(at) = map.get(id).and_then(|e| transforms.get(e).ok()) else {
            continue;
        };
        let Ok(at) = camera.world_to_viewport(eye, at.translation()) else {
            continue;
        };
        let galley = painter.layout_no_wrap(
            label.clone(),
            egui::FontId::proportional(16.0),
            palette.text,
        );
        let rect =
            egui::Rect::from_center_size(screen.point(at), galley.size() + egui::vec2(16.0, 8.0));
        let [r, g, b, _] = cue.tint.colour().to_srgba().to_u8_array();
        painter.rect_filled(rect, 6.0, backing(&palette));
        painter.rect_stroke(
            rect,
            6.0,
            egui::Stroke::new(1.5, egui::Color32::from_rgb(r, g, b)),
            egui::StrokeKind::Inside,
        );
        painter.galley(rect.center() - 0.5 * galley.size(), galley, palette.text);
    }
    Ok(())
}

/// What brings a rectangle into the view, where it is to be read whole.
fn into(view: egui::Rect, rect: egui::Rect) -> egui::Vec2 {
    let by = |low: f32, high: f32, least: f32, most: f32| {
        (least - low).max(0.0) + (most - high).min(0.0)
    };
    egui::vec2(
        by(rect.left(), rect.right(), view.left(), view.right()),
        by(rect.top(), rect.bottom(), view.top(), view.bottom()),
    )
}

/// Behind words over the view: a panel's colour, nearly closed, so that they read in every room.
fn backing(palette: &Palette) -> egui::Color32 {
    palette.panel.gamma_multiply(0.92)
}

/// An empty room says how one begins: in large words what the mode's first button does now.
pub(crate) fn empty(
    mut contexts: EguiContexts,
    project: Res<Project>,
    shelf: Res<Shelf>,
    (tools, hints, hands): (Res<Tools>, Res<Hints>, Res<Hands>),
    screen: Res<Screen>,
    (controls, bindings): (Res<Controls>, Res<Bindings>),
) -> Result {
    let ctx = contexts.ctx_mut()?;
    // While something is drawn it is looked at, and not read.
    let acts = Side::BOTH
        .into_iter()
        .any(|side| hands.get(side).held(Action::Act));
    let Some(view) = screen
        .view()
        .filter(|_| project.document().objects().next().is_none() && !acts)
    else {
        return Ok(());
    };
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let named = |action| key_name(action, &bindings, controls.device());
    let (first, second) = begins(&hints, &tools, shelf.open, named);
    let at = egui::pos2(view.center().x, view.top() + 0.3 * view.height());
    let palette = Palette::of(&ctx.global_style().visuals);
    for (text, size, down, colour) in [
        (first.as_str(), 24.0, 0.0, palette.text),
        (second, 15.0, 32.0, palette.weak),
    ] {
        painter.text(
            at + egui::vec2(0.0, down),
            egui::Align2::CENTER_CENTER,
            text,
            egui::FontId::proportional(size),
            colour,
        );
    }
    Ok(())
}

/// What one begins with in this mode, and what else there is to it.
fn begins(
    hints: &Hints,
    tools: &Tools,
    library: bool,
    named: impl Fn(Action) -> String,
) -> (String, &'static str) {
    const DROP: &str = "or drop a mesh or a document here";
    let first = hints.buttons.first();
    let draws = first.filter(|h| h.action == HintKey::Action(Action::Act));
    if let (Some(hint), Some(tool)) = (draws, tools.active()) {
        // Pressing is not all of it: what it draws is dragged.
        let button = match named(Action::Act) {
            click if click == "click" => "left button".to_owned(),
            other => other,
        };
        let text = format!("{button}: {}", hint.does);
        let mut letters = text.chars();
        let first = letters.next().into_iter().flat_map(char::to_uppercase);
        return (first.chain(letters).collect(), tool.about);
    }
    if library {
        return ("Pick a shape to begin".to_owned(), DROP);
    }
    let key = named(Action::Library);
    (format!("Press {key} for the library"), DROP)
}

/// A dot at each hand; what lies below it is the studio's to show.
pub(crate) fn hands(
    mut contexts: EguiContexts,
    hands: Res<Hands>,
    (pointer, pad): (Res<Pointer>, Res<Pad>),
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    screen: Res<Screen>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let Some(view) = screen.view() else {
        return Ok(());
    };
    let (camera, eye) = camera.into_inner();
    let eye = GlobalTransform::from(*eye);
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    for side in Side::BOTH {
        let (leading, latched) = if pad.leads() {
            (pad.leading(), pad.is_latched(side))
        } else {
            (pointer.leading, pointer.is_latched(side))
        };
        let leads = side == leading;
        if !leads && !latched && !pointer.stretching {
            continue;
        }
        let tip = hands.get(side).pose.position;
        let Ok(at) = camera.world_to_viewport(&eye, tip) else {
            continue;
        };
        // A gamepad has no pointer of its own: its hand is easier to find.
        let radius = if pad.leads() { 6.0 } else { 3.5 };
        let fill = if leads {
            ACCENT
        } else {
            egui::Color32::from_gray(0xc8)
        };
        let at = screen.point(at);
        painter.circle_filled(at, radius + 1.5, egui::Color32::from_black_alpha(110));
        painter.circle(
            at,
            radius,
            fill,
            egui::Stroke::new(1.0, egui::Color32::WHITE),
        );
    }
    Ok(())
}

/// Lengths, angles and scales beside what they are about.
pub(crate) fn readouts(
    mut contexts: EguiContexts,
    readouts: Res<Readouts>,
    camera: Single<(&Camera, &Transform), With<Orbit>>,
    screen: Res<Screen>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let (camera, eye) = camera.into_inner();
    let Some(view) = screen.view() else {
        return Ok(());
    };
    let painter = ctx
        .layer_painter(egui::LayerId::background())
        .with_clip_rect(view);
    let palette = Palette::of(&ctx.global_style().visuals);
    let mut taken: Vec<egui::Rect> = Vec::new();
    for readout in &readouts.0 {
        let eye = GlobalTransform::from(*eye);
        let Ok(at) = camera.world_to_viewport(&eye, readout.at) else {
            continue;
        };
        let galley = painter.layout_no_wrap(
            readout.text.clone(),
            egui::FontId::proportional(14.0),
            palette.text,
        );
        let size = galley.size() + egui::vec2(12.0, 6.0);
        let below = screen.point(at) + egui::vec2(0.0, 24.0);
        let mut rect = egui::Rect::from_center_size(below, size);
        // One below the other where they would lie upon each other.
        while let Some(other) = taken.iter().find(|r| r.intersects(rect)) {
            rect = rect.translate(egui::vec2(0.0, other.bottom() - rect.top() + 2.0));
        }
        if view.contains(screen.point(at)) {
            rect = rect.translate(into(view, rect));
        }
        taken.push(rect);
        painter.rect_filled(rect, 4.0, backing(&palette));
        painter.galley(rect.center() - 0.5 * galley.size(), galley, palette.text);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use midair_studio::tools::{AddTool, Tool, ToolId};

    #[test]
    fn what_is_read_lies_in_the_view() {
        let view = egui::Rect::from_min_max(egui::pos2(0.0, 50.0), egui::pos2(1000.0, 670.0));
        let below = egui::Rect::from_center_size(egui::pos2(260.0, 667.0), egui::vec2(180.0, 24.0));
        let moved = below.translate(into(view, below));
        assert!(view.contains_rect(moved), "{moved:?}");
        assert_eq!(moved.center().x, below.center().x);
        let inside = below.translate(egui::vec2(0.0, -200.0));
        assert_eq!(into(view, inside), egui::Vec2::ZERO);
    }

    #[test]
    fn an_empty_room_says_what_the_mode_begins_with() {
        let named = |action| match action {
            Action::Act => "click".to_owned(),
            _ => "L".to_owned(),
        };
        let tools = Tools::default();
        let mut hints = Hints::default();
        hints.begin("Assemble").say(Action::Library, "library");
        let (first, _) = begins(&hints, &tools, false, named);
        assert_eq!(first, "Press L for the library");
        let (first, _) = begins(&hints, &tools, true, named);
        assert_eq!(first, "Pick a shape to begin");
        // Where the first button draws: what it is called here, and what the mode is about.
        let mut app = App::new();
        app.add_tool(Tool {
            id: ToolId::new("chalk"),
            name: "Chalk",
            about: "draws on what is there",
            order: 0,
        });
        let tools = app.world().resource::<Tools>();
        hints.begin("Chalk").say(Action::Act, "draw a line");
        let (first, second) = begins(&hints, tools, false, named);
        assert_eq!(first, "Left button: draw a line");
        assert_eq!(second, "draws on what is there");
        let (first, _) = begins(&hints, tools, false, |_| "RT".to_owned());
        assert_eq!(first, "RT: draw a line");
        let (first, _) = begins(&hints, tools, true, named);
        assert_eq!(
            first, "Left button: draw a line",
            "the library is no beginning there"
        );
    }
}
