//! Midair, put together: which plugins make the app, and the command line.

mod again;
pub mod cli;
mod device;
mod drawn;
mod rehearse;
mod report;
mod shot;
mod threads;

use std::sync::Arc;
use std::time::Duration;

use bevy::animation::AnimationPlugin;
use bevy::app::ScheduleRunnerPlugin;
use bevy::dev_tools::render_debug::RenderDebugOverlayPlugin;
use bevy::ecs::error::{FallbackErrorHandler, warn};
use bevy::picking::{InteractionPlugin, PickingPlugin, input::PointerInputPlugin};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::settings::{RenderCreation, WgpuSettings};
use bevy::window::ExitCondition;
use bevy::winit::WinitPlugin;
use midair_brush::BrushPlugin;
use midair_csg::AssemblePlugin;
use midair_flatscreen::FlatscreenPlugin;
use midair_library::Volumes;
use midair_openxr::{Headset, HeadsetPlugin};
use midair_scaffold::ScaffoldPlugin;
use midair_space::SpacePlugin;
use midair_studio::{
    StudioPlugin,
    evaluate::Evaluations,
    help::GuidePlugin,
    panel::Host,
    project::{Begin, KeepPlugin, Places},
    settings::KeepSettingsPlugin,
    show::RoomPlugin,
};
use midair_sweep::SweepPlugin;

pub use again::{Again, ResumePlugin, SwitchPlugin, start_again};
pub use rehearse::RehearsalPlugin;
pub use report::probe;

/// Every mode, on the studio.
pub struct MidairPlugins;

impl Plugin for MidairPlugins {
    fn build(&self, app: &mut App) {
        // A user's bad input never ends the app: what a system reports is logged.
        app.insert_resource(FallbackErrorHandler(warn))
            .add_plugins((
                StudioPlugin,
                AssemblePlugin,
                ScaffoldPlugin,
                SweepPlugin,
                BrushPlugin,
            ));
    }
}

/// Where the app runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// In a window.
    Window,
    /// In a headset, with a window beside it.
    Headset,
    /// In a headset alone, where there is no display.
    HeadsetAlone,
    /// Without a window or a graphics card.
    Bare,
    /// As in a window, but nobody sees it and no graphics card draws it: devices are written into it.
    Unseen,
    /// Without a window, but able to draw a picture.
    Picture,
}

impl Stage {
    /// Whether a person sits there, and in front of a window.
    fn has_window(self) -> bool {
        matches!(self, Self::Window | Self::Headset)
    }

    /// Whether somebody works there.
    fn is_live(self) -> bool {
        self.has_window() || self == Self::HeadsetAlone
    }
}

/// The app for a stage without a headset, with `places` for the user's files, ready for its first update.
pub fn app(stage: Stage, places: Places, begin: Begin) -> App {
    build(stage, None, places, begin)
}

/// The app in a headset, with a `window` or without one.
pub fn headset_app(headset: Headset, window: bool, places: Places, begin: Begin) -> App {
    let stage = if window {
        Stage::Headset
    } else {
        Stage::HeadsetAlone
    };
    build(stage, Some(headset), places, begin)
}

fn build(stage: Stage, headset: Option<Headset>, places: Places, begin: Begin) -> App {
    let mut app = App::new();
    let window = WindowPlugin {
        primary_window: (stage.has_window() || stage == Stage::Unseen).then(|| Window {
            title: "Midair".to_owned(),
            name: Some("midair".to_owned()),
            resolution: (1280, 720).into(),
            ..default()
        }),
        exit_condition: if stage.has_window() {
            ExitCondition::OnPrimaryClosed
        } else {
            ExitCondition::DontExit
        },
        // Work that is not saved is asked about first.
        close_when_requested: false,
        ..default()
    };
    let mut plugins = DefaultPlugins.set(window).set(bevy::log::LogPlugin {
        // The app's own lines are what a person should see.
        filter: format!(
            "error,bevy_render::extract_resource=off,midair=warn,midair_studio=warn,midair_csg=warn,midair_scaffold=warn,midair_sweep=warn,midair_brush=warn,midair_library=warn,midair_space=warn{}",
            // Without a window the command itself says what was noticed, once.
            if stage.is_live() { ",midair_openxr=info" } else { ",midair_studio::notice=off" }
        ),
        ..default()
    });
    // Nothing here is animated or picked by the engine, and nobody looks into its buffers.
    plugins = plugins
        .disable::<AnimationPlugin>()
        .disable::<PointerInputPlugin>()
        .disable::<PickingPlugin>()
        .disable::<InteractionPlugin>()
        .disable::<RenderDebugOverlayPlugin>();
    if !stage.has_window() {
        plugins = plugins.disable::<WinitPlugin>();
    }
    if matches!(stage, Stage::Bare | Stage::Unseen) {
        plugins = plugins.set(RenderPlugin {
            render_creation: RenderCreation::Automatic(Box::new(WgpuSettings {
                backends: None,
                ..default()
            })),
            ..default()
        });
    }
    let worn = headset.is_some();
    match headset {
        Some(headset) => headset.install(&mut app, plugins),
        None => {
            app.add_plugins(plugins);
        }
    }
    if stage == Stage::HeadsetAlone {
        app.add_plugins(ScheduleRunnerPlugin::run_loop(Duration::ZERO));
    }
    app.insert_resource(Evaluations::new(Arc::new(Volumes::new(&places.library))))
        .insert_resource(places)
        .insert_resource(begin)
        .add_plugins(MidairPlugins);
    match stage {
        Stage::Window | Stage::Headset => {
            app.add_plugins((
                RoomPlugin,
                FlatscreenPlugin,
                // After it: the panels in a room are drawn by what it brings.
                SpacePlugin,
                GuidePlugin,
                KeepPlugin,
                KeepSettingsPlugin,
            ));
        }
        Stage::HeadsetAlone => {
            app.add_plugins((
                RoomPlugin,
                SpacePlugin,
                GuidePlugin,
                KeepPlugin,
                KeepSettingsPlugin,
            ));
        }
        Stage::Picture => {
            app.add_plugins((RoomPlugin, shot::MakingPlugin));
        }
        Stage::Unseen => {
            app.add_plugins(FlatscreenPlugin);
        }
        Stage::Bare => {}
    }
    if worn {
        app.add_plugins(HeadsetPlugin);
    }
    app.add_plugins(threads::OneThreadPlugin);
    app
}

/// The app as somebody in a headset has it, whatever its hands come from: panels, wands and labels are in the room.
pub fn wear(app: &mut App) {
    if !app.is_plugin_added::<SpacePlugin>() {
        app.add_plugins(SpacePlugin);
    }
    app.insert_resource(Host::Room);
}
