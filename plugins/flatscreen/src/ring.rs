//! The ring of modes on the screen: open while its button is held, letting go chooses.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use midair_studio::{
    carry::in_hands,
    command::Command,
    hands::{Action, Hands, Side},
    hold::Held,
    panel,
    tools::Tools,
};

use crate::bindings::{Control, Controls, Cursor};
use crate::panels::Screen;

/// Its radius, in points.
const RADIUS: f32 = 110.0;

/// What is chosen while it is open.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ring {
    open: bool,
    chosen: Option<usize>,
    /// Where the pointer was when it opened.
    from: Option<Vec2>,
}

impl Ring {
    /// Whether it is to be seen; sticks and pointer are its own then.
    pub fn is_open(&self) -> bool {
        self.open
    }
}

/// Stick, arrows, digits or the pointer choose.
pub(crate) fn turn(
    controls: Res<Controls>,
    (hands, held_things): (Res<Hands>, Res<Held>),
    cursor: Res<Cursor>,
    tools: Res<Tools>,
    mut ring: ResMut<Ring>,
    mut commands: MessageWriter<Command>,
) {
    let held = controls.pressed(Control::Modes)
        || Side::BOTH.iter().any(|&s| hands.get(s).held(Action::Modes));
    let cursor = cursor.at();
    let mut next = *ring;
    let count = tools.all().len();
    if held {
        if !ring.open {
            next = Ring {
                open: true,
                chosen: None,
                from: cursor,
            };
        }
        let stick = [Control::HandStick, Control::ViewStick]
            .map(|c| controls.stick(c))
            .into_iter()
            .chain(Side::BOTH.iter().filter_map(|&s| hands.get(s).swipe))
            .find_map(|s| panel::sector(s, count));
        let pointed = cursor.zip(next.from).and_then(|(at, from)| {
            let towards = (at - from) * Vec2::new(1.0, -1.0) / RADIUS;
            panel::sector(towards, count)
        });
        let arrows = [
            (Control::CrossUp, Vec2::Y),
            (Control::CrossRight, Vec2::X),
            (Control::CrossDown, Vec2::NEG_Y),
            (Control::CrossLeft, Vec2::NEG_X),
        ]
        .into_iter()
        .filter(|&(control, _)| controls.pressed(control))
        .map(|(_, along)| along)
        .sum::<Vec2>();
        let chosen = stick.or(panel::sector(arrows, count)).or(pointed);
        next.chosen = chosen.or(next.chosen);
    } else if ring.open {
        next = Ring::default();
        // A press of cancel takes the choice back.
        let meant = ring.chosen.filter(|_| !controls.pressed(Control::Cancel));
        if let Some(tool) = meant.and_then(|i| tools.all().get(i)) {
            // What a hand holds goes along.
            commands.write(if held_things.is_empty() {
                Command::Mode(tool.id.clone())
            } else {
                Command::Carry {
                    objects: in_hands(&held_things),
                    to: tool.id.clone(),
                }
            });
        }
    }
    ring.set_if_neq(next);
}

pub(crate) fn show(
    mut contexts: EguiContexts,
    screen: Res<Screen>,
    ring: Res<Ring>,
    tools: Res<Tools>,
) -> Result {
    let Some(view) = screen.view().filter(|_| ring.open) else {
        return Ok(());
    };
    let ctx = contexts.ctx_mut()?;
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::new("ring"));
    let middle = ring
        .from
        .map(|at| screen.point(at))
        .filter(|at| view.shrink(1.6 * RADIUS).contains(*at))
        .unwrap_or(view.center());
    let style = ctx.global_style();
    panel::ring(
        &ctx.layer_painter(layer),
        &style,
        middle,
        RADIUS,
        &tools,
        ring.chosen,
    );
    Ok(())
}
