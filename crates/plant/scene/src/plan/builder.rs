//! A plan in the making: what the steps of this folder read and add to.

use crate::check::Check;
use crate::error::{Result, SceneError};
use crate::input::{InletSource, RunContacts};
use crate::keys::{self, SceneKeys, Side};
use crate::plan::Placing;
use crate::plan::grains::obstacles::Obstacles;
use crate::plan::insertions::insertion::Insertion;
use crate::scene::Scene;
use dem::setup::{self, EntryBonds, Particle, Removal, Zone};
use geom::Shape;
use mesh::Files;
use record::{Map, MaterialRecord, Sizes};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Index and density of a material that particles are made of.
pub(super) struct GrainMaterial {
    pub index: u16,
    /// [kg/m³].
    pub density: f64,
}

/// The record of a wall file for a material of the scene.
pub(super) struct WallMaterial {
    pub index: u16,
    pub record: MaterialRecord,
}

/// An inlet of a plan: a stream, and what its indices are in the scene.
pub struct PlannedInlet {
    /// The stream.
    pub source: InletSource,
    /// Index of the zone.
    pub inlet: u32,
    /// Material of the scene for each of the stream's.
    pub materials: Vec<u16>,
    /// Shape of the scene for each of the stream's; `u32::MAX` of those that do not come.
    pub shapes: Vec<u32>,
}

/// Facts about the files of particles that warnings need.
#[derive(Default)]
pub(super) struct FilesRead {
    /// Particles of files that people wrote.
    pub placed: usize,
    /// Files that give their particles spins.
    pub spinning: Vec<String>,
    /// Particles of runs, by index: they lie as the engine left them.
    pub settled: Vec<Range<usize>>,
    /// Clumps of runs, by index in [`setup::Clumps::placed`].
    pub settled_clumps: Vec<Range<usize>>,
    /// Contact histories of each run.
    pub kept: Vec<RunContacts>,
}

/// A plan in the making.
pub(super) struct PlanBuilder<'a> {
    pub check: Check<'a>,
    pub scene: &'a Scene,
    pub materials: Vec<setup::Material>,
    pub particles: Vec<Particle>,
    /// Clusters by id.
    pub clusters: Vec<(u32, u32)>,
    pub clumps: setup::Clumps,
    pub walls: Vec<setup::Wall>,
    /// Walls that fills keep free of; absent: they do not know the walls.
    pub obstacles: Option<Arc<Obstacles>>,
    pub wall_materials: Vec<WallMaterial>,
    /// Areas of servos, until all walls are known.
    pub servo_areas: Vec<ServoArea>,
    pub outlets: Vec<Zone>,
    pub removals: Vec<Removal>,
    pub inlets: Vec<Zone>,
    /// Materials of particles that come in later.
    pub entry_materials: Vec<u16>,
    /// Bonds that inlets may bring.
    pub entry_bonds: Option<EntryBonds>,
    /// Radii of particles that come in later.
    pub entry_sizes: Option<Sizes>,
    /// The same without members of clumps.
    pub sphere_sizes: Option<Sizes>,
    pub insertions: Vec<Insertion>,
    pub streams: Vec<PlannedInlet>,
    pub read: FilesRead,
    pub warnings: Vec<String>,
    /// [`crate::plan::Plan::places`].
    pub places: Map,
    /// Role and SHA-256 of what was read.
    pub inputs: Vec<(String, String)>,
    /// Hears how far a fill is.
    pub hear: &'a dyn Fn(Placing),
}

impl<'a> PlanBuilder<'a> {
    pub(super) fn new(scene: &'a Scene) -> PlanBuilder<'a> {
        let material = |m: &keys::Material| setup::Material {
            name: m.name.clone(),
            density: m.density.unwrap_or(0.0),
            young: m.young,
            poisson: m.poisson,
        };
        PlanBuilder {
            check: Check { text: &scene.text },
            scene,
            materials: scene.keys.material.iter().map(material).collect(),
            particles: Vec::new(),
            clusters: Vec::new(),
            clumps: setup::Clumps::default(),
            walls: Vec::new(),
            obstacles: None,
            wall_materials: Vec::new(),
            servo_areas: Vec::new(),
            outlets: Vec::new(),
            removals: Vec::new(),
            inlets: Vec::new(),
            entry_materials: Vec::new(),
            entry_bonds: None,
            entry_sizes: None,
            sphere_sizes: None,
            insertions: Vec::new(),
            streams: Vec::new(),
            read: FilesRead::default(),
            warnings: Vec::new(),
            places: Map::new(),
            hear: &|_| (),
            inputs: vec![("scene".to_owned(), stream::sha256(scene.text.toml.as_bytes()))],
        }
    }

    pub(super) fn keys(&self) -> &'a SceneKeys {
        &self.scene.keys
    }

    /// A file that a key of the scene names, relative to the scene's folder, read in this way.
    ///
    /// # Errors
    /// What is wrong with the file; where it cannot be read, at the key that names it.
    pub(super) fn file<T>(&self, key: &str, file: &str, read: impl FnOnce(&Path) -> Result<T>) -> Result<T> {
        read(&self.scene.folder.join(file)).map_err(|error| match error {
            SceneError::Read { name, source } => {
                SceneError::Named { place: self.check.text.place(key), key: key.to_owned(), name, source }
            }
            other => other,
        })
    }

    pub(super) fn shape(&self, key: &str, text: &str) -> Result<Shape> {
        Shape::parse(text, &Files(&self.scene.folder)).map_err(|e| {
            let cure = match text.starts_with("mesh:") {
                true => "give the file of a closed mesh (PLY, STL, OBJ), as seen from the folder of the scene",
                false => "write box:x0,y0,z0,x1,y1,z1, sphere:x,y,z,r, cylinder:x0,y0,z0,x1,y1,z1,r, cone:x0,y0,z0,x1,y1,z1,r0,r1 or mesh:FILE",
            };
            self.check.wrong(key, format!("\"{text}\""), &e.to_string(), cure)
        })
    }

    /// A material that particles are made of.
    pub(super) fn grain(&self, key: &str, name: &str) -> Result<GrainMaterial> {
        let index = self.check.material(key, name, &self.materials)?;
        let density = self.materials[index as usize].density;
        if density > 0.0 {
            return Ok(GrainMaterial { index, density });
        }
        let why = "its density is missing, and particles are made of it";
        Err(self.check.wrong(key, format!("\"{name}\""), why, "add density [kg/m³] to the [[material]]"))
    }

    /// Index of the material that a stream describes; added when the scene does not define it.
    pub(super) fn material_of(&mut self, stream: &str, info: &MaterialRecord) -> Result<u16> {
        let name = &info.name;
        if let Some(at) = self.materials.iter().position(|m| m.name == *name) {
            return Ok(at as u16);
        }
        let (Some(young), Some(poisson)) = (info.young, info.poisson) else {
            let why = format!(
                "its material '{name}' has no Young's modulus or Poisson's ratio, and the scene does not define it"
            );
            let cure = format!("add [[material]] name = \"{name}\" with young and poisson");
            return Err(SceneError::file(stream, why, cure));
        };
        if !(young > 0.0 && young.is_finite() && record::is_poisson(poisson)) {
            let why = format!("its material '{name}' has young = {young} Pa, poisson = {poisson}");
            let cure = format!("give a modulus above 0 and a ratio {}, in the scene", record::POISSON);
            return Err(SceneError::file(stream, why, cure));
        }
        let density = info.density.unwrap_or(0.0);
        self.materials.push(setup::Material { name: name.clone(), density, young, poisson });
        Ok(self.materials.len() as u16 - 1)
    }

    /// The first id that no particle has.
    pub(super) fn next_id(&self) -> u32 {
        let members = |b: &setup::Body| self.clumps.shapes[b.shape as usize].spheres.len() as u32;
        let bodies = self.clumps.placed.iter().map(|b| b.id.saturating_add(members(b)));
        let particles = self.particles.iter().map(|p| p.id.saturating_add(1));
        particles.chain(bodies).max().unwrap_or(0).max(self.keys().first_id)
    }

    /// Radii of all particles.
    pub(super) fn sizes(&self) -> Option<Sizes> {
        let own = self.particles.iter().map(|p| Some(Sizes { smallest: p.radius, largest: p.radius }));
        let members = self.clumps.placed.iter().map(|b| {
            let (least, most) = self.clumps.shapes[b.shape as usize].radii();
            Some(Sizes { smallest: least * b.scale, largest: most * b.scale })
        });
        own.chain(members).fold(self.entry_sizes, Sizes::union)
    }

    /// Adds radii of spheres, or of members of clumps, that come in later.
    pub(super) fn will_enter(&mut self, sizes: Sizes, spheres: bool) {
        self.entry_sizes = Sizes::union(self.entry_sizes, Some(sizes));
        if spheres {
            self.sphere_sizes = Sizes::union(self.sphere_sizes, Some(sizes));
        }
    }

    /// Radius of the sphere that holds the widest clump [m]; 0 without any.
    pub(super) fn widest_clump(&self) -> f64 {
        let shapes = self.clumps.shapes.iter().zip(0u32..);
        let one = |(s, k): (&setup::ClumpShape, u32)| {
            self.clumps.scales_of(k).map(|scale| scale.1).fold(0.0, f64::max) * s.reach()
        };
        shapes.map(one).fold(0.0, f64::max)
    }

    /// Index of a shape, by name.
    pub(super) fn clump(&self, key: &str, name: &str) -> Result<u32> {
        Ok(self.check.named(key, name, "clump", self.keys().clump.iter().map(|c| c.name.as_str()))? as u32)
    }
}

/// A servo whose area lies between walls that are known by name.
pub(super) struct ServoArea {
    /// Index of its wall.
    pub wall: usize,
    /// Its key.
    pub key: String,
    pub sides: [Side; 2],
}
