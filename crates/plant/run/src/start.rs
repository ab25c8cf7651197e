//! How a run begins: the engine, and the head of its file.

use crate::error::Result;
use crate::frames;
use crate::schedule::Schedule;
use crate::settling::Settling;
use crate::supply::Supply;
use crate::underway::{Outcome, Run, Settings, Written};
use dem::Simulation;
use dem::setup::{Setup, WallDetail, WallShape, Zone, ZoneMotion};
use geom::Shown;
use record::{BondRange, Map, MaterialRecord, RunTimes, Sizes, json, metadata};
use scene::input::ZoneRecord;
use scene::plan::NO_DENSITY;
use scene::{Below, Plan, Scene, SceneError};
use stages::outlet::path;
use std::io::Write;
use stream::mcap::Writer;

impl<W: Write> Run<W> {
    pub(crate) fn start(scene: &Scene, plan: Plan, out: W, settings: Settings<W>) -> Result<Run<W>> {
        let Plan { mut setup, step, insertions, inlets, warnings, inputs, sizes, places, below } = plan;
        let mut supply = Supply::new(inlets, insertions)?;
        if let Some(saved) = &settings.resume {
            saved.fits(&scene.text.toml, &inputs)?;
            supply.resume(saved)?;
        }
        let surfaces = frames::surfaces(&setup.walls);
        let mut written = Written::new(scene, &setup, inputs);
        setup.record_wrenches = written.output.contacts || written.wall_forces || written.settling.any();
        let head = Head::new(scene, &setup, sizes)?;
        let mut sim = match settings.resume {
            Some(saved) => Simulation::resume(setup, saved.state)?,
            None => Simulation::new(setup)?,
        };
        if let Some(device) = settings.device {
            sim.use_device(device).map_err(|refused| not_computed(&refused))?;
        }
        let schedule = Schedule::new(scene, sim.dt())?;
        not_yet_over(sim.steps(), &schedule)?;
        written.sampling = sampling(scene, sim.dt())?;
        written.watched = settings.watched;
        written.below = below;
        let mut writer = Writer::compressed(out, &settings.provenance, settings.how)?;
        let begins = settings.earlier.as_ref().map_or(sim.time(), |earlier| earlier.start);
        for (name, record) in head.records([sim.dt(), begins], &schedule, written.sampling) {
            writer.metadata(name, record)?;
        }
        if let Some(Below { down, depth }) = below {
            let down = format!("{},{},{}", down.x, down.y, down.z);
            let end =
                [("down", down), ("depth", depth.to_string())].map(|(key, text)| (key.to_owned(), text));
            writer.metadata(metadata::WALLS_END, Map::from(end))?;
        }
        if !places.is_empty() {
            writer.metadata(metadata::PLACES, places)?;
        }
        let first = sim.steps();
        let mut run = Run {
            outcome: Outcome { dt: sim.dt(), chosen_by: step, device: sim.device(), ..Outcome::default() },
            sampled: Some(first).filter(|step| *step > 0),
            sim,
            supply,
            writer,
            cracks_told: first > 0 && schedule.is_frame(first),
            schedule,
            written,
            first,
            begins_written: first > 0,
            crossings: Vec::new(),
            paths: Vec::new(),
            frame_energy: None,
            peak: 0.0,
            before: None,
            saved_at: 0.0,
            checkpoints: 0,
        };
        let warnings: Vec<String> = warnings.iter().map(|text| in_file(scene, text)).collect();
        match settings.earlier {
            None => run.write_walls(&surfaces, &warnings)?,
            Some(earlier) => {
                run.cracks_told = earlier.copy(&mut run.writer, run.sim.time())?;
                run.begins_written = !run.schedule.is_frame(first);
                run.writer.flush_chunk()?;
            }
        }
        Ok(run)
    }
}

/// What a device does not compute.
fn not_computed(refused: &[String]) -> SceneError {
    let why = format!("it does not compute {} (docs/how-to/gpu.md says what it does)", refused.join(", "));
    SceneError::file("--device", why, "leave the option out, or these out of the scene")
}

/// A warning as the output has it: without the name and the folder that the scene happened to be given by.
pub(crate) fn in_file(scene: &Scene, text: &str) -> String {
    let of_scene = text.strip_prefix(&scene.text.name).filter(|rest| rest.starts_with([':', ' ']));
    let folder = scene.folder.join("").display().to_string();
    match of_scene {
        Some(rest) => format!("scene{rest}"),
        None => text.strip_prefix(&folder).unwrap_or(text).to_owned(),
    }
}

impl Written {
    fn new(scene: &Scene, setup: &Setup, inputs: Vec<(String, String)>) -> Written {
        let domain = &scene.keys.domain;
        let density = |m: u16| setup.materials[m as usize].density;
        let spheres_move = |w: &dem::setup::Wall| matches!(w.shape, WallShape::Spheres(_)) && w.moves();
        Written {
            scene: scene.text.toml.clone(),
            inputs,
            walls: frames::heads(setup),
            walls_move: setup.walls.iter().any(spheres_move),
            outlets: !setup.outlets.is_empty(),
            masses: setup.clumps.shapes.iter().map(|s| s.mass(1.0, density(s.material))).collect(),
            output: scene.keys.output.clone(),
            domain: (!domain.strain.is_empty() || domain.source.is_some()).then_some(setup.periodic),
            wall_forces: setup.wall_sums != WallDetail::Off,
            wear: setup.wall_sums == WallDetail::Parts,
            sampling: None,
            watched: false,
            below: None,
            ledger: setup.ledger,
            settling: Settling::of(&scene.keys.time),
        }
    }
}

/// What of a scene and its setup is in the metadata records of a run; a record that is not there is empty.
pub(crate) struct Head {
    scene: Map,
    materials: Map,
    sizes: Map,
    clumps: Map,
    bonds: Map,
    outlets: Vec<ZoneRecord>,
}

impl Head {
    pub(crate) fn new(scene: &Scene, setup: &Setup, sizes: Option<Sizes>) -> Result<Head> {
        let materials: Vec<MaterialRecord> = setup.materials.iter().map(material).collect();
        let clumps = frames::clumps(&setup.clumps);
        let only_clumps =
            !clumps.is_empty() && setup.particles.is_empty() && setup.entry_materials.is_empty();
        let sizes = sizes.map(|sizes| {
            let only = only_clumps.then(|| (metadata::ONLY_CLUMPS.to_owned(), "true".to_owned()));
            sizes.to_map().into_iter().chain(only).collect::<Map>()
        });
        // Bonds are for a stage downstream.
        let bonds = if setup.outlets.is_empty() { None } else { dem::bonds_of(setup)? };
        let bonds = bonds.map(|b| BondRange { step: b.step, longest: b.longest }.to_map());
        let zone = |(zone, i): (&Zone, usize)| ZoneRecord {
            zone: *zone,
            gravity: Some(setup.gravity),
            plant: scene.keys.outlet.get(i).and_then(|o| o.plant.clone()),
            samples: None,
        };
        Ok(Head {
            scene: Map::from([("toml".to_owned(), scene.text.toml.clone())]),
            materials: MaterialRecord::to_map(&materials),
            sizes: sizes.unwrap_or_default(),
            clumps,
            bonds: bonds.unwrap_or_default(),
            outlets: setup.outlets.iter().zip(0..).map(zone).collect(),
        })
    }

    /// All records that are there, in the order of the file, of a run from `start` [s] in steps of `dt` [s].
    pub(crate) fn records(
        self,
        [dt, start]: [f64; 2],
        schedule: &Schedule,
        sampling: Option<u64>,
    ) -> impl Iterator<Item = (&'static str, Map)> {
        let end = schedule.last as f64 * schedule.dt;
        let times = RunTimes { dt: Some(dt), start: Some(start), end: Some(end) };
        let every = sampling.map(|steps| steps as f64 * dt);
        let outlet = |(mut zone, i): (ZoneRecord, usize)| {
            zone.samples = every.filter(|_| zone.zone.motion == ZoneMotion::Recorded);
            (i.to_string(), json(&zone))
        };
        let all = [
            (metadata::SCENE, self.scene),
            (metadata::MATERIALS, self.materials),
            (metadata::TIME, times.to_map()),
            (metadata::SIZES, self.sizes),
            (metadata::OUTLETS, self.outlets.into_iter().zip(0..).map(outlet).collect()),
            (metadata::CLUMPS, self.clumps),
            (metadata::BONDS, self.bonds),
        ];
        all.into_iter().filter(|(name, record)| *name == metadata::MATERIALS || !record.is_empty())
    }
}

fn material(m: &dem::setup::Material) -> MaterialRecord {
    MaterialRecord {
        name: m.name.clone(),
        density: (m.density > NO_DENSITY).then_some(m.density),
        young: Some(m.young),
        poisson: Some(m.poisson),
        ..MaterialRecord::default()
    }
}

/// Refuses to resume a run that has reached its end.
pub(crate) fn not_yet_over(steps: u64, schedule: &Schedule) -> Result<(), SceneError> {
    if steps < schedule.last {
        return Ok(());
    }
    let (reached, end) = (Shown(steps as f64 * schedule.dt), Shown(schedule.last as f64 * schedule.dt));
    let why = format!("the saved run has reached {reached} s, the scene ends at {end} s");
    Err(SceneError::file("--resume", why, "give a later --until"))
}

/// Steps between samples of paths, where an outlet records them.
fn sampling(scene: &Scene, dt: f64) -> Result<Option<u64>, SceneError> {
    let mut least = None;
    let outlets = scene.keys.outlet.iter().enumerate();
    for (i, outlet) in outlets.filter(|(_, o)| o.motion == ZoneMotion::Recorded) {
        let steps = outlet.samples.map_or(path::STEPS, |time| (time / dt).round().max(1.0));
        if steps > path::MOST_STEPS {
            let value = format!("{} s", Shown(outlet.samples.unwrap_or(0.0)));
            let why = format!("is more than {} steps", path::MOST_STEPS);
            let cure = format!("use at most {} s", Shown(path::MOST_STEPS * dt));
            return Err(scene.wrong(&format!("outlet.{i}.samples"), value, &why, &cure));
        }
        let steps = steps as u64;
        least = Some(least.map_or(steps, |other: u64| other.min(steps)));
    }
    Ok(least)
}
