//! The processes of a scenario: a display, the runtime, the app.

use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Process, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use midair_studio::command::Command;
use serde_json::Value;

/// The app that is tested.
pub const MIDAIR: &str = "/target/debug/midair";
/// Where scenarios leave what they made.
pub const OUT: &str = "/out";

/// After so long something that is waited for is taken to be a fault. Nothing is told by it: a machine that has other
/// work, or whose shaders are compiled first, may take long for a frame.
const PATIENCE: Duration = Duration::from_secs(120);

/// So many frames as well: where one takes seconds, more of them are waited for.
const FRAMES: u64 = 300;

/// Polls until something holds; says how many seconds it took.
pub fn until(what: &str, mut holds: impl FnMut() -> Result<bool>) -> Result<f64> {
    let begin = Instant::now();
    loop {
        if holds()? {
            return Ok(begin.elapsed().as_secs_f64());
        }
        if begin.elapsed() > PATIENCE {
            bail!("{what}: not within {} s", PATIENCE.as_secs());
        }
        sleep(Duration::from_millis(5));
    }
}

/// A process that ends with what it was started for.
pub struct Guard(pub Child);

impl Drop for Guard {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn log(name: &str) -> Result<File> {
    let path = Path::new(OUT).join(name);
    OpenOptions::new()
        .create(true)
        .append(true)
        .open(&path)
        .with_context(|| path.display().to_string())
}

/// A display that nobody sees.
pub fn display() -> Result<Guard> {
    fs::create_dir_all("/tmp/.X11-unix")?;
    let child = Process::new("Xvfb")
        .args([
            ":7",
            "-screen",
            "0",
            "1280x720x24",
            "-nolisten",
            "tcp",
            "-noreset",
        ])
        .stdout(log("xvfb.log")?)
        .stderr(log("xvfb.log")?)
        .spawn()
        .context("Xvfb")?;
    until(
        "the display",
        || Ok(Path::new("/tmp/.X11-unix/X7").exists()),
    )?;
    Ok(Guard(child))
}

/// The runtime.
pub struct Runtime {
    process: Guard,
}

impl Runtime {
    /// Controllers and head over the wire.
    pub fn remote() -> Result<Self> {
        let folder = Path::new("/tmp/cfg/monado");
        fs::create_dir_all(folder)?;
        fs::write(
            folder.join("config_v0.json"),
            r#"{"active":"remote","remote":{"version":0,"port":4242,"view_count":2}}"#,
        )?;
        Self::start(&[], "Listening on port")
    }

    /// A head that sways, and controllers of a kind.
    pub fn simulated(kind: &str) -> Result<Self> {
        let _ = fs::remove_dir_all("/tmp/cfg/monado");
        Self::start(
            &[
                ("SIMULATED_ENABLE", "1"),
                ("SIMULATED_LEFT", kind),
                ("SIMULATED_RIGHT", kind),
            ],
            "service has started",
        )
    }

    fn start(environment: &[(&str, &str)], ready: &str) -> Result<Self> {
        let socket = Path::new("/run/xr/monado_comp_ipc");
        let _ = fs::remove_file(socket);
        let _ = fs::remove_file("/run/xr/monado.pid");
        let path = Path::new(OUT).join("monado.log");
        let _ = fs::rename(&path, path.with_extension("before.log"));
        let child = Process::new("monado-service")
            .envs(environment.iter().copied())
            .env("XRT_COMPOSITOR_NULL", "1")
            .env("XRT_NO_STDIN", "1")
            .env("REMOTE_LOG", "info")
            // Otherwise it has the app sleep for as long as its slowest frames took, and forgets them slowly: after a few that
            // hung, an app that could draw thirty frames a second draws one.
            .env("U_PACING_APP_IMMEDIATE_WAIT_FRAME_RETURN", "true")
            .env("U_PACING_APP_USE_MIN_FRAME_PERIOD", "true")
            .stdin(Stdio::null())
            .stdout(log("monado.log")?)
            .stderr(log("monado.log")?)
            .spawn()
            .context("monado-service")?;
        let mut process = Guard(child);
        until("the runtime", || {
            if let Some(status) = process.0.try_wait()? {
                bail!("monado-service ended at once: {status}");
            }
            Ok(socket.exists() && fs::read_to_string(&path)?.contains(ready))
        })?;
        Ok(Self { process })
    }

    /// As when it crashes.
    pub fn kill(mut self) -> Result<()> {
        self.process.0.kill()?;
        self.process.0.wait()?;
        Ok(())
    }

    /// Whether it still runs.
    pub fn is_alive(&mut self) -> bool {
        matches!(self.process.0.try_wait(), Ok(None))
    }
}

/// The app, and what it says.
pub struct App {
    process: Guard,
    folder: PathBuf,
    said: BufReader<File>,
    partial: String,
    /// What it said last.
    pub now: Value,
    /// Everything it said.
    pub all: Vec<Value>,
    asked: u64,
    begun: Instant,
    /// Seconds from its start to the first frame in focus.
    pub focused: f64,
}

impl App {
    /// Starts it in a folder of its own.
    pub fn start(folder: &Path, arguments: &[&str]) -> Result<Self> {
        Self::start_with(folder, arguments, &[])
    }

    /// The same with variables of the environment.
    pub fn start_with(
        folder: &Path,
        arguments: &[&str],
        environment: &[(&str, &str)],
    ) -> Result<Self> {
        let talk = folder.join("talk");
        fs::create_dir_all(&talk)?;
        let said = talk.join("said.jsonl");
        File::create(&said)?;
        let errors = File::create(folder.join("midair.log"))?;
        let begun = Instant::now();
        let child = Process::new(MIDAIR)
            .args(arguments)
            .arg("--rehearse")
            .arg(&talk)
            .env("MIDAIR_HOME", folder.join("home"))
            .env("NO_COLOR", "1")
            .envs(environment.iter().copied())
            .stdin(Stdio::null())
            .stdout(errors.try_clone()?)
            .stderr(errors)
            .spawn()
            .context(MIDAIR)?;
        Ok(Self {
            process: Guard(child),
            folder: folder.to_owned(),
            said: BufReader::new(File::open(said)?),
            partial: String::new(),
            now: Value::Null,
            all: Vec::new(),
            asked: 0,
            begun,
            focused: f64::NAN,
        })
    }

    /// Seconds since it was started.
    pub fn age(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }

    /// Takes in what it has said since.
    pub fn listen(&mut self) -> Result<()> {
        loop {
            let read = self.said.read_line(&mut self.partial)?;
            if read == 0 || !self.partial.ends_with('\n') {
                return Ok(());
            }
            let value: Value = serde_json::from_str(&self.partial)?;
            self.partial.clear();
            self.now = value.clone();
            self.all.push(value);
        }
    }

    /// Waits until what it says fits.
    pub fn until(&mut self, what: &str, fits: impl Fn(&Value) -> bool) -> Result<f64> {
        let begin = Instant::now();
        // Lines said before, how many it had said when it last said one, and when that was.
        let first = self.all.len();
        let (mut heard, mut last) = (first, begin);
        loop {
            self.listen()?;
            if fits(&self.now) {
                return Ok(begin.elapsed().as_secs_f64());
            }
            let ended = self.process.0.try_wait()?;
            if self.all.len() > heard {
                (heard, last) = (self.all.len(), Instant::now());
            }
            // Frames that come, however late, are waited for.
            let late = begin.elapsed() > PATIENCE && (heard - first) as u64 > FRAMES;
            if ended.is_some() || late || last.elapsed() > PATIENCE {
                let why = ended.map_or_else(
                    || format!("not within {} s", begin.elapsed().as_secs()),
                    |status| format!("the app has ended ({status})"),
                );
                bail!("{what}: {why}; it said last: {}", self.now);
            }
            sleep(Duration::from_millis(5));
        }
    }

    /// Asks for something as a panel would, and waits until it is asked.
    pub fn ask(&mut self, command: &Command) -> Result<()> {
        self.say(&ron::to_string(command)?)
    }

    /// Gives it a line to read, and waits until it is read.
    pub fn say(&mut self, line: &str) -> Result<()> {
        let mut file = OpenOptions::new()
            .create(true)
            .append(true)
            .open(self.folder.join("talk/asks.ron"))?;
        writeln!(file, "{line}")?;
        self.asked += 1;
        let asked = self.asked;
        self.until("an ask arrives", |now| now["asked"] == asked)?;
        Ok(())
    }

    /// Waits until it ends by itself, or else until what it says fits; whether it has ended.
    pub fn ends_or(&mut self, fits: impl Fn(&Value) -> bool) -> Result<bool> {
        let mut ended = false;
        until("the app ends", || {
            self.listen()?;
            ended = self.process.0.try_wait()?.is_some();
            Ok(ended || fits(&self.now))
        })?;
        Ok(ended)
    }

    /// Ends it as a power cut would, once what was done so far is in its recording.
    pub fn kill(&mut self, recording: &str) -> Result<()> {
        // A piece is written for each second: the second one that comes was begun after now.
        for _ in 0..2 {
            let length = || Ok::<_, anyhow::Error>(fs::metadata(recording)?.len());
            let before = length()?;
            until("the recording is written", || Ok(length()? > before))?;
        }
        self.process.0.kill()?;
        self.process.0.wait()?;
        Ok(())
    }

    /// It has started itself again, and counts from the start.
    pub fn counts_again(&mut self) {
        self.asked = 0;
    }

    /// What it wrote to its log.
    pub fn log(&self) -> String {
        fs::read_to_string(self.folder.join("midair.log")).unwrap_or_default()
    }
}

/// Runs the app's command line to its end.
pub fn midair(arguments: &[&str]) -> Result<String> {
    let output = Process::new(MIDAIR)
        .args(arguments)
        .env("MIDAIR_HOME", "/tmp/home/midair")
        .output()
        .context(MIDAIR)?;
    if !output.status.success() {
        bail!(
            "midair {}: {}\n{}",
            arguments.join(" "),
            output.status,
            String::from_utf8_lossy(&output.stderr)
        );
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
