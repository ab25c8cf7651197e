//! What to change in a scene whose setup the engine refuses.

use crate::error::shown;
use dem::{Allowed, OutOfRange, Quantity, SetupError, StepCause, Subject};

/// How much longer than what it must hold a zone should be [–].
const MARGIN: f64 = 1.2;

/// What is wrong with a setup, under the key of the scene, and what to do about it.
pub fn explain_setup_error(error: &SetupError) -> String {
    let wrong = statement(error);
    match remedy(error) {
        Some(remedy) => format!("{wrong}: {remedy}"),
        None => wrong,
    }
}

/// What is wrong: the key and the value.
fn statement(error: &SetupError) -> String {
    match error {
        SetupError::NoContact { a, b } => format!("contact: no law between '{a}' and '{b}'"),
        SetupError::StepTooLarge { dt, critical, cause } => {
            let cause = explain_step_cause(cause);
            format!("time.dt: {dt:.4e} s is above the critical step {critical:.4e} s of {cause}")
        }
        SetupError::StepAbovePeriod { dt, most, cause } => {
            let motion = cause.motion.as_ref().map_or(String::new(), ToString::to_string);
            format!("time.dt: {dt:.4e} s is above {most:.4e} s, the longest for {motion}")
        }
        SetupError::NoStep => "time.dt: \"auto\" needs a pair that can touch, and there is none".to_owned(),
        SetupError::OutOfRange(number) => out_of_range(number),
        SetupError::TooFar { quantity, .. } => {
            let (engine, text) = (quantity.to_string(), error.to_string());
            format!("{}{}", key(quantity), text.strip_prefix(&engine).unwrap_or(&text))
        }
        SetupError::PeriodTooSmall { .. } => format!("domain: {error}"),
        SetupError::StrainedWith(what) => format!("domain.strain: a domain that is strained has no {what}"),
        SetupError::StrainedOpen { axis } => format!(
            "domain.strain: {axis} is not periodic, and a stress needs a domain that is periodic along all axes"
        ),
        SetupError::PeriodBelowSkin { axis, period, skin, .. } => format!(
            "neighbours.skin: {skin:.4e} m and the largest diameter are more than the period of {period:.4e} m along {axis}"
        ),
        SetupError::NoWidth(_) => format!("lanes: {error}"),
        SetupError::DuplicateEntryId { .. }
        | SetupError::EntryLate { .. }
        | SetupError::EntryBehindPlane { .. } => format!("inlet: {error}"),
        SetupError::ClumpOutlet(clump) => {
            format!("outlet: of clumps (the scene has '{clump}') only centres are tested")
        }
        SetupError::PrecisionWithout { precision, effects, between: [a, b] } => {
            format!("precision: \"{}\" has no {} ({a}–{b})", precision.name(), effects.join(", "))
        }
        SetupError::DragAndSleep => "drag: not available yet with [sleep]".to_owned(),
        SetupError::LocalDampingWith(other) => format!("local_damping: not available yet with {other}"),
        SetupError::BondsAndSleep => "bond: not available yet with [sleep]".to_owned(),
        SetupError::BondOfZeroLength { .. } => format!("bond: {error}"),
        SetupError::WallSlowerThanSleep { wall, speed, sleep, .. } => format!(
            "sleep.speed: {sleep:.4e} m/s is above half the speed of wall '{wall}', {speed:.4e} m/s: grains that it carries would fall asleep"
        ),
        SetupError::ClumpSleep(clump) => format!("sleep: clumps (the scene has '{clump}') do not sleep"),
        SetupError::OtherState(how) => format!("resume: the saved state does not fit this scene: {how}"),
        SetupError::DuplicateId(_)
        | SetupError::ZoneShorterThanBond { .. }
        | SetupError::ZoneTooShort { .. }
        | SetupError::BehindPlane { .. }
        | SetupError::BondJoinsNothing { .. }
        | SetupError::WallTooFast { .. }
        | SetupError::BeltLeavesPlane(_)
        | SetupError::RotatingPlane(_) => error.to_string(),
    }
}

/// What to do about it; `None` where the statement says what is allowed.
fn remedy(error: &SetupError) -> Option<String> {
    let fixed = match error {
        SetupError::OutOfRange(number) if number.allowed == Allowed::BelowOverlapGuard => {
            "give less, or stiffen the material"
        }
        SetupError::OutOfRange(_) | SetupError::PeriodTooSmall { .. } => return None,
        SetupError::NoContact { a, b } => {
            return Some(format!("add a [[contact]] with between = [\"{a}\", \"{b}\"]"));
        }
        SetupError::ZoneShorterThanBond { longest, .. } => {
            return Some(format!("use at least {:.4e} m, or a smaller gap in [[bond]]", MARGIN * longest));
        }
        SetupError::ZoneTooShort { diameter, .. } => {
            return Some(format!("use at least {:.4e} m", MARGIN * diameter));
        }
        SetupError::PeriodBelowSkin { most, .. } => {
            return Some(format!("use at most {most:.4e} m, or leave the key out"));
        }
        SetupError::WallSlowerThanSleep { most, .. } => {
            return Some(format!("use at most {most:.4e} m/s, or leave out [sleep]"));
        }
        SetupError::StrainedWith(_) => "leave out one of them",
        SetupError::StrainedOpen { .. } => "set domain.periodic = [\"x\", \"y\", \"z\"]",
        SetupError::StepTooLarge { .. } => "use dt = \"auto\", a smaller dt, or softer materials",
        SetupError::StepAbovePeriod { .. } => "use dt = \"auto\", a smaller dt, or a slower motion",
        SetupError::NoStep => "give dt in seconds",
        SetupError::TooFar { .. } => "shift the scene to the origin",
        SetupError::DuplicateId(_) => "give each particle its own",
        SetupError::DuplicateEntryId { .. } => {
            "give the particles of this scene other ids (first_id), or the replayed ones (stage-replay --first-id)"
        }
        SetupError::NoWidth(_) => "use one of Width::available()",
        SetupError::EntryLate { .. } => "crossings must come in time order",
        SetupError::EntryBehindPlane { .. } => {
            "move the inlet's plane or the wall, or turn the wall's normal round"
        }
        SetupError::BehindPlane { .. } => "move it to the side that the plane's normal points to",
        SetupError::ClumpOutlet(_) => "use test = \"centre\" in [[outlet]]",
        SetupError::PrecisionWithout { .. } => "leave the key out for double precision, or that effect",
        SetupError::DragAndSleep | SetupError::LocalDampingWith(_) | SetupError::BondsAndSleep => {
            "leave out one of them"
        }
        SetupError::BondOfZeroLength { .. } => "move one of them",
        SetupError::BondJoinsNothing { .. } => "give a larger gap, or leave it out",
        SetupError::ClumpSleep(_) => "leave out [sleep], or use spheres",
        SetupError::WallTooFast { .. } => "shorten dt, or slow the wall",
        SetupError::BeltLeavesPlane(_) => {
            "give surface_velocity along the plane, and surface_rotation.about along its normal"
        }
        SetupError::RotatingPlane(_) => "use a mesh or wall spheres, or rotate.about along the normal",
        SetupError::OtherState(_) => "resume with the scene of the saved run",
    };
    Some(fixed.to_owned())
}

/// What sets the critical time step, as scenes name it.
pub fn explain_step_cause(cause: &StepCause) -> String {
    let rest = StepCause { drag: None, motion: None, ..cause.clone() };
    let motion = cause.motion.iter().map(|motion| format!("{motion}; "));
    let drag = cause.drag.iter().map(|drag| format!("[drag] {drag}; "));
    motion.chain(drag).chain([rest.to_string()]).collect()
}

/// A number outside its range, under its key.
fn out_of_range(number: &OutOfRange) -> String {
    let OutOfRange { quantity, value, unit, allowed } = number;
    let allowed = match allowed {
        Allowed::Values(values) => match quantity.of {
            Subject::Precision(_) => format!("{values} (leave the key out for double precision)"),
            _ => values.to_string(),
        },
        Allowed::IndexOf(list) => format!("the scene's {list}"),
        Allowed::BelowOverlapGuard => {
            "what the stiffness bears: grains without load would overlap by more than guards.overlap"
                .to_owned()
        }
        Allowed::SomeWeight => "scenes with gravity: a sleeper wakes by a share of its weight".to_owned(),
    };
    format!("{}: {} {unit} is outside {allowed}", key(quantity), shown(*value))
}

/// The key of a number, or where it stands.
fn key(quantity: &Quantity) -> String {
    let name = quantity.name;
    match &quantity.of {
        Subject::TimeStep => format!("time.{name}"),
        Subject::Guards => format!("guards.{name}"),
        Subject::NeighbourLists => format!("neighbours.{name}"),
        Subject::Drag => format!("drag.{name}"),
        Subject::Sleep if name == "gravity" => "gravity, with [sleep]".to_owned(),
        Subject::Sleep => format!("sleep.{name}"),
        Subject::Precision(precision) => format!("precision \"{}\": {name}", precision.name()),
        Subject::PeriodicEnd(end) => format!("domain {end}: {name}"),
        Subject::Entry(id) if name == "inlet" => format!("inlet of particle {id}"),
        Subject::Entry(id) => format!("inlet: {name} of particle {id}"),
        Subject::EntryAlongFlow(id) => format!("inlet: {name} of particle {id} along the flow"),
        Subject::EntryClump(id) => format!("inlet: clump {id}"),
        Subject::Path(id) => format!("inlet: path of particle {id}: {name}"),
        Subject::Setup
        | Subject::Material(_)
        | Subject::Contact(_)
        | Subject::Bond(_)
        | Subject::Particle(_)
        | Subject::ClumpShape(_)
        | Subject::Clump(_)
        | Subject::Wall(_)
        | Subject::Inlet => quantity.to_string(),
    }
}
