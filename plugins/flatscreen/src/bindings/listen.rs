//! What is asked for in this frame: keys and buttons through leafwing's maps, one control per press.
//!
//! Leafwing compares every pair of bindings in every frame to tell `Ctrl+Z` from `Z`; here a chord
//! begins when its last part goes down, and only the longest that fits begins.

use bevy::input::gamepad::{Gamepad, GamepadAxis, GamepadButtonStateChangedEvent};
use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy::window::WindowEvent;
use leafwing_input_manager::action_state::ActionState;
use leafwing_input_manager::input_map::InputMap;
use leafwing_input_manager::user_input::ModifierKey;
use leafwing_input_manager::user_input::updating::CentralInputStore;
use midair_studio::hands::HOLD;

use super::moments::{Cursor, Moments};
use super::part::Part;
use super::{Binding, Bindings, Context, Control, Device};

/// A control that repeats does so this often, in seconds, once it is held.
const REPEAT: f32 = 0.12;
/// A stick counts as touched beyond this.
const TOUCHED: f32 = 0.3;

/// Where the keys go at the moment.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Attention {
    /// A field takes letters.
    pub text: bool,
    /// The focus is in a panel.
    pub panel: bool,
    /// The keyboard on the screen is up.
    pub keyboard: bool,
    /// Both hands pull at one thing.
    pub stretching: bool,
    /// A key is awaited, to bind it: nothing else hears it.
    pub rebinding: bool,
}

/// One binding of one control, as it is listened to.
struct Bound {
    control: Control,
    /// Its place among the control's bindings in leafwing's map.
    index: usize,
    parts: Vec<Part>,
    /// Its last part, as a place in the list of those.
    main: usize,
    /// Its button also begins another chord.
    begins_chord: bool,
    /// It went down and waits for its button to go up.
    waiting: bool,
    active: bool,
}

/// Which controls are down, went down, and which stick is where.
#[derive(Resource)]
pub struct Controls {
    map: InputMap<Control>,
    state: ActionState<Control>,
    bounds: Vec<Bound>,
    /// The last part of every binding, and whether it was down in the frame before.
    mains: Vec<(Part, bool)>,
    /// Seconds until a control that is held fires again.
    repeats: Vec<(Control, f32)>,
    fired: Vec<Control>,
    device: Device,
    pad: Option<Entity>,
}

impl Default for Controls {
    fn default() -> Self {
        Self::new(&Bindings::default())
    }
}

impl Controls {
    fn new(bindings: &Bindings) -> Self {
        let mut map = InputMap::default();
        let mut bounds: Vec<Bound> = Vec::new();
        let mut mains: Vec<(Part, bool)> = Vec::new();
        for &control in Control::ALL {
            let mut index = 0;
            for binding in bindings.of(control) {
                match binding {
                    Binding::Stick(stick) => {
                        map.insert_dual_axis(control, stick.input());
                    }
                    Binding::Chord(parts) => {
                        let (Some(input), Some(&last)) = (binding.input(), parts.last()) else {
                            continue;
                        };
                        map.insert_boxed(control, input);
                        let known = mains.iter().position(|m| m.0 == last);
                        let main = known.unwrap_or_else(|| {
                            // What is down already begins nothing.
                            mains.push((last, true));
                            mains.len() - 1
                        });
                        bounds.push(Bound {
                            control,
                            index,
                            parts: parts.clone(),
                            main,
                            begins_chord: false,
                            waiting: false,
                            active: false,
                        });
                        index += 1;
                    }
                }
            }
        }
        for i in 0..bounds.len() {
            let main = mains[bounds[i].main].0;
            bounds[i].begins_chord = bounds[i].parts.len() == 1
                && bounds
                    .iter()
                    .any(|b| b.parts[..b.parts.len() - 1].contains(&main));
        }
        Self {
            map,
            state: ActionState::default(),
            bounds,
            mains,
            repeats: Vec::new(),
            fired: Vec::new(),
            device: Device::Keys,
            pad: None,
        }
    }

    /// Whether a control is down.
    pub fn pressed(&self, control: Control) -> bool {
        self.state.pressed(&control)
    }

    /// Whether it went down in this frame.
    pub fn just_pressed(&self, control: Control) -> bool {
        self.state.just_pressed(&control)
    }

    /// Whether it went up in this frame.
    pub fn just_released(&self, control: Control) -> bool {
        self.state.just_released(&control)
    }

    /// Whether it went down in this frame, or is held and fires again.
    pub fn fired(&self, control: Control) -> bool {
        self.fired.contains(&control)
    }

    /// Whether it was down until something changed in this frame: what the pointer travelled was its.
    pub fn was_pressed(&self, control: Control) -> bool {
        self.pressed(control) && !self.just_pressed(control) || self.just_released(control)
    }

    /// Whether it is down by a key or button of `device`.
    pub fn pressed_on(&self, control: Control, device: Device) -> bool {
        self.bounds
            .iter()
            .any(|b| b.control == control && b.active && self.mains[b.main].0.device() == device)
    }

    /// Where a stick is: each axis in [−1, 1], together at most 1.
    pub fn stick(&self, control: Control) -> Vec2 {
        self.state.clamped_axis_pair(&control).clamp_length_max(1.0)
    }

    /// What was used last.
    pub fn device(&self) -> Device {
        self.device
    }

    /// The gamepad that is listened to, if one is there.
    pub fn pad(&self) -> Option<Entity> {
        self.pad
    }
}

/// What keys and buttons say, devices side by side.
type Devices<'w, 's> = (
    Res<'w, ButtonInput<KeyCode>>,
    Res<'w, ButtonInput<MouseButton>>,
    MessageReader<'w, 's, WindowEvent>,
    MessageReader<'w, 's, GamepadButtonStateChangedEvent>,
    Query<'w, 's, &'static Window>,
    Query<'w, 's, (Entity, &'static Gamepad)>,
);

/// Reads the devices, before anything else of the frame asks what they say.
pub(crate) fn listen(
    (keys, mouse, mut events, mut on_pads, windows, pads): Devices,
    mut moments: Local<Moments>,
    mut cursor: ResMut<Cursor>,
    time: Res<Time>,
    bindings: Res<Bindings>,
    attention: Res<Attention>,
    mut store: ResMut<CentralInputStore>,
    mut controls: ResMut<Controls>,
) {
    if bindings.is_changed() && !bindings.is_added() || controls.bounds.is_empty() {
        let fresh = Controls::new(&bindings);
        controls.map = fresh.map;
        controls.bounds = fresh.bounds;
        controls.mains = fresh.mains;
        controls.state.reset_all();
        controls.repeats.clear();
    }
    events.read().for_each(|event| moments.hear(event));
    on_pads.read().for_each(|event| moments.hear_pad(event));
    if attention.text {
        moments.leave_out(|key| key != KeyCode::Escape && !is_function(key));
    }
    let now = windows.iter().find_map(Window::cursor_position);
    moments.next(now, &mut cursor);
    moments.tell(&mut store);
    let controls = &mut *controls;
    controls.choose(&keys, &mouse, cursor.travelled(), &pads);
    controls.update(&store, *attention, time.delta_secs());
}

impl Controls {
    /// Which device, and which gamepad, is listened to and named.
    fn choose(
        &mut self,
        keys: &ButtonInput<KeyCode>,
        mouse: &ButtonInput<MouseButton>,
        travelled: Vec2,
        pads: &Query<(Entity, &Gamepad)>,
    ) {
        let touched = |pad: &Gamepad| {
            let axes = [
                GamepadAxis::LeftStickX,
                GamepadAxis::LeftStickY,
                GamepadAxis::RightStickX,
                GamepadAxis::RightStickY,
            ];
            pad.get_just_pressed().next().is_some()
                || axes
                    .into_iter()
                    .any(|a| pad.get(a).is_some_and(|v| v.abs() > TOUCHED))
        };
        self.pad = self.pad.filter(|&p| pads.contains(p));
        let used = pads.iter().find(|(_, pad)| touched(pad)).map(|p| p.0);
        self.pad = used.or(self.pad).or(pads.iter().next().map(|p| p.0));
        // A mouse that trembles on the table is not used.
        let at_desk = keys.get_just_pressed().next().is_some()
            || mouse.get_just_pressed().next().is_some()
            || travelled.length() > 4.0;
        if used.is_some() {
            self.device = Device::Pad;
        } else if at_desk || self.pad.is_none() {
            self.device = Device::Keys;
        }
    }

    fn update(&mut self, store: &CentralInputStore, attention: Attention, dt: f32) {
        let pad = self.pad.unwrap_or(Entity::PLACEHOLDER);
        let now = Instant::now();
        self.state.tick(now, now);
        let strange = [ModifierKey::Control, ModifierKey::Alt, ModifierKey::Super]
            .map(Part::Modifier)
            .into_iter()
            .filter(|m| m.is_down(store, pad))
            .collect::<Vec<_>>();
        let mut began = vec![false; self.mains.len()];
        let mut down = vec![false; self.mains.len()];
        for (i, (main, before)) in self.mains.iter_mut().enumerate() {
            down[i] = main.is_down(store, pad);
            began[i] = down[i] && !*before;
            *before = down[i];
        }
        // For each last part that went down: the binding that it was meant for.
        let mut best: Vec<Option<(bool, usize)>> = vec![None; self.mains.len()];
        let mut fits = vec![false; self.bounds.len()];
        for (i, bound) in self.bounds.iter().enumerate() {
            let heard = heard(bound, attention);
            let whole = self.whole(bound, store, pad);
            let free = bound.control.is_loose()
                || bound.parts[0].device() == Device::Pad
                || strange.iter().all(|m| bound.parts.contains(m));
            if let Some(special) = heard
                && began[bound.main]
                && whole
                && free
            {
                fits[i] = true;
                let rank = Some((special, bound.parts.len()));
                best[bound.main] = best[bound.main].max(rank);
            }
        }
        let mut tapped = Vec::new();
        let mut used = Vec::new();
        for (i, fits) in fits.into_iter().enumerate() {
            let whole = self.whole(&self.bounds[i], store, pad);
            let bound = &mut self.bounds[i];
            let heard = heard(bound, attention);
            let rank = heard.map(|special| (special, bound.parts.len()));
            if fits && rank == best[bound.main] {
                used.extend(bound.parts[..bound.parts.len() - 1].iter().copied());
                let patient = bound.control.is_patient() && bound.begins_chord;
                bound.waiting = patient;
                bound.active = !patient;
            } else {
                bound.active &= whole && heard.is_some();
            }
            if bound.waiting && !down[bound.main] {
                bound.waiting = false;
                tapped.push(bound.control);
            }
        }
        for bound in &mut self.bounds {
            // The button has been part of something else.
            bound.waiting &= !used.contains(&self.mains[bound.main].0);
        }
        for &control in Control::ALL {
            if control.is_stick() {
                let inputs = self.map.get_dual_axislike(&control);
                let pair = inputs
                    .into_iter()
                    .flatten()
                    .map(|i| i.axis_pair(store, pad))
                    .sum();
                self.state.set_axis_pair(&control, pair);
                continue;
            }
            let held = self.bounds.iter().any(|b| b.control == control && b.active);
            if held || tapped.contains(&control) {
                self.state.press(&control);
            } else {
                self.state.release(&control);
            }
        }
        self.repeat(dt);
    }

    fn whole(&self, bound: &Bound, store: &CentralInputStore, pad: Entity) -> bool {
        let inputs = self.map.get_buttonlike(&bound.control);
        inputs
            .and_then(|i| i.get(bound.index))
            .is_some_and(|i| i.pressed(store, pad))
    }

    fn repeat(&mut self, dt: f32) {
        self.fired.clear();
        let state = &self.state;
        self.repeats.retain(|(control, _)| state.pressed(control));
        for (control, left) in &mut self.repeats {
            *left -= dt;
            if *left <= 0.0 {
                // A frame that took long is one step all the same.
                *left = REPEAT;
                self.fired.push(*control);
            }
        }
        for control in self.state.get_just_pressed() {
            self.fired.push(control);
            self.repeats.push((control, HOLD));
        }
    }
}

/// Whether a binding is listened to now, and if so whether rather than what the same key does in the
/// view.
fn heard(bound: &Bound, attention: Attention) -> Option<bool> {
    if attention.rebinding {
        return None;
    }
    let device = bound.parts[0].device();
    let on_keys = device == Device::Keys;
    let context = bound.control.context();
    let letter = |part: &Part| match part {
        // What leaves a field is heard in it.
        Part::Key(KeyCode::Escape) => context == Context::View,
        Part::Key(key) => !is_function(*key),
        _ => false,
    };
    let chord = bound.parts.iter().any(|p| {
        matches!(p, Part::Modifier(m) if *m != ModifierKey::Shift) && bound.parts.len() > 1
    });
    // Letters belong to the field that is typed into, and Ctrl with letters too.
    let typed = on_keys && attention.text && bound.parts.iter().any(letter);
    let open = match context {
        Context::Typing => attention.keyboard,
        _ if !on_keys && attention.keyboard => false,
        Context::Everywhere => !typed,
        Context::Panel => attention.panel && !typed,
        Context::Stretch => attention.stretching && !typed,
        // Keys without Ctrl or Alt are the panel's that has the focus.
        Context::View => {
            let taken = on_keys && attention.panel && !chord && bound.parts.iter().any(letter);
            !typed && !taken
        }
    };
    open.then_some(context != Context::View)
}

fn is_function(key: KeyCode) -> bool {
    use KeyCode::*;
    matches!(
        key,
        F1 | F2 | F3 | F4 | F5 | F6 | F7 | F8 | F9 | F10 | F11 | F12
    )
}
