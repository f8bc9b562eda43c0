//! Keys and gamepad move the focus, press, slide and leave.

use bevy::prelude::*;
use bevy_egui::{EguiClipboard, EguiContext, EguiInput, PrimaryEguiContext, egui};
use midair_studio::{
    command::Command,
    panel::{Dock, Panels, kit},
};

use super::{Focus, Spot, Typing, map};
use crate::bindings::{Attention, Control, Controls, Device};

/// Steps a second of a slider at full deflection of the stick.
const SLIDES: f32 = 30.0;

/// The primary context, its input before the pass begins.
type Primary<'w, 's> =
    Query<'w, 's, (&'static mut EguiContext, &'static mut EguiInput), With<PrimaryEguiContext>>;

pub(crate) fn drive(
    (controls, attention): (Res<Controls>, Res<Attention>),
    mouse: Res<ButtonInput<MouseButton>>,
    time: Res<Time>,
    panels: Res<Panels>,
    (mut focus, mut typing): (ResMut<Focus>, ResMut<Typing>),
    mut primary: Primary,
    mut clipboard: Option<ResMut<EguiClipboard>>,
    mut commands: MessageWriter<Command>,
) {
    let Ok((mut context, mut input)) = primary.single_mut() else {
        return;
    };
    if attention.rebinding {
        // The key is meant for the list alone.
        input
            .events
            .retain(|e| !matches!(e, egui::Event::Key { .. } | egui::Event::Text(_)));
        return;
    }
    let ctx = context.get_mut().clone();
    let focus = focus.bypass_change_detection();
    // The mouse says by itself where it works.
    if mouse.get_just_pressed().next().is_some() {
        focus.leave();
    }
    // What the gamepad has opened is what it works in next.
    let open: Vec<_> = panels
        .all()
        .iter()
        .map(|p| p.id)
        .filter(|id| panels.is_open(id))
        .collect();
    if controls.device() == Device::Pad
        && let Some(fresh) = open.iter().find(|id| !focus.open.contains(id))
    {
        focus.want(fresh);
    }
    focus.open = open;
    // A question is answered before anything else.
    let asked = panels.open_in(Dock::Modal).last().map(|p| p.id);
    if let Some(modal) = asked
        && focus
            .region()
            .is_none_or(|r| r.name != modal && r.name != "popup")
    {
        focus.want(modal);
    }
    if typing.open {
        typing.drive(&controls, focus, &mut input, || {
            clipboard.as_mut().and_then(|c| c.get_text())
        });
        return;
    }
    if controls.just_pressed(Control::PanelNext) {
        focus.enter(&ctx, 1);
        return;
    }
    if controls.just_pressed(Control::PanelPrevious) {
        focus.enter(&ctx, -1);
        return;
    }
    if !focus.inside {
        return;
    }
    for (control, by) in [(Control::PanelTabRight, 1), (Control::PanelTabLeft, -1)] {
        if controls.just_pressed(control) {
            // A panel with tabs turns them; from one without one goes to the next.
            let name = focus.region().map_or("", |r| r.name);
            if kit::turn(&ctx, name, by as i32) {
                focus.want(name);
            } else {
                focus.enter(&ctx, by);
            }
            return;
        }
    }
    if controls.just_pressed(Control::PanelLeave) {
        let by_pad = controls.device() == Device::Pad;
        focus.close(&mut input, by_pad, &mut commands);
        return;
    }
    focus.walk(&ctx, &mut input, &controls);
    if controls.just_pressed(Control::PanelPress) {
        if focus.is_text() {
            typing.begin();
            // What is typed takes the place of what stands there.
            input.events.push(egui::Event::Key {
                key: egui::Key::A,
                physical_key: None,
                pressed: true,
                repeat: false,
                modifiers: egui::Modifiers::CTRL | egui::Modifiers::COMMAND,
            });
            return;
        }
        for pressed in [true, false] {
            input.events.push(key(egui::Key::Enter, pressed));
        }
    }
    focus.slide(
        &mut input,
        controls.stick(Control::ViewStick).x,
        time.delta_secs(),
    );
}

impl Focus {
    /// Into the panels, or from one to the next or the one before.
    fn enter(&mut self, ctx: &egui::Context, by: isize) {
        if self.regions.is_empty() {
            return;
        }
        let count = self.regions.len() as isize;
        let now = self.regions.iter().position(|r| r.name == self.region);
        let to = match now {
            Some(now) if self.inside => (now as isize + by).rem_euclid(count),
            // Back to where one was, or to what was opened last.
            Some(now) => now as isize,
            None => count - 1,
        };
        let region = &self.regions[to as usize];
        let back = self
            .spot
            .filter(|_| !self.inside && now == Some(to as usize));
        let spot = back
            .and_then(|s| map::nearest(&region.spots, s.rect))
            .unwrap_or_else(|| region.first());
        self.region = region.name;
        self.inside = true;
        self.give(ctx, spot);
    }

    /// Out of a menu, out of a window (which closes), out of the panels.
    fn close(
        &mut self,
        input: &mut EguiInput,
        by_pad: bool,
        commands: &mut MessageWriter<Command>,
    ) {
        let Some(region) = self.region() else {
            self.leave();
            return;
        };
        if region.name == "popup" {
            for pressed in [true, false] {
                input.events.push(key(egui::Key::Escape, pressed));
            }
            self.region = "bar";
            return;
        }
        // On the gamepad what B leaves is out of the way; a column stays for the keyboard.
        if region.closes && (region.floats || by_pad) {
            commands.write(Command::Panel {
                id: region.name.to_owned(),
                open: false,
            });
        }
        self.leave();
    }

    /// One step within the panel, by the D-pad, or by the arrows where nothing else needs them.
    fn walk(&mut self, ctx: &egui::Context, input: &mut EguiInput, controls: &Controls) {
        let mut steps = Vec::new();
        for (control, along) in [
            (Control::PanelUp, egui::vec2(0.0, -1.0)),
            (Control::PanelRight, egui::vec2(1.0, 0.0)),
            (Control::PanelDown, egui::vec2(0.0, 1.0)),
            (Control::PanelLeft, egui::vec2(-1.0, 0.0)),
        ] {
            if controls.fired(control) {
                steps.push(along);
            }
        }
        let mut tabs = Vec::new();
        let (text, slider) = (self.is_text(), self.is_slider());
        input.events.retain(|event| {
            let egui::Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } = event
            else {
                return true;
            };
            if *key == egui::Key::Tab && !modifiers.command && !modifiers.alt {
                tabs.push(if modifiers.shift { -1 } else { 1 });
                return false;
            }
            let along = match key {
                egui::Key::ArrowUp if !slider || text => egui::vec2(0.0, -1.0),
                egui::Key::ArrowDown if !slider || text => egui::vec2(0.0, 1.0),
                egui::Key::ArrowRight if !text && !slider => egui::vec2(1.0, 0.0),
                egui::Key::ArrowLeft if !text && !slider => egui::vec2(-1.0, 0.0),
                _ => return true,
            };
            if modifiers.any() {
                return true;
            }
            steps.push(along);
            false
        });
        for by in tabs {
            if let Some(spot) = self.after(by) {
                self.give(ctx, spot);
                show(input, spot);
            }
        }
        for along in steps {
            let (Some(from), Some(region)) = (self.spot, self.region()) else {
                return;
            };
            if let Some(spot) = map::next(&region.spots, from.rect, along) {
                self.give(ctx, spot);
                show(input, spot);
            }
        }
    }

    /// The widget after or before the one that has the focus, through all panels and around; a menu
    /// keeps it.
    fn after(&self, by: isize) -> Option<Spot> {
        let only = self.region().filter(|r| r.name == "popup");
        let spots: Vec<_> = match only {
            Some(region) => region.spots.clone(),
            None => self.regions.iter().flat_map(|r| r.spots.clone()).collect(),
        };
        let now = spots
            .iter()
            .position(|s| Some(s.id) == self.spot.map(|s| s.id))?;
        let to = (now as isize + by).rem_euclid(spots.len() as isize);
        spots.get(to as usize).copied()
    }

    /// The stick moves what slides.
    fn slide(&mut self, input: &mut EguiInput, deflection: f32, dt: f32) {
        if !self.is_slider() || deflection == 0.0 {
            self.slid = 0.0;
            return;
        }
        self.slid += deflection * deflection.abs() * SLIDES * dt;
        let arrow = if self.slid > 0.0 {
            egui::Key::ArrowRight
        } else {
            egui::Key::ArrowLeft
        };
        while self.slid.abs() >= 1.0 {
            self.slid -= self.slid.signum();
            input.events.push(key(arrow, true));
        }
    }
}

pub(super) fn key(key: egui::Key, pressed: bool) -> egui::Event {
    egui::Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: egui::Modifiers::NONE,
    }
}

/// Lists scroll to what has the focus.
fn show(input: &mut EguiInput, spot: Spot) {
    use egui::accesskit::{Action, ActionRequest, TreeId};
    input
        .events
        .push(egui::Event::AccessKitActionRequest(ActionRequest {
            action: Action::ScrollIntoView,
            target_tree: TreeId::ROOT,
            target_node: spot.id.accesskit_id(),
            data: None,
        }));
}
