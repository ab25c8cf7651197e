//! Particles at t = 0: `[[particles]]`, `[[body]]`, `[[fill]]`.

use crate::error::Result;
use crate::input::ParticleFile;
use crate::keys::Particles;
use crate::plan::builder::PlanBuilder;
use dem::setup::{Particle, Wall, WallShape};
use geom::Vec3;

impl PlanBuilder<'_> {
    pub(in crate::plan) fn particles(&mut self) -> Result<()> {
        for (i, entry) in self.keys().particles.iter().enumerate() {
            match &entry.clump {
                Some(clump) => self.clump_file(&format!("particles.{i}"), entry, clump)?,
                None => self.particle_file(i, entry)?,
            }
        }
        self.bodies()?;
        for (i, entry) in self.keys().fill.iter().enumerate() {
            let shape = self.shape(&format!("fill.{i}.shape"), &entry.shape)?;
            match &entry.clump {
                Some(clump) => self.fill_with_clumps(i, entry, clump, &shape)?,
                None => self.fill_with_spheres(i, entry, &shape)?,
            }
        }
        Ok(())
    }

    fn particle_file(&mut self, index: usize, entry: &Particles) -> Result<()> {
        let named = entry.materials.as_deref().unwrap_or_default();
        let file = self.file(&format!("particles.{index}.source"), &entry.source, |file| {
            ParticleFile::read_with(file, entry.length_factor(), named)
        })?;
        self.inputs.push(("particles".to_owned(), file.hash.clone()));
        self.warnings.extend(file.warning.clone());
        if !entry.fixed {
            self.note(entry, &file);
        }
        let key = format!("particles.{index}.material");
        let mut materials = Vec::new();
        match &entry.material {
            Some(name) => materials.push(self.grain(&key, name)?.index),
            None if !named.is_empty() => {
                for name in named {
                    materials.push(self.grain(&format!("particles.{index}.materials"), name)?.index);
                }
            }
            None if file.materials.is_empty() => {
                let why = "is missing, and the file names none";
                return Err(self.check.wrong(&key, "(nothing)", why, "add material = \"…\""));
            }
            None => {
                for record in &file.materials {
                    materials.push(self.material_of(&entry.source, record)?);
                }
            }
        }
        if entry.fixed {
            if file.clumps.is_some() {
                let (key, value) = (format!("particles.{index}.fixed"), "true");
                let why = "and the file is a run with clumps, which cannot be fixed";
                return Err(self.check.wrong(&key, value, why, "give a file of spheres"));
            }
            let of = |p: &Particle| materials[if entry.material.is_some() { 0 } else { p.material as usize }];
            let spheres = file.particles.iter().map(|p| (of(p), (p.position, p.radius)));
            self.fixed(index, entry, spheres.collect());
            if !is_run(entry, &file) && file.particles.iter().any(|p| p.velocity != Vec3::zeros()) {
                let source = &entry.source;
                self.warnings.push(format!(
                    "{source}: the velocities are not used: the grains are fixed; take them out"
                ));
            }
            return Ok(());
        }
        if let Some(clumps) = &file.clumps {
            if entry.material.is_some() {
                let why =
                    "is given, and the file is a run with clumps, which have the material of their [[clump]]";
                return Err(self.check.wrong(&key, "(a run with clumps)", why, "take it out"));
            }
            self.clumps_of_run(entry, clumps)?;
        }
        // Of other materials a contact would be another one.
        if entry.material.is_none() && file.has_ids {
            self.read.kept.push(file.kept);
        }
        let first = self.next_id();
        let of_row = |n: usize| file.clusters.as_ref().map_or(0, |all| all[n]);
        for (n, mut p) in file.particles.into_iter().enumerate() {
            p.material = materials[if entry.material.is_some() { 0 } else { p.material as usize }];
            p.id = if file.has_ids { p.id } else { first.wrapping_add(n as u32) };
            let cluster = entry.cluster.unwrap_or_else(|| of_row(n));
            if cluster > 0 {
                self.clusters.push((p.id, cluster));
            }
            self.particles.push(p);
        }
        Ok(())
    }

    /// Notes what warnings need to know of a file.
    fn note(&mut self, entry: &Particles, file: &ParticleFile) {
        if !is_run(entry, file) {
            self.read.placed += file.particles.len();
        } else {
            let first = self.particles.len();
            self.read.settled.push(first..first + file.particles.len());
        }
        if file.particles.iter().any(|p| p.spin != Vec3::zeros()) {
            self.read.spinning.push(entry.source.clone());
        }
    }

    /// Grains that stay where they are: a wall of spheres for each material.
    fn fixed(&mut self, index: usize, entry: &Particles, mut spheres: Vec<(u16, (Vec3, f64))>) {
        spheres.sort_by_key(|s| s.0);
        let parts: Vec<&[(u16, (Vec3, f64))]> = spheres.chunk_by(|a, b| a.0 == b.0).collect();
        for part in &parts {
            let material = part[0].0;
            let name = match parts.len() {
                1 => format!("particles.{index} ({})", entry.source),
                _ => format!(
                    "particles.{index} ({}, {})",
                    entry.source, self.materials[material as usize].name
                ),
            };
            let shape = WallShape::Spheres(part.iter().map(|s| s.1).collect());
            self.walls.push(Wall::new(name, material, shape));
        }
    }
}

/// Whether a file is a run: only runs name their materials.
fn is_run(entry: &Particles, file: &ParticleFile) -> bool {
    entry.materials.is_none() && !file.materials.is_empty()
}
