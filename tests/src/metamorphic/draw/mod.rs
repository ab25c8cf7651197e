//! Draws scenes: a few dozen grains in cells of a grid, walls at its faces, and everything else that a scene may ask for.

mod calculation;
mod grains;
mod laws;
mod walls;

use super::scene::{File, Scene};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Side of a cell, which holds one grain or clump [m].
pub const CELL: f64 = 0.01;
/// Time for which motions, bonds and insertions are drawn [s]; the run is about as long.
pub const TIME: f64 = 0.01;

/// What was chosen of a scene before its keys are drawn.
#[derive(Debug, Clone, Default)]
struct Choices {
    /// Axes along which the domain repeats.
    periodic: [bool; 3],
    /// Whether nothing is asked for that a small change can make another scene of.
    plain: bool,
    /// Whether all contacts are computed in every precision.
    single: bool,
    /// Whether the domain is strained.
    strained: bool,
    /// Whether grains sleep.
    sleep: bool,
    /// Whether grains are bonded.
    bonded: bool,
    /// Whether there are clumps.
    clumps: bool,
    /// Whether grains touch at the start.
    dense: bool,
    /// Whether grains are inserted from above.
    inserted: bool,
    /// Cells along each axis.
    cells: [usize; 3],
    /// Lowest corner of the grid [m].
    low: [f64; 3],
}

/// A scene that is being drawn.
pub struct Draw {
    random: Pcg64Mcg,
    text: String,
    files: BTreeMap<String, File>,
    choices: Choices,
}

/// Scenes that are drawn until one has keys that do not contradict each other.
const TRIES: usize = 40;

/// The scene of a seed.
///
/// # Panics
/// When the draw writes a scene that is no TOML, or no folder can be made.
pub fn scene(seed: u64) -> Scene {
    let mut last = Scene::default();
    for attempt in 0..TRIES as u64 {
        let mut draw = Draw::new(seed.wrapping_mul(1_000_003).wrapping_add(attempt));
        draw.all();
        let keys = toml::from_str(&draw.text).unwrap_or_else(|e| panic!("{e}\n{}", draw.text));
        last = Scene { keys, files: draw.files };
        let text = last.keys.to_string();
        let folder = tempfile::tempdir().expect("a folder");
        last.write(folder.path(), "scene.toml").expect("the folder can be written");
        let checked = scene::Scene::new("scene.toml", text, &[], folder.path());
        if checked.is_ok_and(|scene| scene.plan(Vec::new()).is_ok()) {
            break;
        }
    }
    last
}

impl Draw {
    fn new(seed: u64) -> Draw {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        // The first numbers of neighbouring seeds resemble each other.
        for _ in 0..8 {
            let _: f64 = random.random_range(0.0..1.0);
        }
        Draw { random, text: String::new(), files: BTreeMap::new(), choices: Choices::default() }
    }

    fn all(&mut self) {
        self.choose();
        self.calculation();
        self.laws();
        self.grains();
        if !self.choices.strained {
            self.walls();
        }
    }

    fn choose(&mut self) {
        let periodic = if self.chance(0.45) { [0; 3].map(|_| self.chance(0.6)) } else { [false; 3] };
        let (plain, single) = (self.chance(0.5), self.chance(0.2));
        let strained = !plain && self.chance(0.1);
        let sleep = !plain && !strained && self.chance(0.15);
        let clumps = !sleep && self.chance(0.2);
        let bonded = !sleep && self.chance(0.2);
        let low = if self.chance(0.3) { [0.0; 3] } else { [0; 3].map(|_| self.between(-0.05, 0.05)) };
        let periodic = if strained { [true; 3] } else { periodic };
        // A scene without walls is one of few.
        let periodic = if plain && periodic == [true; 3] { [true, false, true] } else { periodic };
        let cells = periodic.map(|p| if p { 3 } else { 2 } + usize::from(self.chance(0.4)));
        let dense = self.chance(0.35);
        let inserted = !plain && !strained && !periodic[2] && self.chance(0.2);
        self.choices =
            Choices { plain, single, periodic, strained, sleep, bonded, clumps, dense, inserted, cells, low };
    }

    /// Highest corner of the grid [m].
    fn high(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| digits(self.choices.low[k] + CELL * self.choices.cells[k] as f64, 9))
    }

    fn chance(&mut self, p: f64) -> bool {
        self.random.random_bool(p)
    }

    /// A number of four digits.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        digits(self.random.random_range(low..high), 4)
    }

    /// A number of four digits, evenly over its logarithm.
    fn scale(&mut self, low: f64, high: f64) -> f64 {
        digits(self.random.random_range(low.ln()..high.ln()).exp(), 4)
    }

    fn vector(&mut self, most: f64) -> [f64; 3] {
        [0; 3].map(|_| self.between(-most, most))
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.random.random_range(0..list.len())]
    }

    /// Adds a line.
    fn line(&mut self, line: impl AsRef<str>) {
        let _ = writeln!(self.text, "{}", line.as_ref());
    }

    /// Adds a line with this chance.
    fn maybe(&mut self, p: f64, line: impl AsRef<str>) {
        if self.chance(p) {
            self.line(line);
        }
    }

    /// Adds a key with a number with this chance.
    fn key(&mut self, p: f64, key: &str, low: f64, high: f64) {
        let x = self.scale(low, high);
        self.maybe(p, format!("{key} = {x:?}"));
    }

    /// A separate file, and its name.
    fn file(&mut self, stem: &str, end: &str, file: File) -> String {
        let name = format!("{stem}{}.{end}", self.files.len());
        self.files.insert(name.clone(), file);
        name
    }
}

/// A number of so many digits.
pub fn digits(x: f64, digits: i32) -> f64 {
    if x == 0.0 {
        return x;
    }
    format!("{x:.*e}", digits as usize - 1).parse().unwrap_or(x)
}
