//! Many points for `tellus sample`: `LAT,LON` a line in, a JSON object or a height a line out.
//!
//! Lines are answered in batches on all cores. A batch of a pipe ends where the next line has not come yet, so that a
//! program may write a line and wait for its answer.

use super::sample::{Moment, as_json};
use super::{Failure, args, print_on};
use crate::planet::open::{Opened, open};
use crate::sphere::{LatLon, curve};
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use rayon::prelude::*;
use serde_json::json;
use std::fmt::Display;
use std::io::{self, BufRead as _, BufReader, Read};
use std::path::Path;

/// Most points of a batch, and of one of heights alone.
const BATCH: usize = 4096;
const HEIGHTS: usize = 1 << 17;
/// Points of a task. Lines that follow each other are often close together on the ground: a thread then builds the
/// river blocks around them once.
const TASK: usize = 32;
/// Longest line in bytes: no location is longer.
const LONGEST: u64 = 4096;

/// Lines of locations.
pub(super) struct Points {
    /// For messages.
    name: String,
    lines: BufReader<Box<dyn Read>>,
    /// The number of the last line that was read, from 1.
    number: usize,
    /// Whether all lines are there already: nobody waits for an answer.
    is_file: bool,
}

/// A line of the input.
enum Line {
    Place {
        lat: f64,
        lon: f64,
    },
    /// An empty line or a comment.
    Other,
    End,
}

impl Points {
    /// Opens a file, or standard input for `-`.
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        let (name, lines, is_file): (String, Box<dyn Read>, bool) = if path == Path::new("-") {
            ("standard input".to_owned(), Box::new(io::stdin()), false)
        } else {
            let file = open(path).map_err(|error| format!("{}: {error}", path.display()))?;
            let file = match file {
                Opened::File(file) => file,
                Opened::Folder => return Err(format!("{}: is a folder; name a file", path.display()).into()),
                Opened::Special => {
                    let why =
                        "is a device or a pipe, not a file; name a file, or - and give the points to standard input";
                    return Err(format!("{}: {why}", path.display()).into());
                }
            };
            (path.display().to_string(), Box::new(file), true)
        };
        Ok(Self { name, lines: BufReader::with_capacity(1 << 16, lines), number: 0, is_file })
    }

    /// Prints all that is known of each point. What stands before a wrong line is answered.
    pub(super) fn answer(self, terrain: &Terrain, moment: &Moment) -> Result<(), Failure> {
        self.answer_with(BATCH, |places| answers(terrain, moment, places))
    }

    /// As [`Points::answer`], with heights alone, metres.
    pub(super) fn answer_heights(self, terrain: &Terrain) -> Result<(), Failure> {
        self.answer_with(HEIGHTS, |places| heights(terrain, places))
    }

    fn answer_with(mut self, most: usize, answers: impl Fn(&[(f64, f64)]) -> Vec<String>) -> Result<(), Failure> {
        let mut batch = Vec::with_capacity(most);
        loop {
            let line = self.next();
            if let Ok(Line::Place { lat, lon }) = line {
                batch.push((lat, lon));
            }
            let goes_on = matches!(line, Ok(Line::Place { .. } | Line::Other));
            let has_line = goes_on && batch.len() < most && (self.is_file || self.lines.buffer().contains(&b'\n'));
            if !has_line && !batch.is_empty() {
                if !print_on(&answers(&batch).join("\n"))? {
                    return Ok(());
                }
                batch.clear();
            }
            if let Line::End = line? {
                return Ok(());
            }
        }
    }

    fn next(&mut self) -> Result<Line, Failure> {
        self.number += 1;
        let wrong = |error: &dyn Display| format!("{}:{}: {error}", self.name, self.number);
        let mut bytes = Vec::new();
        let read = (&mut self.lines).take(LONGEST).read_until(b'\n', &mut bytes);
        if read.map_err(|error| format!("{}: {error}", self.name))? == 0 {
            return Ok(Line::End);
        }
        if bytes.len() as u64 == LONGEST && !bytes.ends_with(b"\n") {
            return Err(wrong(&"this line is too long; write LAT,LON such as 20,-45").into());
        }
        let text = String::from_utf8_lossy(&bytes);
        let text = text.trim_start_matches('\u{feff}').trim();
        if text.is_empty() || text.starts_with('#') {
            return Ok(Line::Other);
        }
        let (lat, lon) = args::location(text).map_err(|error| wrong(&error))?;
        Ok(Line::Place { lat, lon })
    }
}

fn answers(terrain: &Terrain, moment: &Moment, places: &[(f64, f64)]) -> Vec<String> {
    let tasks = places.par_chunks(TASK).map_init(Scratch::default, |scratch, places| {
        let dirs: Vec<_> = places.iter().map(|&(lat, lon)| LatLon::from_degrees(lat, lon).direction()).collect();
        let mut samples = vec![Sample::default(); dirs.len()];
        terrain.samples_spaced_into(&dirs, 0.0, Wanted::ALL, &mut samples, scratch);
        let answer = |((&(lat, lon), &dir), sample)| {
            let mut answer = as_json(terrain, dir, sample, &terrain.layers_m(dir), moment);
            answer["lat"] = json!(lat);
            answer["lon"] = json!(lon);
            answer.to_string()
        };
        places.iter().zip(&dirs).zip(&samples).map(answer).collect::<Vec<_>>()
    });
    tasks.collect::<Vec<_>>().concat()
}

/// Heights in metres, some lines at a time. They are asked along a curve that keeps neighbours together.
fn heights(terrain: &Terrain, places: &[(f64, f64)]) -> Vec<String> {
    let place = |(number, &(lat, lon)): (usize, &(f64, f64))| {
        let dir = LatLon::from_degrees(lat, lon).direction();
        (curve::place(dir), number, dir)
    };
    let mut along: Vec<_> = places.par_iter().enumerate().map(place).collect();
    along.par_sort_unstable_by_key(|(place, number, _)| (*place, *number));
    let dirs: Vec<_> = along.iter().map(|(.., dir)| *dir).collect();
    let mut in_order = vec![0.0; places.len()];
    for ((_, number, _), height_m) in along.iter().zip(terrain.heights_m(&dirs)) {
        in_order[*number] = height_m;
    }
    let lines = |heights_m: &[f64]| heights_m.iter().map(f64::to_string).collect::<Vec<_>>().join("\n");
    in_order.par_chunks(BATCH).map(lines).collect()
}
