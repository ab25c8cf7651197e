//! Runs `dem-run` on a scene and reads what it wrote: tables by step and topic.

use super::scene::Scene;
use serde_json::Value as Json;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use stream::mcap::{Event, Reader};

/// A table of one topic at one step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rows {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Numbers, row by row.
    pub rows: Vec<Vec<f64>>,
    /// Names of rows where numbers of the row do not name it: terms of the ledger, walls.
    pub names: Vec<String>,
}

/// Topics at one step.
pub type Frame = BTreeMap<String, Rows>;

/// What a run wrote.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    /// Frames by the number of their step.
    pub frames: BTreeMap<u64, Frame>,
    /// Time step [s].
    pub dt: f64,
    /// Its report.
    pub report: Json,
}

/// How a run ended that has no whole answer.
#[derive(Debug, Clone)]
pub struct Refusal {
    /// Exit code.
    pub code: i32,
    /// What it said.
    pub words: String,
}

/// The program, and how it is called.
#[derive(Debug, Clone)]
pub struct Runner {
    /// `dem-run`.
    pub program: PathBuf,
}

/// Name of the scene in its folder.
pub const SCENE: &str = "scene.toml";

impl Runner {
    /// Writes a scene into a folder and runs it there.
    ///
    /// # Errors
    /// The exit code and the message of a run that did not reach its end.
    ///
    /// # Panics
    /// When the program cannot be started, or the folder not be written.
    pub fn run(&self, folder: &Path, scene: &Scene, arguments: &[&str]) -> Result<Answer, Refusal> {
        scene.write(folder, SCENE).expect("the folder can be written");
        let mut all = vec![SCENE];
        all.extend(arguments);
        self.call(folder, &all)
    }

    /// Runs the program in a folder with these arguments; its output is `out.mcap` if they do not name another.
    ///
    /// # Errors
    /// As [`Runner::run`].
    ///
    /// # Panics
    /// As [`Runner::run`].
    pub fn call(&self, folder: &Path, arguments: &[&str]) -> Result<Answer, Refusal> {
        let mut command = Command::new(&self.program);
        command.current_dir(folder).args(arguments).args(["-q", "--report", "report.json"]);
        if !arguments.contains(&"--threads") {
            command.args(["--threads", "1"]);
        }
        let named = arguments.iter().position(|a| *a == "-o").map(|k| arguments[k + 1]);
        let output = folder.join(named.unwrap_or("out.mcap"));
        if named.is_none() {
            command.args(["-o", "out.mcap"]);
        }
        let _ = std::fs::remove_file(&output);
        let done = command.stdin(Stdio::null()).output().expect("the program starts");
        let words = String::from_utf8_lossy(&done.stderr).into_owned();
        let code = done.status.code().unwrap_or(-1);
        if code != 0 {
            return Err(Refusal { code, words });
        }
        let report = std::fs::read_to_string(folder.join("report.json")).unwrap_or_default();
        let report: Json = serde_json::from_str(&report).unwrap_or_default();
        read(&output, report).map_err(|words| Refusal { code: -2, words })
    }
}

fn read(path: &Path, report: Json) -> Result<Answer, String> {
    let dt = report["dt"].as_f64().ok_or("the report has no dt")?;
    let file = File::open(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut answer = Answer { dt, report, ..Answer::default() };
    for event in Reader::new(BufReader::new(file)) {
        let (topic, time, rows) = match event.map_err(|e| e.to_string())? {
            Event::Points { topic, time_ns, table } => {
                let columns: Vec<String> = table.columns().iter().map(|c| c.name.clone()).collect();
                let row = |k: usize| table.columns().iter().map(|c| c.values.get(k)).collect();
                (topic, time_ns, Rows { columns, rows: (0..table.rows()).map(row).collect(), names: vec![] })
            }
            Event::Bytes { topic, time_ns, data } => {
                let Some(rows) = json(&topic, &data) else { continue };
                (topic, time_ns, rows)
            }
            Event::Metadata { .. } => continue,
        };
        let step = (time as f64 * 1e-9 / dt).round() as u64;
        let at = answer.frames.entry(step).or_default().entry(topic).or_default();
        at.columns = rows.columns;
        at.rows.extend(rows.rows);
        at.names.extend(rows.names);
    }
    Ok(answer)
}

/// The ledger and the forces on walls as tables.
fn json(topic: &str, data: &[u8]) -> Option<Rows> {
    let json: Json = serde_json::from_slice(data).ok()?;
    let columns = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
    match topic {
        record::topic::ENERGY => {
            let terms = json.as_object()?.iter().filter(|(name, _)| *name != "time");
            let (names, rows) =
                terms.map(|(name, v)| (name.clone(), vec![v.as_f64().unwrap_or(f64::NAN)])).unzip();
            Some(Rows { columns: columns(&["energy"]), rows, names })
        }
        record::topic::WALL_FORCES => {
            let walls = json["walls"].as_array()?;
            let row = |wall: &Json| {
                let three = |key: &str| {
                    let list = wall[key].as_array().into_iter().flatten();
                    list.map(|x| x.as_f64().unwrap_or(f64::NAN)).collect::<Vec<_>>()
                };
                [three("force"), vec![wall["contacts"].as_f64().unwrap_or(f64::NAN)]].concat()
            };
            let name = |wall: &Json| wall["name"].as_str().unwrap_or_default().to_owned();
            Some(Rows {
                columns: columns(&["fx", "fy", "fz", "contacts"]),
                rows: walls.iter().map(row).collect(),
                names: walls.iter().map(name).collect(),
            })
        }
        _ => None,
    }
}

impl Answer {
    /// The last frame that has particles.
    pub fn last(&self) -> Option<&Frame> {
        self.frames.values().rev().find(|frame| frame.contains_key(record::topic::PARTICLES))
    }
}
