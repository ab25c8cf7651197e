//! A scene with everything it names: what the engine is made of, and what feeds it.

use crate::check::Check;
use crate::crossings::Sizes;
use crate::error::SceneError;
use crate::faucet::Faucet;
use crate::inlet::InletStream;
use crate::input::Input;
use crate::material_info::MaterialInfo;
use crate::model::{Arithmetic, DragLaw, Model, OrAuto};
use crate::wall_file::WallFile;
use crate::{Scene, bonds, contacts, fill, particle_file, walls};
use dem::setup::{self, EntryBonds, Guards, Particle, Setup, Step, Zone};
use geom::{Shape, Vec3};
use std::path::PathBuf;

/// Everything that a run needs.
pub struct Plan {
    /// For the engine.
    pub setup: Setup,
    /// Which measured curve the time step relies on, when the scene asks for an accuracy.
    pub step: Option<String>,
    /// Faucets and inlet streams.
    pub(crate) feeds: Feeds,
    /// What was left out or overruled, for the user to know.
    pub notes: Vec<String>,
    /// Role and SHA-256 of what was read.
    pub inputs: Vec<(String, String)>,
    /// Radii of all particles of the run; `None` when there are none.
    pub sizes: Option<Sizes>,
}

/// Density of materials that no particle is made of [kg/m³].
pub(crate) const NO_DENSITY: f64 = f64::MIN_POSITIVE;

/// Where particles come from while the run goes on.
pub(crate) struct Feeds {
    pub faucets: Vec<Faucet>,
    pub streams: Vec<InletStream>,
}

/// A plan in the making.
pub(crate) struct Draft<'a> {
    pub check: Check<'a>,
    pub scene: &'a Scene,
    pub materials: Vec<setup::Material>,
    pub particles: Vec<Particle>,
    pub clumps: setup::Clumps,
    pub walls: Vec<setup::Wall>,
    /// What wall files say of a material.
    pub wall_infos: Vec<(u16, MaterialInfo)>,
    pub outlets: Vec<Zone>,
    pub inlets: Vec<Zone>,
    pub entry_materials: Vec<u16>,
    /// Bonds that inlets may bring.
    pub entry_bonds: Option<EntryBonds>,
    pub entry_sizes: Option<Sizes>,
    /// The like without members of clumps.
    pub sphere_sizes: Option<Sizes>,
    pub feeds: Feeds,
    pub read: crate::doubts::Read,
    pub notes: Vec<String>,
    pub inputs: Vec<(String, String)>,
}

impl Scene {
    /// Reads what the scene names, places its particles, and makes everything ready to run.
    /// `given` are the streams of the command line.
    ///
    /// # Errors
    /// Whatever does not fit together, with key, value and cure.
    pub fn plan(&self, given: Vec<Input>) -> Result<Plan, SceneError> {
        let mut draft = Draft::new(self);
        let (mut wall_files, mut streams): (Vec<WallFile>, Vec<InletStream>) = (Vec::new(), Vec::new());
        for input in given {
            match input {
                Input::Walls(file) if wall_files.iter().any(|w| w.hash == file.hash) => {
                    return Err(SceneError::file(&file.name, "is given twice", "leave one out"));
                }
                Input::Walls(file) => wall_files.push(file),
                Input::Inlet(stream) => streams.push(*stream),
            }
        }
        draft.shapes()?;
        draft.particles()?;
        walls::add(&mut draft, &self.model.wall, wall_files)?;
        draft.inlets(streams)?;
        draft.faucets()?;
        draft.outlets()?;
        draft.finish()
    }

    /// Radius of the sphere that holds each clump at scale 1 [m], in the order of the scene.
    ///
    /// # Errors
    /// A shape that is none.
    pub(crate) fn clump_reaches(&self) -> Result<Vec<f64>, SceneError> {
        let mut draft = Draft::new(self);
        draft.shapes()?;
        Ok(draft.clumps.shapes.iter().map(setup::ClumpShape::reach).collect())
    }

    /// [`Scene::plan`], for those who only want the engine's part.
    ///
    /// # Errors
    /// As there.
    pub fn setup(&self, given: Vec<Input>) -> Result<Setup, SceneError> {
        Ok(self.plan(given)?.setup)
    }
}

impl<'a> Draft<'a> {
    fn new(scene: &'a Scene) -> Draft<'a> {
        let material = |m: &crate::model::Material| setup::Material {
            name: m.name.clone(),
            density: m.density.unwrap_or(0.0),
            young: m.young,
            poisson: m.poisson,
        };
        Draft {
            check: Check { text: &scene.text },
            scene,
            materials: scene.model.material.iter().map(material).collect(),
            particles: Vec::new(),
            clumps: setup::Clumps::default(),
            walls: Vec::new(),
            wall_infos: Vec::new(),
            outlets: Vec::new(),
            inlets: Vec::new(),
            entry_materials: Vec::new(),
            entry_bonds: None,
            entry_sizes: None,
            sphere_sizes: None,
            feeds: Feeds { faucets: Vec::new(), streams: Vec::new() },
            read: crate::doubts::Read::default(),
            notes: Vec::new(),
            inputs: vec![("scene".to_owned(), crate::sha256(&scene.text.toml))],
        }
    }

    pub(crate) fn model(&self) -> &'a Model {
        &self.scene.model
    }

    /// A file that the scene names, relative to the scene's folder.
    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.scene.folder.join(file)
    }

    pub(crate) fn shape(&self, key: &str, text: &str) -> Result<Shape, SceneError> {
        let load = |file: &str| crate::mesh_file::read(&self.path(file)).map_err(|e| e.to_string());
        Shape::parse(text, &load).map_err(|e| {
            self.check.wrong(
                key,
                format!("\"{text}\""),
                &e.to_string(),
                "write box:x0,y0,z0,x1,y1,z1, sphere:x,y,z,r or cylinder:x0,y0,z0,x1,y1,z1,r",
            )
        })
    }

    /// Index and density of a material that particles are made of.
    pub(crate) fn grain(&self, key: &str, name: &str) -> Result<(u16, f64), SceneError> {
        let index = self.check.material(key, name, &self.materials)?;
        let density = self.materials[index as usize].density;
        if density > 0.0 {
            return Ok((index, density));
        }
        let why = "its density is missing, and particles are made of it";
        Err(self.check.wrong(key, format!("\"{name}\""), why, "add density [kg/m³] to the [[material]]"))
    }

    /// Index of the material that a stream describes; made when the scene does not define it.
    pub(crate) fn material_of(&mut self, stream: &str, info: &MaterialInfo) -> Result<u16, SceneError> {
        if let Some(at) = self.materials.iter().position(|m| m.name == info.name) {
            return Ok(at as u16);
        }
        let (Some(young), Some(poisson)) = (info.young, info.poisson) else {
            let why = format!(
                "its material '{}' has no Young's modulus or Poisson's ratio, and the scene does not define it",
                info.name
            );
            let cure = format!("add [[material]] name = \"{}\" with young and poisson", info.name);
            return Err(SceneError::file(stream, why, cure));
        };
        let wrong = !(young > 0.0 && young.is_finite() && (0.0..0.5).contains(&poisson));
        if wrong {
            let why = format!("its material '{}' has young = {young} Pa, poisson = {poisson}", info.name);
            return Err(SceneError::file(stream, why, "define the material in the scene"));
        }
        self.materials.push(setup::Material {
            name: info.name.clone(),
            density: info.density.unwrap_or(0.0),
            young,
            poisson,
        });
        Ok(self.materials.len() as u16 - 1)
    }

    pub(crate) fn next_id(&self) -> u32 {
        let members = |b: &setup::Body| self.clumps.shapes[b.shape as usize].spheres.len() as u32;
        let bodies = self.clumps.bodies.iter().map(|b| b.id.saturating_add(members(b)));
        let particles = self.particles.iter().map(|p| p.id.saturating_add(1));
        particles.chain(bodies).max().unwrap_or(0).max(self.model().first_id)
    }

    fn particles(&mut self) -> Result<(), SceneError> {
        for (i, entry) in self.model().particles.iter().enumerate() {
            if let Some(clump) = &entry.clump {
                self.body_file(&format!("particles.{i}"), &entry.source, clump)?;
                continue;
            }
            let file = particle_file::read(&self.path(&entry.source))?;
            self.inputs.push(("particles".to_owned(), file.hash.clone()));
            self.notes.extend(file.note.clone());
            self.read.file(&entry.source, &file, self.particles.len());
            let key = format!("particles.{i}.material");
            let materials: Vec<u16> = match (&entry.material, &file.materials[..]) {
                (Some(name), _) => vec![self.grain(&key, name)?.0],
                (None, []) => {
                    let why = "is missing, and the file names none";
                    return Err(self.check.wrong(&key, "(nothing)", why, "add material = \"…\""));
                }
                (None, named) => {
                    let mut all = Vec::new();
                    for info in named {
                        all.push(self.material_of(&entry.source, info)?);
                    }
                    all
                }
            };
            let first = self.next_id();
            for (n, mut p) in file.particles.into_iter().enumerate() {
                p.material =
                    if entry.material.is_some() { materials[0] } else { materials[p.material as usize] };
                p.id = if file.has_ids { p.id } else { first.wrapping_add(n as u32) };
                self.particles.push(p);
            }
        }
        self.bodies()?;
        for (i, entry) in self.model().fill.iter().enumerate() {
            let shape = self.shape(&format!("fill.{i}.shape"), &entry.shape)?;
            if let Some(clump) = &entry.clump {
                self.fill_bodies(i, entry, clump, &shape)?;
                continue;
            }
            let material = self.grain(&format!("fill.{i}.material"), &entry.material)?;
            let (first, taken) = (self.next_id(), self.taken());
            self.particles.extend(fill::fill(&self.check, i, entry, &shape, material, first, &taken)?);
        }
        Ok(())
    }

    pub(crate) fn sizes(&self) -> Option<Sizes> {
        let own = self.particles.iter().map(|p| Some(Sizes { smallest: p.radius, largest: p.radius }));
        let members = self.clumps.bodies.iter().map(|b| {
            let (least, most) = self.clumps.shapes[b.shape as usize].radii();
            Some(Sizes { smallest: least * b.scale, largest: most * b.scale })
        });
        own.chain(members).fold(self.entry_sizes, Sizes::union)
    }

    /// Radius of the sphere that holds the widest clump [m]; 0 without any.
    pub(crate) fn widest_clump(&self) -> f64 {
        let shapes = self.clumps.shapes.iter().zip(0u32..);
        let one = |(s, k): (&setup::ClumpShape, u32)| {
            self.clumps.scales_of(k).map(|scale| scale.1).fold(0.0, f64::max) * s.reach()
        };
        shapes.map(one).fold(0.0, f64::max)
    }

    fn finish(mut self) -> Result<Plan, SceneError> {
        let model = self.model();
        let sizes = self.sizes();
        let largest = sizes.map_or(0.0, |s| s.largest);
        let contacts = contacts::resolve(&self.check, &model.contact, &self.materials, largest)?;
        let contacts = self.meeting(contacts);
        self.doubts(&contacts);
        let bonds = bonds::resolve(&self.check, &model.bond, &self.materials)?;
        let (safety, step) = crate::accuracy::choose(&self.check, &model.time, &contacts)?;
        // The engine wants a density of every material, also of walls, whose mass plays no part.
        self.materials.iter_mut().filter(|m| m.density == 0.0).for_each(|m| m.density = NO_DENSITY);
        self.entry_materials.sort_unstable();
        self.entry_materials.dedup();
        let entries = self.sphere_sizes;
        let setup = Setup {
            gravity: Vec3::from(model.gravity),
            drag: model.drag.as_ref().map(drag),
            periodic: self.periodic()?,
            materials: self.materials,
            contacts,
            particles: self.particles,
            clumps: self.clumps,
            bonds,
            entry_bonds: self.entry_bonds,
            walls: self.walls,
            outlets: self.outlets,
            inlets: self.inlets,
            largest_entry: entries.map_or(0.0, |s| s.largest),
            smallest_entry: entries.map_or(0.0, |s| s.smallest),
            entry_materials: self.entry_materials,
            step: match model.time.dt {
                OrAuto::Auto => Step::Auto(safety),
                OrAuto::Given(dt) => Step::Fixed(dt),
            },
            precision: match model.precision {
                Arithmetic::F64 => dem::setup::Precision::Double,
                Arithmetic::Mixed => dem::setup::Precision::Mixed,
                Arithmetic::F32 => dem::setup::Precision::Single,
            },
            skin: model.neighbours.skin,
            sleep: model.sleep.map(|s| dem::setup::Sleep { speed: s.speed, time: s.time, wake: s.wake }),
            // Contacts are written with the work of sliding, which the ledger knows.
            ledger: model.output.energy || model.output.contacts || model.guards.energy.is_some(),
            guards: Guards {
                overlap: model.guards.overlap.unwrap_or(Guards::default().overlap),
                motion: model.guards.motion.unwrap_or(Guards::default().motion),
                // [[inlet]]s come before faucets, whose grains may get anywhere.
                cuts: model.inlet.len() as u32,
                zones: model.guards.zones != Some(false),
                energy: model.guards.energy.unwrap_or(Guards::default().energy),
            },
        };
        Ok(Plan { setup, step, feeds: self.feeds, notes: self.notes, inputs: self.inputs, sizes })
    }
}

fn drag(entry: &crate::model::Drag) -> setup::Drag {
    setup::Drag {
        law: match entry.law {
            DragLaw::Stokes => setup::DragLaw::Stokes,
            DragLaw::SchillerNaumann => setup::DragLaw::SchillerNaumann,
        },
        viscosity: entry.viscosity,
        density: entry.density.unwrap_or(0.0),
        velocity: Vec3::from(entry.velocity),
        buoyancy: entry.buoyancy,
    }
}
