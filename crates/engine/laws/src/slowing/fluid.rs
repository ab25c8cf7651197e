//! A fluid at uniform velocity: its drag on a sphere, and its lift.
//!
//! ```text
//! F = −6 π μ r w                                  "stokes", w = v − u
//! F = −6 π μ r w (1 + 0.15 Re^0.687)              "schiller-naumann", Re = 2 r ρ_f |w| / μ < 1000
//! F = −½ · 0.44 ρ_f π r² |w| w                     from there on
//! F_b = −ρ_f V g                                  buoyancy
//! ```
//!
//! Stokes (1851), Trans. Camb. Phil. Soc. 9; Schiller & Naumann (1933), Z. Ver. Dtsch. Ing. 77; w is the predicted velocity of the
//! instant, as for contacts.

use crate::float::Float;
use crate::simd::Row;
use core::f64::consts::PI;
use primitives::{Vec3, volume};
use serde::{Deserialize, Serialize};

/// Re from which the drag coefficient is constant [–].
const TURBULENT: f64 = 1000.0;

/// That coefficient [–].
const NEWTON: f64 = 0.44;

/// How drag depends on speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[repr(u32)]
pub enum DragLaw {
    /// Slow, Re ≪ 1.
    #[default]
    Stokes,
    /// Re up to 2·10⁵.
    SchillerNaumann,
}

/// A fluid.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[repr(C)]
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
    #[inline]
    fn rate(&self, radius: f64, inverse_mass: f64, speed: f64) -> f64 {
        6.0 * PI * self.viscosity * radius * inverse_mass * self.factor(radius, speed)
    }

    /// Drag over that of Stokes [–].
    #[inline]
    fn factor(&self, radius: f64, speed: f64) -> f64 {
        match self.law {
            DragLaw::Stokes => 1.0,
            DragLaw::SchillerNaumann => {
                let re = self.reynolds(radius, speed);
                if re < TURBULENT { 1.0 + 0.15 * libm::pow(re, 0.687) } else { NEWTON * re / 24.0 }
            }
        }
    }

    #[inline]
    fn reynolds(&self, radius: f64, speed: f64) -> f64 {
        2.0 * radius * self.density * speed / self.viscosity
    }

    /// Acceleration by drag alone [m/s²], of a particle's row.
    #[inline]
    pub fn slowing(&self, row: &Row) -> Vec3 {
        let w = row.velocity() - self.velocity;
        w * -self.rate(row.radius(), row.inverse_mass(), w.norm_squared().root())
    }

    /// Weight of the fluid that particles displace over their own, of one density [–].
    #[inline]
    pub fn lift(&self, density: f64) -> f64 {
        if self.buoyancy { self.density / density } else { 0.0 }
    }

    /// Acceleration by the fluid [m/s²], of a particle's row.
    #[inline]
    pub fn acceleration(&self, row: &Row, gravity: &Vec3) -> Vec3 {
        let lift = self.lift(1.0) * volume(row.radius()) * row.inverse_mass();
        self.slowing(row) - gravity * lift
    }

    /// d(factor · |w|)/d|w| [–].
    pub fn slope(&self, radius: f64, speed: f64) -> f64 {
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
