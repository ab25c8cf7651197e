//! The largest diameter of a scene.

use super::sources::largest_scale;
use scene::input::ParticleFile;
use scene::keys::Diameter;
use scene::{Scene, SceneError};

/// Largest diameter of the scene's own particles [m], of clumps that of the sphere which holds them; 0 when all come from an inlet.
pub(super) fn largest(scene: &Scene) -> Result<f64, SceneError> {
    let m = &scene.keys;
    let ranges = m.fill.iter().map(|f| f.diameter).chain(m.insert.iter().map(|f| f.diameter));
    let mut largest = ranges.map(|d: Diameter| d.high).fold(0.0, f64::max);
    for entry in m.particles.iter().filter(|p| p.clump.is_none()) {
        let file = ParticleFile::read(&scene.folder.join(&entry.source))?;
        largest = file.particles.iter().map(|p| 2.0 * p.radius).fold(largest, f64::max);
    }
    let reaches = if m.clump.is_empty() { Vec::new() } else { scene.clump_reaches()? };
    for (clump, reach) in m.clump.iter().zip(reaches) {
        let high = |scale: Option<Diameter>| scale.map_or(1.0, |s| s.high);
        let fills = m.fill.iter().map(|f| (f.clump.as_deref(), high(f.scale)));
        let insertions = m.insert.iter().map(|f| (f.clump.as_deref(), high(f.scale)));
        let bodies = m.body.iter().map(|b| (Some(b.clump.as_str()), b.scale));
        let mut files = Vec::new();
        for entry in &m.particles {
            files.push((entry.clump.as_deref(), largest_scale(scene, entry)?));
        }
        let own =
            fills.chain(insertions).chain(bodies).chain(files).filter(|(name, _)| *name == Some(&clump.name));
        largest = own.map(|(_, scale)| 2.0 * reach * scale).fold(largest, f64::max);
    }
    Ok(largest)
}
