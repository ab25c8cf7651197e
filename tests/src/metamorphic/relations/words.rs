//! The same scene in other words: orders, names, units, what is not used.

use super::{is_drawn, is_placed};
use crate::metamorphic::campaign::{Case, Verdict};
use crate::metamorphic::compare::{ALL, PARTICLES, Rule, WHOLE};
use crate::metamorphic::scene::{File, Scene};
use crate::metamorphic::transform::array;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use record::topic;
use toml::{Table, Value};

/// What neither names nor numbers walls.
const FREE: &[&str] = &[topic::PARTICLES, topic::BODIES, topic::BONDS, topic::ENERGY];

fn shuffle<T>(list: &mut [T], random: &mut Pcg64Mcg) {
    for k in (1..list.len()).rev() {
        list.swap(k, random.random_range(0..=k));
    }
}

/// Keys given as options.
pub fn set(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let mut options: Vec<String> = Vec::new();
    for table in ["output", "guards", "domain"] {
        let Some(Value::Table(keys)) = scene.keys.remove(table) else { continue };
        options.extend(keys.iter().map(|(key, value)| format!("{table}.{key}={value}")));
    }
    let arguments: Vec<&str> = options.iter().flat_map(|o| ["--set", o.as_str()]).collect();
    Some(case.ask(&scene, &arguments, &Rule::bits(WHOLE)))
}

/// Other names of walls, materials and clumps.
pub fn names(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let new = |name: &str| match name {
        "a" => "zinc".to_owned(),
        "b" => "ash".to_owned(),
        "*" => "*".to_owned(),
        other => format!("new {other}"),
    };
    for list in ["material", "wall", "clump"] {
        for entry in scene.list_mut(list) {
            if let Some(Value::String(name)) = entry.get_mut("name") {
                *name = new(name);
            }
        }
    }
    for list in ["wall", "clump", "fill", "insert", "particles", "contact", "bond", "body"] {
        for entry in scene.list_mut(list) {
            for key in ["material", "clump", "between", "materials"] {
                match entry.get_mut(key) {
                    Some(Value::String(name)) => *name = new(name),
                    Some(Value::Array(names)) => {
                        names.iter_mut().for_each(|n| *n = new(n.as_str().unwrap_or_default()).into());
                    }
                    _ => {}
                }
            }
        }
    }
    // The ledger and forces have rows under names; those of walls are numbered here.
    Some(case.ask(&scene, &[], &Rule::bits(ALL)))
}

/// Lengths in millimetres, moduli in kilopascals and so on: the same digits with another exponent.
pub fn units(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    in_units(&mut scene.keys, "");
    (scene != case.scene).then(|| case.ask(&scene, &[], &Rule::bits(WHOLE)))
}

/// Keys that take text with a unit: the unit, and how far its point is.
const UNITS: [(&str, &str, i32); 12] = [
    ("radius", "mm", 3),
    ("diameter", "mm", 3),
    ("gap", "um", 6),
    ("skin", "mm", 3),
    ("length", "cm", 2),
    ("until", "ms", 3),
    ("every", "us", 6),
    ("from", "ms", 3),
    ("young", "kPa", -3),
    ("density", "g/cm³", -3),
    ("velocity", "mm/s", 3),
    ("position", "mm", 3),
];

fn in_units(table: &mut Table, at: &str) {
    for (key, value) in table.iter_mut() {
        let unit = UNITS.iter().find(|u| u.0 == key && at != "output" || u.0 == key && key == "every");
        match (value, unit) {
            (Value::Table(inner), _) => in_units(inner, key),
            (Value::Array(list), None) => {
                list.iter_mut().filter_map(Value::as_table_mut).for_each(|t| in_units(t, key));
            }
            (Value::Array(list), Some((_, unit, point))) if list.iter().all(Value::is_float) => {
                list.iter_mut().for_each(|x| *x = text(x, unit, *point));
            }
            (value @ Value::Float(_), Some((_, unit, point))) => *value = text(value, unit, *point),
            _ => {}
        }
    }
}

/// The same digits with the point moved.
fn text(value: &Value, unit: &str, point: i32) -> Value {
    let Some(x) = value.as_float() else { return value.clone() };
    let written = format!("{x:e}");
    let (digits, exponent) = written.split_once('e').unwrap_or((&written, "0"));
    let exponent = exponent.parse::<i32>().unwrap_or(0) + point;
    format!("{digits}e{exponent} {unit}").into()
}

fn reversed(scene: &mut Scene, list: &str) -> bool {
    match scene.keys.get_mut(list).and_then(Value::as_array_mut) {
        Some(entries) if entries.len() > 1 => {
            entries.reverse();
            true
        }
        _ => false,
    }
}

/// Materials and contacts in another order: contacts are computed law by law, and added in that order. Numbers of materials are written, and
/// differ.
pub fn materials(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    reversed(&mut scene, "material");
    reversed(&mut scene, "contact");
    if super::jumps(&scene) {
        return None;
    }
    let topics = &[topic::BODIES, topic::BONDS, topic::ENERGY, topic::CONTACTS, topic::WALL_FORCES];
    match case.run(&scene, &[]) {
        Err(refusal) => Some(crate::metamorphic::campaign::refused(&refusal)),
        Ok(mut other) => {
            let mut base = case.base.clone();
            for answer in [&mut base, &mut other] {
                for frame in answer.frames.values_mut() {
                    let Some(rows) = frame.get_mut(topic::PARTICLES) else { continue };
                    let Some(at) = rows.columns.iter().position(|c| c == "material") else { continue };
                    rows.rows.iter_mut().for_each(|row| row[at] = 0.0);
                }
            }
            let all: Vec<&str> = topics.iter().copied().chain([topic::PARTICLES]).collect();
            Some(case.judge(&base, &other, &Rule { tolerance: case.rounding(1e-10), ..Rule::bits(&all) }))
        }
    }
}

/// Rows of files in another order, each with the id that it has.
pub fn particles(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    if scene.has(&["clump"]) || !is_placed(&scene) || is_drawn(&scene) && scene.keys.contains_key("first_id")
    {
        return None;
    }
    let mut next = scene.number("first_id").unwrap_or(0.0);
    let sources: Vec<String> = scene
        .list("particles")
        .filter_map(|p| p.get("source")?.as_str().map(str::to_owned))
        .filter(|name| name.starts_with("grains"))
        .collect();
    for name in sources {
        let Some(File::Rows(columns, rows)) = scene.files.get_mut(&name) else { continue };
        columns.push("id".to_owned());
        for row in rows.iter_mut() {
            row.push(next);
            next += 1.0;
        }
        shuffle(rows, random);
    }
    Some(case.ask(&scene, &[], &Rule::bits(WHOLE)))
}

/// Walls in another order: forces of several walls on one grain are added in another order.
pub fn walls(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    if scene.list("wall").any(|w| w.contains_key("servo"))
        || !reversed(&mut scene, "wall")
        || super::jumps(&scene)
    {
        return None;
    }
    let rule = Rule { tolerance: case.rounding(1e-10), ..Rule::bits(PARTICLES) };
    Some(case.ask(&scene, &[], &rule))
}

/// Triangles in another order, and each from another corner: pushes of several triangles on one grain are added in another order.
pub fn triangles(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = other_triangles(&case.scene, random)?;
    if super::jumps(&scene) {
        return None;
    }
    Some(case.ask(&scene, &[], &Rule { tolerance: case.rounding(1e-11), ..Rule::bits(FREE) }))
}

/// The scene with triangles in another order.
pub fn other_triangles(scene: &Scene, random: &mut Pcg64Mcg) -> Option<Scene> {
    let mut scene = scene.clone();
    let mut any = false;
    for file in scene.files.values_mut() {
        if let File::Mesh(_, triangles) = file {
            any = true;
            shuffle(triangles, random);
            triangles.iter_mut().for_each(|t| t.rotate_left(random.random_range(0..3)));
        }
    }
    any.then_some(scene)
}

/// Keys of effects that are 0.
pub fn idle_effects(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let mut changed = false;
    for contact in scene.list_mut("contact") {
        for key in ["rolling_resistance", "twisting_resistance"] {
            if contact.contains_key("sliding_friction") && !contact.contains_key(key) {
                contact.insert(key.to_owned(), 0.0.into());
                changed = true;
            }
        }
        if !contact.contains_key("sliding_friction") {
            contact.insert("sliding_friction".to_owned(), 0.0.into());
            changed = true;
        }
    }
    changed.then(|| case.ask(&scene, &[], &Rule::bits(WHOLE)))
}

/// A material that nothing has.
pub fn unused_materials(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let entry = [
        ("name", Value::from("unused")),
        ("density", 9e3.into()),
        ("young", 3e7.into()),
        ("poisson", 0.1.into()),
    ];
    scene.push("material", entry.into_iter().map(|(k, v)| (k.to_owned(), v)).collect());
    let mut law = Table::new();
    law.insert("between".to_owned(), vec!["unused".to_owned(), "a".to_owned()].into());
    law.insert("restitution".to_owned(), 0.3.into());
    law.insert("sliding_friction".to_owned(), 0.9.into());
    scene.push("contact", law);
    Some(case.ask(&scene, &[], &Rule::bits(WHOLE)))
}

/// Walls that no grain reaches, behind the others.
pub fn far_walls(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let strained = scene.get("domain.strain").is_some();
    if strained || scene.get("domain.periodic").is_some() {
        return None;
    }
    let mut wall = Table::new();
    wall.insert("plane".to_owned(), array(&[0.0, 0.0, -0.9, 0.0, 0.0, 1.0]));
    wall.insert("material".to_owned(), "b".into());
    scene.push("wall", wall);
    Some(case.ask(&scene, &[], &Rule::bits(FREE)))
}
