//! Particles that have fallen past all walls: they meet nothing any more.

use dem::{Halt, Simulation};
use scene::Below;
use serde::Serialize;
use std::fmt::{Display, Formatter, Result};

/// How many of them there are at the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Fallen {
    /// Farther along gravity than any wall ever reaches.
    pub particles: usize,
    /// All that are in the calculation.
    pub of: usize,
}

impl Fallen {
    /// Counts them, if there are any.
    pub(crate) fn count(sim: &mut Simulation, below: &Below) -> std::result::Result<Option<Fallen>, Halt> {
        let all = sim.particles()?;
        let fell = all.iter().filter(|p| p.position.dot(&below.down) - p.radius > below.depth).count();
        Ok((fell > 0).then_some(Fallen { particles: fell, of: all.len() }))
    }
}

impl Display for Fallen {
    fn fmt(&self, f: &mut Formatter) -> Result {
        let Fallen { particles, of } = self;
        write!(
            f,
            "{particles} of {of} particles have fallen past all walls, and fall on: close the gap, or take them out with domain.outside = \"remove\""
        )
    }
}
