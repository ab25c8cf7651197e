//! Where grains come from: fills, faucets, files, and the zones that are there already.

use super::{Cutting, Found, OWN_IDS, Stage, remove};
use crate::columns::Columns;
use crate::error::SceneError;
use crate::model::Particles;
use crate::{Scene, particle_file};
use geom::{Plane, Vec3};
use toml_edit::{DocumentMut, value};

/// Where the particles, or clumps, of a file are [m].
pub fn places(scene: &Scene, entry: &Particles) -> Result<Vec<Vec3>, SceneError> {
    let path = scene.folder.join(&entry.source);
    if entry.clump.is_none() {
        return Ok(particle_file::read(&path)?.particles.iter().map(|p| p.position).collect());
    }
    let name = path.display().to_string();
    let (table, ..) = particle_file::table(&path)?;
    Columns { name: &name, table: &table }.vectors(["x", "y", "z"])
}

/// Largest scale of the clumps of a file [–].
pub fn largest_scale(scene: &Scene, entry: &Particles) -> Result<f64, SceneError> {
    if entry.clump.is_none() {
        return Ok(1.0);
    }
    let path = scene.folder.join(&entry.source);
    let (name, (table, ..)) = (path.display().to_string(), particle_file::table(&path)?);
    let columns = Columns { name: &name, table: &table };
    if table.get("scale").is_none() {
        Ok(1.0)
    } else {
        Ok(columns.numbers("scale")?.into_iter().fold(0.0, f64::max))
    }
}

impl Cutting<'_> {
    /// Fills, inserts, particle files and single clumps of the other stage.
    pub fn sources(&self, document: &mut DocumentMut, found: &mut Found) -> Result<(), SceneError> {
        let m = &self.scene.model;
        let mut kept = 0;
        let shapes = [
            ("fill", m.fill.iter().map(|f| f.shape.as_str()).collect::<Vec<_>>()),
            ("insert", m.insert.iter().map(|f| f.shape.as_str()).collect()),
        ];
        for (key, shapes) in shapes {
            for (i, shape) in shapes.iter().enumerate().rev() {
                let name = format!("{key}.{i}");
                let range = self.of_shape(&name, shape)?;
                found.upstream |= range.1 <= 0.0;
                if self.keeps(&name, range)? {
                    kept += 1;
                } else {
                    remove(document, key, i, name, found);
                }
            }
        }
        for (i, entry) in m.particles.iter().enumerate().rev() {
            let name = format!("particles.{i}");
            let range = self.of_points(places(self.scene, entry)?.into_iter().map(|p| (p, 0.0)));
            found.upstream |= range.1 <= 0.0;
            if self.keeps(&name, range)? {
                kept += 1;
            } else {
                remove(document, "particles", i, name, found);
            }
        }
        for (i, body) in m.body.iter().enumerate().rev() {
            let name = format!("body.{i}");
            let range = self.of_points([(body.position.into(), 0.0)].into_iter());
            found.upstream |= range.1 <= 0.0;
            if self.keeps(&name, range)? {
                kept += 1;
            } else {
                remove(document, "body", i, name, found);
            }
        }
        if kept > 0 && self.cut.keep == Stage::Downstream && m.first_id == 0 {
            document.insert("first_id", value(OWN_IDS));
        }
        Ok(())
    }

    /// Zones that are there already stay with the stage they lie in.
    pub fn zones(&self, document: &mut DocumentMut, found: &mut Found) -> Result<(), SceneError> {
        let m = &self.scene.model;
        let outlets = m.outlet.iter().map(|o| ("outlet", &o.plane)).enumerate().rev();
        let inlets = m.inlet.iter().map(|o| ("inlet", &o.plane)).enumerate().rev();
        for (i, (key, plane)) in outlets.chain(inlets) {
            let name = format!("{key}.{i}");
            let wrong = |e: geom::plane::PlaneError| {
                SceneError::file(&self.scene.text.name, format!("{name}: {e}"), "correct it")
            };
            let plane: Plane = plane.parse().map_err(wrong)?;
            let distance = self.cut.plane.signed_distance(&plane.point);
            found.upstream |= key == "inlet" && distance <= 0.0;
            if !self.keeps(&name, (distance, distance))? {
                remove(document, key, i, name, found);
            }
        }
        Ok(())
    }
}
