//! From the crossings of a run to an inlet stream, also while the run is still being written.
//!
//! [`replay`] opens the files of the run ([`run_file`], [`head`]) and gives their events to the [`replayer`]. Each crossing gets the state in
//! which it is generated ([`generation`]), waits in the [`queue`] for those that are generated before it, is merged with copies
//! ([`merge`]), and is written with its contacts and bonds ([`pairs`], [`send`]).

mod copies;
mod frame;
mod generation;
mod head;
mod merge;
mod pairs;
mod queue;
mod replayer;
mod request;
mod run_file;
mod send;

pub use copies::Copies;
pub use frame::Frame;
pub use request::{FAR, Intervals, Passage, Replay, Replayed};

use crate::StageError;
use replayer::Replayer;
use scene::input::Source;
use std::io::Write;
use stream::mcap::{Provenance, StreamOptions, Writer};

/// Passes the crossings of a run on as an inlet stream, each as soon as it is read. A run that was stopped and resumed is several files
/// (`runs`, with their names), in the order of their times: of each counts what lies before the next begins.
///
/// # Errors
/// A stream that is not a run with an outlet, breaks off, or was stopped before its end; a run that begins later than what is asked for,
/// or files that do not follow each other; a length that is too short.
pub fn replay<W: Write>(
    runs: Vec<(String, Source)>,
    what: &Replay,
    out: W,
    (mut provenance, how): (Provenance, StreamOptions<W>),
) -> Result<(Replayed, W), StageError> {
    let (mut runs, head) = run_file::open(runs, what)?;
    provenance.inputs.extend(runs.iter().filter_map(|r| r.scene.clone()));
    let mut writer = Writer::compressed(out, &provenance, how)?;
    head.write(what, &mut writer)?;
    let start = if what.keep_times { Some(0.0) } else { what.from };
    let mut replayer = Replayer::new(what, head, start, writer);
    for k in 0..runs.len() {
        let limit = runs.get(k + 1).map_or(f64::INFINITY, |next| next.begins);
        replayer.begin(&runs[k].name, limit);
        while let Some(event) = runs[k].next().transpose()? {
            if replayer.pass(event)? {
                break;
            }
        }
        if replayer.enough() {
            break;
        }
        if k + 1 < runs.len() && !replayer.over() {
            return Err(runs[k].gap(&runs[k + 1], replayer.known).into());
        }
    }
    if let (Some(stop), Some(last)) = (&replayer.stopped, runs.last()) {
        // The stream has no end record: readers downstream must not take it for whole.
        replayer.writer.flush_chunk()?;
        return Err(replayer::was_stopped(stop, &last.name).into());
    }
    replayer.again()?;
    replayer.send(f64::INFINITY)?;
    replayer.end()?;
    // The reader downstream may go on; whether the run is whole is checked after that.
    let out = replayer.writer.finish()?;
    if let Some(last) = runs.last_mut() {
        while last.next().transpose()?.is_some() {}
    }
    replayer.done.start = replayer.start.unwrap_or(0.0);
    replayer.done.ahead = replayer.generation.ahead();
    Ok((replayer.done, out))
}
