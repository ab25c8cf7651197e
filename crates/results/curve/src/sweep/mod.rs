//! The runs of a study: what each is made from, its folder, its script, and what it cost.
//!
//! A [`Study`] becomes a [`grid`] of settings of [`knob`]s; each setting and seed is a job with a stamp ([`stamp`]) and a [`script`] that
//! runs dem-run; [`work`] runs the scripts that are not finished and reads their cost, [`measure`] their value.

mod grid;
mod knob;
pub mod measure;
pub mod script;
mod stamp;
pub mod work;

pub use grid::{Grid, Setting};

use crate::study::{CurveError, PHASES, Study};
use grid::AS_IT_IS;
use knob::{is_random, seeds};
use scene::{Scene, SceneError};
use script::{SweepRun, fill, unfilled};
use stamp::{Hashes, stamp, table};
use std::path::{Path, PathBuf};
use toml::Value;

/// The grid and its runs, in the order in which they are made: seed by seed, round by round, so that what disturbs the
/// machine for a while disturbs every setting alike.
pub struct Sweep {
    /// The settings.
    pub grid: Grid,
    pub jobs: Vec<SweepRun>,
    /// Folder of the programs.
    pub tools: PathBuf,
    /// Files that the scenes name.
    pub files: Vec<PathBuf>,
    /// Whether a scene with random numbers is run with one seed only.
    pub one_seed: bool,
    /// Phases of the step at which each setting is run.
    pub phases: u64,
}

/// How much shorter the shortest step is: contacts that begin 20 steps after the start or later meet every phase.
const SHORTER: f64 = 0.05;

impl Sweep {
    /// Lays out the runs.
    ///
    /// # Errors
    /// A scene or setting that is wrong, blanks that nothing fills, repeats without random numbers.
    pub fn new(study: &Study) -> Result<Sweep, CurveError> {
        let blank = |key: &str| lines(study).any(|line| line.contains(&format!("{{{key}}}")));
        let plain = !study.scene.contains('{');
        let mut files = Vec::new();
        let own = plain.then(|| read(&study.scene, &study.set, &mut files)).transpose()?;
        let grid = Grid::new(study, &blank, own.as_ref())?;
        let tools = std::env::current_exe().map_err(CurveError::io("where this program is"))?;
        let tools = tools.parent().unwrap_or(Path::new(".")).to_owned();
        let mut sweep = Sweep { grid, jobs: Vec::new(), tools, files, one_seed: false, phases: 1 };
        sweep.phases = sweep.phases(study)?;
        let mut hashes = Hashes::default();
        for repeat in 0..study.repeat.max(sweep.phases) {
            for at in 0..sweep.grid.settings.len() {
                let job = sweep.job(study, at, repeat, &mut hashes)?;
                sweep.jobs.push(job);
            }
        }
        let once = sweep.jobs.clone();
        for round in 1..study.rounds {
            let folder =
                |job: &SweepRun| job.folder.with_file_name(format!("{},round={round}", base(&job.folder)));
            sweep.jobs.extend(once.iter().map(|job| SweepRun { folder: folder(job), ..job.clone() }));
        }
        Ok(sweep)
    }

    /// The phases that the study asks for; where it says nothing and no setting depends on a seed, [`PHASES`].
    fn phases(&mut self, study: &Study) -> Result<u64, CurveError> {
        if let Some(phases) = study.phases {
            return Ok(phases);
        }
        if study.repeat > 1 || lines(study).any(|line| line.contains("{seed}")) {
            return Ok(1);
        }
        for setting in &self.grid.settings {
            let scene = fill(&study.scene, setting, 0);
            if unfilled(&scene).is_some() || is_random(&read(&scene, &study.set, &mut self.files)?) {
                return Ok(1);
            }
        }
        Ok(PHASES)
    }

    /// The run of one setting with one seed, or at one phase of the step.
    fn job(
        &mut self,
        study: &Study,
        at: usize,
        repeat: u64,
        hashes: &mut Hashes,
    ) -> Result<SweepRun, CurveError> {
        let setting = &self.grid.settings[at];
        let (seed, phase) = if self.phases > 1 { (0, repeat) } else { (repeat, 0) };
        let shorten = SHORTER * phase as f64 / self.phases as f64;
        let filled = |text: &String| {
            let line = fill(text, setting, seed);
            match unfilled(&line).map(|blank| (blank, blank.trim_matches(['{', '}']))) {
                Some((blank, key)) => {
                    Err(CurveError::Usage(format!("{text}: nothing fills {blank}: vary {key}")))
                }
                None => Ok(line),
            }
        };
        let scene = filled(&study.scene)?;
        let inputs = study.inputs.iter().map(filled).collect::<Result<Vec<_>, _>>()?;
        let each = study.each.as_ref().map(filled).transpose()?;
        let values = read(&scene, &study.set, &mut self.files)?;
        check_random(study, &scene, &values)?;
        self.one_seed |= study.repeat == 1 && is_random(&values);
        let mut sets = study.set.clone();
        let varied = self.grid.knobs.iter().zip(setting);
        for (knob, (_, value)) in varied.clone().filter(|(_, (_, value))| value != AS_IT_IS) {
            sets.extend(knob.overrides(&values, value)?);
        }
        sets.extend(seeds(&values, seed));
        sets.extend((shorten > 0.0).then(|| format!("time.shorten={shorten}")));
        let threads = varied.clone().find_map(|(k, (_, v))| k.threads(v).map(str::to_owned));
        let threads = threads.unwrap_or(study.threads.to_string());
        let name = name(setting, seed, study.repeat, phase);
        let text =
            checked(&scene, &sets, &mut self.files).map_err(|e| e.at(format!("point {name}")))?.text.toml;
        let (folder, stamp_now) = (study.folder.join(folder(&name)), String::new());
        let mut job = SweepRun {
            setting: at,
            repeat,
            shorten,
            folder,
            stamp: stamp_now,
            name,
            scene,
            inputs,
            sets,
            threads,
            each,
        };
        job.stamp = stamp(&job, &text, &self.tools, hashes)?;
        Ok(job)
    }
}

/// Texts that may have blanks.
fn lines(study: &Study) -> impl Iterator<Item = &String> {
    [&study.scene].into_iter().chain(&study.inputs).chain(&study.each)
}

/// Refuses repeats of a scene that does not depend on the seed.
fn check_random(study: &Study, scene: &str, values: &Value) -> Result<(), CurveError> {
    let seeded = lines(study).any(|line| line.contains("{seed}"));
    if study.repeat == 1 || seeded || is_random(values) {
        return Ok(());
    }
    Err(CurveError::Usage(format!(
        "--repeat {}: {scene} uses no random numbers: it has no [[fill]], no [[insert]] and no [[bond]] of drawn strength: leave --repeat out, or \
         put {{seed}} into --each",
        study.repeat
    )))
}

fn base(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A scene with changes, as values; the files that it names are added to `files`.
fn read(file: &str, sets: &[String], files: &mut Vec<PathBuf>) -> Result<Value, CurveError> {
    table(file, &checked(file, sets, files)?.text.toml)
}

fn checked(file: &str, sets: &[String], files: &mut Vec<PathBuf>) -> Result<Scene, CurveError> {
    let what = format!("{file}: cannot open it (check the path)");
    let text = stream::whole::text(Path::new(file)).map_err(CurveError::io(what))?;
    let scene = Scene::new(file, text, sets, Path::new(file).parent().unwrap_or(Path::new("")));
    let scene = scene.map_err(|error| match error {
        SceneError::Override { .. } => CurveError::Usage(error.to_string()),
        other => other.into(),
    })?;
    files.extend(scene.files());
    Ok(scene)
}

fn name(setting: &Setting, seed: u64, seeds: u64, phase: u64) -> String {
    let mut parts: Vec<String> = setting.iter().map(|(k, v)| format!("{k}={v}")).collect();
    parts.extend((seeds > 1).then(|| format!("seed={seed}")));
    parts.extend((phase > 0).then(|| format!("phase={phase}")));
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
