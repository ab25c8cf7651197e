//! What a run begins with: the engine, and the head of its file.

use super::{CLUMPS, OUTLETS, Outcome, Run, RunError, Settings, json};
use crate::checkpoint::Checkpoint;
use crate::crossings::{self, ONLY_CLUMPS, SIZES};
use crate::error::SceneError;
use crate::feeds::Supply;
use crate::frames;
use crate::gate::Gate;
use crate::links;
use crate::material_info::{self, MATERIALS};
use crate::paths;
use crate::schedule::Schedule;
use crate::{Plan, Scene, input::SCENE};
use dem::Simulation;
use dem::setup::ZoneMotion;
use std::collections::BTreeMap;
use std::io::Write;
use stream::mcap::Writer;

type Record = BTreeMap<String, String>;

impl<W: Write> Run<W> {
    pub(super) fn start(
        scene: &Scene,
        plan: Plan,
        resume: Option<Checkpoint>,
        out: W,
        settings: Settings<W>,
    ) -> Result<Run<W>, RunError> {
        let mut supply = Supply::new(plan.feeds);
        if let Some(saved) = &resume {
            saved.fits(&scene.text.toml, &plan.inputs)?;
            let samples = supply.samples();
            supply.skip(&saved.given, saved.state.time() + saved.state.look_ahead() + samples)?;
        }
        let walls = frames::heads(&plan.setup);
        let surfaces = frames::surfaces(&plan.setup.walls);
        let materials = material_info::to_map(&plan.setup.materials);
        let (zones, gravity) = (plan.setup.outlets.clone(), plan.setup.gravity);
        let moving = spheres_move(&plan.setup.walls);
        let shapes = frames::clumps(&plan.setup.clumps);
        let clumps = !shapes.is_empty();
        let only_clumps = clumps && plan.setup.particles.is_empty() && plan.setup.entry_materials.is_empty();
        let density = |m: u16| plan.setup.materials[m as usize].density;
        let masses = plan.setup.clumps.shapes.iter().map(|s| s.mass(1.0, density(s.material))).collect();
        let follows = plan.setup.walls.iter().any(|w| w.motion.servo.is_some());
        let wall_forces = scene.model.output.wall_forces || follows;
        let recorded = scene.model.output.contacts || wall_forces;
        // What a stage downstream has to know of them.
        let bonds = if zones.is_empty() { None } else { dem::bonds_of(&plan.setup)? };
        let mut sim = match resume {
            Some(saved) => Simulation::resume(plan.setup, saved.state)?,
            None => Simulation::new(plan.setup)?,
        };
        sim.record_loads(recorded);
        let schedule = Schedule::new(scene, sim.dt())?;
        if sim.steps() >= schedule.last {
            let why = format!(
                "the saved run has reached {} s, the scene ends at {} s",
                geom::Shown(sim.time()),
                geom::Shown(schedule.last as f64 * schedule.dt)
            );
            return Err(SceneError::file("--resume", why, "give a later --until").into());
        }
        let sampling = sampling(scene, sim.dt())?;
        let sampled = Some(sim.steps()).filter(|step| *step > 0);
        let every = sampling.map(|steps| steps as f64 * sim.dt());
        let gate = |(i, zone): (usize, &dem::setup::Zone)| {
            let plant = scene.model.outlet.get(i).and_then(|o| o.plant.clone());
            let samples = every.filter(|_| zone.motion == ZoneMotion::Recorded);
            let gate = Gate { zone: *zone, gravity: Some(gravity), plant, samples };
            (i.to_string(), json(&gate))
        };
        let outlets: Record = zones.iter().enumerate().map(gate).collect();
        let mut writer = Writer::compressed(out, &settings.provenance, settings.how)?;
        for (name, mut record) in records(scene, &schedule, &sim, materials, plan.sizes, &outlets) {
            if name == SIZES && only_clumps {
                record.insert(ONLY_CLUMPS.to_owned(), "true".to_owned());
            }
            writer.metadata(name, record)?;
        }
        if clumps {
            writer.metadata(CLUMPS, shapes)?;
        }
        if let Some(bonds) = bonds {
            writer.metadata(links::BONDS, links::to_map(&bonds))?;
        }
        let mut run = Run {
            outcome: Outcome { dt: sim.dt(), chosen_by: plan.step, ..Outcome::default() },
            sim,
            supply,
            writer,
            schedule,
            scene: scene.text.toml.clone(),
            inputs: plan.inputs,
            walls,
            moving,
            outlets: !outlets.is_empty(),
            clumps,
            masses,
            energy: scene.model.output.energy,
            contacts: scene.model.output.contacts,
            wall_forces,
            precision: scene.model.output.precision,
            crossings: Vec::new(),
            sampling,
            sampled,
            paths: Vec::new(),
            looked: None,
            watched: false,
            before: None,
            looked_at: 0.0,
            checkpoints: 0,
        };
        run.write_walls(&surfaces, &plan.notes)?;
        Ok(run)
    }
}

/// The metadata of a run: scene, materials, sizes, times, outlets.
fn records(
    scene: &Scene,
    schedule: &Schedule,
    sim: &Simulation,
    materials: Record,
    sizes: Option<crossings::Sizes>,
    outlets: &Record,
) -> Vec<(&'static str, Record)> {
    let times = [("dt", sim.dt()), ("start", sim.time()), ("end", schedule.last as f64 * schedule.dt)];
    let times = times.iter().map(|(k, v)| ((*k).to_owned(), v.to_string())).collect();
    let mut records = vec![
        (SCENE, Record::from([("toml".to_owned(), scene.text.toml.clone())])),
        (MATERIALS, materials),
        ("time", times),
    ];
    records.extend(sizes.map(|s| (SIZES, s.to_map())));
    if !outlets.is_empty() {
        records.push((OUTLETS, outlets.clone()));
    }
    records
}

/// Steps between samples of paths, where an outlet records them.
fn sampling(scene: &Scene, dt: f64) -> Result<Option<u64>, SceneError> {
    let mut least = None;
    for (i, outlet) in scene.model.outlet.iter().enumerate().filter(|(_, o)| o.motion == ZoneMotion::Recorded)
    {
        let steps = outlet.samples.map_or(paths::STEPS, |time| (time / dt).round().max(1.0));
        if steps > paths::MOST_STEPS {
            let check = crate::check::Check { text: &scene.text };
            let most = geom::Shown(paths::MOST_STEPS * dt);
            let value = format!("{} s", geom::Shown(outlet.samples.unwrap_or(0.0)));
            let (why, cure) =
                (format!("is more than {} steps", paths::MOST_STEPS), format!("use at most {most} s"));
            return Err(check.wrong(&format!("outlet.{i}.samples"), value, &why, &cure));
        }
        let steps = steps as u64;
        least = Some(least.map_or(steps, |other: u64| other.min(steps)));
    }
    Ok(least)
}

/// Whether wall spheres move, so that they are written with every frame.
fn spheres_move(walls: &[dem::setup::Wall]) -> bool {
    walls.iter().any(|w| matches!(w.shape, dem::setup::WallShape::Spheres(_)) && w.motion.moves())
}
