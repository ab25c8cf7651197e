//! Whether a saved state can be one of a setup: the lengths of its columns, and the indices in them.
//!
//! The hash of a checkpoint proves that nothing was damaged, not that a program wrote it. Everything behind this check indexes without asking again.

use crate::model::StateMismatch;
use crate::setup::{EntryClump, Particle, Sample, Setup};
use crate::state::{
    Bonds, CellState, ClumpMotion, Direction, FREE, Forces, Held, ListStatus, Particles, RigidClumps,
    ServoState, Sleepers, State, ZoneParticle, Zones,
};
use laws::space::sphere::away;

/// More than anything is counted up to: what is added to it stays a number.
const MANY: u64 = 1 << 31;
/// Beyond this no number of a state is meant, in SI units: what two of them make together (a spin and an arm, a momentum and an inertia) has squares
/// that are numbers.
const HUGE: f64 = 1e74;

/// Whether a part of a state is whole, or the error that names it.
fn whole(part: &'static str, is: bool) -> Result<(), StateMismatch> {
    if is { Ok(()) } else { Err(StateMismatch::Content(part)) }
}

/// Whether all indices are below `end`.
fn below<'a>(indices: impl IntoIterator<Item = &'a u32>, end: usize) -> bool {
    indices.into_iter().all(|&k| (k as usize) < end)
}

impl State {
    /// Refuses a state that no simulation of a setup can have, where `begun` is the one that it begins with.
    ///
    /// # Errors
    /// Which part has another length, an index beyond its column, or a number that is none.
    pub fn check(&self, begun: &State, setup: &Setup) -> Result<(), StateMismatch> {
        let n = self.particles.len();
        let State { particles, zones, clumps, bonds, sleepers, strained, servos, mounts, .. } = self;
        whole("particles", particles.is_valid(setup))?;
        whole("starting particles", below(&self.starting, n))?;
        whole("neighbour lists", self.listing_is_valid())?;
        whole("zones", zones.is_valid(&begun.zones, setup, n))?;
        whole("clumps", clumps.is_valid(setup, n) && clumps.leave_together(zones))?;
        whole("bonds", bonds.is_valid(setup, n))?;
        whole("sleeping particles", sleepers.as_ref().is_none_or(|s| s.is_valid(n)))?;
        let same_cell = |cell: &CellState| begun.strained.as_ref().is_some_and(|b| cell.is_valid(b));
        whole("strained domain", strained.as_ref().is_none_or(same_cell))?;
        let holds = |s: &ServoState| s.is_finite() && s.held.is_valid();
        whole("servos", servos.len() == begun.servos.len() && servos.iter().all(holds))?;
        whole("sums of walls", self.wall_sums.is_valid(&begun.wall_sums, self.steps))?;
        whole("walls on springs", mounts.len() == begun.mounts.len())
    }

    /// Whether lists can have been rebuilt as it is recorded.
    fn listing_is_valid(&self) -> bool {
        let listing = &self.listing;
        let listed = listing.rebuilds > 0;
        let begins = listing.status == ListStatus::Outdated && self.forces == Forces::Due;
        let counts = listing.rebuilds < 1 << 62 && self.steps < 1 << 62;
        counts
            && (listed || begins)
            && listing.step <= self.steps
            && listing.skin >= 0.0
            && is_meant(&listing.skin)
    }
}

impl Particles {
    fn is_valid(&self, setup: &Setup) -> bool {
        let Particles { rows, acceleration, spins, angular_acceleration, id, material, home } = self;
        let n = id.len();
        let rotates = if self.rotates() { [n + 2, n] } else { [0, 0] };
        let lengths = [rows.len(), acceleration.len(), material.len(), home.len()] == [n + 2, n, n, n]
            && [spins.len(), angular_acceleration.len()] == rotates;
        let mut ids = id.clone();
        ids.sort_unstable();
        lengths
            && material.iter().all(|&m| (m as usize) < setup.materials.len())
            && ids.windows(2).all(|two| two[0] != two[1])
            && rows[..n]
                .iter()
                .all(|row| row.radius() > 0.0 && row.inverse_mass() > 0.0 && row[3..].iter().all(is_meant))
            && home.iter().all(|home| home[3] >= 0.0 && is_meant(&home[3]))
            && (0..n).all(|k| is_somewhere(k, &rows[k][..3]) && is_somewhere(k, &home[k][..3]))
    }
}

/// Whether a rigid clump that comes in or goes out has a shape.
fn has_shape(clump: &Option<EntryClump>, setup: &Setup) -> bool {
    clump.is_none_or(|clump| (clump.shape as usize) < setup.clumps.shapes.len())
}

/// Whether a number of a state can be meant.
fn is_meant(x: &f64) -> bool {
    x.abs() < HUGE
}

/// Whether the place of particle `k` can be meant: that where what has left waits for the next listing is far beyond.
fn is_somewhere(k: usize, place: &[f64]) -> bool {
    place.iter().all(is_meant) || place == away(k)
}

/// Whether all numbers of a particle can be meant.
fn has_meaning(p: &Particle) -> bool {
    p.radius > 0.0 && p.position.iter().chain(&p.velocity).chain(&p.spin).chain([&p.radius]).all(is_meant)
}

/// Whether a particle in a zone can be moved: to a search, a position that is not a number is nowhere.
fn moves_finitely(t: &ZoneParticle) -> bool {
    let turns = t.turn.is_none_or(|turn| turn.iter().all(is_meant))
        && t.turned.is_none_or(|turned| turned.coords.iter().all(is_meant));
    let numbers = t.centre.iter().chain([&t.since, &t.lead]);
    turns && has_meaning(&t.start) && numbers.into_iter().all(is_meant)
}

/// Whether a sample of a path is made of numbers.
fn is_sample(sample: &Sample) -> bool {
    let vectors = [&sample.position, &sample.velocity, &sample.spin];
    is_meant(&sample.time) && vectors.into_iter().flatten().all(is_meant)
}

impl Zones {
    fn is_valid(&self, begun: &Zones, setup: &Setup, n: usize) -> bool {
        let (outlets, inlets) = (begun.outlets.len(), begun.inlets.len());
        let flags = if begun.none() { 0 } else { n };
        let material = |m: u16| (m as usize) < setup.materials.len();
        let of_outlets = [&self.beyond, &self.crossed, &self.sampled].map(Vec::len);
        let lengths =
            [self.outlets.len(), self.inlets.len()] == [outlets, inlets] && of_outlets == [outlets; 3];
        let travels = |direction: &Direction| match *direction {
            Direction::Out(outlet) => (outlet as usize) < outlets,
            Direction::In(inlet) => (inlet as usize) < inlets,
        };
        let entries = || self.pending.iter().chain(&self.waiting).chain(&self.announced);
        lengths
            && [self.gone.len(), self.prescribed.len()] == [flags; 2]
            && self.flags_are_valid()
            && self.zone_particles.iter().all(|t| travels(&t.direction) && material(t.start.material))
            && self.zone_particles.iter().all(moves_finitely)
            && entries().all(|e| e.time.is_finite() && has_meaning(&e.particle))
            && self.paths.values().all(|path| path.samples.iter().all(is_sample))
            && below(entries().map(|e| &e.inlet), inlets)
            && entries().all(|e| material(e.particle.material) && has_shape(&e.clump, setup))
            && self.look_again < 1 << 62
            && below(self.crossings.iter().map(|c| &c.outlet), outlets)
            && self.crossings.iter().all(|c| material(c.particle.material) && has_shape(&c.clump, setup))
            && self.counts_are_valid(begun, n)
    }

    /// Whether the particles in zones and those that have left are those of the flags, each once.
    fn flags_are_valid(&self) -> bool {
        let are = |rows: Vec<u32>, flags: &[bool]| {
            let mut rows = rows;
            rows.sort_unstable();
            (0..).zip(flags).filter(|(_, flag)| **flag).map(|(k, _): (u32, _)| k).eq(rows)
        };
        are(self.zone_particles.iter().map(|t| t.at).collect(), &self.prescribed)
            && are(self.left.iter().map(|(k, _)| *k).collect(), &self.gone)
            && self.gone.iter().zip(&self.prescribed).all(|(gone, prescribed)| !(*gone && *prescribed))
    }

    /// Whether particles that went back are counted for the planes that there are.
    fn counts_are_valid(&self, begun: &Zones, n: usize) -> bool {
        let (now, then) = (&self.lost.returned, &begun.lost.returned);
        let watched = then.inlets.len();
        let few = |counts: &[u64]| counts.iter().all(|&count| count < MANY);
        let origins = if watched > 0 { n } else { self.lost.origins.len() };
        [now.inlets.len(), now.removed.len()] == [watched; 2]
            && [now.outlets.len(), now.fallen.len(), now.held_back.len()]
                == [then.outlets.len(), then.fallen.len(), then.held_back.len()]
            && now.inserts.len() == then.inserts.len()
            && now.regions.len() == then.regions.len()
            && now.regions.iter().all(|r| r.count < MANY && is_meant(&r.mass))
            && now.inserts.iter().all(|i| few(&[i.waited, i.waiting, i.skipped]))
            && [&now.inlets, &now.removed, &now.outlets, &now.fallen].iter().all(|counts| few(counts))
            && self.lost.origins.len() == origins
            && self.lost.origins.iter().all(|origin| origin.inlet as usize <= watched)
    }
}

impl RigidClumps {
    fn is_valid(&self, setup: &Setup, n: usize) -> bool {
        let RigidClumps { flights, members, of, arms, images } = self;
        if flights.is_empty() {
            return members.is_empty() && of.iter().all(|&clump| clump == FREE);
        }
        let covered = of.len();
        let mut first = 0;
        let in_order = flights.iter().zip(0..).all(|(clump, number)| {
            let shape = setup.clumps.shapes.get(clump.shape as usize);
            let range = first..first + clump.count as usize;
            let begins =
                clump.first as usize == first && shape.is_some_and(|s| s.spheres.len() == range.len());
            first = range.end;
            let own = |m: &u32| of.get(*m as usize) == Some(&number);
            let numbers = [
                &clump.position,
                &clump.velocity,
                &clump.acceleration,
                &clump.momentum,
                &clump.torque,
                &clump.spin,
                &clump.place_before,
            ];
            let meant =
                numbers.into_iter().flatten().chain(&clump.turn).chain(&clump.turn_before).all(is_meant);
            let weighs = [clump.mass, clump.scale]
                .iter()
                .chain(&clump.inverse_inertia)
                .all(|x| *x > 0.0 && is_meant(x));
            begins && meant && weighs && members.get(range).is_some_and(|members| members.iter().all(own))
        });
        let joined = of.iter().filter(|&&clump| clump != FREE).count();
        [arms.len(), images.len()] == [covered; 2]
            && covered <= n
            && in_order
            && [first, joined] == [members.len(); 2]
    }
}

impl RigidClumps {
    /// Whether all members of a clump have left where one has.
    fn leave_together(&self, zones: &Zones) -> bool {
        let members = |clump: &ClumpMotion| self.members[clump.range()].iter();
        let gone = |k: &u32| zones.is_gone(*k as usize);
        self.flights.iter().all(|clump| members(clump).all(gone) || !members(clump).any(gone))
    }
}

impl Bonds {
    fn is_valid(&self, setup: &Setup, n: usize) -> bool {
        let Bonds { on, pairs, springs, pulls, turns, due, left, .. } = self;
        let turned = if *on { n } else { 0 };
        let two = |ends: &[u32; 2]| ends[0] != ends[1] && below(ends, turned);
        [springs.len(), pulls.len(), turns.len()] == [pairs.len(), pairs.len(), turned]
            && pairs.iter().all(|pair| two(&pair.ends))
            && below(due, setup.bonds.len())
            && left[1] <= left[0]
            && left[0] <= u32::MAX as usize
    }
}

impl Sleepers {
    fn is_valid(&self, n: usize) -> bool {
        // Two rows behind the last stand for walls and for nothing: they are always at rest.
        let few = |count: &u32| u64::from(*count) < MANY;
        self.quiet.iter().all(few)
            && [self.quiet.len(), self.held.len(), self.asleep.len()] == [n, n, n + 2]
            && self.asleep[n..] == [true, true]
    }
}

impl Held {
    fn is_valid(&self) -> bool {
        u64::from(self.near) < MANY && self.steps < 1 << 62 && self.limited <= self.steps
    }
}

impl CellState {
    fn is_valid(&self, begun: &CellState) -> bool {
        let periodic = |cell: &CellState| cell.lengths.map(|l| [0, 1, 2].map(|a| l[a] > 0.0));
        let follows = |cell: &CellState| cell.followers.map(|f| f.is_some());
        let held = self.followers.iter().flatten().all(|follower| follower.held.is_valid());
        held && self.is_finite() && periodic(self) == periodic(begun) && follows(self) == follows(begun)
    }
}
