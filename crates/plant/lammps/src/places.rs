//! Numbers of atoms, and positions in a periodic domain, as LAMMPS has them.

use dem::setup::Setup;
use geom::Vec3;

/// Number of the atom of a particle: LAMMPS counts from 1.
pub fn number_of(id: u32) -> u64 {
    u64::from(id) + 1
}

/// A position inside the period, and the periods between both.
pub fn wrapped(setup: &Setup, mut position: Vec3) -> (Vec3, [i64; 3]) {
    let mut images = [0; 3];
    for axis in 0..3 {
        if let Some((low, high)) = setup.periodic[axis] {
            images[axis] = ((position[axis] - low) / (high - low)).floor() as i64;
            position[axis] = low + (position[axis] - low).rem_euclid(high - low);
        }
    }
    (position, images)
}

/// The shortest of the vectors that a periodic domain makes of one.
pub fn nearest(setup: &Setup, mut apart: Vec3) -> Vec3 {
    for axis in 0..3 {
        if let Some((low, high)) = setup.periodic[axis] {
            apart[axis] -= (high - low) * (apart[axis] / (high - low)).round();
        }
    }
    apart
}
