//! Warns of walls of spheres that are too dense for a law with adhesion.
//!
//! The spheres that a grain touches share their elastic energy, but each adheres by itself. On a flat wall of spheres d/10 and d/20 apart, d the diameter of
//! the grain: Hertz with cohesion loses 7 % of the energy of an elastic bounce at any step, the pull-off force of JKR is 1.0 and 1.5 times that of a plane, and
//! what caps friction and rolling 1.3 and 1.7 times where adhesion presses most. At d/4 pull-off and caps are within 4 % of those of a plane.

use crate::plan::builder::PlanBuilder;
use dem::effects::{Slot, active};
use dem::setup::{ContactLaw, WallShape};
use geom::{Shown, Vec3, grid};

/// Share of the diameter of a grain that spheres of a wall may be apart [–].
const APART: f64 = 0.2;
/// Neighbours within that distance from which spheres are denser: those of a grid of this width have four at it, on average.
const NEIGHBOURS: f64 = 2.0;
/// Spheres that are looked at.
const LOOKED_AT: usize = 2000;

impl PlanBuilder<'_> {
    /// Warns of each such wall; `contacts` are those in force.
    pub(in crate::plan) fn adhesive_walls(&mut self, contacts: &[ContactLaw]) {
        let adheres = |law: &&ContactLaw| {
            let pulls = |d: &&dem::effects::Description| d.slot == Slot::Cohesion || d.name == "jkr";
            active(law).any(|d| pulls(&d) && !(d.idle)(law))
        };
        let laws: Vec<&ContactLaw> = contacts.iter().filter(adheres).collect();
        let largest = self.sizes().map_or(0.0, |s| 2.0 * s.largest);
        if laws.is_empty() || largest <= 0.0 {
            return;
        }
        for wall in &self.walls {
            let WallShape::Spheres(spheres) = &wall.shape else { continue };
            let meets = |law: &&&ContactLaw| law.between.0 == wall.material || law.between.1 == wall.material;
            if laws.iter().any(|law| meets(&law)) && is_denser(spheres, APART * largest) {
                self.warnings.push(format!(
                    "wall '{}': its spheres are less than {} m apart, a fifth of the largest grain, and each adheres by itself: energy, pull-off and what caps \
                     friction are those of too many contacts (docs/reference/scene.md); draw this wall as mesh = \"…\", or give it spheres a quarter of a grain apart",
                    wall.name,
                    Shown(APART * largest)
                ));
            }
        }
    }
}

/// Whether spheres have more than [`NEIGHBOURS`] within a distance [m] on average.
fn is_denser(spheres: &[(Vec3, f64)], distance: f64) -> bool {
    let centres: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
    let grid = grid::Grid::new(&centres, distance);
    let some = centres.iter().step_by(centres.len().div_ceil(LOOKED_AT).max(1));
    let (mut looked_at, mut near) = (0, 0);
    for centre in some {
        looked_at += 1;
        near += grid.within(&centres, *centre, distance).count() - 1;
    }
    near as f64 > NEIGHBOURS * f64::from(looked_at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_of_a_grid_are_denser_than_a_distance_above_its_width() {
        let at = |k: i32| (Vec3::new(f64::from(k % 50), f64::from(k / 50), 0.0), 1.0);
        let spheres: Vec<(Vec3, f64)> = (0..2500).map(at).collect();
        assert!(is_denser(&spheres, 1.1) && !is_denser(&spheres, 0.9));
        assert!(!is_denser(&spheres[..1], 1.0));
    }
}
