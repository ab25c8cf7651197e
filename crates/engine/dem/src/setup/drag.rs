//! A fluid at uniform velocity, as a setup asks for it ([`crate::passes::drag`] says what it does).

use crate::space::mass;
use geom::Vec3;
use laws::simd::Row;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Re from which the drag coefficient is constant [–].
const TURBULENT: f64 = 1000.0;

/// That coefficient [–].
const NEWTON: f64 = 0.44;

/// How drag depends on speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum DragLaw {
    /// Slow, Re ≪ 1.
    Stokes,
    /// Re up to 2·10⁵.
    SchillerNaumann,
}

/// A fluid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Drag {
    /// How drag depends on speed.
    pub law: DragLaw,
    /// μ [Pa·s].
    pub viscosity: f64,
    /// ρ_f [kg/m³].
    pub density: f64,
    /// u [m/s].
    pub velocity: Vec3,
    /// Whether it lifts particles by the weight of what they displace.
    pub buoyancy: bool,
}

impl Drag {
    /// Rate λ = |F| / (m |w|) of a sphere at a relative speed [m/s]: 1/s.
    fn rate(&self, radius: f64, inverse_mass: f64, speed: f64) -> f64 {
        6.0 * PI * self.viscosity * radius * inverse_mass * self.factor(radius, speed)
    }

    /// Drag over that of Stokes [–].
    fn factor(&self, radius: f64, speed: f64) -> f64 {
        match self.law {
            DragLaw::Stokes => 1.0,
            DragLaw::SchillerNaumann => {
                let re = self.reynolds(radius, speed);
                if re < TURBULENT { 1.0 + 0.15 * libm::pow(re, 0.687) } else { NEWTON * re / 24.0 }
            }
        }
    }

    fn reynolds(&self, radius: f64, speed: f64) -> f64 {
        2.0 * radius * self.density * speed / self.viscosity
    }

    /// Acceleration by drag alone [m/s²], of a particle's row.
    pub(crate) fn slowing(&self, row: &Row) -> Vec3 {
        let w = row.velocity() - self.velocity;
        w * -self.rate(row.radius(), row.inverse_mass(), w.norm())
    }

    /// Weight of the fluid that particles displace over their own, of one density [–].
    pub fn lift(&self, density: f64) -> f64 {
        if self.buoyancy { self.density / density } else { 0.0 }
    }

    /// Acceleration by the fluid [m/s²], of a particle's row.
    pub fn acceleration(&self, row: &Row, gravity: &Vec3) -> Vec3 {
        let lift = self.lift(1.0) * mass(row.radius(), 1.0) * row.inverse_mass();
        self.slowing(row) - gravity * lift
    }

    /// d(factor · |w|)/d|w| [–].
    pub(crate) fn slope(&self, radius: f64, speed: f64) -> f64 {
        match self.law {
            DragLaw::Stokes => 1.0,
            DragLaw::SchillerNaumann => {
                let re = self.reynolds(radius, speed);
                let low = 1.0 + 0.15 * 1.687 * libm::pow(re.min(TURBULENT), 0.687);
                low.max(if re > TURBULENT { NEWTON * re / 12.0 } else { 0.0 })
            }
        }
    }
}
