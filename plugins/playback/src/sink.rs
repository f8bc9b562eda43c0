//! Lines to a file, off the frame: a slow disk never stops a hand.

use std::{
    fs::File,
    io::{self, Seek, SeekFrom, Write},
    path::Path,
    sync::{
        Arc, OnceLock,
        mpsc::{Receiver, SyncSender, TrySendError, sync_channel},
    },
    thread::JoinHandle,
};

/// Lines that may wait for the disk: some seconds at worst, a minute as a rule.
const WAITING: usize = 4096;
/// What ends a session.
const TAIL: &str = "])\n";

/// A file that lines are sent to.
pub(crate) struct Sink {
    lines: Option<SyncSender<String>>,
    thread: Option<JoinHandle<()>>,
    fault: Arc<OnceLock<String>>,
}

impl Sink {
    /// Creates the file, with its first lines. Errors: the system's.
    pub fn create(path: &Path, head: &str) -> io::Result<Self> {
        let mut file = File::create(path)?;
        file.write_all(head.as_bytes())?;
        let (lines, inbox) = sync_channel(WAITING);
        let fault = Arc::new(OnceLock::new());
        let told = fault.clone();
        let good = head.len() as u64;
        let thread = std::thread::Builder::new()
            .name("session recorder".into())
            .spawn(move || {
                if let Err(e) = write(file, &inbox, good) {
                    // Only this thread sets it.
                    let _ = told.set(e.to_string());
                }
            })?;
        Ok(Self {
            lines: Some(lines),
            thread: Some(thread),
            fault,
        })
    }

    /// Sends one line. Errors: one clear reason why the recording has ended.
    pub fn send(&self, line: String) -> Result<(), String> {
        let Some(lines) = &self.lines else {
            return Err("it was closed".into());
        };
        match lines.try_send(line) {
            Ok(()) => Ok(()),
            Err(TrySendError::Full(_)) => Err("the disk does not keep up".into()),
            Err(TrySendError::Disconnected(_)) => Err(self.reason()),
        }
    }

    /// Why it has ended by itself, if it has.
    pub fn fault(&self) -> Option<&str> {
        self.fault.get().map(String::as_str)
    }

    /// Ends the file and waits for it. Errors: what kept it from being whole.
    pub fn close(&mut self) -> Result<(), String> {
        drop(self.lines.take());
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            return Err(self.reason());
        }
        match self.fault() {
            None => Ok(()),
            Some(fault) => Err(fault.to_owned()),
        }
    }

    fn reason(&self) -> String {
        self.fault().unwrap_or("its writer stopped").to_owned()
    }
}

impl Drop for Sink {
    fn drop(&mut self) {
        // Whoever cares about the outcome has closed it before.
        let _ = self.close();
    }
}

fn write(mut file: File, inbox: &Receiver<String>, mut good: u64) -> io::Result<()> {
    let written = (|| {
        while let Ok(line) = inbox.recv() {
            file.write_all(line.as_bytes())?;
            good += line.len() as u64;
            // With the disk behind: one flush for all that wait.
            while let Ok(line) = inbox.try_recv() {
                file.write_all(line.as_bytes())?;
                good += line.len() as u64;
            }
            flush(&file)?;
        }
        file.write_all(TAIL.as_bytes())?;
        flush(&file)
    })();
    if written.is_err() {
        // Back to the last whole line, so that what there is plays; with luck its end fits too.
        let _ = file
            .set_len(good)
            .and_then(|()| file.seek(SeekFrom::Start(good)))
            .and_then(|_| file.write_all(TAIL.as_bytes()));
    }
    written
}

fn flush(file: &File) -> io::Result<()> {
    match file.sync_data() {
        // A pipe or device that cannot be flushed is not full.
        Err(e) if e.kind() == io::ErrorKind::InvalidInput => Ok(()),
        other => other,
    }
}
