//! Whether a scene is the one that a checkpoint was saved with.

use crate::checkpoint::Checkpoint;
use scene::SceneError;
use toml::{Table, Value};

const CURE: &str = "resume with the scene and inputs of the saved run (only time.until, [guards], when_blocked of [[insert]], and every, checkpoint and precision of [output] may change)";

impl Checkpoint {
    /// Refuses another scene than the one that was saved; its end, its output and its guards may differ.
    ///
    /// # Errors
    /// What differs.
    pub(crate) fn fits(&self, scene: &str, inputs: &[(String, String)]) -> Result<(), SceneError> {
        let refuse =
            |what: String| Err(SceneError::file("--resume", format!("the saved run differs: {what}"), CURE));
        if let Some(difference) = difference("", &fixed(&self.scene), &fixed(scene)) {
            return refuse(difference);
        }
        let others = |list: &'_ [(String, String)]| list.iter().filter(|i| i.0 != "scene").cloned().collect();
        let (saved, now): (Vec<_>, Vec<_>) = (others(&self.inputs), others(inputs));
        match (saved.iter().zip(&now).find(|(a, b)| a != b), saved.len(), now.len()) {
            (Some((a, _)), ..) => refuse(format!("the {} are others", a.0)),
            (None, then, now) if then != now => refuse(format!("{then} inputs then, {now} now")),
            _ => Ok(()),
        }
    }
}

/// The keys of a scene that may not change.
fn fixed(text: &str) -> Value {
    let mut table: Table = toml::from_str(text).unwrap_or_default();
    table.remove("guards");
    let insertions = table.get_mut("insert").and_then(Value::as_array_mut);
    for insertion in insertions.into_iter().flatten().filter_map(Value::as_table_mut) {
        insertion.remove("when_blocked");
    }
    for (key, free) in [("time", &["until"][..]), ("output", &["every", "checkpoint", "precision"])] {
        let Some(inner) = table.get_mut(key).and_then(Value::as_table_mut) else { continue };
        free.iter().for_each(|k| drop(inner.remove(*k)));
        if inner.is_empty() {
            table.remove(key);
        }
    }
    Value::Table(table)
}

/// The first key of a value, with what it is set to.
fn leaf(key: String, value: &Value) -> String {
    match value.as_table().and_then(|table| table.iter().next()) {
        Some((k, inner)) => leaf(format!("{key}.{k}"), inner),
        None => format!("{key} = {value}"),
    }
}

/// The first key whose values differ.
fn difference(key: &str, saved: &Value, now: &Value) -> Option<String> {
    use Value::{Array, Table};
    let join = |k: &str| if key.is_empty() { k.to_owned() } else { format!("{key}.{k}") };
    match (saved, now) {
        (Table(a), Table(b)) => {
            let keys = a.keys().chain(b.keys().filter(|k| !a.contains_key(*k)));
            keys.into_iter().find_map(|k| match (a.get(k), b.get(k)) {
                (Some(x), Some(y)) => difference(&join(k), x, y),
                (Some(x), None) => Some(format!("{} is gone", leaf(join(k), x))),
                (None, y) => y.map(|y| format!("{} is new", leaf(join(k), y))),
            })
        }
        (Array(a), Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().find_map(|(i, (x, y))| difference(&join(&i.to_string()), x, y))
        }
        (Array(a), Array(b)) => Some(format!("{key} had {} entries, now {}", a.len(), b.len())),
        _ => (saved != now).then(|| format!("{key} was {saved}, now {now}")),
    }
}
