//! What tripped a guard: which particle, where, by how much.

use crate::model::{Entrance, Halt, Model, Partner, Stiffer, With};
use crate::neighbours::{NeighbourLists, Segment};
use crate::observe::snapshot::energy;
use crate::observe::stiffen::{DeepContact, stiffer};
use crate::passes::ledger::swing;
use crate::passes::touching::position_before;
use crate::space::mass;
use crate::state::{CellState, ServoState, State};
use std::ops::Range;

/// The deepest overlap in those segments, zone particles and those that have left among themselves left out; `Ok` when only those are too deep. Where particles
/// have `moved` since forces were computed, their positions before the move count.
pub fn check_overlap(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    segments: &[Range<usize>],
    moved: bool,
) -> Result<(), Halt> {
    let limit = model.setup.guards.overlap;
    let position =
        |k: usize| if moved { position_before(model, state, k) } else { state.particles.position(k) };
    let time = state.time() - if moved { model.dt } else { 0.0 };
    let mut worst: Option<(f64, Halt)> = None;
    for segment in segments.iter().flat_map(|range| &lists.slots.segments[range.clone()]) {
        for at in segment.contacts() {
            let (i, j) = (lists.slots.i[at] as usize, lists.slots.partner[at] as usize);
            if state.zones.is_idle(lists.slots.ends(segment, at)) {
                continue;
            }
            let (other, radius) = lists.partner(&state.particles, segment, at, position);
            let (here, mine) = (position(i), state.particles.rows[i].radius());
            let overlap = mine + radius - (here - other).norm();
            let share = overlap / if radius == 0.0 { mine } else { mine.min(radius) };
            if share > limit && worst.as_ref().is_none_or(|w| share > w.0) {
                // Of a pair, the one that comes in is named first.
                let (one, other) = if !segment.with.is_wall() && state.zones.entering_by(j).is_some() {
                    (j, i)
                } else {
                    (i, j)
                };
                let partner = match segment.with {
                    With::Wall(w) => Partner::Wall(model.setup.walls[w].name.clone()),
                    _ => Partner::Particle(state.particles.id[other]),
                };
                let (id, position) = (state.particles.id[one], position(one));
                let halt = match state.zones.entering_by(one) {
                    Some(inlet) => {
                        let by = Entrance::of(inlet, model.setup.guards.cuts);
                        Halt::InletOverlap { time, id, by, partner, position, overlap, share, limit }
                    }
                    None => {
                        let stiffer = bearing(model, state, lists, (segment, at), overlap);
                        Halt::Overlap { time, id, partner, position, overlap, share, limit, stiffer }
                    }
                };
                worst = Some((share, halt));
            }
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}

/// What would bear the contact in a slot, which overlaps by so much [m], and those near it.
fn bearing(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    (segment, slot): (&Segment, usize),
    overlap: f64,
) -> Option<Box<Stiffer>> {
    let between = model.kinds[segment.kind].between;
    let alike = lists.slots.segments.iter().filter(|s| model.kinds[s.kind].between == between);
    let near = alike.flat_map(|s| s.contacts().filter_map(|at| contact(model, state, lists, (s, at))));
    let deep = DeepContact { overlap, ..contact(model, state, lists, (segment, slot))? };
    stiffer(model, &deep, near).map(Box::new)
}

/// What meets in a slot, and how fast.
fn contact(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    (segment, slot): (&Segment, usize),
) -> Option<DeepContact> {
    let (p, i) = (&state.particles, lists.slots.i[slot] as usize);
    let (row, other) = (&p.rows[i], lists.partner_row(p, segment, slot));
    let apart = row.position() - other.position();
    let normal = apart.try_normalize(0.0)?;
    Some(DeepContact {
        between: model.kinds[segment.kind].between,
        radii: [row.radius(), other.radius()],
        inverse_mass: row.inverse_mass() + other.inverse_mass(),
        overlap: row.radius() + other.radius() - apart.norm(),
        approach: (other.velocity() - row.velocity()).dot(&normal),
    })
}

/// The particle whose state is lost: where it was listed, from where it has gone less than its margin.
fn not_a_number(state: &State, k: usize) -> Halt {
    let position = state.particles.home[k].vector();
    Halt::NotANumber { time: state.time(), id: state.particles.id[k], position }
}

/// Steps between two checks of the energy that the step makes: a check takes about as long as a step.
pub const ENERGY_EVERY: u64 = 50;

/// Energy below this share of all is rounding.
const ROUNDING: f64 = 1e-9;

/// Share of its radius in a step below which a particle rests [–].
const RESTS: f64 = 1e-9;

/// Energy of motion below which nothing moves [J]: of all particles, each at [`RESTS`], and of one that may come in. Grains that touch up to the rounding of
/// their places hold far less, and so do those that have come and gone.
pub fn rest(model: &Model, state: &State) -> f64 {
    let at_rest = |mass: f64, radius: f64| 0.5 * mass * (RESTS * radius / model.dt).powi(2);
    let heavy = state.particles.rows.iter().filter(|row| row.inverse_mass() > 0.0);
    let setup = &model.setup;
    let densities = setup.entry_materials.iter().filter_map(|m| setup.materials.get(usize::from(*m)));
    let densest = densities.map(|m| m.density).fold(0.0, f64::max);
    let entry = mass(setup.largest_entry, densest);
    heavy.map(|row| at_rest(1.0 / row.inverse_mass(), row.radius())).sum::<f64>()
        + at_rest(entry, setup.largest_entry)
}

/// Whether the energy that the step makes is to be checked now.
pub fn checks_energy(model: &Model, state: &State) -> bool {
    model.setup.guards.energy.is_finite() && state.steps.is_multiple_of(ENERGY_EVERY)
}

/// Energy that the finite step has made, of what was exchanged and moves; forces of this instant are known.
pub fn check_energy(model: &Model, state: &mut State, lists: &NeighbourLists) -> Result<(), Halt> {
    let limit = model.setup.guards.energy;
    let (time, e) = (state.time(), energy(model, state, lists));
    // At the deepest point of an impact and at the top of a flight nothing moves: the largest value so far counts.
    state.ledger.peak = state.ledger.peak.max(e.held());
    // What springs swing by comes back, and is bounded by the step: only what stays is made.
    let (made, of) = (e.integration - swing(model, state, lists), e.exchanged() + state.ledger.peak);
    // Sums of positions far from the origin have no more digits. Written so that NaN is caught.
    let rounding = ROUNDING * (of + e.potential.abs()) + rest(model, state);
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
        let position = state.particles.position(k);
        let motion = (position - position_before(model, state, k)).norm();
        let share = motion / row.radius();
        if !(share <= limit) && worst.as_ref().is_none_or(|w| !(share <= w.0)) && state.zones.is_free(k) {
            let (time, id) = (state.time(), state.particles.id[k]);
            worst = Some((share, Halt::Motion { time, id, position, motion, share, limit }));
        }
    }
    worst.map_or(Ok(()), |(_, halt)| Err(halt))
}

/// Whether all positions, velocities and histories are finite: whether a run can go on from here.
pub fn is_finite(state: &State) -> bool {
    let p = &state.particles;
    let rows = p.rows.iter().all(|row| row.iter().all(|x| x.is_finite()));
    let fours = [&p.spins, &p.acceleration, &p.angular_acceleration];
    rows && fours.iter().all(|column| column.iter().all(|q| q[..3].iter().all(|x| x.is_finite())))
        && state.contacts.layout.are_finite(&state.contacts.history)
        && state.servos.iter().all(ServoState::is_finite)
        && state.strained.as_ref().is_none_or(CellState::is_finite)
}
