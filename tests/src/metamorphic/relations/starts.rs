//! A scene that starts from the end of another one: what its contacts keep goes with it.

use super::words::other_triangles;
use super::{is_placed, jumps};
use crate::metamorphic::answer::Answer;
use crate::metamorphic::campaign::{Case, Verdict, refused, time};
use crate::metamorphic::compare::{self, PARTICLES, Rule};
use crate::metamorphic::scene::Scene;
use crate::metamorphic::transform::array;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use toml::{Table, Value};

/// The same walls.
pub fn unchanged(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = case.scene.clone();
    row(case, scene, |case, whole, other| case.judge(whole, other, &Rule::bits(PARTICLES)))
}

/// The same walls in another order, with another name, with triangles in another order, behind a wall that nothing reaches.
pub fn reworded(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    if !case.scene.has(&["wall"]) || jumps(&case.scene) || case.scene.get("domain.periodic").is_some() {
        return None;
    }
    let mut scene = other_triangles(&case.scene, random).unwrap_or_else(|| case.scene.clone());
    if random.random_bool(0.6) {
        let mut far = Table::new();
        far.insert("plane".to_owned(), array(&[0.0, 0.0, -0.9, 0.0, 0.0, 1.0]));
        far.insert("material".to_owned(), "b".into());
        if let Some(Value::Array(list)) = scene.keys.get_mut("wall") {
            list.insert(0, Value::Table(far));
        }
    }
    row(case, scene, |case, whole, other| {
        case.judge(whole, other, &Rule { tolerance: case.rounding(1e-9), ..Rule::bits(PARTICLES) })
    })
}

/// Runs the first half, and `second` from its end; compares with the undivided run.
fn row(case: &Case, second: Scene, judge: fn(&Case, &Answer, &Answer) -> Verdict) -> Option<Verdict> {
    let scene = &case.scene;
    // What the second run would begin anew: bonds, insertions, motions, springs, and the state of servos, sleep and strain.
    let moves = |w: &Table| ["motion", "servo", "spring"].iter().any(|k| w.contains_key(*k));
    if !is_placed(scene)
        || scene.has(&["bond", "sleep", "outlet", "first_id"])
        || scene.list("wall").any(moves)
        || scene.get("domain.strain").is_some()
        || !scene.get("output.precision").is_none_or(|p| p.as_str() == Some("f64"))
    {
        return None;
    }
    let half = case.steps() / 4 * 2;
    let folder = case.folder();
    let until = time(half, case.base.dt).to_string();
    if let Err(refusal) = case.runner.run(&folder, scene, &["--until", &until, "-o", "settled.mcap"]) {
        return Some(refused(&refusal));
    }
    let mut second = second;
    let fixed = |p: &Table| p.get("fixed").and_then(Value::as_bool).unwrap_or(false);
    let mut particles: Vec<Value> = scene.list("particles").filter(|p| fixed(p)).cloned().map(Value::Table).collect();
    let mut run = Table::new();
    run.insert("source".to_owned(), "settled.mcap".into());
    particles.push(Value::Table(run));
    second.keys.remove("body");
    second.keys.insert("particles".to_owned(), Value::Array(particles));
    second.set("time", "until", time(case.steps() - half, case.base.dt));
    let other = match case.runner.run(&folder, &second, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    // Steps are counted from the start of the second run.
    let later = |answer: &Answer, from: u64| Answer {
        frames: answer.frames.iter().filter(|(s, _)| **s >= from).map(|(s, f)| (s - from, f.clone())).collect(),
        ..answer.clone()
    };
    let whole = later(&case.base, half);
    debug_assert!(compare::ALL.len() > PARTICLES.len());
    Some(judge(case, &whole, &other))
}
