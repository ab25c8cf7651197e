//! One surface as walls of different forms.

use super::jumps;
use crate::metamorphic::campaign::{Case, Verdict};
use crate::metamorphic::compare::Rule;
use crate::metamorphic::scene::{File, Scene, numbers};
use crate::metamorphic::transform::array;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use record::topic;
use toml::Value;

/// What does not number walls.
const TOPICS: &[&str] = &[topic::PARTICLES, topic::BODIES, topic::BONDS];

/// How far a mesh reaches that stands for a plane [m].
const FAR: f64 = 0.15;

fn ask(case: &Case, scene: &Scene) -> Option<Verdict> {
    Some(case.ask(scene, &[], &Rule { tolerance: case.rounding(1e-9), ..Rule::bits(TOPICS) }))
}

/// The axis that a plane is across, where it is one.
fn axis_of(plane: &[f64]) -> Option<usize> {
    (0..3).find(|k| plane[3 + k].abs() == 1.0)
}

/// Low and high end along each axis, of the periodic cell or far away.
fn ends(scene: &Scene) -> [[f64; 2]; 3] {
    let of = |key: &str| scene.get(key).and_then(numbers);
    let names: Vec<&str> = scene
        .get("domain.periodic")
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    let (low, high) = (of("domain.low"), of("domain.high"));
    [0, 1, 2].map(|k| match (&low, &high) {
        (Some(low), Some(high)) if names.contains(&["x", "y", "z"][k]) => [low[k], high[k]],
        _ => [-FAR, FAR],
    })
}

/// A rectangle across an axis, in so many strips.
fn rectangle(axis: usize, at: f64, u: [f64; 2], v: [f64; 2], strips: usize) -> File {
    let mut vertices = Vec::new();
    for k in 0..=strips {
        for side in v {
            let mut p = [0.0; 3];
            p[axis] = at;
            p[(axis + 1) % 3] = u[0] + (u[1] - u[0]) * k as f64 / strips as f64;
            p[(axis + 2) % 3] = side;
            vertices.push(p);
        }
    }
    let triangles = (0..strips).flat_map(|k| {
        let a = 2 * k;
        [[a, a + 2, a + 3], [a, a + 3, a + 1]]
    });
    File::Mesh(vertices, triangles.collect())
}

/// A wall that neither moves in a way that only planes can, nor turns.
fn is_plain(wall: &toml::Table) -> bool {
    !["servo", "spring", "motion", "surface_rotation"].iter().any(|key| wall.contains_key(*key))
}

/// A plane as a large mesh.
pub fn plane_as_mesh(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let ends = ends(&scene);
    if jumps(&scene) {
        return None;
    }
    let mut files = Vec::new();
    for wall in scene.list_mut("wall").filter(|w| is_plain(w)) {
        let Some(plane) = wall.get("plane").and_then(numbers) else { continue };
        let Some(axis) = axis_of(&plane) else { continue };
        let name = format!("plane{}.ply", files.len());
        let (u, v) = (ends[(axis + 1) % 3], ends[(axis + 2) % 3]);
        files.push((name.clone(), rectangle(axis, plane[axis], u, v, random.random_range(1..5))));
        wall.remove("plane");
        wall.insert("mesh".to_owned(), name.into());
    }
    if files.is_empty() {
        return None;
    }
    scene.files.extend(files);
    ask(case, &scene)
}

/// A plane as a face of a large box.
pub fn plane_as_box(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let ends = ends(&scene);
    if jumps(&scene) {
        return None;
    }
    let mut any = false;
    for wall in scene.list_mut("wall").filter(|w| is_plain(w)) {
        let Some(plane) = wall.get("plane").and_then(numbers) else { continue };
        let Some(axis) = axis_of(&plane) else { continue };
        let mut corners = [ends.map(|e| e[0]), ends.map(|e| e[1])].concat();
        let upper = plane[3 + axis] < 0.0;
        corners[if upper { 3 + axis } else { axis }] = plane[axis];
        wall.remove("plane");
        wall.insert("box".to_owned(), array(&corners));
        wall.insert(
            "faces".to_owned(),
            vec![format!("{}{}", ["x", "y", "z"][axis], if upper { "+" } else { "-" })].into(),
        );
        any = true;
    }
    any.then(|| ask(case, &scene)).flatten()
}

/// Each face of a box, an endless plane, as a large mesh.
pub fn box_as_mesh(case: &Case, random: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    if jumps(&scene) {
        return None;
    }
    let ends = ends(&scene);
    let (mut walls, mut files, mut any) = (Vec::new(), Vec::new(), false);
    for wall in case.scene.list("wall") {
        let corners = wall.get("box").and_then(numbers).filter(|_| is_plain(wall));
        let faces = wall.get("faces").and_then(Value::as_array);
        let (Some(corners), Some(faces)) = (corners, faces) else {
            walls.push(Value::Table(wall.clone()));
            continue;
        };
        any = true;
        for face in faces.iter().filter_map(Value::as_str) {
            let axis = ["x", "y", "z"].iter().position(|a| face.starts_with(a))?;
            let at = corners[axis + if face.ends_with('+') { 3 } else { 0 }];
            let (u, v) = (ends[(axis + 1) % 3], ends[(axis + 2) % 3]);
            let name = format!("face{}.ply", files.len());
            files.push((name.clone(), rectangle(axis, at, u, v, random.random_range(1..4))));
            let mut one = wall.clone();
            one.remove("box");
            one.remove("faces");
            one.remove("name");
            one.insert("mesh".to_owned(), name.into());
            walls.push(Value::Table(one));
        }
    }
    scene.keys.insert("wall".to_owned(), Value::Array(walls));
    scene.files.extend(files);
    any.then(|| ask(case, &scene)).flatten()
}

/// Each triangle as four.
pub fn finer(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    let mut any = false;
    for file in scene.files.values_mut() {
        let File::Mesh(vertices, triangles) = file else { continue };
        any = true;
        let mut finer = Vec::new();
        let mut middles = std::collections::BTreeMap::new();
        for [a, b, c] in triangles.iter().copied() {
            let mut middle = |i: usize, j: usize| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    vertices.push([0, 1, 2].map(|k| 0.5 * (vertices[i][k] + vertices[j][k])));
                    vertices.len() - 1
                })
            };
            let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        *triangles = finer;
    }
    (any && !jumps(&scene)).then(|| ask(case, &scene)).flatten()
}

/// The belt of a plane, and a plane that moves along itself.
pub fn belt(case: &Case, _: &mut Pcg64Mcg) -> Option<Verdict> {
    let mut scene = case.scene.clone();
    if jumps(&scene) {
        return None;
    }
    let mut any = false;
    for wall in scene.list_mut("wall").filter(|w| w.contains_key("plane") && !w.contains_key("motion")) {
        let Some(velocity) = wall.remove("surface_velocity") else { continue };
        let motion = [("translate".to_owned(), velocity)].into_iter().collect();
        wall.insert("motion".to_owned(), Value::Table(motion));
        any = true;
    }
    any.then(|| ask(case, &scene)).flatten()
}
