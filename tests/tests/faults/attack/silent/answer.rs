//! What a call answers: its output without its origin, and its warnings.

use super::call::Call;
use grainpipe_tests::tools::tool;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use stream::mcap::{Event, PROVENANCE, Reader};
use tempfile::TempDir;

/// The report holds times and the options as they were given.
pub const REPORT: &str = "report.json";

/// A folder with the files that calls read.
pub struct Shop {
    /// The folder.
    pub folder: TempDir,
    /// Their names.
    pub inputs: BTreeSet<String>,
    /// Metadata of runs that is not compared, besides where they come from.
    pub unseen: &'static [&'static str],
}

/// What a call answered.
pub struct Answer {
    /// Its exit code.
    pub code: i32,
    /// All that it printed, its last line included, which sums up what was done.
    pub told: String,
    /// A number for what each file holds, and for stdout.
    pub output: BTreeMap<String, u64>,
}

impl Shop {
    /// Runs a call in a separate folder.
    pub fn answer(&self, call: &Call) -> Answer {
        let folder = tempfile::tempdir().expect("a folder");
        let inputs: BTreeSet<&String> = self.inputs.iter().chain(&call.reads).collect();
        for name in inputs.into_iter().filter(|name| self.folder.path().join(name).exists()) {
            let here = folder.path().join(name);
            // A file of a folder that is linked as a whole is there.
            if !here.exists() {
                here.parent().map(fs::create_dir_all).transpose().expect("a folder");
                std::os::unix::fs::symlink(self.folder.path().join(name), here).expect("a link");
            }
        }
        let words = call.words();
        let words: Vec<&str> = words.iter().map(String::as_str).chain(["--threads", "1"]).collect();
        let done = tool(folder.path(), &call.tool, &words);
        let mut output = BTreeMap::from([("stdout".to_owned(), self.number(&done.stdout))]);
        self.collect(folder.path(), "", &mut output);
        Answer { code: done.code, told: done.stderr, output }
    }

    /// Numbers of the files in a folder, those of folders in it with their path.
    fn collect(&self, folder: &Path, before: &str, found: &mut BTreeMap<String, u64>) {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let name = format!("{before}{}", entry.file_name().to_string_lossy());
            let kind = entry.file_type().expect("a kind");
            if before.is_empty() && name == REPORT {
                continue;
            }
            if kind.is_dir() {
                self.collect(&entry.path(), &format!("{name}/"), found);
            } else if kind.is_file() {
                found.insert(name, self.number(&fs::read(entry.path()).expect("read")));
            }
        }
    }

    /// A number for what a file holds.
    fn number(&self, bytes: &[u8]) -> u64 {
        let mut hasher = DefaultHasher::new();
        match bytes {
            _ if bytes.starts_with(b"ply") => without_comments(bytes).hash(&mut hasher),
            _ if bytes.starts_with(b"\x89MCAP") => {
                Reader::new(bytes).map_while(Result::ok).for_each(|event| self.add(event, &mut hasher))
            }
            _ => bytes.hash(&mut hasher),
        }
        hasher.finish()
    }

    /// Adds an event of a stream; the log has no results.
    fn add(&self, event: Event, hasher: &mut DefaultHasher) {
        match event {
            Event::Metadata { name, map } if name != PROVENANCE && !self.unseen.contains(&name.as_str()) => {
                (name, map).hash(hasher)
            }
            Event::Points { topic, time_ns, table } => {
                (topic, time_ns).hash(hasher);
                for column in table.columns() {
                    column.name.hash(hasher);
                    column.values.to_f64().iter().for_each(|x| x.to_bits().hash(hasher));
                }
            }
            Event::Bytes { topic, time_ns, data } if topic != record::topic::LOG => {
                (topic, time_ns, data).hash(hasher)
            }
            _ => {}
        }
    }
}

/// A PLY file without comments, which say what made it.
fn without_comments(bytes: &[u8]) -> Vec<u8> {
    let end = bytes.windows(10).position(|w| w == b"end_header").unwrap_or(bytes.len());
    let kept = |line: &&[u8]| !line.starts_with(b"comment") && !line.starts_with(b"obj_info");
    let head: Vec<&[u8]> = bytes[..end].split(|b| *b == b'\n').filter(kept).collect();
    [&head.concat(), &bytes[end..]].concat()
}
