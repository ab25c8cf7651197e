//! The wall's columns: x y z radius, material, and further attributes.

use super::report::Wall;
use crate::regions::Regions;
use crate::settings::WallError;
use stream::{Table, Values};

impl Wall {
    /// Columns x y z radius [m] (f64), material (u16); roughness [m] when one was asked for; region (u16) and
    /// vx vy vz [m/s] when there are any.
    ///
    /// # Errors
    /// None for a wall as it was built.
    pub fn table(&self, regions: &Regions) -> Result<Table, WallError> {
        let mut table = Table::with_rows(self.radii.len());
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            table.push(name, Values::F64(self.centres.iter().map(|c| c[axis]).collect()))?;
        }
        table.push("radius", Values::F64(self.radii.clone()))?;
        self.push_attributes(&mut table, regions)?;
        Ok(table)
    }

    /// Adds material, roughness, region and velocity, or replaces columns of that name. Whole numbers have 32 bits: some readers of PLY skip `ushort`.
    ///
    /// # Errors
    /// A table with another number of rows.
    pub fn push_attributes(&self, table: &mut Table, regions: &Regions) -> Result<(), WallError> {
        let surface = |r: &u16| &regions.surfaces[*r as usize];
        let column = |f: &dyn Fn(&u16) -> f64| Values::F64(self.regions.iter().map(f).collect());
        table.replace(
            "material",
            Values::U32(self.regions.iter().map(|r| surface(r).material.into()).collect()),
        )?;
        if regions.is_rough() {
            let of = |(i, &r): (usize, &u16)| regions.roughness(i, r).unwrap_or(f64::NAN);
            table.replace("roughness", Values::F64(self.regions.iter().enumerate().map(of).collect()))?;
        }
        if regions.surfaces.len() > 1 {
            table.replace("region", Values::U32(self.regions.iter().map(|&r| r.into()).collect()))?;
        }
        if regions.surfaces.iter().any(|s| s.velocity.norm_squared() > 0.0) {
            for (axis, name) in ["vx", "vy", "vz"].iter().enumerate() {
                table.replace(name, column(&|r| surface(r).velocity[axis]))?;
            }
        }
        Ok(())
    }
}
