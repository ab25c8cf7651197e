//! Grains that come in during the run: all of them are atoms from the start.
//!
//! ```text
//! wait   at rest at a place of their own, upstream of everything
//! come   straight, at about the speed that they will have, to where they enter, x_e at t_e
//! zone   x = x_e + v_e τ + ½ a τ²,  τ = t − t_e,  a = g in a ballistic zone, else 0
//! free   from t_f on, when they reach the end of their zone
//! ```
//!
//! Until t_f nothing acts on an atom but the force here, m a and two kicks, so that it is exactly on its path in every step: with a kick of
//! m Δv/Δt in step k and velocities half a step later, x(k+1) = x(k) + (v + Δv) Δt. In step n, the first at or after t_e, it must be at
//! x(n Δt), and half a step before at v(n Δt) − ½ a Δt; the kick comes in step n − 1. In step 0 a force acts for half a step only: it has no kick.

use crate::arrival::{Arrival, Way};
use crate::depot::Depot;
use crate::error::{LammpsError, Refusal, Result};
use crate::inflow::Inflow;
use crate::outlet;
use dem::Simulation;
use dem::setup::{Entry, Particle, Setup, Zone};
use geom::{Shown, Vec3};
use run::{RunError, Schedule};
use scene::Plan;
use scene::plan::{Insertion, Planned};

/// A step that does not come.
const NEVER: f64 = 1e15;

/// Adds all grains of a plan that come in until the end to its setup, which has the members of clumps, where they are at t = 0; in the order of their ids.
///
/// # Errors
/// Insertions without space for all; grains that the engine refuses, too.
pub fn add(setup: &mut Setup, plan: &Plan, inflow: &Inflow, schedule: &Schedule) -> Result<Vec<Arrival>> {
    let mut entries = inserted(&plan.insertions, schedule.end())?;
    let streamed = inflow.entries.iter().filter(|e| e.time <= schedule.end());
    entries.splice(0..0, streamed.copied());
    entries.sort_by(|a, b| a.time.total_cmp(&b.time));
    if !inflow.entries.is_empty() {
        check(&plan.setup, &entries)?;
    }
    let mut all = Vec::with_capacity(entries.len());
    let mut particles = Vec::with_capacity(entries.len());
    for (inlet, zone) in (0..).zip(&setup.inlets) {
        let here: Vec<&Entry> = entries.iter().filter(|e| e.inlet == inlet).collect();
        let depot = Depot::new(setup, zone, &here).map_err(|refusal| LammpsError::Cannot(vec![refusal]))?;
        for (number, entry) in here.into_iter().enumerate() {
            let (arrival, particle) =
                arrival(setup, zone, entry, depot.place(number), (schedule.dt, depot.speed));
            all.push(arrival);
            particles.push(particle);
        }
    }
    if let Some(refusal) = outlet::takes_waiting(setup, &particles) {
        return Err(LammpsError::Cannot(vec![refusal]));
    }
    setup.particles.extend(particles);
    all.sort_by_key(|arrival| arrival.id);
    Ok(all)
}

/// What insertions bring until a time [s].
fn inserted(insertions: &[Insertion], end: f64) -> Result<Vec<Entry>> {
    let mut all = Vec::new();
    for insertion in insertions {
        let mut insertion = insertion.clone();
        while insertion.next_time().is_some_and(|time| time <= end) {
            let Some(Planned { entry, blocked }) = insertion.next_entry()? else { break };
            if blocked {
                return Err(LammpsError::Cannot(vec![without_room(&insertion, &entry)]));
            }
            all.push(entry);
        }
    }
    Ok(all)
}

/// Why a grain cannot come in that others leave no room for.
fn without_room(insertion: &Insertion, entry: &Entry) -> Refusal {
    let keys: Vec<&str> = insertion.keys().collect();
    let (size, time) = (Shown(2.0 * entry.particle.radius), Shown(entry.time));
    let why =
        format!("leave no room for a grain of {size} m at {time} s, and in LAMMPS none waits or is left out");
    Refusal::new(keys.join(" and "), why, "use lower rates, wider shapes, or another from for one of them")
}

/// Has the engine refuse what it would refuse in dem-run, in its words.
fn check(setup: &Setup, entries: &[Entry]) -> Result<()> {
    let setup = Setup { clusters: Vec::new(), ..setup.clone() };
    let mut engine = Simulation::new(setup).map_err(RunError::from)?;
    entries.iter().try_for_each(|entry| engine.enter(*entry)).map_err(RunError::from)?;
    Ok(())
}

/// The first step at or after a time [s].
fn step_at(time: f64, dt: f64) -> f64 {
    let mut step = (time / dt).ceil().max(0.0);
    while step > 0.0 && (step - 1.0) * dt >= time {
        step -= 1.0;
    }
    while step * dt < time {
        step += 1.0;
    }
    step
}

/// Where a grain waits, and how it comes from there, at about a speed [m/s].
fn arrival(
    setup: &Setup,
    zone: &Zone,
    entry: &Entry,
    place: Vec3,
    (dt, speed): (f64, f64),
) -> (Arrival, Particle) {
    let (p, a) = (&entry.particle, zone.acceleration(&setup.gravity));
    let past = zone.past(&p.position, p.radius);
    // The engine has refused those that never arrive.
    let free = entry.time + zone.arrives_after(past, &p.velocity, &setup.gravity).unwrap_or(0.0);
    let first = step_at(entry.time, dt);
    let tau = first * dt - entry.time;
    let there = p.position + p.velocity * tau + a * (0.5 * tau * tau);
    let velocity = p.velocity + a * tau;
    let half_before = velocity - a * (0.5 * dt);
    let falls = if a == Vec3::zeros() { NEVER } else { first };
    let never = (NEVER, Vec3::zeros());
    let (position, start, leaves, comes) = match first {
        0.0 => (there, velocity, never, never),
        1.0 => (there - half_before * dt, half_before, never, never),
        _ => {
            let (comes, end) = (first - 1.0, there - half_before * dt);
            let way = end - place;
            let steps = (way.norm() / (speed * dt)).ceil().max(1.0);
            if steps < comes {
                let u = way / (steps * dt);
                (place, Vec3::zeros(), (comes - steps, u), (comes, half_before - u))
            } else {
                // There is no time to wait: it is on its way from the start.
                let u = way.try_normalize(0.0).unwrap_or_else(Vec3::zeros) * speed;
                (end - u * (comes * dt), u, never, (comes, half_before - u))
            }
        }
    };
    let arrival = Arrival { id: p.id, enters: entry.time, free, way: Way { falls, leaves, comes } };
    (arrival, Particle { position, velocity: start, ..*p })
}
