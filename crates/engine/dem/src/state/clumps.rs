//! Rigid clumps: several spheres that move as one rigid body.
//!
//! Every sphere of a clump (a member) is an ordinary row of the particles, with the mass of the whole clump, the velocity of its own centre and the
//! spin of the clump, so that contacts, walls, images and lists know nothing of clumps. After each move, which treated members as
//! if they were free, this pass takes the force on each from its acceleration, moves the clump, and writes the members' rows:
//!
//! ```text
//! F = Σ F_k,   τ = Σ (r_k × F_k + M_k)              in the order of the members
//! v_n = v* + (a_n − a_{n−1}) Δt/2,   L_n = L* + (τ_n − τ_{n−1}) Δt/2        as in [`laws::contact::motion`]
//! x ← x + v_n Δt + a_n Δt²/2,   v* ← v_n + a_n Δt
//! R ← free turn of L_n + τ_n Δt/2 over Δt ([`turn`]),   L* ← L_n + τ_n Δt
//! ```
//!
//! L is kept in space: without torque it never changes. Kick, turn, kick: Dullweber, Leimkuhler & McLachlan (1997), J. Chem. Phys.
//! 107, doi:10.1063/1.474310. Members of one clump never form a contact: such pairs are left out of the lists.

use crate::setup::{Body, EntryClump, Particle, Setup};
use crate::space::rotation;
use crate::state::clump::quaternion;
use crate::state::particles::select;
use crate::state::row_order::RowOrder;
use crate::state::{ClumpMotion, Particles};
use geom::Vec3;
use laws::simd::Row4;
use laws::space::cell::Cell;
use serde::{Deserialize, Serialize};

/// A particle that belongs to no clump.
pub const FREE: u32 = u32::MAX;

/// All clumps of a simulation, and their members.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct RigidClumps {
    pub(crate) flights: Vec<ClumpMotion>,
    /// Rows of the members, clump after clump.
    pub(crate) members: Vec<u32>,
    /// The clump of each row, or [`FREE`]; empty without clumps.
    pub(crate) of: Vec<u32>,
    /// Position of each row in its clump, in the principal frame [m].
    pub(crate) arms: Vec<Row4>,
    /// Periods between each row and its position in the clump: members lie in the periodic box, each by itself.
    pub(crate) images: Vec<[i8; 3]>,
}

impl RigidClumps {
    /// The clumps of a setup at t = 0; their members are added to the particles.
    pub fn new(setup: &Setup, particles: &mut Particles) -> RigidClumps {
        let mut clumps = RigidClumps::default();
        let mut sorted: Vec<&Body> = setup.clumps.placed.iter().collect();
        sorted.sort_unstable_by_key(|b| b.id);
        for body in sorted {
            clumps.push(body, setup, particles);
        }
        clumps
    }

    /// Whether there is none.
    pub fn none(&self) -> bool {
        self.flights.is_empty()
    }

    /// Whether all of so many particles are members.
    pub fn carry_all(&self, particles: usize) -> bool {
        self.members.len() == particles
    }

    /// Adds a clump, its members at the end of the particles.
    pub fn push(&mut self, body: &Body, setup: &Setup, particles: &mut Particles) {
        let shape = &setup.clumps.shapes[body.shape as usize];
        let density = setup.materials[shape.material as usize].density;
        let (s, mass) = (body.scale, shape.mass(body.scale, density));
        let inverse_inertia = shape.inertia.map(|i| 1.0 / (i * density * s * s * s * s * s));
        let turn = body.orientation * shape.frame;
        let first = self.members.len() as u32;
        self.push_members(body, mass, setup, particles);
        let momentum = rotation::momentum(&turn, &body.spin, &inverse_inertia);
        let turn = turn.into_inner().coords.into();
        self.flights.push(ClumpMotion {
            position: body.position,
            velocity: body.velocity,
            acceleration: Vec3::zeros(),
            turn,
            momentum,
            torque: Vec3::zeros(),
            spin: body.spin,
            place_before: body.position,
            turn_before: turn,
            mass,
            inverse_inertia,
            scale: s,
            id: body.id,
            shape: body.shape,
            first,
            count: shape.spheres.len() as u32,
            starting: true,
            is_prescribed: false,
        });
    }

    /// Adds the members of a clump at the end of the particles, each with the `mass` of the whole [kg].
    fn push_members(&mut self, body: &Body, mass: f64, setup: &Setup, particles: &mut Particles) {
        let shape = &setup.clumps.shapes[body.shape as usize];
        let turn = body.orientation * shape.frame;
        self.cover(particles.len());
        for (k, (centre, radius)) in shape.spheres.iter().enumerate() {
            let arm = centre * body.scale;
            let out = turn * arm;
            let at = particles.len();
            particles.push(
                &Particle {
                    id: body.id.wrapping_add(k as u32),
                    material: shape.material,
                    radius: radius * body.scale,
                    position: body.position + out,
                    velocity: body.velocity + body.spin.cross(&out),
                    spin: body.spin,
                },
                &setup.materials,
            );
            particles.rows[at][7] = 1.0 / mass;
            self.members.push(at as u32);
            self.of.push(self.flights.len() as u32);
            self.arms.push(Row4::of(arm));
            self.images.push([0; 3]);
        }
    }

    /// Adds a clump that moves by a prescribed motion for now, at its position and velocity of `now`, when it has turned for a time `turned` [s].
    pub fn enter(
        &mut self,
        now: &Particle,
        turned: f64,
        clump: &EntryClump,
        setup: &Setup,
        particles: &mut Particles,
    ) {
        let Particle { id, position, velocity, spin, .. } = *now;
        let orientation = rotation::spun(&(spin * turned)) * clump.orientation;
        let EntryClump { shape, scale, .. } = *clump;
        self.push(&Body { id, shape, scale, position, orientation, velocity, spin }, setup, particles);
        if let Some(clump_motion) = self.flights.last_mut() {
            clump_motion.is_prescribed = true;
        }
    }

    /// Removes pairs of members of one clump from a list.
    pub fn drop_own<T>(&self, list: &mut Vec<T>, pair: impl Fn(&T) -> (u32, u32)) {
        if !self.none() {
            let of = |k: u32| self.of.get(k as usize).copied().unwrap_or(FREE);
            list.retain(|p| {
                let (i, j) = pair(p);
                of(i) == FREE || of(i) != of(j)
            });
        }
    }

    /// Whether a row is a member of a clump.
    pub fn is_member(&self, k: usize) -> bool {
        self.body_of(k).is_some()
    }

    /// The clump that a row is a member of.
    pub(crate) fn body_of(&self, k: usize) -> Option<&ClumpMotion> {
        self.of.get(k).and_then(|&b| self.flights.get(b as usize))
    }

    /// From the centre of its clump to row `k` [m]; 0 of a sphere.
    pub fn arm(&self, k: usize) -> Vec3 {
        self.body_of(k).map_or_else(Vec3::zeros, |f| quaternion(&f.turn) * self.arms[k].vector())
    }

    /// Follows the particles into their new order. Clumps stay or leave whole.
    pub fn reorder(&mut self, to: &RowOrder) {
        if self.none() {
            return;
        }
        self.cover(to.new.len());
        self.keep(&to.new);
        let RigidClumps { flights: _, members, of, arms, images } = self;
        members.iter_mut().for_each(|m| *m = to.new[*m as usize]);
        select(of, to.order, 0);
        select(arms, to.order, 0);
        select(images, to.order, 0);
    }

    /// Makes the columns as long as there are particles: those that were added last are free.
    fn cover(&mut self, particles: usize) {
        self.of.resize(particles, FREE);
        self.arms.resize(particles, Row4::default());
        self.images.resize(particles, [0; 3]);
    }

    /// −m g·x of those that are free [J]; what a fluid displaced lifts is no longer heavy.
    pub fn potential(&self, setup: &Setup) -> f64 {
        self.flights
            .iter()
            .filter(|f| !f.is_prescribed)
            .map(|f| -f.mass * f.weight(setup).dot(&f.position))
            .sum()
    }

    /// Brings clumps, and each of their members, back into the periodic cell; what energy of motion they get by that [J], in steps of `dt` [s].
    pub fn wrap(&mut self, particles: &mut Particles, cell: &Cell, dt: f64) -> f64 {
        let mut work = 0.0;
        for f in &mut self.flights {
            let there = -cell.away(&f.position);
            let shift = there.component_mul(&cell.lengths());
            f.position += shift;
            f.place_before += shift;
            if cell.moves() {
                work += f.kick(&there.component_mul(&cell.speed), dt);
            }
            for &m in &self.members[f.range()] {
                let m = m as usize;
                let (position, velocity, _) = f.point(&self.arms[m]);
                self.images[m] = (-cell.away(&position)).map(|n| n as i8).into();
                let position = position + cell.shift(&self.images[m]);
                particles.rows[m][..3].copy_from_slice(position.as_slice());
                if cell.moves() {
                    let velocity = velocity + cell.drift(&self.images[m]);
                    particles.rows[m][4..7].copy_from_slice(velocity.as_slice());
                }
            }
        }
        work
    }

    /// Memory of one clump, and of each of its members beyond a particle's [bytes].
    pub fn bytes() -> (usize, usize) {
        (size_of::<ClumpMotion>(), 2 * size_of::<u32>() + size_of::<Row4>() + size_of::<[i8; 3]>())
    }

    /// Memory of all clumps [bytes].
    pub fn all_bytes(&self) -> usize {
        let (flights, members, arms) = (&self.flights[..], &self.members[..], &self.arms[..]);
        size_of_val(flights)
            + size_of_val(members)
            + size_of_val(&self.of[..])
            + size_of_val(arms)
            + size_of_val(&self.images[..])
    }
}

/// The start of each sphere that is in this state as a whole: the sphere itself, or the members of a clump, with the velocity of its centre;
/// and the principal axes of the clump to space.
pub fn starts(
    whole: &Particle,
    clump: Option<&EntryClump>,
    setup: &Setup,
) -> (Vec<Particle>, Option<[f64; 4]>) {
    let Some(clump) = clump else { return (vec![*whole], None) };
    let shape = &setup.clumps.shapes[clump.shape as usize];
    let turn = clump.orientation * shape.frame;
    let spheres = shape.spheres_at(whole.position, &clump.orientation, clump.scale);
    let member = |((position, radius), k)| Particle {
        id: whole.id.wrapping_add(k),
        material: shape.material,
        radius,
        position,
        ..*whole
    };
    (spheres.zip(0..).map(member).collect(), Some(turn.into_inner().coords.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::ClumpShape;
    use geom::Moments;
    use laws::effects::Material;

    /// Spheres that came in since the last rebuild have no entry yet, and some of them may have left already.
    #[test]
    fn rows_beyond_the_members_are_reordered() {
        let spheres = [(Vec3::zeros(), 0.1), (Vec3::x() * 0.1, 0.1)];
        let shape = ClumpShape::new("pair", 0, &spheres, &Moments::of_sum(&spheres));
        let (orientation, still) = (shape.frame, Vec3::zeros());
        let materials = vec![Material { name: "a".to_owned(), density: 1e3, young: 1e6, poisson: 0.3 }];
        let mut setup = Setup { materials, ..Setup::default() };
        setup.clumps.shapes.push(shape);
        let body =
            Body { id: 0, shape: 0, scale: 1.0, position: still, orientation, velocity: still, spin: still };
        setup.clumps.placed.push(body);
        let mut particles = Particles::new(true);
        let mut clumps = RigidClumps::new(&setup, &mut particles);
        clumps.reorder(&RowOrder::of(&[0, 1, 4], 5));
        assert_eq!((&clumps.of[..], &clumps.members[..]), (&[0, 0, FREE][..], &[0, 1][..]));
    }
}
