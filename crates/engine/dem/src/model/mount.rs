//! Checks of walls on springs.

use crate::model::{Check, SetupError, Subject};
use crate::setup::{Setup, Wall};

/// Refuses springs without meaning, and walls with a servo as well.
pub fn check<F: Fn() -> Subject>(setup: &Setup, wall: &Wall, check: &Check<F>) -> Result<(), SetupError> {
    let Some(m) = &wall.mount else { return Ok(()) };
    let length = m.direction.norm();
    let unit = (length - 1.0).abs() < 1e-9;
    check.within("spring.direction", length, "[–]", unit, "directions of length 1")?;
    check.positive("spring.stiffness", m.stiffness, "N/m")?;
    check.within(
        "spring.damping",
        m.damping,
        "N·s/m",
        m.damping >= 0.0 && m.damping.is_finite(),
        "damping ≥ 0",
    )?;
    check.positive("spring.mass", m.mass, "kg")?;
    check.positive("spring.speed_limit", m.speed_limit, "m/s")?;
    let servo = if wall.servo.is_some() { 1.0 } else { 0.0 };
    check.within(
        "spring with servo",
        servo,
        "",
        servo == 0.0,
        "what a wall can have: a spring or a servo",
    )?;
    let periodic = (0..3).any(|a| setup.periodic[a].is_some() && m.direction[a] != 0.0);
    let along = if periodic { 1.0 } else { 0.0 };
    check.within("spring along a periodic axis", along, "", !periodic, "axes that are not periodic")
}
