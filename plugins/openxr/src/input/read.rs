//! Reading controllers and head: one look at the runtime for each frame, not for each eye.

use bevy::math::{Quat, Vec2, Vec3};
use bevy::prelude::*;
use bevy_mod_openxr::session::OxrSession;
use midair_studio::hands::{ActionSet, Pose, Side};
use midair_studio::notice::Notices;
use openxr::{ActiveActionSet, Path, Posef, ReferenceSpaceType, Space, SpaceLocationFlags, Time};

use super::actions::{self, Sense, Set};
use super::bindings::{Arms, Bindings, Control, Profile, Source};
use super::controllers::Controller;
use super::keys::{Keys, Raw};
use crate::frame::Trouble;
use crate::runtime::{Connection, RuntimeFault};
use crate::session::below_the_eyes;

/// What a session listens with.
#[derive(Resource)]
pub(crate) struct Input {
    connection: Connection,
    hands: [Path; 2],
    /// For the left-handed, and for the right-handed.
    sets: [Set; 2],
    floor: Space,
    eyes: Space,
    held: [Held; 2],
    /// Which controllers are held has to be asked anew.
    stale: bool,
    leads: Option<Side>,
}

/// What one hand holds.
#[derive(Default)]
struct Held {
    profile: Option<&'static Profile>,
    arms: Arms,
    swipe: Option<Source>,
    keys: Keys,
}

/// One hand in one frame, in metres of the room.
pub(super) struct HandRead {
    pub aim: Option<Pose>,
    pub tracked: bool,
    /// Whether the runtime gives a place that is none.
    pub senseless: bool,
    /// Whether the controller is on.
    pub active: bool,
    pub down: ActionSet,
    pub swipe: Option<Vec2>,
}

impl Input {
    /// Makes the actions of a session and says which tables the runtime took.
    pub fn open(
        world: &mut World,
        connection: &Connection,
        session: &OxrSession,
    ) -> Result<Self, RuntimeFault> {
        let refused = |call| move |code| RuntimeFault::refused(&connection.runtime, call, code);
        let hand = |text| {
            connection
                .instance
                .string_to_path(text)
                .map_err(refused("xrStringToPath"))
        };
        let hands = [hand("/user/hand/left")?, hand("/user/hand/right")?];
        let bindings = world.resource::<Bindings>();
        let (sets, suggested) = actions::make(connection, session, bindings, hands)?;
        let known = session.enumerate_reference_spaces().unwrap_or_default();
        let (kind, pose) = if known.contains(&ReferenceSpaceType::STAGE) {
            (ReferenceSpaceType::STAGE, Posef::IDENTITY)
        } else {
            let mut pose = Posef::IDENTITY;
            let down = below_the_eyes().translation;
            pose.position.y = down.y;
            (ReferenceSpaceType::LOCAL, pose)
        };
        let space = |kind, pose| {
            reference_space(session, kind, pose).map_err(refused("xrCreateReferenceSpace"))
        };
        let floor = space(kind, pose)?;
        let eyes = space(ReferenceSpaceType::VIEW, Posef::IDENTITY)?;
        let mut notices = world.resource_mut::<Notices>();
        for table in suggested {
            let Some(reason) = table.refused else {
                info!(
                    target: "midair_openxr::bindings",
                    "{}: {} bindings accepted", table.profile.id, table.bindings
                );
                continue;
            };
            notices.warn(format!(
                "{} refused the buttons of {} ({reason}). If those are your controllers, look at their lines in headset.ron.",
                connection.runtime, table.profile.name
            ));
        }
        Ok(Self {
            connection: connection.clone(),
            hands,
            sets,
            floor,
            eyes,
            held: Default::default(),
            stale: true,
            leads: None,
        })
    }

    /// Which controllers are held has changed.
    pub fn rename(&mut self) {
        self.stale = true;
    }

    /// Listens to the set for whoever leads.
    pub(super) fn sync(
        &mut self,
        session: &OxrSession,
        bindings: &Bindings,
        main: Side,
        trouble: &Trouble,
    ) {
        if self.stale || self.leads != Some(main) {
            self.stale = false;
            self.leads = Some(main);
            self.look_at_controllers(session, bindings, main, trouble);
        }
        let set = &self.sets[main as usize].set;
        if let Err(code) = session.sync_actions(&[ActiveActionSet::new(set)]) {
            trouble.note("xrSyncActions", code);
        }
    }

    fn look_at_controllers(
        &mut self,
        session: &OxrSession,
        bindings: &Bindings,
        main: Side,
        trouble: &Trouble,
    ) {
        for side in Side::BOTH {
            let profile = match session.current_interaction_profile(self.hands[side as usize]) {
                Ok(path) => actions::profile_of(&self.connection, path),
                Err(code) => {
                    trouble.note("xrGetCurrentInteractionProfile", code);
                    None
                }
            };
            let held = &mut self.held[side as usize];
            if held.profile.map(|p| p.id) != profile.map(|p| p.id) {
                info!(
                    target: "midair_openxr::bindings",
                    "{side:?}: {}", profile.map_or("nothing", |p| p.id)
                );
            }
            // What was down with another controller is let go.
            *held = Held {
                profile,
                arms: profile.map_or(Arms::default(), |p| bindings.arms(p, side, main)),
                swipe: profile.and_then(|p| bindings.swipe(p, side, main)),
                keys: Keys::default(),
            };
        }
    }

    /// One hand at `time`.
    pub(super) fn hand(
        &mut self,
        session: &OxrSession,
        side: Side,
        main: Side,
        time: Time,
        trouble: &Trouble,
        controller: &mut Controller,
    ) -> HandRead {
        let set = &self.sets[main as usize];
        let hand = self.hands[side as usize];
        let i = side as usize;
        let grip = located(&set.grip[i], &self.floor, time, trouble);
        let aim = located(&set.aim[i], &self.floor, time, trouble);
        let mut raw = Raw::default();
        let mut active = false;
        for (control, sense) in &set.senses {
            match sense {
                Sense::Axis(action) => match action.state(session, hand) {
                    Ok(state) => {
                        active |= state.is_active;
                        let value = if state.is_active && state.current_state.is_finite() {
                            state.current_state
                        } else {
                            0.0
                        };
                        match control {
                            Control::Act => raw.act = value,
                            _ => raw.grab = value,
                        }
                    }
                    Err(code) => trouble.note("xrGetActionStateFloat", code),
                },
                Sense::Button(action) => match action.state(session, hand) {
                    Ok(state) => {
                        let down = state.is_active && state.current_state;
                        match control {
                            Control::PadTouch => {
                                raw.pad_touch = state.is_active.then_some(down);
                            }
                            Control::PadClick => raw.pad_click = down,
                            _ => {
                                if let Some(action) = control.action() {
                                    raw.buttons.set(action, down);
                                }
                            }
                        }
                    }
                    Err(code) => trouble.note("xrGetActionStateBoolean", code),
                },
                Sense::Plane(action) => match action.state(session, hand) {
                    Ok(state) if state.is_active => {
                        let at = Vec2::new(state.current_state.x, state.current_state.y);
                        match control {
                            Control::Stick => raw.stick = at,
                            _ => raw.pad = at,
                        }
                    }
                    Ok(_) => {}
                    Err(code) => trouble.note("xrGetActionStateVector2f", code),
                },
            }
        }
        let held = &mut self.held[i];
        let (down, swipe) = held.keys.advance(&raw, &held.arms, held.swipe);
        let followed = |at: &Located| at.tracked && at.pose.is_some();
        let tracked = followed(&grip) && followed(&aim);
        controller.active = active;
        controller.tracked = tracked;
        controller.grip = grip.pose.or(controller.grip);
        controller.aim = aim.pose.or(controller.aim);
        controller.profile = held.profile.map_or("", |p| p.id);
        controller.name = held.profile.map_or("", |p| p.name);
        controller.trigger = raw.act;
        controller.squeeze = raw.grab;
        controller.stick = raw.stick;
        controller.pad = raw
            .pad_touch
            .unwrap_or(raw.pad != Vec2::ZERO)
            .then_some(raw.pad);
        HandRead {
            aim: aim.pose,
            tracked,
            senseless: grip.senseless || aim.senseless,
            active,
            down,
            swipe,
        }
    }

    /// Where the eyes are at `time`, in metres of the room.
    pub(super) fn head(&self, time: Time, trouble: &Trouble) -> Option<Pose> {
        located(&self.eyes, &self.floor, time, trouble).pose
    }

    /// Whom a pulse goes to.
    pub(crate) fn pulse(
        &self,
        session: &OxrSession,
        main: Side,
        side: Side,
        pulse: &openxr::HapticVibration,
    ) -> openxr::Result<()> {
        self.sets[main as usize]
            .haptic
            .apply_feedback(session, self.hands[side as usize], pulse)
    }
}

/// Where a space is.
#[derive(Clone, Copy, Default)]
struct Located {
    /// If that is known. A pose that is none (NaN, no turn) counts as not known.
    pose: Option<Pose>,
    /// Whether it is followed rather than guessed.
    tracked: bool,
    /// The runtime calls such a pose known.
    senseless: bool,
}

fn located(space: &Space, floor: &Space, time: Time, trouble: &Trouble) -> Located {
    let location = match space.locate(floor, time) {
        Ok(location) => location,
        Err(code) => {
            trouble.note("xrLocateSpace", code);
            return Located::default();
        }
    };
    let flags = location.location_flags;
    let valid = SpaceLocationFlags::POSITION_VALID | SpaceLocationFlags::ORIENTATION_VALID;
    if !flags.contains(valid) {
        return Located::default();
    }
    let tracked = SpaceLocationFlags::POSITION_TRACKED | SpaceLocationFlags::ORIENTATION_TRACKED;
    let pose = pose(&location.pose);
    Located {
        pose,
        tracked: flags.contains(tracked),
        senseless: pose.is_none(),
    }
}

fn pose(from: &Posef) -> Option<Pose> {
    let (p, o) = (from.position, from.orientation);
    let rotation = Quat::from_xyzw(o.x, o.y, o.z, o.w);
    let length = rotation.length();
    if !length.is_finite() || length < 0.5 {
        return None;
    }
    let pose = Pose {
        position: Vec3::new(p.x, p.y, p.z),
        rotation: rotation.normalize(),
    };
    pose.is_sound().then_some(pose)
}

/// bevy_mod_openxr gives reference spaces a type of its own; listening needs OpenXR's.
fn reference_space(
    session: &OxrSession,
    kind: ReferenceSpaceType,
    pose: Posef,
) -> openxr::Result<Space> {
    let session: &openxr::Session<openxr::AnyGraphics> = session;
    session.create_reference_space(kind, pose)
}

/// Where the tip of a wand is, from where its controller aims: `angle` degrees below that, `length` metres ahead.
pub(super) fn tip(aim: &Pose, angle: f32, length: f32) -> Pose {
    let angle = if angle.is_finite() {
        angle.clamp(-90.0, 90.0)
    } else {
        0.0
    };
    let rotation = (aim.rotation * Quat::from_rotation_x(-angle.to_radians())).normalize();
    Pose {
        position: aim.position + rotation * Vec3::NEG_Z * length,
        rotation,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_that_is_none_is_not_known() {
        let mut from = Posef::IDENTITY;
        assert_eq!(pose(&from), Some(Pose::default()));
        from.position.x = f32::NAN;
        assert_eq!(pose(&from), None);
        from = Posef::IDENTITY;
        from.orientation.w = f32::NAN;
        assert_eq!(pose(&from), None);
        from.orientation.w = 0.0;
        assert_eq!(pose(&from), None);
        // A turn that is only nearly of length one is one.
        from.orientation.w = 1.001;
        assert_eq!(pose(&from), Some(Pose::default()));
    }

    #[test]
    fn a_wand_points_below_its_controller_by_the_angle() {
        let down = tip(&Pose::default(), 90.0, 0.1);
        assert!(down.position.distance(Vec3::new(0.0, -0.1, 0.0)) < 1e-6);
        let level = tip(&Pose::default(), f32::NAN, 0.1);
        assert!(level.position.distance(Vec3::new(0.0, 0.0, -0.1)) < 1e-6);
    }
}
