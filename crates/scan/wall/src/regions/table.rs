//! Roughness, material and velocity by region: by position, by a column of the cloud, or by both.
//!
//! ```toml
//! roughness = 0.0005             # [m] where no region says otherwise
//! [[region]]                     # the first region that holds a point decides
//! name = "worn"
//! shape = "box:0,-1,-1,1,1,1"
//! roughness = 0.002              # absent keys: as outside of all regions
//! material = "liner"
//! friction = 0.4
//! velocity = [0.1, 0, 0]
//! [[region]]                     # points by a column of the cloud: a class, a colour, an intensity
//! column = "classification"
//! values = [6, 6]                # smallest and largest value, or one value
//! friction = 0.8                # or its values at the two ends: see [`crate::regions::steps`]
//! ```
//!
//! With a section `[wear]` (see [`crate::regions::wear`]) the roughness of points that no region with a roughness of its own holds comes from a
//! table of wear and position.

use super::attributes::{AttributeError, check_material, check_velocity};
use super::error::RegionsError;
use super::steps::{OneOrTwo, Region, Stepped};
use super::wear::{self, Wear, WearReport};
use geom::{Vec3, mesh::TriMesh, shape::Shape};
use rayon::prelude::*;
use record::MaterialRecord;
use serde::Deserialize;

/// What a region's surface is like.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceAttributes {
    /// Name of the region; empty outside of all.
    pub name: String,
    /// Depth of the dents between neighbouring spheres ζ [m]; `None` when only radii are given.
    pub roughness: Option<f64>,
    /// Its material, as an index in [`Regions::materials`].
    pub material: u16,
    /// Velocity [m/s].
    pub velocity: Vec3,
    /// Whether a table of wear, where there is one, says the roughness instead.
    pub worn: bool,
}

/// All regions: the first surface is that of the points in none of them.
#[derive(Debug)]
pub struct Regions {
    pub materials: Vec<MaterialRecord>,
    /// Surfaces; number 0 is outside of all regions.
    pub surfaces: Vec<SurfaceAttributes>,
    /// Properties that change along a column.
    pub stepped: Vec<Stepped>,
    places: Vec<RegionPlace>,
    wear: Option<Wear>,
    /// Roughness of each point [m] by the table of wear.
    worn: Vec<f64>,
}

/// Which points a region holds: those that meet all conditions.
#[derive(Debug)]
struct RegionPlace {
    shape: Option<Shape>,
    column: Option<ColumnRange>,
    /// Whether the column of each point is in the range; empty before it was looked up.
    in_range: Vec<bool>,
}

/// Values of a column of the cloud.
#[derive(Debug)]
struct ColumnRange {
    name: String,
    values: [f64; 2],
    /// Of all steps together.
    whole: [f64; 2],
    /// Number and name of the region, for messages.
    place: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    roughness: Option<f64>,
    #[serde(default)]
    region: Vec<Region>,
    wear: Option<wear::Section>,
}

impl Region {
    fn place(&self, number: usize, load: wear::Load<TriMesh>) -> Result<RegionPlace, RegionsError> {
        let place = format!("region {number} '{}'", self.name);
        let shape = self.shape.as_ref().map(|text| Shape::parse(text, &load)).transpose();
        let shape = shape.map_err(|source| RegionsError::Shape {
            number,
            name: self.name.clone(),
            source: Box::new(source),
        })?;
        let column = match (&self.column, &self.values) {
            (None, None) if shape.is_none() => return Err(RegionsError::NoPlace { place }),
            (None, None) => None,
            (Some(_), None) => {
                return Err(RegionsError::HalfColumn { place, given: "column", missing: "values" });
            }
            (None, Some(_)) => {
                return Err(RegionsError::HalfColumn { place, given: "values", missing: "column" });
            }
            (Some(name), Some(values)) => {
                let values = match *values {
                    OneOrTwo::One(value) => [value; 2],
                    OneOrTwo::Two(values) => values,
                };
                if !(values[0] <= values[1]) {
                    return Err(RegionsError::Values { place, values });
                }
                Some(ColumnRange { name: name.clone(), values, whole: self.whole.unwrap_or(values), place })
            }
        };
        Ok(RegionPlace { shape, column, in_range: Vec::new() })
    }
}

impl RegionPlace {
    /// Looks up which points have a value in the range; `property` gives a column of the cloud.
    fn look_up(&mut self, property: &dyn Fn(&str) -> Option<Vec<f64>>) -> Result<(), RegionsError> {
        let Some(ColumnRange { name, values, whole, place }) = &self.column else { return Ok(()) };
        let (column, place) = (name.clone(), place.clone());
        let Some(own) = property(name) else { return Err(RegionsError::NoColumn { place, column }) };
        self.in_range = own.iter().map(|v| (values[0]..=values[1]).contains(v)).collect();
        let is_in = |v: &f64| (whole[0]..=whole[1]).contains(v);
        if own.iter().any(is_in) {
            return Ok(());
        }
        let ends = |[low, high]: [f64; 2], v: &f64| [low.min(*v), high.max(*v)];
        let found = own.iter().fold([f64::INFINITY, f64::NEG_INFINITY], ends);
        Err(RegionsError::NoneInRange { place, column, values: *whole, found })
    }

    fn holds(&self, p: &Vec3, index: u32) -> bool {
        self.shape.as_ref().is_none_or(|s| s.contains(p))
            && (self.column.is_none() || self.in_range.get(index as usize) == Some(&true))
    }
}

impl Regions {
    /// One surface everywhere.
    ///
    /// # Errors
    /// Values outside their ranges.
    pub fn one(
        roughness: Option<f64>,
        material: MaterialRecord,
        velocity: Vec3,
    ) -> Result<Regions, RegionsError> {
        check_material(&material, "material")?;
        check_velocity(&velocity, "velocity")?;
        check_roughness(roughness, "roughness")?;
        let surface = SurfaceAttributes { name: String::new(), roughness, material: 0, velocity, worn: true };
        let (materials, surfaces) = (vec![material], vec![surface]);
        let stepped = Vec::new();
        Ok(Regions { materials, surfaces, stepped, places: Vec::new(), wear: None, worn: Vec::new() })
    }

    /// Regions of a TOML text, and what holds outside of them; `load` reads the file of a shape `mesh:FILE`, and `read` the text of
    /// a table of wear.
    ///
    /// # Errors
    /// Text that is no such table, shapes that cannot be read, values outside their ranges.
    pub fn parse(
        text: &str,
        material: MaterialRecord,
        velocity: Vec3,
        load: wear::Load<TriMesh>,
        read: wear::Load<String>,
    ) -> Result<Regions, RegionsError> {
        let file: File = toml::from_str(text)?;
        let mut regions = Regions::one(file.roughness, material, velocity)?;
        regions.wear = file.wear.map(|section| Wear::new(section, read, load)).transpose()?;
        let outside = regions.materials[0].name.clone();
        for (number, region) in (1..).zip(file.region) {
            let place = format!("region {number} '{}'", region.name);
            for step in region.steps(&place, &outside, &mut regions.stepped)? {
                regions.places.push(step.place(number, load)?);
                regions.add(number, step)?;
            }
        }
        if regions.surfaces.len() > u16::MAX as usize {
            return Err(RegionsError::TooMany);
        }
        Ok(regions)
    }

    fn add(&mut self, number: usize, region: Region) -> Result<(), RegionsError> {
        let place = format!("region {number} '{}'", region.name);
        let outside = self.surfaces[0].clone();
        let own = region.roughness.map(OneOrTwo::first);
        check_roughness(own, &place)?;
        let velocity = region.velocity.map_or(outside.velocity, Vec3::from);
        check_velocity(&velocity, &place)?;
        let material = self.material(&region, &place)?;
        let (roughness, worn) = (own.or(outside.roughness), own.is_none());
        self.surfaces.push(SurfaceAttributes { name: region.name, roughness, material, velocity, worn });
        Ok(())
    }

    /// The number of the region's material; a new one when its values are new.
    fn material(&mut self, region: &Region, place: &str) -> Result<u16, RegionsError> {
        let outside = &self.materials[0];
        let [young, poisson, friction, restitution] =
            [region.young, region.poisson, region.friction, region.restitution]
                .map(|v| v.map(OneOrTwo::first));
        let own = young.or(poisson).or(friction).or(restitution).is_some();
        let named = region.material.clone();
        let name = named.unwrap_or_else(|| match own {
            true if !region.name.is_empty() => format!("{}-{}", outside.name, region.name),
            _ => outside.name.clone(),
        });
        let known = self.materials.iter().find(|m| m.name == name);
        let base = known.unwrap_or(outside);
        let material = MaterialRecord {
            density: None,
            young: young.or(base.young),
            poisson: poisson.or(base.poisson),
            friction: friction.or(base.friction),
            restitution: restitution.or(base.restitution),
            name,
        };
        check_material(&material, place)?;
        match self.materials.iter().position(|m| m.name == material.name) {
            Some(at) if self.materials[at] == material => Ok(at as u16),
            Some(_) => {
                Err(AttributeError::TwoOfOneName { place: place.to_owned(), name: material.name }.into())
            }
            None => {
                self.materials.push(material);
                Ok(self.materials.len() as u16 - 1)
            }
        }
    }

    /// Looks up the columns of regions, and asks the table of wear, when there is one, for the roughness of each point [m]; `property`
    /// gives a column of the cloud.
    ///
    /// # Errors
    /// No such property; a range of values that no point has; points without a measurement when no roughness holds outside.
    pub fn measure(
        &mut self,
        points: &[Vec3],
        property: &dyn Fn(&str) -> Option<Vec<f64>>,
    ) -> Result<Option<WearReport>, RegionsError> {
        self.places.iter_mut().try_for_each(|place| place.look_up(property))?;
        let Some(wear) = &self.wear else { return Ok(None) };
        let (worn, report) = wear.roughness(points, property, self.surfaces[0].roughness)?;
        self.worn = worn;
        Ok(Some(report))
    }

    /// Roughness of a point in a region [m]: the region's own, the one by wear, or the one that holds outside.
    pub fn roughness(&self, point: usize, region: u16) -> Option<f64> {
        let surface = &self.surfaces[region as usize];
        let worn = self.worn.get(point).copied().filter(|_| surface.worn);
        worn.or(surface.roughness)
    }

    /// The least roughness of any region [m].
    pub fn least_roughness(&self) -> Option<f64> {
        let all = self.surfaces.iter().filter_map(|s| s.roughness);
        all.reduce(f64::min)
    }

    /// Whether any point may have a roughness.
    pub fn is_rough(&self) -> bool {
        !self.worn.is_empty() || self.surfaces.iter().any(|s| s.roughness.is_some())
    }

    /// The surface of each point [m], whose numbers in the cloud are `index`: the first region that holds it, else 0.
    pub fn of(&self, points: &[Vec3], index: &[u32]) -> Vec<u16> {
        let first = |(p, &index): (&Vec3, &u32)| {
            self.places.iter().position(|s| s.holds(p, index)).map_or(0, |at| at as u16 + 1)
        };
        points.par_iter().zip(index).map(first).collect()
    }
}

fn check_roughness(roughness: Option<f64>, place: &str) -> Result<(), RegionsError> {
    match roughness {
        Some(value) if !(value > 0.0 && value.is_finite()) => {
            Err(RegionsError::Roughness { place: place.to_owned(), value })
        }
        _ => Ok(()),
    }
}
