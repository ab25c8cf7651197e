//! How a run is computed and written does not change what happens.

use crate::metamorphic::answer::{Answer, Rows};
use crate::metamorphic::campaign::{Case, Verdict, refused, time};
use crate::metamorphic::compare::{PARTICLES, Rule, WHOLE};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use record::topic;

/// Any number of threads.
pub fn threads(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let threads = random.random_range(2..4).to_string();
    Some(case.ask(&case.scene, &["--threads", &threads], &Rule::bits(WHOLE)))
}

/// The program of the GPU, on this processor. It keeps no ledger.
pub fn device(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    for key in ["energy", "contacts", "wall_forces"] {
        scene.set("output", key, false);
    }
    scene.keys.get_mut("guards").and_then(|g| g.as_table_mut()).map(|guards| guards.remove("energy"));
    match case.ask(&scene, &["--device", "local"], &Rule::bits(&[topic::PARTICLES, topic::BODIES])) {
        // What it does not compute it says.
        Verdict::Refused(words) if words.contains("--device: it does not compute") => None,
        verdict => Some(verdict),
    }
}

/// Other times of frames and checkpoints. The work of contacts is that since the frame before.
pub fn interval(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let part = random.random_range(1..5);
    scene.set("output", "every", time(case.steps() / 4, case.base.dt) / f64::from(part));
    scene.set("output", "checkpoint", case.base.dt * random.random_range(3.0..50.0));
    let topics =
        &[topic::PARTICLES, topic::BODIES, topic::BONDS, topic::ENERGY, topic::WALL_FORCES, topic::HISTORY];
    Some(case.ask(&scene, &[], &Rule::bits(topics)))
}

/// The opposite of what is written.
pub fn switches(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    for key in ["energy", "contacts", "wall_forces"] {
        let on = scene.get(&format!("output.{key}")).and_then(|v| v.as_bool()).unwrap_or(false);
        scene.set("output", key, !on);
    }
    // The guard keeps the ledger.
    scene.keys.get_mut("guards").and_then(|g| g.as_table_mut()).map(|guards| guards.remove("energy"));
    let topics =
        &[topic::PARTICLES, topic::BODIES, topic::BONDS, topic::CRACKS, topic::HISTORY, topic::CROSSINGS];
    Some(case.ask(&scene, &[], &Rule::bits(topics)))
}

/// Interrupted at any step.
pub fn resumed(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    interrupted(case, random, &[])
}

/// Interrupted, and written as one.
pub fn whole(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    interrupted(case, random, &["--whole"])
}

fn interrupted(case: &Case, random: &mut Pcg64Mcg, more: &[&str]) -> Option<Verdict> {
    // Before the third quarter, so that two frames follow.
    let step = random.random_range(1..case.steps() * 3 / 4);
    let (folder, until) = (case.folder(), time(step, case.base.dt).to_string());
    if let Err(refusal) = case.runner.run(&folder, &case.scene, &["--until", &until, "-o", "begun.mcap"]) {
        return Some(refused(&refusal));
    }
    let mut arguments = vec!["scene.toml", "--resume", "begun.mcap"];
    arguments.extend(more);
    match case.runner.call(&folder, &arguments) {
        Err(refusal) => Some(Verdict::Differs(format!(
            "a run that was interrupted at step {step} cannot be resumed: {}",
            refusal.words
        ))),
        Ok(mut other) => {
            // The frame at the interruption is left out, and its cracks come in a message of their own.
            let mut base = case.base.clone();
            [&mut base, &mut other].into_iter().for_each(gather_cracks);
            let topics = if more.is_empty() { PARTICLES } else { WHOLE };
            Some(case.judge(&base, &other, &Rule::bits(topics)))
        }
    }
}

/// All cracks in the last frame.
fn gather_cracks(answer: &mut Answer) {
    let mut all: Option<Rows> = None;
    for frame in answer.frames.values_mut() {
        if let Some(rows) = frame.remove(topic::CRACKS) {
            match &mut all {
                Some(all) => all.rows.extend(rows.rows),
                None => all = Some(rows),
            }
        }
    }
    if let (Some(all), Some(mut last)) = (all, answer.frames.last_entry()) {
        last.get_mut().insert(topic::CRACKS.to_owned(), all);
    }
}
