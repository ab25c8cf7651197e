//! A recipe: what is to be found, with which tests, compared with which data, in which steps.
//!
//! [`read`] checks everything that can be checked before a trial runs; each error names its place.

mod blanks;
mod check;
mod keys;
mod parameter;
mod steps;
mod test;
mod tests_of;
mod text;
mod with;

pub use blanks::{filled, shown};
pub use keys::Pick;
pub use parameter::{Parameter, Prior};
pub use steps::{Part, Step};
pub use test::{CalibrationSettings, GivenData, Test};

use crate::error::{CalibrateError, Result};
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
