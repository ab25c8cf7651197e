//! A library of stones: closed meshes with names, size classes and sieve sizes.
//!
//! A name rock_N_H says that the stone is number H of size class N.

use crate::shape::ShapeMeasures;
use crate::stone::{Stone, StoneError};
use geom::Vec3;
use geom::mesh::TriMesh;
use rayon::prelude::*;
use thiserror::Error;

/// One stone of a library.
#[derive(Debug, Clone)]
pub struct LibraryStone {
    /// Its name: that of its file without the ending.
    pub name: String,
    /// N of rock_N_H.
    pub class: Option<u32>,
    /// The mesh.
    pub stone: Stone,
    pub shape: ShapeMeasures,
    /// Radius of the sphere about the centre of mass that encloses it [m].
    pub reach: f64,
    /// Radius of the sphere about the centre of mass that is inside of it [m]; 0 if the centre is outside.
    pub inner: f64,
}

/// Stones, in the order of their names.
#[derive(Debug, Clone)]
pub struct Library {
    pub stones: Vec<LibraryStone>,
}

/// Why meshes are not a library.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LibraryError {
    #[error("the library has no mesh: give a folder of closed meshes (PLY, STL, OBJ)")]
    Empty,
    #[error("{name}: {why}")]
    Stone { name: String, why: StoneError },
}

impl Library {
    /// Checks and measures named meshes [m].
    ///
    /// # Errors
    /// No mesh; one that is not a stone.
    pub fn new(mut meshes: Vec<(String, TriMesh)>, units_given: bool) -> Result<Library, LibraryError> {
        if meshes.is_empty() {
            return Err(LibraryError::Empty);
        }
        meshes.sort_by(|a, b| a.0.cmp(&b.0));
        let one = |(name, mesh): (String, TriMesh)| {
            let stone = Stone::new(&mesh, units_given);
            let stone = stone.map_err(|why| LibraryError::Stone { name: name.clone(), why })?;
            let (shape, reach, centre) = (ShapeMeasures::of(&stone), stone.reach(), stone.moments.centre);
            let inner = if stone.inside.contains(&centre) { stone.inside.distance(&centre) } else { 0.0 };
            Ok(LibraryStone { class: class_of(&name), name, stone, shape, reach, inner })
        };
        let stones: Result<Vec<_>, _> = meshes.into_par_iter().map(one).collect();
        Ok(Library { stones: stones? })
    }
}

impl LibraryStone {
    /// The vertices about the centre of mass [m].
    pub fn arms(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.stone.mesh.vertices.iter().map(|v| v - self.stone.moments.centre)
    }
}

/// N of rock_N_H.
fn class_of(name: &str) -> Option<u32> {
    let (class, number) = name.strip_prefix("rock_")?.split_once('_')?;
    number.parse::<u32>().ok()?;
    class.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_read_from_names() {
        assert_eq!(class_of("rock_3_12"), Some(3));
        for name in ["rock_3", "stone_3_12", "rock_a_1", "rock_3_x", "boulder"] {
            assert_eq!(class_of(name), None, "{name}");
        }
    }
}
