//! The ledger of zones: what contacts do to travellers goes in or out, because nothing acts on them.

use crate::kernel::LEDGER;
use crate::neighbours::contacts::Segment;
use crate::neighbours::contacts::With;
use crate::passes::zones::travel::Way;
use crate::setup::Particle;
use crate::simulation::Simulation;
use geom::Vec3;

impl Simulation {
    /// The ledger of one step, before the zones move.
    pub(crate) fn account_zones(&mut self) {
        let now = self.time();
        for t in &self.zones.travellers {
            let flow = t.flow(now, &self.zones, &self.setup);
            let state = Particle { velocity: flow.velocity, spin: flow.spin, ..t.start };
            let work = self.power(t.at as usize, &state) * self.dt;
            self.account.passed += work;
            match t.way {
                Way::In(_) => self.account.entered -= work,
                Way::Out(_) => self.account.left += work,
            }
        }
    }

    /// Of the contacts of particle `k` on it [W], in the step before the last move.
    pub(crate) fn power(&self, k: usize, state: &Particle) -> f64 {
        let (force, moment) = self.all_loads().on(k, state.radius);
        Vec3::from(force).dot(&state.velocity) + Vec3::from(moment).dot(&state.spin)
    }

    /// The like of particle `k`, or of a member of the clump that moves like this about its centre.
    pub(crate) fn power_about(&self, k: usize, whole: &Particle) -> f64 {
        let r = self.bodies.arm_at(k);
        let velocity = whole.velocity + whole.spin.cross(&r);
        self.power(k, &Particle { radius: self.particles.rows[k][3], velocity, ..*whole })
    }

    /// Elastic energy [J] of the contacts that act on nobody.
    pub(crate) fn held_by_idle(&self) -> f64 {
        if self.zones.none() {
            return 0.0;
        }
        let c = &self.contacts;
        let of = |s: &Segment| -> f64 {
            let idle = |place: &usize| self.idles(self.kinds[s.kind].with, *place);
            s.contacts().filter(idle).map(|place| c.ledger[place * LEDGER]).sum()
        };
        c.segments.iter().map(of).sum()
    }

    /// Elastic energy [J] of the contacts of particle `k` with those that have not left before it.
    pub(crate) fn held(&self, k: usize) -> f64 {
        let c = &self.contacts;
        let entries = &c.entries[c.starts[k] as usize..c.starts[k + 1] as usize];
        let of = |&entry: &u32| {
            let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
            let wall = matches!(self.kinds[c.segment_of(place).kind].with, With::Wall(_));
            let other = if second { c.i[place] } else { c.partner[place] } as usize;
            if !wall && self.zones.is_gone(other) { 0.0 } else { c.ledger[place * LEDGER] }
        };
        entries.iter().map(of).sum()
    }
}
