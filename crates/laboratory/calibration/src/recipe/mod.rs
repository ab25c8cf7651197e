//! A recipe: what is to be found, with which tests, compared with which data, in which steps.
//!
//! [`read`] checks everything that can be checked before a trial runs; each error names its place.

mod blanks;
mod check;
mod keys;
mod parameter;
mod steps;
mod tests_of;
mod text;
mod with;

pub use blanks::{filled, shown};
pub use keys::Pick;
pub use parameter::{Parameter, Prior};
pub use steps::{Part, Step};

use crate::error::{CalibrateError, Result};
use crate::measured::data::Target;
use crate::measured::target::Units;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use text::Text;

/// A checked recipe.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// The file, as it was named.
    pub name: String,
    /// Its folder, which the blank `{here}` stands for.
    pub here: PathBuf,
    /// What is to be found.
    pub parameters: Vec<Parameter>,
    /// What is simulated.
    pub tests: Vec<Test>,
    /// What is fitted to what, in order.
    pub steps: Vec<Step>,
    /// Numbers for all.
    pub settings: CalibrationSettings,
    /// What is odd, but no error.
    pub warnings: Vec<String>,
}

/// Numbers for all trials.
#[derive(Debug, Clone)]
pub struct CalibrationSettings {
    /// Runs of each trial with different seeds.
    pub seeds: u64,
    /// Seed of the proposals, and the first of the runs.
    pub seed: u64,
    /// Content of the intervals.
    pub interval: f64,
    /// Largest share of failed trials.
    pub failures: f64,
    /// Longest time of a run [s].
    pub timeout: Option<f64>,
    /// A trial is abandoned when its log likelihood is this much below the best.
    pub abandon: f64,
}

/// A command that prints a curve or a number.
#[derive(Debug, Clone)]
pub struct Test {
    /// Its name.
    pub name: String,
    /// The shell line, with blanks.
    pub command: String,
    /// The file that is read, relative to the folder of the run; absent: stdout.
    pub read: Option<String>,
    /// Column of x; absent: the result is a number.
    pub x: Option<String>,
    /// Column of y.
    pub y: Option<String>,
    /// Only rows with these values.
    pub rows: BTreeMap<String, f64>,
    /// Which row is the number.
    pub pick: Pick,
    /// Data; absent: a test that `--design` may propose.
    pub target: Option<Target>,
    /// Deviation of a measurement that is not there yet, as share or in the unit of y.
    pub deviation: Option<f64>,
    /// Whether [`Test::deviation`] is a share.
    pub share: bool,
    /// Units of x and y.
    pub(crate) units: Units,
}

impl Test {
    /// Unit of y, for messages.
    pub fn unit(&self) -> &str {
        self.units.y.as_deref().unwrap_or_default()
    }

    /// Whether the seed changes it.
    pub fn is_random(&self) -> bool {
        self.command.contains("{seed}")
    }
}

impl Recipe {
    /// A blank that nothing fills in the last step, and its test, which no step has to run.
    pub fn open_blank(&self) -> Option<(String, String)> {
        let with = &self.steps.last()?.with;
        let known = |name: &str| {
            with.contains_key(name)
                || check::OWN_BLANKS.contains(&name)
                || self.parameters.iter().any(|p| p.name == name)
        };
        let open = |t: &Test| {
            let name = blanks::names(&t.command).into_iter().find(|name| !known(name))?;
            Some((name.to_owned(), t.name.clone()))
        };
        self.tests.iter().find_map(open)
    }

    /// The first test with the command of this one: their runs are the same, and are made once.
    pub fn first_with_command_of(&self, test: usize) -> usize {
        let command = &self.tests[test].command;
        self.tests.iter().position(|t| &t.command == command).unwrap_or(test)
    }
}

/// Data for a test without, or instead of, those of the recipe: `NAME=FILE`, or `FILE` for the only test or the next one without data.
pub type GivenData = Vec<String>;

/// Reads and checks a recipe; `data` are given on the command line.
///
/// # Errors
/// What is wrong, and where.
pub fn read(path: &Path, data: &GivenData) -> Result<Recipe> {
    let name = path.display().to_string();
    let toml = stream::whole::text(path).map_err(crate::error::file(path, "cannot read the recipe"))?;
    let text = Text { name: &name, toml: &toml };
    let keys = text.parse()?;
    if keys.parameter.is_empty() || keys.test.is_empty() {
        let message = "a recipe has at least one [[parameter]] and one [[test]]".to_owned();
        return Err(CalibrateError::Recipe { place: text.place(None), message });
    }
    let here = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let here = here.canonicalize().map_err(crate::error::file(here, "cannot find the folder"))?;
    let settings = check::settings(&text, &keys.settings)?;
    let parameters = check::parameters(&text, &keys.parameter)?;
    let with = with::names(&text, &keys, &parameters)?;
    let blanks: Vec<&str> = parameters.iter().map(|p| p.name.as_str()).chain(with.iter().copied()).collect();
    let (tests, mut warnings) = tests_of::tests(&text, &keys.test, &blanks, &settings, (&here, data))?;
    check::used(&text, &parameters, &tests)?;
    with::refuse_unused(&text, &keys, &tests)?;
    let steps = steps::steps(&text, &keys, &parameters, (&tests, &with))?;
    for (k, test) in tests.iter().enumerate() {
        if test.target.is_some() && !steps.iter().any(|s| s.to.iter().any(|p| p.test == k)) {
            warnings
                .push(format!("test '{}': no step fits to it, so that its data change nothing", test.name));
        }
    }
    Ok(Recipe { name, here, parameters, tests, steps, settings, warnings })
}
