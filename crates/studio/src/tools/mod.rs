//! How a mode plugs in: an id, a name, a place in the frame.
//!
//! A mode is an ordinary plugin. It registers itself with [`AddTool::add_tool`] and adds its systems
//! to the sets of [`StudioSet`] with [`tool_active`] as their condition. Ids are
//! saved in documents and never renamed.

mod aim;

use std::borrow::Cow;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

pub use aim::{Aim, CATCH};

use crate::{StudioSet, hands::Side};

/// The name of a tool in files.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ToolId(Cow<'static, str>);

impl ToolId {
    /// An id known when the plugin is written.
    pub const fn new(id: &'static str) -> Self {
        Self(Cow::Borrowed(id))
    }

    /// As text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl From<String> for ToolId {
    fn from(id: String) -> Self {
        Self(Cow::Owned(id))
    }
}

impl std::fmt::Display for ToolId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

/// What the studio shows of a tool.
#[derive(Clone, Debug)]
pub struct Tool {
    /// Its id.
    pub id: ToolId,
    /// What people read.
    pub name: &'static str,
    /// One line on what it does.
    pub about: &'static str,
    /// Where it stands among the others, smallest first.
    pub order: i32,
}

/// The tools that are plugged in, and the one in the hands.
#[derive(Resource, Debug, Default)]
pub struct Tools {
    tools: Vec<Tool>,
    active: Option<ToolId>,
    left: bool,
}

impl Tools {
    /// All of them, in order.
    pub fn all(&self) -> &[Tool] {
        &self.tools
    }

    /// The one in the hands.
    pub fn active(&self) -> Option<&Tool> {
        self.tools
            .iter()
            .find(|t| Some(&t.id) == self.active.as_ref())
    }

    /// Whether a plugin for `id` is there.
    pub fn knows(&self, id: &str) -> bool {
        self.tools.iter().any(|t| t.id.as_str() == id)
    }

    /// Takes another tool in hand. Leaving a tool aborts the gesture in progress: [`ToolChanged`]
    /// tells it so before its systems stop running. Returns whether that tool exists.
    pub fn activate(&mut self, id: &str) -> bool {
        let Some(tool) = self.tools.iter().find(|t| t.id.as_str() == id) else {
            return false;
        };
        if self.active.as_ref() != Some(&tool.id) {
            self.active = Some(tool.id.clone());
            self.left = true;
        }
        true
    }
}

/// Another tool was taken in hand. Observed by tools (to abort) and by the studio (to revert an
/// open transaction).
#[derive(Event, Clone, Debug)]
pub struct ToolChanged {
    /// The tool now in the hands.
    pub active: ToolId,
}

/// The step in which [`ToolChanged`] is triggered.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Announce;

/// Registers a mode.
pub trait AddTool {
    /// Adds `tool`; the first one in order is in the hands at the start.
    fn add_tool(&mut self, tool: Tool) -> &mut Self;
}

impl AddTool for App {
    fn add_tool(&mut self, tool: Tool) -> &mut Self {
        let mut tools = self.world_mut().get_resource_or_init::<Tools>();
        tools.tools.retain(|t| t.id != tool.id);
        tools.tools.push(tool);
        tools
            .tools
            .sort_by(|a, b| (a.order, &a.id).cmp(&(b.order, &b.id)));
        tools.active = tools.tools.first().map(|t| t.id.clone());
        self
    }
}

/// A run condition: this tool is in the hands. For systems of several sets it is to be asked for each
/// (`distributive_run_if`): a mode that is left in [`StudioSet::Ask`] would otherwise do one frame's work
/// more after it was told so.
pub fn tool_active(id: ToolId) -> impl Fn(Res<Tools>) -> bool + Clone {
    move |tools| tools.active.as_ref() == Some(&id)
}

/// What one button does now.
#[derive(Clone, Debug, PartialEq)]
pub struct Hint {
    /// Which hand; `None` for either.
    pub side: Option<Side>,
    /// The action or gesture, as the active way in should name it.
    pub action: HintKey,
    /// What it does: "fuse 3", "copy", "drop".
    pub does: String,
}

/// What a hint is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HintKey {
    /// A named action.
    Action(crate::hands::Action),
    /// Moving the hand or hands.
    Move,
    /// Touching the pad.
    Swipe,
}

/// What every button does in this phase: the active tool writes it in
/// [`StudioSet::Cue`], ways in show it.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Hints {
    /// One line on where one is in the work.
    pub status: String,
    /// The buttons.
    pub buttons: Vec<Hint>,
    /// Two buttons of these that do one thing this way and that way, and what it is: where all stand in one line they
    /// are told as one.
    pub pairs: Vec<([crate::hands::Action; 2], &'static str)>,
}

impl Hints {
    /// Starts over with a status line.
    pub fn begin(&mut self, status: impl Into<String>) -> &mut Self {
        self.status = status.into();
        self.buttons.clear();
        self.pairs.clear();
        self
    }

    /// Two buttons that were said do one thing, this way and that way.
    pub fn pair(&mut self, two: [crate::hands::Action; 2], does: &'static str) -> &mut Self {
        self.pairs.push((two, does));
        self
    }

    /// Says what a button does.
    pub fn say(&mut self, action: crate::hands::Action, does: impl Into<String>) -> &mut Self {
        self.buttons.push(Hint {
            side: None,
            action: HintKey::Action(action),
            does: does.into(),
        });
        self
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Tools>()
        .init_resource::<Hints>()
        .init_resource::<Aim>()
        // First in the frame's work, so that no tool acts in the frame it was left.
        .add_systems(Update, announce.in_set(StudioSet::Pick).in_set(Announce));
}

fn announce(mut tools: ResMut<Tools>, mut aim: ResMut<Aim>, mut commands: Commands) {
    if tools.left {
        aim.set_if_neq(Aim::default());
        tools.bypass_change_detection().left = false;
        if let Some(active) = tools.active.clone() {
            commands.trigger(ToolChanged { active });
        }
    }
}
