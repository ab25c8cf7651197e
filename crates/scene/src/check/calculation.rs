//! Checks of how a scene is calculated and written, and of the fluid around its particles.

use super::Check;
use crate::error::Result;
use crate::keys::{Drag, DragLaw, Every, SceneKeys, Sleep, Time};

/// Whole numbers up to here are exact.
const EXACT: f64 = 9e15;

impl Check<'_> {
    /// `[time]`, `[output]`, `[guards]` and the other single tables.
    pub(super) fn calculation(&self, m: &SceneKeys) -> Result<()> {
        self.finite("gravity", &m.gravity, "m/s²")?;
        for (key, corner) in [("domain.low", m.domain.low), ("domain.high", m.domain.high)] {
            self.finite(key, &corner.unwrap_or_default(), "m")?;
        }
        self.positive("time.until", m.time.until, "s")?;
        self.within("time.until", m.time.until.unwrap_or(0.0), 0.0, record::LATEST, "s")?;
        self.positive("time.dt", m.time.dt.0, "s")?;
        if let Some(safety) = m.time.safety {
            self.within("time.safety", safety, 1e-6, 1.0, "")?;
        }
        self.accuracy(&m.time)?;
        self.within("time.shorten", m.time.shorten.unwrap_or(0.0), 0.0, 0.5, "")?;
        if let Some(Every::Given(every)) = m.output.every {
            self.positive("output.every", every, "s")?;
        }
        self.positive("output.checkpoint", m.output.checkpoint, "s")?;
        self.positive("neighbours.skin", m.neighbours.skin, "m")?;
        m.drag.as_ref().map_or(Ok(()), |d| self.drag(d))?;
        self.positive("guards.overlap", m.guards.overlap, "")?;
        self.positive("guards.motion", m.guards.motion, "")?;
        self.positive("guards.energy", m.guards.energy, "")?;
        self.within("guards.steps", m.guards.steps.unwrap_or(1.0), 1.0, EXACT, "")?;
        self.within("guards.frames", m.guards.frames.unwrap_or(1.0), 1.0, EXACT, "")?;
        self.within("first_id", f64::from(m.first_id), 0.0, 4e9, "")?;
        m.sleep.as_ref().map_or(Ok(()), |s| self.sleep(s))
    }

    /// One of `accuracy`, `safety` and `dt` sets the step; an override of `dt` replaces a `safety` of the file.
    fn accuracy(&self, time: &Time) -> Result<()> {
        let overruled = self.text.set_by("time.dt").is_some() && self.text.set_by("time.safety").is_none();
        let refuse = |key: &str, value: String, other: String| {
            let why = format!("{other} sets the step already");
            Err(self.wrong(key, value, &why, "take one of them out"))
        };
        if let (Some(safety), Some(dt), false) = (time.safety, time.dt.0, overruled) {
            return refuse("time.safety", safety.to_string(), format!("dt = {dt} s"));
        }
        let Some(accuracy) = time.accuracy else { return Ok(()) };
        self.within("time.accuracy", accuracy.0, 1e-9, 1.0, "")?;
        let shown = format!("{} %", geom::Shown(100.0 * accuracy.0));
        match (time.safety, time.dt.0) {
            (Some(safety), _) => refuse("time.accuracy", shown, format!("safety = {safety}")),
            (_, Some(dt)) => refuse("time.accuracy", shown, format!("dt = {dt} s")),
            _ => Ok(()),
        }
    }

    fn sleep(&self, s: &Sleep) -> Result<()> {
        self.positive("sleep.speed", s.speed, "m/s")?;
        self.positive("sleep.time", s.time, "s")?;
        if s.wake > 0.0 && s.wake < 1.0 {
            return Ok(());
        }
        let why = "is outside 0 to 1, both left out: from 1 on, a grain in free fall counts as one at rest";
        Err(self.wrong("sleep.wake", s.wake, why, "give a share of the weight, such as 0.1"))
    }

    fn drag(&self, d: &Drag) -> Result<()> {
        self.positive("drag.viscosity", d.viscosity, "Pa·s")?;
        self.positive("drag.density", d.density, "kg/m³")?;
        if d.density.is_none() && (d.buoyancy || d.law == DragLaw::SchillerNaumann) {
            let why = "is missing, and \"schiller-naumann\" and buoyancy need it";
            let cure = "add the density of the fluid [kg/m³], such as 1.2 for air or 1000 for water";
            return Err(self.wrong("drag.density", "(nothing)", why, cure));
        }
        self.finite("drag.velocity", &d.velocity, "m/s")
    }
}
