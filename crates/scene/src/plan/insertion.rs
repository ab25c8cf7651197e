//! `[[insert]]`: particles that come through a cross-section at a rate.
//!
//! The shape is a zone: particles are generated where its velocity enters it, keep that velocity through it and
//! are free behind it. Seen from the moving particles, successive positions are random and no two
//! touch, because two particles that come Δt apart are v Δt apart along the velocity v.

use super::builder::PlanBuilder;
use super::random::{diameter, generator, orientation};
use super::section::Section;
use super::total::Total;
use crate::check::Check;
use crate::error::{Result, SceneError};
use crate::keys::{Diameter, Insert};
use dem::setup::{Entry, EntryClump, Particle};
use geom::{Plane, Shape, Shown, Vec3, sphere::volume};
use rand_pcg::Pcg64Mcg;
use std::collections::VecDeque;

/// Random positions saturate at a solid fraction of 0.38 in space; near it, tries become many.
const DENSEST: f64 = 0.3;
const TRIES: usize = 20_000;
const CURE: &str = "use a lower rate, a wider shape or a higher velocity";

/// An insertion that gives its particles one after the other, in the order of their times.
#[derive(Debug, Clone)]
pub struct Insertion {
    /// Its name in messages.
    pub key: String,
    /// What it comes through.
    pub(super) section: Section,
    velocity: Vec3,
    inserted: Inserted,
    rate: Rate,
    until: f64,
    total: Total,
    time: f64,
    count: u32,
    first_id: u32,
    inlet: u32,
    random: Pcg64Mcg,
    recent: VecDeque<(Vec3, f64)>,
}

#[derive(Debug, Clone, Copy)]
enum Rate {
    Mass(f64),
    Count(f64),
}

/// What an insertion inserts: spheres, or clumps as the spheres that hold them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inserted {
    /// Diameters of the spheres [m].
    pub diameter: Diameter,
    /// Index of the material.
    pub material: u16,
    /// Mass over the volume of the sphere [kg/m³].
    pub density: f64,
    /// Of clumps: their shape.
    pub clump: Option<InsertedClump>,
    /// Ids that each takes.
    pub ids: u32,
}

/// The shape of inserted clumps.
#[derive(Debug, Clone, Copy)]
pub(super) struct InsertedClump {
    /// Index of the shape.
    pub shape: u32,
    /// Diameter of the sphere that holds it at scale 1 [m].
    pub size: f64,
}

/// Particles that are expected to come in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Until the end.
    pub all: f64,
    /// Of these, on average over the run, when none leaves.
    pub mean: f64,
}

impl PlanBuilder<'_> {
    /// The insertion of an entry, whose zone is the next of the plan.
    ///
    /// # Errors
    /// A shape that is too thin, has no end, or is too narrow for the rate.
    pub(super) fn insertion(
        &self,
        index: usize,
        entry: &Insert,
        shape: Shape,
        inserted: Inserted,
        first_id: u32,
    ) -> Result<Insertion> {
        let (check, velocity) = (&self.check, Vec3::from(entry.velocity));
        let key = |k: &str| format!("insert.{index}.{k}");
        let speed = velocity.norm();
        if speed == 0.0 {
            let cure = "give the velocity that particles leave the shape with";
            return Err(check.wrong(&key("velocity"), "0 m/s", "nothing would come out", cure));
        }
        let Some(section) = Section::new(shape, velocity / speed) else {
            let why = "has no end: only box, sphere and cylinder (without '!') can insert particles";
            return Err(check.wrong(&key("shape"), &entry.shape, why, "use one of these"));
        };
        let (thickness, largest) = (section.size(0), inserted.diameter.high);
        if thickness <= largest {
            let (thickness, diameter) = (Shown(thickness), Shown(largest));
            let why = format!(
                "is {thickness} m thick along the velocity, and the largest diameter is {diameter} m"
            );
            let cure = format!("make it at least {} m thick", Shown(1.2 * largest));
            return Err(check.wrong(&key("shape"), &entry.shape, &why, &cure));
        }
        let insertion = Insertion {
            key: format!("insert.{index}"),
            section,
            velocity,
            inserted,
            rate: entry.rate.map_or(Rate::Count(entry.rate_count.unwrap_or(0.0)), Rate::Mass),
            until: entry.until.unwrap_or(f64::INFINITY),
            total: Total::new(entry),
            time: entry.from,
            count: 0,
            first_id,
            inlet: self.inlets.len() as u32,
            random: generator(entry.seed, 2, index as u64),
            recent: VecDeque::new(),
        };
        if let (Some(mass), None) = (entry.mass, insertion.next_time()) {
            let (value, cure) = (format!("{mass} kg"), "give more mass, or count");
            return Err(check.wrong(&key("mass"), value, "is less than half a particle", cure));
        }
        insertion.check_rate(check, index)?;
        Ok(insertion)
    }
}

impl Insertion {
    /// The middle of where its grains become free, and how fast they are there.
    pub(super) fn leaves(&self) -> (Vec3, Vec3) {
        (self.section.zone().plane.point, self.velocity)
    }

    /// Refuses a rate that needs more space than the cross-section has.
    fn check_rate(&self, check: &Check, index: usize) -> Result<()> {
        let Diameter { low, high } = self.inserted.diameter;
        let radius = high / 2.0;
        let mut random = generator(0, 3, index as u64);
        let inside = (0..10_000).filter(|_| self.section.candidate(radius, &mut random).is_some()).count()
            as f64
            / 1e4;
        // The section that spheres fill is wider than that of their centres by their radius.
        let area = inside * self.section.size(1) * self.section.size(2);
        let mean = volume(low / 2.0) + volume(radius);
        let (flow, key, written) = match self.rate {
            Rate::Mass(rate) => (rate / self.inserted.density, "rate", format!("{rate} kg/s")),
            Rate::Count(rate) => (rate * mean / 2.0, "rate_count", format!("{rate} 1/s")),
        };
        let speed = self.velocity.norm();
        let fraction = flow / (area * speed);
        if fraction <= DENSEST {
            return Ok(());
        }
        let why = match inside == 0.0 {
            true => "no particle fits into the cross-section of the shape".to_owned(),
            false => format!(
                "would fill {:.0} % of the cross-section ({area:.3e} m² at {} m/s)",
                100.0 * fraction,
                Shown(speed)
            ),
        };
        let most = 100.0 * DENSEST;
        let cure = format!("at most {most:.0} % can be: a lower rate, a wider shape or a higher velocity");
        Err(check.wrong(&format!("{}.{key}", self.key), written, &why, &cure))
    }

    /// Lowest distance [m] of the centres that become free, from a plane.
    pub(super) fn lowest_over(&self, plane: &Plane) -> f64 {
        let mut random = generator(0, 4, 0);
        let end = self.section.frame[0] * self.section.ranges[0].1;
        let radius = self.inserted.diameter.low / 2.0;
        let places = (0..2_000).filter_map(|_| self.section.candidate(radius, &mut random));
        places.map(|across| plane.signed_distance(&(across + end))).fold(f64::INFINITY, f64::min)
    }

    /// Time of the next particle [s]; `None` when the insertion has ended.
    pub fn next_time(&self) -> Option<f64> {
        let next = || self.mass_of(diameter(self.inserted.diameter, &mut self.random.clone()) / 2.0);
        (self.time < self.until && self.total.has_room(next)).then_some(self.time)
    }

    /// Mass of a particle of a radius [kg].
    fn mass_of(&self, radius: f64) -> f64 {
        volume(radius) * self.inserted.density
    }

    /// Particles that come until a time [s] since t = 0; members of clumps count one by one.
    pub fn expected(&self, end: f64) -> Expected {
        let Diameter { low, high } = self.inserted.diameter;
        // The mean of d³ of diameters that are uniform between both.
        let mean = volume(0.5) * 0.25 * (low + high) * (low * low + high * high);
        let mass = mean * self.inserted.density;
        let each = match self.rate {
            Rate::Mass(rate) => rate / mass,
            Rate::Count(rate) => rate,
        };
        let open = (self.until.min(end) - self.time).max(0.0).min(self.total.expected(mass) / each);
        let rate = each * f64::from(self.inserted.ids);
        // The number grows while the insertion is open and stays afterwards.
        let after = end - self.time - open;
        let mean = if open > 0.0 { rate * open * (0.5 * open + after) / end } else { 0.0 };
        Expected { all: rate * open, mean }
    }

    /// The next particle.
    ///
    /// # Errors
    /// No space is found.
    pub fn next_entry(&mut self) -> Result<Option<Entry>> {
        let Some(time) = self.next_time() else { return Ok(None) };
        let mut random = self.random.clone();
        let radius = diameter(self.inserted.diameter, &mut random) / 2.0;
        let found = self.place(radius, time, &mut random);
        self.random = random;
        let Some(across) = found else {
            let (size, time) = (Shown(2.0 * radius), Shown(time));
            let why = format!("no room for a particle of diameter {size} m at {time} s");
            return Err(SceneError::file(&self.key, why, CURE));
        };
        let mass = self.mass_of(radius);
        self.total.add(mass);
        self.time += match self.rate {
            Rate::Mass(rate) => mass / rate,
            Rate::Count(rate) => 1.0 / rate,
        };
        let id = self.first_id.wrapping_add(self.count);
        self.count += self.inserted.ids;
        let clump = self.inserted.clump.map(|c| EntryClump {
            shape: c.shape,
            scale: 2.0 * radius / c.size,
            orientation: orientation(&mut self.random),
        });
        let position = across + self.section.frame[0] * self.section.ranges[0].0;
        let (velocity, spin) = (self.velocity, Vec3::zeros());
        let particle = Particle { id, material: self.inserted.material, radius, position, velocity, spin };
        Ok(Some(Entry { time, inlet: self.inlet, particle, clump, turn: None }))
    }

    /// A position across the flow where a sphere touches none of those before it.
    fn place(&mut self, radius: f64, time: f64, random: &mut Pcg64Mcg) -> Option<Vec3> {
        let axis = self.section.frame[0];
        let behind = axis * (-self.velocity.norm() * time);
        let reach = self.velocity.norm() * time;
        // Those further ahead than the largest diameter touch nothing that comes from now on.
        let high = self.inserted.diameter.high;
        while self.recent.front().is_some_and(|(p, _)| p.dot(&axis) + reach > high) {
            self.recent.pop_front();
        }
        let across = (0..TRIES).find_map(|_| {
            let across = self.section.candidate(radius, random)?;
            let moving = across + behind;
            let free = |(p, r): &(Vec3, f64)| (p - moving).norm_squared() >= (r + radius) * (r + radius);
            self.recent.iter().all(free).then_some(across)
        })?;
        self.recent.push_back((across + behind, radius));
        Some(across)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;
    use std::path::Path;

    fn insertion(rate: f64) -> Result<Insertion> {
        inserted(rate, "until = 1")
    }

    fn inserted(rate: f64, end: &str) -> Result<Insertion> {
        let toml = format!(
            "[[material]]\nname = \"m\"\ndensity = 1000\nyoung = 1e6\npoisson = 0.3\n\
             [[insert]]\nmaterial = \"m\"\nshape = \"cylinder:0,0,1,0,0,1.03,0.05\"\ndiameter = [0.01, 0.02]\n\
             velocity = [0, 0, -1]\nrate = {rate}\n{end}"
        );
        let scene = Scene::new("s", toml, &[], Path::new(""))?;
        let mut builder = PlanBuilder::new(&scene);
        builder.insertions()?;
        let insertion = builder.insertions.remove(0);
        let zone = insertion.section.zone();
        assert!((zone.length - 0.03).abs() < 1e-12 && (zone.plane.point.z - 1.0).abs() < 1e-12);
        Ok(insertion)
    }

    #[test]
    fn an_insertion_keeps_its_rate_and_nothing_overlaps_on_the_way() {
        let mut insertion = insertion(0.8).unwrap();
        let start = insertion.clone();
        let mut all: Vec<Entry> = Vec::new();
        while let Some(entry) = insertion.next_entry().unwrap() {
            assert!((entry.particle.position.z - 1.03).abs() < 1e-12);
            all.push(entry);
        }
        let mass: f64 = all.iter().map(|e| 1000.0 * volume(e.particle.radius)).sum();
        assert!((mass - 0.8).abs() < 0.01, "{mass} kg in 1 s");
        let Expected { all: expected, mean: there } = start.expected(2.0);
        assert!((all.len() as f64 / expected - 1.0).abs() < 0.1, "{} of {expected}", all.len());
        // Open in the first half of the time: half of them in it, all of them behind it.
        assert!((there / expected - 0.75).abs() < 1e-12, "{there} of {expected} on average");
        for (i, a) in all.iter().enumerate() {
            for b in &all[..i] {
                assert!(a.time >= b.time);
                let apart =
                    a.particle.position - b.particle.position - b.particle.velocity * (a.time - b.time);
                assert!(apart.norm() >= a.particle.radius + b.particle.radius - 1e-12);
            }
        }
    }

    fn all(mut insertion: Insertion) -> Vec<f64> {
        std::iter::from_fn(|| insertion.next_entry().unwrap())
            .map(|e| 1000.0 * volume(e.particle.radius))
            .collect()
    }

    #[test]
    fn an_insertion_ends_after_its_number_or_its_mass() {
        assert_eq!(all(inserted(0.8, "count = 37").unwrap()).len(), 37);
        let found = all(inserted(0.8, "mass = 0.2").unwrap());
        let (mass, last) = (found.iter().sum::<f64>(), found[found.len() - 1]);
        assert!((mass - 0.2).abs() <= 1000.0 * volume(0.01) / 2.0, "{mass} kg, the last {last} kg");
        // Whichever end comes first.
        assert!(all(inserted(0.8, "count = 1000000\nuntil = 0.05").unwrap()).len() < 50);
        let expected = inserted(0.8, "mass = 0.2").unwrap().expected(10.0).all;
        assert!((expected / found.len() as f64 - 1.0).abs() < 0.15, "{expected} of {}", found.len());
        for (end, part) in
            [("count = 0", "no particle"), ("mass = -1", "above 0"), ("mass = 1\ncount = 1", "only one")]
        {
            let message = inserted(0.8, end).unwrap_err().to_string();
            assert!(message.contains(part), "{end}: {message}");
        }
    }

    #[test]
    fn a_rate_that_does_not_fit_is_refused() {
        let message = insertion(8.0).unwrap_err().to_string();
        assert!(message.contains("insert.0.rate = 8 kg/s") && message.contains("at most 30 %"), "{message}");
    }
}
