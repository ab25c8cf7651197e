//! What touched a particle in the step before, and with which force.

use crate::interaction::{Interaction, With};
use crate::setup::Touch;
use crate::simulation::{Simulation, stride};
use geom::Vec3;

impl Simulation {
    /// Where particle `k` was before the last move [m].
    pub(crate) fn position_before(&self, k: usize) -> Vec3 {
        let (row, a) = (&self.particles.rows[k], &self.particles.acceleration[k]);
        let (dt, square) = (self.dt, 0.5 * self.dt * self.dt);
        let back = |axis: usize| row[axis] - (dt * row[4 + axis] - square * a[axis]);
        Vec3::new(back(0), back(1), back(2))
    }

    /// Contacts of particle `k` in the step before the last move, with their forces on it.
    pub(crate) fn touching(&self, k: usize) -> Vec<Touch> {
        // A listing since then would have other places: crossings are found before it.
        let (Some(&from), Some(&to)) = (self.starts.get(k), self.starts.get(k + 1)) else {
            return Vec::new();
        };
        let stride = stride(self.particles.rotates());
        let of = |&entry: &u32| {
            let (load, second) = ((entry >> 1) as usize, entry & 1 == 1);
            let row = &self.loads[load * stride..(load + 1) * stride];
            let force = Vec3::new(row[0], row[1], row[2]);
            let it = self.interactions.iter().rev().find(|i| i.first_load <= load)?;
            if force == Vec3::zeros() {
                return None;
            }
            let normal = self.normal(it, load - it.first_load);
            let force = if second { -force } else { force };
            let along = normal * force.dot(&normal);
            let partner = partner(it, load - it.first_load, second).map(|p| self.particles.id[p as usize]);
            Some(Touch { partner, normal: along, tangential: force - along })
        };
        self.entries[from as usize..to as usize].iter().filter_map(of).collect()
    }

    fn normal(&self, it: &Interaction, contact: usize) -> Vec3 {
        let i = self.position_before(it.i[contact] as usize);
        let j = match it.with {
            With::Particles => self.position_before(it.partner[contact] as usize),
            _ => it.place_of_partner(contact),
        };
        (i - j).try_normalize(0.0).unwrap_or_else(Vec3::zeros)
    }
}

fn partner(it: &Interaction, contact: usize, second: bool) -> Option<u32> {
    match it.with {
        With::Wall(_) => None,
        _ if second => Some(it.i[contact]),
        _ => Some(it.partner[contact]),
    }
}
