//! Parts of scenes as text.

use crate::composing::compose::number;
use crate::request::Specimen;
use crate::sample::Sample;
use geom::Vec3;
use std::f64::consts::PI;

/// A wall as text.
pub(super) fn wall(name: &str, shape: &str, material: &str, more: &str) -> String {
    format!("[[wall]]\nname = \"{name}\"\n{shape}\nmaterial = \"{material}\"\n{more}\n")
}

/// The shape of a wall that is a plane: point and normal.
pub(super) fn plane(point: Vec3, normal: [i8; 3]) -> String {
    let [x, y, z] = [point.x, point.y, point.z].map(number);
    let [a, b, c] = normal;
    format!("plane = \"{x},{y},{z},{a},{b},{c}\"")
}

/// What every run writes.
pub(super) fn output(until: f64, rows: u64) -> String {
    let every = number(until / rows as f64);
    format!("[output]\nevery = {every}\nwall_forces = true\nprecision = \"f64\"\n\n")
}

/// Facets of a round wall.
const FACETS: usize = 64;

/// An upright round wall as triangles: `facet` gives those between two neighbouring directions, of corners at a height [m] on the circle of a specimen.
pub(super) fn around(specimen: &Specimen, facet: impl Fn([&dyn Fn(f64) -> [f64; 3]; 2]) -> String) -> String {
    let (low, r) = (specimen.low, specimen.radius());
    let at = |k: usize| {
        let turn = 2.0 * PI * k as f64 / FACETS as f64;
        move |z: f64| [low.x + r + r * turn.cos(), low.y + r + r * turn.sin(), z]
    };
    (0..FACETS).map(|k| facet([&at(k), &at(k + 1)])).collect()
}

/// The upright cylinder in a box, as a shape.
pub(super) fn cylinder(specimen: &Specimen) -> String {
    let (low, high) = (specimen.low, specimen.high);
    let [x, y] = [0.5 * (low.x + high.x), 0.5 * (low.y + high.y)].map(number);
    let [c, z, radius] = [low.z, high.z, specimen.radius()].map(number);
    format!("cylinder:{x},{y},{c},{x},{y},{z},{radius}")
}

/// The servo of a wall that presses along a direction.
pub(super) fn servo(direction: [i8; 3], stress: &str, area: &str, limit: f64) -> String {
    let [x, y, z] = direction;
    format!("servo = {{ direction = [{x}, {y}, {z}], {stress}, {area}, speed_limit = {} }}\n", number(limit))
}

/// The servo of a lid that presses down with a stress [Pa] on an area [m²].
pub(super) fn pressing(stress: f64, area: f64, limit: f64) -> String {
    let [stress, area] = [stress, area].map(number);
    servo([0, 0, -1], &format!("stress = {stress}"), &format!("area = {area}"), limit)
}

/// A motion at a constant velocity that begins smoothly.
pub(super) fn translate(velocity: Vec3, ramp: f64) -> String {
    let [x, y, z] = [velocity.x, velocity.y, velocity.z].map(number);
    format!("motion = {{ translate = [{x}, {y}, {z}], ramp = {} }}\n", number(ramp))
}

/// A triangle as a line.
pub(super) fn triangle(corners: [[f64; 3]; 3]) -> String {
    let words: Vec<String> = corners.iter().flatten().map(|x| number(*x)).collect();
    words.join(" ") + "\n"
}

/// Triangles of four corners, a line each.
pub(super) fn rectangle(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> String {
    triangle([a, b, c]) + &triangle([a, c, d])
}

/// Local damping for the preparation: it stops the specimen as a whole, too, which hardly has unbalanced forces. Clumps and samples with damping of
/// their own get none.
pub(super) fn damping(sample: &Sample) -> &'static str {
    if sample.has("local_damping") { "" } else { "[local_damping]\nfactor = 0.7\n\n" }
}
