//! Bonds between the centres of particles, until they break.
//!
//! A pass of its own over a list of its own ([`crate::passes::bonds`]): what bonds do is added to the sums of contacts, particle by particle in the order of the
//! bonds, so that it depends on no thread. Bonds are computed in double precision always. [`crate::model::bonds::springs`] has the law. It needs to know how each
//! end has turned:
//!
//! ```text
//! q ← exp(ω_{n−½} Δt) q,   ω_{n−½} = w*_n − α_{n−1} Δt/2          what [`laws::contact::motion`] has turned it by
//! ```
//!
//! Places and turns of one instant in the springs, velocities predicted for it in the dashpots: with springs alone that is velocity Verlet, which makes no energy
//! on the whole. A bond breaks by the stress of an instant, before it acts in it:
//!
//! ```text
//! σ = F_n/A + β |M| r/I > σ_c   or   τ = |F_t|/A + β |M_t| r/J > τ_c − F_n/A tan φ          F_n: tension; A = π r², I = π r⁴/4, J = 2 I
//! ```
//!
//! Potyondy & Cundall (2004), Int. J. Rock Mech. Min. Sci. 41, doi:10.1016/j.ijrmms.2004.09.011, have the strengths and springs by increments; turns of
//! both ends instead, so that nothing is lost by rounding or order: Wang (2009), Acta Geotech. 4, doi:10.1007/s11440-008-0072-1. Beam in a frame that turns along:
//! Crisfield (1990), Comput. Methods Appl. Mech. Eng. 81, doi:10.1016/0045-7825(90)90106-V.

use crate::model::bonds::find;
use crate::model::bonds::springs::{packed, replaces_contact};
use crate::model::{BondedPair, BreakMode, NewBond, Pull, SetupError, Springs};
use crate::setup::{CrossingBond, Setup};
use crate::space::rotation::spun;
use crate::state::Particles;
use crate::state::particles::select;
use crate::state::row_order::RowOrder;
use crate::threads::{FEW, share};
use geom::Vec3;
use laws::contact::Sums;
use laws::simd::Row4;
use nalgebra::{Quaternion, UnitQuaternion};
use serde::{Deserialize, Serialize};

/// Bonds, or particles, of one task.
pub const CHUNK: usize = 256;

/// A bond at one instant, for observers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondState {
    /// Ids of both particles, the lower first.
    pub ids: [u32; 2],
    /// Half-way between both centres [m].
    pub middle: Vec3,
    /// Length L at rest, and radius r of the beam [m].
    pub size: [f64; 2],
    /// When it broke [s]; `None` while it is whole.
    pub broken: Option<f64>,
    /// What broke it, if it did.
    pub mode: BreakMode,
    /// Force on the first [N], and moments on both about their centres [N·m].
    pub force: Vec3,
    /// See there.
    pub moments: [Vec3; 2],
    /// Largest tension σ and shear τ [Pa]; of a broken one, those that broke it.
    pub stress: [f64; 2],
    /// σ_c, and τ_c at the present pressure [Pa].
    pub strength: [f64; 2],
}

/// A bond that broke.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Crack {
    /// When [s].
    pub time: f64,
    /// Ids of both particles, the lower first.
    pub ids: [u32; 2],
    /// Their clusters; 0: none.
    pub clusters: [u32; 2],
    /// Where: half-way between both centres [m].
    pub place: Vec3,
    /// Along the bond, from the second to the first [–].
    pub normal: Vec3,
    /// Radius of the bond [m].
    pub radius: f64,
    /// What broke it.
    pub mode: BreakMode,
    /// Elastic energy that it held [J].
    pub energy: f64,
}

/// All bonds of a simulation.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Bonds {
    /// Whether the scene has any, or may get them.
    pub(crate) on: bool,
    /// By rows.
    pub(crate) pairs: Vec<BondedPair>,
    /// The numbers of each.
    pub(crate) springs: Vec<Springs>,
    /// What each does at this instant.
    pub(crate) pulls: Vec<Pull>,
    /// How each particle has turned, by row, as quaternions i, j, k, w; empty where there are none.
    pub(crate) turns: Vec<Row4>,
    /// Energy of those that broke at this instant [J].
    pub(crate) lost: f64,
    /// Step at whose instant they broke.
    pub(crate) at: Option<u64>,
    /// Ids of those that broke at this instant and are in contact from now on.
    pub(crate) freed: Vec<[u32; 2]>,
    /// Those that broke since they were asked for.
    pub(crate) cracks: Vec<Crack>,
    /// Laws whose bonds are not made yet, by index.
    pub(crate) due: Vec<u32>,
    /// Materials of laws that have joined nothing when their time came.
    pub(crate) idle: Vec<[String; 2]>,
    /// Of those that have left: how many, and how many of them were broken.
    pub(crate) left: [usize; 2],
    /// Of two that come in, one of which is not here yet.
    pub(crate) waiting: Vec<CrossingBond>,
    /// First entry of each particle, and one more.
    #[serde(skip)]
    pub(crate) starts: Vec<u32>,
    /// Bond × 2, + 1 where the particle is j; by the id of the other.
    #[serde(skip)]
    pub(crate) entries: Vec<u32>,
}

impl Bonds {
    /// Bonds of a setup at t = 0, whose particles are sorted by id.
    ///
    /// # Errors
    /// Two centres at one position; a law for which there is no pair.
    pub fn new(setup: &Setup, particles: &Particles) -> Result<Bonds, SetupError> {
        let mut bonds = Bonds { on: !setup.bonds.is_empty(), ..Bonds::default() };
        if bonds.none() {
            return Ok(bonds);
        }
        find::bonded_pairs(setup)?.into_iter().for_each(|bond| bonds.put(bond));
        bonds.due = (0..).zip(&setup.bonds).filter(|(_, law)| law.at > 0.0).map(|(n, _)| n).collect();
        bonds.turns = vec![row_of(&UnitQuaternion::identity()); particles.len()];
        bonds.index(&particles.id);
        Ok(bonds)
    }

    /// Whether there is none, and never will be.
    pub fn none(&self) -> bool {
        !self.on
    }

    /// Puts one behind the others; [`Bonds::index`] then has to be called.
    pub fn put(&mut self, bond: NewBond) {
        self.pairs.push(BondedPair::new(bond.ends));
        self.springs.push(packed(&bond.numbers));
        self.pulls.push(Pull::default());
    }

    /// How particle `k` has turned.
    pub fn turn(&self, k: usize) -> UnitQuaternion<f64> {
        turn_of(&self.turns[k])
    }

    /// How many there were, of those that have left as well, and how many of them broke.
    pub fn count(&self) -> [usize; 2] {
        let broken = self.pairs.iter().filter(|t| t.broken.is_finite()).count();
        [self.pairs.len() + self.left[0], broken + self.left[1]]
    }

    /// Memory that bonds take [bytes].
    pub fn bytes(&self) -> usize {
        use std::mem::size_of_val;
        size_of_val(&self.pairs[..])
            + size_of_val(&self.springs[..])
            + size_of_val(&self.pulls[..])
            + size_of_val(&self.turns[..])
            + size_of_val(&self.starts[..])
            + size_of_val(&self.entries[..])
    }

    /// Elastic energy of this instant [J].
    pub fn elastic(&self) -> f64 {
        self.pulls.iter().map(|p| p.elastic).sum()
    }

    /// Power of all dashpots [W], and energy of bonds that broke [J], at this instant.
    pub fn dissipated(&self) -> [f64; 2] {
        [self.pulls.iter().map(|p| p.power).sum(), self.lost]
    }

    /// Follows the particles into their new order, in which their ids are `ids`. Bonds lie in the order of their particles, which are then
    /// fetched from near each other.
    pub fn reorder(&mut self, to: &RowOrder, ids: &[u32]) {
        if self.none() {
            return;
        }
        let count = self.count();
        let Bonds {
            pairs,
            springs,
            pulls,
            turns,
            // Counted below, and indexed.
            left: _,
            starts: _,
            entries: _,
            // Of no particle, or by its id.
            on: _,
            lost: _,
            at: _,
            freed: _,
            cracks: _,
            due: _,
            idle: _,
            waiting: _,
        } = self;
        pairs.iter_mut().for_each(|pair| pair.ends = pair.ends.map(|k| to.new[k as usize]));
        let stays = |&n: &u32| !pairs[n as usize].ends.contains(&RowOrder::LEFT);
        let mut kept: Vec<u32> = (0..pairs.len() as u32).filter(stays).collect();
        kept.sort_unstable_by_key(|&n| {
            let [i, j] = pairs[n as usize].ends;
            (i.min(j), i.max(j))
        });
        select(pairs, &kept, 0);
        select(springs, &kept, 0);
        select(pulls, &kept, 0);
        select(turns, to.order, 0);
        let here = self.count();
        self.left = [0, 1].map(|n| self.left[n] + count[n] - here[n]);
        self.index(ids);
    }

    /// Which particles have which bonds.
    pub fn index(&mut self, ids: &[u32]) {
        let mut starts = vec![0; self.turns.len() + 1];
        let ends = || self.pairs.iter().flat_map(|t| t.ends);
        ends().for_each(|k| starts[k as usize + 1] += 1);
        (1..starts.len()).for_each(|k| starts[k] += starts[k - 1]);
        let mut next = starts.clone();
        self.entries = vec![0; 2 * self.pairs.len()];
        for (entry, k) in (0..).zip(ends()) {
            self.entries[next[k as usize] as usize] = entry;
            next[k as usize] += 1;
        }
        // Sums do not depend on the order of rows.
        let pairs = &self.pairs;
        let other = |&entry: &u32| ids[pairs[(entry >> 1) as usize].ends[1 - (entry & 1) as usize] as usize];
        for pair in starts.windows(2) {
            self.entries[pair[0] as usize..pair[1] as usize].sort_unstable_by_key(other);
        }
        self.starts = starts;
    }

    /// Turns all particles by what they have turned in the step of `dt` [s] that has just been made.
    pub fn advance(&mut self, particles: &Particles, dt: f64) {
        let many = self.turns.len() >= FEW;
        let rows = particles.spins.chunks(CHUNK).zip(particles.angular_acceleration.chunks(CHUNK));
        share(many, self.turns.chunks_mut(CHUNK).zip(rows).collect(), |(turns, (spins, turning))| {
            for ((turn, w), a) in turns.iter_mut().zip(spins).zip(turning) {
                let by = [0, 1, 2].map(|axis| (w[axis] - 0.5 * dt * a[axis]) * dt);
                let q = spun(&Vec3::from(by)).into_inner() * turn_of(turn).into_inner();
                *turn = row_of(&UnitQuaternion::new_unchecked(q / q.norm()));
            }
        });
    }

    /// Whether particles in these rows are bonded, by springs of which something holds.
    pub fn joins(&self, rows: [u32; 2], of: impl Fn(&Springs) -> bool) -> bool {
        let k = rows[0] as usize;
        self.entries[self.starts[k] as usize..self.starts[k + 1] as usize].iter().any(|&entry| {
            let (pair, springs) = (&self.pairs[(entry >> 1) as usize], &self.springs[(entry >> 1) as usize]);
            pair.ends[1 - (entry & 1) as usize] == rows[1] && pair.is_whole() && of(springs)
        })
    }

    /// Takes the pairs out of a list that are not in contact as long as their bonds hold.
    pub fn drop_replaced<T>(&self, list: &mut Vec<T>, rows: impl Fn(&T) -> (u32, u32)) {
        if self.none() {
            return;
        }
        let replaced = |(i, j)| self.joins([i, j], replaces_contact);
        list.retain(|item| !replaced(rows(item)));
    }

    /// Adds what bonds do to some particles.
    pub fn add(&self, sums: &mut Sums) {
        for at in 0..if self.none() { 0 } else { sums.particles() } {
            let k = sums.first + at;
            for &entry in &self.entries[self.starts[k] as usize..self.starts[k + 1] as usize] {
                let (pull, second) = (&self.pulls[(entry >> 1) as usize], entry & 1 == 1);
                let force = pull.force.map(|f| if second { -f } else { f });
                sums.add(at, force, pull.moment[usize::from(second)]);
            }
        }
    }
}

/// A rotation, as it is kept.
pub fn row_of(turn: &UnitQuaternion<f64>) -> Row4 {
    Row4(turn.coords.into())
}

/// The rotation again.
fn turn_of(&Row4([i, j, k, w]): &Row4) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k))
}
