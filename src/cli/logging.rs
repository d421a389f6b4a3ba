//! What the program logs: errors, and its own warnings, on standard error, or what `RUST_LOG` asks for. The editor also
//! keeps warnings of all libraries and the steps of the program in a file that outlives its window.

use crate::planet::printable::printable;
use log::{Level, Log, Metadata, Record};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// The log of this run and earlier ones, and the one that it followed once that was long.
const NAME: &str = "tellus.log";
const BEFORE: &str = "tellus-before.log";
/// A file of this length is followed by another.
const MOST_BYTES: u64 = 1 << 20;

/// A log file; None as long as none is kept.
type Kept = Arc<Mutex<Option<LogFile>>>;

/// The log file of the process.
#[cfg_attr(not(feature = "editor"), allow(dead_code, reason = "the editor alone keeps a file"))]
pub(super) struct Logging(Kept);

impl Logging {
    /// Sets up logging. A program that embeds this one may have a logger already.
    pub(super) fn start() -> Self {
        let kept = Kept::default();
        let mut terminal =
            env_logger::Builder::from_env(env_logger::Env::default().default_filter_or("error,tellus=warn"));
        if std::env::var_os(env_logger::DEFAULT_FILTER_ENV).is_none() {
            // As all commands tell what is wrong. Who sets the filter wants to know time and place, too.
            terminal.format(|out, record| {
                let kind = if record.level() == Level::Error { "error" } else { "warning" };
                writeln!(out, "{kind}: {}", printable(&record.args().to_string()))
            });
        }
        let terminal = terminal.build();
        let most = terminal.filter().max(Level::Info.to_level_filter());
        if log::set_boxed_logger(Box::new(Both { terminal, file: kept.clone() })).is_ok() {
            log::set_max_level(most);
        }
        Self(kept)
    }

    /// Keeps a log in a folder from now on. Without one the program works as well.
    #[cfg_attr(not(feature = "editor"), allow(dead_code, reason = "the editor alone keeps a file"))]
    pub(super) fn keep_in(&self, folder: &Path) {
        match LogFile::open(folder) {
            Ok(file) => *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(file),
            Err(error) => log::warn!("{}: no log is kept: {error}", folder.display()),
        }
        log::info!("Tellus {} begins", env!("CARGO_PKG_VERSION"));
    }
}

/// The terminal and the file.
struct Both {
    terminal: env_logger::Logger,
    file: Kept,
}

impl Log for Both {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        self.terminal.enabled(metadata) || is_kept(metadata)
    }

    fn log(&self, record: &Record<'_>) {
        self.terminal.log(record);
        if is_kept(record.metadata())
            && let Some(file) = &mut *self.file.lock().unwrap_or_else(PoisonError::into_inner)
        {
            file.write(record);
        }
    }

    fn flush(&self) {
        self.terminal.flush();
    }
}

/// Whether the file gets it: warnings of all libraries, and what this one tells.
fn is_kept(metadata: &Metadata<'_>) -> bool {
    let most = if metadata.target().starts_with("tellus") { Level::Info } else { Level::Warn };
    metadata.level() <= most
}

struct LogFile {
    path: PathBuf,
    file: File,
    bytes: u64,
    begun: Instant,
}

impl LogFile {
    fn open(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let path = folder.join(NAME);
        if fs::metadata(&path).is_ok_and(|found| found.len() >= MOST_BYTES) {
            fs::rename(&path, folder.join(BEFORE))?;
        }
        let file = OpenOptions::new().create(true).append(true).open(&path)?;
        let bytes = file.metadata()?.len();
        Ok(Self { path, file, bytes, begun: Instant::now() })
    }

    /// Writes a line. Nobody is told where that fails: it would be logged.
    fn write(&mut self, record: &Record<'_>) {
        if self.bytes >= MOST_BYTES
            && let Some(Ok(next)) = self.path.parent().map(Self::open)
        {
            *self = Self { begun: self.begun, ..next };
        }
        let (secs, id) = (self.begun.elapsed().as_secs_f64(), std::process::id());
        let text = printable(&record.args().to_string()).replace('\n', " / ");
        let line = format!("{id} {secs:10.3} s {} {}: {text}\n", record.level(), record.target());
        // One call: another window may write to the same file.
        if self.file.write_all(line.as_bytes()).is_ok() {
            self.bytes += line.len() as u64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(file: &mut LogFile, text: &str) {
        file.write(&Record::builder().level(Level::Warn).target("tellus::test").args(format_args!("{text}")).build());
    }

    #[test]
    fn a_log_goes_on_over_runs_has_a_line_for_each_record_and_is_followed_by_another_once_it_is_long() {
        let folder = tempfile::tempdir().unwrap();
        for run in 0..2 {
            record(&mut LogFile::open(folder.path()).unwrap(), &format!("run {run}\nwith \u{1b}[31mcolour"));
        }
        let text = fs::read_to_string(folder.path().join(NAME)).unwrap();
        assert_eq!(text.lines().count(), 2, "{text}");
        assert!(text.contains("WARN tellus::test: run 0 / with ") && !text.contains('\u{1b}'), "{text}");
        let mut file = LogFile::open(folder.path()).unwrap();
        let long = "x".repeat(10_000);
        (0..120).for_each(|_| record(&mut file, &long));
        let [new, old] = [NAME, BEFORE].map(|name| fs::metadata(folder.path().join(name)).unwrap().len());
        assert!((MOST_BYTES..MOST_BYTES + 20_000).contains(&old) && new < MOST_BYTES, "{old} {new}");
    }

    #[test]
    fn the_file_gets_warnings_of_all_and_the_steps_of_the_program() {
        let kept = |target: &str, level| is_kept(&Metadata::builder().target(target).level(level).build());
        assert!(kept("wgpu_core::device", Level::Warn) && !kept("wgpu_core::device", Level::Info));
        assert!(kept("tellus::editor", Level::Info) && !kept("tellus::frame", Level::Debug));
    }
}
