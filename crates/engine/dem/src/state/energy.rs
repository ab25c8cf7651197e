//! The energy ledger: each term by its own formula.

use serde::{Deserialize, Serialize};

/// Energy of one instant, of the particles that are free, and what has come and gone since the start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Energy {
    /// ½ m v².
    pub translation: f64,
    /// ½ I ω².
    pub rotation: f64,
    /// −m g·x, from the origin.
    pub potential: f64,
    /// In the springs of contacts and bonds; negative where cohesion binds.
    pub elastic: f64,
    /// Dissipated by the normal law: its dashpot, and what it takes to part grains that adhere.
    pub normal: f64,
    /// Dissipated by sliding friction, dashpot included.
    pub sliding: f64,
    /// Dissipated by rolling resistance, dashpot included.
    pub rolling: f64,
    /// Dissipated by twisting resistance, dashpot included.
    pub twisting: f64,
    /// Dissipated by dashpots of bonds, and with bonds that broke.
    pub bonds: f64,
    /// Work of moving walls on particles.
    pub walls: f64,
    /// Kinetic energy of particles that fell asleep.
    pub slept: f64,
    /// Taken by the fluid.
    pub drag: f64,
    /// Taken by local damping.
    pub local_damping: f64,
    /// ½ M s'² of walls on springs.
    pub mount_kinetic: f64,
    /// ½ k s² of their springs.
    pub mount_elastic: f64,
    /// Dissipated by their dashpots.
    pub mount_damping: f64,
    /// Brought by particles that became free at a calculation plane, and work of those before it.
    pub entered: f64,
    /// Taken along by particles that passed a storage plane, and work on those behind it.
    pub left: f64,
    /// Made (or taken, negative) by the finite time step: what contacts and fluid did to particles beyond what springs,
    /// dissipators and walls account for. It falls with Δt as the integrator's error does.
    pub integration: f64,
    /// Half of what dissipators and fluid take and walls bring in the step that begins now: the other terms end with the last one.
    pub half_step: f64,
}

impl Energy {
    /// Everything that was there at the start: constant to rounding.
    pub fn balance(&self) -> f64 {
        self.translation
            + self.rotation
            + self.potential
            + self.elastic
            + self.normal
            + self.sliding
            + self.rolling
            + self.twisting
            + self.bonds
            + self.slept
            + self.drag
            + self.local_damping
            + self.mount_kinetic
            + self.mount_elastic
            + self.mount_damping
            + self.left
            + self.half_step
            - self.walls
            - self.entered
            - self.integration
    }

    /// [`Energy::integration`] over what was exchanged, or over the most that moved or was in springs so far (`peak` [J], or now) where that
    /// is more [–]; `None` where both are no more than `rest` [J]. And whether the first was taken.
    pub fn error(&self, peak: f64, rest: f64) -> Option<(f64, bool)> {
        let (exchanged, held) = (self.exchanged(), peak.max(self.held()));
        let of = exchanged.max(held);
        (of > rest && self.integration.is_finite()).then(|| (self.integration / of, exchanged >= held))
    }

    /// What moves and is in springs.
    pub fn held(&self) -> f64 {
        self.translation + self.rotation + self.elastic.abs() + self.mount_kinetic + self.mount_elastic
    }

    /// What has changed its form since the start, to compare [`Energy::integration`] with.
    pub fn exchanged(&self) -> f64 {
        let dissipated = self.normal + self.sliding + self.rolling + self.twisting + self.bonds;
        dissipated + self.slept + self.drag.abs() + self.local_damping + self.mount_damping + self.walls.abs()
    }
}
