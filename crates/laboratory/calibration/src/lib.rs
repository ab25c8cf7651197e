//! From laboratory curves to parameters, with intervals that say what the data cannot tell.

mod emulator;
mod error;
mod fit;
mod measured;
pub mod recipe;
mod report;
pub mod session;
pub mod trial;

pub use error::{CalibrateError, Location};
pub use fit::next::{Next, next_tests};
pub use measured::data::{Point, Target};
pub use recipe::Recipe;
pub use report::fitness::{Nearest, StepFit};
pub use report::judge::{Finding, Judged, Pair, PartSensitivity, judge};
pub use report::page::html;
pub use report::picture::draw;
pub use report::{guess, words};

/// Samples of the posterior of a step: CSV.
pub fn samples(recipe: &Recipe, end: &session::StepEnd) -> String {
    use std::fmt::Write as _;
    let of: Vec<&recipe::Parameter> = end.fitted.step.fit.iter().map(|&k| &recipe.parameters[k]).collect();
    let mut text =
        of.iter().map(|p| p.name.as_str()).chain(["log_density"]).collect::<Vec<_>>().join(",") + "\n";
    for s in &end.samples.list {
        let cells: Vec<String> = of.iter().zip(&s.z).map(|(p, z)| recipe::shown(p.value(*z))).collect();
        let _ = writeln!(text, "{},{:.4}", cells.join(","), s.log);
    }
    text
}
