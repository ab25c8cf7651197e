//! Places stones of real shape in settled soil, one by one: random stone, random size, random orientation, random position; undone if it overlaps.
//!
//! The grains whose centres are inside a placed stone become its grains. Every random number comes from one stream, and stones are tried one after the
//! other, so the result is a function of the inputs and the seed alone.

mod crowd;
mod report;

pub use report::{ClassReport, Undone};

use crate::content::{excess, final_mass};
use crate::grading::Class;
use crate::library::Library;
use crate::placed::PlacedStone;
use crate::random::random_orientation;
use geom::random::{generator, unit};
use geom::{Grid, Shown, Vec3};
use rand_pcg::Pcg64Mcg;
use report::{Obstacle, missed};
use thiserror::Error;

/// Stream of random numbers.
const STREAM: u64 = 0x7061_636b;

/// Grains of settled soil.
#[derive(Debug, Clone, Default)]
pub struct Soil {
    /// Centres [m].
    pub centres: Vec<Vec3>,
    /// Mass of each [kg].
    pub masses: Vec<f64>,
}

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PackSettings {
    /// p, mass of the stones over the total mass [–].
    pub content: f64,
    /// Allowed excess of the content, and of each class, over it [–].
    pub tolerance: f64,
    /// ρ_r, density of the stones [kg/m³].
    pub density: f64,
    /// Box that stones lie in: lowest and highest corner [m].
    pub bounds: [Vec3; 2],
    /// Most tries for each class.
    pub tries: u64,
    /// Rounds of moves in which room is made for a stone when the tries of its class have run out; 0: none is made.
    pub rounds: u64,
    /// Fewest grains of a stone.
    pub least_grains: usize,
    pub seed: u64,
}

/// Why nothing can be placed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PackError {
    #[error("the soil has no grain inside the box: give the soil, or another --within")]
    NoSoil,
    #[error("class {class}: no stone fits into the box: stone '{name}' is {} m wide, the box {} m; give a larger box or smaller stones", Shown(*size), Shown(*room))]
    Large { class: u32, name: String, size: f64, room: f64 },
}

/// Stones at their places.
#[derive(Debug, Clone)]
pub struct Packing {
    /// The stones, in the order in which they were placed; cluster k + 1 is the k-th.
    pub placed: Vec<PlacedStone>,
    /// Of each grain: 0, or the cluster that it belongs to.
    pub clusters: Vec<u32>,
    /// Content reached [–].
    pub content: f64,
    /// Total mass [kg]: stones, and the soil that is in none.
    pub mass: f64,
    /// Mass of the stones [kg].
    pub stone_mass: f64,
    /// Each class, in the order of the grading.
    pub classes: Vec<ClassReport>,
}

/// What was done for a class.
#[derive(Debug, Clone, Copy, Default)]
struct ClassRun {
    tries: u64,
    undone: Undone,
    /// Stones for which room was made.
    crowded: usize,
    /// What was in the way of the last one for which none was made.
    obstacle: Option<Obstacle>,
    /// Whether its content is not reached.
    missed: bool,
}

struct Packer<'a> {
    library: &'a Library,
    soil: &'a Soil,
    settings: &'a PackSettings,
    grid: Grid,
    random: Pcg64Mcg,
    placed: Vec<PlacedStone>,
    clusters: Vec<u32>,
    /// Volume of the stones of each class [m³].
    volumes: Vec<f64>,
    soil_mass: f64,
    bulk: f64,
}

/// Places stones until each class has its content, or its tries are used up. `progress` gets the share of the content that is reached.
///
/// # Errors
/// No soil in the box; a class whose stones do not fit into it.
pub fn pack(
    library: &Library,
    classes: &[Class],
    soil: &Soil,
    settings: &PackSettings,
    progress: impl Fn(f64),
) -> Result<Packing, PackError> {
    let [lo, hi] = settings.bounds;
    let within = |p: &Vec3| (0..3).all(|k| p[k] >= lo[k] && p[k] <= hi[k]);
    let in_box = || soil.centres.iter().zip(&soil.masses).filter(|(p, _)| within(p)).map(|(_, m)| m);
    let volume: f64 = (hi - lo).iter().product();
    if in_box().next().is_none() {
        return Err(PackError::NoSoil);
    }
    // About four grains in a cell.
    let cell = (4.0 * volume / in_box().count() as f64).cbrt();
    let mut packer = Packer {
        library,
        soil,
        settings,
        grid: Grid::new(&soil.centres, cell),
        random: generator(settings.seed, STREAM, 0),
        placed: Vec::new(),
        clusters: vec![0; soil.centres.len()],
        volumes: vec![0.0; classes.len()],
        soil_mass: soil.masses.iter().sum(),
        bulk: in_box().sum::<f64>() / volume,
    };
    // Large stones first: they find no place later.
    let largest = |c: &Class| c.stones.iter().map(|&k| packer.size_range(c, k).1).fold(0.0, f64::max);
    let mut order: Vec<(usize, f64)> = classes.iter().enumerate().map(|(k, c)| (k, largest(c))).collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut runs = vec![ClassRun::default(); classes.len()];
    for (k, _) in order {
        packer.fits(&classes[k])?;
        runs[k] = packer.class(k, &classes[k], &progress);
    }
    Ok(packer.finish(classes, &runs))
}

impl Packer<'_> {
    /// Volumes that a stone of a class can have [m³].
    fn size_range(&self, class: &Class, stone: usize) -> (f64, f64) {
        let of = &self.library.stones[stone];
        let volume = of.stone.moments.volume;
        let at = |sieve: f64| volume * (sieve / of.shape.sieve_size).powi(3);
        class.sieves.map_or((volume, volume), |(low, high)| (at(low), at(high)))
    }

    /// Refuses a class of which not even the smallest stone fits into the box.
    fn fits(&self, class: &Class) -> Result<(), PackError> {
        let room = self.room();
        let scale =
            |k: usize| class.sieves.map_or(1.0, |(low, _)| low / self.library.stones[k].shape.sieve_size);
        let width = |k: usize| self.library.stones[k].shape.sides[2] * scale(k);
        let smallest = class.stones.iter().map(|&k| (width(k), k)).min_by(|a, b| a.0.total_cmp(&b.0));
        match smallest {
            Some((size, k)) if size > room => {
                let name = self.library.stones[k].name.clone();
                Err(PackError::Large { class: class.number, name, size, room })
            }
            _ => Ok(()),
        }
    }

    /// Shortest side of the box [m].
    fn room(&self) -> f64 {
        (self.settings.bounds[1] - self.settings.bounds[0]).min()
    }

    /// The total mass at the end [kg], as far as it is known.
    fn mass(&self) -> f64 {
        let s = self.settings;
        final_mass(self.soil_mass, self.volumes.iter().sum(), self.bulk, s.density, s.content)
    }

    /// Whether a class has its content.
    fn is_reached(&self, index: usize, class: &Class) -> bool {
        let wanted = self.settings.content * class.share;
        excess(self.volumes[index], self.settings.density, self.mass(), wanted) >= -self.settings.tolerance
    }

    /// Share of the content that is reached.
    fn done(&self) -> f64 {
        let all = self.volumes.iter().sum::<f64>() * self.settings.density;
        (all / (self.mass() * self.settings.content)).min(1.0)
    }

    /// A random stone of a class and its volume [m³]; `None` if it is too heavy for what is missing.
    fn draw(&mut self, index: usize, class: &Class) -> Option<(usize, f64)> {
        let (density, wanted, mass) =
            (self.settings.density, self.settings.content * class.share, self.mass());
        let stone = class.stones[(unit(&mut self.random) * class.stones.len() as f64) as usize];
        let volume = self.volume(class, stone, mass * wanted / density - self.volumes[index]);
        let above = excess(self.volumes[index] + volume, density, mass, wanted) > self.settings.tolerance;
        (!above).then_some((stone, volume))
    }

    /// Tries stones of a class until its content is reached, and makes room for the others where that is asked for.
    fn class(&mut self, index: usize, class: &Class, progress: &impl Fn(f64)) -> ClassRun {
        let mut run = ClassRun::default();
        while run.tries < self.settings.tries && !self.is_reached(index, class) {
            run.tries += 1;
            let Some((stone, volume)) = self.draw(index, class) else {
                run.undone.too_heavy += 1;
                continue;
            };
            if self.attempt(stone, index, volume, &mut run.undone) {
                progress(self.done());
            }
        }
        if self.settings.rounds > 0 && !self.is_reached(index, class) {
            (run.crowded, run.obstacle) = self.crowd(index, class, &mut run.undone, progress);
        }
        run.missed = !self.is_reached(index, class);
        run
    }

    /// The volume of the next stone [m³]: of a random sieve size of its class. The last ones fill what is missing, if that is a size of the class.
    fn volume(&mut self, class: &Class, stone: usize, missing: f64) -> f64 {
        let (least, most) = self.size_range(class, stone);
        let share = unit(&mut self.random);
        let volume = least * (most / least).powf(share);
        match missing - volume {
            rest if rest >= least => volume,
            _ if missing <= most => missing.max(least),
            // Two more stones, neither too small.
            _ => (missing / 2.0).clamp(least, most),
        }
    }

    fn attempt(&mut self, stone: usize, class: usize, volume: f64, undone: &mut Undone) -> bool {
        let of = &self.library.stones[stone];
        let scale = (volume / of.stone.moments.volume).cbrt();
        let Some(mut placed) = self.random_place(stone, class, scale) else {
            undone.count(Obstacle::TooLarge);
            return false;
        };
        if !self.is_free(&placed, usize::MAX) {
            undone.overlaps += 1;
            return false;
        }
        match self.own_grains(&placed) {
            Ok(grains) => placed.grains = grains,
            Err(obstacle) => {
                undone.count(obstacle);
                return false;
            }
        }
        self.volumes[class] += placed.volume(of);
        self.placed.push(placed);
        self.take(self.placed.len() - 1);
        true
    }

    /// A stone with a random orientation at a random place in the box; `None` if it is larger than the box.
    fn random_place(&mut self, stone: usize, class: usize, scale: f64) -> Option<PlacedStone> {
        let of = &self.library.stones[stone];
        let orientation = random_orientation(&mut self.random);
        let draw = [unit(&mut self.random), unit(&mut self.random), unit(&mut self.random)];
        let (lo, hi) = of
            .arms()
            .map(|arm| orientation * (arm * scale))
            .fold((Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)), |(lo, hi), p| {
                (lo.inf(&p), hi.sup(&p))
            });
        // Places of the centre at which the stone is in the box.
        let (first, last) = (self.settings.bounds[0] - lo, self.settings.bounds[1] - hi);
        let fits = (0..3).all(|k| first[k] <= last[k]);
        let centre = first + (last - first).component_mul(&Vec3::from(draw));
        fits.then(|| PlacedStone::new((stone, of), class, scale, orientation, centre))
    }

    /// The grains of a stone: enough of them, and none of another stone.
    fn own_grains(&self, placed: &PlacedStone) -> Result<Vec<u32>, Obstacle> {
        let grains = self.grains(placed);
        if grains.len() < self.settings.least_grains {
            return Err(Obstacle::FewGrains);
        }
        let shared = grains.iter().any(|&g| self.clusters[g as usize] > 0);
        if shared { Err(Obstacle::SharedGrains) } else { Ok(grains) }
    }

    /// Grains whose centres are in a stone, ascending.
    fn grains(&self, placed: &PlacedStone) -> Vec<u32> {
        let of = &self.library.stones[placed.stone];
        let near = self.grid.within(&self.soil.centres, placed.centre, of.reach * placed.scale);
        let mut inside: Vec<u32> =
            near.filter(|&g| placed.contains(of, &self.soil.centres[g as usize])).collect();
        inside.sort_unstable();
        inside
    }

    fn finish(self, classes: &[Class], runs: &[ClassRun]) -> Packing {
        let (density, total) = (self.settings.density, self.volumes.iter().sum::<f64>());
        let stone_mass = total * density;
        let mass = self.soil_mass + stone_mass;
        let report = |k: usize| {
            let (class, run) = (&classes[k], runs[k]);
            let wanted = self.settings.content * class.share;
            let stones = self.placed.iter().filter(|p| p.class == k).count();
            let volume = self.volumes[k];
            ClassReport {
                class: class.number,
                stones,
                content_wanted: wanted,
                content: volume * density / mass,
                excess: excess(volume, density, mass, wanted),
                share_wanted: class.share,
                share: if total > 0.0 { volume / total } else { 0.0 },
                tries: run.tries,
                undone: run.undone,
                crowded: run.crowded,
                missed: run.missed.then(|| missed(run.tries, &run.undone, run.obstacle)),
            }
        };
        let classes = (0..classes.len()).map(report).collect();
        Packing {
            content: stone_mass / mass,
            mass,
            stone_mass,
            classes,
            placed: self.placed,
            clusters: self.clusters,
        }
    }
}

#[cfg(test)]
#[path = "pack/tests.rs"]
mod tests;
