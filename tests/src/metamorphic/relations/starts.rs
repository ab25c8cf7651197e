//! A scene that starts from the end of another one: what its contacts keep goes with it.

use super::words::other_triangles;
use super::{is_placed, jumps};
use crate::metamorphic::answer::{Answer, Refusal};
use crate::metamorphic::campaign::{Case, Verdict, refused, time};
use crate::metamorphic::compare::{self, PARTICLES, Rule};
use crate::metamorphic::scene::Scene;
use crate::metamorphic::transform::array;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use std::path::PathBuf;
use toml::{Table, Value};

/// Largest difference of an undivided run and of two in a row, over the largest speed, that is not asked to become smaller [–].
const SMALL: f64 = 1e-3;

/// The undivided run, and two in a row. Velocities are written at the time of positions, so forces that depend on them begin half a step
/// late: the difference is of the order of the step.
pub fn unchanged(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    (!case.scene.list("particles").any(is_fixed)).then(|| divided(case)).flatten()
}

/// The same where some grains are fixed: these are walls without a name.
pub fn on_fixed(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    case.scene.list("particles").any(is_fixed).then(|| divided(case)).flatten()
}

fn is_fixed(entry: &Table) -> bool {
    entry.get("fixed").and_then(Value::as_bool).unwrap_or(false)
}

fn divided(case: &Case) -> Option<Verdict> {
    if !is_divisible(&case.scene) || jumps(&case.scene) {
        return None;
    }
    let off = |parts: u32| -> Result<[f64; 2], Refusal> {
        let mut scene = case.scene.clone();
        scene.set("time", "dt", case.base.dt / f64::from(parts));
        let (steps, dt) = (case.steps() * u64::from(parts), case.base.dt / f64::from(parts));
        let whole = case.run(&scene, &[])?;
        let half = steps / 4 * 2;
        let folder = first(case, &scene, half, dt)?;
        let other = second(case, &folder, &scene, &scene, steps - half, dt)?;
        let frames =
            whole.frames.iter().filter(|(s, _)| **s >= half).map(|(s, f)| (s - half, f.clone())).collect();
        let speeds = whole.last().and_then(|f| f.get(record::topic::PARTICLES)).map_or(0.0, |rows| {
            let v = rows.columns.iter().position(|c| c == "vx").unwrap_or(0);
            rows.rows.iter().flat_map(|row| &row[v..v + 3]).fold(0.0, |most: f64, x| most.max(x.abs()))
        });
        let deviations = compare::deviations(&Answer { frames, ..whole }, &other);
        Ok([deviations.get("/particles vx").copied().unwrap_or(0.0), speeds])
    };
    match (off(2), off(8)) {
        (Err(refusal), _) | (_, Err(refusal)) => Some(refused(&refusal)),
        (Ok([coarse, _]), Ok([fine, speed])) if fine > 0.6 * coarse && fine > SMALL * speed => {
            Some(Verdict::Differs(format!(
                "with a quarter of the step velocities differ by {fine:e} m/s, before by {coarse:e} m/s"
            )))
        }
        _ => Some(Verdict::Same),
    }
}

/// The same walls with triangles in another order, and behind a wall that nothing reaches.
pub fn reworded(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = &case.scene;
    if !scene.has(&["wall"]) || !is_divisible(scene) || jumps(scene) || scene.get("domain.periodic").is_some()
    {
        return None;
    }
    let mut other = other_triangles(scene, random).unwrap_or_else(|| scene.clone());
    if random.random_bool(0.6) {
        let mut far = Table::new();
        far.insert("plane".to_owned(), array(&[0.0, 0.0, -0.9, 0.0, 0.0, 1.0]));
        far.insert("material".to_owned(), "b".into());
        if let Some(Value::Array(list)) = other.keys.get_mut("wall") {
            list.insert(0, Value::Table(far));
        }
    }
    let (half, dt) = (case.steps() / 4 * 2, case.base.dt);
    let runs = first(case, scene, half, dt).and_then(|folder| {
        let one = second(case, &folder, scene, scene, case.steps() - half, dt)?;
        Ok((one, second(case, &folder, scene, &other, case.steps() - half, dt)?))
    });
    match runs {
        Err(refusal) => Some(refused(&refusal)),
        Ok((one, other)) => {
            Some(case.judge(&one, &other, &Rule { tolerance: case.rounding(1e-9), ..Rule::bits(PARTICLES) }))
        }
    }
}

/// Whether a second run goes on with everything: not with bonds, insertions, motions, springs, servos and sleep, which it begins again.
fn is_divisible(scene: &Scene) -> bool {
    let moves = |w: &Table| ["motion", "servo", "spring"].iter().any(|k| w.contains_key(*k));
    is_placed(scene)
        && !scene.has(&["bond", "sleep", "outlet", "first_id"])
        && !scene.list("wall").any(moves)
        && scene.get("domain.strain").is_none()
}

/// Runs the first part of a scene; the folder with its run.
fn first(case: &Case, scene: &Scene, steps: u64, dt: f64) -> Result<PathBuf, Refusal> {
    let folder = case.folder();
    let until = time(steps, dt).to_string();
    case.runner.run(&folder, scene, &["--until", &until, "-o", "settled.mcap"])?;
    Ok(folder)
}

/// Runs a scene from the end of the first part.
fn second(
    case: &Case,
    folder: &std::path::Path,
    before: &Scene,
    scene: &Scene,
    steps: u64,
    dt: f64,
) -> Result<Answer, Refusal> {
    let mut scene = scene.clone();
    let mut particles: Vec<Value> =
        before.list("particles").filter(|p| is_fixed(p)).cloned().map(Value::Table).collect();
    particles.push(Value::Table([("source".to_owned(), "settled.mcap".into())].into_iter().collect()));
    scene.keys.remove("body");
    scene.keys.insert("particles".to_owned(), Value::Array(particles));
    scene.set("time", "until", time(steps, dt));
    case.runner.run(folder, &scene, &[])
}
