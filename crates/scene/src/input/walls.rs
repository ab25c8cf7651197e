//! Wall spheres from a walls MCAP.

use crate::columns::Columns;
use crate::error::SceneError;
use crate::material_info::MaterialInfo;
use geom::Vec3;
use sha2::{Digest, Sha256};
use stream::Table;

/// The wall spheres of one stream.
#[derive(Debug, Clone)]
pub struct WallFile {
    /// Its name, for messages.
    pub name: String,
    /// What it says of its materials, by index.
    pub materials: Vec<MaterialInfo>,
    /// Centre [m], radius [m], index of `materials`.
    pub spheres: Vec<(Vec3, f64, u16)>,
    /// Velocity of all of them [m/s].
    pub velocity: Vec3,
    /// SHA-256 of the spheres, whatever the stream was packed like.
    pub hash: String,
}

impl WallFile {
    /// Takes the table of the topic `/walls`.
    ///
    /// # Errors
    /// Columns that are missing or wrong; spheres that move one by one.
    pub(crate) fn new(
        name: &str,
        table: &Table,
        materials: Vec<MaterialInfo>,
    ) -> Result<WallFile, SceneError> {
        let columns = Columns { name, table };
        let centres = columns.vectors(["x", "y", "z"])?;
        let radii = columns.radii()?;
        if centres.is_empty() {
            return Err(SceneError::file(name, "has no wall sphere", "check the tool that made it"));
        }
        let materials = if materials.is_empty() {
            vec![MaterialInfo { name: "wall".into(), ..MaterialInfo::default() }]
        } else {
            materials
        };
        let material = columns.indices("material", materials.len() as f64 - 1.0)?;
        let material = |row: usize| material.as_ref().map_or(0, |m| m[row] as u16);
        let spheres =
            centres.iter().zip(&radii).enumerate().map(|(i, (c, r))| (*c, *r, material(i))).collect();
        let velocities = columns.vectors_or_zero(["vx", "vy", "vz"])?;
        let velocity = velocities[0];
        if let Some(row) = velocities.iter().position(|v| *v != velocity) {
            let why = format!("its spheres have different velocities (rows 0 and {row})");
            let cure = "not available yet: give the wall a 'motion' in the scene, or one velocity";
            return Err(SceneError::file(name, why, cure));
        }
        Ok(WallFile { name: name.to_owned(), materials, hash: hash(table), spheres, velocity })
    }
}

/// SHA-256 over names and values of columns.
pub(crate) fn hash(table: &Table) -> String {
    let mut sum = Sha256::new();
    for column in table.columns() {
        sum.update(column.name.as_bytes());
        for row in 0..table.rows() {
            sum.update(column.values.get(row).to_le_bytes());
        }
    }
    sum.finalize().iter().map(|b| format!("{b:02x}")).collect()
}
