//! Every key of a scene, in each form of its value: each stands in a scene here, and every scene runs.

mod scenes;

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::line;
use grainpipe_tests::written::note;
use scene::keys::{Row, rows};
use scenes::{FILES, FLAT, before, scenes};
use std::collections::BTreeMap;
use toml::{Table, Value};

/// Every value in the scenes, by the dotted key without indices.
fn values() -> BTreeMap<String, Vec<Value>> {
    fn add(found: &mut BTreeMap<String, Vec<Value>>, at: &str, value: &Value) {
        match value {
            Value::Table(table) => {
                table.iter().for_each(|(key, value)| {
                    add(found, format!("{at}.{key}").trim_start_matches('.'), value)
                });
            }
            Value::Array(list) if list.iter().any(Value::is_table) => {
                list.iter().for_each(|v| add(found, at, v))
            }
            _ => {}
        }
        found.entry(at.to_owned()).or_default().push(value.clone());
    }
    let mut found = BTreeMap::new();
    for (name, text) in scenes() {
        let table: Table = toml::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        add(&mut found, "", &Value::Table(table));
    }
    found
}

/// Forms of a type that no value has.
fn missing(kind: &str, values: &[Value]) -> Vec<String> {
    let has = |wanted: &dyn Fn(&Value) -> bool| values.iter().any(wanted);
    let number = |v: &Value| v.is_float() || v.is_integer();
    let mut forms: Vec<(String, bool)> = Vec::new();
    for word in kind.split('"').skip(1).step_by(2) {
        let is = |v: &Value| v.as_str() == Some(word);
        forms.push((
            format!("\"{word}\""),
            has(&|v| is(v) || v.as_array().is_some_and(|list| list.iter().any(is))),
        ));
    }
    for part in kind.split(" or ") {
        let found = match part {
            "number" | "integer" => has(&number),
            "2 numbers" => has(&|v| v.as_array().is_some_and(|list| list.len() == 2)),
            "true/false" => has(&|v| v.as_bool() == Some(true)) && has(&|v| v.as_bool() == Some(false)),
            _ => !values.is_empty(),
        };
        forms.push((part.to_owned(), found));
    }
    forms.into_iter().filter(|form| !form.1).map(|form| form.0).collect()
}

#[test]
fn every_key_stands_in_a_scene_in_each_form() {
    let (rows, values) = (rows(), values());
    assert!(rows.len() > 200, "{} rows", rows.len());
    let wrong = |(key, row): &(String, Row)| {
        let found = values.get(key).map_or(&[][..], |found| found);
        let missing = missing(&row.kind, found);
        (!missing.is_empty()).then(|| format!("{key}: {}", missing.join(", ")))
    };
    let wrong: Vec<String> = rows.iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "without a scene in every_key/scenes.rs: {wrong:#?}");
}

#[test]
fn every_scene_runs() {
    let folder = folder(&FILES);
    let path = folder.path();
    for (name, text) in scenes() {
        std::fs::write(path.join(format!("{name}.toml")), text).expect("written");
    }
    std::fs::write(path.join("flat.xyz"), FLAT).expect("written");
    for command in before() {
        let done = line(path, &command);
        assert_eq!(done.code, 0, "{command}: {}", done.stderr);
    }
    let wrong = |(name, _): &(String, String)| {
        let done = line(path, &format!("dem-run {name}.toml -o {name}.run.mcap"));
        (done.code != 0).then(|| format!("{name}: {}", done.stderr))
    };
    let wrong: Vec<String> = scenes().iter().filter_map(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    note("keys", path, &[]);
}

/// Puts one more value behind each list at a dotted key, in turn; the changed scenes.
fn with_one_more(table: &Table, key: &str) -> Vec<String> {
    fn lists<'a>(value: &'a mut Value, path: &[&str], found: &mut Vec<&'a mut Vec<Value>>) {
        match (value, path) {
            (Value::Array(list), []) => found.push(list),
            (Value::Array(list), _) => list.iter_mut().for_each(|v| lists(v, path, found)),
            (Value::Table(table), [first, rest @ ..]) => {
                if let Some(value) = table.get_mut(*first) {
                    lists(value, rest, found);
                }
            }
            _ => {}
        }
    }
    let path: Vec<&str> = key.split('.').collect();
    let changed = |n: usize| {
        let mut whole = Value::Table(table.clone());
        let mut found = Vec::new();
        lists(&mut whole, &path, &mut found);
        let list = found.into_iter().nth(n)?;
        list.push(list.last().expect("no list of fixed length is empty").clone());
        Some(whole.to_string())
    };
    (0..).map_while(changed).collect()
}

/// A key that takes so many values refuses one more: it would be lost.
#[test]
fn nothing_behind_the_end_of_a_list_is_lost() {
    let counts = |part: &str| part.trim_start_matches("list of ").starts_with(|c: char| c.is_ascii_digit());
    let fixed = |row: &Row| row.kind.split(" or ").any(counts);
    let rows: Vec<(String, Row)> = rows().into_iter().filter(|(_, row)| fixed(row)).collect();
    let (mut tried, mut taken) = (0, Vec::new());
    for (name, text) in scenes() {
        let table: Table = toml::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        for (key, _) in &rows {
            for longer in with_one_more(&table, key) {
                tried += 1;
                if scene::Scene::new("s.toml", longer, &[], std::path::Path::new("")).is_ok() {
                    taken.push(format!("{name}: {key}"));
                }
            }
        }
    }
    assert!(taken.is_empty() && tried > 80, "{tried} tried: {taken:#?}");
}
