//! Which grains an entry makes: sizes and materials with their shares.
//!
//! ```text
//! next class = argmax_k  s_k T − T_k        s_k: its share, T: mass (or number) so far, T_k: that of the class
//! n̄ = Σ s_k/m_k                             grains per mass, m_k: mean mass of a grain of the class
//! ```
//!
//! The next grain is of the class that is farthest behind its share, so that at any time each class is within one grain of it. Within a class
//! diameters are uniform, or even over ln d by what the shares are of, as between two sieves:
//!
//! ```text
//! by number   d = a (b/a)^u                        ⟨d³⟩ = (b³ − a³)/(3 ln(b/a))
//! by mass     d = (a⁻³ − u (a⁻³ − b⁻³))^(−⅓)       ⟨d³⟩ = 3 ln(b/a)/(a⁻³ − b⁻³)         u uniform in [0, 1), from a to b
//! ```

use super::random::{diameter, unit};
use crate::keys::{Diameter, ShareOf};
use geom::sphere::volume;
use rand_pcg::Pcg64Mcg;

/// How diameters lie in a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spread {
    /// Uniform, by number.
    Uniform,
    /// Even over ln d, by number.
    Number,
    /// Even over ln d, by mass.
    Mass,
}

/// Grains of one range of sizes and one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Class {
    /// Diameters [m].
    pub range: Diameter,
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
        let Diameter { low, high } = self.range;
        let (wide, cube) = (libm::log(high / low), |d: f64| d * d * d);
        let cubed = match self.spread {
            _ if low == high => cube(low),
            Spread::Uniform => 0.25 * (low + high) * (low * low + high * high),
            Spread::Number => (cube(high) - cube(low)) / (3.0 * wide),
            Spread::Mass => 3.0 * wide / (1.0 / cube(low) - 1.0 / cube(high)),
        };
        volume(0.5) * cubed
    }

    /// A diameter [m].
    fn diameter(&self, random: &mut Pcg64Mcg) -> f64 {
        let Diameter { low, high } = self.range;
        match self.spread {
            Spread::Uniform => diameter(self.range, random),
            Spread::Number => (low * libm::pow(high / low, unit(random))).min(high),
            Spread::Mass => {
                let [a, b] = [low, high].map(|d| 1.0 / (d * d * d));
                (1.0 / libm::cbrt(a - unit(random) * (a - b))).clamp(low, high)
            }
        }
    }
}

/// All classes of an entry, and how much of each was made.
#[derive(Debug, Clone)]
pub(super) struct Grading {
    classes: Vec<Class>,
    of: ShareOf,
    /// Mass [kg] or number of each class so far.
    made: Vec<f64>,
}

/// A grain that is about to be made.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grain {
    /// Number of its class.
    class: usize,
    /// [m].
    pub diameter: f64,
    /// [kg].
    pub mass: f64,
    /// Index of its material.
    pub material: u16,
}

impl Grading {
    /// Of classes whose shares are known up to a factor; at least one.
    pub(super) fn new(mut classes: Vec<Class>, of: ShareOf) -> Grading {
        let sum: f64 = classes.iter().map(|c| c.share).sum();
        classes.iter_mut().for_each(|c| c.share /= sum);
        Grading { made: vec![0.0; classes.len()], classes, of }
    }

    /// One material, diameters uniform in a range.
    pub(super) fn uniform(range: Diameter, material: u16, density: f64) -> Grading {
        Grading::new(
            vec![Class { range, spread: Spread::Uniform, share: 1.0, material, density }],
            ShareOf::Mass,
        )
    }

    /// Smallest and largest diameter [m].
    pub(super) fn range(&self) -> Diameter {
        let low = self.classes.iter().map(|c| c.range.low).fold(f64::INFINITY, f64::min);
        let high = self.classes.iter().map(|c| c.range.high).fold(0.0, f64::max);
        Diameter { low, high }
    }

    /// Materials, each once.
    pub(super) fn materials(&self) -> Vec<u16> {
        let mut all: Vec<u16> = self.classes.iter().map(|c| c.material).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// Mean mass [kg] and volume [m³] of a grain.
    pub(super) fn mean(&self) -> (f64, f64) {
        let number = |c: &Class| match self.of {
            ShareOf::Mass => c.share / c.mean_mass(),
            ShareOf::Number => c.share,
        };
        let sum = |of: &dyn Fn(&Class) -> f64| self.classes.iter().map(|c| number(c) * of(c)).sum::<f64>();
        let all = sum(&|_| 1.0);
        (sum(&Class::mean_mass) / all, sum(&Class::mean_volume) / all)
    }

    /// The next grain; it counts once it is [`Grading::make`]-d.
    pub(super) fn next(&self, random: &mut Pcg64Mcg) -> Grain {
        let total: f64 = self.made.iter().sum();
        let behind = |k: usize| self.classes[k].share * total - self.made[k];
        // Of equals the one with the largest share, and of these the first.
        let order = |a: &usize, b: &usize| {
            let shares = self.classes[*b].share.total_cmp(&self.classes[*a].share);
            behind(*b).total_cmp(&behind(*a)).then(shares).then(a.cmp(b))
        };
        let class = (0..self.classes.len()).min_by(order).unwrap_or(0);
        let Class { material, density, .. } = self.classes[class];
        let diameter = self.classes[class].diameter(random);
        Grain { class, diameter, mass: volume(diameter / 2.0) * density, material }
    }

    /// Counts a grain.
    pub(super) fn make(&mut self, grain: &Grain) {
        self.made[grain.class] += match self.of {
            ShareOf::Mass => grain.mass,
            ShareOf::Number => 1.0,
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::generator;
    use super::*;

    fn classes(list: &[(f64, f64)]) -> Vec<Class> {
        let class = |&(d, share): &(f64, f64)| {
            let range = Diameter { low: d, high: d };
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
            let range = Diameter { low: 0.004, high: 0.016 };
            let class = Class { range, spread, share: 1.0, material: 0, density: 1000.0 };
            let grading = Grading::new(vec![class], of);
            let mut random = generator(0, 1, 0);
            let grains: Vec<Grain> = (0..100_000).map(|_| grading.next(&mut random)).collect();
            let weight = |g: &Grain| if of == ShareOf::Mass { g.mass } else { 1.0 };
            let all: f64 = grains.iter().map(weight).sum();
            let half: f64 = grains.iter().filter(|g| g.diameter < 0.008).map(weight).sum();
            assert!((half / all - 0.5).abs() < 0.01, "{spread:?}: {}", half / all);
            let mean = grains.iter().map(|g| g.mass).sum::<f64>() / 1e5;
            assert!((mean / grading.mean().0 - 1.0).abs() < 0.01, "{spread:?}: {mean}");
        }
    }
}
