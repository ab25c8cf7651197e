//! `[[clump]]`: shapes of rigid clumps from spheres or from a closed mesh.
//!
//! Multisphere: mass, centre and inertia of the union of the spheres, of their sum (`mass = "sum"`: overlaps count twice), or as given (`moments`).
//! Polyhedron: those of the inside of the mesh, exactly; a sphere of `vertex_radius` sits centred on every vertex that a face uses, so that
//! the mesh is the hull of the centres and contacts lie `vertex_radius` outside of it (JP6939487B2, particles as polyhedra). With `faces` the
//! spheres sit on a thinned mesh; volume, centre and inertia stay those of the whole one.

use crate::error::{Result, SceneError};
use crate::input::read_mesh_warned;
use crate::keys::{Clump, ClumpMass};
use crate::plan::builder::PlanBuilder;
use dem::setup::ClumpShape;
use geom::mesh::TriMesh;
use geom::moments::BodyError;
use geom::{Moments, Vec3};
use record::ClumpRecord;

/// Most members of a clump: more make every neighbour list long; a mesh with so many vertices is not meant as a clump.
const MOST: usize = 2000;

type Sphere = (Vec3, f64);

impl PlanBuilder<'_> {
    /// Shapes of all `[[clump]]`.
    pub(in crate::plan) fn clump_shapes(&mut self) -> Result<()> {
        for (i, entry) in self.keys().clump.iter().enumerate() {
            let key = format!("clump.{i}");
            let material = self.grain(&format!("{key}.material"), &entry.material)?.index;
            let (spheres, moments) = match &entry.mesh {
                Some(file) => self.polyhedron(&key, entry, file)?,
                None => self.multisphere(&key, entry)?,
            };
            let shape = ClumpShape::new(&entry.name, material, &spheres, &moments);
            self.inputs
                .push((format!("clump '{}'", entry.name), stream::sha256(format!("{shape:?}").as_bytes())));
            self.clumps.shapes.push(shape);
        }
        Ok(())
    }

    /// Index of the scene's shape of that name.
    ///
    /// # Errors
    /// There is none, or it has other spheres; `cure` says what to do.
    pub(in crate::plan) fn same_clump(
        &self,
        file: &str,
        record: &ClumpRecord,
        cure: &'static str,
    ) -> Result<u32> {
        let shape = self.clump(file, &record.name)?;
        if self.clumps.shapes.get(shape as usize).is_some_and(|s| is_same(record, s)) {
            return Ok(shape);
        }
        let why = format!("its clump '{}' has other spheres than the scene's", record.name);
        Err(SceneError::file(file, why, cure))
    }

    fn multisphere(&self, key: &str, entry: &Clump) -> Result<(Vec<Sphere>, Moments)> {
        let given = entry.spheres.as_deref().unwrap_or_default();
        let cure = "take fewer: a few dozen carry the shape (stone-clump)";
        self.few(&format!("{key}.spheres"), (given.len(), "spheres"), cure)?;
        let sphere = |s: &[f64; 4]| (Vec3::new(s[0], s[1], s[2]) * entry.scale, s[3] * entry.scale);
        let spheres: Vec<Sphere> = given.iter().map(sphere).collect();
        if let Some(m) = &entry.moments {
            let s = entry.scale;
            let (volume, centre) = (m.volume * s.powi(3), Vec3::from(m.centre) * s);
            return Ok((spheres, Moments { volume, centre, inertia: m.tensor() * s.powi(5) }));
        }
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

    fn polyhedron(&mut self, key: &str, entry: &Clump, file: &str) -> Result<(Vec<Sphere>, Moments)> {
        let mut warnings = Vec::new();
        let mesh = self
            .file(&format!("{key}.mesh"), file, |file| read_mesh_warned(file, entry.scale, &mut warnings))?;
        self.warnings.extend(warnings);
        let mesh = mesh.welded();
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
        let mesh = match entry.faces {
            Some(faces) => self.thinned(&format!("{key}.faces"), &mesh, faces as usize)?,
            None => mesh,
        };
        let mut used = vec![false; mesh.vertices.len()];
        mesh.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
        let vertices = mesh.vertices.iter().zip(used).filter(|(_, used)| *used);
        let radius = entry.vertex_radius.unwrap_or_default() * entry.scale;
        let spheres: Vec<Sphere> = vertices.map(|(v, _)| (*v, radius)).collect();
        let cure = "thin it: faces = 100 carries the shape";
        self.few(&format!("{key}.mesh"), (spheres.len(), "vertices"), cure)?;
        Ok((spheres, moments))
    }

    /// A mesh of so many faces.
    fn thinned(&self, key: &str, mesh: &TriMesh, faces: usize) -> Result<TriMesh> {
        let wrong = |why: String, cure: &str| Err(self.check.wrong(key, faces.to_string(), &why, cure));
        let all = mesh.faces.len();
        if faces >= all {
            return wrong(format!("the mesh has {all} faces"), "give fewer, or take it out");
        }
        let thinned = remesh::decimate(mesh, faces);
        if thinned.faces.len() > faces {
            let why = format!("no more than {} of them can be taken away", all - thinned.faces.len());
            return wrong(why, "repair the mesh with stone-clean, or give more faces");
        }
        Ok(thinned)
    }

    fn few(&self, key: &str, (count, what): (usize, &str), cure: &str) -> Result<()> {
        if count <= MOST {
            return Ok(());
        }
        let why = format!("makes more than {MOST} spheres that move as one");
        Err(self.check.wrong(key, format!("{count} {what}"), &why, cure))
    }
}

/// Whether a recorded shape is one of the scene, except for rounding.
fn is_same(record: &ClumpRecord, shape: &ClumpShape) -> bool {
    let size = shape.reach();
    let near = |a: &[f64; 4], (c, r): &(Vec3, f64)| {
        let at = shape.centre + shape.frame * c;
        (Vec3::new(a[0], a[1], a[2]) - at).norm() < 1e-9 * size && (a[3] - r).abs() < 1e-9 * size
    };
    record.spheres.len() == shape.spheres.len()
        && (record.volume - shape.volume).abs() < 1e-9 * shape.volume
        && record.spheres.iter().zip(&shape.spheres).all(|(a, b)| near(a, b))
}
