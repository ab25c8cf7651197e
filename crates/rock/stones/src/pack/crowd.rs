//! Makes room for stones that find none at random: a stone begins small in a gap, and grows while it and its neighbours move a little.
//!
//! Placing at random ends when the gaps are smaller than the stones, long before the box is full ("jamming limit" of random sequential addition: 38 % of
//! the volume for equal spheres; Feder 1980, DOI 10.1016/0022-5193(80)90358-6). Random moves of hard bodies (Metropolis et al. 1953,
//! DOI 10.1063/1.1699114) gather gaps into larger ones, and growth between them (in the manner of Lubachevsky & Stillinger 1990, DOI 10.1007/BF01025983)
//! takes them at once. A move or a growth that would make two stones overlap, or leave the box, is undone, so what holds of stones that are placed at random
//! holds here.

use super::{Obstacle, Packer, Undone};
use crate::grading::Class;
use crate::placed::PlacedStone;
use geom::Vec3;
use geom::random::unit;
use nalgebra::UnitQuaternion;

/// Sizes at which a stone begins, over its own: the first that finds a gap.
const SEEDS: [f64; 4] = [0.8, 0.65, 0.5, 0.35];
/// Random places tried for each of them.
const PLACES: u32 = 500;
/// Stones nearer to the growing one than this, in its sieve sizes, move.
const NEAR: f64 = 3.0;
/// Growth that is tried after a round, over the size: the largest that fits.
const GROWTH: [f64; 5] = [0.2, 0.1, 0.05, 0.02, 0.005];
/// Largest move at first, over the radius of the sphere around a stone [–], and its limits.
const MOVE: f64 = 0.1;
const MOVES: [f64; 2] = [1e-3, 0.3];
/// Stones in a row that cannot be placed, after which a class ends.
const FAILURES: u32 = 5;
/// Moves of a round that should succeed [–]: fewer, and they become shorter.
const SUCCESS: f64 = 0.4;

impl Packer<'_> {
    /// Makes room for stones of a class, one after the other, until its content is reached or several in a row cannot be placed; the number of stones,
    /// and what was in the way of the last one.
    pub(super) fn crowd(
        &mut self,
        index: usize,
        class: &Class,
        undone: &mut Undone,
        progress: &impl Fn(f64),
    ) -> (usize, Option<Obstacle>) {
        let (mut stones, mut failures, mut last) = (0, 0, None);
        // Stones that are too heavy for what is missing are drawn again, as often as at random.
        for _ in 0..self.settings.tries {
            if self.is_reached(index, class) || failures == FAILURES {
                break;
            }
            let Some((stone, volume)) = self.draw(index, class) else {
                undone.too_heavy += 1;
                continue;
            };
            match self.make_room(stone, index, volume) {
                Ok(()) => {
                    (stones, failures) = (stones + 1, 0);
                    progress(self.done());
                }
                Err(obstacle) => {
                    undone.count(obstacle);
                    (failures, last) = (failures + 1, Some(obstacle));
                }
            }
        }
        (stones, last)
    }

    /// Places a stone small and lets it grow; all is as before where that does not place it.
    fn make_room(&mut self, stone: usize, class: usize, volume: f64) -> Result<(), Obstacle> {
        let of = &self.library.stones[stone];
        let full = (volume / of.stone.moments.volume).cbrt();
        let (seed, share) = self.seed(stone, class, full)?;
        let new = self.placed.len();
        let near = NEAR * of.shape.sieve_size * full + of.reach * full;
        let close = |p: &PlacedStone| {
            (p.centre - seed.centre).norm() < near + self.library.stones[p.stone].reach * p.scale
        };
        let others: Vec<usize> = (0..new).filter(|k| close(&self.placed[*k])).collect();
        let before: Vec<PlacedStone> = others.iter().map(|k| self.placed[*k].clone()).collect();
        let moving: Vec<usize> = others.iter().copied().chain([new]).collect();
        self.placed.push(seed);
        let placed = self.grow(&moving, full, share).and_then(|()| self.claim(&moving));
        match placed {
            Ok(()) => self.volumes[class] += volume,
            Err(_) => {
                moving.iter().for_each(|k| self.release(*k));
                self.placed.truncate(new);
                others.iter().zip(before).for_each(|(k, stone)| self.placed[*k] = stone);
                others.iter().for_each(|k| self.take(*k));
            }
        }
        placed
    }

    /// A stone at a share of its size, in a gap.
    fn seed(&mut self, stone: usize, class: usize, full: f64) -> Result<(PlacedStone, f64), Obstacle> {
        if self.library.stones[stone].shape.sides[2] * full > self.room() {
            return Err(Obstacle::TooLarge);
        }
        for share in SEEDS {
            for _ in 0..PLACES {
                let at = self.random_place(stone, class, share * full);
                if let Some(placed) = at.filter(|placed| self.is_free(placed, usize::MAX)) {
                    return Ok((placed, share));
                }
            }
        }
        Err(Obstacle::NoRoom)
    }

    /// Rounds of moves and growth until the last of the moving stones has its size.
    fn grow(&mut self, moving: &[usize], full: f64, mut share: f64) -> Result<(), Obstacle> {
        let new = self.placed.len() - 1;
        let mut step = MOVE;
        for _ in 0..self.settings.rounds {
            let moved = moving.iter().filter(|k| self.moved(**k, step)).count();
            let success = moved as f64 / moving.len() as f64;
            step = (step * if success < SUCCESS { 0.9 } else { 1.1 }).clamp(MOVES[0], MOVES[1]);
            let larger = GROWTH.map(|growth| (share * (1.0 + growth)).min(1.0));
            let fits = larger.into_iter().find(|larger| {
                let old = &self.placed[new];
                let grown = self.stone_at((old.stone, old.class), larger * full, old.orientation, old.centre);
                self.replaced(new, grown)
            });
            share = fits.unwrap_or(share);
            if share >= 1.0 {
                return Ok(());
            }
        }
        Err(Obstacle::NoRoom)
    }

    /// Moves and turns a stone randomly; whether it could.
    fn moved(&mut self, k: usize, step: f64) -> bool {
        let mut draw = || 2.0 * unit(&mut self.random) - 1.0;
        let [way, turn] = [(); 2].map(|()| Vec3::new(draw(), draw(), draw()) * step);
        let old = &self.placed[k];
        let reach = self.library.stones[old.stone].reach * old.scale;
        let orientation = UnitQuaternion::from_scaled_axis(turn) * old.orientation;
        let moved = self.stone_at((old.stone, old.class), old.scale, orientation, old.centre + way * reach);
        self.replaced(k, moved)
    }

    fn stone_at(
        &self,
        (stone, class): (usize, usize),
        scale: f64,
        orientation: UnitQuaternion<f64>,
        centre: Vec3,
    ) -> PlacedStone {
        PlacedStone::new((stone, &self.library.stones[stone]), class, scale, orientation, centre)
    }

    /// Puts a stone instead of another one, if it is in the box and overlaps no third.
    fn replaced(&mut self, k: usize, by: PlacedStone) -> bool {
        let [lo, hi] = self.settings.bounds;
        let within = (0..3).all(|a| by.bounds[0][a] >= lo[a] && by.bounds[1][a] <= hi[a]);
        let free = within && self.is_free(&by, k);
        if free {
            let grains = std::mem::take(&mut self.placed[k].grains);
            self.placed[k] = PlacedStone { grains, ..by };
        }
        free
    }

    /// Whether a stone overlaps none but the k-th.
    pub(super) fn is_free(&self, placed: &PlacedStone, k: usize) -> bool {
        let of = |stone: usize| &self.library.stones[stone];
        let mut others = self.placed.iter().enumerate().filter(|(other, _)| *other != k);
        !others.any(|(_, other)| placed.overlaps(of(placed.stone), other, of(other.stone)))
    }

    /// Gives stones that have moved the grains that are inside of them now.
    fn claim(&mut self, moving: &[usize]) -> Result<(), Obstacle> {
        moving.iter().for_each(|k| self.release(*k));
        for &k in moving {
            self.placed[k].grains = self.own_grains(&self.placed[k])?;
            self.take(k);
        }
        Ok(())
    }

    /// The grains of a stone become those of the soil again.
    fn release(&mut self, k: usize) {
        for grain in std::mem::take(&mut self.placed[k].grains) {
            self.clusters[grain as usize] = 0;
            self.soil_mass += self.soil.masses[grain as usize];
        }
    }

    /// The grains of a stone are no longer those of the soil.
    pub(super) fn take(&mut self, k: usize) {
        for &grain in &self.placed[k].grains {
            self.clusters[grain as usize] = k as u32 + 1;
            self.soil_mass -= self.soil.masses[grain as usize];
        }
    }
}
