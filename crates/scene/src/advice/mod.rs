//! What the engine refuses or stops at, in the words of a scene: which key it is about, and what to do.
//!
//! The engine's own messages say what is wrong; keys, flags and remedies are added here, and nowhere else.

mod setup;
#[cfg(test)]
mod tests;

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

/// What the message of [`Halt::Device`] has.
pub const DEVICE_FAILED: &str = "the device has failed";

/// What else helps grains that overlap too far.
const SOFTER: &str = "let grains meet more slowly (a lower drop or speed of insertion)";

/// A list of remedies, and where it helps the wider guard: a limit above the smaller radius is refused.
fn or_wider(remedies: &[&str], share: f64) -> String {
    let wider = (share < 1.0).then_some("raise guards.overlap");
    let all: Vec<&str> = remedies.iter().copied().chain(wider).collect();
    match all.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{}, or {last}", rest.join(", ")),
        _ => all.concat(),
    }
}

/// What a contact must be made of to bear what it met.
pub(crate) fn of_stiffness(stiffer: Option<&Stiffer>) -> String {
    let Some(Stiffer { speed, key, of, value, unit }) = stiffer else { return String::new() };
    let met = if *speed > 0.0 { format!(" for an approach at {speed:.3e} m/s") } else { String::new() };
    format!(" ({key} of {of} ≥ {value:.2e} {unit}{met})")
}

/// Why a run was stopped, and what to change in the scene or in the stages of a plant.
pub fn explain_halt(halt: &Halt) -> String {
    let advice = match halt {
        Halt::Overlap { stiffer, share, .. } => {
            let stiffen = format!("stiffen the material{}", of_stiffness(stiffer.as_deref()));
            return format!("{halt}: {}", or_wider(&[&stiffen, SOFTER, "shorten dt"], *share));
        }
        Halt::InletOverlap { by: Entrance::Inlet(_), share, .. } => {
            let remedies = [
                "let grains come in along the paths that they took (motion = \"recorded\" in both stages)",
                "keep its zone free at the start",
                "let slow grains start farther back (stage-replay --ahead)",
                "cut where nothing piles up to the plane, 3 to 4 grain diameters below a mouth",
                "set guards.zones = \"remove\" where the other grain is one that came back",
            ];
            return format!("{halt}: {}", or_wider(&remedies, *share));
        }
        Halt::InletOverlap { by: Entrance::Insert(k), share, .. } => {
            let remedies = [
                format!("move insert.{k}.shape to where nothing lies or piles up"),
                format!("end it before (insert.{k}.until)"),
                format!("lower insert.{k}.rate"),
                format!("raise insert.{k}.velocity, so that grains leave the shape sooner"),
            ];
            let remedies: Vec<&str> = remedies.iter().map(String::as_str).collect();
            return format!("{halt}: {}", or_wider(&remedies, *share));
        }
        Halt::Motion { .. } => "shorten dt or raise guards.motion",
        Halt::NotANumber { .. } => {
            "its speed, spin or stiffness is far too large; look at what it started with, or shorten dt"
        }
        Halt::WallNotANumber { .. } => {
            return format!("{halt}; look at the stiffness of its contacts, or shorten dt");
        }
        Halt::WallTooFast { .. } => {
            "raise wall.spring.speed_limit, or use a stiffer spring or a heavier wall"
        }
        Halt::WallTooLight { .. } => "raise wall.spring.mass, or use a smaller time.dt or time.safety",
        Halt::WallPastAll { .. } => {
            "turn wall.servo.direction round if it points away from the grains, or start the wall where it meets them"
        }
        Halt::Device { .. } => "go on without --device",
        Halt::CellTooSmall { .. } => "end the run before, or take a larger domain with more grains",
        Halt::NotKept { .. } => "set record_wrenches in the setup",
        Halt::CameBack { .. } => {
            "cut the plant farther upstream, take a longer zone (length), or set guards.zones = \"remove\" to take such grains out, or false where \
             grains get there by another way"
        }
        Halt::TooFast { .. } => "shorten dt, or raise guards.motion",
        Halt::BondsTooStiff { .. } => "shorten dt (time.safety), or use softer or thinner bonds",
        Halt::Bonds { .. } => "move one of them",
        Halt::Energy { .. } => "shorten dt (time.safety) or raise guards.energy",
    };
    format!("{halt}: {advice}")
}
