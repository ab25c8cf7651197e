//! Sizes of two grains that meet.

/// What of the sizes of two grains a law may depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// R* [m].
    pub radius: f64,
    /// m* [kg].
    pub mass: f64,
    /// The smaller radius [m].
    pub smaller: f64,
    /// r_i + r_j [m]; infinite at a flat wall.
    pub sum: f64,
}

impl Meeting {
    /// Sizes that are not known: what depends on them comes out as no number, which LAMMPS would refuse.
    pub const UNKNOWN: Meeting =
        Meeting { radius: f64::NAN, mass: f64::NAN, smaller: f64::NAN, sum: f64::NAN };

    /// Two grains of these radii [m] and masses [kg]; a wall has an infinite mass.
    pub fn of(radii: [f64; 2], masses: [f64; 2]) -> Meeting {
        let sum = radii[0] + radii[1];
        Meeting {
            radius: radii[0] * radii[1] / sum,
            mass: 1.0 / (1.0 / masses[0] + 1.0 / masses[1]),
            smaller: radii[0].min(radii[1]),
            sum,
        }
    }

    /// A grain at a flat wall.
    pub fn flat(radius: f64, mass: f64) -> Meeting {
        Meeting { radius, mass, smaller: radius, sum: f64::INFINITY }
    }

    /// Length of a bar between the centres; 4 r at a flat wall [m].
    pub fn length(&self) -> f64 {
        if self.sum.is_infinite() { 4.0 * self.smaller } else { self.sum }
    }

    /// r²/(r_i + r_j) with the smaller radius; r at a flat wall [m].
    pub fn thickness(&self) -> f64 {
        if self.sum.is_infinite() { self.smaller } else { self.smaller * self.smaller / self.sum }
    }
}
