//! Wall spheres from a walls MCAP.

use crate::error::{Result, SceneError};
use geom::Vec3;
use record::column::{MATERIAL, POSITION, VELOCITY};
use record::{Columns, MaterialRecord};
use stream::Table;

/// The wall spheres of one stream.
#[derive(Debug, Clone)]
pub struct WallFile {
    /// Its name, for messages.
    pub name: String,
    /// Its materials, by index.
    pub materials: Vec<MaterialRecord>,
    /// Its spheres.
    pub spheres: Vec<WallSphere>,
    /// Velocity of all of them [m/s].
    pub velocity: Vec3,
    /// SHA-256 of the columns; packing and compression do not change it.
    pub hash: String,
}

/// One wall sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallSphere {
    /// Centre [m].
    pub centre: Vec3,
    /// Radius [m].
    pub radius: f64,
    /// Index of [`WallFile::materials`].
    pub material: u16,
}

impl WallFile {
    /// Takes the table of the topic `/walls`.
    ///
    /// # Errors
    /// Columns that are missing or wrong; spheres that move one by one.
    pub(super) fn new(name: &str, table: &Table, mut materials: Vec<MaterialRecord>) -> Result<WallFile> {
        let columns = Columns { name, table };
        let centres = columns.vectors(POSITION)?;
        let radii = columns.radii()?;
        if centres.is_empty() {
            return Err(SceneError::file(name, "has no wall sphere", "check the tool that made it"));
        }
        if materials.is_empty() {
            materials.push(MaterialRecord { name: "wall".into(), ..MaterialRecord::default() });
        }
        let material = columns.indices(MATERIAL, materials.len() as f64 - 1.0)?;
        let material = |row: usize| material.as_ref().map_or(0, |m| m[row] as u16);
        let sphere = |i: usize| WallSphere { centre: centres[i], radius: radii[i], material: material(i) };
        let spheres = (0..centres.len()).map(sphere).collect();
        let velocities = columns.vectors_or_zero(VELOCITY)?;
        let velocity = velocities[0];
        if let Some(row) = velocities.iter().position(|v| *v != velocity) {
            let why = format!("its spheres have different velocities (rows 0 and {row})");
            let cure = "not available yet: give the wall a 'motion' in the scene, or one velocity";
            return Err(SceneError::file(name, why, cure));
        }
        Ok(WallFile { name: name.to_owned(), materials, hash: record::hash(table), spheres, velocity })
    }
}
