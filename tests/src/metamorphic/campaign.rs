//! Many scenes, each asked by every relation that applies.

use super::answer::{Answer, Refusal, Runner};
use super::compare::{self, Deviations, Rule, Tolerance};
use super::draw::{TIME, digits};
use super::relations::{RELATIONS, Relation};
use super::scene::{File, Scene};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::cell::{Cell, OnceCell};
use std::collections::BTreeMap;
use std::path::PathBuf;
use tempfile::TempDir;

/// What became of one question.
#[derive(Debug, Clone)]
pub enum Verdict {
    /// Both answers are one.
    Same,
    /// They differ, as the words say.
    Differs(String),
    /// The scene in other words was refused.
    Refused(String),
}

/// A scene with its answer, and what its relations need.
pub struct Case<'a> {
    /// The scene; its step is a number.
    pub scene: Scene,
    /// Its answer.
    pub base: Answer,
    /// Runs scenes.
    pub runner: &'a Runner,
    folder: PathBuf,
    /// Removes the folder.
    _owner: Option<TempDir>,
    runs: Cell<usize>,
    noise: OnceCell<Deviations>,
}

/// Fewest and most steps of a scene.
const STEPS: (f64, f64) = (80.0, 800.0);

impl<'a> Case<'a> {
    /// Runs a scene of `dt = "auto"` once to know its step, and again with this step as a number.
    ///
    /// # Errors
    /// A scene that does not reach its end.
    ///
    /// # Panics
    /// When no folder can be made.
    pub fn draw(runner: &'a Runner, mut scene: Scene) -> Result<(Case<'a>, Answer), Refusal> {
        let folder = tempfile::tempdir().expect("a folder");
        scene.set("time", "until", TIME);
        let probe = runner.run(folder.path(), &scene, &[])?;
        let until = (TIME / probe.dt).clamp(STEPS.0, STEPS.1) / 4.0;
        let quarter = until.round() * probe.dt;
        scene.set("time", "until", 4.0 * quarter);
        scene.set("output", "every", quarter);
        let free = runner.run(folder.path(), &scene, &[])?;
        for key in ["safety", "accuracy", "shorten"] {
            scene.keys.get_mut("time").and_then(|t| t.as_table_mut()).map(|t| t.remove(key));
        }
        scene.set("time", "dt", free.dt);
        Ok((Case::pinned(runner, scene)?, free))
    }

    /// A scene whose step is a number.
    ///
    /// # Errors
    /// A scene that does not reach its end.
    ///
    /// # Panics
    /// When no folder can be made.
    pub fn pinned(runner: &'a Runner, scene: Scene) -> Result<Case<'a>, Refusal> {
        let owner = tempfile::tempdir().expect("a folder");
        let folder = owner.path().to_owned();
        let case = Case::in_folder(runner, scene, folder)?;
        Ok(Case { _owner: Some(owner), ..case })
    }

    /// The same; what it runs stays in this folder.
    ///
    /// # Errors
    /// As [`Case::pinned`].
    pub fn in_folder(runner: &'a Runner, scene: Scene, folder: PathBuf) -> Result<Case<'a>, Refusal> {
        let base = runner.run(&folder.join("first"), &scene, &[])?;
        Ok(Case { scene, base, runner, folder, _owner: None, runs: Cell::new(0), noise: OnceCell::new() })
    }

    /// A folder for another run.
    pub fn folder(&self) -> PathBuf {
        self.runs.set(self.runs.get() + 1);
        self.folder.join(format!("second-{}", self.runs.get()))
    }

    /// Number of its steps.
    pub fn steps(&self) -> u64 {
        self.base.frames.keys().last().copied().unwrap_or(0)
    }

    /// Runs another scene.
    ///
    /// # Errors
    /// As [`Runner::run`].
    pub fn run(&self, scene: &Scene, arguments: &[&str]) -> Result<Answer, Refusal> {
        self.runner.run(&self.folder(), scene, arguments)
    }

    /// Runs another scene and compares its answer.
    pub fn ask(&self, scene: &Scene, arguments: &[&str], rule: &Rule) -> Verdict {
        match self.run(scene, arguments) {
            Ok(other) => self.judge(&self.base, &other, rule),
            Err(refusal) => refused(&refusal),
        }
    }

    /// Compares two answers.
    pub fn judge(&self, base: &Answer, other: &Answer, rule: &Rule) -> Verdict {
        compare::difference(base, other, rule).map_or(Verdict::Same, Verdict::Differs)
    }

    /// As much as rounding may change, with a share of the largest number.
    pub fn rounding(&self, share: f64) -> Tolerance<'_> {
        Tolerance::Rounding(self.noise(), if self.is_double() { share } else { share.max(1e-4) })
    }

    /// Whether contacts are computed in double precision.
    pub fn is_double(&self) -> bool {
        self.scene.get("precision").and_then(|p| p.as_str()).is_none_or(|p| p == "f64")
    }

    /// What changes of the last digits of all positions and velocities make of the scene.
    fn noise(&self) -> &Deviations {
        self.noise.get_or_init(|| {
            let mut all = Deviations::new();
            for seed in 0..2 {
                let disturbed = disturbed(&self.scene, seed, if self.is_double() { 1e-15 } else { 1e-10 });
                let Ok(other) = self.run(&disturbed, &[]) else { continue };
                for (group, deviation) in compare::deviations(&self.base, &other) {
                    let at = all.entry(group).or_insert(0.0);
                    *at = at.max(deviation);
                }
            }
            all
        })
    }
}

/// The verdict of a refusal.
pub fn refused(refusal: &Refusal) -> Verdict {
    Verdict::Refused(format!("exit {}: {}", refusal.code, refusal.words.lines().next().unwrap_or_default()))
}

/// The scene with places moved by about `size` [m], and velocities by as much of a metre a second.
fn disturbed(scene: &Scene, seed: u64, size: f64) -> Scene {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut scene = scene.clone();
    let Scene { keys, files } = &mut scene;
    let moves = |name: &str| name.starts_with("grains") || name.starts_with("clumps");
    for file in files.iter_mut().filter(|(name, _)| moves(name)).map(|(_, file)| file) {
        let File::Rows(_, rows) = file else { continue };
        rows.iter_mut()
            .for_each(|row| row[..6].iter_mut().for_each(|x| *x += random.random_range(-size..size)));
    }
    for (list, key) in [("body", "position"), ("body", "velocity"), ("fill", "velocity")] {
        for entry in keys.get_mut(list).and_then(|v| v.as_array_mut()).into_iter().flatten() {
            for x in entry.get_mut(key).and_then(|v| v.as_array_mut()).into_iter().flatten() {
                if let toml::Value::Float(x) = x {
                    *x += random.random_range(-size..size);
                }
            }
        }
    }
    scene
}

/// The relation of the step that the program chose and the same as a number.
pub const AUTO: &str = "`dt = \"auto\"` as a number";

/// Counts of one relation.
#[derive(Debug, Clone, Copy, Default)]
pub struct Count {
    /// Answers that were compared.
    pub compared: usize,
    /// Answers that differ.
    pub differ: usize,
    /// Scenes in other words that were refused.
    pub refused: usize,
}

/// A scene that fails a relation.
pub struct Failure {
    /// Seed of the scene.
    pub seed: u64,
    /// The relation.
    pub relation: &'static Relation,
    /// How the answers differ.
    pub words: String,
    /// The scene.
    pub scene: Scene,
}

/// What a campaign found.
#[derive(Default)]
pub struct Findings {
    /// Scenes that were drawn.
    pub scenes: usize,
    /// Scenes that were refused or did not reach their end, by the first line of the message.
    pub refused: BTreeMap<String, usize>,
    /// Counts by name of relation.
    pub counts: BTreeMap<&'static str, Count>,
    /// Failures.
    pub failures: Vec<Failure>,
}

impl Findings {
    /// Adds those of another part.
    pub fn add(&mut self, other: Findings) {
        self.scenes += other.scenes;
        other.refused.into_iter().for_each(|(words, n)| *self.refused.entry(words).or_default() += n);
        for (name, count) in other.counts {
            let all = self.counts.entry(name).or_default();
            all.compared += count.compared;
            all.differ += count.differ;
            all.refused += count.refused;
        }
        self.failures.extend(other.failures);
    }

    /// Number of scenes that were refused.
    pub fn refusals(&self) -> usize {
        self.refused.values().sum()
    }
}

/// Random numbers of a relation: they do not depend on what else is asked.
pub fn random(seed: u64, relation: &str) -> Pcg64Mcg {
    let name = relation
        .bytes()
        .fold(seed ^ 0x9e37_79b9, |sum, byte| sum.wrapping_mul(31).wrapping_add(u64::from(byte)));
    Pcg64Mcg::seed_from_u64(name)
}

/// Asks a scene by every relation that is chosen.
pub fn ask(runner: &Runner, seed: u64, chosen: &dyn Fn(&Relation) -> bool) -> Findings {
    let mut found = Findings { scenes: 1, ..Findings::default() };
    let scene = super::draw::scene(seed);
    let (case, free) = match Case::draw(runner, scene) {
        Ok(both) => both,
        Err(refusal) => {
            let words = match refused(&refusal) {
                Verdict::Refused(words) => words,
                _ => String::new(),
            };
            found.refused.insert(words, 1);
            return found;
        }
    };
    let auto = found.counts.entry(AUTO).or_default();
    auto.compared += 1;
    let rule = Rule { tolerance: case.rounding(1e-10), ..Rule::bits(compare::PARTICLES) };
    if !super::relations::jumps(&case.scene)
        && let Some(words) = compare::difference(&case.base, &free, &rule)
    {
        auto.differ += 1;
        let relation = &super::relations::AUTOMATIC;
        found.failures.push(Failure { seed, relation, words, scene: case.scene.clone() });
    }
    for relation in RELATIONS.iter().filter(|r| chosen(r)) {
        let verdict = match relation.asks(&case, &mut random(seed, relation.name)) {
            None => continue,
            Some(verdict) => verdict,
        };
        let count = found.counts.entry(relation.name).or_default();
        match verdict {
            Verdict::Same => count.compared += 1,
            Verdict::Refused(words) => {
                count.refused += 1;
                if std::env::var_os("GRAINPIPE_REFUSED").is_some() {
                    eprintln!("seed {seed}, {}: {words}", relation.name);
                }
            }
            Verdict::Differs(words) => {
                count.compared += 1;
                count.differ += 1;
                let scene = case.scene.clone();
                found.failures.push(Failure { seed, relation, words, scene });
            }
        }
    }
    found
}

/// A whole number of steps as a time.
pub fn time(steps: u64, dt: f64) -> f64 {
    digits(steps as f64 * dt, 15)
}
