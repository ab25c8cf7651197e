//! What an insertion inserts: spheres, or clumps in place of the spheres that hold them.

use crate::keys::Diameter;
use dem::setup::ClumpShape;
use geom::sphere::volume;

/// Index and density of a material that particles are made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct GrainMaterial {
    pub index: u16,
    /// [kg/m³].
    pub density: f64,
}

/// Spheres, or clumps as the spheres that hold them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inserted {
    /// Diameters of the spheres [m].
    pub diameter: Diameter,
    /// Index of the material.
    pub material: u16,
    /// Mass over the volume of the sphere [kg/m³].
    pub density: f64,
    /// Of clumps: their shape.
    pub clump: Option<InsertedClump>,
    /// Ids that each takes.
    pub ids: u32,
}

/// The shape of inserted clumps.
#[derive(Debug, Clone, Copy)]
pub(super) struct InsertedClump {
    /// Index of the shape.
    pub shape: u32,
    /// Diameter of the sphere that holds it at scale 1 [m].
    pub size: f64,
}

impl Inserted {
    pub(super) fn spheres(diameter: Diameter, material: GrainMaterial) -> Inserted {
        Inserted { diameter, material: material.index, density: material.density, clump: None, ids: 1 }
    }

    /// Clumps of the shape with this index, in a range of scales; `density` is that of their material [kg/m³].
    pub(super) fn clumps(index: u32, shape: &ClumpShape, scale: Diameter, density: f64) -> Inserted {
        let size = 2.0 * shape.reach();
        Inserted {
            diameter: Diameter { low: scale.low * size, high: scale.high * size },
            material: shape.material,
            density: shape.mass(1.0, density) / volume(shape.reach()),
            clump: Some(InsertedClump { shape: index, size }),
            ids: shape.spheres.len() as u32,
        }
    }
}
