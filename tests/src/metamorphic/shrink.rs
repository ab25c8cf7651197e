//! Makes the smallest scene that still fails a relation.

use super::answer::Runner;
use super::campaign::{Case, Failure, Verdict, random};
use super::scene::{File, Scene};
use toml::Value;

/// Most runs of the relation while a scene is made smaller.
const TRIES: usize = 250;

/// The words of the difference, if the scene fails the relation.
fn fails(runner: &Runner, scene: &Scene, failure: &Failure) -> Option<String> {
    let case = Case::pinned(runner, scene.clone()).ok()?;
    match failure.relation.asks(&case, &mut random(failure.seed, failure.relation.name)) {
        Some(Verdict::Differs(words)) => Some(words),
        _ => None,
    }
}

/// Shrinks the scene of a failure as far as it goes.
pub fn shrink(runner: &Runner, failure: &mut Failure) {
    let mut left = TRIES;
    loop {
        let before = failure.scene.clone();
        for smaller in candidates(&before) {
            if left == 0 {
                return;
            }
            left -= 1;
            if smaller != failure.scene
                && let Some(words) = fails(runner, &smaller, failure)
            {
                failure.words = words;
                failure.scene = smaller;
                break;
            }
        }
        if failure.scene == before {
            return;
        }
    }
}

/// Scenes that are a little smaller, the largest cuts first.
fn candidates(scene: &Scene) -> Vec<Scene> {
    let mut all = Vec::new();
    let keys: Vec<String> = scene.keys.keys().cloned().collect();
    let needed = ["time", "material", "contact", "output"];
    for key in keys.iter().filter(|k| !needed.contains(&k.as_str())) {
        let mut smaller = scene.clone();
        smaller.keys.remove(key);
        all.push(smaller);
    }
    let named = scene.keys.to_string();
    if scene.files.keys().any(|name| !named.contains(name.as_str())) {
        let mut smaller = scene.clone();
        smaller.files.retain(|name, _| named.contains(name.as_str()));
        all.push(smaller);
    }
    // Half of the rows, then one.
    for (name, file) in &scene.files {
        let File::Rows(_, rows) = file else { continue };
        if !name.starts_with("grains") && !name.starts_with("clumps") {
            continue;
        }
        let mut size = rows.len() / 2;
        while size >= 1 {
            for from in (0..rows.len()).step_by(size) {
                let mut smaller = scene.clone();
                if let Some(File::Rows(_, rows)) = smaller.files.get_mut(name) {
                    rows.drain(from..(from + size).min(rows.len()));
                    if rows.is_empty() {
                        continue;
                    }
                }
                all.push(smaller);
            }
            size /= 2;
        }
    }
    for key in &keys {
        match scene.keys.get(key) {
            Some(Value::Array(list)) => {
                for k in 0..list.len() {
                    let mut smaller = scene.clone();
                    if let Some(Value::Array(list)) = smaller.keys.get_mut(key) {
                        list.remove(k);
                    }
                    all.push(smaller);
                    entries(scene, key, Some(k), &mut all);
                }
            }
            Some(Value::Table(_)) => entries(scene, key, None, &mut all),
            _ => {}
        }
    }
    all
}

/// Without one key of a table.
fn entries(scene: &Scene, key: &str, at: Option<usize>, all: &mut Vec<Scene>) {
    let value = scene.keys.get(key);
    let entry = value.and_then(|v| at.map_or(Some(v), |k| v.as_array()?.get(k)));
    let Some(Value::Table(table)) = entry else { return };
    // Without its step a scene would have another one for each change.
    for name in table.keys().filter(|name| key != "time" || !["dt", "until"].contains(&name.as_str())) {
        let mut smaller = scene.clone();
        let value = smaller.keys.get_mut(key);
        let entry = value.and_then(|v| match at {
            Some(k) => value_at(v, k),
            None => Some(v),
        });
        if let Some(Value::Table(table)) = entry {
            table.remove(name);
        }
        all.push(smaller);
    }
}

fn value_at(value: &mut Value, k: usize) -> Option<&mut Value> {
    value.as_array_mut().and_then(|list| list.get_mut(k))
}
