//! The particles' columns, in space order.

use crate::setup::Particle;
use crate::space::mass;
use crate::state::row_order::RowOrder;
use crate::threads::refill;
use geom::Vec3;
use laws::effects::Material;
use laws::simd::{Row, Row4};
use laws::space::sphere::FAR;
use serde::{Deserialize, Serialize};

/// Columns, one entry a particle; `rows` and `spins` have two more ([`FAR`]).
///
/// Positions are those of the step; velocities and spins are predicted for it from the acceleration of the step
/// before, so that forces use positions and velocities of one instant ([`laws::contact::motion`]).
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Particles {
    /// x, y, z, radius [m], predicted velocity [m/s], 1/m [1/kg].
    pub rows: Vec<Row>,
    /// Acceleration of the step before [m/s²].
    pub acceleration: Vec<Row4>,
    /// Predicted angular velocity [rad/s]; empty without rotation.
    pub spins: Vec<Row4>,
    /// Angular acceleration of the step before [rad/s²]; empty without rotation.
    pub angular_acceleration: Vec<Row4>,
    /// Unique number.
    pub id: Vec<u32>,
    /// Material.
    pub material: Vec<u16>,
    /// Position when neighbours were listed, and the margin around it [m].
    pub home: Vec<Row4>,
}

/// Makes a particle faster at once [m/s], between the move and the forces of a step of `dt` [s]; the energy that it gets [J]. The ledger has
/// ½ m v₋·v₊, in which v₊ of the last step becomes v₊ + `by` ([`crate::state::ledger`]).
pub fn kick_row(row: &mut Row, acceleration: &Row4, by: &Vec3, dt: f64) -> f64 {
    let half_way = row.velocity() - acceleration.vector() * (0.5 * dt);
    (0..3).for_each(|a| row[4 + a] += by[a]);
    (half_way + by * 0.5).dot(by) / row.inverse_mass()
}

/// Takes the rows named by `order`; the last ones, so many as the `tail` is long, stay behind them.
pub fn select<T: Copy + Send + Sync>(column: &mut Vec<T>, order: &[u32], tail: usize) {
    select_by(&mut Vec::new(), column, order, tail);
}

/// The same by way of `spare` memory, which is another's afterwards.
fn select_by<T: Copy + Send + Sync>(spare: &mut Vec<T>, column: &mut Vec<T>, order: &[u32], tail: usize) {
    let end = column.len() - tail;
    // Of nothing: a column that still has rows would be given room beside them.
    spare.clear();
    spare.reserve_exact(order.len() + TAIL);
    refill(spare, order.len(), |k| column[order[k] as usize]);
    spare.extend_from_slice(&column[end..]);
    std::mem::swap(column, spare);
}

/// Rows after the last particle, at most.
const TAIL: usize = 2;

/// Up to so many threads memory is worth more than the time that spare columns save.
const FEW_THREADS: usize = 4;

/// Memory for columns that are put into another order; it is kept from one time to the next.
#[derive(Debug, Default)]
pub struct SpareColumns {
    rows: Vec<Row>,
    quads: Vec<Row4>,
}

impl Particles {
    /// No particles; with or without columns for rotation.
    pub fn new(rotates: bool) -> Particles {
        Particles {
            rows: FAR.to_vec(),
            acceleration: Vec::new(),
            spins: if rotates { vec![Row4::default(); 2] } else { Vec::new() },
            angular_acceleration: Vec::new(),
            id: Vec::new(),
            material: Vec::new(),
            home: Vec::new(),
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Makes particle `k` faster at once [m/s], between the move and the forces of a step of `dt` [s]; the energy that it gets [J].
    pub fn kick(&mut self, k: usize, by: &Vec3, dt: f64) -> f64 {
        let (row, a) = (&mut self.rows[k], &self.acceleration[k]);
        kick_row(row, a, by, dt)
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
            self.spins.insert(at, Row4::of(w));
            self.angular_acceleration.push(Row4::default());
        }
        self.id.push(particle.id);
        self.material.push(material);
        self.home.push(Row4::of(p));
    }

    /// Makes room for so many more: columns that grow one by one take twice their length.
    pub fn reserve(&mut self, more: usize) {
        self.rows.reserve_exact(more);
        self.acceleration.reserve_exact(more);
        if self.rotates() {
            self.spins.reserve_exact(more);
            self.angular_acceleration.reserve_exact(more);
        }
        self.id.reserve_exact(more);
        self.material.reserve_exact(more);
        self.home.reserve_exact(more);
    }

    /// Takes the particles that stay, in their new order.
    pub fn reorder(&mut self, to: &RowOrder, spare: &mut SpareColumns) {
        let (rotates, order) = (self.rotates(), to.order);
        let Particles { rows, acceleration, spins, angular_acceleration, home, id: _, material: _ } = self;
        let SpareColumns { rows: spare_rows, quads } = spare;
        select_by(spare_rows, rows, order, TAIL);
        select_by(quads, acceleration, order, 0);
        if rotates {
            select_by(quads, spins, order, TAIL);
            select_by(quads, angular_acceleration, order, 0);
        }
        select_by(quads, home, order, 0);
        // With many threads, page faults of new memory take longer than the sorting; with few they are negligible.
        if rayon::current_num_threads() <= FEW_THREADS {
            *spare = SpareColumns::default();
        }
        self.take_names(order);
    }

    /// The same of what no step changes: numbers and materials.
    pub fn take_names(&mut self, order: &[u32]) {
        select(&mut self.id, order, 0);
        select(&mut self.material, order, 0);
    }

    /// How far the surface of particle `k` may come from its home [m].
    pub fn reach(&self, k: usize) -> f64 {
        self.rows[k].radius() + self.home[k][3]
    }

    /// Centre of particle `k` [m].
    #[inline]
    pub fn position(&self, k: usize) -> Vec3 {
        self.rows[k].position()
    }

    /// |v| + r|ω| of particle `k` [m/s].
    pub fn surface_speed(&self, k: usize) -> f64 {
        let spin = self.spins.get(k).map_or(0.0, |w| w.vector().norm());
        self.rows[k].velocity().norm() + self.rows[k].radius() * spin
    }

    /// Predicted angular velocity [rad/s] of particle `k`, and its angular acceleration of the step before [rad/s²]; 0 without rotation.
    pub fn rotation(&self, k: usize) -> (Vec3, Vec3) {
        let of = |column: &[Row4]| column.get(k).map_or_else(Vec3::zeros, Row4::vector);
        (of(&self.spins), of(&self.angular_acceleration))
    }
}
