//! The headset as a way in: OpenXR runtimes, sessions, controllers, haptics.
//!
//! [`Headset::open`] finds loader, runtime and headset, or says in one line what is missing and what to do about it.
//! [`Headset::install`] builds an app that draws with the graphics card that the runtime asked for. From then on the
//! session's [`Life`] decides: while the headset is worn its controllers write the studio's hands, otherwise the window
//! has them. A runtime that refuses a call, or dies, costs the session and nothing else.
//!
//! It stands on bevy_mod_openxr, whose own start, frame loop and event loop are not used: they end the app where a
//! runtime fails, and open the loader by a name that players do not have.

mod frame;
mod haptics;
pub mod input;
pub mod runtime;
pub mod session;
mod stand;

use std::sync::{Arc, Mutex};

use bevy::app::PluginGroupBuilder;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::renderer::{
    RenderAdapter, RenderAdapterInfo, RenderInstance, RenderQueue, WgpuWrapper,
};
use bevy::render::settings::RenderCreation;
use bevy_mod_openxr::types::WgpuGraphics;
use bevy_mod_xr::session::XrSessionPlugin;
use midair_studio::StudioSet;

pub use frame::eye;
pub use runtime::RuntimeFault;
pub use session::Life;

use runtime::{Card, Connection};
use session::Link;

/// A runtime with a headset, and the graphics card it draws with.
pub struct Headset {
    connection: Connection,
    graphics: WgpuGraphics,
    card: Card,
}

impl Headset {
    /// Finds a headset.
    ///
    /// # Errors
    ///
    /// What is missing and the way out, as one line.
    pub fn open() -> Result<Self, RuntimeFault> {
        let connection = Connection::open()?;
        let (graphics, card) = connection.card()?;
        Ok(Self {
            connection,
            graphics,
            card,
        })
    }

    /// What the headset and its runtime are called.
    pub fn name(&self) -> String {
        format!("{}, {}", self.connection.headset, self.connection.runtime)
    }

    /// Adds `plugins` to an app, with this headset's card in place of what they draw with.
    pub fn install(self, app: &mut App, plugins: PluginGroupBuilder) {
        app.insert_non_send(self.card);
        app.insert_resource(Link::new(self.connection));
        app.add_plugins(
            plugins
                .disable::<RenderPlugin>()
                // A frame that is drawn while the next one is computed is one frame late in the eyes.
                .disable::<PipelinedRenderingPlugin>()
                .add_before::<RenderPlugin>(XrSessionPlugin { auto_handle: false })
                .add_before::<RenderPlugin>(CardPlugin(Mutex::new(Some(self.graphics)))),
        );
    }
}

/// Draws with the card that the runtime asked for.
struct CardPlugin(Mutex<Option<WgpuGraphics>>);

impl Plugin for CardPlugin {
    fn build(&self, app: &mut App) {
        let graphics = match self.0.lock() {
            Ok(mut slot) => slot.take(),
            Err(poisoned) => poisoned.into_inner().take(),
        };
        let Some(WgpuGraphics(device, queue, info, adapter, instance)) = graphics else {
            return;
        };
        app.add_plugins(RenderPlugin {
            render_creation: RenderCreation::manual(
                device.into(),
                RenderQueue(Arc::new(WgpuWrapper::new(queue))),
                RenderAdapterInfo(WgpuWrapper::new(info)),
                RenderAdapter(Arc::new(WgpuWrapper::new(adapter))),
                RenderInstance(Arc::new(WgpuWrapper::new(instance))),
            ),
            ..default()
        });
    }
}

/// Session, hands and pulses; added to an app that a [`Headset`] was installed in, after the studio.
pub struct HeadsetPlugin;

impl Plugin for HeadsetPlugin {
    fn build(&self, app: &mut App) {
        frame::plugin(app);
        session::plugin(app);
        input::plugin(app);
        app.add_systems(
            Update,
            (
                // What was pulled in this frame is drawn from where it is now.
                (stand::stand, haptics::pulse)
                    .after(StudioSet::Commit)
                    .before(StudioSet::Cue),
                stand::pace.run_if(resource_changed::<Life>),
                stand::host
                    .in_set(StudioSet::Gather)
                    .before(midair_studio::hands::WriteHands),
            ),
        );
    }
}
