//! What is known of the instant of a frame when its loads are read.

use crate::arrival::{self, Arrival};
use crate::dump::Ended;
use crate::places::number_of;
use dem::setup::{Particle, Setup};

/// What is known when the loads of a frame are read.
pub struct Now<'a> {
    /// The scene's setup.
    pub setup: &'a Setup,
    /// Grains that come in, by id.
    pub arrivals: &'a [Arrival],
    /// Step of the frame, and its time [s].
    pub step: u64,
    /// Time [s].
    pub time: f64,
    /// All particles by id.
    pub particles: &'a [Particle],
}

impl Now<'_> {
    /// Whether an atom is a grain that forces act on: those on their way in feel nothing, and walls do not move by them.
    pub fn is_free(&self, number: u64) -> bool {
        let grain = self.particles.binary_search_by_key(&number, |p| number_of(p.id)).is_ok();
        grain && arrival::is_free(self.arrivals, number, self.time)
    }
}

/// The particle of an atom.
pub fn particle<'a>(now: &Now<'a>, number: u64) -> Result<&'a Particle, Ended> {
    let found = now.particles.binary_search_by_key(&number, |p| number_of(p.id));
    let missing = || Ended::Wrong(format!("contacts: atom {number} is no particle of the scene"));
    found.map(|index| &now.particles[index]).map_err(|_| missing())
}
