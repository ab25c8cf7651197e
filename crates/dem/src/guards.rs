//! What is looked for when a guard has tripped: which particle, where, by how much.

use crate::error::Halt;
use crate::interaction::With;
use crate::simulation::Simulation;

/// The deepest overlap, travellers among themselves left out; `Ok` when only those are too deep.
pub fn overlap(sim: &Simulation) -> Result<(), Halt> {
    let limit = sim.setup.guards.overlap;
    let mut worst: Option<(f64, Halt)> = None;
    for it in &sim.interactions {
        for k in 0..it.len {
            let i = it.i[k] as usize;
            let (row, pair) = (sim.particles.rows[i], matches!(it.with, With::Particles | With::Images));
            let partner = it.partner[k] as usize;
            if sim.zones.travels(i) && (!pair || sim.zones.travels(partner)) {
                continue;
            }
            let (place, radius) = sim.contact_partner(it, k);
            let flat = radius == 0.0;
            let overlap = row[3] + radius - (sim.particles.position(i) - place).norm();
            let share = overlap / if flat { row[3] } else { row[3].min(radius) };
            if share > limit && worst.as_ref().is_none_or(|w| share > w.0) {
                let partner = match it.with {
                    With::Wall(w) => format!("wall '{}'", sim.setup.walls[w].name),
                    _ => format!("particle {}", sim.particles.id[partner]),
                };
                let (time, id, [x, y, z]) = (sim.time(), sim.particles.id[i], [row[0], row[1], row[2]]);
                worst = Some((share, Halt::Overlap { time, id, partner, x, y, z, overlap, share, limit }));
            }
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}

/// The particle that moved farthest, or the first that is not a number.
pub fn motion(sim: &Simulation) -> Result<(), Halt> {
    let limit = sim.setup.guards.motion;
    let mut worst: Option<(f64, Halt)> = None;
    for k in 0..sim.particles.len() {
        let row = sim.particles.rows[k];
        let motion = (sim.particles.position(k) - sim.position_before(k)).norm();
        let share = motion / row[3];
        if !(share <= limit) && worst.as_ref().is_none_or(|w| !(share <= w.0)) && !sim.zones.is_gone(k) {
            let (time, id, [x, y, z]) = (sim.time(), sim.particles.id[k], [row[0], row[1], row[2]]);
            worst = Some((share, Halt::Motion { time, id, x, y, z, motion, share, limit }));
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}

impl Simulation {
    /// Centre and radius [m] of the partner of a contact; radius 0 on a flat wall.
    fn contact_partner(&self, it: &crate::interaction::Interaction, k: usize) -> (geom::Vec3, f64) {
        match it.with {
            With::Particles => {
                let j = it.partner[k] as usize;
                (self.particles.position(j), self.particles.rows[j][3])
            }
            _ => (it.place_of_partner(k), it.radius_of_partner(k)),
        }
    }
}
