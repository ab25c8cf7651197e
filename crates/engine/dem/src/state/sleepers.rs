//! Particles that sleep ([`crate::passes::sleep`] says when).

use crate::setup::Sleep;
use crate::state::particles::select;
use crate::state::row_order::RowOrder;
use laws::contact::wrenches::split_off;
use laws::simd::Row;
use serde::{Deserialize, Serialize};

/// Which particles sleep, and since when that is so.
#[derive(Clone, Copy)]
pub struct SleepMap<'a> {
    /// Whether each particle, and the two that fill up blocks, sleeps in this step.
    pub asleep: &'a [bool],
    /// Steps that were ended.
    pub turns: u64,
    /// For each tile, the last of them in which a particle fell asleep or woke.
    pub changed: &'a [u64],
}

/// Particles that sleep.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Sleepers {
    /// Steps that each particle has been at rest; those that sleep have reached `steps`.
    pub(crate) quiet: Vec<u32>,
    /// Whether each particle, and the two that fill up blocks, sleeps in this step.
    pub asleep: Vec<bool>,
    pub(crate) next: Vec<bool>,
    /// Force, moment on each when it fell asleep, and the kinetic energy that it lost [N, N·m, J].
    pub(crate) held: Vec<Row>,
    pub(crate) steps: u32,
    pub(crate) speed: f64,
    /// Acceleration that wakes [m/s²].
    pub(crate) wake: f64,
    /// Steps that were ended, and for each tile the last of them in which a particle fell asleep or woke.
    #[serde(skip)]
    pub(crate) turns: u64,
    #[serde(skip)]
    pub(crate) changed: Vec<u64>,
}

/// The same, for some particles.
pub struct SleeperSlices<'a> {
    pub(crate) quiet: &'a mut [u32],
    pub(crate) next: &'a mut [bool],
    pub(crate) held: &'a mut [Row],
    pub(crate) asleep: &'a [bool],
    /// Particles that must stay awake.
    pub(crate) prescribed: &'a [bool],
    pub(crate) steps: u32,
    pub(crate) speed: f64,
    pub(crate) wake: f64,
}

impl Sleepers {
    /// All awake.
    pub fn new(rule: Sleep, dt: f64, gravity: f64, particles: usize) -> Sleepers {
        let steps = (rule.time / dt).ceil().clamp(1.0, f64::from(u32::MAX)) as u32;
        let mut new = Sleepers {
            quiet: Vec::new(),
            asleep: vec![true; 2],
            next: Vec::new(),
            held: Vec::new(),
            steps,
            speed: rule.speed,
            wake: rule.wake * gravity,
            turns: 0,
            changed: Vec::new(),
        };
        (0..particles).for_each(|_| new.push());
        new
    }

    /// One more particle, awake.
    pub fn push(&mut self) {
        self.asleep.insert(self.quiet.len(), false);
        self.quiet.push(0);
        self.held.push(Row::default());
    }

    /// Takes the particles that stay, in their new order.
    pub fn reorder(&mut self, to: &RowOrder) {
        let Sleepers {
            quiet,
            held,
            asleep,
            // Filled in each step, or of no particle.
            next: _,
            steps: _,
            speed: _,
            wake: _,
            turns: _,
            changed: _,
        } = self;
        select(quiet, to.order, 0);
        select(held, to.order, 0);
        select(asleep, to.order, 2);
    }

    /// Number of sleepers.
    pub fn count(&self) -> usize {
        self.asleep.iter().filter(|&&a| a).count() - 2
    }

    /// Whether a particle sleeps.
    pub fn sleeps(&self, k: usize) -> bool {
        self.asleep[k]
    }

    /// Whether a particle has fallen asleep in the last step.
    pub fn fell_asleep(&self, k: usize) -> bool {
        self.quiet[k] == self.steps
    }

    /// Ends a step: which particles sleep from now on, and the energy [J] that those lost that fell asleep; particles of a `tile`.
    pub fn end_step(&mut self, tile: usize) -> f64 {
        self.turns += 1;
        self.changed.resize(self.next.len().div_ceil(tile), self.turns);
        let mut lost = 0.0;
        for (t, next) in self.next.chunks(tile).enumerate() {
            let here = t * tile..t * tile + next.len();
            if self.asleep[here.clone()] == *next {
                continue;
            }
            self.asleep[here.clone()].copy_from_slice(next);
            self.changed[t] = self.turns;
            let fell_asleep =
                self.quiet[here.clone()].iter().zip(&self.held[here]).filter(|(q, _)| **q == self.steps);
            lost += fell_asleep.map(|(_, held)| held[6]).sum::<f64>();
        }
        lost
    }

    /// What stands now, for [`RestingTile`].
    pub fn map(&self) -> SleepMap<'_> {
        SleepMap { asleep: &self.asleep, turns: self.turns, changed: &self.changed }
    }

    /// Columns of all particles, with `prescribed` (or none) to be kept awake.
    pub fn sleeper_slices<'a>(&'a mut self, prescribed: &'a [bool]) -> SleeperSlices<'a> {
        self.next.resize(self.quiet.len(), false);
        let Sleepers { quiet, next, held, asleep, steps, speed, wake, .. } = self;
        SleeperSlices { quiet, next, held, asleep, prescribed, steps: *steps, speed: *speed, wake: *wake }
    }

    /// Wakes a particle.
    pub fn wake_particle(&mut self, k: usize) {
        (self.quiet[k], self.asleep[k]) = (0, false);
        self.turns += 1;
        self.changed.fill(self.turns);
    }
}

impl<'a> SleeperSlices<'a> {
    /// Takes the first `n` off.
    pub fn split_off(&mut self, n: usize) -> SleeperSlices<'a> {
        SleeperSlices {
            quiet: split_off(&mut self.quiet, n),
            next: split_off(&mut self.next, n),
            held: split_off(&mut self.held, n),
            ..*self
        }
    }
}
