//! Looking for a runtime that is gone, off the frame.

use std::sync::Mutex;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use crate::runtime::{Connection, RuntimeFault};

/// Between two looks.
const PAUSE: Duration = Duration::from_secs(2);

/// Looks for a runtime in a thread of its own: opening one may take many seconds.
#[derive(Default)]
pub(super) struct Search {
    on: bool,
    next: Option<Instant>,
    look: Option<Mutex<Receiver<Result<Connection, RuntimeFault>>>>,
    last: Option<RuntimeFault>,
}

impl Search {
    /// Whether one is looked for.
    pub fn is_on(&self) -> bool {
        self.on
    }

    /// From now on.
    pub fn soon(&mut self) {
        self.next = None;
        self.last = None;
    }

    /// From a moment later on: what was lost has to let go first.
    pub fn after_a_loss(&mut self) {
        self.on = true;
        self.last = None;
        self.next = Some(Instant::now() + PAUSE);
    }

    /// Not before a while: an attempt came to nothing.
    pub fn pause(&mut self) {
        self.on = true;
        self.next = Some(Instant::now() + PAUSE);
    }

    /// It is found.
    pub fn rest(&mut self) {
        *self = Self::default();
    }

    /// Whether a fault is another one than before.
    pub fn is_news(&mut self, fault: &RuntimeFault) -> bool {
        // Right after a loss it is no news that nothing answers.
        let news = self.last.as_ref() != Some(fault)
            && !(self.on && self.last.is_none() && *fault == RuntimeFault::NoRuntime);
        self.last = Some(fault.clone());
        news
    }

    /// What came of the look that is under way; begins another one in its time.
    pub fn look(&mut self, now: Instant) -> Option<Result<Connection, RuntimeFault>> {
        self.on = true;
        if let Some(look) = &mut self.look {
            let found = match look.get_mut() {
                Ok(receiver) => receiver.try_recv(),
                Err(_) => Err(TryRecvError::Disconnected),
            };
            return match found {
                Ok(found) => {
                    self.look = None;
                    self.next = Some(now + PAUSE);
                    Some(found)
                }
                Err(TryRecvError::Empty) => None,
                Err(TryRecvError::Disconnected) => {
                    self.look = None;
                    self.next = Some(now + PAUSE);
                    None
                }
            };
        }
        if self.next.is_none_or(|next| now >= next) {
            let (sender, receiver) = channel();
            let thread = std::thread::Builder::new().name("headset search".to_owned());
            let begun = thread.spawn(move || {
                // Nobody may be waiting any more.
                let _ = sender.send(Connection::open());
            });
            if begun.is_ok() {
                self.look = Some(Mutex::new(receiver));
            }
            self.next = Some(now + PAUSE);
        }
        None
    }
}
