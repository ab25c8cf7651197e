//! Wall spheres from a walls MCAP.

use crate::error::{Result, SceneError};
use geom::Vec3;
use record::column::{MATERIAL, POSITION, VELOCITY};
use record::{Columns, MaterialRecord};
use stream::Table;

/// Most velocities of the surface of one stream.
const MOST_VELOCITIES: usize = 100;

/// The wall spheres of one stream.
#[derive(Debug, Clone)]
pub struct WallFile {
    /// Its name, for messages.
    pub name: String,
    /// Its materials, by index.
    pub materials: Vec<MaterialRecord>,
    /// Its spheres.
    pub spheres: Vec<WallSphere>,
    /// Velocities of their surface, which moves on them as that of a belt [m/s].
    pub velocities: Vec<Vec3>,
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
    /// Index of [`WallFile::velocities`].
    pub velocity: u16,
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
        let given = columns.vectors_or_zero(VELOCITY)?;
        let (velocity, velocities) = different(name, &given)?;
        let sphere = |i: usize| WallSphere {
            centre: centres[i],
            radius: radii[i],
            material: material(i),
            velocity: velocity[i],
        };
        let spheres = (0..centres.len()).map(sphere).collect();
        Ok(WallFile { name: name.to_owned(), materials, hash: record::hash(table), spheres, velocities })
    }

    /// Multiplies all lengths, those of velocities too.
    pub fn scale(&mut self, factor: f64) {
        if factor != 1.0 {
            self.spheres
                .iter_mut()
                .for_each(|s| (s.centre, s.radius) = (s.centre * factor, s.radius * factor));
            self.velocities.iter_mut().for_each(|v| *v *= factor);
        }
    }
}

/// The different velocities of a wall's surface [m/s], and the number of each sphere's own; each of them is a separate wall.
fn different(name: &str, given: &[Vec3]) -> Result<(Vec<u16>, Vec<Vec3>)> {
    let mut velocities: Vec<Vec3> = Vec::new();
    let mut of = Vec::with_capacity(given.len());
    for v in given {
        let known = of.last().map(|&k: &u16| k as usize).filter(|&k| velocities[k] == *v);
        let k = known.or_else(|| velocities.iter().position(|known| known == v)).unwrap_or(velocities.len());
        if k == MOST_VELOCITIES {
            let why = format!("its spheres have more than {MOST_VELOCITIES} different velocities");
            let cure =
                "give each region one velocity, or use surface_velocity and surface_rotation in the scene";
            return Err(SceneError::file(name, why, cure));
        }
        if k == velocities.len() {
            velocities.push(*v);
        }
        of.push(k as u16);
    }
    Ok((of, velocities))
}
