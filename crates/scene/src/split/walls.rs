//! Walls: which of them a stage needs.

use super::sides::Range;
use super::{Cutting, Found, Stage, remove};
use crate::input::Input;
use crate::mesh_file;
use crate::model::Wall;
use geom::Vec3;
use std::fs::File;
use toml_edit::DocumentMut;

impl Cutting<'_> {
    /// Walls at rest that no particle of the stage can reach.
    pub fn walls(&self, document: &mut DocumentMut, found: &mut Found) {
        for (i, wall) in self.scene.model.wall.iter().enumerate().rev() {
            let Some(range) = self.of_wall(wall).filter(|_| wall.motion.is_none()) else { continue };
            let reach = self.largest / 2.0;
            let unreachable = match self.cut.keep {
                Stage::Upstream => range.0 > reach,
                Stage::Downstream => range.1 < -reach,
            };
            if self.largest > 0.0 && unreachable {
                remove(document, "wall", i, wall_name(i, wall), found);
            }
        }
    }

    /// Where a wall is, when it has an end and its file can be read now.
    fn of_wall(&self, wall: &Wall) -> Option<Range> {
        if let Some(file) = &wall.mesh {
            let mesh = mesh_file::read(&self.scene.folder.join(file)).ok()?;
            return Some(self.of_points(mesh.vertices.iter().map(|v| (*v, 0.0))));
        }
        let path = self.scene.folder.join(wall.source.as_ref()?);
        let file = File::open(&path).ok()?;
        match Input::open(&path.display().to_string(), Box::new(file)).ok()? {
            Input::Walls(walls) if walls.velocity == Vec3::zeros() => {
                Some(self.of_points(walls.spheres.iter().map(|s| (s.0, s.1))))
            }
            _ => None,
        }
    }
}

/// A wall as its author calls it.
fn wall_name(index: usize, wall: &Wall) -> String {
    wall.name.as_ref().map_or_else(|| format!("wall.{index}"), |name| format!("wall '{name}'"))
}
