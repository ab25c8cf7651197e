//! Zones: particles that move by a prescribed motion, feel nothing, and act on others.
//!
//! Outlet: past the storage plane a particle's state is recorded and it goes on by the zone's motion to the exclusion
//! plane; where paths are recorded it goes on as the free particle that it is. Inlet: a particle appears on the generation plane at its recorded time and goes on by the zone's motion to
//! the calculation plane, where it becomes free. JP5440448B2.
//!
//! A zone particle's row is overwritten after each move, so that the move itself needs no zones.

mod flow;
mod guide;
mod watch;

use crate::setup::{ContactHistory, Crossing, Entry, Setup, Zone};
use crate::state::particles::select;
use crate::state::row_order::RowOrder;
use crate::state::{Direction, Particles, Path, ReturnCounts, ZoneParticle};
use laws::simd::Row4;
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
    /// For each outlet, free particles that have crossed it and go on to its exclusion plane; only where paths are recorded.
    pub(crate) crossed: Vec<BTreeSet<u32>>,
    pub(crate) pending: VecDeque<Entry>,
    /// Entries that are past their time, because their places were taken.
    pub(crate) waiting: VecDeque<Entry>,
    /// Entries that are listed already and come in later, of insertions; some that have come in since.
    pub(crate) announced: Vec<Entry>,
    /// Step in which the places of those that wait are looked at next.
    pub(crate) look_again: u64,
    pub(crate) crossings: Vec<Crossing>,
    /// For each outlet, particles that may be past its plane, or come back through it, until the next rebuild.
    #[serde(skip)]
    pub(crate) near: Vec<Vec<u32>>,
    /// Whether a particle is out of the calculation and waits for the next listing.
    pub(crate) gone: Vec<bool>,
    /// Those, and where they were when neighbours were listed.
    pub(crate) left: Vec<(u32, Row4)>,
    /// Whether each particle is in a zone; empty without zones.
    pub(crate) prescribed: Vec<bool>,
    pub(crate) ids: BTreeSet<u32>,
    /// Recorded paths of those on their way in, by id.
    pub(crate) paths: BTreeMap<u32, Path>,
    /// Histories that contacts take once the first particle is free, by its id and that of the other.
    pub(crate) histories: BTreeMap<(u32, u32), ContactHistory>,
    /// For each outlet, those whose paths were sampled last.
    pub(crate) sampled: Vec<BTreeSet<u32>>,
    pub(crate) latest: f64,
    /// Where free particles came from, and which went back.
    pub(crate) lost: ReturnCounts,
}

impl Zones {
    /// Zones of a setup.
    pub fn new(setup: &Setup, particles: &Particles) -> Zones {
        let past = |zone: &Zone| {
            let there = setup.particles.iter().filter(|p| zone.past(&p.position, p.radius) >= 0.0);
            let clumps = setup.clumps.placed.iter().filter(|b| zone.past(&b.position, 0.0) >= 0.0);
            there.map(|p| p.id).chain(clumps.map(|b| b.id)).collect()
        };
        let ids =
            if setup.inlets.is_empty() { BTreeSet::new() } else { particles.id.iter().copied().collect() };
        let zones = !(setup.outlets.is_empty() && setup.inlets.is_empty() && setup.removals.is_empty());
        let flags = if zones { vec![false; particles.len()] } else { Vec::new() };
        Zones {
            outlets: setup.outlets.clone(),
            inlets: setup.inlets.clone(),
            beyond: setup.outlets.iter().map(past).collect(),
            crossed: vec![BTreeSet::new(); setup.outlets.len()],
            gone: flags.clone(),
            sampled: vec![BTreeSet::new(); setup.outlets.len()],
            prescribed: flags,
            ids,
            latest: f64::NEG_INFINITY,
            lost: ReturnCounts::new(setup, particles.len()),
            ..Zones::default()
        }
    }

    /// Takes back an entry that was listed, and has met something before it came in: whether there is room is decided when it is due.
    pub(crate) fn put_back(&mut self, id: u32) {
        let Some(at) = self.announced.iter().position(|e| e.particle.id == id) else { return };
        let e = self.announced.remove(at);
        let before = self.pending.partition_point(|other| other.time <= e.time);
        self.pending.insert(before, e);
    }

    /// Whether the scene has no zone at all, and no region that takes particles out.
    pub fn none(&self) -> bool {
        self.outlets.is_empty() && self.inlets.is_empty() && self.lost.returned.regions.is_empty()
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

    /// Whether particle `k` is neither in a zone nor out of the calculation.
    pub fn is_free(&self, k: usize) -> bool {
        !self.is_prescribed(k) && !self.is_gone(k)
    }

    /// Whether a free particle has crossed an outlet, and goes on to its exclusion plane.
    pub(crate) fn has_crossed(&self, id: u32) -> bool {
        self.crossed.iter().any(|crossed| crossed.contains(&id))
    }

    /// Whether particle `k` is in a zone.
    pub fn is_prescribed(&self, k: usize) -> bool {
        self.prescribed.get(k) == Some(&true)
    }

    /// Whether a contact of a particle, with another or with a wall (`None`), acts on no particle: those in zones act on others and nothing acts on them. One that
    /// has just left at the end of a zone was in the zone when forces were computed.
    pub fn is_idle(&self, (i, other): (u32, Option<u32>)) -> bool {
        let passive = |k: u32| !self.is_free(k as usize);
        passive(i) && other.is_none_or(passive)
    }

    /// The inlet that particle `k` comes in by, while it is on its way.
    pub fn entering_by(&self, k: usize) -> Option<u32> {
        let found = self.zone_particles.iter().find(|t| self.is_prescribed(k) && t.at as usize == k)?;
        if let Direction::In(inlet) = found.direction { Some(inlet) } else { None }
    }

    /// Whether a particle is to come in, or is on its way in.
    pub(crate) fn is_entering(&self, id: u32, setup: &Setup) -> bool {
        let members = |e: &Entry| e.clump.map_or(1, |c| crate::setup::clumps::members(&c, setup));
        self.pending.iter().chain(&self.waiting).any(|e| id.wrapping_sub(e.particle.id) < members(e))
            || self.zone_particles.iter().any(|t| t.start.id == id && matches!(t.direction, Direction::In(_)))
    }

    /// Histories that contacts of a particle are to take, by their other particle; removed here.
    pub(crate) fn take_histories(&mut self, id: u32) -> Vec<(u32, ContactHistory)> {
        let told: Vec<_> = self.histories.range((id, 0)..=(id, u32::MAX)).map(|(k, s)| (k.1, *s)).collect();
        for (partner, _) in &told {
            self.histories.remove(&(id, *partner));
        }
        told
    }

    /// Follows the particles into their new order.
    pub fn reorder(&mut self, to: &RowOrder) {
        if self.none() {
            return;
        }
        let Zones {
            zone_particles,
            prescribed,
            gone,
            left,
            lost,
            // Found again when neighbours are listed.
            near: _,
            // Of no particle, or by its id.
            outlets: _,
            inlets: _,
            beyond: _,
            crossed: _,
            pending: _,
            waiting: _,
            announced: _,
            look_again: _,
            crossings: _,
            ids: _,
            paths: _,
            histories: _,
            sampled: _,
            latest: _,
        } = self;
        // A row that is gone has none; only a checkpoint that was changed has both.
        zone_particles.retain(|t| to.new[t.at as usize] != RowOrder::LEFT);
        zone_particles.iter_mut().for_each(|t| t.at = to.new[t.at as usize]);
        select(prescribed, to.order, 0);
        *gone = vec![false; to.order.len()];
        left.clear();
        lost.reorder(to);
    }
}
