//! Checks of `[[wall]]` and its motion.

use super::Check;
use crate::error::Result;
use crate::keys::{Motion, OneOrMore, Path, Place, Rotate, SceneKeys, Wall};
use geom::units;
use std::collections::BTreeMap;

impl Check<'_> {
    pub(super) fn walls(&self, m: &SceneKeys) -> Result<()> {
        m.wall.iter().enumerate().try_for_each(|(i, w)| self.wall(&format!("wall.{i}"), w))?;
        self.wall_names(&m.wall)
    }

    /// Results, servos and stages name walls, and faces of boxes: no two have one name.
    fn wall_names(&self, walls: &[Wall]) -> Result<()> {
        let mut known: BTreeMap<String, usize> = BTreeMap::new();
        for (i, wall) in walls.iter().enumerate() {
            let (key, name) = (format!("wall.{i}.name"), wall.name_at(i));
            for own in wall.names(&name) {
                let Some(other) = known.insert(own.clone(), i) else { continue };
                let at = self.text.place(&format!("wall.{other}.name"));
                let why = match own == name {
                    true => format!("is a name of wall.{other} ({at}), too"),
                    false => format!("gives a face the name \"{own}\", which wall.{other} ({at}) has, too"),
                };
                return Err(self.wrong(&key, format!("\"{name}\""), &why, "give every wall its own name"));
            }
        }
        Ok(())
    }

    fn wall(&self, entry: &str, w: &Wall) -> Result<()> {
        let kinds = [
            ("source", w.source.is_some()),
            ("plane", w.plane.is_some()),
            ("mesh", w.mesh.is_some()),
            ("box", w.cuboid.is_some()),
            ("solid", w.solid.is_some()),
        ];
        if kinds.iter().any(|k| k.1) {
            self.one_of(entry, &kinds)?;
        }
        if w.faces.is_some() && w.cuboid.is_none() {
            let cure = "add box = [x0,y0,z0,x1,y1,z1]";
            return Err(self.wrong(&format!("{entry}.faces"), "(given)", "only a box has faces", cure));
        }
        if w.faces.as_ref().is_some_and(Vec::is_empty) {
            let cure = "name the faces that exist, such as faces = [\"z-\"], or take it out for all six";
            return Err(self.wrong(&format!("{entry}.faces"), "[]", "leaves nothing of the box", cure));
        }
        self.mesh_scale(entry, w)?;
        w.place.as_ref().map_or(Ok(()), |steps| self.place(&format!("{entry}.place"), steps))?;
        if let Some(b) = w.cuboid {
            let key = format!("{entry}.box");
            if (0..3).any(|a| b[a] >= b[a + 3]) {
                let cure = "give the lowest corner, then the highest";
                return Err(self.wrong(&key, format!("{b:?} m"), "has no inside", cure));
            }
        }
        w.servo.as_ref().map_or(Ok(()), |s| self.servo(entry, w, s))?;
        w.spring.as_ref().map_or(Ok(()), |s| self.spring(entry, w, s))?;
        self.belt(entry, w)?;
        w.motion.as_ref().map_or(Ok(()), |list| self.motions(&format!("{entry}.motion"), list))
    }

    /// Turns and shifts.
    fn place(&self, entry: &str, steps: &OneOrMore<Place>) -> Result<()> {
        for (key, step) in steps.entries(entry) {
            if step.rotate.is_none() && step.translate.is_none() {
                let cure = "add rotate = { about = [0, 1, 0], angle = \"10 deg\" } or translate = [0, 0, 1], or take it out";
                return Err(self.wrong(&key, "{ }", "puts nothing anywhere", cure));
            }
            if let Some(turn) = &step.rotate {
                self.direction(&format!("{key}.rotate.about"), turn.about, "such as [0, 0, 1]")?;
            }
        }
        Ok(())
    }

    /// `scale` and `units` of a drawing.
    fn mesh_scale(&self, entry: &str, w: &Wall) -> Result<()> {
        for (key, given) in [("scale", w.scale.is_some()), ("units", w.units.is_some())] {
            if given && w.mesh.is_none() && w.source.is_none() {
                let why = "only the files of mesh and source may have lengths in another unit: everything else is in metres";
                return Err(self.wrong(
                    &format!("{entry}.{key}"),
                    "(given)",
                    why,
                    "take it out, or give mesh",
                ));
            }
        }
        self.lengths(entry, w.scale, w.units.as_deref())
    }

    /// `scale` and `units` of a file.
    pub(super) fn lengths(&self, entry: &str, scale: Option<f64>, units: Option<&str>) -> Result<()> {
        if scale.is_some() && units.is_some() {
            let why = "both say what a length in the file is";
            return Err(self.wrong(&format!("{entry}.scale"), "(given)", why, "give scale or units"));
        }
        let Some(name) = units else { return Ok(()) };
        units::factor(name, "m").map(drop).map_err(|_| {
            let cure = "write \"µm\", \"mm\", \"cm\", \"m\", \"km\", \"in\" or \"ft\"";
            self.wrong(&format!("{entry}.units"), format!("\"{name}\""), "is no unit of length", cure)
        })
    }

    /// The surface of a belt or a turntable.
    fn belt(&self, entry: &str, w: &Wall) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        w.surface_rotation.as_ref().map_or(Ok(()), |r| self.rotate(&key("surface_rotation"), r))?;
        let still = w.surface_velocity.is_none_or(|v| v == [0.0; 3])
            && w.surface_rotation.as_ref().is_none_or(|r| r.rpm == 0.0);
        if still && let Some(name) = w.surface_velocity.map(|_| "surface_velocity") {
            let cure = "give a velocity, or take it out";
            return Err(self.wrong(&key(name), "[0, 0, 0] m/s", "moves nothing", cure));
        }
        Ok(())
    }

    fn rotate(&self, key: &str, r: &Rotate) -> Result<()> {
        self.direction(&format!("{key}.about"), r.about, "such as [0, 0, 1]")
    }

    /// One motion, or a list of them that act one after the other.
    fn motions(&self, entry: &str, list: &OneOrMore<Motion>) -> Result<()> {
        if list.is_empty() {
            let cure =
                "add a motion, such as { translate = [0.5, 0, 0], from = 2, until = 2.4 }, or take it out";
            return Err(self.wrong(entry, "[ ]", "names no motion", cure));
        }
        for (k, (key, motion)) in list.entries(entry).enumerate() {
            self.motion(&key, motion)?;
            let endless = motion.until.is_none() || motion.repeat.is_some();
            let carried = motion.translate.is_some_and(|v| v != [0.0; 3]) && endless;
            let turns = |m: &&Motion| {
                m.rotate.is_some() || m.swing.is_some() || m.path.as_ref().is_some_and(|p| p.about.is_some())
            };
            if carried && list[k + 1..].iter().any(|m| turns(&m)) {
                let why = "carries the wall ever farther from the axis of a later rotation, so that its speed has no bound";
                let cure = "add until without repeat, or give the rotation before the translation: it then turns about an axis that is carried along";
                let value = if motion.repeat.is_some() { "(with repeat)" } else { "(without until)" };
                return Err(self.wrong(&format!("{key}.translate"), value, why, cure));
            }
        }
        Ok(())
    }

    fn motion(&self, entry: &str, motion: &Motion) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let turns = [
            ("rotate", motion.rotate.is_some()),
            ("swing", motion.swing.is_some()),
            ("path.about", motion.path.as_ref().is_some_and(|p| p.about.is_some())),
        ];
        let names: Vec<&str> = turns.iter().filter(|t| t.1).map(|t| t.0).collect();
        if names.is_empty() && motion.translate.is_none() && motion.vibrate.is_none() && motion.path.is_none()
        {
            let cure = "add rotate, swing, translate, vibrate or path, or take it out";
            return Err(self.wrong(entry, "{ }", "names no motion", cure));
        }
        if names.len() > 1 {
            let why = "one motion turns about one axis";
            let cure = "write a list of motions: motion = [{ rotate = … }, { swing = … }]; each is carried by those after it";
            return Err(self.wrong(entry, names.join(" and "), why, cure));
        }
        self.until(&key("until"), motion.until, motion.from)?;
        let longest = 0.5 * (motion.ends().unwrap_or(f64::INFINITY) - motion.from);
        if !(0.0..=longest).contains(&motion.ramp) {
            let why = "does not fit: the motion takes it to start, and again to end";
            let cure = "give at most half of the time from `from` to `until`";
            return Err(self.wrong(&key("ramp"), format!("{} s", motion.ramp), why, cure));
        }
        self.repeat(entry, motion.repeat, motion.from, motion.until, motion.path.is_some())?;
        motion.rotate.as_ref().map_or(Ok(()), |r| self.rotate(&key("rotate"), r))?;
        if let Some(s) = &motion.swing {
            self.direction(&key("swing.about"), s.about, "such as [0, 1, 0]")?;
        }
        if let Some(p) = &motion.path {
            self.path_axis(&key("path"), p)?;
        }
        Ok(())
    }

    /// The axis of the angles of a table.
    fn path_axis(&self, key: &str, p: &Path) -> Result<()> {
        if let Some(about) = p.about {
            self.direction(&format!("{key}.about"), about, "such as [0, 1, 0]")?;
        }
        if p.about.is_some() != p.through.is_some() {
            let why = "about and through give an axis together";
            return Err(self.wrong(
                key,
                "(one of them)",
                why,
                "give both, or none if the file has no angles",
            ));
        }
        Ok(())
    }
}
