//! Margins: how far particles may go until neighbours are listed again, and which of them touch where they are listed.

use crate::float::Float;
use crate::simd::Row4;
use primitives::Vec3;

/// What all particles share when they are listed.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct MarginInputs {
    /// Gap up to which neighbours are listed [m].
    pub skin: f64,
    /// How far ahead lists look [s].
    pub horizon: f64,
    /// Acceleration of free fall [m/s²].
    pub gravity: f64,
    /// Most that a margin holds for the way of a particle [m].
    pub most: f64,
    /// How far ahead in time contacts are looked for [s].
    pub ahead: f64,
}

impl MarginInputs {
    /// Margin of a particle with a velocity [m].
    #[inline(always)]
    pub fn of(&self, velocity: &Vec3) -> f64 {
        let speed = velocity.norm_squared().root();
        let way = self.horizon * (speed + 0.5 * self.gravity * self.horizon);
        margin(self.skin, way, self.most) + self.ahead * speed
    }
}

/// Room of a particle [m]: a share of the skin, and the `way` that it is expected to go, but no more than `most`: beyond, lists that
/// hold longer would cost more than they save.
#[inline(always)]
pub fn margin(skin: f64, way: f64, most: f64) -> f64 {
    0.5 * skin + way.min(most)
}

/// Whether two particles touched where they were listed, of these radii [m].
#[inline(always)]
pub fn touched(homes: [&Row4; 2], radii: [f64; 2]) -> bool {
    let square: f64 = (0..3).map(|x| (homes[0][x] - homes[1][x]) * (homes[0][x] - homes[1][x])).sum();
    let reach = radii[0] + radii[1];
    square < reach * reach
}
