//! Contacts of rigid clumps: each dashpot is made for the mass that it moves.
//!
//! ```text
//! m_i = min(N_i/a_i, 1/A_i)
//! a_i = n_i·(a_a − a_b),  a_a = F/m_a + (I_a⁻¹ Σ r_j × N_j n_j) × r_i     what all elastic forces of this pair of bodies do at the contact i
//! A_i = 1/m_a + (r_i × n_i)·I_a⁻¹(r_i × n_i) + the same of b               what its own force does
//! ```
//!
//! A dashpot made for the mass of the whole clump is too strong where the clump turns away (a corner that hits a floor), and where several contacts share the
//! impact (a plate that falls flat). Forces of each pair of bodies count by themselves: at rest the sum over all pairs is zero. Bodies are clumps, single
//! particles and walls.

use crate::model::{Model, With};
use crate::neighbours::{NeighbourLists, Segment};
use crate::space::rotation;
use crate::state::State;
use crate::state::clump::quaternion;
use crate::state::clumps::FREE;
use crate::threads::{FEW, share};
use geom::Vec3;
use laws::contact::damped_mass::DampedMass;
use laws::contact::patch::PATCH;
use laws::contact::touch::Touch;
use laws::simd::BLOCK;

/// A contact of a clump that touches.
struct Entry {
    /// The clump, and the other body: a clump, a particle or a wall.
    bodies: (u32, u32),
    /// First of its numbers.
    at: usize,
    touch: Touch,
    /// N, up to a factor that all of the pair share.
    force: f64,
    /// From the centre of each body to its sphere [m].
    arms: [Vec3; 2],
    /// The wall, where the other body is one.
    wall: Option<usize>,
    /// 1/m of both [1/kg].
    inverse_masses: [f64; 2],
    /// 1 for the side of the first particle of the contact, −1 where the clump is the second.
    sign: f64,
}

/// Finds them, where contact points are known.
pub fn find(model: &Model, state: &State, lists: &mut NeighbourLists) {
    let segments: Vec<&Segment> = lists.slots.segments.iter().filter(|s| s.patches).collect();
    let many = state.particles.len() >= FEW;
    let found = share(many, segments, |s| entries(model, state, lists, s));
    // By the first body, in the order of slots.
    let clumps = state.clumps.flights.len();
    let mut starts = vec![0_usize; clumps + 1];
    found.iter().flatten().for_each(|e| starts[e.bodies.0 as usize + 1] += 1);
    (0..clumps).for_each(|k| starts[k + 1] += starts[k]);
    let mut next = starts.clone();
    let mut order: Vec<Option<&Entry>> = vec![None; starts[clumps]];
    for entry in found.iter().flatten() {
        let at = &mut next[entry.bodies.0 as usize];
        order[*at] = Some(entry);
        *at += 1;
    }
    let of_clumps: Vec<Vec<&Entry>> =
        starts.windows(2).map(|w| order[w[0]..w[1]].iter().flatten().copied().collect()).collect();
    let numbers = share(many, of_clumps, |mut own: Vec<&Entry>| {
        // Stable: those of one pair stay in the order of their slots.
        own.sort_by_key(|e| e.bodies.1);
        own.chunk_by(|a, b| a.bodies.1 == b.bodies.1)
            .flat_map(|pair| of_pair(model, state, pair))
            .collect::<Vec<_>>()
    });
    for s in lists.slots.segments.iter().filter(|s| s.patches && !s.with.is_wall()) {
        lists.step.patch[s.patch..s.patch + s.slots.len() * PATCH].fill(1.0);
    }
    for (at, numbers) in numbers.into_iter().flatten() {
        for (c, number) in numbers.into_iter().enumerate() {
            lists.step.patch[at + (2 + c) * BLOCK] = number;
        }
    }
}

/// Contacts of clumps in a segment that touch.
fn entries(model: &Model, state: &State, lists: &NeighbourLists, s: &Segment) -> Vec<Entry> {
    let (particles, clumps, slots) = (&state.particles, &state.clumps, &lists.slots);
    let Some(law) = model.kinds[s.kind].patch else { return Vec::new() };
    let (ahead, body) = (model.ahead(), |k: u32| clumps.of.get(k as usize).copied().unwrap_or(FREE));
    // After the clumps come the particles, then the walls.
    let first_wall = (clumps.flights.len() + particles.len()) as u32;
    let number = |k: u32| if body(k) == FREE { clumps.flights.len() as u32 + k } else { body(k) };
    let mut found = Vec::new();
    for slot in s.contacts() {
        let (i, j) = (slots.i[slot], slots.partner[slot]);
        let (wall, other) = match s.with {
            With::Wall(w) => (Some(w), first_wall + w as u32),
            _ => (None, number(j)),
        };
        if body(i) == FREE && (wall.is_some() || body(j) == FREE) {
            continue;
        }
        let (row, partner) = (&particles.rows[i as usize], lists.partner_row(particles, s, slot));
        let way = ahead * (row.velocity() - partner.velocity()).norm();
        let reach = row.radius() + partner.radius() + way;
        if !((row.position() - partner.position()).norm_squared() < reach * reach) {
            continue;
        }
        let touch = Touch::of(law, [model.dt, ahead], row, partner, 0.0);
        if touch.overlap <= 0.0 {
            continue;
        }
        let at = s.patch + s.rank(slot) / BLOCK * (PATCH * BLOCK) + s.rank(slot) % BLOCK;
        let shared = if s.with.is_wall() { lists.step.patch[at] } else { 1.0 };
        let arm_j = if wall.is_some() { Vec3::zeros() } else { clumps.arm(j as usize) };
        let (mut bodies, mut arms, mut sign) = ((number(i), other), [clumps.arm(i as usize), arm_j], 1.0);
        let mut inverse_masses = [row.inverse_mass(), partner.inverse_mass()];
        // The clump comes first; of two the one with the lower number.
        if bodies.1 < bodies.0 {
            (bodies, sign) = ((bodies.1, bodies.0), -1.0);
            arms.reverse();
            inverse_masses.reverse();
        }
        let force = shared * touch.force;
        found.push(Entry { bodies, at, touch, force, arms, wall, inverse_masses, sign });
    }
    found
}

/// What m* and 1/m* are multiplied by in each contact of a pair of bodies, and where these numbers stand.
fn of_pair(model: &Model, state: &State, pair: &[&Entry]) -> Vec<(usize, [f64; 2])> {
    let [first, ..] = pair else { return Vec::new() };
    let clumps = &state.clumps.flights;
    let turning = [first.bodies.0, first.bodies.1].map(|body| clumps.get(body as usize));
    // What a moment does to a body.
    let spun = |side: usize, moment: &Vec3| {
        turning[side]
            .map_or_else(Vec3::zeros, |f| rotation::spin(&quaternion(&f.turn), moment, &f.inverse_inertia))
    };
    let mount = first.wall.and_then(|w| model.walls[w].mount.as_ref());
    let (direction, wall) = mount.map_or((Vec3::zeros(), 0.0), |m| (m.direction, 1.0 / m.mass));
    let normal = |e: &Entry| e.touch.normal * e.sign;
    let (mut push, mut moments) = (Vec3::zeros(), [Vec3::zeros(); 2]);
    for e in pair {
        let force = normal(e) * e.force;
        push += force;
        moments[0] += e.arms[0].cross(&force);
        moments[1] -= e.arms[1].cross(&force);
    }
    let accelerated = [spun(0, &moments[0]), spun(1, &moments[1])];
    let damped = |e: &&Entry| {
        let (n, [a, b]) = (normal(e), e.inverse_masses);
        let along = n.dot(&direction);
        let lever = [e.arms[0].cross(&n), e.arms[1].cross(&n)];
        let own = a
            + b
            + along * along * wall
            + lever[0].dot(&spun(0, &lever[0]))
            + lever[1].dot(&spun(1, &lever[1]));
        let by_all =
            n.dot(&push) * (a + b) + along * push.dot(&direction) * wall + lever[0].dot(&accelerated[0])
                - lever[1].dot(&accelerated[1]);
        DampedMass::new(e.touch.overlap, e.force, own, by_all)
    };
    let all: Vec<DampedMass> = pair.iter().map(damped).collect();
    let deepest = pair
        .iter()
        .enumerate()
        .fold(0, |most, (k, e)| if e.touch.overlap > pair[most].touch.overlap { k } else { most });
    let pace = all[deepest].pace();
    let numbers = |(e, own): (&&Entry, &DampedMass)| {
        (e.at, own.numbers(pace, e.inverse_masses[0] + e.inverse_masses[1]))
    };
    pair.iter().zip(&all).map(numbers).collect()
}
