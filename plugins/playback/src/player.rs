use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use midair_studio::{
    StudioSet,
    command::Command,
    evaluate::Delivery,
    hands::{AdvanceHands, HandsInput, WriteHands},
    notice::Notices,
};

use crate::{
    Arrivals, Beat, Cursor, FrameBeat, OffFrame, PlayError, PlayOptions, Report, Session, SpeedGate,
};

/// Frames that may pass, hands still, until background work has settled.
const MAX_SETTLING: u32 = 2_000;
/// The fewest: what a frame's edit asks for may be asked for in the frame after.
const MIN_SETTLING: u32 = 2;
/// How often finished work is looked for.
const POLL: Duration = Duration::from_micros(200);

/// A session being played. Insert it and call [`prepare`] before every frame, as [`crate::play`]
/// does.
#[derive(Resource)]
pub struct Player {
    session: Arc<Session>,
    cursor: Cursor,
    /// A beat that has to wait until background work has settled.
    held: Option<Option<usize>>,
    settling: u32,
    current: Option<FrameBeat>,
    gate: Option<SpeedGate>,
    patience: Duration,
    paced: bool,
    probe: fn(&mut World) -> Report,
    frames: u64,
    time: Duration,
}

impl Player {
    /// Plays `session` from its start. The options' `probe` tells what there is, for
    /// [`crate::Step::Expect`]; where `hands_only`, a hand faster than [`crate::MAX_SPEED`] ends it.
    pub fn new(session: Arc<Session>, options: &PlayOptions) -> Self {
        Self {
            cursor: session.cursor(),
            session,
            held: None,
            settling: 0,
            current: None,
            gate: options.hands_only.then(SpeedGate::default),
            patience: options.patience,
            paced: options.paced,
            probe: options.probe,
            frames: 0,
            time: Duration::ZERO,
        }
    }

    /// The session.
    pub fn session(&self) -> &Arc<Session> {
        &self.session
    }

    /// Frames played so far, without those that only waited.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Session time played so far.
    pub fn time(&self) -> Duration {
        self.time
    }

    /// The frame that is being played; `None` in one that only waits.
    pub fn current(&self) -> Option<&FrameBeat> {
        self.current.as_ref()
    }
}

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// A frame: `app.update()`.
    Frame,
    /// Nothing: the session is over and all background work is done.
    Done,
}

/// Writes the frame that [`prepare`] chose into the hands, where a device would.
pub struct PlayerPlugin;

impl Plugin for PlayerPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Arrivals>()
            .add_message::<Command>()
            .add_systems(
                Update,
                write
                    // The hands of this frame are made from what is written here.
                    .in_set(WriteHands)
                    .in_set(StudioSet::Gather)
                    .before(AdvanceHands)
                    .run_if(resource_exists::<Player>),
            );
    }
}

fn write(player: Res<Player>, mut input: ResMut<HandsInput>, mut ask: MessageWriter<Command>) {
    match &player.current {
        Some(beat) => {
            *input = beat.input;
            ask.write_batch(beat.commands.iter().cloned());
        }
        None => *input = *player.cursor.now(),
    }
}

/// Chooses the next frame: sets its time and what it takes in, waiting for the results it needs.
/// To be called between frames; waits at most the player's patience.
pub fn prepare(world: &mut World) -> Result<Next, PlayError> {
    if !world.contains_resource::<Player>() {
        return Ok(Next::Done);
    }
    world.init_resource::<Arrivals>();
    world.resource_scope(|world, work: Mut<Arrivals>| {
        world.resource_scope(|world, mut player: Mut<Player>| player.prepare(world, &*work.0))
    })
}

impl Player {
    fn prepare(&mut self, world: &mut World, work: &dyn OffFrame) -> Result<Next, PlayError> {
        loop {
            let held = match self.held.take() {
                Some(held) => held,
                None => match self.cursor.next() {
                    Some(Beat::Frame(beat)) => {
                        self.begin(world, work, beat)?;
                        return Ok(Next::Frame);
                    }
                    Some(Beat::Check(step)) => Some(step),
                    None => None,
                },
            };
            // Checks, and the end, wait until everything asked for has arrived.
            if !self.settled(world, work)? {
                self.held = Some(held);
                self.current = None;
                self.set_time(world, self.session.dt());
                work.deliver(
                    world,
                    if self.paced {
                        Delivery::AsTheyCome
                    } else {
                        Delivery::All
                    },
                );
                return Ok(Next::Frame);
            }
            self.settling = 0;
            match held {
                Some(step) => self.expect(world, step)?,
                None => {
                    // Asked again, it is still over.
                    self.held = Some(None);
                    self.settling = MIN_SETTLING;
                    return Ok(Next::Done);
                }
            }
        }
    }

    fn begin(
        &mut self,
        world: &mut World,
        work: &dyn OffFrame,
        beat: FrameBeat,
    ) -> Result<(), PlayError> {
        let session = self.session.clone();
        if let Some(gate) = &mut self.gate {
            gate.check(beat.dt, &beat.input, || session.place(beat.step))?;
        }
        if self.paced {
            work.deliver(world, Delivery::AsTheyCome);
        } else if session.is_recorded() {
            for &job in &beat.ready {
                self.wait(world, work, |world| {
                    work.is_waiting(world, job) || work.unfinished(world) == 0
                })?;
                if !work.is_waiting(world, job) {
                    return Err(PlayError::Diverged {
                        at: session.place(beat.step),
                        frame: self.frames,
                    });
                }
            }
            work.deliver(world, Delivery::Exactly(beat.ready.clone()));
        } else {
            self.wait(world, work, |world| work.unfinished(world) == 0)?;
            work.deliver(world, Delivery::All);
        }
        self.set_time(world, beat.dt);
        self.frames += 1;
        self.time += beat.dt;
        self.current = Some(beat);
        Ok(())
    }

    /// Whether no background work is left, after at least a frame or two of rest.
    fn settled(&mut self, world: &mut World, work: &dyn OffFrame) -> Result<bool, PlayError> {
        self.wait(world, work, |world| work.unfinished(world) == 0)?;
        let quiet = work.waiting(world) == 0 && work.delivered(world).is_empty();
        if quiet && self.settling >= MIN_SETTLING {
            return Ok(true);
        }
        self.settling += 1;
        if self.settling > MAX_SETTLING {
            return Err(self.stuck(work.waiting(world)));
        }
        Ok(false)
    }

    fn expect(&self, world: &mut World, step: usize) -> Result<(), PlayError> {
        let Some(crate::Step::Expect(expectation)) = self.session.steps().get(step) else {
            return Ok(());
        };
        let mut report = (self.probe)(world);
        if let Some(notices) = world.get_resource::<Notices>() {
            report.warnings = notices.warnings().to_vec();
        }
        match expectation.failure(&report) {
            None => Ok(()),
            Some(what) => Err(PlayError::Expected {
                at: self.session.place(step),
                what,
            }),
        }
    }

    fn wait(
        &self,
        world: &World,
        work: &dyn OffFrame,
        done: impl Fn(&World) -> bool,
    ) -> Result<(), PlayError> {
        let since = Instant::now();
        while !done(world) {
            if since.elapsed() >= self.patience {
                return Err(self.stuck(work.unfinished(world)));
            }
            std::thread::sleep(POLL);
        }
        Ok(())
    }

    fn stuck(&self, jobs: usize) -> PlayError {
        let step = self.current.as_ref().map_or(0, |b| b.step);
        PlayError::Stuck {
            at: self.session.place(step),
            frame: self.frames,
            jobs,
            patience: self.patience,
        }
    }

    fn set_time(&self, world: &mut World, dt: Duration) {
        if let Some(mut real) = world.get_resource_mut::<Time<Real>>()
            // The clock's first update sets it and takes no time: the first frame is not it.
            && real.last_update().is_none()
        {
            real.update_with_duration(Duration::ZERO);
        }
        world.insert_resource(TimeUpdateStrategy::ManualDuration(dt));
    }
}
