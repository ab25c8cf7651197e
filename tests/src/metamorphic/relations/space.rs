//! The same scene elsewhere, turned, mirrored, in other units, in a moving frame.

use super::{is_drawn, is_placed, jumps};
use crate::metamorphic::campaign::{Case, Verdict, refused};
use crate::metamorphic::compare::{ALL, Rule};
use crate::metamorphic::scene::{File, Scene, numbers};
use crate::metamorphic::transform::{Transform, array};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use record::topic;
use toml::{Table, Value};

/// What does not depend on the place.
const MOVED: &[&str] = &[topic::PARTICLES, topic::BODIES, topic::CONTACTS, topic::BONDS, topic::WALL_FORCES];

/// Lengths, masses and times × powers of two. Those of lengths are even: contact laws have roots of lengths.
pub fn similarity(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = &case.scene;
    // Defaults that have a unit, and what bounds of accuracy compare with.
    let fixed =
        scene.has_in_contacts(&["characteristic_velocity", "jkr"]) || scene.has(&["drag", "sleep", "outlet"]);
    let random_places = !is_placed(scene);
    let servos = scene.list("wall").any(|w| w.contains_key("servo") || w.contains_key("spring"));
    if fixed || random_places || servos || scene.list("contact").any(is_hooke_by_velocity) {
        return None;
    }
    let mut of = |most: i32| random.random_range(-most..=most);
    let powers = [2 * of(2), of(5), of(3)];
    let transform = Transform { powers, ..Transform::default() };
    let other = transform.scene(scene);
    let topics = &[topic::PARTICLES, topic::BODIES, topic::BONDS];
    Some(case.ask(&other, &[], &Rule { transform, ..Rule::bits(topics) }))
}

/// A linear law without its stiffness has that of a speed.
fn is_hooke_by_velocity(contact: &Table) -> bool {
    let law = contact.get("law").and_then(Value::as_str);
    let given =
        ["stiffness", "contact_modulus", "effective_modulus"].iter().any(|k| contact.contains_key(*k));
    matches!(law, Some("hooke" | "walton_braun")) && !given
}

fn turned(case: &Case, turn: [[f64; 3]; 3]) -> Option<Verdict> {
    let transform = Transform { turn, ..Transform::default() };
    let scene = transform.scene(&case.scene);
    let (tolerance, periods) = (case.rounding(1e-10), periods_of_axes(&scene));
    Some(case.ask(&scene, &[], &Rule { transform, tolerance, periods, ..Rule::bits(ALL) }))
}

/// One axis reversed: cells are in another order, and so are sums over contacts.
pub fn mirror(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    if !is_placed(&case.scene) || jumps(&case.scene) {
        return None;
    }
    let mut turn = Transform::default().turn;
    let axis = random.random_range(0..3);
    turn[axis][axis] = -1.0;
    turned(case, turn)
}

/// Axes exchanged: squares are added in another order.
pub fn permuted(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    if !is_placed(&case.scene) || jumps(&case.scene) {
        return None;
    }
    let turns = [
        [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
        [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
    ];
    turned(case, turns[random.random_range(0..3)])
}

/// Any rotation.
pub fn rotated(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = &case.scene;
    let boxed = scene
        .list("wall")
        .any(|w| w.contains_key("box") || w.get("solid").is_some_and(|s| s.get("box").is_some()));
    let round = scene.list("wall").any(|w| w.contains_key("solid"));
    if !is_placed(scene) || jumps(scene) || scene.get("domain.periodic").is_some() || boxed || round {
        return None;
    }
    let mut q = [0.0; 4].map(|_: f64| random.random_range(-1.0..1.0));
    let length = q.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
    q.iter_mut().for_each(|x| *x /= length);
    let [w, x, y, z] = q;
    let turn = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    turned(case, turn)
}

/// Everything elsewhere.
pub fn shifted(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    if !is_placed(&case.scene) || jumps(&case.scene) {
        return None;
    }
    let shift = [0.0; 3].map(|_: f64| random.random_range(-0.2..0.2));
    let transform = Transform { shift, ..Transform::default() };
    let scene = transform.scene(&case.scene);
    let (tolerance, periods) = (case.rounding(1e-9), periods_of_axes(&scene));
    Some(case.ask(&scene, &[], &Rule { transform, tolerance, periods, ..Rule::bits(MOVED) }))
}

/// The periodic axes of a scene, with low corner and period.
fn periods(scene: &Scene) -> Vec<(usize, f64, f64)> {
    let of = |key: &str| scene.get(key).and_then(numbers);
    let (Some(low), Some(high)) = (of("domain.low"), of("domain.high")) else { return Vec::new() };
    let names = scene.get("domain.periodic").and_then(Value::as_array).into_iter().flatten();
    let axes = names.filter_map(|n| ["x", "y", "z"].iter().position(|a| n.as_str() == Some(a)));
    axes.map(|k| (k, low[k], high[k] - low[k])).collect()
}

/// Period of each axis [m]; 0 where it has none.
fn periods_of_axes(scene: &Scene) -> [f64; 3] {
    let mut of = [0.0; 3];
    periods(scene).into_iter().for_each(|(axis, _, period)| of[axis] = period);
    of
}

/// Grains and walls are shifted along periodic axes, and the cell stays: grains cross its faces elsewhere.
pub fn rolled(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = &case.scene;
    let periods = periods(scene);
    let turns = |m: &Table| ["rotate", "swing"].iter().any(|key| m.contains_key(*key));
    let moves = |w: &Table| match w.get("motion") {
        Some(Value::Table(one)) => turns(one),
        Some(Value::Array(list)) => list.iter().filter_map(Value::as_table).any(turns),
        _ => false,
    };
    // Walls that are the same everywhere along the axes: planes and faces of boxes that end where their image begins.
    let alike = |w: &Table| {
        (w.contains_key("plane") || w.contains_key("box")) && !w.contains_key("surface_rotation") && !moves(w)
    };
    let fixed = |p: &Table| p.get("fixed").and_then(Value::as_bool).unwrap_or(false);
    if periods.is_empty()
        || !is_placed(scene)
        || jumps(scene)
        || !scene.list("wall").all(alike)
        || scene.list("particles").any(fixed)
        || scene.get("domain.strain").is_some()
    {
        return None;
    }
    // One of the grains crosses a face soon.
    let grain =
        first_states(scene).and_then(|rows| rows.get(random.random_range(0..rows.len().max(1))).cloned());
    let mut shift = [0.0; 3];
    for (axis, low, period) in &periods {
        let Some(grain) = &grain else { continue };
        let to = low + if grain[3 + axis] > 0.0 { period - CLOSE } else { CLOSE };
        shift[*axis] = (to - grain[*axis]).rem_euclid(*period);
    }
    let transform = Transform { shift, ..Transform::default() };
    let mut other = transform.scene(scene);
    for table in ["domain", "wall"] {
        if let Some(old) = scene.keys.get(table) {
            other.keys.insert(table.to_owned(), old.clone());
        }
    }
    wrap(&mut other, &periods);
    let mut rolled = match case.run(&other, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    let mut base = case.base.clone();
    // Places are compared from the face on, which a grain at the face may have on either side.
    for (answer, shift) in [(&mut base, shift), (&mut rolled, [0.0; 3])] {
        for rows in answer.frames.values_mut().flat_map(|f| f.values_mut()) {
            let Some(x) = rows.columns.iter().position(|c| c == "x") else { continue };
            for row in &mut rows.rows {
                for (axis, low, period) in &periods {
                    let part = (row[x + axis] + shift[*axis] - low) / period;
                    row[x + axis] = (std::f64::consts::TAU * part).sin();
                }
            }
        }
    }
    let topics = &[topic::PARTICLES, topic::BONDS, topic::WALL_FORCES];
    let rule = Rule { tolerance: case.rounding(1e-9), ..Rule::bits(topics) };
    Some(case.judge(&base, &rolled, &rule))
}

/// How far a grain is from the face that it is about to cross [m].
const CLOSE: f64 = 2e-4;

/// Places and velocities of a file of grains.
fn first_states(scene: &Scene) -> Option<&Vec<Vec<f64>>> {
    scene.files.iter().find_map(|(name, file)| match file {
        File::Rows(_, rows) if name.starts_with("grains") || name.starts_with("clumps") => Some(rows),
        _ => None,
    })
}

fn wrap(scene: &mut Scene, periods: &[(usize, f64, f64)]) {
    let Scene { keys, files } = scene;
    let wrapped = |x: f64, low: f64, period: f64| if x >= low + period { x - period } else { x };
    for (_, file) in files.iter_mut().filter(|(name, _)| !name.starts_with("path")) {
        if let (Some(x), File::Rows(_, rows)) = (file.column("x"), file) {
            for row in rows.iter_mut() {
                periods
                    .iter()
                    .for_each(|(axis, low, period)| row[x + axis] = wrapped(row[x + axis], *low, *period));
            }
        }
    }
    for body in keys.get_mut("body").and_then(Value::as_array_mut).into_iter().flatten() {
        let Some(mut p) = body.get("position").and_then(numbers) else { continue };
        periods.iter().for_each(|(axis, low, period)| p[*axis] = wrapped(p[*axis], *low, *period));
        body.as_table_mut().map(|b| b.insert("position".to_owned(), array(&p)));
    }
}

/// Everything moves with one velocity, walls too.
pub fn boosted(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = &case.scene;
    let fixed = |p: &Table| p.get("fixed").and_then(Value::as_bool).unwrap_or(false);
    let driven = |w: &Table| ["servo", "spring", "source"].iter().any(|k| w.contains_key(*k));
    let periodic_walls = scene.get("domain.periodic").is_some() && scene.has(&["wall"]);
    if !is_placed(scene)
        || jumps(scene)
        || scene.has(&["drag"])
        || periodic_walls
        || scene.get("domain.strain").is_some()
        || scene.list("particles").any(fixed)
        || scene.list("wall").any(driven)
    {
        return None;
    }
    let boost = [0.0; 3].map(|_: f64| random.random_range(-0.3..0.3));
    let transform = Transform { boost, ..Transform::default() };
    let mut other = scene.clone();
    // Grains alone move: belts and fluids have velocities relative to what carries them.
    let frame = Transform { boost, ..Transform::default() };
    let Scene { keys, files } = &mut other;
    for (name, file) in files.iter_mut() {
        if let (true, File::Rows(columns, rows)) =
            (name.starts_with("grains") || name.starts_with("clumps"), file)
        {
            rows.iter_mut().for_each(|row| frame.row(columns, row, false));
        }
    }
    for body in keys.get_mut("body").and_then(Value::as_array_mut).into_iter().flatten() {
        let old = body.get("velocity").and_then(numbers).unwrap_or(vec![0.0; 3]);
        let new: Vec<f64> = (0..3).map(|k| old[k] + boost[k]).collect();
        body.as_table_mut().map(|b| b.insert("velocity".to_owned(), array(&new)));
    }
    for wall in other.list_mut("wall") {
        let mut translate = Table::new();
        translate.insert("translate".to_owned(), array(&boost));
        let mut list = match wall.remove("motion") {
            Some(Value::Array(list)) => list,
            Some(one) => vec![one],
            None => Vec::new(),
        };
        list.push(Value::Table(translate));
        wall.insert("motion".to_owned(), Value::Array(list));
    }
    let mut answer = match case.run(&other, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    let mut base = case.base.clone();
    // Where everything is by now is left out.
    for frame in base.frames.values_mut().chain(answer.frames.values_mut()) {
        for rows in frame.values_mut() {
            let Some(x) = rows.columns.iter().position(|c| c == "x") else { continue };
            rows.rows.iter_mut().for_each(|row| row[x..x + 3].fill(0.0));
        }
    }
    let rule =
        Rule { transform, tolerance: case.rounding(1e-9), ..Rule::bits(&[topic::PARTICLES, topic::BODIES]) };
    Some(case.judge(&base, &answer, &rule))
}

/// Two copies of a periodic cell side by side: each is as the one.
pub fn doubled(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let scene = &case.scene;
    let periods = periods(scene);
    if periods.is_empty() || !is_placed(scene) || jumps(scene) || is_drawn(scene) {
        return None;
    }
    if scene.has(&["wall", "clump"])
        || scene.list("particles").any(|p| p.contains_key("fixed"))
        || scene.get("domain.strain").is_some()
    {
        return None;
    }
    let (axis, low, period) = periods[random.random_range(0..periods.len())];
    let mut other = scene.clone();
    let mut high = scene.get("domain.high").and_then(numbers)?;
    high[axis] = low + 2.0 * period;
    other.set("domain", "high", array(&high));
    // Copies come behind all others, so that the first ones keep their ids.
    let copies: Vec<Table> = scene.list("particles").cloned().collect();
    for mut copy in copies {
        let name = copy.get("source")?.as_str()?.to_owned();
        let mut file = scene.files.get(&name)?.clone();
        if let (Some(x), File::Rows(_, rows)) = (file.column("x"), &mut file) {
            rows.iter_mut().for_each(|row| row[x + axis] += period);
        }
        let copied = name.replace(".csv", "-copy.csv");
        other.files.insert(copied.clone(), file);
        copy.insert("source".to_owned(), copied.into());
        other.push("particles", copy);
    }
    let mut answer = match case.run(&other, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    let mut base = case.base.clone();
    let count = base.frames.values().next()?.get(topic::PARTICLES)?.rows.len();
    for answer in [&mut base, &mut answer] {
        for frame in answer.frames.values_mut() {
            frame.retain(|name, _| name == topic::PARTICLES);
            let Some(rows) = frame.get_mut(topic::PARTICLES) else { continue };
            let at = |c: &str| rows.columns.iter().position(|name| name == c);
            let (Some(id), Some(x)) = (at("id"), at("x")) else { continue };
            let first = rows.rows.iter().map(|r| r[id]).fold(f64::INFINITY, f64::min);
            rows.rows.retain(|row| row[id] < first + count as f64);
            rows.rows.iter_mut().for_each(|row| {
                row[x + axis] = (std::f64::consts::TAU * (row[x + axis] - low) / period).sin()
            });
        }
    }
    let tolerance = case.rounding(1e-9);
    Some(case.judge(&base, &answer, &Rule { tolerance, ..Rule::bits(&[topic::PARTICLES]) }))
}
