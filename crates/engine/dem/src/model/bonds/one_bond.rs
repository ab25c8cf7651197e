//! What one bond does, of numbers that are known elsewhere.

use super::law::{Ends, Pull, Pulls, pulls};
use super::springs::{SpringLanes, packed};
use crate::setup::BondNumbers;
use geom::Vec3;
use laws::simd::{Turn, V};
use nalgebra::UnitQuaternion;

/// What a bond does: the centre of i relative to that of j [m] and its velocity [m/s], spins [rad/s] and turns of both since turns are counted.
pub fn bond_now(
    bond: &BondNumbers,
    [arm, velocity]: [Vec3; 2],
    spin: [Vec3; 2],
    turn: [UnitQuaternion<f64>; 2],
) -> Pull {
    let lane = |v: Vec3| V::new(v.x, v.y, v.z);
    let springs = SpringLanes::of(packed(bond).map(|row| row.0));
    let turn = turn.map(|q| Turn::of(q.coords.into()));
    let found: Pulls<f64> =
        pulls(&springs, &Ends { arm: lane(arm), velocity: lane(velocity), spin: spin.map(lane), turn });
    let array = |v: V<f64>| [v.x, v.y, v.z];
    let Pulls { force, elastic, moment, power, stress } = found;
    Pull { force: array(force), elastic, moment: moment.map(array), power, stress }
}
