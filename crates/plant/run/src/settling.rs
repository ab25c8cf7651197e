//! Whether the grains have come to rest: a run may end there, before its last step.

use crate::error::{Ended, Result};
use crate::underway::Run;
use geom::Shown;
use record::{json, topic};
use scene::SceneError;
use scene::keys::Time;
use serde::Serialize;
use serde_json::json as object;
use std::io::Write;

/// Steps between two checks: a check takes less than a step.
pub(crate) const EVERY: u64 = 200;
/// Largest mean unbalanced force over mean contact force of grains that lie [–]: grains at rest in the air have just begun to fall.
const LIE: f64 = 0.1;

/// At what a run ends before its last step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Settling {
    unbalanced: Option<f64>,
    kinetic: Option<f64>,
}

/// How far the grains are from rest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Settled {
    /// Mean unbalanced force over mean contact force [–]; `None` where no contact carries a force.
    pub unbalanced: Option<f64>,
    /// Kinetic energy [J].
    pub kinetic: f64,
}

impl Settling {
    pub(crate) fn of(time: &Time) -> Settling {
        Settling { unbalanced: time.until_unbalanced, kinetic: time.until_kinetic }
    }

    /// Whether anything is asked for.
    pub(crate) fn any(&self) -> bool {
        self.unbalanced.is_some() || self.kinetic.is_some()
    }

    /// Why the run ends, where it does.
    fn reached(&self, now: &Settled) -> Option<String> {
        let found = now.unbalanced?;
        if let Some(limit) = self.unbalanced.filter(|limit| found <= *limit) {
            let (found, limit) = (Shown(found), Shown(limit));
            return Some(format!(
                "mean unbalanced over mean contact force is {found}, time.until_unbalanced = {limit}"
            ));
        }
        let limit = self.kinetic.filter(|limit| now.kinetic <= *limit && found <= LIE)?;
        let (found, limit) = (Shown(now.kinetic), Shown(limit));
        Some(format!("kinetic energy is {found} J, time.until_kinetic = {limit} J"))
    }
}

impl<W: Write> Run<W> {
    /// Ends the run with this step where the grains have come to rest.
    pub(crate) fn settle(&mut self, step: u64) -> Result<(), Ended> {
        let settling = self.written.settling;
        if !settling.any()
            || step == 0
            || !step.is_multiple_of(EVERY)
            || self.supply.comes(self.schedule.end())
            || self.a_servo_is_on_its_way()
        {
            return Ok(());
        }
        let now = self.settled()?;
        if let Some(why) = settling.reached(&now) {
            if step == self.first {
                let why = format!("the grains of the saved run have come to rest: {why}");
                let cure =
                    "give a smaller time.until_unbalanced or time.until_kinetic, or take it out (--set)";
                return Err(SceneError::file("--resume", why, cure).into());
            }
            self.schedule.last = step;
            self.outcome.settled = Some(why.clone());
            self.note(&format!("the grains have come to rest: {why}"))?;
        }
        Ok(())
    }

    /// Whether a wall or the domain has yet to press on the grains: what it touches first is no packing at rest.
    fn a_servo_is_on_its_way(&self) -> bool {
        let walls = self.sim.servos().into_iter().map(|(_, servo)| (servo.target, servo.held));
        let axes = self.sim.followed_stresses().into_iter().flatten();
        walls.chain(axes).any(|(target, held)| target > 0.0 && held.since.is_none())
    }

    fn settled(&mut self) -> Result<Settled, Ended> {
        let energy = self.sim.energy()?;
        Ok(Settled { unbalanced: self.sim.unbalanced()?, kinetic: energy.translation + energy.rotation })
    }

    /// Writes how far the grains are from rest, with a frame.
    pub(crate) fn write_settling(&mut self) -> Result<(), Ended> {
        if !self.written.settling.any() {
            return Ok(());
        }
        let Settled { unbalanced, kinetic } = self.settled()?;
        let message = object!({"time": self.sim.time(), "unbalanced": unbalanced, "kinetic": kinetic});
        Ok(self.writer.bytes(topic::SETTLING, "json", self.now(), json(&message).as_bytes())?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_in_the_air_are_not_at_rest() {
        let settling = Settling { unbalanced: Some(1e-5), kinetic: Some(1e-6) };
        let now = |unbalanced, kinetic| Settled { unbalanced, kinetic };
        assert_eq!(settling.reached(&now(None, 0.0)), None);
        assert_eq!(settling.reached(&now(Some(0.5), 0.0)), None);
        assert!(settling.reached(&now(Some(0.01), 1e-7)).is_some_and(|why| why.contains("until_kinetic")));
        assert!(settling.reached(&now(Some(1e-6), 1.0)).is_some_and(|why| why.contains("until_unbalanced")));
        assert_eq!(settling.reached(&now(Some(1e-4), 1e-5)), None);
    }
}
