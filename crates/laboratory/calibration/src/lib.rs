//! From laboratory curves to parameters, with intervals that say what the data cannot tell.

mod data;
mod emulator;
mod error;
mod fit;
pub mod guess;
mod judge;
mod page;
mod picture;
mod prior;
pub mod recipe;
pub mod session;
mod sheet;
mod target;
pub mod trial;
pub mod words;

pub use data::{Point, Target};
pub use error::{CalibrateError, Place};
pub use fit::next::{Next, next_tests};
pub use judge::{Finding, Judged, Pair, PartSensitivity, StepFit, judge};
pub use page::html;
pub use picture::draw;
pub use recipe::Recipe;

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
