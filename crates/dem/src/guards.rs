//! What is looked for when a guard has tripped: which particle, where, by how much.

use crate::contacts::With;
use crate::error::Halt;
use crate::simulation::Simulation;

/// The deepest overlap, travellers among themselves left out; `Ok` when only those are too deep. Where particles have `moved`
/// since loads were computed, they are looked for where they were.
pub fn overlap(sim: &Simulation, moved: bool) -> Result<(), Halt> {
    let limit = sim.setup.guards.overlap;
    let place = |k: usize| if moved { sim.position_before(k) } else { sim.particles.position(k) };
    let time = sim.time() - if moved { sim.dt } else { 0.0 };
    let mut worst: Option<(f64, Halt)> = None;
    for segment in &sim.contacts.segments {
        let with = sim.kinds[segment.kind].with;
        for at in segment.contacts() {
            let (i, partner) = (sim.contacts.i[at] as usize, sim.contacts.partner[at] as usize);
            let pair = !matches!(with, With::Wall(_));
            if sim.zones.travels(i) && (!pair || sim.zones.travels(partner)) {
                continue;
            }
            let (other, radius) = sim.partner(segment, at, place);
            let (here, mine) = (place(i), sim.particles.rows[i][3]);
            let overlap = mine + radius - (here - other).norm();
            let share = overlap / if radius == 0.0 { mine } else { mine.min(radius) };
            if share > limit && worst.as_ref().is_none_or(|w| share > w.0) {
                let partner = match with {
                    With::Wall(w) => format!("wall '{}'", sim.setup.walls[w].name),
                    _ => format!("particle {}", sim.particles.id[partner]),
                };
                let (id, [x, y, z]) = (sim.particles.id[i], [here.x, here.y, here.z]);
                worst = Some((share, Halt::Overlap { time, id, partner, x, y, z, overlap, share, limit }));
            }
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}

/// Steps between two looks at the energy that the step makes: a look takes about as long as a step.
pub const ENERGY_EVERY: u64 = 50;

/// Energy that the finite step has made, of what was exchanged and moves.
pub fn energy(sim: &mut Simulation) -> Result<(), Halt> {
    let (limit, time) = (sim.setup.guards.energy, sim.time());
    let e = sim.energy()?;
    let (made, of) = (e.integration, e.exchanged() + e.translation + e.rotation);
    // Written so that NaN is caught.
    if made <= limit * of { Ok(()) } else { Err(Halt::Energy { time, made, of, limit }) }
}

/// The particle that moved farthest, or the first that is not a number.
pub fn motion(sim: &Simulation) -> Result<(), Halt> {
    let limit = sim.setup.guards.motion;
    let mut worst: Option<(f64, Halt)> = None;
    for k in 0..sim.particles.len() {
        let row = sim.particles.rows[k];
        let motion = (sim.particles.position(k) - sim.position_before(k)).norm();
        let share = motion / row[3];
        if !(share <= limit)
            && worst.as_ref().is_none_or(|w| !(share <= w.0))
            && !sim.zones.is_gone(k)
            && !sim.zones.travels(k)
        {
            let (time, id, [x, y, z]) = (sim.time(), sim.particles.id[k], [row[0], row[1], row[2]]);
            worst = Some((share, Halt::Motion { time, id, x, y, z, motion, share, limit }));
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}
