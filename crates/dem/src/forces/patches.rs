//! Patches of wall spheres that grains touch at once: what part each contact has in its own, found before forces are computed.

use crate::forces::tile::TileInputs;
use crate::kernel::patch::{ALONE, Bodies, Instant, PATCH, Patch, PatchLaw, Touch};
use crate::model::With;
use crate::neighbours::{Segment, TileSlice};
use crate::simd::{BLOCK, Row};
use geom::Vec3;
use std::ops::Range;

/// What is found of the spheres near one grain; the memory is kept from one grain to the next.
#[derive(Default)]
struct Near {
    touches: Vec<Touch>,
    /// What [`Patch::terms`] gives of each, now and a step ago.
    terms: Vec<[[f64; 2]; 2]>,
    /// Share of each, now and a step ago.
    shares: Vec<[f64; 2]>,
}

impl TileSlice<'_> {
    /// Finds the patches of a segment, whose contact points are known.
    pub fn find_patches(&mut self, s: &Segment, inputs: &TileInputs) {
        let kind = &inputs.model.kinds[s.kind];
        let (Some(law), With::Wall(wall)) = (kind.patch, s.with) else { return };
        let first = s.patch - self.from.patch;
        self.patch[first..first + s.slots.len() * PATCH].fill(1.0);
        let (i, wall) = (&inputs.lists.i[s.contacts()], &inputs.model.walls[wall]);
        let (direction, mass) =
            wall.mount.as_ref().map_or((Vec3::zeros(), f64::INFINITY), |m| (m.direction, m.mass));
        let remembers = kind.kernel.columns() > 0;
        let (mut near, mut from) = (Near::default(), 0);
        while from < s.len {
            let to = from + i[from..].iter().take_while(|&&k| k == i[from]).count();
            let row = &inputs.step.rows[i[from] as usize];
            let bodies = Bodies { inverse_mass: row[7], direction, wall: 1.0 / mass };
            let put = |k: usize, numbers: [f64; PATCH], patch: &mut [f64]| {
                let at = first + (from + k) / BLOCK * (PATCH * BLOCK) + (from + k) % BLOCK;
                numbers.iter().enumerate().for_each(|(c, number)| patch[at + c * BLOCK] = *number);
            };
            if wall.mount.is_some() {
                for k in from..to {
                    let apart = row.position() - self.point(s, k).position();
                    put(k - from, bodies.alone(&apart.normalize()), self.patch);
                }
            }
            if law.shared && self.several_touch(s, from..to, (row, wall.fastest()), inputs) {
                near.touches.clear();
                let step = [inputs.step.dt, inputs.step.ahead];
                near.touches.extend((from..to).map(|k| {
                    Touch::of(step, row, self.point(s, k), self.held(s, k, row, law, kind.kernel.columns()))
                }));
                near.find(law, remembers, &bodies, |k, numbers| put(k, numbers, self.patch));
            }
            from = to;
        }
    }

    /// The wall's point of contact `k` of a segment.
    fn point(&self, s: &Segment, k: usize) -> &Row {
        &self.rows[s.rows - self.from.row + k]
    }

    /// Gap up to which contact `k` lasts, once it is made or where it is being made [m].
    fn held(&self, s: &Segment, k: usize, row: &Row, law: PatchLaw, columns: usize) -> f64 {
        if law.gap == 0.0 {
            return 0.0;
        }
        // The history of a law that adheres begins with what says that contact was made.
        let at = self.layout.history_at(s.history - self.from.history, k, 0, columns);
        let other = self.point(s, k);
        let reach = row[3] + other[3];
        let touches = (row.position() - other.position()).norm_squared() < reach * reach;
        let made = touches || self.layout.get(self.history, at) > 0.0;
        if made { law.gap * libm::cbrt(row[3] * other[3] / reach) } else { 0.0 }
    }

    /// Whether a grain in `row` may touch two or more of some contacts of a wall, no faster than `fastest` [m/s], in this step.
    fn several_touch(
        &self,
        s: &Segment,
        contacts: Range<usize>,
        (row, fastest): (&Row, f64),
        inputs: &TileInputs,
    ) -> bool {
        if contacts.len() < 2 {
            return false;
        }
        let ahead = inputs.step.ahead;
        let way = if ahead > 0.0 { ahead * (row.velocity().norm() + fastest) } else { 0.0 };
        let reach = row[3] + way + inputs.model.reach;
        let touches = |k: &usize| {
            let other = self.point(s, *k);
            // A little more, so that no rounding leaves out what [`Touch::of`] finds.
            let far = (reach + other[3]) * (1.0 + 1e-9);
            (row.position() - other.position()).norm_squared() < far * far
        };
        contacts.filter(touches).nth(1).is_some()
    }
}

impl Near {
    /// Gives the numbers of each contact of a patch; nothing where at most one is touched. `remembers`: whether springs know their stiffness a step ago.
    fn find(
        &mut self,
        law: PatchLaw,
        remembers: bool,
        bodies: &Bodies,
        mut put: impl FnMut(usize, [f64; PATCH]),
    ) {
        let Near { touches, terms, shares } = self;
        let count = touches.len();
        let Some(mut patch) = Patch::of(law, count, |k| touches[k]) else { return };
        let instants = if remembers { &Instant::BOTH[..] } else { &Instant::BOTH[..1] };
        if !patch.together {
            terms.clear();
            terms.extend((0..count).map(|k| {
                let mut of = [[0.0; 2]; 2];
                instants.iter().for_each(|&instant| of[instant as usize] = patch.terms(k, instant));
                of
            }));
            patch.known = terms;
        }
        shares.clear();
        shares.extend((0..count).map(|k| {
            let now = patch.share(k, Instant::Now);
            [now, if remembers { patch.share(k, Instant::Before) } else { now }]
        }));
        let push = patch.push(|k| shares[k][0]);
        for k in 0..count {
            let numbers = patch.numbers(k, &push, bodies, |k| shares[k]);
            if numbers != ALONE {
                put(k, numbers);
            }
        }
    }
}
