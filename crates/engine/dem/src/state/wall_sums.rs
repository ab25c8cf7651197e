//! What particles have done to each wall, and to each of its spheres and triangles, since the sums were last taken.
//!
//! ```text
//! impulse  = Σ F Δt     moment = Σ T Δt     work = Σ P Δt     normal = Σ |F·n| Δt      over all instants; the first and the last count half
//! ```
//!
//! So an impulse is the change of momentum that velocity Verlet makes of it. Sliding work is that of the energy ledger, whose steps count whole.
//! Sums run in the order of the contact list: they are the same for any number of threads.

use crate::model::Model;
use crate::setup::{WallDetail, WallShape};
use geom::Vec3;
use serde::{Deserialize, Serialize};

/// What particles do to a whole wall in an interval of time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct WallSum {
    /// Time integral of the force on the wall [N·s].
    pub impulse: Vec3,
    /// Time integral of the torque on the wall about its reference point [N·m·s].
    pub moment: Vec3,
    /// Work of the particles on the moving surface [J]; what drives the wall does the opposite.
    pub work: f64,
    /// Time integral of the sum of normal forces, without their signs [N·s].
    pub normal: f64,
    /// Largest force on the wall at an instant [N].
    pub largest: f64,
    /// Energy that sliding dissipated [J]; 0 without the ledger.
    pub sliding: f64,
    /// Impacts: particles that come to touch the wall and did not touch it a step before.
    pub impacts: u64,
    /// Energy of the approach of these along the normal, and along the surface [J].
    pub impact_energy: [f64; 2],
    /// Force of the instant so far [N].
    #[serde(skip)]
    pub(crate) now: Vec3,
}

/// What particles do to a sphere or a triangle of a wall in an interval of time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PartSum {
    /// Number of the sphere or triangle, in the order in which the wall was given.
    pub part: u32,
    /// Time integral of the normal force [N·s].
    pub normal: f64,
    /// Largest normal force of a contact [N].
    pub largest: f64,
    /// Energy that sliding dissipated [J].
    pub sliding: f64,
    /// Impacts, each on the part that it presses most.
    pub impacts: u32,
    /// Energy of these along the normal, and along the surface [J].
    pub impact_energy: [f64; 2],
}

/// Sums of the parts of one wall that were touched.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PartSums {
    /// Row of each part plus one; 0: not touched. Empty where parts have no sums.
    rows_of: Vec<u32>,
    rows: Vec<PartSum>,
}

/// Sums of all walls.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct WallSums {
    /// Step from which they count.
    pub since: u64,
    /// By wall; empty where nothing asks for them.
    pub whole: Vec<WallSum>,
    /// By wall.
    pub parts: Vec<PartSums>,
}

/// The sums of an interval of time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WallInterval {
    /// Its length [s].
    pub length: f64,
    /// By wall.
    pub walls: Vec<WallSum>,
    /// By wall, the parts that were touched, in their order.
    pub parts: Vec<Vec<PartSum>>,
}

impl PartSums {
    /// The sums of a part, in a wall whose parts have any.
    pub fn of(&mut self, part: u32) -> Option<&mut PartSum> {
        let row = self.rows_of.get_mut(part as usize)?;
        if *row == 0 {
            self.rows.push(PartSum { part, ..PartSum::default() });
            *row = self.rows.len() as u32;
        }
        self.rows.get_mut(*row as usize - 1)
    }

    /// Takes the rows, by part.
    fn take(&mut self) -> Vec<PartSum> {
        let mut rows = std::mem::take(&mut self.rows);
        rows.iter().for_each(|row| self.rows_of[row.part as usize] = 0);
        rows.sort_unstable_by_key(|row| row.part);
        rows
    }

    fn is_valid(&self, begun: &PartSums) -> bool {
        let PartSums { rows_of, rows } = self;
        rows_of.len() == begun.rows_of.len()
            && rows_of.iter().all(|&row| row as usize <= rows.len())
            && rows.iter().all(|row| (row.part as usize) < rows_of.len())
    }
}

impl WallSums {
    /// Nothing yet, of the walls that a setup asks sums for.
    pub fn new(model: &Model) -> WallSums {
        let (walls, detail) = (&model.setup.walls, model.setup.wall_sums);
        let count = if detail == WallDetail::Off { 0 } else { walls.len() };
        let parts = |shape: &WallShape| match shape {
            // A plane has no parts but itself.
            WallShape::Plane(_) => 0,
            WallShape::Spheres(_) | WallShape::Mesh(_) if detail != WallDetail::Parts => 0,
            WallShape::Spheres(spheres) => spheres.len(),
            WallShape::Mesh(mesh) => mesh.faces.len(),
        };
        let of = |shape: &WallShape| PartSums { rows_of: vec![0; parts(shape)], rows: Vec::new() };
        let parts = walls[..count].iter().map(|wall| of(&wall.shape)).collect();
        WallSums { since: 0, whole: vec![WallSum::default(); count], parts }
    }

    /// Whether nothing asks for them.
    pub fn none(&self) -> bool {
        self.whole.is_empty()
    }

    /// Ends an instant: its forces on walls are complete.
    pub fn end_instant(&mut self) {
        for wall in &mut self.whole {
            wall.largest = wall.largest.max(wall.now.norm());
            wall.now = Vec3::zeros();
        }
    }

    /// Takes the sums of an interval that ends after `steps` steps of `dt` [s].
    pub fn take(&mut self, steps: u64, dt: f64) -> WallInterval {
        let length = (steps - self.since) as f64 * dt;
        self.since = steps;
        WallInterval {
            length,
            walls: self.whole.iter_mut().map(std::mem::take).collect(),
            parts: self.parts.iter_mut().map(PartSums::take).collect(),
        }
    }

    /// Whether these can be sums of a run that begins with `begun`, after `steps` steps.
    pub fn is_valid(&self, begun: &WallSums, steps: u64) -> bool {
        let WallSums { since, whole, parts } = self;
        *since <= steps
            && whole.len() == begun.whole.len()
            && parts.len() == begun.parts.len()
            && parts.iter().zip(&begun.parts).all(|(own, begun)| own.is_valid(begun))
    }
}
