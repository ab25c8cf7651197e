//! What a scene switches on, why, and what it costs (`--explain`).
//!
//! [`explain`] builds the engine without running it, lists effects with the keys that call for them ([`effects`], [`keys`]), counts what
//! comes in ([`Coming`]), and runs a part of the scene with and without each effect ([`calibration`]). [`text`] writes the answer.

mod calibration;
mod effects;
mod keys;
mod text;

use crate::error::Result;
use crate::schedule::Schedule;
use crate::stop::guard;
pub use calibration::Calibration;
use dem::setup::{Guards, Setup, Wall, WallShape};
use dem::{ContactBytes, MatchedDamping, Simulation, critical_step};
pub use effects::Effect;
use effects::{EffectToMeasure, effects};
use geom::{Shown, counted};
use scene::advice::explain_step_cause;
use scene::keys::Insert;
use scene::plan::{ImpactError, Insertion, impact_error};
use scene::{Plan, Scene};
use serde::Serialize;
use stages::inlet::InletStream;

/// Step over another one from which on it is longer [–].
const LONGER: f64 = 1.001;

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
    pub wall_spheres: usize,
    /// Particles that come in.
    pub coming: Coming,
    /// Time step [s].
    pub dt: f64,
    /// Critical time step [s].
    pub critical_dt: f64,
    /// Which measured curve the time step relies on, when the scene asks for an accuracy.
    pub chosen_by: Option<String>,
    /// What an impact is off by at this step, where that was measured.
    pub impact_error: Option<ImpactError>,
    /// The pair that limits it.
    pub limiting_pair: String,
    /// Critical step with half of `guards.overlap`, where that lengthens it [s].
    pub critical_dt_half_overlap: Option<f64>,
    /// `guards.overlap` [–].
    pub guard_overlap: f64,
    /// Critical step with a restitution of 1 everywhere, where that lengthens it [s].
    pub critical_dt_elastic: Option<f64>,
    /// Steps of the run.
    pub steps: u64,
    pub effects: Vec<Effect>,
    /// Damping that is matched to the step.
    pub matched_damping: Vec<MatchedDamping>,
    /// Keys of the scene that have no effect, and why.
    pub dropped: Vec<String>,
    /// State of a particle [B].
    pub bytes_per_particle: usize,
    /// Bytes of a listed contact, without the history of its effects [B].
    pub bytes_per_contact: ContactBytes,
    /// Bonds at t = 0.
    pub bonds: usize,
    /// Bytes of a bond, with those of its particles; when there are some.
    pub bytes_per_bond: Option<f64>,
    /// What a GPU does not compute of it; empty: it computes all.
    pub not_on_a_gpu: Vec<String>,
    /// Whether anything turns particles.
    pub rotation: bool,
    /// Time of a step, when it was measured.
    pub calibration: Option<Calibration>,
    /// Why it could not be.
    pub unmeasured: Option<String>,
    /// Expected time of the run [s], when it is known.
    pub expected_seconds: Option<f64>,
}

/// What comes in while a run goes on, as far as that is known before.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coming {
    /// Keys of the insertions.
    #[serde(rename = "faucets")]
    pub insertions: Vec<String>,
    /// When those that repeat open and close.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub repeats: Vec<String>,
    /// Particles that they bring until the end, and the mean number of these over the run.
    pub particles: (f64, f64),
    /// Keys of the inlets, whose particles are not known before.
    pub streams: Vec<String>,
}

/// When an insertion opens and closes, if it repeats.
fn repeats((i, entry): (usize, &Insert)) -> Option<String> {
    let shown = |number: f64, unit: &str| format!("{} {unit}", Shown(number));
    let (from, period) = (shown(entry.from, "s"), shown(entry.repeat?, "s"));
    let often =
        entry.times.map_or("without end".to_owned(), |times| format!("{} in all", counted(times, "time")));
    let open = entry.until.map(|until| format!("after {}", shown(until - entry.from, "s")));
    let mass = entry.mass.map(|mass| format!("after {}", shown(mass, "kg")));
    let count = entry.count.map(|count| format!("after {}", counted(count, "grain")));
    let ends = open.into_iter().chain(mass).chain(count).chain(["when the next begins".to_owned()]);
    let ends = ends.collect::<Vec<_>>().join(" or ");
    Some(format!("insert.{i} opens at {from} and every {period}, {often}; each time ends {ends}"))
}

impl Coming {
    /// Of these insertions and so many streams, until a time [s].
    fn new(scene: &Scene, insertions: &[Insertion], streams: usize, end: f64) -> Coming {
        let expected = insertions.iter().map(|insertion| insertion.expected(end));
        Coming {
            insertions: insertions.iter().flat_map(|insertion| insertion.keys().map(str::to_owned)).collect(),
            repeats: scene.keys.insert.iter().enumerate().filter_map(repeats).collect(),
            particles: expected.fold((0.0, 0.0), |sum, more| (sum.0 + more.all, sum.1 + more.mean)),
            streams: (0..streams).map(|k| format!("inlet.{k}")).collect(),
        }
    }

    /// Mean number of particles over the run, where none of the `start` leaves, over those that were there when a step was measured.
    /// `None`: unknown.
    fn growth(&self, start: usize, measured: usize) -> Option<f64> {
        let mean = start as f64 + self.particles.1;
        match (self.streams.is_empty(), self.insertions.is_empty()) {
            (true, true) => Some(1.0),
            (true, false) => Some(mean / measured as f64),
            (false, _) => None,
        }
    }
}

/// Explains a scene; `measure` also runs a part of it, with and without each effect.
///
/// # Errors
/// Whatever would keep the scene from running.
pub fn explain(scene: &Scene, plan: Plan, measure: bool) -> Result<Explained> {
    let Plan { mut setup, step: chosen_by, insertions, inlets, .. } = plan;
    let mut streams = inlets.into_iter().map(InletStream::new).collect::<Result<Vec<_>, _>>()?;
    let limit = critical_step(&setup)?;
    let critical_dt_half_overlap = half_overlap(&mut setup, limit.dt)?;
    let critical_dt_elastic = elastic(&mut setup, limit.dt)?;
    let particles = setup.particles.len() + setup.clumps.members();
    // They are most of a scene: what only checks it has them once.
    let placed = std::mem::take(&mut setup.particles);
    let mut whole = setup.clone();
    if measure {
        setup.particles.clone_from(&placed);
    }
    whole.particles = placed;
    let mut sim = Simulation::new(whole)?;
    if let Err(halt) = sim.ready() {
        guard(scene, &halt)?;
    }
    let Schedule { dt, last, .. } = Schedule::new(scene, sim.dt())?;
    streams.iter_mut().try_for_each(|stream| stream.check(dt * last as f64))?;
    let matched_damping = sim.matched_damping();
    let (bytes_per_particle, rotation) = (sim.bytes_per_particle(), sim.rotates());
    let (bonds, bytes_per_contact) = (sim.bond_count()[0], sim.bytes_of_contact());
    let bytes_per_bond = (bonds > 0).then(|| sim.bytes_of_bonds() as f64 / bonds as f64);
    let not_on_a_gpu = sim.not_on_a_device();
    drop(sim);
    let coming = Coming::new(scene, &insertions, streams.len(), dt * last as f64);
    // The middle of the run at the latest: its end may be at rest.
    let measured = measure.then(|| Calibration::new(setup.clone(), &insertions, last / 2));
    let calibration = measured.as_ref().and_then(|m| m.as_ref().ok()).copied();
    let measured_effect = |effect: EffectToMeasure| effect.measured(calibration, &insertions);
    let fields = Fields {
        particles,
        wall_spheres: setup.walls.iter().map(wall_spheres).sum(),
        dt,
        critical_dt: limit.dt,
        chosen_by,
        impact_error: impact_error(&setup.contacts, scene.keys.time.contacts, dt / limit.dt),
        critical_dt_half_overlap,
        guard_overlap: setup.guards.overlap,
        critical_dt_elastic,
        limiting_pair: explain_step_cause(&limit.cause),
        steps: last,
        effects: effects(scene, &setup).into_iter().map(measured_effect).collect(),
        matched_damping,
        dropped: keys::dropped(scene, &setup),
        bytes_per_particle,
        bytes_per_contact,
        bonds,
        bytes_per_bond,
        not_on_a_gpu,
        rotation,
        calibration,
        unmeasured: measured.and_then(Result::err),
        expected_seconds: calibration
            .and_then(|c| Some(c.seconds_per_step * last as f64 * coming.growth(particles, c.particles)?)),
        coming,
    };
    let [particles, walls] =
        [(particles, "particle"), (setup.walls.len(), "wall")].map(|(n, of)| counted(n, of));
    let summary = format!("{particles}, {walls}, {} of {dt:.3e} s", counted(last, "step"));
    Ok(Explained { text: text::text(&fields), summary, fields })
}

/// Critical step with half of the overlap guard, where that is longer: the stiffness of the limiting pair is that at the guard.
fn half_overlap(setup: &mut Setup, critical: f64) -> Result<Option<f64>> {
    let guards = Guards { overlap: 0.5 * setup.guards.overlap, ..setup.guards };
    let given = std::mem::replace(&mut setup.guards, guards);
    let found = critical_step(setup);
    setup.guards = given;
    let dt = found?.dt;
    Ok(Some(dt).filter(|dt| *dt > LONGER * critical))
}

/// Critical step with a restitution of 1 everywhere, where that is longer: a dashpot makes a contact stiffer.
fn elastic(setup: &mut Setup, critical: f64) -> Result<Option<f64>> {
    let given = setup.contacts.clone();
    for law in setup.contacts.iter_mut().filter(|law| law.number("restitution").is_some()) {
        law.set("restitution", 1.0);
    }
    let found = critical_step(setup);
    setup.contacts = given;
    let dt = found?.dt;
    Ok(Some(dt).filter(|dt| *dt > LONGER * critical))
}

fn wall_spheres(wall: &Wall) -> usize {
    match &wall.shape {
        WallShape::Spheres(spheres) => spheres.len(),
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn insertions_that_repeat_say_when_they_open_and_close() {
        let words = |keys: &str| {
            let insert = format!(
                "[[insert]]\nmaterial = \"m\"\nshape = \"sphere:0,0,0,1\"\ndiameter = 0.1\nvelocity = [0, 0, -1]\nrate = 1\n{keys}"
            );
            let scene = Scene::new("s", insert, &[], std::path::Path::new("")).expect("a scene");
            scene.keys.insert.iter().enumerate().filter_map(repeats).collect::<Vec<_>>().join("\n")
        };
        assert_eq!(words("until = 1"), "");
        let of_mass = "insert.0 opens at 2 s and every 5 s, without end; each time ends after 3 kg or when the next begins";
        assert_eq!(words("from = 2\nrepeat = 5\nmass = 3"), of_mass);
        let twice = "insert.0 opens at 1 s and every 5 s, 2 times in all; each time ends after 2 s or after 1 grain or when the next begins";
        assert_eq!(words("from = 1\nuntil = 3\nrepeat = 5\ncount = 1\ntimes = 2"), twice);
    }
}
