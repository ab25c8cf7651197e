//! Where on its path a particle is generated, so that the zone's motion brings it to the calculation plane as it was recorded.
//!
//! ```text
//! x₀ = x − v τ + ½ g τ²      v₀ = v − g τ          τ before it arrives; g only in free fall
//! R₀ = turn(−ω τ) R                                  of a clump
//! v τ − ½ g τ² = L           τ = 2 L / (v + √(v² − 2 g L))        to the generation plane; v, g along the normal
//! τ_apex = v/g               where a falling particle did not move along the normal: no path leads there from farther back
//! ```

use super::head::Head;
use super::{Intervals, Replay};
use crate::outlet::crossing::CrossingRow;
use dem::setup::{Zone, ZoneMotion};
use geom::{Shown, Vec3};
use scene::{Result, SceneError};

/// Places rows on their paths.
pub struct Generation {
    zone: Zone,
    /// Of the motion in the zone [m/s²].
    acceleration: Vec3,
    intervals: Intervals,
    ahead: Option<f64>,
    /// Whether particles arrive at the times that were recorded.
    kept: bool,
}

impl Generation {
    pub fn new(head: &Head, what: &Replay) -> Generation {
        let zone = head.zone.zone;
        let acceleration = head.acceleration();
        let kept =
            what.keep_times && what.intervals == Intervals::Both && zone.motion != ZoneMotion::Recorded;
        Generation { zone, acceleration, intervals: what.intervals, ahead: what.ahead, kept }
    }

    /// T of [`Intervals::Both`] [s], when it is known.
    pub fn ahead(&self) -> Option<f64> {
        self.ahead.filter(|_| self.intervals == Intervals::Both)
    }

    /// The longest time between generation and crossing, where particles cross at the times that were recorded [s]; ∞ while it is unknown.
    pub fn lead(&self) -> f64 {
        if self.kept { self.ahead.unwrap_or(f64::INFINITY) } else { 0.0 }
    }

    /// Gives a row the state in which it is generated. The result is how much later than its crossing that is [s], in a stream whose time
    /// is later by T. Where times are kept it is earlier, but not before 0: a particle that crosses before T is generated on its way.
    pub fn place(&mut self, name: &str, row: &mut CrossingRow) -> Result<f64> {
        let (plane, particle) = (self.zone.plane, &mut row.particle);
        let speed = particle.velocity.dot(&plane.normal);
        if !(speed > 0.0) {
            let (id, time, speed) = (particle.id, Shown(row.time), Shown(speed));
            let why = format!(
                "particle {id} passes at {time} s with {speed} m/s along the normal of the calculation plane"
            );
            let cure = "give --at a normal in the direction of flow, or rotate the record (--turn-deg)";
            return Err(SceneError::file(name, why, cure));
        }
        let passes = plane.project(&particle.position) - plane.normal * self.zone.lead(particle.radius);
        let pull = self.acceleration.dot(&plane.normal);
        let apex = if pull > 0.0 { speed / pull } else { f64::INFINITY };
        // From the generation plane, or from the apex where no path leads there.
        let square = speed * speed - 2.0 * pull * self.zone.length;
        let whole = if square >= 0.0 { 2.0 * self.zone.length / (speed + square.sqrt()) } else { apex };
        let (position, before, waits) = match self.intervals {
            Intervals::Generation => {
                let depth = self.zone.length.min(speed * whole - 0.5 * pull * whole * whole);
                // Over the whole length without rounding.
                let depth = if whole < apex { self.zone.length } else { depth };
                (passes - plane.normal * depth, whole, 0.0)
            }
            Intervals::Both => {
                let ahead = *self.ahead.get_or_insert(whole);
                let before = ahead.min(apex).min(if self.kept { row.time.max(0.0) } else { f64::INFINITY });
                let back = particle.velocity * before - self.acceleration * (0.5 * before * before);
                (passes - back, before, if self.kept { -before } else { ahead - before })
            }
        };
        particle.position = position;
        particle.velocity -= self.acceleration * before;
        if let Some((clump, _)) = &mut row.clump {
            *clump = clump.turned(&(particle.spin * -before));
        }
        row.turn = row.turn.map(|turn| dem::spun(&(particle.spin * -before)) * turn);
        Ok(waits)
    }
}
