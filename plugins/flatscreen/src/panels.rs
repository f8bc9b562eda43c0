//! The panels on screen.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, egui};
use midair_studio::{
    command::{Command, Errands},
    evaluate::Evaluations,
    notice::Notices,
    panel::{self, Bar},
    project::{Project, Recoverables, Shelf},
    tools::{Hints, Tools},
};

use crate::keys::key_name;
use crate::pointer::Pointer;

/// What is being typed and dragged in panels.
#[derive(Resource, Default)]
pub(crate) struct Screen {
    bar: Bar,
    styled: bool,
}

pub(crate) fn style(mut contexts: EguiContexts, mut screen: ResMut<Screen>) -> Result {
    if !screen.styled {
        panel::apply_style(contexts.ctx_mut()?);
        screen.styled = true;
    }
    Ok(())
}

pub(crate) fn show(
    mut contexts: EguiContexts,
    mut screen: ResMut<Screen>,
    project: Res<Project>,
    tools: Res<Tools>,
    hints: Res<Hints>,
    mut shelf: ResMut<Shelf>,
    left_behind: Res<Recoverables>,
    errands: Res<Errands>,
    evaluations: Res<Evaluations>,
    notices: Res<Notices>,
    pointer: Res<Pointer>,
    mut commands: MessageWriter<Command>,
) -> Result {
    let ctx = contexts.ctx_mut()?;
    let mut asks = Vec::new();
    let mut root = egui::Ui::new(
        ctx.clone(),
        "root".into(),
        egui::UiBuilder::new()
            .layer_id(egui::LayerId::background())
            .max_rect(ctx.viewport_rect()),
    );
    egui::Panel::top("bar").show(&mut root, |ui| {
        ui.add_space(6.0);
        asks.extend(panel::bar(
            ui,
            &mut screen.bar,
            &project,
            &tools,
            &shelf,
            &left_behind,
            &errands,
        ));
        ui.add_space(4.0);
    });
    egui::Panel::bottom("hints").show(&mut root, |ui| {
        ui.add_space(4.0);
        panel::operands(ui, project.document());
        panel::hints(ui, &hints, key_name);
        ui.add_space(4.0);
    });
    if shelf.open {
        // Away from where the leading hand works.
        let mut query = shelf.query.clone();
        egui::Panel::left("library")
            .resizable(true)
            .default_size(250.0)
            .show(&mut root, |ui| {
                ui.add_space(8.0);
                ui.horizontal(|ui| {
                    ui.heading("Library");
                    ui.weak("L");
                });
                asks.extend(panel::library(ui, &shelf, &mut query, pointer.leading));
            });
        if shelf.query != query {
            shelf.query = query;
        }
    }
    let corner = egui::Area::new("notices".into())
        .anchor(egui::Align2::RIGHT_BOTTOM, [-16.0, -64.0])
        .interactable(false);
    corner.show(ctx, |ui| {
        let busy = evaluations.outstanding();
        let any = notices.recent(8.0).next().is_some();
        if any || busy > 0 {
            egui::Frame::window(ui.style()).show(ui, |ui| {
                ui.set_max_width(420.0);
                panel::notices(ui, &notices);
                if busy > 0 {
                    ui.horizontal(|ui| {
                        ui.spinner();
                        ui.label(format!("Making {busy} solid{}", if busy == 1 { "" } else { "s" }));
                    });
                }
            });
        }
    });
    commands.write_batch(asks);
    Ok(())
}
