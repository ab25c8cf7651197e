//! Where servos have moved their walls, and how well they held what they follow.

use serde::{Deserialize, Serialize};

/// Deviation up to which a servo is at its target [–].
const REACHED: f64 = 0.01;
/// Steps for which it must stay there: then it has reached it.
const STAYS: u32 = 200;

/// Where a servo has moved its wall.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ServoState {
    /// How far the wall has been shifted since t = 0, along the servo's direction [m].
    pub shift: f64,
    /// Its rate [m/s].
    pub governor: Governor,
    /// Shift when neighbours were listed [m].
    pub listed: f64,
    /// How well it held its target.
    pub held: Held,
}

impl ServoState {
    /// Whether its numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.shift.is_finite() && self.governor.speed.is_finite() && self.governor.drift.is_finite()
    }
}

/// The rate of something that follows a force or a stress ([`crate::passes::servo`] says how).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Governor {
    /// The rate.
    pub speed: f64,
    /// The part of it that is the integral of the lack of force.
    pub drift: f64,
    /// Whether the force has nearly been reached since nothing was touched.
    pub landed: bool,
}

/// How well a servo held its target since it first reached it, and stayed there to a hundredth for some steps: sums over steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// When it first reached it [s].
    pub since: Option<f64>,
    /// Steps in a row at its target, before it has reached it.
    pub near: u32,
    /// Whether it has touched a particle.
    pub touched: bool,
    /// Force of the wall on the particles along its direction in the last step [N].
    pub push: f64,
    /// Steps since then.
    pub steps: u64,
    /// Steps among them at the speed limit.
    pub limited: u64,
    /// Sum of |P − F| [N].
    pub deviation: f64,
    /// Sum of F [N].
    pub target: f64,
    /// Largest |P − F|/F [–].
    pub worst: f64,
}

impl Held {
    /// Adds a step that presses with `push` [N] where `target` [N] is wanted, at `time` [s].
    pub fn add(&mut self, time: f64, push: f64, target: f64, limited: bool) {
        self.push = push;
        let off = (push - target).abs();
        if self.since.is_none() {
            self.near = if target > 0.0 && off <= REACHED * target { self.near + 1 } else { 0 };
            if self.near < STAYS {
                return;
            }
            self.since = Some(time);
        }
        self.steps += 1;
        self.limited += u64::from(limited);
        self.deviation += off;
        self.target += target;
        if target > 0.0 {
            self.worst = self.worst.max(off / target);
        }
    }

    /// Mean |P − F| over mean F [–]; `None` before the target was reached.
    pub fn mean(&self) -> Option<f64> {
        (self.target > 0.0).then(|| self.deviation / self.target)
    }
}
