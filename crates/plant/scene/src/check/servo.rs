//! Checks of the servo and of the spring of a wall.

use super::Check;
use crate::error::Result;
use crate::keys::{Servo, Side, Spring, Wall};

impl Check<'_> {
    pub(super) fn servo(&self, entry: &str, w: &Wall, s: &Servo) -> Result<()> {
        let key = |k: &str| format!("{entry}.servo.{k}");
        self.direction(&key("direction"), s.direction, "such as [0, 0, -1]")?;
        let of = [("force", s.force.is_some()), ("stress", s.stress.is_some()), ("path", s.path.is_some())];
        self.one_of(&format!("{entry}.servo"), &of)?;
        for (k, value, unit) in [("force", s.force, "N"), ("stress", s.stress, "Pa")] {
            if let Some(value) = value.filter(|value| *value < 0.0) {
                let why = "pulls, and a wall only pushes";
                let cure = "give it without the sign, and turn the direction round";
                return Err(self.wrong(&key(k), format!("{value} {unit}"), why, cure));
            }
        }
        self.servo_area(entry, s)?;
        if w.cuboid.is_some() && w.faces.as_ref().is_none_or(|f| f.len() != 1) {
            let why = "all faces of the box would follow one direction";
            let cure = "put the face that moves into a separate [[wall]]: faces = [\"z+\"]";
            return Err(self.wrong(&format!("{entry}.servo"), "(with a box)", why, cure));
        }
        Ok(())
    }

    pub(super) fn spring(&self, entry: &str, w: &Wall, s: &Spring) -> Result<()> {
        let key = |k: &str| format!("{entry}.spring.{k}");
        self.direction(&key("direction"), s.direction, "such as [0, 0, 1]")?;
        if w.servo.is_some() {
            let why = "a wall follows its servo or moves on its spring";
            return Err(self.wrong(&format!("{entry}.spring"), "(with servo)", why, "take one of them out"));
        }
        if w.cuboid.is_some() && w.faces.as_ref().is_none_or(|f| f.len() != 1) {
            let why = "each face of the box would be a wall on its own spring";
            let cure = "put the face that moves into a separate [[wall]]: faces = [\"z-\"]";
            return Err(self.wrong(&format!("{entry}.spring"), "(with a box)", why, cure));
        }
        Ok(())
    }

    /// The area that a stress acts on.
    fn servo_area(&self, entry: &str, s: &Servo) -> Result<()> {
        let key = |k: &str| format!("{entry}.servo.{k}");
        for side in s.area_between.iter().flatten() {
            if let Side::Walls([a, b]) = side
                && a == b
            {
                let value = format!("[\"{a}\", \"{b}\"]");
                let cure = "name the two walls between which the side lies";
                return Err(self.wrong(&key("area_between"), value, "names one wall twice", cure));
            }
        }
        if s.area.is_some() && s.area_between.is_some() {
            let why = "both give the area that the stress acts on";
            return Err(self.wrong(&key("area"), "(with area_between)", why, "take one of them out"));
        }
        let given = s.area.is_some() || s.area_between.is_some();
        if s.stress.is_some() && !given {
            let why = "stress and area make a force together";
            return Err(self.wrong(
                &key("area"),
                "(missing)",
                why,
                "give area or area_between, or force [N] alone",
            ));
        }
        if s.force.is_some() && given {
            let which = if s.area.is_some() { "area" } else { "area_between" };
            let why = "a force needs no area: stress and area make a force together";
            return Err(self.wrong(
                &key(which),
                "(with force)",
                why,
                "take it out, or give stress [Pa] instead of force",
            ));
        }
        Ok(())
    }
}
