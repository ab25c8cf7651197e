//! What grains do to walls, as messages: forces of an instant, and sums over the steps since the frame before.

use crate::frames::{WallHead, kind};
use dem::{PartSum, Simulation, WallForce, WallInterval, WallSum};
use geom::Vec3;
use record::TableBuilder;
use record::column::{self, IMPACT_ENERGY, POSITION};
use scene::keys::Precision;
use serde_json::{Value, json};
use stream::Table;

/// The sums since the frame before.
pub(crate) struct Interval<'a> {
    pub sums: &'a WallInterval,
    /// Point of each wall about which its torque is, now [m].
    pub about: Vec<Vec3>,
    /// Whether the ledger knows the sliding work.
    pub slides: bool,
}

/// The message of the topic `/wall_forces`: force on each wall [N], its shift [m], and what grains did to it in an interval.
pub(crate) fn forces(
    time: f64,
    forces: &[WallForce],
    walls: &[WallHead],
    interval: Option<&Interval>,
) -> Value {
    let one = |(index, (f, w)): (usize, (&WallForce, &WallHead))| {
        let mut wall = json!({"name": w.name, "force": f.force, "shift": f.shift, "contacts": f.contacts});
        if let Some(servo) = servo(f) {
            wall["servo"] = servo;
        }
        if let Some(interval) = interval.filter(|interval| interval.sums.length > 0.0) {
            put_means(&mut wall, index, interval);
        }
        wall
    };
    let walls: Vec<Value> = forces.iter().zip(walls).enumerate().map(one).collect();
    match interval {
        Some(interval) => json!({"time": time, "interval": interval.sums.length, "walls": walls}),
        None => json!({"time": time, "walls": walls}),
    }
}

/// What the servo of a wall follows, if it has one.
fn servo(f: &WallForce) -> Option<Value> {
    let s = f.servo.as_ref()?;
    let mut servo = json!({"target": s.target, "push": s.push});
    let mut put = |key: &str, value: Option<f64>| {
        if let Some(value) = value {
            servo[key] = value.into();
        }
    };
    put("area", s.area);
    put("reached", s.held.since);
    put("mean_deviation", s.held.mean());
    put("worst_deviation", s.held.mean().map(|_| s.held.worst));
    Some(servo)
}

/// Means and sums of one wall.
fn put_means(wall: &mut Value, index: usize, interval: &Interval) {
    let Interval { sums: WallInterval { length, walls, .. }, about, slides } = interval;
    let (Some(sum), Some(about)) = (walls.get(index), about.get(index)) else { return };
    let WallSum { impulse, moment, work, normal, largest, sliding, impacts, impact_energy, .. } = sum;
    wall["mean_force"] = json!(impulse / *length);
    wall["largest_force"] = json!(largest);
    wall["mean_normal"] = json!(normal / length);
    wall["mean_torque"] = json!(moment / *length);
    wall["about"] = json!(about);
    wall["mean_power"] = json!(work / length);
    wall["impacts"] = json!(impacts);
    wall["impact_energy"] = json!(impact_energy);
    if *slides {
        wall["sliding_work"] = json!(sliding);
    }
}

/// The table of the topic `/wall_wear`: a row for each wall sphere and triangle that was touched.
pub(crate) fn wear(sim: &Simulation, sums: &WallInterval, precision: Precision) -> Table {
    let of = |(wall, parts): (usize, &Vec<PartSum>)| {
        let places = sim.wall_part_positions(wall, parts.iter().map(|sum| sum.part));
        places.into_iter().zip(parts.clone()).map(move |(place, sum)| (wall as u16, place, sum))
    };
    let rows: Vec<(u16, Vec3, PartSum)> = sums.parts.iter().enumerate().flat_map(of).collect();
    TableBuilder::of(rows.len(), kind(precision))
        .vectors(POSITION, &rows, |(_, place, _)| *place)
        .u16(column::WALL, rows.iter().map(|(wall, ..)| *wall))
        .u32(column::PART, rows.iter().map(|(.., sum)| sum.part))
        .numbers(column::INTERVAL, rows.iter().map(|_| sums.length))
        .numbers(column::NORMAL_IMPULSE, rows.iter().map(|(.., sum)| sum.normal))
        .numbers(column::LARGEST_NORMAL, rows.iter().map(|(.., sum)| sum.largest))
        .numbers(column::WORK, rows.iter().map(|(.., sum)| sum.sliding))
        .u32(column::IMPACTS, rows.iter().map(|(.., sum)| sum.impacts))
        .numbers(IMPACT_ENERGY[0], rows.iter().map(|(.., sum)| sum.impact_energy[0]))
        .numbers(IMPACT_ENERGY[1], rows.iter().map(|(.., sum)| sum.impact_energy[1]))
        .done()
}
