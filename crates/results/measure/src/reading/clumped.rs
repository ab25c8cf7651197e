//! Rigid clumps of a frame: each is one grain, and its spheres share its mass.
//!
//! ```text
//! m_i = M r_i³ / Σ r³        share_i = m_i / (ρ_i V_i)        M: mass of the clump, V_i: volume of the ball i
//! ```
//!
//! So sums over spheres give the mass of the clump, whose spheres overlap and leave a part of it uncovered.

use crate::MeasureError;
use crate::reading::frame::{Frame, mass};
use crate::reading::table::Columns;
use geom::Vec3;
use record::column::{BODY, ID, MASS, POSITION, VELOCITY};
use record::topic::{BODIES, PARTICLES};
use std::collections::HashMap;
use stream::Table;

/// Rigid clumps, in the order of their message, and the spheres of them that were found.
struct Clumps {
    id: Vec<u64>,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    mass: Vec<f64>,
    /// Σ r³ of the spheres [m³], and the row of one of them.
    cubes: Vec<f64>,
    first: Vec<Option<usize>>,
}

impl Frame {
    /// Whether rows may belong to clumps, whose message follows.
    pub(crate) fn has_members(&self) -> bool {
        self.table.get(BODY).is_some()
    }

    /// The grain that each row belongs to: its clump, or itself.
    pub fn body(&self) -> Vec<u64> {
        self.table
            .get(BODY)
            .map_or_else(|| self.id.clone(), |b| b.to_f64().into_iter().map(|b| b as u64).collect())
    }

    /// Its grains: a clump is one of them, at its centre of mass and as large as a ball of its mass.
    pub fn grains(&self) -> &Frame {
        self.clumped.as_deref().unwrap_or(self)
    }

    /// Centre [m] of the grain that each row belongs to: of the ball, or the centre of mass of its clump.
    pub fn grain_centres(&self) -> Vec<Vec3> {
        let grains = self.grains();
        let centres: HashMap<u64, &Vec3> = grains.id.iter().copied().zip(&grains.position).collect();
        let rows = self.body().into_iter().zip(&self.position);
        rows.map(|(body, own)| **centres.get(&body).unwrap_or(&own)).collect()
    }

    /// Volume of row `row` over that of its ball [–]: spheres of a clump overlap.
    pub fn share(&self, row: usize) -> f64 {
        self.shares.get(row).copied().unwrap_or(1.0)
    }

    /// With the clumps of the message that follows; `densities` [kg/m³] are by material.
    ///
    /// # Errors
    /// A message that lacks columns, or a clump of which there are spheres.
    pub(crate) fn with_clumps(mut self, table: &Table, densities: &[f64]) -> Result<Frame, MeasureError> {
        let columns = Columns { topic: BODIES, time: self.time, table };
        let id = columns.whole(ID)?;
        let count = id.len();
        let mut clumps = Clumps {
            position: columns.vectors(POSITION)?,
            velocity: columns.vectors(VELOCITY)?,
            mass: columns.positive(MASS)?,
            cubes: vec![0.0; count],
            first: vec![None; count],
            id,
        };
        let places: HashMap<u64, usize> = clumps.id.iter().enumerate().map(|(k, id)| (*id, k)).collect();
        let bodies = self.body();
        let of: Vec<Option<usize>> = bodies.iter().map(|body| places.get(body).copied()).collect();
        if let Some(row) = (0..self.len()).find(|&row| of[row].is_none() && bodies[row] != self.id[row]) {
            let why = format!("the clump of sphere {} is not in {BODIES}", self.id[row]);
            return Err(MeasureError::Message { topic: PARTICLES.to_owned(), time: self.time, why });
        }
        for (row, k) in of.iter().enumerate().filter_map(|(row, k)| Some((row, (*k)?))) {
            clumps.cubes[k] += self.radius[row].powi(3);
            clumps.first[k].get_or_insert(row);
        }
        self.shares = vec![1.0; self.len()];
        for (row, k) in of.iter().enumerate().filter_map(|(row, k)| Some((row, (*k)?))) {
            self.mass[row] = clumps.mass[k] * self.radius[row].powi(3) / clumps.cubes[k];
            self.shares[row] = self.mass[row] / mass(self.material[row], self.radius[row], densities);
        }
        let mut grains = self.only(|row| of[row].is_none());
        for k in 0..count {
            let Some(row) = clumps.first[k] else { continue };
            grains.id.push(clumps.id[k]);
            grains.position.push(clumps.position[k]);
            grains.velocity.push(clumps.velocity[k]);
            grains.radius.push((self.share(row) * clumps.cubes[k]).cbrt());
            grains.material.push(self.material[row]);
            grains.mass.push(clumps.mass[k]);
        }
        self.clumped = Some(Box::new(grains));
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball;
    use stream::Values;

    /// A clump of two spheres that overlap, and a ball beside it.
    #[test]
    fn spheres_of_a_clump_share_its_mass_and_are_one_grain() {
        let table = |columns: &[(&str, &[f64])]| {
            let mut table = Table::default();
            columns.iter().for_each(|(name, values)| table.push(name, Values::F64(values.to_vec())).unwrap());
            table
        };
        let frame = Frame {
            id: vec![0, 1, 2],
            position: vec![Vec3::zeros(), Vec3::x(), Vec3::y()],
            velocity: vec![Vec3::zeros(); 3],
            radius: vec![1.0, 2.0, 1.0],
            material: vec![0; 3],
            mass: [1.0, 8.0, 1.0].map(|cube| cube * 1000.0 * ball::volume(1.0)).to_vec(),
            table: table(&[(BODY, &[9.0, 9.0, 2.0])]),
            ..Frame::default()
        };
        let unit = 1000.0 * ball::volume(1.0);
        let place: [(&str, &[f64]); 6] =
            [("x", &[0.5]), ("y", &[0.0]), ("z", &[0.0]), ("vx", &[1.0]), ("vy", &[2.0]), ("vz", &[3.0])];
        let clump = table(&[&[(ID, &[9.0][..]), (MASS, &[4.5 * unit][..])][..], &place].concat());
        let found = frame.with_clumps(&clump, &[1000.0]).unwrap();
        assert!((found.mass[0] - 0.5 * unit).abs() < 1e-9 && (found.mass[1] - 4.0 * unit).abs() < 1e-9);
        assert!((found.share(1) - 0.5).abs() < 1e-12 && found.share(2) == 1.0);
        let grains = found.grains();
        assert_eq!(grains.id, [2, 9]);
        assert_eq!(grains.velocity[1], Vec3::new(1.0, 2.0, 3.0));
        assert!((grains.radius[1] - 4.5_f64.cbrt()).abs() < 1e-12, "a ball of its mass");
    }
}
