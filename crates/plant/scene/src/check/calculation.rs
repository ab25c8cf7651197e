//! Checks of how a scene is calculated, and of the fluid around its particles.

use super::Check;
use crate::error::Result;
use crate::keys::{Drag, DragLaw, Insert, SceneKeys, Time};

impl Check<'_> {
    /// `[domain]`, `[time]`, `[local_damping]` and `[drag]`: keys that do not go together.
    pub(super) fn calculation(&self, m: &SceneKeys) -> Result<()> {
        self.domain(m)?;
        self.settling(m)?;
        self.local_damping(m)?;
        self.accuracy(&m.time)?;
        m.drag.as_ref().map_or(Ok(()), |d| self.drag(d))
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
        let shown = format!("{} %", geom::Shown(100.0 * accuracy.0));
        match (time.safety, time.dt.0) {
            (Some(safety), _) => refuse("time.accuracy", shown, format!("safety = {safety}")),
            (_, Some(dt)) => refuse("time.accuracy", shown, format!("dt = {dt} s")),
            _ => Ok(()),
        }
    }

    /// A run that ends when it has come to rest knows only of its own scene.
    fn settling(&self, m: &SceneKeys) -> Result<()> {
        let keys = [("until_unbalanced", m.time.until_unbalanced), ("until_kinetic", m.time.until_kinetic)];
        let Some((key, value)) =
            keys.iter().find_map(|(key, value)| value.map(|v| (format!("time.{key}"), v)))
        else {
            return Ok(());
        };
        if !m.outlet.is_empty() || !m.inlet.is_empty() {
            let why = "a stage of a cut runs to its until: the other stages count on it";
            return Err(self.wrong(&key, value, why, "take it out, or settle the scene before it is cut"));
        }
        let open = |i: &Insert| i.until.is_none() && i.mass.is_none() && i.count.is_none();
        let endless = |i: &Insert| if i.repeat.is_some() { i.times.is_none() } else { open(i) };
        if let Some(at) = m.insert.iter().position(endless) {
            let why = format!("insert.{at} has no end, so that the grains never come to rest");
            let missing = if m.insert[at].repeat.is_some() { "times" } else { "until, mass or count" };
            return Err(self.wrong(&key, value, &why, &format!("add {missing} to insert.{at}")));
        }
        Ok(())
    }

    fn local_damping(&self, m: &SceneKeys) -> Result<()> {
        if m.local_damping.is_some() && m.sleep.is_some() {
            let why = "does not act with [sleep]";
            return Err(self.wrong("local_damping", "(given)", why, "leave out one of them"));
        }
        Ok(())
    }

    fn drag(&self, d: &Drag) -> Result<()> {
        if d.density.is_none() && (d.buoyancy || d.law == DragLaw::SchillerNaumann) {
            let why = "is missing, and \"schiller-naumann\" and buoyancy need it";
            let cure = "add the density of the fluid [kg/m³], such as 1.2 for air or 1000 for water";
            return Err(self.wrong("drag.density", "(nothing)", why, cure));
        }
        Ok(())
    }
}
