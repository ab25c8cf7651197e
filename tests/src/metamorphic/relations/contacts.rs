//! Scenes of one or two grains, made of a law or a wall of the scene.

use super::laws::made;
use crate::metamorphic::campaign::{Case, Verdict, refused};
use crate::metamorphic::compare::{PARTICLES, Rule, Tolerance};
use crate::metamorphic::draw::digits;
use crate::metamorphic::scene::{File, Scene, number};
use crate::metamorphic::transform::array;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use record::topic;
use std::collections::BTreeMap;
use toml::{Table, Value};

const RADIUS: f64 = 0.0045;
const COLUMNS: [&str; 7] = ["x", "y", "z", "vx", "vy", "vz", "radius"];

/// A scene with these grains of the first material, and this law between all.
fn small(case: &Case, rows: Vec<Vec<f64>>, law: Table) -> Option<Scene> {
    let mut scene = Scene::default();
    scene.keys.insert("material".to_owned(), case.scene.keys.get("material")?.clone());
    scene.push("contact", law);
    scene.files.insert("grains.csv".to_owned(), File::Rows(COLUMNS.map(str::to_owned).to_vec(), rows));
    let entry = [("source", Value::from("grains.csv")), ("material", "a".into())];
    scene.push("particles", entry.into_iter().map(|(k, v)| (k.to_owned(), v)).collect());
    scene.set("output", "energy", true);
    scene.set("guards", "energy", 1e6);
    scene.set("guards", "overlap", 0.4);
    Some(scene)
}

fn law(keys: &[(&str, Value)]) -> Table {
    let all = Value::from(vec!["*".to_owned(), "*".to_owned()]);
    let keys = keys.iter().map(|(k, v)| ((*k).to_owned(), v.clone()));
    [("between".to_owned(), all)].into_iter().chain(keys).collect()
}

/// Largest difference over the largest speed: friction's spring is ahead of the instant by what the stiffness of unloading asks for, (ω Δt)²/4 of its way [–].
const YIELDING: f64 = 1e-5;

/// While it is loaded, a spring that yields is a linear one, along the contact and across it.
pub fn loading(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let yields = |c: &&Table| c.get("law").and_then(Value::as_str) == Some("walton_braun");
    let given = case.scene.list("contact").find(yields)?;
    let stiffness = given.get("stiffness").and_then(number)?;
    let e = given.get("restitution").and_then(number)?.max(0.4);
    let density = case.scene.list("material").find_map(|m| m.get("density").and_then(number))?;
    let mass = density * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    let quarter = std::f64::consts::FRAC_PI_2 * (0.5 * mass / stiffness).sqrt();
    let rows = vec![
        vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, RADIUS],
        vec![digits(2.0 * RADIUS - 1e-7, 12), 0.0, 0.0, -0.1, random.random_range(0.01..0.05), 0.01, RADIUS],
    ];
    let ratio = random.random_range(0.2..1.0);
    let across = match random.random_bool(0.5) {
        true => ("tangential_ratio", Value::from(ratio)),
        false => ("tangential_stiffness", (ratio * stiffness).into()),
    };
    let with = |name: &str, e: f64| {
        let keys: &[(&str, Value)] = &[
            ("law", name.into()),
            ("stiffness", stiffness.into()),
            ("restitution", e.into()),
            ("sliding_friction", 2.0.into()),
            ("tangential_damping", 1e-12.into()),
            across.clone(),
        ];
        let mut scene = small(case, rows.clone(), law(keys))?;
        scene.set("time", "dt", digits(0.01 * e * quarter.min(1e-3), 6));
        scene.set("time", "contacts", "sampled");
        scene.set("time", "until", digits(0.8 * quarter, 6));
        scene.set("output", "every", digits(0.2 * quarter, 6));
        Some(scene)
    };
    // The step is that of the law that yields.
    let (one, mut other) = (with("walton_braun", e)?, with("hooke", 1.0)?);
    other.keys.insert("time".to_owned(), one.keys.get("time")?.clone());
    match (case.run(&one, &[]), case.run(&other, &[])) {
        (Ok(one), Ok(other)) => {
            let none = BTreeMap::new();
            Some(case.judge(
                &one,
                &other,
                &Rule { tolerance: Tolerance::Rounding(&none, YIELDING), ..Rule::bits(PARTICLES) },
            ))
        }
        (Err(refusal), _) | (_, Err(refusal)) => Some(refused(&refusal)),
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// Two triangles that share an edge: its ends, and the normals of both.
fn seams(vertices: &[[f64; 3]], triangles: &[[usize; 3]]) -> Vec<[[f64; 3]; 4]> {
    let mut edges: BTreeMap<(usize, usize), Vec<[f64; 3]>> = BTreeMap::new();
    for t in triangles {
        let [a, b, c] = t.map(|k| vertices[k]);
        let normal = unit(cross(minus(b, a), minus(c, a)));
        for k in 0..3 {
            let (i, j) = (t[k], t[(k + 1) % 3]);
            edges.entry((i.min(j), i.max(j))).or_default().push(normal);
        }
    }
    let shared = edges.into_iter().filter(|(_, normals)| normals.len() == 2);
    shared.map(|((i, j), n)| [vertices[i], vertices[j], n[0], n[1]]).collect()
}

/// Most energy that an elastic grain may gain or lose as it moves over a seam: that of the step [–].
const SEAM: f64 = 2e-3;

/// A grain without friction that moves over the seam of two triangles keeps its energy.
pub fn seam(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let plain = |w: &&Table| {
        !["motion", "servo", "spring", "surface_velocity", "surface_rotation"]
            .iter()
            .any(|k| w.contains_key(*k))
    };
    let walls: Vec<&Table> =
        case.scene.list("wall").filter(plain).filter(|w| w.contains_key("mesh")).collect();
    let wall = *walls.get(random.random_range(0..walls.len().max(1)))?;
    let name = wall.get("mesh")?.as_str()?;
    let File::Mesh(vertices, triangles) = case.scene.files.get(name)? else { return None };
    let mut seams = seams(vertices, triangles);
    // Bent ones first: flat ones are less to be feared.
    seams.retain(|s| dot(s[2], s[3]) < 1.0 - 1e-9 || random.random_bool(0.05));
    let [a, b, n1, n2] = *seams.get(random.random_range(0..seams.len().max(1)))?;
    // The side on which the grains of the scene are.
    let rows = case.base.frames.values().next()?.get(topic::PARTICLES)?;
    let x = rows.columns.iter().position(|c| c == "x")?;
    let centre =
        [0, 1, 2].map(|k| rows.rows.iter().map(|r| r[x + k]).sum::<f64>() / rows.rows.len().max(1) as f64);
    let normal = unit([0, 1, 2].map(|k| n1[k] + n2[k]));
    let side = if dot(minus(centre, a), normal) < 0.0 { -1.0 } else { 1.0 };
    let normal = normal.map(|x| side * x);
    let across = unit(cross(normal, minus(b, a)));
    let part = random.random_range(0.4..0.6);
    let (into, along) = (random.random_range(0.2..0.6), random.random_range(-0.6..0.6));
    let stiffness = 10f64.powf(random.random_range(2.3..3.3));
    let density = case.scene.list("material").find_map(|m| m.get("density").and_then(number))?;
    let mass = density * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    let lasts = std::f64::consts::PI * (mass / stiffness).sqrt();
    // The grain is over the seam at some time of its contact.
    let early = 2e-5 / into + lasts * random.random_range(0.2..0.8);
    let place = [0, 1, 2]
        .map(|k| a[k] + part * (b[k] - a[k]) + (RADIUS + 2e-5) * normal[k] - early * along * across[k]);
    let velocity = [0, 1, 2].map(|k| along * across[k] - into * normal[k]);
    let row = [&place[..], &velocity[..], &[RADIUS][..]].concat();
    let elastic =
        law(&[("law", "hooke".into()), ("stiffness", stiffness.into()), ("restitution", 1.0.into())]);
    let mut scene = small(case, vec![row], elastic)?;
    scene.files.insert(name.to_owned(), File::Mesh(vertices.clone(), triangles.clone()));
    scene.push("wall", wall.clone());
    scene.set("time", "dt", digits(lasts / 1000.0, 4));
    scene.set("time", "until", digits(2.5 * lasts, 4));
    scene.set("output", "every", digits(lasts / 20.0, 4));
    let answer = match case.run(&scene, &[]) {
        Ok(answer) => answer,
        Err(refusal) => return Some(refused(&refusal)),
    };
    let made = made(&answer)?;
    let at = array(&[&place[..], &velocity[..]].concat());
    Some(match made > SEAM {
        true => Verdict::Differs(format!(
            "{made:e} of the energy is made or lost by a grain of {RADIUS} m at {at}"
        )),
        false => Verdict::Same,
    })
}
