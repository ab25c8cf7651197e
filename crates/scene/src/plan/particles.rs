//! Particles at t = 0: `[[particles]]`, `[[body]]`, `[[fill]]`.

use super::builder::PlanBuilder;
use crate::error::Result;
use crate::input::ParticleFile;
use crate::keys::Particles;
use geom::Vec3;

impl PlanBuilder<'_> {
    pub(super) fn particles(&mut self) -> Result<()> {
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
        let file = ParticleFile::read(&self.path(&entry.source), entry.length_factor())?;
        self.inputs.push(("particles".to_owned(), file.hash.clone()));
        self.warnings.extend(file.warning.clone());
        // Only runs name their materials.
        if file.materials.is_empty() {
            self.read.placed += file.particles.len();
        } else {
            let first = self.particles.len();
            self.read.settled.push(first..first + file.particles.len());
        }
        if file.particles.iter().any(|p| p.spin != Vec3::zeros()) {
            self.read.spinning.push(entry.source.clone());
        }
        let key = format!("particles.{index}.material");
        let mut materials = Vec::new();
        match &entry.material {
            Some(name) => materials.push(self.grain(&key, name)?.index),
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
        let first = self.next_id();
        for (n, mut p) in file.particles.into_iter().enumerate() {
            p.material = materials[if entry.material.is_some() { 0 } else { p.material as usize }];
            p.id = if file.has_ids { p.id } else { first.wrapping_add(n as u32) };
            self.particles.push(p);
        }
        Ok(())
    }
}
