//! Facts about the files of particles that warnings need.

use crate::input::ParticleFile;
use geom::Vec3;
use std::ops::Range;

/// Facts about the files of particles that warnings need.
#[derive(Default)]
pub(super) struct FilesRead {
    /// Particles of files that people wrote.
    pub placed: usize,
    /// Files that give their particles spins.
    pub spinning: Vec<String>,
    /// Particles of runs, by index: they lie as the engine left them.
    pub settled: Vec<Range<usize>>,
}

impl FilesRead {
    /// A file whose particles come after `first` others.
    pub(super) fn file(&mut self, source: &str, file: &ParticleFile, first: usize) {
        // Only runs name their materials.
        if file.materials.is_empty() {
            self.placed += file.particles.len();
        } else {
            self.settled.push(first..first + file.particles.len());
        }
        if file.particles.iter().any(|p| p.spin != Vec3::zeros()) {
            self.spinning.push(source.to_owned());
        }
    }
}
