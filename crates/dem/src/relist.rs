//! Makes the lists anew: sorts the particles in space, finds pairs and walls near them, carries contact memory over.

use crate::interaction::{Interaction, List, With};
use crate::kernel::LEDGER;
use crate::neighbours::pairs;
use crate::simulation::{Simulation, stride};
use geom::{Grid, Vec3};
use std::collections::HashMap;

impl Simulation {
    /// Sorts, lists, and remembers.
    pub(crate) fn relist(&mut self) {
        self.wrap();
        // Freed before anything is listed: old and new together would be the most that a run ever takes.
        (self.loads, self.couples, self.ledger) = (Vec::new(), Vec::new(), Vec::new());
        (self.starts, self.entries) = (Vec::new(), Vec::new());
        let order = self.space_order();
        let before: Vec<Option<Remembered>> = {
            let count = self.particles.len();
            self.interactions.iter_mut().map(|i| Remembered::take(i, count)).collect()
        };
        self.particles.select(&order);
        self.zones.reorder(&order);
        self.bodies.reorder(&order);
        self.follow_fresh(&order);
        for k in 0..self.particles.len() {
            let r = self.particles.rows[k];
            self.particles.home[k] = [r[0], r[1], r[2], 0.0];
        }
        self.listed = self.steps;
        self.list_contacts();
        recall(&before, &mut self.interactions, &order);
        drop(before);
        self.make_room();
        self.away = 0.0;
        self.stale = false;
        self.listings += 1;
    }

    fn follow_fresh(&mut self, order: &[u32]) {
        if self.fresh.is_empty() {
            return;
        }
        let place: HashMap<u32, u32> = order.iter().zip(0u32..).map(|(&o, n)| (o, n)).collect();
        self.fresh = self.fresh.iter().filter_map(|k| place.get(k).copied()).collect();
    }

    /// Particles that have left the box through a periodic face come back through the other.
    fn wrap(&mut self) {
        if self.setup.periodic.iter().all(|p| p.is_none()) {
            return;
        }
        for k in 0..self.particles.len() {
            if self.bodies.is_member(k) {
                continue;
            }
            let p = self.wrapped(self.particles.position(k));
            self.particles.rows[k][..3].copy_from_slice(p.as_slice());
        }
        let periodic = self.setup.periodic;
        self.bodies.wrap(&mut self.particles, |p| crate::simulation::wrapped(&periodic, p));
    }

    /// Old places of the particles that stay, sorted by cell and, within a cell, by id.
    fn space_order(&self) -> Vec<u32> {
        let mut stay: Vec<u32> =
            (0..self.particles.len() as u32).filter(|&k| !self.zones.is_gone(k as usize)).collect();
        stay.sort_unstable_by_key(|&k| self.particles.id[k as usize]);
        let points: Vec<Vec3> = stay.iter().map(|&k| self.particles.position(k as usize)).collect();
        if points.is_empty() {
            return stay;
        }
        let grid = Grid::new(&points, self.cell());
        grid.order().iter().map(|&k| stay[k as usize]).collect()
    }

    fn largest_radius(&self) -> f64 {
        let count = self.particles.len();
        self.particles.rows[..count].iter().map(|r| r[3]).fold(0.0, f64::max)
    }

    fn cell(&self) -> f64 {
        (2.0 * self.largest_radius() + self.skin).max(f64::MIN_POSITIVE)
    }

    /// Lists all contacts of the particles where they were listed (`home`): a function of those places, of the step of
    /// listing, and of nothing else, so that a resumed run has the same lists.
    pub(crate) fn list_contacts(&mut self) {
        let p = &self.particles;
        let count = p.len();
        let points: Vec<Vec3> = p.home.iter().map(|h| Vec3::new(h[0], h[1], h[2])).collect();
        let radii: Vec<f64> = p.rows[..count].iter().map(|r| r[3]).collect();
        let largest = self.largest_radius();
        let grid = Grid::new(&points, self.cell());
        let time = self.listed as f64 * self.dt;
        let mut lists: Vec<List> = vec![List::default(); self.interactions.len()];
        let class = self.classes(With::Particles);
        for (i, j) in pairs(&points, &radii, &grid, largest, self.skin).into_iter().flatten() {
            if self.bodies.same(i, j) {
                continue;
            }
            lists[class.of(p.material[i as usize], p.material[j as usize])].push(i, j);
        }
        if self.setup.periodic.iter().any(|p| p.is_some()) {
            let class = self.classes(With::Images);
            for (i, j, shift) in self.image_pairs(&points, &radii, &grid, largest) {
                let list = &mut lists[class.of(p.material[i as usize], p.material[j as usize])];
                list.push(i, j);
                list.shift.push(shift);
            }
        }
        for (list, interaction) in lists.iter_mut().zip(&self.interactions) {
            if let With::Wall(w) = interaction.with {
                let member = |k: usize| p.material[k] == interaction.between.0;
                for (i, part) in self.walls[w].near(&points, &radii, member, self.skin, time) {
                    list.push(i, part);
                }
            }
        }
        self.adopt(lists, count);
    }

    fn adopt(&mut self, lists: Vec<List>, count: usize) {
        let mut places = 0;
        for (list, interaction) in lists.into_iter().zip(&mut self.interactions) {
            interaction.list(list, count);
            interaction.first_load = places;
            places += interaction.places();
        }
        self.index_loads(count);
        self.just_listed = true;
    }

    /// Room for the loads of all listed contacts; made last, when old lists are gone.
    pub(crate) fn make_room(&mut self) {
        let couples = self.interactions.iter().any(|i| i.kernel.couples());
        let places: usize = self.interactions.iter().map(|i| i.places()).sum();
        self.loads = vec![0.0; places * stride(self.particles.rotates())];
        self.couples = vec![0.0; if couples { places * 4 } else { 0 }];
        self.ledger = vec![0.0; if self.setup.ledger { places * LEDGER } else { 0 }];
    }

    /// For each particle, its loads in a fixed order.
    fn index_loads(&mut self, count: usize) {
        let each = |interactions: &[Interaction], put: &mut dyn FnMut(u32, u32)| {
            for it in interactions {
                for k in 0..it.len {
                    let load = 2 * (it.first_load + k) as u32;
                    put(it.i[k], load);
                    if !matches!(it.with, With::Wall(_)) {
                        put(it.partner[k], load + 1);
                    }
                }
            }
        };
        let mut starts = vec![0u32; count + 1];
        each(&self.interactions, &mut |particle, _| starts[particle as usize + 1] += 1);
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut entries = vec![0u32; starts[count] as usize];
        each(&self.interactions, &mut |particle, entry| {
            let place = &mut next[particle as usize];
            entries[*place as usize] = entry;
            *place += 1;
        });
        (self.starts, self.entries) = (starts, entries);
    }

    fn classes(&self, with: With) -> Classes {
        let materials = self.setup.materials.len();
        let mut at = vec![usize::MAX; materials * materials];
        for (k, i) in self.interactions.iter().enumerate().filter(|(_, i)| i.with == with) {
            let (a, b) = (i.between.0 as usize, i.between.1 as usize);
            at[a * materials + b] = k;
            at[b * materials + a] = k;
        }
        Classes { materials, at }
    }

    /// Pairs across periodic faces: i, j, and the shift of j. Each pair once, by the half of all shifts whose first part that
    /// is not zero is positive.
    fn image_pairs(&self, points: &[Vec3], radii: &[f64], grid: &Grid, largest: f64) -> Vec<Image> {
        let mut found = Vec::new();
        let (lo, hi) = geom::grid::bounds(points);
        for shift in half_of_shifts(&self.setup.periodic) {
            for (i, p) in points.iter().enumerate() {
                let reach = radii[i] + self.skin;
                let (place, far) = (p - shift, reach + largest);
                if (0..3).any(|a| place[a] < lo[a] - far || place[a] > hi[a] + far) {
                    continue;
                }
                for j in grid.runs_near(place, far).flatten() {
                    let close = reach + radii[j];
                    let near = (points[j] + shift - p).norm_squared() < close * close;
                    if near && !self.bodies.same(i as u32, j as u32) {
                        found.push((i as u32, j as u32, shift));
                    }
                }
            }
        }
        found.sort_by_key(|f: &Image| (f.0, f.1));
        found
    }
}

/// Which interaction two materials belong to.
struct Classes {
    materials: usize,
    at: Vec<usize>,
}

impl Classes {
    fn of(&self, a: u16, b: u16) -> usize {
        self.at[a as usize * self.materials + b as usize]
    }
}

/// A pair across a periodic face: i, j, the shift of j [m].
type Image = (u32, u32, Vec3);

fn half_of_shifts(periodic: &[Option<(f64, f64)>; 3]) -> Vec<Vec3> {
    let period = periodic.map(|p| p.map(|(lo, hi)| hi - lo));
    let choices = period.map(|p| if p.is_some() { vec![-1.0, 0.0, 1.0] } else { vec![0.0] });
    let mut shifts = Vec::new();
    for &x in &choices[0] {
        for &y in &choices[1] {
            for &z in &choices[2] {
                if [x, y, z].into_iter().find(|&s| s != 0.0) == Some(1.0) {
                    let of = |a: usize, s: f64| s * period[a].unwrap_or(0.0);
                    shifts.push(Vec3::new(of(0, x), of(1, y), of(2, z)));
                }
            }
        }
    }
    shifts
}

/// Lists and memory as they were before: what new contacts remember from.
struct Remembered {
    /// First contact of each particle, and one more.
    first: Vec<u32>,
    old: Interaction,
}

impl Remembered {
    /// Takes list and memory out of an interaction.
    fn take(interaction: &mut Interaction, particles: usize) -> Option<Remembered> {
        if interaction.kernel.memory() == 0 {
            return None;
        }
        let old = interaction.take_lists();
        let mut first = vec![0u32; particles + 1];
        for &i in &old.i[..old.len] {
            first[i as usize + 1] += 1;
        }
        for k in 0..particles {
            first[k + 1] += first[k];
        }
        Some(Remembered { first, old })
    }

    fn find(&self, i: u32, partner: u32) -> Option<usize> {
        let run = *self.first.get(i as usize)? as usize..*self.first.get(i as usize + 1)? as usize;
        run.into_iter().find(|&k| self.old.partner[k] == partner)
    }
}

/// Gives each new contact the memory that it had; `order` tells each particle's old place. A contact whose two partners have
/// changed places remembers the opposite.
fn recall(before: &[Option<Remembered>], now: &mut [Interaction], order: &[u32]) {
    let kinds: Vec<((u16, u16), With)> = now.iter().map(|i| (i.between, i.with)).collect();
    for (at, it) in now.iter_mut().enumerate() {
        let wall = matches!(it.with, With::Wall(_));
        // A pair may have become a pair across a periodic face, or stopped being one.
        let source = |k: usize| {
            if wall { k == at } else { kinds[k].0 == it.between && !matches!(kinds[k].1, With::Wall(_)) }
        };
        let sources: Vec<&Remembered> =
            before.iter().enumerate().filter(|(k, _)| source(*k)).filter_map(|(_, r)| r.as_ref()).collect();
        it.recall(|i, partner| {
            let i = order[i as usize];
            let partner = if wall { partner } else { order[partner as usize] };
            sources.iter().find_map(|s| {
                let same = s.find(i, partner).map(|k| (1.0, &s.old, k));
                same.or_else(|| if wall { None } else { s.find(partner, i).map(|k| (-1.0, &s.old, k)) })
            })
        });
    }
}
