//! The box that most specimens are prepared in: four smooth sides, a floor, and a lid that presses.

use super::*;
use crate::composing::walls::{PLATE, SIDE};

/// The four sides with their normals.
const SIDES: [(&str, [i8; 3]); 4] =
    [("left", [1, 0, 0]), ("right", [-1, 0, 0]), ("front", [0, 1, 0]), ("back", [0, -1, 0])];

/// Four planes around a specimen.
pub(super) fn sides(of: &Context) -> String {
    let (low, high) = (of.specimen.low, of.specimen.high);
    let side = |(name, normal): &(&str, [i8; 3])| {
        let corner = if normal.iter().any(|n| *n < 0) { high } else { low };
        wall(name, &plane(Vec3::new(corner.x, corner.y, low.z), *normal), SIDE, "")
    };
    SIDES.iter().map(side).collect()
}

/// A floor, and a lid that presses with a stress [Pa].
fn floor_and_lid(of: &Context, stress: f64) -> String {
    let space = of.specimen;
    let area = space.sides()[0] * space.sides()[1];
    let limit = of.request.speed_limit(&of.sample.grains, stress, space.height);
    let press = pressing(stress, area, limit);
    wall("floor", &plane(space.low, [0, 0, 1]), PLATE, "")
        + &wall("lid", &plane(space.high, [0, 0, -1]), PLATE, &press)
}

/// Time in which a specimen is pressed together and comes to rest, at most [s].
pub(super) fn settling(of: &Context, stress: f64) -> f64 {
    let (space, grains) = (of.specimen, &of.sample.grains);
    let way = space.high.z - space.low.z;
    let fall = if grains.gravity > 0.0 { (2.0 * way / (0.3 * grains.gravity)).sqrt() } else { 0.0 };
    20.0 * way / of.request.speed_limit(grains, stress, space.height) + 5.0 * fall
}

/// A preparation in a box whose lid presses with the stress.
pub(super) fn press(of: &Context) -> Part {
    let stress = of.loading.stress;
    let until = settling(of, stress);
    let text = output(until, 20) + damping(of.sample) + &floor_and_lid(of, stress) + &sides(of);
    Part { until, to_rest: true, text, bonds: of.sample.is_packed(), ..Part::default() }
}

/// Shift of a wall along z [m].
fn rise(prepared: &Prepared, wall: &str) -> f64 {
    prepared.shifts.get(wall).map_or(0.0, |shift| shift.z)
}

/// A box around a specimen, its walls and all places that its grains come to, and its volume [m³].
pub(super) fn around(of: &Context) -> (String, Option<f64>) {
    let (low, high) = (of.specimen.low, of.specimen.high);
    let far = (high - low).max();
    let [a, b] = [low.add_scalar(-far), high.add_scalar(far)];
    let corners = [a.x, a.y, a.z, b.x, b.y, b.z].map(number).join(",");
    (format!("box:{corners}"), Some((b - a).product()))
}

/// A box whose sides stay, of these heights [m].
pub(super) fn upright(of: &Context, heights: Vec<f64>) -> Room {
    let [x, y] = of.specimen.sides().map(|side| vec![side; heights.len()]);
    Room::of_box([x, y, heights])
}

/// Height of a specimen under its lid [m].
pub(super) fn height(of: &Context, prepared: &Prepared) -> f64 {
    of.specimen.high.z - of.specimen.low.z + rise(prepared, "lid")
}
