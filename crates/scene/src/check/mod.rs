//! Values that a key may have.

use crate::error::{SceneError, ValueError, nearest};
use crate::model::{Diameter, Drag, DragLaw, Every, Model, OrAuto, Servo, Sleep, Time, Wall};
use crate::text::Text;
use std::fmt::Display;

/// Refuses values, naming key, value, unit and cure.
pub(crate) struct Check<'a> {
    pub text: &'a Text,
}

pub(crate) type Checked = Result<(), SceneError>;

impl Check<'_> {
    /// The error for a key's value.
    pub(crate) fn wrong(&self, key: &str, value: impl Display, why: &str, cure: &str) -> SceneError {
        SceneError::Value(Box::new(ValueError {
            place: self.text.place(key),
            key: key.to_owned(),
            value: value.to_string(),
            why: why.to_owned(),
            cure: cure.to_owned(),
        }))
    }

    /// A number above zero.
    pub(crate) fn positive(&self, key: &str, value: f64, unit: &str) -> Checked {
        if value > 0.0 && value.is_finite() {
            return Ok(());
        }
        Err(self.wrong(
            key,
            format!("{value} {unit}").trim_end(),
            "must be a finite number above 0",
            "give a positive value",
        ))
    }

    pub(crate) fn positive_if(&self, key: &str, value: Option<f64>, unit: &str) -> Checked {
        value.map_or(Ok(()), |v| self.positive(key, v, unit))
    }

    pub(crate) fn within(&self, key: &str, value: f64, low: f64, high: f64, unit: &str) -> Checked {
        if (low..=high).contains(&value) {
            return Ok(());
        }
        let cure = format!("give {low} to {high}{}{unit}", if unit.is_empty() { "" } else { " " });
        Err(self.wrong(key, format!("{value} {unit}").trim_end(), "is outside the range", &cure))
    }

    pub(crate) fn finite(&self, key: &str, value: &[f64], unit: &str) -> Checked {
        if value.iter().all(|v| v.is_finite()) {
            return Ok(());
        }
        Err(self.wrong(key, format!("{value:?} {unit}"), "must be finite", "give numbers"))
    }

    pub(crate) fn diameter(&self, key: &str, d: Diameter) -> Checked {
        self.positive(key, d.low, "m")?;
        self.positive(key, d.high, "m")?;
        if d.low > d.high {
            let value = format!("[{}, {}] m", d.low, d.high);
            return Err(self.wrong(key, value, "the range is upside down", "give [smallest, largest]"));
        }
        if d.high > 100.0 {
            let value = format!("{} m", d.high);
            return Err(self.wrong(
                key,
                value,
                "is larger than 100 m",
                "lengths are in metres: 5 mm is 0.005",
            ));
        }
        Ok(())
    }

    fn length(&self, key: &str, value: OrAuto) -> Checked {
        match value {
            OrAuto::Auto => Ok(()),
            OrAuto::Given(v) => self.positive(key, v, "m"),
        }
    }

    /// One and only one of several keys.
    pub(crate) fn one_of(&self, entry: &str, keys: &[(&str, bool)]) -> Checked {
        let names = || keys.iter().map(|k| k.0).collect::<Vec<_>>().join(" or ");
        let given: Vec<&str> = keys.iter().filter(|k| k.1).map(|k| k.0).collect();
        match given[..] {
            [_] => Ok(()),
            [] => Err(self.wrong(entry, "(without)", &format!("{} is missing", names()), "add one of them")),
            _ => {
                Err(self.wrong(entry, given.join(" and "), "only one of them can be", "take the others out"))
            }
        }
    }

    /// One of `accuracy`, `safety` and `dt` sets the step; an override of `dt` stands in the place of a `safety` of the file.
    fn accuracy(&self, time: &Time) -> Checked {
        let overruled = self.text.set_by("time.dt").is_some() && self.text.set_by("time.safety").is_none();
        if let (Some(safety), OrAuto::Given(dt), false) = (time.safety, time.dt, overruled) {
            let why = format!("dt = {dt} s sets the step already");
            return Err(self.wrong("time.safety", safety, &why, "take one of them out"));
        }
        let Some(accuracy) = time.accuracy else { return Ok(()) };
        self.within("time.accuracy", accuracy.0, 1e-9, 1.0, "")?;
        let shown = format!("{} %", geom::Shown(100.0 * accuracy.0));
        let refuse = |other: String| {
            Err(self.wrong(
                "time.accuracy",
                &shown,
                &format!("{other} sets the step already"),
                "take one of them out",
            ))
        };
        match (time.safety, time.dt) {
            (Some(safety), _) => refuse(format!("safety = {safety}")),
            (_, OrAuto::Given(dt)) => refuse(format!("dt = {dt} s")),
            _ => Ok(()),
        }
    }

    /// Every value of a scene that can be judged by itself.
    pub(crate) fn model(&self, m: &Model) -> Checked {
        self.finite("gravity", &m.gravity, "m/s²")?;
        self.positive_if("time.until", m.time.until, "s")?;
        if let OrAuto::Given(dt) = m.time.dt {
            self.positive("time.dt", dt, "s")?;
        }
        if let Some(safety) = m.time.safety {
            self.within("time.safety", safety, 1e-6, 1.0, "")?;
        }
        self.accuracy(&m.time)?;
        if let Some(Every::Given(every)) = m.output.every {
            self.positive("output.every", every, "s")?;
        }
        self.positive_if("output.checkpoint", m.output.checkpoint, "s")?;
        self.positive_if("neighbours.skin", m.neighbours.skin, "m")?;
        m.drag.as_ref().map_or(Ok(()), |d| self.drag(d))?;
        self.positive_if("guards.overlap", m.guards.overlap, "")?;
        self.positive_if("guards.motion", m.guards.motion, "")?;
        self.positive_if("guards.energy", m.guards.energy, "")?;
        self.within("first_id", f64::from(m.first_id), 0.0, 4e9, "")?;
        m.sleep.as_ref().map_or(Ok(()), |s| self.sleep(s))?;
        self.materials(m)?;
        self.contacts(m)?;
        self.bonds(m)?;
        self.clumps(m)?;
        self.sources(m)?;
        for (i, w) in m.wall.iter().enumerate() {
            self.wall(&format!("wall.{i}"), w)?;
        }
        for (i, o) in m.outlet.iter().enumerate() {
            self.length(&format!("outlet.{i}.length"), o.length)?;
            self.positive_if(&format!("outlet.{i}.samples"), o.samples, "s")?;
        }
        for (i, o) in m.inlet.iter().enumerate() {
            self.length(&format!("inlet.{i}.length"), o.length)?;
        }
        Ok(())
    }

    fn sleep(&self, s: &Sleep) -> Checked {
        self.positive("sleep.speed", s.speed, "m/s")?;
        self.positive("sleep.time", s.time, "s")?;
        if s.wake > 0.0 && s.wake < 1.0 {
            return Ok(());
        }
        let why = "is outside 0 to 1, both left out: from 1 on, a grain in free fall counts as one at rest";
        Err(self.wrong("sleep.wake", s.wake, why, "give a share of the weight, such as 0.1"))
    }

    fn drag(&self, d: &Drag) -> Checked {
        self.positive("drag.viscosity", d.viscosity, "Pa·s")?;
        self.positive_if("drag.density", d.density, "kg/m³")?;
        if d.density.is_none() && (d.buoyancy || d.law == DragLaw::SchillerNaumann) {
            let why = "is missing, and \"schiller-naumann\" and buoyancy need it";
            let cure = "add the density of the fluid [kg/m³], such as 1.2 for air or 1000 for water";
            return Err(self.wrong("drag.density", "(nothing)", why, cure));
        }
        self.finite("drag.velocity", &d.velocity, "m/s")
    }

    fn materials(&self, m: &Model) -> Checked {
        for (i, material) in m.material.iter().enumerate() {
            let key = |k: &str| format!("material.{i}.{k}");
            if m.material[..i].iter().any(|o| o.name == material.name) {
                let why = "another material has this name";
                return Err(self.wrong(
                    &key("name"),
                    &material.name,
                    why,
                    "give every material its own name",
                ));
            }
            if material.name.is_empty() || material.name == "*" {
                return Err(self.wrong(
                    &key("name"),
                    format!("\"{}\"", material.name),
                    "is no name",
                    "name the material",
                ));
            }
            self.positive_if(&key("density"), material.density, "kg/m³")?;
            self.positive(&key("young"), material.young, "Pa")?;
            self.within(&key("poisson"), material.poisson, 0.0, 0.499, "")?;
        }
        Ok(())
    }

    fn sources(&self, m: &Model) -> Checked {
        for (i, f) in m.fill.iter().enumerate() {
            let key = |k: &str| format!("fill.{i}.{k}");
            self.grains(&format!("fill.{i}"), &f.material, f.diameter, (f.clump.is_some(), f.scale))?;
            self.positive_if(&key("mass"), f.mass, "kg")?;
            if f.count == Some(0) {
                return Err(self.wrong(&key("count"), "0", "no particle is asked for", "give at least 1"));
            }
            self.one_of(&format!("fill.{i}"), &[("mass", f.mass.is_some()), ("count", f.count.is_some())])?;
            self.finite(&key("velocity"), &f.velocity, "m/s")?;
        }
        for (i, f) in m.insert.iter().enumerate() {
            let key = |k: &str| format!("insert.{i}.{k}");
            self.grains(&format!("insert.{i}"), &f.material, f.diameter, (f.clump.is_some(), f.scale))?;
            self.positive_if(&key("rate"), f.rate, "kg/s")?;
            self.positive_if(&key("rate_count"), f.rate_count, "1/s")?;
            let rates = [("rate", f.rate.is_some()), ("rate_count", f.rate_count.is_some())];
            self.one_of(&format!("insert.{i}"), &rates)?;
            self.finite(&key("velocity"), &f.velocity, "m/s")?;
            self.within(&key("from"), f.from, 0.0, f64::MAX, "s")?;
            if f.until.is_some_and(|u| u.is_nan() || u <= f.from) {
                let value = format!("{} s", f.until.unwrap_or(0.0));
                return Err(self.wrong(&key("until"), value, "is not after 'from'", "give a later time"));
            }
        }
        Ok(())
    }

    fn wall(&self, entry: &str, w: &Wall) -> Checked {
        let kinds = [
            ("source", w.source.is_some()),
            ("plane", w.plane.is_some()),
            ("mesh", w.mesh.is_some()),
            ("box", w.cuboid.is_some()),
        ];
        if kinds.iter().any(|k| k.1) {
            self.one_of(entry, &kinds)?;
        }
        if w.faces.is_some() && w.cuboid.is_none() {
            let why = "only a box has faces";
            return Err(self.wrong(
                &format!("{entry}.faces"),
                "(given)",
                why,
                "add box = [x0,y0,z0,x1,y1,z1]",
            ));
        }
        if let Some(b) = w.cuboid {
            self.finite(&format!("{entry}.box"), &b, "m")?;
            if (0..3).any(|a| b[a] >= b[a + 3]) {
                let why = "has no inside";
                return Err(self.wrong(
                    &format!("{entry}.box"),
                    format!("{b:?} m"),
                    why,
                    "give the lowest corner, then the highest",
                ));
            }
        }
        w.servo.as_ref().map_or(Ok(()), |s| self.servo(entry, w, s))?;
        let Some(motion) = &w.motion else { return Ok(()) };
        let key = |k: &str| format!("{entry}.motion.{k}");
        if motion.rotate.is_none() && motion.translate.is_none() && motion.vibrate.is_none() {
            let why = "says of no motion what it is";
            let cure = "add rotate, translate or vibrate, or take it out";
            return Err(self.wrong(&format!("{entry}.motion"), "{ }", why, cure));
        }
        self.finite(&key("from"), &[motion.from], "s")?;
        if motion.until.is_some_and(|u| !(u > motion.from)) {
            let value = format!("{} s", motion.until.unwrap_or(0.0));
            return Err(self.wrong(&key("until"), value, "is not after 'from'", "give a later time"));
        }
        if let Some(r) = &motion.rotate {
            self.finite(&key("rotate.about"), &r.about, "")?;
            self.finite(&key("rotate.through"), &r.through, "m")?;
            self.finite(&key("rotate.rpm"), &[r.rpm], "1/min")?;
            if r.about == [0.0; 3] {
                return Err(self.wrong(
                    &key("rotate.about"),
                    "[0, 0, 0]",
                    "has no direction",
                    "such as [0, 0, 1]",
                ));
            }
        }
        self.finite(&key("translate"), &motion.translate.unwrap_or_default(), "m/s")?;
        if let Some(v) = &motion.vibrate {
            self.finite(&key("vibrate.amplitude"), &v.amplitude, "m")?;
            self.positive(&key("vibrate.frequency"), v.frequency, "Hz")?;
        }
        Ok(())
    }

    fn servo(&self, entry: &str, w: &Wall, s: &Servo) -> Checked {
        let key = |k: &str| format!("{entry}.servo.{k}");
        self.finite(&key("direction"), &s.direction, "")?;
        if s.direction == [0.0; 3] {
            return Err(self.wrong(&key("direction"), "[0, 0, 0]", "has no direction", "such as [0, 0, -1]"));
        }
        let of = [("force", s.force.is_some()), ("stress", s.stress.is_some())];
        self.one_of(&format!("{entry}.servo"), &of)?;
        self.finite(&key("force"), &[s.force.unwrap_or(0.0)], "N")?;
        self.finite(&key("stress"), &[s.stress.unwrap_or(0.0)], "Pa")?;
        for (k, value, unit) in [("force", s.force, "N"), ("stress", s.stress, "Pa")] {
            if let Some(value) = value.filter(|value| *value < 0.0) {
                let why = "pulls, and a wall only pushes";
                let cure = "give it without the sign, and turn the direction round";
                return Err(self.wrong(&key(k), format!("{value} {unit}"), why, cure));
            }
        }
        self.positive_if(&key("area"), s.area, "m²")?;
        if s.stress.is_some() != s.area.is_some() {
            let why = "stress and area make a force together";
            return Err(self.wrong(&key("area"), "(one of them)", why, "give both, or force [N] alone"));
        }
        self.positive(&key("speed_limit"), s.speed_limit, "m/s")?;
        if w.cuboid.is_some() && w.faces.as_ref().is_none_or(|f| f.len() != 1) {
            let why = "all faces of the box would follow one direction";
            let cure = "give the face that moves a [[wall]] of its own: faces = [\"z+\"]";
            return Err(self.wrong(&format!("{entry}.servo"), "(with a box)", why, cure));
        }
        Ok(())
    }

    /// The index of a material, by name.
    pub(crate) fn material(
        &self,
        key: &str,
        name: &str,
        known: &[dem::setup::Material],
    ) -> Result<u16, SceneError> {
        if let Some(at) = known.iter().position(|m| m.name == name) {
            return Ok(at as u16);
        }
        let names = known.iter().map(|m| m.name.as_str());
        let cure = match nearest(name, names.clone()) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("known: {}", names.collect::<Vec<_>>().join(", ")),
        };
        Err(self.wrong(key, format!("\"{name}\""), "no [[material]] has this name", &cure))
    }
}
