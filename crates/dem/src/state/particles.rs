//! The particles' columns, in space order.

use crate::effects::Material;
use crate::setup::Particle;
use crate::simd::{Row, Row4};
use crate::space::sphere::{FAR, mass};
use geom::Vec3;
use serde::{Deserialize, Serialize};

/// Columns, one entry a particle; `rows` and `spins` have two more ([`FAR`]).
///
/// Positions are those of the step; velocities and spins are predicted for it from the acceleration of the step
/// before, so that forces use positions and velocities of one instant ([`crate::advance`]).
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Particles {
    /// x, y, z, radius [m], predicted velocity [m/s], 1/m [1/kg].
    pub rows: Vec<Row>,
    /// Acceleration of the step before [m/s²].
    pub acceleration: Vec<Row4>,
    /// Predicted angular velocity [rad/s]; empty without rotation.
    pub spins: Vec<Row4>,
    /// Angular acceleration of the step before [rad/s²]; empty without rotation.
    pub turning: Vec<Row4>,
    /// Unique number.
    pub id: Vec<u32>,
    /// Material.
    pub material: Vec<u16>,
    /// Where the particle was when neighbours were listed, and its room around that place [m].
    pub home: Vec<Row4>,
}

impl Particles {
    /// No particles; with or without columns for rotation.
    pub fn new(rotates: bool) -> Particles {
        Particles {
            rows: FAR.to_vec(),
            acceleration: Vec::new(),
            spins: if rotates { vec![Row4::default(); 2] } else { Vec::new() },
            turning: Vec::new(),
            id: Vec::new(),
            material: Vec::new(),
            home: Vec::new(),
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether they have angular velocities.
    pub fn rotates(&self) -> bool {
        !self.spins.is_empty()
    }

    /// Adds a particle at the end.
    pub fn push(&mut self, particle: &Particle, materials: &[Material]) {
        let at = self.len();
        let Particle { position: p, velocity: v, spin: w, radius, material, .. } = *particle;
        let row =
            [p.x, p.y, p.z, radius, v.x, v.y, v.z, 1.0 / mass(radius, materials[material as usize].density)];
        self.rows.insert(at, Row(row));
        self.acceleration.push(Row4::default());
        if self.rotates() {
            self.spins.insert(at, Row4([w.x, w.y, w.z, 0.0]));
            self.turning.push(Row4::default());
        }
        self.id.push(particle.id);
        self.material.push(material);
        self.home.push(Row4([p.x, p.y, p.z, 0.0]));
    }

    /// Takes the particles named by `order`, and leaves the others.
    pub fn select(&mut self, order: &[u32]) {
        fn pick<T: Copy>(from: &mut Vec<T>, order: &[u32], tail: usize) {
            let end = from.len() - tail;
            let picked = order.iter().map(|&k| from[k as usize]).chain(from[end..].iter().copied()).collect();
            *from = picked;
        }
        pick(&mut self.rows, order, 2);
        pick(&mut self.acceleration, order, 0);
        if self.rotates() {
            pick(&mut self.spins, order, 2);
            pick(&mut self.turning, order, 0);
        }
        pick(&mut self.id, order, 0);
        pick(&mut self.material, order, 0);
        pick(&mut self.home, order, 0);
    }

    /// How far the surface of particle `k` may come from its home [m].
    pub fn reach(&self, k: usize) -> f64 {
        self.rows[k][3] + self.home[k][3]
    }

    /// Centre of particle `k` [m].
    pub fn position(&self, k: usize) -> Vec3 {
        let r = &self.rows[k];
        Vec3::new(r[0], r[1], r[2])
    }
}
