//! Rigid clumps: several spheres that move as one body.
//!
//! Every sphere of a clump (a member) is an ordinary row of the particles, with the mass of the whole body, the velocity of its own centre and the
//! spin of the body, so that contacts, walls, images and lists know nothing of clumps. After each move, which treated members as
//! if they were free, this pass takes the force on each from its acceleration, moves the body, and writes the members' rows:
//!
//! ```text
//! F = Σ F_k,   τ = Σ (r_k × F_k + M_k)              in the order of the members
//! v_n = v* + (a_n − a_{n−1}) Δt/2,   L_n = L* + (τ_n − τ_{n−1}) Δt/2        as in [`crate::advance`]
//! x ← x + v_n Δt + a_n Δt²/2,   v* ← v_n + a_n Δt
//! R ← free turn of L_n + τ_n Δt/2 over Δt ([`turn`]),   L* ← L_n + τ_n Δt
//! ```
//!
//! L is kept in space: without torque it never changes. Kick, turn, kick: Dullweber, Leimkuhler & McLachlan (1997), J. Chem. Phys.
//! 107, doi:10.1063/1.474310. Members of one body never form a contact: such pairs are left out of the lists.

use crate::effects::Material;
use crate::setup::{Body, ClumpShape, EntryClump, Particle, Setup};
use crate::simd::Row4;
use crate::space::rotation;
use crate::space::sphere::periods;
use crate::state::clump::{ClumpMotion, arm, quaternion};
use crate::state::particles::Particles;
use geom::Vec3;
use serde::{Deserialize, Serialize};

/// A particle that belongs to no clump.
pub(crate) const FREE: u32 = u32::MAX;

/// All clumps of a simulation, and their members.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct RigidClumps {
    pub(crate) flights: Vec<ClumpMotion>,
    /// Rows of the members, body after body.
    pub(crate) members: Vec<u32>,
    /// The body of each row, or [`FREE`]; empty without bodies.
    pub(crate) of: Vec<u32>,
    /// Place of each row in its body, in the principal frame [m].
    pub(crate) arms: Vec<Row4>,
    /// Periods between each row and its place in the body: members lie in the periodic box, each by itself.
    pub(crate) images: Vec<[i8; 3]>,
}

impl RigidClumps {
    /// The bodies of a setup at t = 0; their members are added to the particles.
    pub fn new(setup: &Setup, particles: &mut Particles) -> RigidClumps {
        let mut bodies = RigidClumps::default();
        let mut sorted: Vec<&Body> = setup.clumps.bodies.iter().collect();
        sorted.sort_unstable_by_key(|b| b.id);
        for body in sorted {
            bodies.push(body, &setup.clumps.shapes[body.shape as usize], &setup.materials, particles);
        }
        bodies
    }

    /// Whether there is none.
    pub fn none(&self) -> bool {
        self.flights.is_empty()
    }

    /// Adds a body, its members at the end of the particles.
    pub fn push(
        &mut self,
        body: &Body,
        shape: &ClumpShape,
        materials: &[Material],
        particles: &mut Particles,
    ) {
        let density = materials[shape.material as usize].density;
        let (s, mass) = (body.scale, shape.mass(body.scale, density));
        let inverse_inertia = shape.inertia.map(|i| 1.0 / (i * density * s * s * s * s * s));
        let turn = body.orientation * shape.frame;
        let first = self.members.len() as u32;
        self.push_members(body, shape, materials, particles);
        let momentum = rotation::momentum(&turn, &body.spin, &inverse_inertia);
        let turn = turn.into_inner().coords.into();
        self.flights.push(ClumpMotion {
            place: body.position,
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
            travels: false,
        });
    }

    /// Adds the members of a clump at the end of the particles, each with the mass of the whole.
    fn push_members(
        &mut self,
        body: &Body,
        shape: &ClumpShape,
        materials: &[Material],
        particles: &mut Particles,
    ) {
        let turn = body.orientation * shape.frame;
        let mass = shape.mass(body.scale, materials[shape.material as usize].density);
        self.of.resize(particles.len(), FREE);
        self.arms.resize(particles.len(), Row4::default());
        self.images.resize(particles.len(), [0; 3]);
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
                materials,
            );
            particles.rows[at][7] = 1.0 / mass;
            self.members.push(at as u32);
            self.of.push(self.flights.len() as u32);
            self.arms.push(Row4([arm.x, arm.y, arm.z, 0.0]));
            self.images.push([0; 3]);
        }
    }

    /// Adds a body that moves by a prescribed motion for now, from its state at the start, its place and velocity now, and how long it has
    /// turned [s]; gives the start of each member, and the principal axes then.
    pub fn enter(
        &mut self,
        (start, now, turned): (&Particle, &Particle, f64),
        clump: &EntryClump,
        setup: &Setup,
        particles: &mut Particles,
    ) -> (Vec<Particle>, [f64; 4]) {
        let shape = &setup.clumps.shapes[clump.shape as usize];
        let EntryClump { shape: index, scale, orientation } = *clump;
        let Particle { id, position, velocity, spin, .. } = *now;
        let orientation = rotation::spun(&(spin * turned)) * orientation;
        let body = Body { id, shape: index, scale, position, orientation, velocity, spin };
        self.push(&body, shape, &setup.materials, particles);
        if let Some(clump_motion) = self.flights.last_mut() {
            clump_motion.travels = true;
        }
        starts(start, clump, setup)
    }

    /// Takes the pairs of one body's own members out of a list.
    pub fn drop_own<T>(&self, list: &mut Vec<T>, pair: impl Fn(&T) -> (u32, u32)) {
        if !self.none() {
            let of = |k: u32| self.of.get(k as usize).copied().unwrap_or(FREE);
            list.retain(|p| {
                let (i, j) = pair(p);
                of(i) == FREE || of(i) != of(j)
            });
        }
    }

    /// Whether a row is a member of a body.
    pub fn is_member(&self, k: usize) -> bool {
        self.body_of(k).is_some()
    }

    /// The body that a row is a member of.
    pub(crate) fn body_of(&self, k: usize) -> Option<&ClumpMotion> {
        self.of.get(k).and_then(|&b| self.flights.get(b as usize))
    }

    /// Follows the particles to their new places; `order` names the old ones of those that stay. Bodies stay or leave whole.
    pub fn reorder(&mut self, order: &[u32]) {
        if self.none() {
            return;
        }
        let mut new = vec![FREE; self.of.len().max(order.len())];
        for (n, &o) in order.iter().enumerate() {
            new[o as usize] = n as u32;
        }
        self.keep(&new);
        self.members.iter_mut().for_each(|m| *m = new[*m as usize]);
        let before = std::mem::take(&mut self.of);
        let old = |o: &u32| before.get(*o as usize).copied().unwrap_or(FREE);
        self.of = order.iter().map(old).collect();
        self.arms = order.iter().map(|&o| self.arms.get(o as usize).copied().unwrap_or_default()).collect();
        self.images =
            order.iter().map(|&o| self.images.get(o as usize).copied().unwrap_or_default()).collect();
    }

    /// −m g·x of those that are free [J]; what a fluid displaced lifts is no longer heavy.
    pub fn potential(&self, setup: &Setup) -> f64 {
        self.flights.iter().filter(|f| !f.travels).map(|f| -f.mass * f.weight(setup).dot(&f.place)).sum()
    }

    /// Brings bodies, and each of their members, back into the periodic box.
    pub fn wrap(&mut self, particles: &mut Particles, periodic: &[Option<(f64, f64)>; 3]) {
        let periods = periods(periodic);
        let away =
            |p: &Vec3, a: usize| periodic[a].map_or(0.0, |(lo, hi)| -((p[a] - lo) / (hi - lo)).floor());
        let there = |p: Vec3| [0, 1, 2].map(|a| away(&p, a));
        for f in &mut self.flights {
            let shift = Vec3::from(there(f.place)).component_mul(&periods);
            f.place += shift;
            f.place_before += shift;
            for &m in &self.members[f.range()] {
                let m = m as usize;
                let place = f.place + quaternion(&f.turn) * arm(&self.arms[m]);
                self.images[m] = there(place).map(|n| n as i8);
                let place = place + far(&self.images[m], &periods);
                particles.rows[m][..3].copy_from_slice(place.as_slice());
            }
        }
    }

    /// Memory of one body, and of each of its members beyond a particle's [bytes].
    pub fn bytes() -> (usize, usize) {
        (size_of::<ClumpMotion>(), 2 * size_of::<u32>() + size_of::<Row4>() + size_of::<[i8; 3]>())
    }

    /// Memory of all bodies [bytes].
    pub fn all_bytes(&self) -> usize {
        let (flights, members, arms) = (&self.flights[..], &self.members[..], &self.arms[..]);
        size_of_val(flights)
            + size_of_val(members)
            + size_of_val(&self.of[..])
            + size_of_val(arms)
            + size_of_val(&self.images[..])
    }
}

pub(crate) fn far(image: &[i8; 3], periods: &Vec3) -> Vec3 {
    Vec3::from(image.map(f64::from)).component_mul(periods)
}

/// The state of each member of a clump that is whole in this state, with the velocity of its centre; and its principal axes to space.
pub fn starts(whole: &Particle, clump: &EntryClump, setup: &Setup) -> (Vec<Particle>, [f64; 4]) {
    let shape = &setup.clumps.shapes[clump.shape as usize];
    let turn = clump.orientation * shape.frame;
    let member = |(k, (centre, radius)): (usize, &(Vec3, f64))| Particle {
        id: whole.id.wrapping_add(k as u32),
        radius: radius * clump.scale,
        position: whole.position + turn * (centre * clump.scale),
        material: shape.material,
        ..*whole
    };
    (shape.spheres.iter().enumerate().map(member).collect(), turn.into_inner().coords.into())
}
