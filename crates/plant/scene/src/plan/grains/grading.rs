//! Which grains an entry makes: sizes and materials with their shares.
//!
//! ```text
//! next class = argmin_k  (T_k + m_k/2)/s_k        s_k: its share, T_k: mass (or number) of the class so far
//! n̄ = Σ s_k/m_k                                   grains per mass, m_k: mean mass (or number, 1) of a grain of the class
//! ```
//!
//! The next grain is of the class that comes first to half a grain behind its share (Webster's rule of seats): at any time each class is about half a grain too
//! much or too little, whatever its size, so that classes of few large grains are not begun too early. Within a class
//! diameters are uniform, or even over ln d by what the shares are of, as between two sieves:
//!
//! ```text
//! by number   d = a (b/a)^u                        ⟨d³⟩ = (b³ − a³)/(3 ln(b/a))
//! by mass     d = (a⁻³ − u (a⁻³ − b⁻³))^(−⅓)       ⟨d³⟩ = 3 ln(b/a)/(a⁻³ − b⁻³)         u from 0 to 1, from a to b
//! u ← u + (√5 − 1)/2, less 1 from 1 on, from a random start: any n of them fill [0, 1) evenly
//! ```

use crate::keys::{OneOrRange, ShareOf};
use crate::plan::grains::random::{diameter, unit};
use geom::sphere::volume;
use rand_pcg::Pcg64Mcg;

/// Step of a sequence that fills [0, 1) most evenly: the golden ratio less 1.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// How diameters lie in a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::plan) enum Spread {
    /// Uniform, by number.
    Uniform,
    /// Even over ln d, by number.
    Number,
    /// Even over ln d, by mass.
    Mass,
}

/// Grains of one range of sizes and one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::plan) struct Class {
    /// Diameters [m].
    pub range: OneOrRange,
    /// How they lie in between.
    pub spread: Spread,
    /// Share of the whole, of mass or of number [–]; all together are 1.
    pub share: f64,
    /// Index of the material.
    pub material: u16,
    /// Mass over the volume of the sphere [kg/m³].
    pub density: f64,
}

impl Class {
    /// Mean mass of a grain [kg].
    fn mean_mass(&self) -> f64 {
        self.mean_volume() * self.density
    }

    fn mean_volume(&self) -> f64 {
        let OneOrRange { low, high } = self.range;
        let (wide, cube) = (libm::log(high / low), |d: f64| d * d * d);
        let cubed = match self.spread {
            _ if low == high => cube(low),
            Spread::Uniform => 0.25 * (low + high) * (low * low + high * high),
            Spread::Number => (cube(high) - cube(low)) / (3.0 * wide),
            Spread::Mass => 3.0 * wide / (1.0 / cube(low) - 1.0 / cube(high)),
        };
        volume(0.5) * cubed
    }

    /// The next diameter [m], and its u on a curve, after the `last` one.
    fn diameter(&self, last: Option<f64>, random: &mut Pcg64Mcg) -> (f64, Option<f64>) {
        let OneOrRange { low, high } = self.range;
        if self.spread == Spread::Uniform {
            return (diameter(self.range, random), None);
        }
        let u = last.map_or_else(|| unit(random), |u| (u + GOLDEN).fract());
        let [a, b] = [low, high].map(|d| 1.0 / (d * d * d));
        let diameter = match self.spread {
            Spread::Number => low * libm::pow(high / low, u),
            _ => 1.0 / libm::cbrt(a - u * (a - b)),
        };
        (diameter.clamp(low, high), Some(u))
    }
}

/// All classes of an entry, and how much of each was made.
#[derive(Debug, Clone)]
pub(in crate::plan) struct Grading {
    classes: Vec<Class>,
    of: ShareOf,
    /// Mass [kg] or number of each class so far.
    made: Vec<f64>,
    /// u of the last grain of each class.
    last: Vec<Option<f64>>,
}

/// A grain that is about to be made.
#[derive(Debug, Clone, Copy)]
pub(in crate::plan) struct Grain {
    /// Number of its class.
    class: usize,
    /// Its place on the curve of its class.
    u: Option<f64>,
    /// [m].
    pub diameter: f64,
    /// [kg].
    pub mass: f64,
    /// Index of its material.
    pub material: u16,
}

impl Grading {
    /// Of classes whose shares are known up to a factor; at least one.
    pub(in crate::plan) fn new(mut classes: Vec<Class>, of: ShareOf) -> Grading {
        let sum: f64 = classes.iter().map(|c| c.share).sum();
        classes.iter_mut().for_each(|c| c.share /= sum);
        Grading { made: vec![0.0; classes.len()], last: vec![None; classes.len()], classes, of }
    }

    /// One material, diameters uniform in a range.
    pub(in crate::plan) fn uniform(range: OneOrRange, material: u16, density: f64) -> Grading {
        Grading::new(
            vec![Class { range, spread: Spread::Uniform, share: 1.0, material, density }],
            ShareOf::Mass,
        )
    }

    /// Smallest and largest diameter [m].
    pub(in crate::plan) fn range(&self) -> OneOrRange {
        let low = self.classes.iter().map(|c| c.range.low).fold(f64::INFINITY, f64::min);
        let high = self.classes.iter().map(|c| c.range.high).fold(0.0, f64::max);
        OneOrRange { low, high }
    }

    /// Material and radius [m] of the smallest and of the largest grain of each class.
    pub(in crate::plan) fn sizes(&self) -> impl Iterator<Item = (u16, f64)> + '_ {
        self.classes.iter().flat_map(|c| [c.range.low, c.range.high].map(|d| (c.material, d / 2.0)))
    }

    /// Materials, each once.
    pub(in crate::plan) fn materials(&self) -> Vec<u16> {
        let mut all: Vec<u16> = self.classes.iter().map(|c| c.material).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Mean mass [kg] and volume [m³] of a grain.
    pub(in crate::plan) fn mean(&self) -> (f64, f64) {
        let number = |c: &Class| match self.of {
            ShareOf::Mass => c.share / c.mean_mass(),
            ShareOf::Number => c.share,
        };
        let sum = |of: &dyn Fn(&Class) -> f64| self.classes.iter().map(|c| number(c) * of(c)).sum::<f64>();
        let all = sum(&|_| 1.0);
        (sum(&Class::mean_mass) / all, sum(&Class::mean_volume) / all)
    }

    /// The next grain; it counts once it is [`Grading::make`]-d.
    pub(in crate::plan) fn next(&self, random: &mut Pcg64Mcg) -> Grain {
        let due = |k: usize| {
            let class = &self.classes[k];
            let grain = if self.of == ShareOf::Mass { class.mean_mass() } else { 1.0 };
            (self.made[k] + 0.5 * grain) / class.share
        };
        // Of equals the one with the largest share, and of these the first.
        let order = |a: &usize, b: &usize| {
            let shares = self.classes[*b].share.total_cmp(&self.classes[*a].share);
            due(*a).total_cmp(&due(*b)).then(shares).then(a.cmp(b))
        };
        let class = (0..self.classes.len()).min_by(order).unwrap_or(0);
        let Class { material, density, .. } = self.classes[class];
        let (diameter, u) = self.classes[class].diameter(self.last[class], random);
        Grain { class, u, diameter, mass: volume(diameter / 2.0) * density, material }
    }

    /// Counts a grain.
    pub(in crate::plan) fn make(&mut self, grain: &Grain) {
        self.last[grain.class] = grain.u;
        self.made[grain.class] += match self.of {
            ShareOf::Mass => grain.mass,
            ShareOf::Number => 1.0,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::grains::random::generator;

    fn classes(list: &[(f64, f64)]) -> Vec<Class> {
        let class = |&(d, share): &(f64, f64)| {
            let range = OneOrRange { low: d, high: d };
            Class { range, spread: Spread::Uniform, share, material: 0, density: 1000.0 }
        };
        list.iter().map(class).collect()
    }

    #[test]
    fn shares_are_kept_within_a_grain_at_any_time() {
        for of in [ShareOf::Mass, ShareOf::Number] {
            let mut grading = Grading::new(classes(&[(0.016, 50.0), (0.012, 30.0), (0.008, 20.0)]), of);
            let (mean, _) = grading.mean();
            let (mut random, mut mass) = (generator(0, 1, 0), 0.0);
            for n in 1..=5000 {
                let grain = grading.next(&mut random);
                grading.make(&grain);
                mass += grain.mass;
                let total: f64 = grading.made.iter().sum();
                let largest = if of == ShareOf::Mass { 1000.0 * volume(0.008) } else { 1.0 };
                for (made, class) in grading.made.iter().zip(&grading.classes) {
                    assert!((made - class.share * total).abs() < 1.5 * largest, "{n}: {made} of {total}");
                }
            }
            assert!((mass / 5000.0 / mean - 1.0).abs() < 0.01, "{of:?}: {mass} kg, {mean} kg each");
        }
    }

    #[test]
    fn between_two_sieves_mass_or_number_is_even_over_the_logarithm() {
        for (spread, of) in [(Spread::Mass, ShareOf::Mass), (Spread::Number, ShareOf::Number)] {
            let range = OneOrRange { low: 0.004, high: 0.016 };
            let class = Class { range, spread, share: 1.0, material: 0, density: 1000.0 };
            let mut grading = Grading::new(vec![class], of);
            let mut random = generator(0, 1, 0);
            let next = |_| {
                let grain = grading.next(&mut random);
                grading.make(&grain);
                grain
            };
            let grains: Vec<Grain> = (0..100_000).map(next).collect();
            let weight = |g: &Grain| if of == ShareOf::Mass { g.mass } else { 1.0 };
            let all: f64 = grains.iter().map(weight).sum();
            let half: f64 = grains.iter().filter(|g| g.diameter < 0.008).map(weight).sum();
            assert!((half / all - 0.5).abs() < 1e-4, "{spread:?}: {}", half / all);
            let mean = grains.iter().map(|g| g.mass).sum::<f64>() / 1e5;
            assert!((mean / grading.mean().0 - 1.0).abs() < 1e-4, "{spread:?}: {mean}");
        }
    }
}
