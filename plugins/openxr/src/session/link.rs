//! The line to the runtime: connection, session, what it says.

use bevy::prelude::*;
use bevy_mod_openxr::resources::OxrFrameState;
use bevy_mod_openxr::session::OxrSession;
use midair_studio::notice::Notices;
use openxr::{Event, EventDataBuffer, SessionState};

use super::open;
use super::search::Search;
use crate::frame::Trouble;
use crate::input::Input;
use crate::runtime::{Connection, RuntimeFault};

/// The line to the runtime.
#[derive(Resource)]
pub struct Link {
    connection: Option<Connection>,
    /// A session is there.
    open: bool,
    /// It was begun and not ended.
    begun: bool,
    state: SessionState,
    /// Whether the person wants to be in the headset.
    wanted: bool,
    search: Search,
    /// What was refused and said already: each call is spoken of once.
    said: Vec<&'static str>,
    /// Sessions so far.
    sessions: u32,
}

impl Default for Link {
    fn default() -> Self {
        Self {
            connection: None,
            open: false,
            begun: false,
            state: SessionState::UNKNOWN,
            wanted: false,
            search: Search::default(),
            said: Vec::new(),
            sessions: 0,
        }
    }
}

impl Link {
    pub(crate) fn new(connection: Connection) -> Self {
        Self {
            connection: Some(connection),
            wanted: true,
            ..Self::default()
        }
    }

    /// Whether a session is there.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Whether the runtime runs it.
    pub fn is_begun(&self) -> bool {
        self.begun
    }

    /// Whether the person wants to be in the headset.
    pub fn is_wanted(&self) -> bool {
        self.wanted
    }

    /// Whether a runtime is looked for.
    pub fn is_searching(&self) -> bool {
        self.search.is_on()
    }

    /// What the runtime said last.
    pub fn state(&self) -> SessionState {
        self.state
    }

    /// Sessions so far, the one at hand included.
    pub fn sessions(&self) -> u32 {
        self.sessions
    }

    /// What the headset and its runtime are called.
    pub fn name(&self) -> String {
        match &self.connection {
            Some(c) if c.headset.is_empty() => c.runtime.clone(),
            Some(c) => format!("{}, {}", c.headset, c.runtime),
            None => "the headset".to_owned(),
        }
    }

    pub(crate) fn connection(&self) -> Option<&Connection> {
        self.connection.as_ref()
    }

    /// Into the headset, or out of it.
    pub(crate) fn want(&mut self, on: bool) {
        self.wanted = on;
        if on {
            self.search.soon();
        }
    }

    #[cfg(test)]
    pub(super) fn pretend(&mut self, state: SessionState) {
        self.open = true;
        self.state = state;
    }
}

/// What was refused since the last frame: said once, and the end of the session where there is no going on.
pub(super) fn refusals(world: &mut World) {
    let list = world.resource::<Trouble>().take();
    for refusal in list {
        let mut link = world.resource_mut::<Link>();
        let runtime = link
            .connection
            .as_ref()
            .map_or("The OpenXR runtime".to_owned(), |c| c.runtime.clone());
        if refusal.is_end() {
            if link.connection.is_some() {
                let line = format!(
                    "{runtime} stopped ({}: {:?}). Your work is kept and goes on here with mouse and keyboard; Midair comes \
                     back into the headset when {runtime} runs again.",
                    refusal.call, refusal.code
                );
                lose(world, line);
            }
            continue;
        }
        if link.said.contains(&refusal.call) {
            continue;
        }
        link.said.push(refusal.call);
        world.resource_mut::<Notices>().warn(format!(
            "{runtime} refused {} ({:?}). If the headset does not go on, start {runtime} again.",
            refusal.call, refusal.code
        ));
    }
}

/// What the runtime says.
pub(super) fn poll(world: &mut World) {
    let Some(instance) = world
        .resource::<Link>()
        .connection
        .as_ref()
        .map(|c| c.instance.clone())
    else {
        return;
    };
    let mut buffer = EventDataBuffer::new();
    loop {
        match instance.poll_event(&mut buffer) {
            Ok(Some(event)) => {
                if !heard(world, &event) {
                    return;
                }
            }
            Ok(None) => return,
            Err(code) => {
                world.resource::<Trouble>().note("xrPollEvent", code);
                return;
            }
        }
    }
}

/// Takes one event in; false when the line is gone with it.
fn heard(world: &mut World, event: &Event) -> bool {
    match event {
        Event::SessionStateChanged(change) => {
            let state = change.state();
            info!(target: "midair_openxr::life", "session {state:?}");
            world.resource_mut::<Link>().state = state;
            match state {
                SessionState::READY => begin(world),
                SessionState::STOPPING => end(world),
                SessionState::EXITING => {
                    // The person closed it in the runtime's own menu.
                    world.resource_mut::<Link>().wanted = false;
                    part(world, true);
                    return false;
                }
                SessionState::LOSS_PENDING => {
                    lose(
                        world,
                        "The headset is disconnected. Your work is kept and goes on here with mouse and keyboard; Midair \
                         comes back into the headset when it is there again."
                            .to_owned(),
                    );
                    return false;
                }
                _ => {}
            }
        }
        Event::InstanceLossPending(_) => {
            lose(
                world,
                "The OpenXR runtime is about to stop. Your work is kept and goes on here with mouse and keyboard; Midair \
                 comes back into the headset when it runs again."
                    .to_owned(),
            );
            return false;
        }
        Event::InteractionProfileChanged(_) => {
            if let Some(mut input) = world.get_resource_mut::<Input>() {
                input.rename();
            }
        }
        Event::ReferenceSpaceChangePending(_) => {
            info!(target: "midair_openxr::life", "the floor was set anew");
        }
        Event::EventsLost(lost) => {
            warn!("the runtime lost {} events", lost.lost_event_count());
        }
        _ => {}
    }
    true
}

fn begin(world: &mut World) {
    let Some(session) = world.get_resource::<OxrSession>().cloned() else {
        return;
    };
    match session.begin(openxr::ViewConfigurationType::PRIMARY_STEREO) {
        Ok(_) => world.resource_mut::<Link>().begun = true,
        Err(code) => world.resource::<Trouble>().note("xrBeginSession", code),
    }
}

fn end(world: &mut World) {
    world.resource_mut::<Link>().begun = false;
    if let Some(session) = world.get_resource::<OxrSession>().cloned()
        && let Err(code) = session.end()
    {
        world.resource::<Trouble>().note("xrEndSession", code);
    }
}

/// Opens a session where one is wanted, leaves one where none is, looks for a runtime that is gone.
pub(super) fn attend(world: &mut World) {
    let now = std::time::Instant::now();
    let link = world.resource::<Link>();
    let (wanted, connected, open) = (link.wanted, link.connection.is_some(), link.open);
    if open && !wanted {
        leave(world);
        return;
    }
    if open || !wanted {
        return;
    }
    if connected {
        match open::session(world) {
            Ok(()) => {
                let mut link = world.resource_mut::<Link>();
                link.open = true;
                link.begun = false;
                link.state = SessionState::IDLE;
                link.sessions += 1;
                link.said.clear();
                link.search.rest();
            }
            Err(fault) => {
                part(world, true);
                world.resource_mut::<Link>().search.pause();
                fell_through(world, &fault);
            }
        }
        return;
    }
    let mut link = world.resource_mut::<Link>();
    match link.search.look(now) {
        None => {}
        Some(Ok(connection)) => {
            let adopted = world
                .get_non_send::<crate::runtime::Card>()
                .map(|card| connection.adopt(card));
            match adopted {
                Some(Ok(())) => world.resource_mut::<Link>().connection = Some(connection),
                Some(Err(fault)) => fell_through(world, &fault),
                None => {}
            }
        }
        Some(Err(fault)) => fell_through(world, &fault),
    }
}

/// An attempt came to nothing: the reason is said when it is another one than before.
fn fell_through(world: &mut World, fault: &RuntimeFault) {
    let mut link = world.resource_mut::<Link>();
    if link.search.is_news(fault) {
        let line = format!("Not in the headset yet: {fault}. Midair goes on looking.");
        world.resource_mut::<Notices>().warn(line);
    }
}

/// Leaves by the person's wish: the runtime is asked to end the session, and says the rest.
fn leave(world: &mut World) {
    let session = world.get_resource::<OxrSession>().cloned();
    let asked = world.resource::<Link>().begun
        && session.is_some_and(|session| session.request_exit().is_ok());
    if !asked {
        part(world, false);
    }
}

/// The runtime is gone without having been asked.
fn lose(world: &mut World, line: String) {
    part(world, true);
    world.resource_mut::<Link>().search.after_a_loss();
    world.resource_mut::<Notices>().warn(line);
}

/// The app ends.
pub(super) fn close(world: &mut World) {
    world.resource_mut::<Link>().wanted = false;
    part(world, true);
}

/// Lets go of the session, and of the `runtime` where it is gone too.
fn part(world: &mut World, runtime: bool) {
    world.remove_resource::<Input>();
    world.remove_resource::<OxrFrameState>();
    open::close(world);
    let mut link = world.resource_mut::<Link>();
    link.open = false;
    link.begun = false;
    link.state = SessionState::UNKNOWN;
    if runtime {
        link.connection = None;
    }
}
