//! Grains that come in during the run: all of them are atoms from the start, on their way.
//!
//! ```text
//! x(0) = x_e − v t_e        t_e: when a grain enters the zone at x_e; it keeps v until it is free at t_f, behind the zone
//! ```
//!
//! So each is where it must be at every time from t_e on, and no atom is made during the run. Until t_f it moves at v, takes part in no
//! contact, and before t_e it is in no frame.

use crate::error::Result;
use dem::setup::{Entry, Particle, Setup};
use scene::plan::Insertion;

/// A grain that comes in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrival {
    /// Its id.
    pub id: u32,
    /// When it enters the zone [s].
    pub enters: f64,
    /// When it moves freely [s].
    pub free: f64,
}

/// Adds all grains that insertions bring until `end` [s] to a setup, where they are at t = 0; in the order of their ids.
///
/// # Errors
/// An insertion without space.
pub fn add(setup: &mut Setup, insertions: &[Insertion], end: f64) -> Result<Vec<Arrival>> {
    let mut all = Vec::new();
    for insertion in insertions {
        let mut insertion = insertion.clone();
        while insertion.next_time().is_some_and(|time| time <= end) {
            let Some(Entry { time, inlet, particle, .. }) = insertion.next_entry()? else { break };
            let plane = &setup.inlets[inlet as usize].plane;
            let left = (plane.point - particle.position).dot(&plane.normal);
            let speed = particle.velocity.dot(&plane.normal);
            all.push(Arrival { id: particle.id, enters: time, free: time + left / speed });
            let position = particle.position - particle.velocity * time;
            setup.particles.push(Particle { position, ..particle });
        }
    }
    all.sort_by_key(|arrival| arrival.id);
    Ok(all)
}
