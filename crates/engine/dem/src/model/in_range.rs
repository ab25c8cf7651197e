//! Checks of single numbers: each is refused with its quantity, value, unit and what is allowed.

use crate::model::{Allowed, OutOfRange, Quantity, SetupError, Subject};
use crate::setup::Setup;
use geom::Vec3;

/// Checks of numbers of one subject. It is named only when one is refused: a large setup has millions of them.
pub struct Check<S>(pub S);

impl<S: Fn() -> Subject> Check<S> {
    /// Refuses a value that is not ok.
    pub fn within(
        &self,
        name: &'static str,
        value: f64,
        unit: &'static str,
        ok: bool,
        allowed: impl Into<Allowed>,
    ) -> Result<(), SetupError> {
        if ok { Ok(()) } else { Err(out_of_range((self.0)().quantity(name), value, unit, allowed)) }
    }

    /// Refuses all but numbers above 0 that a quantity of this unit may have.
    pub fn positive(&self, name: &'static str, value: f64, unit: &'static str) -> Result<(), SetupError> {
        let [least, most] = magnitudes(unit);
        if value > 0.0 && (least..=most).contains(&value) {
            return Ok(());
        }
        let key = name.rsplit('.').next().unwrap_or_default();
        let range =
            if value > 0.0 { format!("{least:e} ≤ {key} ≤ {most:e}") } else { format!("{key} > 0") };
        self.within(name, value, unit, false, range)
    }

    /// Refuses infinity, NaN, and numbers that are larger than a quantity of this unit may be.
    pub fn finite(&self, name: &'static str, value: f64, unit: &'static str) -> Result<(), SetupError> {
        let [_, most] = magnitudes(unit);
        if value.abs() <= most {
            return Ok(());
        }
        self.within(name, value, unit, false, format!("−{most:e} to {most:e}"))
    }

    /// Refuses a vector with a number that is not finite.
    pub fn vector(&self, name: &'static str, v: &Vec3, unit: &'static str) -> Result<(), SetupError> {
        v.iter().try_for_each(|&x| self.finite(name, x, unit))
    }

    /// Refuses an index of a material that there is not.
    pub fn material(&self, name: &'static str, material: u16, setup: &Setup) -> Result<(), SetupError> {
        let known = (material as usize) < setup.materials.len();
        self.within(name, material.into(), "[–]", known, Allowed::IndexOf("materials"))
    }

    /// Refuses a position that is none, or too far away for a sphere.
    pub fn place(&self, name: &'static str, position: &Vec3, radius: f64) -> Result<(), SetupError> {
        if position.iter().all(|x| x.is_finite()) {
            return self.near(name, position, radius);
        }
        self.vector(name, position, "m")
    }

    /// Refuses a sphere so far away that its position has too few digits left: it would hang in the air.
    pub fn near(&self, name: &'static str, position: &Vec3, radius: f64) -> Result<(), SetupError> {
        let far = position.amax();
        if far * f64::EPSILON <= DIGITS * radius {
            return Ok(());
        }
        Err(SetupError::TooFar { quantity: Box::new((self.0)().quantity(name)), far, radius })
    }

    /// Refuses a sphere without a centre or a radius.
    pub fn sphere(&self, (centre, radius): &(Vec3, f64)) -> Result<(), SetupError> {
        self.positive("radius", *radius, "m")?;
        self.place("sphere", centre, *radius)
    }
}

/// The smallest (but 0) and the largest number that a quantity of this unit may have: beyond, results overflow, or lose all their digits.
pub fn magnitudes(unit: &str) -> [f64; 2] {
    match unit {
        "m" => [1e-15, 1e15],
        "m/s" | "rad/s" | "rpm" => [1e-18, 1e12],
        // Files count seconds in 32 bits.
        "s" => [1e-18, 4e9],
        "Hz" => [1e-18, 1e15],
        "Pa" => [1e-9, 1e35],
        "N/m" => [1e-9, 1e18],
        "Pa/m" => [1e-6, 1e38],
        "kg/m³" => [f64::MIN_POSITIVE, 1e30],
        "" | "[–]" | "m/s²" | "Pa·s" => [1e-12, 1e12],
        _ => [f64::MIN_POSITIVE, 1e18],
    }
}

/// Share of its radius to which a position is known, or better.
const DIGITS: f64 = 1e-6;

/// A number that is outside its range.
pub(crate) fn out_of_range(
    quantity: Quantity,
    value: f64,
    unit: &'static str,
    allowed: impl Into<Allowed>,
) -> SetupError {
    SetupError::OutOfRange(Box::new(OutOfRange { quantity, value, unit, allowed: allowed.into() }))
}

/// Refuses numbers of materials that there are not: everything else looks them up.
pub(crate) fn indices(setup: &Setup) -> Result<(), SetupError> {
    for c in &setup.contacts {
        Check(|| Subject::Contact(None)).material("between", c.between.0.max(c.between.1), setup)?;
    }
    for p in &setup.particles {
        Check(|| Subject::Particle(p.id)).material("material", p.material, setup)?;
    }
    for shape in &setup.clumps.shapes {
        Check(|| Subject::ClumpShape(shape.name.clone())).material("material", shape.material, setup)?;
    }
    for wall in &setup.walls {
        Check(|| Subject::Wall(wall.name.clone())).material("material", wall.material, setup)?;
    }
    let inlet = Check(|| Subject::Inlet);
    setup.entry_materials.iter().try_for_each(|&m| inlet.material("material", m, setup))
}
