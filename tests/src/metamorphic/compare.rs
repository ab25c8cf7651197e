//! Where two answers differ that must be one.

use super::answer::{Answer, Frame, Rows};
use super::meaning::{Kind, column, width};
use super::transform::Transform;
use record::topic;
use std::collections::BTreeMap;

/// How much two answers may differ.
#[derive(Debug, Clone, Copy)]
pub enum Tolerance<'a> {
    /// Not at all.
    Bits,
    /// As much as rounding makes of a scene: a multiple of what a change of the last digits does to the same scene, which grows with
    /// its collisions; and this share of the largest number of the column.
    Rounding(&'a Deviations, f64),
}

/// The largest differences of each group of columns: `/particles vx`.
pub type Deviations = BTreeMap<String, f64>;

/// Most that a difference may be over that of the disturbed scene: two changes of the last digits differ by their size and by where
/// they are.
const AMPLIFIED: f64 = 2000.0;

/// What is compared, and how rows of one answer are found in the other.
#[derive(Debug, Clone)]
pub struct Rule<'a> {
    /// What was done to the frame and to the units.
    pub transform: Transform,
    /// New ids of particles; absent: the same.
    pub ids: Option<BTreeMap<u32, u32>>,
    /// New indices of walls; absent: the same.
    pub walls: Option<Vec<u32>>,
    /// Topics.
    pub topics: &'a [&'a str],
    /// Terms of the ledger that are left out.
    pub without: &'a [&'a str],
    /// How exact.
    pub tolerance: Tolerance<'a>,
    /// Period of each axis in the second answer [m], 0 where there is none: a contact across a face is at either side of the cell.
    pub periods: [f64; 3],
}

/// What a scene of other words has in common with the first one.
pub const PARTICLES: &[&str] = &[topic::PARTICLES, topic::BODIES];
/// The same with what acts between them.
pub const ALL: &[&str] =
    &[topic::PARTICLES, topic::BODIES, topic::CONTACTS, topic::BONDS, topic::ENERGY, topic::WALL_FORCES];
/// The same with everything that is written of contacts.
pub const WHOLE: &[&str] = &[
    topic::PARTICLES,
    topic::BODIES,
    topic::CONTACTS,
    topic::BONDS,
    topic::ENERGY,
    topic::WALL_FORCES,
    topic::CRACKS,
    topic::HISTORY,
    topic::CROSSINGS,
];

impl<'a> Rule<'a> {
    /// Nothing changed but the words.
    pub fn bits(topics: &'a [&'a str]) -> Rule<'a> {
        Rule {
            transform: Transform::default(),
            ids: None,
            walls: None,
            topics,
            without: &[],
            tolerance: Tolerance::Bits,
            periods: [0.0; 3],
        }
    }
}

/// The first difference beyond the tolerance, in words.
pub fn difference(base: &Answer, other: &Answer, rule: &Rule) -> Option<String> {
    let mut common = 0;
    for (step, frame) in &base.frames {
        let Some(second) = other.frames.get(step) else { continue };
        common += usize::from(frame.contains_key(topic::PARTICLES) && second.contains_key(topic::PARTICLES));
        if let Some(words) = frames(frame, second, rule) {
            return Some(format!("step {step}: {words}"));
        }
    }
    (common < 2).then(|| format!("the runs have {common} frames at the same steps"))
}

fn frames(frame: &Frame, second: &Frame, rule: &Rule) -> Option<String> {
    for topic in rule.topics {
        let (Some(a), Some(b)) = (frame.get(*topic), second.get(*topic)) else { continue };
        let found = match matched(topic, a, b, rule) {
            Ok(found) => found,
            Err(words) => return Some(format!("{topic}: {words}")),
        };
        for (group, worst) in found {
            if !rule.allows(&group, &worst) {
                let Worst { deviation, row, values, largest } = worst;
                return Some(format!(
                    "{group} of {row}: {:e} instead of {:e}, {deviation:e} off (largest {largest:e})",
                    values[1], values[0]
                ));
            }
        }
    }
    None
}

/// The largest differences of two runs of one scene, over all frames.
pub fn deviations(base: &Answer, other: &Answer) -> Deviations {
    let mut all = Deviations::new();
    let rule = Rule { tolerance: Tolerance::Rounding(&Deviations::new(), f64::INFINITY), ..Rule::bits(ALL) };
    for (step, frame) in &base.frames {
        let Some(second) = other.frames.get(step) else { continue };
        for topic in ALL {
            let (Some(a), Some(b)) = (frame.get(*topic), second.get(*topic)) else { continue };
            let found = matched(topic, a, b, &rule).unwrap_or_default();
            for (group, worst) in found {
                let at = all.entry(group).or_insert(0.0);
                *at = at.max(worst.deviation);
            }
        }
    }
    all
}

/// The largest difference of a group of columns.
struct Worst {
    deviation: f64,
    row: String,
    values: [f64; 2],
    largest: f64,
}

impl Rule<'_> {
    fn allows(&self, group: &str, worst: &Worst) -> bool {
        match self.tolerance {
            Tolerance::Bits => worst.deviation == 0.0,
            Tolerance::Rounding(noise, share) => {
                let noise = noise.get(group).copied().unwrap_or(0.0);
                worst.deviation <= AMPLIFIED * noise + share * worst.largest
            }
        }
    }

    fn is_exact(&self) -> bool {
        matches!(self.tolerance, Tolerance::Bits)
    }

    fn id(&self, id: f64) -> u32 {
        let id = id as u32;
        self.ids.as_ref().and_then(|map| map.get(&id).copied()).unwrap_or(id)
    }
}

/// A row under its name.
struct Named {
    name: String,
    /// Orders rows of one name.
    order: f64,
    values: Vec<f64>,
}

fn matched(topic: &str, a: &Rows, b: &Rows, rule: &Rule) -> Result<BTreeMap<String, Worst>, String> {
    let (first, second) = (named(topic, a, rule, true), named(topic, b, rule, false));
    if a.columns != b.columns && topic != topic::PARTICLES {
        return Err(format!("columns {:?} and {:?}", a.columns, b.columns));
    }
    let mut found: BTreeMap<String, Worst> = BTreeMap::new();
    let largest = largest(&a.columns, &first);
    let forces = a.columns.iter().position(|c| c == "fx");
    let (mut i, mut j) = (0, 0);
    let mut lone = Vec::new();
    while i < first.len() || j < second.len() {
        let order = match (first.get(i), second.get(j)) {
            (Some(x), Some(y)) => x.name.cmp(&y.name),
            (Some(_), None) => std::cmp::Ordering::Less,
            _ => std::cmp::Ordering::Greater,
        };
        match order {
            std::cmp::Ordering::Less => {
                lone.push((&first[i], "missing"));
                i += 1;
            }
            std::cmp::Ordering::Greater => {
                lone.push((&second[j], "new"));
                j += 1;
            }
            std::cmp::Ordering::Equal => {
                row(topic, a, b, [&first[i], &second[j]], &largest, rule, &mut found);
                (i, j) = (i + 1, j + 1);
            }
        }
    }
    for (row, what) in lone {
        // A contact that has just begun, or is about to end, may be on one side only where rounding counts.
        match forces.filter(|_| topic == topic::CONTACTS && !rule.is_exact()) {
            Some(k) => {
                let force = row.values[k..k + 3].iter().map(|x| x * x).sum::<f64>().sqrt();
                let group = format!("{topic} fx");
                let size = largest[k];
                let worst =
                    Worst { deviation: force, row: row.name.clone(), values: [0.0, force], largest: size };
                keep(&mut found, group, worst);
            }
            None => return Err(format!("row {} is {what}", row.name)),
        }
    }
    Ok(found)
}

fn keep(found: &mut BTreeMap<String, Worst>, group: String, worst: Worst) {
    match found.get_mut(&group) {
        Some(old) if worst.deviation <= old.deviation => {}
        Some(old) => *old = worst,
        None => {
            found.insert(group, worst);
        }
    }
}

/// Share of a velocity over a radius below which a spin is rounding [–].
const ROUNDED_SPIN: f64 = 1e-6;

/// The largest number of the group of each column.
fn largest(columns: &[String], rows: &[Named]) -> Vec<f64> {
    let mut all: Vec<f64> =
        (0..columns.len()).map(|k| rows.iter().map(|r| r.values[k].abs()).fold(0.0, f64::max)).collect();
    let mut k = 0;
    while k < columns.len() {
        let wide = width(column(&columns[k])).min(columns.len() - k);
        let most = all[k..k + wide].iter().copied().fold(0.0, f64::max);
        all[k..k + wide].fill(most);
        k += wide;
    }
    // Spins that are nothing beside velocities over radii are the rounding of these.
    let at = |name: &str| columns.iter().position(|c| c == name);
    if let (Some(w), Some(v), Some(r)) = (at("wx"), at("vx"), at("radius"))
        && all[r] > 0.0
    {
        let most = all[w].max(ROUNDED_SPIN * all[v] / all[r]);
        all[w..w + 3].fill(most);
    }
    // A ledger's terms are parts of one sum.
    if columns == ["energy"] {
        all[0] = rows.iter().map(|r| r.values[0].abs()).sum();
    }
    all
}

/// Columns that name a row and are not values of it.
const NAMES: [&str; 9] = ["id", "id_i", "id_j", "kind", "body", "partner", "wall", "element", "clump"];

fn row(
    topic: &str,
    a: &Rows,
    b: &Rows,
    rows: [&Named; 2],
    largest: &[f64],
    rule: &Rule,
    found: &mut BTreeMap<String, Worst>,
) {
    let mut group = String::new();
    let mut left = 0;
    for (k, name) in a.columns.iter().enumerate() {
        if left == 0 {
            left = width(column(name));
            group = format!("{topic} {name}");
        }
        left -= 1;
        // An output without clusters lacks a column.
        let Some(at) = b.columns.iter().position(|c| c == name) else { continue };
        if NAMES.contains(&name.as_str()) {
            continue;
        }
        let values = [rows[0].values[k], rows[1].values[at]];
        let same = values[0] == values[1] || values.iter().all(|v| v.is_nan());
        let axis = ["x", "y", "z"].iter().position(|axis| name == axis);
        let period = axis.filter(|_| topic == topic::CONTACTS).map_or(0.0, |axis| rule.periods[axis]);
        let deviation = if same { 0.0 } else { apart(values, period) };
        let deviation = if deviation.is_nan() { f64::INFINITY } else { deviation };
        keep(
            found,
            group.clone(),
            Worst { deviation, row: rows[0].name.clone(), values, largest: largest[k] },
        );
    }
}

/// Distance of two numbers, of which whole periods do not count where there are any.
fn apart([a, b]: [f64; 2], period: f64) -> f64 {
    let way = a - b;
    if period > 0.0 { (way - period * (way / period).round()).abs() } else { way.abs() }
}

/// Rows under their names, in the frame and units of the second answer, in the order of names.
fn named(topic: &str, table: &Rows, rule: &Rule, changed: bool) -> Vec<Named> {
    let at = |name: &str| table.columns.iter().position(|c| c == name);
    let position = at("x");
    let mut all = Vec::new();
    for (n, numbers) in table.rows.iter().enumerate() {
        let mut values = numbers.clone();
        if changed {
            rule.transform.row(&table.columns, &mut values, false);
        }
        let id = |name: &str| at(name).map(|k| if changed { rule.id(values[k]) } else { values[k] as u32 });
        let name = match topic {
            topic::CONTACTS | topic::BONDS | topic::CRACKS => {
                let wall = at("kind").is_some_and(|k| values[k] == 1.0);
                let mut ids = [id("id_i").unwrap_or(0), id("id_j").unwrap_or(0)];
                if wall {
                    ids[1] = at("id_j").map_or(0, |k| values[k] as u32);
                    if let (true, Some(map)) = (changed, &rule.walls) {
                        ids[1] = map.get(ids[1] as usize).copied().unwrap_or(ids[1]);
                    }
                } else if ids[0] > ids[1] {
                    ids.swap(0, 1);
                    reverse(&table.columns, &mut values);
                }
                format!("{} {} {}", if wall { "wall contact" } else { "pair" }, ids[0], ids[1])
            }
            topic::ENERGY if rule.without.contains(&table.names[n].as_str()) => continue,
            topic::WALL_FORCES => {
                let to = rule.walls.as_ref().filter(|_| changed).and_then(|map| map.get(n).copied());
                format!("wall {}", to.unwrap_or(n as u32))
            }
            _ => match (table.names.get(n), id("id")) {
                (Some(name), _) => name.clone(),
                (None, Some(id)) => format!("id {id:06}"),
                (None, None) => format!("row {n}"),
            },
        };
        let order = position.map_or(0.0, |k| values[k] + 0.377 * values[k + 1] + 0.119 * values[k + 2]);
        all.push(Named { name, order, values });
    }
    all.sort_by(|a, b| a.name.cmp(&b.name).then(a.order.total_cmp(&b.order)));
    if topic == topic::CONTACTS && !rule.is_exact() {
        merge(&table.columns, &mut all);
    }
    all
}

/// Contacts of one grain with one wall as one: which of two faces at a seam carries how much, and where, is a matter of rounding.
fn merge(columns: &[String], all: &mut Vec<Named>) {
    let summed = |k: usize| ["fx", "fy", "fz", "work"].contains(&columns[k].as_str());
    for row in all.iter_mut().filter(|row| row.name.starts_with("wall contact")) {
        (0..columns.len()).filter(|k| !summed(*k)).for_each(|k| row.values[k] = 0.0);
    }
    all.dedup_by(|next, kept| {
        let one = next.name == kept.name && next.name.starts_with("wall contact");
        if one {
            kept.values.iter_mut().zip(&next.values).for_each(|(sum, x)| *sum += x);
        }
        one
    });
}

/// A row seen from the other particle: its normal and force are reversed, its moments exchanged.
fn reverse(columns: &[String], values: &mut [f64]) {
    for k in 0..columns.len() {
        match (columns[k].as_str(), column(&columns[k]).kind) {
            ("nx" | "fx", Kind::Vector) => values[k..k + 3].iter_mut().for_each(|x| *x = -*x),
            ("mx_i", _) => (0..3).for_each(|axis| values.swap(k + axis, k + 3 + axis)),
            _ => {}
        }
    }
}
