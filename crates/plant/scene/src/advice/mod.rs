//! What the engine refuses or stops at, in the words of a scene: which key it is about, and what to do.
//!
//! The engine's own messages say what is wrong; keys, flags and remedies are added here, and nowhere else.

mod cause;
mod remedy;
mod setup;
#[cfg(test)]
mod tests;

pub use cause::stop_cause;
pub use remedy::Remedy;
pub use setup::{explain_setup_error, explain_step_cause};

use dem::{Entrance, Halt, SetupError, Stiffer};
use thiserror::Error;

/// A scene whose setup the engine refuses; its message is that of [`explain_setup_error`].
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}", explain_setup_error(.0))]
pub struct SceneSetupError(pub SetupError);

impl From<SetupError> for SceneSetupError {
    fn from(error: SetupError) -> SceneSetupError {
        SceneSetupError(error)
    }
}

/// How much more the hardest impact near a contact must need than the contact itself to be named [–].
const HARDER: f64 = 1.05;

/// What a contact must be made of to bear what it met, and what the hardest impact near it needs.
pub(crate) fn of_stiffness(stiffer: Option<&Stiffer>) -> String {
    let Some(Stiffer { speed, key, of, value, most, unit }) = stiffer else { return String::new() };
    let met = if *speed > 0.0 { format!(" for an approach at {speed:.3e} m/s") } else { String::new() };
    let harder = if *most > HARDER * value {
        format!(", {most:.2e} {unit} for the hardest impact of grains near it")
    } else {
        String::new()
    };
    format!(" ({key} of {of} ≥ {value:.2e} {unit}{met}{harder})")
}

/// Why a run was stopped, when, and what to change in the scene or in the stages of a plant.
pub fn explain_halt(halt: &Halt) -> String {
    at(halt.time(), &explain_fact(halt))
}

/// A fact, after its time [s].
pub fn at(time: f64, fact: &str) -> String {
    format!("t = {time:.6e} s: {fact}")
}

/// [`explain_halt`] without the time.
pub fn explain_fact(halt: &Halt) -> String {
    let stiff = if let Halt::Overlap { stiffer, .. } = halt {
        of_stiffness(stiffer.as_deref())
    } else {
        String::new()
    };
    let k = match halt {
        Halt::InletOverlap { by: Entrance::Insert(k), .. }
        | Halt::FreeInWall { by: Entrance::Insert(k), .. }
        | Halt::NoRoom { by: Entrance::Insert(k), .. } => *k,
        _ => 0,
    };
    let remedies: Vec<String> = Remedy::of(halt).iter().map(|remedy| remedy.text(k, &stiff)).collect();
    let all = match remedies.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, [one])) if !one.contains(',') => format!("{one}, or {last}"),
        Some((last, rest)) => format!("{}; or {last}", rest.join("; ")),
        None => String::new(),
    };
    format!("{halt}: {all}")
}
