//! Where grains come from: fills, faucets, files, and the zones that are there already.

use super::{Cutting, Found, OWN_IDS, Stage, remove};
use crate::error::SceneError;
use crate::particle_file;
use geom::Plane;
use toml_edit::{DocumentMut, value};

impl Cutting<'_> {
    /// Fills, inserts and particle files of the other stage.
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
            let file = particle_file::read(&self.scene.folder.join(&entry.source))?;
            let range = self.of_points(file.particles.iter().map(|p| (p.position, 0.0)));
            found.upstream |= range.1 <= 0.0;
            if self.keeps(&name, range)? {
                kept += 1;
            } else {
                remove(document, "particles", i, name, found);
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
