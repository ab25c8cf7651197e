//! What a scene switches on, why, and what it costs.

use crate::run::RunError;
use crate::schedule::Schedule;
use crate::{Plan, Scene};
use dem::setup::{Precision, Setup};
use dem::{Simulation, critical_step};
use serde::Serialize;
use std::fmt::Write;
use std::time::Instant;

/// Time that a measurement takes at least [s].
const MEASURE: f64 = 0.15;
/// Steps that a measurement takes at most: the start of a run, before anything can go wrong.
const MOST: u32 = 500;

/// The answer.
pub struct Explained {
    /// For people: several lines.
    pub text: String,
    /// One line.
    pub summary: String,
    /// For machines.
    pub fields: Fields,
}

/// The answer's numbers.
#[derive(Debug, Clone, Serialize)]
pub struct Fields {
    /// Particles at t = 0.
    pub particles: usize,
    /// Wall spheres.
    pub wall_spheres: usize,
    /// Time step [s].
    pub dt: f64,
    /// Critical time step [s].
    pub critical_dt: f64,
    /// Which measured curve the time step relies on, when the scene asks for an accuracy.
    pub chosen_by: Option<String>,
    /// The pair that limits it.
    pub limiting_pair: String,
    /// Steps of the run.
    pub steps: u64,
    /// Effects.
    pub effects: Vec<Effect>,
    /// What the scene asks for and cannot matter: key and pair.
    pub dropped: Vec<String>,
    /// State of a particle [B].
    pub bytes_per_particle: usize,
    /// Everything that a listed contact takes [B], when there are some at the start.
    pub bytes_per_listed_contact: Option<f64>,
    /// Bonds at t = 0.
    pub bonds: usize,
    /// What one takes [B], with what is kept of its particles; when there are some.
    pub bytes_per_bond: Option<f64>,
    /// Whether anything turns particles.
    pub rotation: bool,
    /// Measured time of a step at the start [s], when it was measured.
    pub seconds_per_step: Option<f64>,
}

/// One effect of a scene.
#[derive(Debug, Clone, Serialize)]
pub struct Effect {
    /// Its name.
    pub name: String,
    /// Which keys call for it.
    pub why: String,
    /// Memory between steps [B] for each contact.
    pub bytes_per_contact: usize,
    /// Measured share of a step, when it was measured: how much faster the scene is without it, negative where it is slower [–].
    pub share: Option<f64>,
}

/// Explains a scene; `measure` also runs some steps, with and without each effect.
///
/// # Errors
/// Whatever would keep the scene from running.
pub fn explain(scene: &Scene, plan: Plan, measure: bool) -> Result<Explained, RunError> {
    let chosen = plan.step;
    let mut setup = plan.setup;
    let dropped = drop_idle(&mut setup);
    let limit = critical_step(&setup)?;
    let mut sim = Simulation::new(setup.clone())?;
    if let Err(halt) = sim.particles() {
        crate::run::stopped(scene, 0, halt)?;
    }
    let schedule = Schedule::new(scene, sim.dt())?;
    let (bytes_per_particle, rotation) = (sim.bytes_per_particle(), sim.rotates());
    let bonds = sim.bond_count()[0];
    let bytes_per_bond = (bonds > 0).then(|| sim.bytes_of_bonds() as f64 / bonds as f64);
    let bytes_per_listed_contact = (sim.listed_contacts() > 0).then(|| sim.bytes_per_listed_contact());
    let whole = measure.then(|| time_step(sim)).flatten();
    let effects = effects(&setup).into_iter().map(|(mut effect, without)| {
        let less = without.filter(|_| measure).and_then(|s| Simulation::new(s).ok()).and_then(time_step);
        effect.share = less.zip(whole).map(|(less, whole)| 1.0 - less / whole);
        effect
    });
    let spheres = setup.walls.iter().map(|w| match &w.shape {
        dem::setup::WallShape::Spheres(s) => s.len(),
        _ => 0,
    });
    let fields = Fields {
        particles: setup.particles.len() + setup.clumps.members(),
        wall_spheres: spheres.sum(),
        dt: schedule.dt,
        critical_dt: limit.dt,
        chosen_by: chosen,
        limiting_pair: limit.pair,
        steps: schedule.last,
        effects: effects.collect(),
        dropped,
        bytes_per_particle,
        bytes_per_listed_contact,
        bonds,
        bytes_per_bond,
        rotation,
        seconds_per_step: whole,
    };
    let summary = format!(
        "{} particles, {} walls, {} steps of {:.3e} s",
        fields.particles,
        setup.walls.len(),
        fields.steps,
        fields.dt
    );
    Ok(Explained { text: text(&fields), summary, fields })
}

fn text(fields: &Fields) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = writeln!(
        out,
        "time step      {:.4e} s, {:.3} of the critical {:.4e} s",
        fields.dt,
        fields.dt / fields.critical_dt,
        fields.critical_dt
    );
    if let Some(chosen) = &fields.chosen_by {
        let _ = writeln!(out, "chosen by      {chosen}");
    }
    let _ = writeln!(out, "limited by     {}", fields.limiting_pair);
    let _ = writeln!(out, "steps          {}", fields.steps);
    let _ = writeln!(out, "particles      {}, and {} wall spheres", fields.particles, fields.wall_spheres);
    if let Some(seconds) = fields.seconds_per_step {
        let hours = seconds * fields.steps as f64;
        let _ =
            writeln!(out, "measured       {:.3e} s a step at the start: {hours:.1} s for the run", seconds);
    }
    let _ = writeln!(out, "\n{:22} {:>10} {:>8}  called for by", "effect", "B/contact", "share");
    for e in &fields.effects {
        let share = e.share.map_or("–".to_owned(), |s| format!("{:.0} %", 100.0 * s));
        let _ = writeln!(out, "{:22} {:>10} {:>8}  {}", e.name, e.bytes_per_contact, share, e.why);
    }
    let turns = if fields.rotation { "" } else { ", without rotation: nothing here turns a particle" };
    let _ = writeln!(out, "\nmemory         {} B a particle{turns}", fields.bytes_per_particle);
    if let Some(bytes) = fields.bytes_per_listed_contact {
        let _ = writeln!(out, "               {bytes:.0} B a listed contact, lists and loads included");
    }
    if let Some(bytes) = fields.bytes_per_bond {
        let _ = writeln!(out, "               {bytes:.0} B a bond, {} bonds", fields.bonds);
    }
    for key in &fields.dropped {
        let _ = writeln!(out, "dropped        {key}: 0 cannot matter, nothing of it is computed");
    }
    out
}

/// Takes effects away that cannot matter, and says which.
fn drop_idle(setup: &mut Setup) -> Vec<String> {
    let name = |m: u16| setup.materials[m as usize].name.as_str();
    let mut dropped = Vec::new();
    let needed = setup.contacts.iter().map(|c| {
        let (less, keys) = dem::needed(c);
        dropped.extend(keys.iter().map(|k| format!("{k} ({}–{})", name(c.between.0), name(c.between.1))));
        less
    });
    setup.contacts = needed.collect();
    dropped
}

/// Every effect, and the setup without it where there is one.
fn effects(setup: &Setup) -> Vec<(Effect, Option<Setup>)> {
    let mut found = contact_effects(setup);
    let mut add = |name: &str, why: String, bytes: usize, without: Option<Setup>| {
        if !why.is_empty() {
            let effect = Effect { name: name.into(), why, bytes_per_contact: bytes, share: None };
            found.push((effect, without));
        }
    };
    let named = |there: bool, key: &str| if there { key.to_owned() } else { String::new() };
    let (body, member) = Simulation::bytes_of_clump();
    let clumps = setup.clumps.shapes.iter().map(|s| format!("'{}' of {}", s.name, s.spheres.len()));
    let clumps = clumps.collect::<Vec<_>>().join(", ");
    let why = format!("[[clump]] {clumps}: {body} B a body, {member} B a member");
    add("clump", if clumps.is_empty() { clumps } else { why }, 0, None);
    let name = |m: u16| setup.materials[m as usize].name.as_str();
    let bonds = setup.bonds.iter().map(|b| format!("{}–{}", name(b.between.0), name(b.between.1)));
    let bonds = bonds.collect::<Vec<_>>().join(", ");
    let why = format!("[[bond]] {bonds}");
    let loose = Setup { bonds: Vec::new(), entry_bonds: None, ..setup.clone() };
    add("bond", if bonds.is_empty() { bonds } else { why }, 0, Some(loose));
    add("gravity", named(setup.gravity.norm() > 0.0, "gravity"), 0, None);
    let dry = Setup { drag: None, ..setup.clone() };
    let law = setup.drag.map(|d| format!("drag.law = {:?}", d.law).to_lowercase());
    add("drag", law.unwrap_or_default(), 0, Some(dry));
    let ledger = Setup { ledger: false, ..setup.clone() };
    add("energy", named(setup.ledger, "output.energy, output.contacts or guards.energy"), 0, Some(ledger));
    let clumps = setup.clumps.shapes.len();
    add("clumps", if clumps > 0 { format!("{clumps} [[clump]]") } else { String::new() }, 0, None);
    let awake = Setup { sleep: None, ..setup.clone() };
    add("sleep", named(setup.sleep.is_some(), "sleep"), 0, Some(awake));
    let double = Setup { precision: Precision::Double, ..setup.clone() };
    add("mixed precision", named(setup.precision == Precision::Mixed, "precision"), 0, Some(double.clone()));
    add("single precision", named(setup.precision == Precision::Single, "precision"), 0, Some(double));
    let zones = |n: usize, key: &str| if n > 0 { format!("{n} [[{key}]]") } else { String::new() };
    add("outlet", zones(setup.outlets.len(), "outlet"), 0, None);
    add("inlet", zones(setup.inlets.len(), "inlet or insert"), 0, None);
    let moving = setup.walls.iter().filter(|w| w.motion != dem::setup::Motion::still());
    let names: Vec<&str> = moving.map(|w| w.name.as_str()).collect();
    add("wall motion", names.join(", "), 0, None);
    found
}

/// Effects of contact, each once, with the pairs that call for it.
fn contact_effects(setup: &Setup) -> Vec<(Effect, Option<Setup>)> {
    let name = |m: u16| setup.materials[m as usize].name.as_str();
    let mut found: Vec<(Effect, Option<Setup>)> = Vec::new();
    for (at, c) in setup.contacts.iter().enumerate() {
        let pair = format!("{}–{}", name(c.between.0), name(c.between.1));
        for part in dem::parts(c) {
            let known = found.iter().position(|(e, _)| e.name == part.effect);
            let Some(known) = known else {
                let less = part.without.map(|c| {
                    let mut less = setup.clone();
                    less.contacts[at] = c;
                    less
                });
                let (name, bytes_per_contact) = (part.effect.to_owned(), part.bytes);
                found.push((Effect { name, why: pair.clone(), bytes_per_contact, share: None }, less));
                continue;
            };
            let (effect, less) = &mut found[known];
            effect.why = format!("{}, {pair}", effect.why);
            effect.bytes_per_contact = effect.bytes_per_contact.max(part.bytes);
            if let (Some(less), Some(c)) = (less, part.without) {
                less.contacts[at] = c;
            }
        }
    }
    found
}

/// Time of a step [s], from the start of a scene; `None` when a guard stops it.
fn time_step(mut sim: Simulation) -> Option<f64> {
    sim.step().ok()?;
    let start = Instant::now();
    let mut steps = 0;
    loop {
        sim.step().ok()?;
        steps += 1;
        let passed = start.elapsed().as_secs_f64();
        if (passed > MEASURE && steps >= 10) || steps == MOST {
            return Some(passed / f64::from(steps));
        }
    }
}
