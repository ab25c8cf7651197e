//! Patches of wall spheres that grains touch at once: what part each contact has in its own, found before forces are computed.

use crate::forces::tile::TileInputs;
use crate::model::With;
use crate::neighbours::{Segment, TileSlice};
use geom::Vec3;
use laws::contact::patch::{ALONE, Belonging, Bodies, Instants, PATCH, Patch};
use laws::contact::touch::{PatchLaw, Touch};
use laws::simd::{BLOCK, Row};
use std::cell::RefCell;

/// Memory that each thread keeps from one segment to the next.
#[derive(Default)]
struct Near {
    /// Contacts that may touch.
    candidates: Vec<u32>,
    grain: NearGrain,
}

thread_local! {
    static NEAR: RefCell<Near> = RefCell::default();
}

/// What is found of the spheres near one grain.
#[derive(Default)]
struct NearGrain {
    /// Those that do, or did a step ago, each with its contact.
    touches: Vec<(usize, Touch)>,
    /// What [`Patch::terms`] gives of each.
    terms: Vec<[Instants; 2]>,
    /// Share of each.
    shares: Vec<Instants>,
}

/// Where the numbers of the patches of a segment stand.
struct Numbers<'a>(&'a mut [f64]);

impl Numbers<'_> {
    /// Puts those of contact `k`.
    fn put(&mut self, k: usize, numbers: [f64; PATCH]) {
        let at = k / BLOCK * (PATCH * BLOCK) + k % BLOCK;
        numbers.iter().enumerate().for_each(|(c, number)| self.0[at + c * BLOCK] = *number);
    }
}

impl TileSlice<'_> {
    /// Finds the patches of a segment, whose contact points are known.
    pub fn find_patches(&mut self, s: &Segment, inputs: &TileInputs) {
        let kind = &inputs.model.kinds[s.kind];
        let (Some(law), With::Wall(wall)) = (kind.patch, s.with) else { return };
        let first = s.patch - self.from.patch;
        let mut numbers = Numbers(&mut self.patch[first..first + s.slots.len() * PATCH]);
        numbers.0.fill(1.0);
        let (i, wall) = (&inputs.lists.i[s.contacts()], &inputs.model.walls[wall]);
        let rows = s.rows - self.from.row;
        let points: &[Row] = &self.rows[rows..rows + s.len];
        let (direction, mass) =
            wall.mount.as_ref().map_or((Vec3::zeros(), f64::INFINITY), |m| (m.direction, m.mass));
        let bodies = |row: &Row| Bodies { inverse_mass: row.inverse_mass(), direction, wall: 1.0 / mass };
        if wall.mount.is_some() {
            for (k, (&grain, point)) in i.iter().zip(points).enumerate() {
                let row = &inputs.step.rows[grain as usize];
                let apart = row.position() - point.position();
                numbers.put(k, bodies(row).alone(&apart.normalize()));
            }
        }
        if !law.shared {
            return;
        }
        let times = [inputs.step.dt, inputs.step.ahead];
        let held = |k: usize, row: &Row| {
            if law.gap == 0.0 {
                return 0.0;
            }
            // The history of a law that adheres begins with what says that contact was made.
            let (history, columns) = (s.history - self.from.history, kind.composition.columns());
            let at = self.layout.history_at(history, k, 0, columns);
            law.held(row, &points[k], self.layout.get(self.history, at) > 0.0)
        };
        NEAR.with_borrow_mut(|near| {
            let Near { candidates, grain } = near;
            let longest = times[0].max(times[1]);
            let more = [longest, wall.fastest(), inputs.model.reach];
            find_candidates(candidates, i, inputs.step.rows, points, more);
            for of in candidates.chunk_by(|&a, &b| i[a as usize] == i[b as usize]) {
                if let [first, _, ..] = of {
                    let row = &inputs.step.rows[i[*first as usize] as usize];
                    grain.touches.clear();
                    grain.touches.extend(of.iter().filter_map(|&k| {
                        let k = k as usize;
                        let touch = Touch::of(law, times, row, &points[k], held(k, row));
                        touch.counts().then_some((k, touch))
                    }));
                    grain.find(law, &bodies(row), &mut numbers);
                }
            }
        });
    }
}

/// Finds which contacts of a segment may touch now, or did a step ago: grains `i` of some rows beside spheres at `points`. `more`: how long grains may
/// move [s], how fast the wall is at most [m/s], and how far it acts without touch [m].
///
/// Without a branch: most of these contacts do not touch, in no order that a processor could guess.
fn find_candidates(
    found: &mut Vec<u32>,
    i: &[u32],
    rows: &[Row],
    points: &[Row],
    [longest, fastest, beyond]: [f64; 3],
) {
    found.resize(i.len(), 0);
    let mut count = 0;
    for (k, (&i, point)) in i.iter().zip(points).enumerate() {
        let row = &rows[i as usize];
        let [_, _, _, radius, u, v, w, _] = **row;
        // No less than the way of both.
        let way = longest * (u.abs() + v.abs() + w.abs() + fastest);
        // A little more, so that no rounding leaves out what [`Touch::of`] finds.
        let far = (radius + point.radius() + way + beyond) * (1.0 + 1e-9);
        found[count] = k as u32;
        count += usize::from((row.position() - point.position()).norm_squared() < far * far);
    }
    found.truncate(count);
}

impl NearGrain {
    /// Gives the numbers of each contact of a patch; nothing where at most one is touched.
    fn find(&mut self, law: PatchLaw, bodies: &Bodies, numbers: &mut Numbers) {
        let NearGrain { touches, terms, shares } = self;
        let count = touches.len();
        let Some(mut patch) = Patch::of(law, count, |k| touches[k].1) else { return };
        if patch.belonging == Belonging::EachTwo {
            terms.clear();
            terms.extend((0..count).map(|k| patch.terms(k)));
            patch.known = terms;
        }
        shares.clear();
        shares.extend((0..count).map(|k| patch.shares(k)));
        let push = patch.push(bodies, |k| shares[k][0]);
        for k in 0..count {
            let found = patch.numbers(k, &push, bodies, shares[k]);
            if found != ALONE {
                numbers.put(touches[k].0, found);
            }
        }
    }
}
