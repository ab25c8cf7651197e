//! What is looked for when a guard has tripped: which particle, where, by how much.

use crate::model::Model;
use crate::model::halt::Halt;
use crate::model::kind::With;
use crate::neighbours::NeighbourLists;
use crate::neighbours::ends::{idles, partner};
use crate::observe::snapshot::energy;
use crate::passes::touching::position_before;
use crate::simd::Row4;
use crate::state::State;
use crate::state::servo::ServoState;
use std::ops::Range;

/// The deepest overlap in those segments, zone particles and those that have left among themselves left out; `Ok` when only those are too deep. Where particles
/// have `moved` since loads were computed, they are looked for where they were.
pub fn check_overlap(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    segments: &[Range<usize>],
    moved: bool,
) -> Result<(), Halt> {
    let limit = model.setup.guards.overlap;
    let place = |k: usize| if moved { position_before(model, state, k) } else { state.particles.position(k) };
    let time = state.time() - if moved { model.dt } else { 0.0 };
    let mut worst: Option<(f64, Halt)> = None;
    for segment in segments.iter().flat_map(|range| &lists.contacts.segments[range.clone()]) {
        let with = model.kinds[segment.kind].with;
        for at in segment.contacts() {
            let (i, j) = (lists.contacts.i[at] as usize, lists.contacts.partner[at] as usize);
            let pair = !matches!(with, With::Wall(_));
            if idles(state, lists, with, at) {
                continue;
            }
            let (other, radius) = partner(model, state, lists, segment, at, place);
            let (here, mine) = (place(i), state.particles.rows[i][3]);
            let overlap = mine + radius - (here - other).norm();
            let share = overlap / if radius == 0.0 { mine } else { mine.min(radius) };
            if share > limit && worst.as_ref().is_none_or(|w| share > w.0) {
                // Of a pair, the one that comes in is named first.
                let (one, other) = if pair && state.zones.entering_by(j).is_some() { (j, i) } else { (i, j) };
                let partner = match with {
                    With::Wall(w) => format!("wall '{}'", model.setup.walls[w].name),
                    _ => format!("particle {}", state.particles.id[other]),
                };
                let here = place(one);
                let (id, [x, y, z]) = (state.particles.id[one], [here.x, here.y, here.z]);
                let halt = match state.zones.entering_by(one) {
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
fn not_a_number(state: &State, k: usize) -> Halt {
    let Row4([x, y, z, _]) = state.particles.home[k];
    Halt::NotANumber { time: state.time(), id: state.particles.id[k], x, y, z }
}

/// Steps between two looks at the energy that the step makes: a look takes about as long as a step.
pub const ENERGY_EVERY: u64 = 50;

/// Energy below this share of all is rounding.
const ROUNDING: f64 = 1e-9;

/// Whether the energy that the step makes is to be checked now.
pub fn checks_energy(model: &Model, state: &State) -> bool {
    model.setup.guards.energy.is_finite() && state.steps.is_multiple_of(ENERGY_EVERY)
}

/// Energy that the finite step has made, of what was exchanged and moves; forces of this instant are known.
pub fn check_energy(model: &Model, state: &mut State, lists: &NeighbourLists) -> Result<(), Halt> {
    let limit = model.setup.guards.energy;
    let (time, e) = (state.time(), energy(model, state, lists));
    // At the deepest point of an impact and at the top of a flight nothing moves: the most that was seen counts.
    let peak = &mut state.ledger.peak;
    *peak = peak.max(e.translation + e.rotation + e.elastic.abs());
    let (made, of) = (e.integration, e.exchanged() + *peak);
    // Sums of positions far from the origin have no more digits. Written so that NaN is caught.
    let rounding = ROUNDING * (of + e.potential.abs());
    if made <= limit * of + rounding { Ok(()) } else { Err(Halt::Energy { time, made, of, limit }) }
}

/// The particle that moved farthest, or the first that is not a number.
pub fn check_motion(model: &Model, state: &State) -> Result<(), Halt> {
    let limit = model.setup.guards.motion;
    let mut worst: Option<(f64, Halt)> = None;
    for k in 0..state.particles.len() {
        let row = state.particles.rows[k];
        let finite = row[..3].iter().chain(&row[4..7]).all(|x| x.is_finite());
        if !finite && !state.zones.is_gone(k) {
            return Err(not_a_number(state, k));
        }
        let motion = (state.particles.position(k) - position_before(model, state, k)).norm();
        let share = motion / row[3];
        if !(share <= limit)
            && worst.as_ref().is_none_or(|w| !(share <= w.0))
            && !state.zones.is_gone(k)
            && !state.zones.travels(k)
        {
            let (time, id, [x, y, z]) = (state.time(), state.particles.id[k], [row[0], row[1], row[2]]);
            worst = Some((share, Halt::Motion { time, id, x, y, z, motion, share, limit }));
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}

/// Whether everything that moves is at a place and has a velocity: what a run can go on from.
pub fn is_finite(state: &State, lists: &NeighbourLists) -> bool {
    let p = &state.particles;
    let rows = p.rows.iter().all(|row| row.iter().all(|x| x.is_finite()));
    let fours = [&p.spins, &p.acceleration, &p.turning];
    rows && fours.iter().all(|column| column.iter().all(|q| q[..3].iter().all(|x| x.is_finite())))
        && lists.contacts.form.are_finite(&lists.contacts.memory)
        && state.servos.iter().all(ServoState::is_finite)
}
