//! `[[clump]]`: shapes of rigid clumps from spheres or from a closed mesh.
//!
//! Multisphere: mass, centre and inertia of the union of the spheres, or of their sum (`mass = "sum"`: overlaps count twice).
//! Polyhedron: those of the inside of the mesh, exactly; a sphere of `vertex_radius` sits centred on every vertex that a face uses, so that
//! the mesh is the hull of the centres and contacts lie `vertex_radius` outside of it (JP6939487B2, particles as polyhedra).

use crate::check::Check;
use crate::error::SceneError;
use crate::model::{Clump, ClumpMass, Diameter, Model};
use crate::plan::Draft;
use dem::setup::ClumpShape;
use geom::moments::BodyError;
use geom::{Moments, Vec3};

/// More members make every contact list long; a mesh of so many vertices was not meant for this.
const MOST: usize = 2000;

type Sphere = (Vec3, f64);

impl Draft<'_> {
    /// Shapes of all `[[clump]]`.
    pub(crate) fn shapes(&mut self) -> Result<(), SceneError> {
        for (i, entry) in self.model().clump.iter().enumerate() {
            let key = format!("clump.{i}");
            let material = self.grain(&format!("{key}.material"), &entry.material)?.0;
            let (spheres, moments) = match &entry.mesh {
                Some(file) => self.polyhedron(&key, entry, file)?,
                None => self.multisphere(&key, entry)?,
            };
            let shape = ClumpShape::new(&entry.name, material, &spheres, &moments);
            self.inputs.push((format!("clump '{}'", entry.name), crate::sha256(&format!("{shape:?}"))));
            self.clumps.shapes.push(shape);
        }
        Ok(())
    }

    fn multisphere(&self, key: &str, entry: &Clump) -> Result<(Vec<Sphere>, Moments), SceneError> {
        let given = entry.spheres.as_deref().unwrap_or_default();
        self.few(&format!("{key}.spheres"), given.len(), "spheres")?;
        let sphere = |s: &[f64; 4]| (Vec3::new(s[0], s[1], s[2]) * entry.scale, s[3] * entry.scale);
        let spheres: Vec<Sphere> = given.iter().map(sphere).collect();
        if let ClumpMass::Sum = entry.mass {
            let moments = Moments::of_sum(&spheres);
            return Ok((spheres, moments));
        }
        let moments = Moments::of_union(&spheres).map_err(|e| {
            let count = format!("({} spheres)", spheres.len());
            self.check.wrong(&format!("{key}.spheres"), count, &e.to_string(), "or use mass = \"sum\"")
        })?;
        Ok((spheres, moments))
    }

    fn polyhedron(&self, key: &str, entry: &Clump, file: &str) -> Result<(Vec<Sphere>, Moments), SceneError> {
        let mut mesh = crate::mesh_file::read(&self.path(file))?.welded();
        mesh.vertices.iter_mut().for_each(|v| *v *= entry.scale);
        let refused = |why: &str, cure: &str| {
            self.check.wrong(&format!("{key}.mesh"), format!("\"{file}\""), why, cure)
        };
        let moments = Moments::of_mesh(&mesh).map_err(|e| {
            let cure = match &e {
                BodyError::Mesh(_) => "close it, with stone-clean or a mesh editor",
                _ => "repair it in a mesh editor",
            };
            refused(&e.to_string(), cure)
        })?;
        let mut used = vec![false; mesh.vertices.len()];
        mesh.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
        let vertices = mesh.vertices.iter().zip(used).filter(|(_, used)| *used);
        let radius = entry.vertex_radius.unwrap_or_default() * entry.scale;
        let spheres: Vec<Sphere> = vertices.map(|(v, _)| (*v, radius)).collect();
        self.few(&format!("{key}.mesh"), spheres.len(), "vertices")?;
        Ok((spheres, moments))
    }

    fn few(&self, key: &str, count: usize, what: &str) -> Result<(), SceneError> {
        if count <= MOST {
            return Ok(());
        }
        let why = format!("makes more than {MOST} spheres that move as one");
        let cure = "thin it: a few dozen carry the shape (stone-clean --faces 100)";
        Err(self.check.wrong(key, format!("{count} {what}"), &why, cure))
    }

    /// Index of a shape, by name.
    pub(crate) fn clump(&self, key: &str, name: &str) -> Result<u32, SceneError> {
        let names = || self.model().clump.iter().map(|c| c.name.as_str());
        if let Some(at) = names().position(|n| n == name) {
            return Ok(at as u32);
        }
        let cure = match crate::error::nearest(name, names()) {
            Some(near) => format!("did you mean '{near}'?"),
            None if names().next().is_none() => "add a [[clump]] with this name".to_owned(),
            None => format!("known: {}", names().collect::<Vec<_>>().join(", ")),
        };
        Err(self.check.wrong(key, format!("\"{name}\""), "no [[clump]] has this name", &cure))
    }
}

impl Check<'_> {
    /// Spheres have material and diameter, clumps a name and perhaps a scale.
    pub(crate) fn grains(
        &self,
        entry: &str,
        material: &str,
        diameter: Diameter,
        (clump, scale): (bool, Option<Diameter>),
    ) -> Result<(), SceneError> {
        let key = |k: &str| format!("{entry}.{k}");
        let given = diameter != Diameter::default();
        if clump {
            for (name, given) in [("material", !material.is_empty()), ("diameter", given)] {
                if given {
                    let why = "a clump has its own";
                    return Err(self.wrong(&key(name), "(given)", why, "take it out, or use scale"));
                }
            }
            let range = scale.unwrap_or(Diameter { low: 1.0, high: 1.0 });
            self.positive(&key("scale"), range.low, "")?;
            self.positive(&key("scale"), range.high, "")?;
            if range.low > range.high {
                let value = format!("[{}, {}]", range.low, range.high);
                return Err(self.wrong(
                    &key("scale"),
                    value,
                    "the range is upside down",
                    "give [smallest, largest]",
                ));
            }
            return Ok(());
        }
        for (name, given) in [("material", !material.is_empty()), ("diameter", given)] {
            if !given {
                let why = format!("{name} is missing");
                return Err(self.wrong(
                    entry,
                    format!("(without {name})"),
                    &why,
                    "add it, or the name of a clump",
                ));
            }
        }
        if scale.is_some() {
            let why = "only clumps have a scale";
            return Err(self.wrong(&key("scale"), "(given)", why, "use diameter, or add clump = \"…\""));
        }
        self.diameter(&key("diameter"), diameter)
    }

    /// Every value of `[[clump]]` and `[[body]]` that can be judged by itself.
    pub(crate) fn clumps(&self, m: &Model) -> Result<(), SceneError> {
        for (i, c) in m.clump.iter().enumerate() {
            let key = |k: &str| format!("clump.{i}.{k}");
            if c.name.is_empty() || m.clump[..i].iter().any(|o| o.name == c.name) {
                let value = format!("\"{}\"", c.name);
                return Err(self.wrong(
                    &key("name"),
                    value,
                    "is no name of its own",
                    "name each clump differently",
                ));
            }
            let kinds = [("spheres", c.spheres.is_some()), ("mesh", c.mesh.is_some())];
            self.one_of(&format!("clump.{i}"), &kinds)?;
            self.positive(&key("scale"), c.scale, "")?;
            self.positive_if(&key("vertex_radius"), c.vertex_radius, "m")?;
            if c.mesh.is_some() != c.vertex_radius.is_some() {
                let why = "vertex_radius goes with mesh, and mesh with vertex_radius";
                return Err(self.wrong(&format!("clump.{i}"), "(one of them)", why, "give both, or spheres"));
            }
            let spheres = c.spheres.as_deref().unwrap_or_default();
            if c.spheres.is_some() && spheres.is_empty() {
                return Err(self.wrong(
                    &key("spheres"),
                    "[]",
                    "has no sphere",
                    "give [[x, y, z, radius], …]",
                ));
            }
            for (k, sphere) in spheres.iter().enumerate() {
                self.finite(&key(&format!("spheres.{k}")), &sphere[..3], "m")?;
                self.positive(&key(&format!("spheres.{k}")), sphere[3], "m")?;
            }
        }
        for (i, b) in m.body.iter().enumerate() {
            let key = |k: &str| format!("body.{i}.{k}");
            self.finite(&key("position"), &b.position, "m")?;
            self.finite(&key("velocity"), &b.velocity, "m/s")?;
            self.finite(&key("spin"), &b.spin, "rad/s")?;
            self.positive(&key("scale"), b.scale, "")?;
        }
        Ok(())
    }
}
