//! Walls: which of them a stage needs.

use super::Stage;
use super::cutting::{Cutting, StageText};
use geom::{Plane, Shown};
use scene::Result;
use scene::keys::Wall;

/// Cosine beyond which a wall is parallel to the cut [–].
const PARALLEL: f64 = 0.99;

impl Cutting<'_> {
    /// Refuses a plane that lies behind an unbounded wall at rest, or whose zone reaches through one.
    pub fn clear_of_walls(&self) -> Result<()> {
        let length = self.cut.length.unwrap_or(1.2 * self.largest);
        for (i, wall) in self.scene.keys.wall.iter().enumerate().filter(|(_, w)| w.motion.is_none()) {
            for plane in planes(wall) {
                let along = plane.normal.dot(&self.cut.plane.normal);
                let before = plane.signed_distance(&self.cut.plane.point);
                let name = wall_name(i, wall);
                if along.abs() > PARALLEL && before <= 0.0 {
                    let why =
                        format!("the plane lies {} m behind {name}, where no grain can be", Shown(-before));
                    let cure = "move the plane to the side that the wall's normal points to";
                    return Err(self.wrong(why, cure));
                }
                if along < -PARALLEL && before < length {
                    let why = format!(
                        "{name} lies {} m behind the plane, within its zone of {} m: grains that rest on it would never leave the zone",
                        Shown(before),
                        Shown(length)
                    );
                    let beyond = Shown(length - before);
                    let cure =
                        format!("move the plane at least {beyond} m upstream, or use a shorter --length");
                    return Err(self.wrong(why, cure));
                }
            }
        }
        Ok(())
    }

    /// Walls at rest that no particle of the stage can reach.
    pub fn walls(&self, text: &mut StageText) {
        for (i, wall) in self.scene.keys.wall.iter().enumerate().rev() {
            if wall.motion.is_some() {
                continue;
            }
            let Some(range) = self.bounded(wall).map(|b| b.range) else { continue };
            let reach = self.largest / 2.0;
            let unreachable = match self.cut.keep {
                Stage::Upstream => range.0 > reach,
                Stage::Downstream => range.1 < -reach,
            };
            if self.largest > 0.0 && unreachable {
                text.remove("wall", i, wall_name(i, wall));
            }
        }
    }
}

/// The unbounded planes of a wall; a text that is not a plane is refused by the stage that uses it.
pub fn planes(wall: &Wall) -> Vec<Plane> {
    let put = |plane: Plane| wall.placement().map_or(plane, |place| place.plane(&plane));
    let plane = wall.plane.as_ref().and_then(|text| text.parse().ok()).map(put);
    let mut sides = wall.sides();
    // The mark of a plant does not depend on the order of faces.
    sides.sort_by_key(|(face, _)| *face as usize);
    sides.dedup_by_key(|(face, _)| *face);
    plane.into_iter().chain(sides.into_iter().map(|(_, plane)| plane)).collect()
}

/// The name of a wall.
fn wall_name(index: usize, wall: &Wall) -> String {
    wall.name.as_ref().map_or_else(|| format!("wall.{index}"), |name| format!("wall '{name}'"))
}
