//! `[[fill]]`: spheres at random places of a shape, none touching another.
//!
//! They are placed one after the other, and the largest go first, while there is space; more than [`MANY`] are placed on a lattice
//! ([`crate::plan::grains::one_per_cell`]). Diameters and positions come from random numbers of this fill alone, so that a fill depends on the ones before
//! it only by the space they left.

use crate::error::Result;
use crate::keys::{Fill, Lattice, OneOrRange};
use crate::plan::Placing;
use crate::plan::builder::PlanBuilder;
use crate::plan::grains::grading::{Grading, Grain};
use crate::plan::grains::lattice;
use crate::plan::grains::one_per_cell;
use crate::plan::grains::packing::{Packing, Radii, bounds};
use crate::plan::grains::random::{FILL, diameter, generator};
use crate::plan::grains::sizes::EntryGrains;
use dem::setup::Particle;
use geom::{Shape, Vec3};
use rand_pcg::Pcg64Mcg;

/// More than this is a mistake, or needs another program.
const MOST: u64 = 50_000_000;

/// More than so many are placed on a lattice.
const MANY: usize = 1_000_000;

impl PlanBuilder<'_> {
    /// `[[fill]]` of spheres.
    ///
    /// # Errors
    /// A shape without end, or without room for all; the message says how many fit.
    pub(in crate::plan) fn fill_with_spheres(
        &mut self,
        index: usize,
        entry: &Fill,
        shape: &Shape,
    ) -> Result<()> {
        let key = |k: &str| format!("fill.{index}.{k}");
        let grading = self.grading(&entry.sized(index))?;
        let Some(corners) = bounds(shape) else {
            let cure = "use one of these, or [[particles]] from a file";
            return Err(self.check.wrong(&key("shape"), &entry.shape, FILLED, cure));
        };
        if let Some(lattice) = entry.lattice {
            let material = self.grain(&key("material"), entry.grains().material.unwrap_or_default())?.index;
            return self.fill_lattice(index, entry, (shape, corners), (lattice, material));
        }
        let largest = grading.range().high / 2.0;
        let mut random = generator(entry.seed, FILL, index as u64);
        let mut grains = self.grains_of(index, entry, grading, &mut random)?;
        let (first_id, taken) = (self.next_id(), self.taken());
        let many = grains.len() > MANY;
        if !many {
            grains.sort_by(|a, b| b.diameter.total_cmp(&a.diameter));
        }
        let hear = |placed| (self.hear)(Placing { fill: index, placed, of: grains.len() });
        let radii = Radii { all: &radii(&grains), hear: &hear };
        let places = if many {
            one_per_cell::places(shape, corners, &radii, &taken, &mut random)
        } else {
            Packing::new(shape, corners, largest, &taken).place_all(&radii, &mut random)
        };
        drop(taken);
        let places = places.map_err(|n| {
            let mass = |grains: &[Grain]| grains.iter().fold(0.0, |sum, g| sum + g.mass);
            let (fits, of, count) = (mass(&grains[..n]), mass(&grains), grains.len());
            let what = self.in_the_way();
            let why =
                format!("only {n} of {count} particles ({fits:.4} of {of:.4} kg) fit without touching{what}");
            self.check.wrong(&key("shape"), &entry.shape, &why, LARGER)
        })?;
        self.place(entry, first_id, grains.iter().map(|g| (g.material, g.diameter)).zip(places));
        Ok(())
    }

    /// Spheres on all sites of a lattice.
    fn fill_lattice(
        &mut self,
        index: usize,
        entry: &Fill,
        (shape, corners): (&Shape, (Vec3, Vec3)),
        (lattice, material): (Lattice, u16),
    ) -> Result<()> {
        let (first_id, taken, diameter) =
            (self.next_id(), self.taken(), entry.diameter.unwrap_or_default().high);
        let places = lattice::places(shape, corners, (lattice, diameter), &taken, MOST);
        drop(taken);
        let key = |k: &str| format!("fill.{index}.{k}");
        let places = places.map_err(|sites| {
            let (why, cure) =
                (format!("makes {sites:.3e} sites, more than fifty million"), "give larger spheres");
            self.check.wrong(&key("diameter"), format!("{diameter} m"), &why, cure)
        })?;
        if places.is_empty() {
            let (why, cure) = ("no sphere fits into it", "make the shape larger, or the spheres smaller");
            return Err(self.check.wrong(&key("shape"), &entry.shape, why, cure));
        }
        self.place(entry, first_id, places.into_iter().map(|place| ((material, diameter), place)));
        Ok(())
    }

    /// Adds spheres of a material and a diameter [m] each.
    fn place(&mut self, entry: &Fill, first_id: u32, spheres: impl Iterator<Item = ((u16, f64), Vec3)>) {
        let (velocity, spin) = (Vec3::from(entry.velocity), Vec3::zeros());
        for (n, ((material, diameter), position)) in (0u32..).zip(spheres) {
            let id = first_id.wrapping_add(n);
            if let Some(cluster) = entry.cluster.filter(|c| *c > 0) {
                self.clusters.push((id, cluster));
            }
            self.particles.push(Particle { id, material, radius: diameter / 2.0, position, velocity, spin });
        }
    }

    /// The grains, in random order.
    fn grains_of(
        &self,
        index: usize,
        entry: &Fill,
        mut grading: Grading,
        random: &mut Pcg64Mcg,
    ) -> Result<Vec<Grain>> {
        let key = |k: &str| format!("fill.{index}.{k}");
        let most = entry.count.unwrap_or_else(|| (entry.mass.unwrap_or(0.0) / grading.mean().0) as u64);
        if most > MOST {
            let (why, cure) = ("makes more than fifty million particles", "ask for fewer or larger ones");
            return Err(self.check.wrong(&key(entry.amount()), format!("{most} particles"), why, cure));
        }
        let (mut grains, mut mass) = (Vec::new(), 0.0);
        loop {
            let grain = grading.next(random);
            if entry.is_enough(grains.len() as u64, mass + grain.mass / 2.0) {
                break;
            }
            grading.make(&grain);
            mass += grain.mass;
            grains.push(grain);
        }
        if let (true, Some(mass)) = (grains.is_empty(), entry.mass) {
            let (value, cure) = (format!("{mass} kg"), "give more mass, or count");
            return Err(self.check.wrong(&key("mass"), value, "is less than half a particle", cure));
        }
        Ok(grains)
    }
}

fn radii(grains: &[Grain]) -> Vec<f64> {
    grains.iter().map(|g| g.diameter / 2.0).collect()
}

impl Fill {
    /// What it says about its grains.
    pub(in crate::plan) fn sized(&self, index: usize) -> EntryGrains<'_> {
        EntryGrains { entry: format!("fill.{index}"), keys: self.grains() }
    }

    /// Whether so many are enough, or so much mass with half of the next.
    fn is_enough(&self, count: u64, mass: f64) -> bool {
        match self.count {
            Some(wanted) => count >= wanted,
            None => mass > self.mass.unwrap_or(0.0),
        }
    }
}

/// Why a shape is refused.
pub(in crate::plan) const FILLED: &str =
    "cannot be filled: only box, sphere, cylinder, cone and a closed mesh (without '!') can";

/// The cure for a shape that is too small.
pub(in crate::plan) const LARGER: &str =
    "make the shape larger (random places fill about a third of it), or pour with [[insert]]";

/// Sizes at random in a range: as many as come nearest to the mass, but not more than one above `most`.
pub(in crate::plan) fn sizes(
    entry: &Fill,
    range: OneOrRange,
    most: u64,
    mass_of: impl Fn(f64) -> f64,
    random: &mut Pcg64Mcg,
) -> Vec<f64> {
    let (mut sizes, mut mass) = (Vec::new(), 0.0);
    while sizes.len() as u64 <= most {
        let size = diameter(range, random);
        let more = mass_of(size);
        if entry.is_enough(sizes.len() as u64, mass + more / 2.0) {
            break;
        }
        mass += more;
        sizes.push(size);
    }
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use geom::sphere::volume;
    use std::path::Path;

    fn filled(shape: &str, mass: f64, seed: u64) -> Result<Vec<Particle>> {
        let toml = format!(
            "first_id = 7\n[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n\
             [[fill]]\nmaterial = \"m\"\nshape = \"{shape}\"\ndiameter = [0.01, 0.02]\nmass = {mass}\nseed = {seed}"
        );
        let scene = Scene::new("s", toml, &[], Path::new(""))?;
        let mut builder = PlanBuilder::new(&scene);
        builder.particles()?;
        Ok(builder.particles)
    }

    #[test]
    fn a_fill_has_its_mass_lies_inside_and_touches_nothing() {
        let shape = "cylinder:0,0,0,0,0,0.2,0.1";
        let found = filled(shape, 1.0, 0).unwrap();
        let mass: f64 = found.iter().map(|p| 1000.0 * volume(p.radius)).sum();
        assert!((mass - 1.0).abs() < 1000.0 * volume(0.01), "{mass} kg");
        for (i, p) in found.iter().enumerate() {
            assert!((0.005..=0.01).contains(&p.radius) && p.position.xy().norm() + p.radius <= 0.1 + 1e-12);
            assert!(found[..i].iter().all(|q| (q.position - p.position).norm() >= q.radius + p.radius));
        }
        assert_eq!((found[0].id, found.len()), (7, found.last().unwrap().id as usize - 6));
        assert_eq!(found, filled(shape, 1.0, 0).unwrap());
        assert_ne!(found, filled(shape, 1.0, 1).unwrap());
    }

    #[test]
    fn very_many_are_placed_on_a_lattice_in_linear_time() {
        let toml = "[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n\
                    [[fill]]\nmaterial = \"m\"\nshape = \"box:0,0,0,1,1,1\"\ndiameter = 0.0092\ncount = 1200000";
        let scene = Scene::new("s", toml.into(), &[], Path::new("")).unwrap();
        let mut builder = PlanBuilder::new(&scene);
        builder.particles().unwrap();
        // A solid fraction of 0.49: random places, one after the other, end at 0.38.
        assert_eq!(builder.particles.len(), 1_200_000);
        assert!(builder.particles.iter().zip(0..).all(|(p, id)| p.id == id));
    }

    #[test]
    fn whoever_waits_for_a_fill_hears_how_many_are_placed() {
        let toml = |count| {
            format!(
                "[time]\nuntil = 1\n[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n\
                 [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n\
                 [[fill]]\nmaterial = \"m\"\nshape = \"box:0,0,0,1,1,1\"\ndiameter = 0.009\ncount = {count}"
            )
        };
        // One after the other, and on a lattice.
        for count in [50_000, 1_100_000] {
            let heard = std::cell::RefCell::new(Vec::new());
            let scene = Scene::new("s", toml(count), &[], Path::new("")).unwrap();
            let plan =
                scene.plan_with(Vec::new(), &|placing| heard.borrow_mut().push((placing.placed, placing.of)));
            assert_eq!(plan.unwrap().setup.particles.len(), count);
            let heard = heard.into_inner();
            assert!(heard.is_sorted() && heard.iter().all(|h| h.1 == count), "{heard:?}");
            assert!(heard.len() > 3 && heard.last().unwrap().0 > count * 9 / 10, "{heard:?}");
        }
    }

    #[test]
    fn a_shape_that_is_too_small_is_refused() {
        let message = filled("box:0,0,0,0.1,0.1,0.1", 5.0, 0).unwrap_err().to_string();
        assert!(message.contains("kg) fit without touching") && message.contains("[[insert]]"), "{message}");
        assert!(filled("halfspace:0,0,0,0,0,1", 5.0, 0).unwrap_err().to_string().contains("only box"));
    }
}
