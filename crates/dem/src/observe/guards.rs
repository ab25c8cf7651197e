//! What is looked for when a guard has tripped: which particle, where, by how much.

use crate::model::error::Halt;
use crate::neighbours::contacts::With;
use crate::passes::servo::Piston;
use crate::simd::Row4;
use crate::simulation::Simulation;
use std::ops::Range;

/// The deepest overlap in those segments, travellers and who has left among themselves left out; `Ok` when only those are too deep. Where particles
/// have `moved` since loads were computed, they are looked for where they were.
pub fn overlap(sim: &Simulation, segments: &[Range<usize>], moved: bool) -> Result<(), Halt> {
    let limit = sim.setup.guards.overlap;
    let place = |k: usize| if moved { sim.position_before(k) } else { sim.particles.position(k) };
    let time = sim.time() - if moved { sim.dt } else { 0.0 };
    let mut worst: Option<(f64, Halt)> = None;
    for segment in segments.iter().flat_map(|range| &sim.contacts.segments[range.clone()]) {
        let with = sim.kinds[segment.kind].with;
        for at in segment.contacts() {
            let (i, partner) = (sim.contacts.i[at] as usize, sim.contacts.partner[at] as usize);
            let pair = !matches!(with, With::Wall(_));
            if sim.idles(with, at) {
                continue;
            }
            let (other, radius) = sim.partner(segment, at, place);
            let (here, mine) = (place(i), sim.particles.rows[i][3]);
            let overlap = mine + radius - (here - other).norm();
            let share = overlap / if radius == 0.0 { mine } else { mine.min(radius) };
            if share > limit && worst.as_ref().is_none_or(|w| share > w.0) {
                // Of a pair, the one that comes in is named first.
                let (one, other) =
                    if pair && sim.zones.on_its_way(partner).is_some() { (partner, i) } else { (i, partner) };
                let partner = match with {
                    With::Wall(w) => format!("wall '{}'", sim.setup.walls[w].name),
                    _ => format!("particle {}", sim.particles.id[other]),
                };
                let here = place(one);
                let (id, [x, y, z]) = (sim.particles.id[one], [here.x, here.y, here.z]);
                let halt = match sim.zones.on_its_way(one) {
                    Some(inlet) => {
                        Halt::InletOverlap { time, id, inlet, partner, x, y, z, overlap, share, limit }
                    }
                    None => Halt::Overlap { time, id, partner, x, y, z, overlap, share, limit },
                };
                worst = Some((share, halt));
            }
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}

/// The particle whose state is lost: where it was listed, from where it has gone less than its room.
fn not_a_number(sim: &Simulation, k: usize) -> Halt {
    let Row4([x, y, z, _]) = sim.particles.home[k];
    Halt::NotANumber { time: sim.time(), id: sim.particles.id[k], x, y, z }
}

/// Steps between two looks at the energy that the step makes: a look takes about as long as a step.
pub const ENERGY_EVERY: u64 = 50;

/// Energy below this share of all is rounding.
const ROUNDING: f64 = 1e-9;

/// Energy that the finite step has made, of what was exchanged and moves.
pub fn energy(sim: &mut Simulation) -> Result<(), Halt> {
    let (limit, time) = (sim.setup.guards.energy, sim.time());
    let e = sim.energy()?;
    // At the deepest point of an impact and at the top of a flight nothing moves: the most that was seen counts.
    let peak = &mut sim.account.peak;
    *peak = peak.max(e.translation + e.rotation + e.elastic.abs());
    let (made, of) = (e.integration, e.exchanged() + *peak);
    // Sums of places far from the origin have no more digits. Written so that NaN is caught.
    let rounding = ROUNDING * (of + e.potential.abs());
    if made <= limit * of + rounding { Ok(()) } else { Err(Halt::Energy { time, made, of, limit }) }
}

/// The particle that moved farthest, or the first that is not a number.
pub fn motion(sim: &Simulation) -> Result<(), Halt> {
    let limit = sim.setup.guards.motion;
    let mut worst: Option<(f64, Halt)> = None;
    for k in 0..sim.particles.len() {
        let row = sim.particles.rows[k];
        let finite = row[..3].iter().chain(&row[4..7]).all(|x| x.is_finite());
        if !finite && !sim.zones.is_gone(k) {
            return Err(not_a_number(sim, k));
        }
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

impl Simulation {
    /// Whether everything that moves is at a place and has a velocity: what a run can go on from.
    pub fn is_finite(&self) -> bool {
        let p = &self.particles;
        let rows = p.rows.iter().all(|row| row.iter().all(|x| x.is_finite()));
        let fours = [&p.spins, &p.acceleration, &p.turning];
        rows && fours.iter().all(|column| column.iter().all(|q| q[..3].iter().all(|x| x.is_finite())))
            && self.contacts.form.are_finite(&self.contacts.memory)
            && self.pistons.iter().all(Piston::is_finite)
    }
}
