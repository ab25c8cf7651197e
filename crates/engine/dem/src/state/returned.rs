//! Particles that go back through a plane, against the flow: what is there is not simulated by this stage.

use crate::setup::{Removed, Setup};
use crate::state::particles::select;
use crate::state::row_order::RowOrder;
use serde::{Deserialize, Serialize};

/// Where a free particle came from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Origin {
    /// Its inlet + 1; 0 when it came by none that is watched.
    pub(crate) inlet: u32,
    /// Whether it has been behind the calculation plane.
    pub(crate) behind: bool,
}

/// How much the particles in the zone of an outlet hold back those that follow, which an undivided stream does not.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct HeldBack {
    /// Of free particles on those in the zone, along the flow [N s].
    pub impulse: f64,
    /// Of those that passed the storage plane, along the flow [N s].
    pub momentum: f64,
    /// How many passed.
    pub passed: u64,
}

/// What an insertion found no room for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct NoRoom {
    /// How many came in later than they were due, or still wait.
    pub waited: u64,
    /// How many of these wait now.
    pub waiting: u64,
    /// How many did not come in at all.
    pub skipped: u64,
}

/// How many particles went back, found no room or were taken out, and what cuts do to the stream.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Returned {
    /// For each watched inlet: particles that were behind its calculation plane again.
    pub inlets: Vec<u64>,
    /// For each watched inlet: particles that were taken out because they had gone back through the whole zone, or were in the way.
    pub removed: Vec<u64>,
    /// For each outlet: free particles that came upstream through its storage plane.
    pub outlets: Vec<u64>,
    /// For each outlet: particles that were recorded, and fell back through the plane in the zone.
    pub fallen: Vec<u64>,
    /// For each outlet: how much it holds back.
    pub held_back: Vec<HeldBack>,
    /// For each insertion, in the order of the scene: what it found no room for; a clump counts as one.
    pub inserts: Vec<NoRoom>,
    /// For each region of [`Setup::removals`]: what it has taken out.
    pub regions: Vec<Removed>,
}

impl Returned {
    /// What an insertion found no room for, by its number among all inlets: those that are watched come first.
    pub(crate) fn no_room(&mut self, inlet: u32) -> &mut NoRoom {
        &mut self.inserts[inlet as usize - self.inlets.len()]
    }
}

/// Where particles came from.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct ReturnCounts {
    /// Of each particle; empty where no inlet is watched.
    pub(crate) origins: Vec<Origin>,
    /// Whether any is.
    pub(crate) any: bool,
    pub(crate) returned: Returned,
}

impl ReturnCounts {
    pub fn new(setup: &Setup, particles: usize) -> ReturnCounts {
        let watched = (setup.guards.cuts as usize).min(setup.inlets.len());
        let none = |count: usize| vec![0; count];
        let outlets = setup.outlets.len();
        let returned = Returned {
            inlets: none(watched),
            removed: none(watched),
            outlets: none(outlets),
            fallen: none(outlets),
            held_back: vec![HeldBack::default(); outlets],
            inserts: vec![NoRoom::default(); setup.inlets.len() - watched],
            regions: vec![Removed::default(); setup.removals.len()],
        };
        let origins = if watched > 0 { vec![Origin::default(); particles] } else { Vec::new() };
        ReturnCounts { origins, any: false, returned }
    }

    /// A particle is added at the end.
    pub fn push(&mut self) {
        if !self.returned.inlets.is_empty() {
            self.origins.push(Origin::default());
        }
    }

    /// Takes the particles that stay, in their new order.
    pub fn reorder(&mut self, to: &RowOrder) {
        let ReturnCounts { origins, any: _, returned } = self;
        if !returned.inlets.is_empty() {
            select(origins, to.order, 0);
        }
    }

    /// Particle `k` is free behind an inlet.
    pub fn freed(&mut self, k: usize, inlet: u32) {
        if (inlet as usize) < self.returned.inlets.len() {
            self.origins[k] = Origin { inlet: inlet + 1, behind: false };
            self.any = true;
        }
    }
}
