//! `[[insert]]`: particles that come through a cross-section at a rate.
//!
//! The shape is a zone: particles are generated where its velocity enters it, keep that velocity through it and
//! are free behind it. Seen from the moving particles, the places of one after the other are random and none
//! touches another, because the distance along the velocity v of two that come Δt apart is v Δt.

use crate::bodies::orientation;
use crate::check::Check;
use crate::error::SceneError;
use crate::fill::{diameter, generator, unit, volume};
use crate::model::{Diameter, Insert};
use crate::room::{bounds, holds};
use dem::setup::{ClumpShape, Entry, EntryClump, Particle, Zone};
use geom::{Plane, Shape, Shown, Vec3};
use rand_pcg::Pcg64Mcg;
use std::collections::VecDeque;

/// Random places saturate at a solid fraction of 0.38 in space; near it, tries become many.
const DENSEST: f64 = 0.3;
const TRIES: usize = 20_000;

/// A faucet that gives its particles one after the other, in the order of their times.
#[derive(Debug, Clone)]
pub(crate) struct Faucet {
    key: String,
    section: Section,
    velocity: Vec3,
    grains: Poured,
    rate: Rate,
    until: f64,
    time: f64,
    count: u32,
    first_id: u32,
    inlet: u32,
    random: Pcg64Mcg,
    recent: VecDeque<(Vec3, f64)>,
}

/// What comes out: spheres, or clumps as the spheres that hold them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Poured {
    /// Of the spheres [m].
    diameter: Diameter,
    material: u16,
    /// Mass over that of the sphere [kg/m³].
    density: f64,
    /// Shape, and the diameter of the sphere that holds it at scale 1 [m].
    clump: Option<(u32, f64)>,
    /// Ids that each takes.
    ids: u32,
}

impl Poured {
    pub(crate) fn spheres(diameter: Diameter, (material, density): (u16, f64)) -> Poured {
        Poured { diameter, material, density, clump: None, ids: 1 }
    }

    pub(crate) fn clumps(shape: u32, clump: &ClumpShape, scale: Diameter, density: f64) -> Poured {
        let size = 2.0 * clump.reach();
        Poured {
            diameter: Diameter { low: scale.low * size, high: scale.high * size },
            material: clump.material,
            density: clump.mass(1.0, density) / volume(clump.reach()),
            clump: Some((shape, size)),
            ids: clump.spheres.len() as u32,
        }
    }
}

/// The shape as seen along the velocity.
#[derive(Debug, Clone)]
struct Section {
    shape: Shape,
    /// Along the velocity, and twice across it.
    frame: [Vec3; 3],
    /// What the shape covers along each of them [m].
    ranges: [(f64, f64); 3],
}

impl Section {
    /// `None` for a shape without end.
    fn new(shape: Shape, axis: Vec3) -> Option<Section> {
        let (low, high) = bounds(&shape)?;
        let across = axis.cross(&if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() }).normalize();
        let frame = [axis, across, axis.cross(&across)];
        let ranges = frame.map(|n| extent(&n, &low, &high));
        Some(Section { shape, frame, ranges })
    }

    fn middle(&self, n: usize) -> f64 {
        (self.ranges[n].0 + self.ranges[n].1) / 2.0
    }

    fn size(&self, n: usize) -> f64 {
        self.ranges[n].1 - self.ranges[n].0
    }

    /// The zone: its calculation plane is where the shape ends.
    fn zone(&self) -> Zone {
        let end = self.frame[0] * self.ranges[0].1;
        let point = end + self.frame[1] * self.middle(1) + self.frame[2] * self.middle(2);
        Zone::new(Plane { point, normal: self.frame[0] }, self.size(0))
    }

    /// A place across the flow that holds a sphere.
    fn candidate(&self, radius: f64, random: &mut Pcg64Mcg) -> Option<Vec3> {
        let [u, w] = [1, 2].map(|n| self.ranges[n].0 + self.size(n) * unit(random));
        let across = self.frame[1] * u + self.frame[2] * w;
        holds(&self.shape, &(across + self.frame[0] * self.middle(0)), radius).then_some(across)
    }
}

#[derive(Debug, Clone, Copy)]
enum Rate {
    Mass(f64),
    Count(f64),
}

impl Faucet {
    /// A faucet and its zone.
    ///
    /// # Errors
    /// A shape that is too thin, has no end, or is too narrow for the rate.
    pub(crate) fn new(
        check: &Check,
        index: usize,
        entry: &Insert,
        shape: Shape,
        grains: Poured,
        ids: (u32, u32),
    ) -> Result<(Faucet, Zone), SceneError> {
        let key = |k: &str| format!("insert.{index}.{k}");
        let velocity = Vec3::from(entry.velocity);
        let speed = velocity.norm();
        if speed == 0.0 {
            let cure = "give the velocity that particles leave the shape with";
            return Err(check.wrong(&key("velocity"), "0 m/s", "nothing would come out", cure));
        }
        let Some(section) = Section::new(shape, velocity / speed) else {
            let why = "has no end: only box, sphere and cylinder (without '!') can be a faucet";
            return Err(check.wrong(&key("shape"), &entry.shape, why, "use one of these"));
        };
        let (thickness, largest) = (section.size(0), grains.diameter.high);
        if thickness <= largest {
            let why = format!(
                "is {} m thick along the velocity, and the largest diameter is {} m",
                Shown(thickness),
                Shown(largest)
            );
            let cure = format!("make it at least {} m thick", Shown(1.2 * largest));
            return Err(check.wrong(&key("shape"), &entry.shape, &why, &cure));
        }
        let rate = match (entry.rate, entry.rate_count) {
            (Some(mass), _) => Rate::Mass(mass),
            (None, count) => Rate::Count(count.unwrap_or(0.0)),
        };
        let faucet = Faucet {
            key: format!("insert.{index}"),
            section,
            velocity,
            grains,
            rate,
            until: entry.until.unwrap_or(f64::INFINITY),
            time: entry.from,
            count: 0,
            first_id: ids.0,
            inlet: ids.1,
            random: generator(entry.seed, 2, index as u64),
            recent: VecDeque::new(),
        };
        faucet.check_rate(check, index)?;
        let zone = faucet.section.zone();
        Ok((faucet, zone))
    }

    /// Refuses a rate that needs more room than the cross-section has.
    fn check_rate(&self, check: &Check, index: usize) -> Result<(), SceneError> {
        let radius = self.grains.diameter.high / 2.0;
        let mut random = generator(0, 3, index as u64);
        let inside = (0..10_000).filter(|_| self.section.candidate(radius, &mut random).is_some()).count()
            as f64
            / 1e4;
        // The section that spheres fill is wider than that of their centres by their radius.
        let area = inside * self.section.size(1) * self.section.size(2);
        let mean = volume(self.grains.diameter.low / 2.0) + volume(radius);
        let (flow, written) = match self.rate {
            Rate::Mass(rate) => (rate / self.grains.density, format!("{rate} kg/s")),
            Rate::Count(rate) => (rate * mean / 2.0, format!("{rate} 1/s")),
        };
        let fraction = flow / (area * self.velocity.norm());
        if fraction <= DENSEST {
            return Ok(());
        }
        let key = if matches!(self.rate, Rate::Mass(_)) { "rate" } else { "rate_count" };
        let why = if inside == 0.0 {
            "no particle fits into the cross-section of the shape".to_owned()
        } else {
            format!(
                "would fill {:.0} % of the room that passes ({:.3e} m² at {} m/s)",
                100.0 * fraction,
                area,
                Shown(self.velocity.norm())
            )
        };
        let cure = format!(
            "at most {:.0} % can be: a lower rate, a wider shape or a higher velocity",
            100.0 * DENSEST
        );
        Err(check.wrong(&format!("{}.{key}", self.key), written, &why, &cure))
    }

    /// Lowest distance [m] of the centres that become free, from a plane.
    pub(crate) fn lowest_over(&self, plane: &Plane) -> f64 {
        let mut random = generator(0, 4, 0);
        let end = self.section.frame[0] * self.section.ranges[0].1;
        let places =
            (0..2_000).filter_map(|_| self.section.candidate(self.grains.diameter.low / 2.0, &mut random));
        places.map(|across| plane.signed_distance(&(across + end))).fold(f64::INFINITY, f64::min)
    }

    /// Time of the next particle [s]; `None` when the faucet is closed for good.
    pub(crate) fn next_time(&self) -> Option<f64> {
        (self.time < self.until).then_some(self.time)
    }

    /// Its name in messages.
    pub(crate) fn key(&self) -> &str {
        &self.key
    }

    /// Particles that come until a time [s] since t = 0, members of clumps by themselves, and how many of them are there on average over it.
    pub(crate) fn expected(&self, end: f64) -> (f64, f64) {
        let Diameter { low, high } = self.grains.diameter;
        // The mean of d³ of diameters that are uniform between both.
        let mean = volume(0.5) * 0.25 * (low + high) * (low * low + high * high);
        let each = match self.rate {
            Rate::Mass(rate) => rate / (mean * self.grains.density),
            Rate::Count(rate) => rate,
        };
        let open = (self.until.min(end) - self.time).max(0.0);
        let rate = each * f64::from(self.grains.ids);
        // It grows while it is open and stays behind that.
        let after = end - self.time - open;
        (rate * open, if open > 0.0 { rate * open * (0.5 * open + after) / end } else { 0.0 })
    }

    /// The next particle.
    ///
    /// # Errors
    /// No room is found.
    pub(crate) fn next(&mut self) -> Result<Option<Entry>, SceneError> {
        let Some(time) = self.next_time() else { return Ok(None) };
        let mut random = self.random.clone();
        let radius = diameter(self.grains.diameter, &mut random) / 2.0;
        let axis = self.section.frame[0];
        let behind = axis * (-self.velocity.norm() * time);
        let reach = self.velocity.norm() * time;
        // Those further ahead than the largest diameter touch nothing that comes from now on.
        while self.recent.front().is_some_and(|(p, _)| p.dot(&axis) + reach > self.grains.diameter.high) {
            self.recent.pop_front();
        }
        let found = (0..TRIES).find_map(|_| {
            let across = self.section.candidate(radius, &mut random)?;
            let moving = across + behind;
            let free = |(p, r): &(Vec3, f64)| (p - moving).norm_squared() >= (r + radius) * (r + radius);
            self.recent.iter().all(free).then_some(across)
        });
        self.random = random;
        let Some(across) = found else {
            let why =
                format!("no room for a particle of diameter {} m at {} s", Shown(2.0 * radius), Shown(time));
            return Err(SceneError::file(
                &self.key,
                why,
                "use a lower rate, a wider shape or a higher velocity",
            ));
        };
        self.recent.push_back((across + behind, radius));
        let step = match self.rate {
            Rate::Mass(rate) => volume(radius) * self.grains.density / rate,
            Rate::Count(rate) => 1.0 / rate,
        };
        self.time += step;
        let id = self.first_id.wrapping_add(self.count);
        self.count += self.grains.ids;
        let clump = self.grains.clump.map(|(shape, size)| EntryClump {
            shape,
            scale: 2.0 * radius / size,
            orientation: orientation(&mut self.random),
        });
        let position = across + axis * self.section.ranges[0].0;
        let (velocity, spin) = (self.velocity, Vec3::zeros());
        let particle = Particle { id, material: self.grains.material, radius, position, velocity, spin };
        Ok(Some(Entry { time, inlet: self.inlet, particle, clump, turn: None }))
    }
}

/// The range that a box covers along a direction.
fn extent(n: &Vec3, low: &Vec3, high: &Vec3) -> (f64, f64) {
    let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let reach: f64 = (0..3).map(|a| (n[a] * half[a]).abs()).sum();
    (n.dot(&middle) - reach, n.dot(&middle) + reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Text;

    fn faucet(rate: f64) -> Result<Faucet, SceneError> {
        let text = Text::new("s", String::new());
        let shape = "cylinder:0,0,1,0,0,1.03,0.05";
        let entry = Insert {
            material: "m".into(),
            clump: None,
            scale: None,
            shape: shape.into(),
            diameter: Diameter { low: 0.01, high: 0.02 },
            velocity: [0.0, 0.0, -1.0],
            rate: Some(rate),
            rate_count: None,
            from: 0.0,
            until: Some(1.0),
            seed: 0,
        };
        let grains = Poured::spheres(entry.diameter, (0, 1000.0));
        let made = Faucet::new(&Check { text: &text }, 0, &entry, shape.parse().unwrap(), grains, (0, 0));
        made.map(|(faucet, zone)| {
            assert!((zone.length - 0.03).abs() < 1e-12 && (zone.plane.point.z - 1.0).abs() < 1e-12);
            faucet
        })
    }

    #[test]
    fn a_faucet_gives_its_rate_and_nothing_overlaps_on_the_way() {
        let mut faucet = faucet(0.8).unwrap();
        let closed = faucet.clone();
        let mut all: Vec<Entry> = Vec::new();
        while let Some(entry) = faucet.next().unwrap() {
            assert!((entry.particle.position.z - 1.03).abs() < 1e-12);
            all.push(entry);
        }
        let mass: f64 = all.iter().map(|e| 1000.0 * volume(e.particle.radius)).sum();
        assert!((mass - 0.8).abs() < 0.01, "{mass} kg in 1 s");
        let (expected, there) = closed.expected(2.0);
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

    #[test]
    fn a_rate_that_does_not_fit_is_refused() {
        let message = faucet(8.0).unwrap_err().to_string();
        assert!(message.contains("insert.0.rate = 8 kg/s") && message.contains("at most 30 %"), "{message}");
    }
}
