//! Checks of `[[wall]]`, its motion and its servo.

use super::Check;
use crate::error::Result;
use crate::keys::{Motion, SceneKeys, Servo, Wall};
use geom::units;

impl Check<'_> {
    pub(super) fn walls(&self, m: &SceneKeys) -> Result<()> {
        m.wall.iter().enumerate().try_for_each(|(i, w)| self.wall(&format!("wall.{i}"), w))
    }

    fn wall(&self, entry: &str, w: &Wall) -> Result<()> {
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
            let cure = "add box = [x0,y0,z0,x1,y1,z1]";
            return Err(self.wrong(&format!("{entry}.faces"), "(given)", "only a box has faces", cure));
        }
        self.mesh_scale(entry, w)?;
        if let Some(b) = w.cuboid {
            let key = format!("{entry}.box");
            self.finite(&key, &b, "m")?;
            if (0..3).any(|a| b[a] >= b[a + 3]) {
                let cure = "give the lowest corner, then the highest";
                return Err(self.wrong(&key, format!("{b:?} m"), "has no inside", cure));
            }
        }
        w.servo.as_ref().map_or(Ok(()), |s| self.servo(entry, w, s))?;
        w.motion.as_ref().map_or(Ok(()), |motion| self.motion(&format!("{entry}.motion"), motion))
    }

    /// `scale` and `units` of a drawing.
    fn mesh_scale(&self, entry: &str, w: &Wall) -> Result<()> {
        for (key, given) in [("scale", w.scale.is_some()), ("units", w.units.is_some())] {
            if given && w.mesh.is_none() {
                let why = "only a mesh has lengths in another unit: everything else is in metres";
                return Err(self.wrong(
                    &format!("{entry}.{key}"),
                    "(given)",
                    why,
                    "take it out, or give mesh",
                ));
            }
        }
        if w.scale.is_some() && w.units.is_some() {
            let why = "both say what a length in the file is";
            return Err(self.wrong(&format!("{entry}.scale"), "(given)", why, "give scale or units"));
        }
        self.positive(&format!("{entry}.scale"), w.scale, "")?;
        let Some(name) = &w.units else { return Ok(()) };
        units::factor(name, "m").map(drop).map_err(|e| {
            let cure = "write \"mm\", \"cm\", \"m\", \"in\" or \"ft\"";
            self.wrong(&format!("{entry}.units"), format!("\"{name}\""), &e.to_string(), cure)
        })
    }

    fn motion(&self, entry: &str, motion: &Motion) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        if motion.rotate.is_none() && motion.translate.is_none() && motion.vibrate.is_none() {
            let cure = "add rotate, translate or vibrate, or take it out";
            return Err(self.wrong(entry, "{ }", "names no motion", cure));
        }
        self.finite(&key("from"), &[motion.from], "s")?;
        self.until(&key("until"), motion.until, motion.from)?;
        if let Some(r) = &motion.rotate {
            self.direction(&key("rotate.about"), r.about, "such as [0, 0, 1]")?;
            self.finite(&key("rotate.through"), &r.through, "m")?;
            self.finite(&key("rotate.rpm"), &[r.rpm], "1/min")?;
        }
        self.finite(&key("translate"), &motion.translate.unwrap_or_default(), "m/s")?;
        if let Some(v) = &motion.vibrate {
            self.finite(&key("vibrate.amplitude"), &v.amplitude, "m")?;
            self.positive(&key("vibrate.frequency"), v.frequency, "Hz")?;
        }
        Ok(())
    }

    /// A vector of any length but 0.
    fn direction(&self, key: &str, vector: [f64; 3], such: &str) -> Result<()> {
        self.finite(key, &vector, "")?;
        match vector == [0.0; 3] {
            true => Err(self.wrong(key, "[0, 0, 0]", "has no direction", such)),
            false => Ok(()),
        }
    }

    fn servo(&self, entry: &str, w: &Wall, s: &Servo) -> Result<()> {
        let key = |k: &str| format!("{entry}.servo.{k}");
        self.direction(&key("direction"), s.direction, "such as [0, 0, -1]")?;
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
        self.positive(&key("area"), s.area, "m²")?;
        if s.stress.is_some() != s.area.is_some() {
            let why = "stress and area make a force together";
            return Err(self.wrong(&key("area"), "(one of them)", why, "give both, or force [N] alone"));
        }
        self.positive(&key("speed_limit"), s.speed_limit, "m/s")?;
        if w.cuboid.is_some() && w.faces.as_ref().is_none_or(|f| f.len() != 1) {
            let why = "all faces of the box would follow one direction";
            let cure = "put the face that moves into a separate [[wall]]: faces = [\"z+\"]";
            return Err(self.wrong(&format!("{entry}.servo"), "(with a box)", why, cure));
        }
        Ok(())
    }
}
