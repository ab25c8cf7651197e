//! Zones: particles that move by a prescribed motion, feel nothing, and act on others.
//!
//! Outlet: past the storage plane a particle's state is recorded and it goes on by the zone's motion to the exclusion
//! plane. Inlet: a particle appears on the generation plane at its recorded time and goes on by the zone's motion to
//! the calculation plane, where it becomes free. JP5440448B2.
//!
//! A traveller's row is overwritten after each move, so that the move itself knows nothing of zones.

use crate::setup::{ContactHistory, Crossing, Entry, Setup, Zone};
use crate::simd::Row4;
use crate::state::particles::Particles;
use crate::state::zone_particle::{Direction, ZoneParticle};
use crate::state::{path, returned as lost};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Steps ahead of their time at which entries are listed, so that not each of them forces a rebuild.
pub const LOOK_AHEAD: u64 = 256;

/// All zones of a simulation and the particles in them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Zones {
    pub(crate) outlets: Vec<Zone>,
    pub(crate) inlets: Vec<Zone>,
    pub(crate) zone_particles: Vec<ZoneParticle>,
    /// For each outlet, free particles past its plane that never crossed it.
    pub(crate) beyond: Vec<BTreeSet<u32>>,
    pub(crate) pending: VecDeque<Entry>,
    pub(crate) crossings: Vec<Crossing>,
    /// For each outlet, particles that may be past its plane, or come back through it, until the next rebuild.
    #[serde(skip)]
    pub(crate) near: Vec<Vec<u32>>,
    /// Whether a particle is out of the calculation and waits for the next listing.
    pub(crate) gone: Vec<bool>,
    /// Those, and where they were when neighbours were listed.
    pub(crate) left: Vec<(u32, Row4)>,
    /// Whether a particle travels.
    pub(crate) busy: Vec<bool>,
    pub(crate) ids: BTreeSet<u32>,
    /// Recorded paths of those on their way in, by id.
    pub(crate) paths: BTreeMap<u32, path::Path>,
    /// What contacts are to remember once the first of two is free, by its id and that of the other.
    pub(crate) memories: BTreeMap<(u32, u32), ContactHistory>,
    /// For each outlet, those whose paths were sampled last.
    pub(crate) sampled: Vec<BTreeSet<u32>>,
    pub(crate) latest: f64,
    /// Where free particles came from, and which went back.
    pub(crate) lost: lost::ReturnCounts,
}

impl Zones {
    /// Zones of a setup.
    pub fn new(setup: &Setup, particles: &Particles) -> Zones {
        let past = |zone: &Zone| {
            let there = setup.particles.iter().filter(|p| zone.past(&p.position, p.radius) >= 0.0);
            let bodies = setup.clumps.bodies.iter().filter(|b| zone.past(&b.position, 0.0) >= 0.0);
            there.map(|p| p.id).chain(bodies.map(|b| b.id)).collect()
        };
        let ids =
            if setup.inlets.is_empty() { BTreeSet::new() } else { particles.id.iter().copied().collect() };
        let zones = !setup.outlets.is_empty() || !setup.inlets.is_empty();
        let flags = if zones { vec![false; particles.len()] } else { Vec::new() };
        Zones {
            outlets: setup.outlets.clone(),
            inlets: setup.inlets.clone(),
            beyond: setup.outlets.iter().map(past).collect(),
            gone: flags.clone(),
            sampled: vec![BTreeSet::new(); setup.outlets.len()],
            busy: flags,
            ids,
            latest: f64::NEG_INFINITY,
            lost: lost::ReturnCounts::new(setup, particles.len()),
            ..Zones::default()
        }
    }

    /// Whether the scene has no zone at all.
    pub fn none(&self) -> bool {
        self.outlets.is_empty() && self.inlets.is_empty()
    }

    /// Whether a particle is listed and not in the calculation: past an exclusion plane, or its time to come in is yet to come.
    pub fn hidden(&self, time: f64) -> impl Fn(usize) -> bool + '_ {
        let early: BTreeSet<u32> =
            self.zone_particles.iter().filter(|t| t.since > time).map(|t| t.at).collect();
        move |k| self.is_gone(k) || early.contains(&(k as u32))
    }

    /// Whether particle `k` has passed an exclusion plane.
    pub fn is_gone(&self, k: usize) -> bool {
        self.gone.get(k) == Some(&true)
    }

    /// Whether particle `k` is in a zone.
    pub fn travels(&self, k: usize) -> bool {
        self.busy.get(k) == Some(&true)
    }

    /// Whether a contact of a particle, with another or with a wall (`None`), acts on no particle: those in zones act on others and nothing acts on them. One that
    /// has just left at the end of a zone travelled when loads were computed.
    pub fn idles(&self, (i, other): (u32, Option<u32>)) -> bool {
        let passive = |k: u32| self.travels(k as usize) || self.is_gone(k as usize);
        passive(i) && other.is_none_or(passive)
    }

    /// The inlet that particle `k` comes in by, while it is on its way.
    pub fn entering_by(&self, k: usize) -> Option<u32> {
        let found = self.zone_particles.iter().find(|t| self.travels(k) && t.at as usize == k)?;
        if let Direction::In(inlet) = found.way { Some(inlet) } else { None }
    }

    /// Whether each particle is in a zone; empty without zones.
    pub fn busy(&self) -> &[bool] {
        &self.busy
    }

    /// Crossings since the last call.
    pub fn take_crossings(&mut self) -> Vec<Crossing> {
        std::mem::take(&mut self.crossings)
    }

    /// Whether a particle is to come in, or is on its way in.
    pub(crate) fn is_entering(&self, id: u32, setup: &Setup) -> bool {
        let members = |e: &Entry| e.clump.map_or(1, |c| crate::setup::clumps::members(&c, setup));
        self.pending.iter().any(|e| id.wrapping_sub(e.particle.id) < members(e))
            || self.zone_particles.iter().any(|t| t.start.id == id && matches!(t.way, Direction::In(_)))
    }

    /// Whether one is to come in later.
    pub(crate) fn waits(&self, id: u32) -> bool {
        self.pending.iter().any(|e| e.particle.id == id)
    }

    /// Histories that contacts of a particle are to take, by their other particle; removed here.
    pub(crate) fn told(&mut self, id: u32) -> Vec<(u32, ContactHistory)> {
        let told: Vec<_> = self.memories.range((id, 0)..=(id, u32::MAX)).map(|(k, s)| (k.1, *s)).collect();
        for (partner, _) in &told {
            self.memories.remove(&(id, *partner));
        }
        told
    }

    /// Follows the particles to their new places; `order` names the old ones of those that stay.
    pub fn reorder(&mut self, order: &[u32]) {
        if self.none() {
            return;
        }
        let mut new = vec![u32::MAX; self.busy.len()];
        for (n, &o) in order.iter().enumerate() {
            new[o as usize] = n as u32;
        }
        for t in &mut self.zone_particles {
            t.at = new[t.at as usize];
        }
        self.busy = order.iter().map(|&o| self.busy[o as usize]).collect();
        self.gone = vec![false; order.len()];
        self.left.clear();
        self.lost.reorder(order);
    }
}
