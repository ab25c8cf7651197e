//! From the command line to the runs: what each is made from, and its folder.

use crate::args::Args;
use crate::grid::{AS_IT_IS, Grid, Setting};
use crate::knob::{by_chance, seeds};
use crate::line::{Job, fill, unfilled};
use anyhow::{Context, anyhow};
use cli::usage;
use scene::Scene;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Value;

/// The grid and its runs, in the order in which they are made: seed by seed, round by round, so that what disturbs the
/// machine for a while disturbs every setting alike.
pub struct Sweep {
    /// The settings.
    pub grid: Grid,
    /// The runs.
    pub jobs: Vec<Job>,
    /// Folder of the programs.
    pub tools: PathBuf,
}

/// What files hold, each read once.
#[derive(Default)]
struct Hashes(BTreeMap<PathBuf, String>);

impl Hashes {
    /// SHA-256 of a file.
    fn of(&mut self, path: &Path) -> anyhow::Result<String> {
        if let Some(known) = self.0.get(path) {
            return Ok(known.clone());
        }
        let bytes = std::fs::read(path).with_context(|| format!("{}: cannot read it", path.display()))?;
        let hash = stream::sha256(&bytes);
        self.0.insert(path.to_owned(), hash.clone());
        Ok(hash)
    }

    /// Hashes of those of some words that are files in one of the folders.
    fn of_words<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        folders: &[&Path],
    ) -> anyhow::Result<String> {
        let mut all = String::new();
        for word in words {
            let paths = folders.iter().map(|folder| folder.join(word));
            if let Some(path) = paths.into_iter().find(|path| path.is_file()) {
                all += &self.of(&path)?;
            }
        }
        Ok(all)
    }
}

impl Sweep {
    /// Lays out the runs.
    ///
    /// # Errors
    /// A scene or setting that is wrong, blanks that nothing fills, repeats where chance plays no part.
    pub fn new(args: &Args) -> anyhow::Result<Sweep> {
        let lines = || [&args.scene].into_iter().chain(&args.inputs).chain(&args.each);
        let blank = |key: &str| lines().any(|line| line.contains(&format!("{{{key}}}")));
        let plain = !args.scene.contains('{');
        let own = if plain { Some(read(&args.scene, &args.set)?) } else { None };
        let grid = Grid::new(args, &blank, own.as_ref())?;
        let tools = std::env::current_exe().context("where this program is")?;
        let tools = tools.parent().unwrap_or(Path::new(".")).to_owned();
        let (mut hashes, mut once) = (Hashes::default(), Vec::new());
        for repeat in 0..args.repeat {
            for (at, setting) in grid.settings.iter().enumerate() {
                once.push(job(args, &grid, (at, setting), repeat, &tools, &mut hashes)?);
            }
        }
        let round = |round: u64| {
            let folder = move |job: &Job| match round {
                0 => job.folder.clone(),
                _ => job.folder.with_file_name(format!("{},round={round}", base(&job.folder))),
            };
            once.iter().map(move |job| Job { folder: folder(job), ..job.clone() }).collect::<Vec<Job>>()
        };
        let jobs: Vec<Job> = (0..args.rounds).flat_map(round).collect();
        Ok(Sweep { grid, jobs, tools })
    }
}

fn base(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A scene with changes, as values.
fn read(file: &str, sets: &[String]) -> anyhow::Result<Value> {
    Ok(Value::Table(checked(file, sets)?.text.toml.parse().with_context(|| file.to_owned())?))
}

fn checked(file: &str, sets: &[String]) -> anyhow::Result<Scene> {
    let text =
        std::fs::read_to_string(file).with_context(|| format!("{file}: cannot open it (check the path)"))?;
    let scene = Scene::new(file, text, sets, Path::new(file).parent().unwrap_or(Path::new("")))?;
    cli::also_reads(scene.files())?;
    Ok(scene)
}

fn job(
    args: &Args,
    grid: &Grid,
    (at, setting): (usize, &Setting),
    repeat: u64,
    tools: &Path,
    hashes: &mut Hashes,
) -> anyhow::Result<Job> {
    let filled = |text: &String| {
        let line = fill(text, setting, repeat);
        match unfilled(&line) {
            Some(blank) => {
                Err(usage(format!("{text}: nothing fills {blank}: vary {}", blank.trim_matches(['{', '}']))))
            }
            None => Ok(line),
        }
    };
    let scene = filled(&args.scene)?;
    let inputs = args.inputs.iter().map(filled).collect::<anyhow::Result<Vec<_>>>()?;
    let each = args.each.as_ref().map(filled).transpose()?;
    let values = read(&scene, &args.set)?;
    let seeded =
        [&args.scene].into_iter().chain(&args.inputs).chain(&args.each).any(|l| l.contains("{seed}"));
    if args.repeat > 1 && !seeded && !by_chance(&values) {
        return Err(usage(format!(
            "--repeat {}: chance plays no part in {scene}: it has no [[fill]] and no [[insert]]: leave --repeat out, or \
             put {{seed}} into --each",
            args.repeat
        )));
    }
    if args.repeat == 1 && by_chance(&values) {
        static SAID: std::sync::Once = std::sync::Once::new();
        SAID.call_once(|| {
            cli::warn("chance plays a part in this scene, and one seed does not tell how much: --repeat 3 gives intervals")
        });
    }
    let mut sets = args.set.clone();
    for (knob, (_, value)) in grid.knobs.iter().zip(setting).filter(|(_, (_, value))| value != AS_IT_IS) {
        sets.extend(knob.overrides(&values, value)?);
    }
    sets.extend(seeds(&values, repeat));
    let threads = grid.knobs.iter().zip(setting).find_map(|(k, (_, v))| k.threads(v).map(str::to_owned));
    let threads = threads.unwrap_or(rayon::current_num_threads().to_string());
    let name = name(setting, repeat, args.repeat);
    let text = checked(&scene, &sets).with_context(|| format!("point {name}"))?.text.toml;
    let mut job = Job {
        setting: at,
        repeat,
        folder: args.folder().join(folder(&name)),
        stamp: String::new(),
        name,
        scene,
        inputs,
        sets,
        threads,
        each,
    };
    job.stamp = stamp(&job, &text, tools, hashes)?;
    Ok(job)
}

fn name(setting: &Setting, repeat: u64, repeats: u64) -> String {
    let mut parts: Vec<String> = setting.iter().map(|(k, v)| format!("{k}={v}")).collect();
    parts.extend((repeats > 1 || repeat > 0).then(|| format!("seed={repeat}")));
    parts.join(",")
}

/// The name as a folder.
fn folder(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() || "=.,+-_".contains(c) { c } else { '_' };
    let plain: String = name.chars().map(safe).collect();
    if plain == name && name.len() < 120 {
        plain
    } else {
        format!("{:.100}-{:.8}", plain, stream::sha256(name.as_bytes()))
    }
}

/// SHA-256 of everything that a point is made from: the scene with its changes, the files that it and the lines name, the
/// programs, the line before.
fn stamp(job: &Job, text: &str, tools: &Path, hashes: &mut Hashes) -> anyhow::Result<String> {
    let value = Value::Table(text.parse().with_context(|| job.scene.clone())?);
    let mut words = Vec::new();
    strings(&value, &mut words);
    // Shapes name their files behind a colon.
    let named = words.iter().map(|w| w.split_once(':').map_or(w.as_str(), |(_, file)| file));
    let folder = Path::new(&job.scene).parent().unwrap_or(Path::new("")).to_owned();
    let program = hashes.of(&tools.join("dem-run")).map_err(|_| {
        anyhow!("{}: is not there: install dem-run beside cost-curve", tools.join("dem-run").display())
    })?;
    let mut all = vec![program, stream::sha256(text.as_bytes()), hashes.of_words(named, &[&folder])?];
    for input in &job.inputs {
        all.push(hashes.of(Path::new(input))?);
    }
    let line = job.each.clone().unwrap_or_default();
    all.push(hashes.of_words(line.split_whitespace(), &[Path::new(""), tools])?);
    all.extend([line, job.threads.clone()]);
    Ok(stream::sha256(all.join("\n").as_bytes()))
}

/// Every text in a scene.
fn strings(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::String(text) => found.push(text.clone()),
        Value::Array(list) => list.iter().for_each(|v| strings(v, found)),
        Value::Table(table) => table.values().for_each(|v| strings(v, found)),
        _ => {}
    }
}
