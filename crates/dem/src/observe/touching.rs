//! What touched a particle in the step before, and with which force.

use crate::neighbours::contacts::Segment;
use crate::neighbours::contacts::With;
use crate::setup::Touch;
use crate::simulation::Simulation;
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
        let c = &self.contacts;
        let (Some(&from), Some(&to)) = (c.starts.get(k), c.starts.get(k + 1)) else {
            return Vec::new();
        };
        let of = |&entry: &u32| {
            let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
            let force = c.force(place);
            if force == Vec3::zeros() {
                return None;
            }
            let segment = c.segment_of(place);
            let normal = self.normal(segment, place);
            let force = if second { -force } else { force };
            let along = normal * force.dot(&normal);
            let partner = match self.kinds[segment.kind].with {
                With::Wall(_) => None,
                _ if second => Some(c.i[place]),
                _ => Some(c.partner[place]),
            };
            let partner = partner.map(|p| self.particles.id[p as usize]);
            let springs = self.springs(segment, place, second);
            let id = self.particles.id[k];
            Some(Touch { id, partner, normal: along, tangential: force - along, springs })
        };
        c.entries[from as usize..to as usize].iter().filter_map(of).collect()
    }

    fn normal(&self, segment: &Segment, place: usize) -> Vec3 {
        let i = self.position_before(self.contacts.i[place] as usize);
        let (j, _) = self.partner(segment, place, |k| self.position_before(k));
        (i - j).try_normalize(0.0).unwrap_or_else(Vec3::zeros)
    }
}
