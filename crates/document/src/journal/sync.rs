use std::fs::File;
use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// How long writes gather before they are forced to disk together.
const GATHER: Duration = Duration::from_millis(250);

/// The thread that forces what was written to disk, off the frame.
#[derive(Debug)]
pub(super) struct Syncer {
    handle: SyncHandle,
    thread: Option<JoinHandle<()>>,
}

/// Hands files to the thread.
#[derive(Clone, Debug)]
pub(super) struct SyncHandle(Arc<(Mutex<State>, Condvar)>);

#[derive(Debug, Default)]
struct State {
    journal: bool,
    files: Vec<File>,
    stop: bool,
    error: Option<io::Error>,
}

impl SyncHandle {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Forces `file` to disk soon.
    pub(super) fn sync(&self, file: File) {
        self.state().files.push(file);
        self.0.1.notify_all();
    }
}

impl Syncer {
    pub(super) fn start(journal: File) -> io::Result<Self> {
        let handle = SyncHandle(Arc::default());
        let theirs = handle.clone();
        let thread = std::thread::Builder::new()
            .name("journal".into())
            .spawn(move || run(&theirs, &journal))?;
        Ok(Self {
            handle,
            thread: Some(thread),
        })
    }

    pub(super) fn handle(&self) -> SyncHandle {
        self.handle.clone()
    }

    /// The journal was written to.
    pub(super) fn wake(&self) {
        self.handle.state().journal = true;
        self.handle.0.1.notify_all();
    }

    pub(super) fn take_error(&self) -> Option<io::Error> {
        self.handle.state().error.take()
    }
}

fn run(handle: &SyncHandle, journal: &File) {
    let signal = &handle.0.1;
    let mut state = handle.state();
    loop {
        while !state.journal && state.files.is_empty() && !state.stop {
            state = signal.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        if !state.stop {
            (state, _) = signal
                .wait_timeout_while(state, GATHER, |s| !s.stop)
                .unwrap_or_else(PoisonError::into_inner);
        }
        let wrote = std::mem::take(&mut state.journal);
        let files = std::mem::take(&mut state.files);
        let stop = state.stop;
        drop(state);
        // Meshes first: the steps that use them are in the journal.
        let mut done: io::Result<()> = files.iter().try_for_each(File::sync_data);
        if wrote {
            done = done.and(journal.sync_data());
        }
        state = handle.state();
        if let Err(e) = done {
            state.error = Some(e);
        }
        if stop && !state.journal && state.files.is_empty() {
            return;
        }
    }
}

impl Drop for Syncer {
    fn drop(&mut self) {
        self.handle.state().stop = true;
        self.handle.0.1.notify_all();
        if let Some(thread) = self.thread.take() {
            // It never panics; if it did, there is nothing left to flush.
            let _ = thread.join();
        }
    }
}
