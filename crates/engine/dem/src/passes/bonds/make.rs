//! Bonds that are made during a run.

use crate::model::bonds::find::{Grain, find};
use crate::model::bonds::kinds::End;
use crate::model::bonds::limit::{bonded, critical};
use crate::model::bonds::springs::numbers;
use crate::model::quantity::material_names;
use crate::model::{BondedPair, Halt, Model, NewBond, Springs};
use crate::setup::Bond;
use crate::setup::bond::cluster_of;
use crate::state::{ListStatus, State};
use geom::Vec3;

/// Makes the bonds whose time has come.
///
/// # Errors
/// Two centres at one position; bonds too stiff for the step.
pub fn make_due(model: &Model, state: &mut State) -> Result<(), Halt> {
    let time = state.time();
    let is_due = |&n: &u32| model.setup.bonds[n as usize].at <= time + 0.5 * model.dt;
    if !state.bonds.due.iter().any(is_due) {
        return Ok(());
    }
    let (now, later) = state.bonds.due.iter().partition(|n| is_due(n));
    state.bonds.due = later;
    let now: Vec<u32> = now;
    // Particles that have just come in have no entries yet.
    state.bonds.index(&state.particles.id);
    let laws: Vec<&Bond> = now.iter().map(|&n| &model.setup.bonds[n as usize]).collect();
    let grains = grains(model, state);
    let found = find(&state.cell(model), &laws, &grains, |rows| state.bonds.joins(rows, |_| true));
    let found = found.map_err(|error| Halt::Bonds { time, error: Box::new(error) })?;
    let unused = laws.iter().zip(&found.used).filter(|(_, used)| !**used);
    state.bonds.idle.extend(unused.map(|(law, _)| material_names(&model.setup, law.between)));
    found.pairs.into_iter().for_each(|bond| state.bonds.put(bond));
    state.bonds.index(&state.particles.id);
    state.listing.outdate(ListStatus::Outdated);
    check_step(model, state, &grains)
}

/// Particles that may be bonded now, by id: members of rigid clumps are not.
fn grains(model: &Model, state: &State) -> Vec<Grain> {
    let p = &state.particles;
    let cell = state.cell(model);
    let stays = |k: &usize| !state.zones.is_gone(*k) && !state.clumps.is_member(*k);
    let grain = |k: usize| {
        let (id, radius) = (p.id[k], p.rows[k].radius());
        let end = End { id, radius, mass: 1.0 / p.rows[k].inverse_mass(), turn: state.bonds.turn(k) };
        let cluster = cluster_of(&state.clusters, id);
        Grain { row: k as u32, end, material: p.material[k], cluster, position: cell.wrapped(p.position(k)) }
    };
    let mut all: Vec<Grain> = (0..p.len()).filter(stays).map(grain).collect();
    all.sort_unstable_by_key(|g| g.end.id);
    all
}

/// Refuses bonds whose critical step is below that of the run.
fn check_step(model: &Model, state: &State, grains: &[Grain]) -> Result<(), Halt> {
    let mut place = vec![u32::MAX; state.particles.len()];
    (0..).zip(grains).for_each(|(at, grain)| place[grain.row as usize] = at);
    let here = |(pair, springs): (&BondedPair, &Springs)| {
        let ends = pair.ends.map(|k| place[k as usize]);
        let stays = pair.is_whole() && !ends.contains(&u32::MAX);
        stays.then(|| NewBond { ends, numbers: numbers(springs) })
    };
    let pairs: Vec<NewBond> = state.bonds.pairs.iter().zip(&state.bonds.springs).filter_map(here).collect();
    let axis = |bond: &NewBond| -> Vec3 {
        state.bonds.turn(grains[bond.ends[1] as usize].row as usize) * bond.numbers.axis
    };
    let Some((alone, worst)) = critical(&pairs, grains, axis) else { return Ok(()) };
    let critical = 1.0 / (1.0 / alone + 1.0 / model.contact_step);
    if critical >= model.dt {
        return Ok(());
    }
    let particle = bonded(&model.setup, &grains[worst as usize]);
    Err(Halt::BondsTooStiff { time: state.time(), dt: model.dt, critical, particle })
}
