//! Options of commands that work long: number of threads, and progress on standard error.

use super::{Failure, args, tell};
use clap::ValueEnum;
use serde_json::json;
use std::io::IsTerminal as _;
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Threads and progress.
#[derive(clap::Args)]
pub(super) struct WorkArgs {
    /// Threads to work on [default: one for each core]
    #[arg(long, value_name = "N", value_parser = |text: &str| args::whole(text, 1_u16, 1024))]
    threads: Option<u16>,
    /// How work that takes long tells its progress on standard error. auto: a percentage that counts up at a terminal,
    /// elsewhere a line a minute. json: lines of objects with progress, share, elapsed_s and left_s
    #[arg(long, value_name = "HOW", value_enum, default_value = "auto")]
    progress: How,
}

/// Form of the progress on standard error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum How {
    Auto,
    Json,
    None,
}

/// Form of the progress that the command line asked for.
static HOW: OnceLock<How> = OnceLock::new();

impl WorkArgs {
    /// Sets up the threads of this process and how it tells its progress. Once, before any work.
    pub(super) fn begin(&self) -> Result<(), Failure> {
        let _ = HOW.set(self.progress);
        let Some(threads) = self.threads else { return Ok(()) };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global();
        pool.map_err(|error| format!("cannot start {threads} threads: {error}; use fewer").into())
    }
}

/// Time before the first percentage at a terminal, and between lines elsewhere.
const PATIENCE: Duration = Duration::from_secs(2);
const LINES: Duration = Duration::from_secs(60);
/// Least time between two objects.
const OBJECTS: Duration = Duration::from_millis(500);

/// Tells how much of some work is done. `what` has become of it: `baked`.
pub(super) fn told(what: &'static str) -> impl Fn(f64) -> bool + Sync {
    let (start, how) = (Instant::now(), HOW.get().copied().unwrap_or(How::Auto));
    let is_read = std::io::stderr().is_terminal();
    // Time and percentage of the last line.
    let last: Mutex<Option<(Instant, u32)>> = Mutex::new(None);
    move |done| {
        let percent = (done * 100.0) as u32;
        let mut last = last.lock().unwrap_or_else(PoisonError::into_inner);
        let (before, told) = last.unwrap_or((start, 0));
        let (elapsed, since) = (start.elapsed(), before.elapsed());
        let is_due = match how {
            How::None => false,
            How::Json => last.is_none() || since >= OBJECTS || percent >= 100,
            How::Auto if is_read => elapsed > PATIENCE,
            How::Auto => since >= LINES || (percent >= 100 && last.is_some()),
        };
        if !is_due || (percent <= told && last.is_some()) {
            return true;
        }
        *last = Some((Instant::now(), percent));
        let elapsed_s = elapsed.as_secs_f64();
        let left_s = (done > 0.0).then(|| elapsed_s * (1.0 - done) / done);
        match how {
            How::Json => {
                let object = json!({ "progress": what, "share": done, "elapsed_s": elapsed_s, "left_s": left_s });
                tell(&object.to_string());
            }
            _ if is_read => eprint!("\r{what}: {percent}%{}", if percent < 100 { "" } else { "\n" }),
            _ => tell(&format!("{what}: {percent}%{}", left_s.map_or(String::new(), |s| format!(", {s:.0} s left")))),
        }
        true
    }
}

/// Words for a time.
pub(super) fn in_words(secs: f64) -> String {
    match secs {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 100.0 * 60.0 => format!("{:.0} minutes", s / 60.0),
        s => format!("{:.0} hours", s / 3600.0),
    }
}
