//! Soil, library and grading from their files.

use crate::args::Args;
use anyhow::{Context, bail};
use dem::setup::Particle;
use geom::Vec3;
use scene::input::ParticleFile;
use std::path::PathBuf;
use stones::{Class, Library, Soil, grading};

/// Endings of meshes; other files of a library folder are passed over.
const MESHES: [&str; 3] = ["ply", "stl", "obj"];

/// Grains of the soil, as they were read.
pub struct Grains {
    pub particles: Vec<Particle>,
    /// Radii [m].
    pub radii: Vec<f64>,
    /// Whether ids come from the file.
    pub has_ids: bool,
    /// Name and density [kg/m³] of each material.
    pub materials: Vec<(String, f64)>,
}

impl Grains {
    /// Centres and masses.
    pub fn soil(&self) -> Soil {
        let mass = |p: &Particle| geom::sphere::volume(p.radius) * self.materials[usize::from(p.material)].1;
        Soil {
            centres: self.particles.iter().map(|p| p.position).collect(),
            masses: self.particles.iter().map(mass).collect(),
        }
    }

    /// The box around all of them [m].
    pub fn bounds(&self) -> [Vec3; 2] {
        let none = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
        self.particles.iter().fold(none, |[lo, hi], p| {
            let r = Vec3::repeat(p.radius);
            [lo.inf(&(p.position - r)), hi.sup(&(p.position + r))]
        })
    }
}

/// Reads the soil.
pub fn grains(args: &Args) -> anyhow::Result<Grains> {
    let file = ParticleFile::read(&args.soil, 1.0)?;
    file.warning.iter().for_each(|w| cli::warn(w));
    let name = args.soil.display();
    if file.particles.is_empty() {
        bail!("{name}: holds no grain: give settled soil");
    }
    if file.clusters.iter().flatten().any(|c| *c > 0) {
        bail!("{name}: has clusters already: give soil without stones");
    }
    let materials: Vec<(String, f64)> = match (file.materials.len(), args.soil_density) {
        (0, None) => return Err(cli::usage(format!("{name} names no density: add --soil-density [kg/m³]"))),
        (0, Some(density)) => vec![("soil".to_owned(), density)],
        (_, given) => {
            let of = |m: &record::MaterialRecord| Some((m.name.clone(), given.or(m.density)?));
            let all: Option<Vec<_>> = file.materials.iter().map(of).collect();
            all.ok_or_else(|| {
                cli::usage(format!("{name}: a material has no density: add --soil-density [kg/m³]"))
            })?
        }
    };
    let radii = file.particles.iter().map(|p| p.radius).collect();
    Ok(Grains { particles: file.particles, radii, has_ids: file.has_ids, materials })
}

/// Reads and checks the meshes of the library.
pub fn library(args: &Args) -> anyhow::Result<Library> {
    let folder = &args.library;
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("{}: cannot read the folder", folder.display()))?;
    let paths: Result<Vec<PathBuf>, _> = entries.map(|entry| entry.map(|e| e.path())).collect();
    let mesh = |path: &PathBuf| {
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        path.is_file() && ending.is_some_and(|e| MESHES.contains(&e.as_str()))
    };
    let mut meshes = Vec::new();
    for path in paths.with_context(|| folder.display().to_string())?.into_iter().filter(mesh) {
        let file = path.display().to_string();
        let bytes = stream::whole::file(&path).with_context(|| format!("{file}: cannot read the mesh"))?;
        let found =
            cli::read_mesh(&bytes, &file, &args.lengths, &args.placing).with_context(|| file.clone())?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        meshes.push((name, found));
    }
    let units_given = args.lengths.factor().is_some() || args.placing.scales();
    Library::new(meshes, units_given).with_context(|| folder.display().to_string())
}

/// The classes of the grading, or one of all stones.
pub fn classes(args: &Args, library: &Library) -> anyhow::Result<Vec<Class>> {
    let Some(file) = &args.grading else { return Ok(grading::whole(library)) };
    let text = stream::whole::text(file).with_context(|| format!("{}: cannot read", file.display()))?;
    grading::read(&text, library).with_context(|| file.display().to_string())
}
