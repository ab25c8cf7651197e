//! One entry of `[[insert]]`: through which section its grains come, how many, and which is next.

use crate::check::Check;
use crate::error::Result;
use crate::keys::{Insert, OneOrRange};
use crate::plan::grains::grading::{Grading, Grain};
use crate::plan::grains::random::{INSERT, generator, random_orientation};
use crate::plan::insertions::section::Section;
use crate::plan::insertions::total::Total;
use crate::plan::insertions::windows::Windows;
use dem::setup::{Entry, EntryClump, Particle, WhenBlocked};
use geom::{Plane, Shape, Shown, Vec3};
use rand_pcg::Pcg64Mcg;

/// Random positions saturate at a solid fraction of 0.38 in space; near it, tries become many.
const DENSEST: f64 = 0.3;
/// How much longer than on average a number or a mass of drawn sizes is taken to need.
const MORE: f64 = 1.1;

/// One entry of `[[insert]]`.
#[derive(Debug, Clone)]
pub(in crate::plan) struct Feed {
    /// Its name in messages.
    pub key: String,
    /// What it comes through.
    pub section: Section,
    pub velocity: Vec3,
    pub inserted: Inserted,
    /// What becomes of a particle that has no room.
    pub when_blocked: WhenBlocked,
    rate: Rate,
    windows: Windows,
    /// Of the window that is open, or opens next.
    total: Total,
    time: f64,
    count: u32,
    first_id: u32,
    inlet: u32,
    pub random: Pcg64Mcg,
}

#[derive(Debug, Clone, Copy)]
enum Rate {
    Mass(f64),
    Count(f64),
}

/// What an insertion inserts: spheres, or clumps as the spheres that hold them.
#[derive(Debug, Clone)]
pub(in crate::plan) struct Inserted {
    /// Sizes and materials.
    pub grading: Grading,
    /// Of clumps: their shape.
    pub clump: Option<InsertedClump>,
    /// Ids that each takes.
    pub ids: u32,
}

/// A grain that it brings.
pub(in crate::plan) struct Coming {
    /// Index of its material.
    pub material: u16,
    /// Of the sphere that holds it [m].
    pub radius: f64,
    /// Index of the shape and scale of a clump.
    pub clump: Option<(u32, f64)>,
}

/// The shape of inserted clumps.
#[derive(Debug, Clone, Copy)]
pub(in crate::plan) struct InsertedClump {
    /// Index of the shape.
    pub shape: u32,
    /// Diameter of the sphere that holds it at scale 1 [m].
    pub size: f64,
    /// Scales that were announced [–].
    pub scales: OneOrRange,
}

impl Feed {
    /// The feed of entry number `index`, whose zone is number `inlet` of the plan.
    ///
    /// # Errors
    /// A shape that is too thin, has no end, or is too narrow for the rate.
    pub(in crate::plan) fn new(
        check: &Check,
        inlet: u32,
        index: usize,
        entry: &Insert,
        shape: Shape,
        inserted: Inserted,
        first_id: u32,
    ) -> Result<Feed> {
        let velocity = Vec3::from(entry.velocity);
        let key = |k: &str| format!("insert.{index}.{k}");
        let speed = velocity.norm();
        if speed == 0.0 {
            let cure = "give the velocity that particles leave the shape with";
            return Err(check.wrong(&key("velocity"), "0 m/s", "nothing would come out", cure));
        }
        let Some(section) = Section::new(shape, velocity / speed) else {
            let why = "has no end: only box, sphere, cylinder, cone and a closed mesh (without '!') can insert particles";
            return Err(check.wrong(&key("shape"), &entry.shape, why, "use one of these"));
        };
        let (thickness, largest) = (section.size(0), inserted.grading.range().high);
        if thickness <= largest {
            let (thickness, diameter) = (Shown(thickness), Shown(largest));
            let why = format!(
                "is {thickness} m thick along the velocity, and the largest diameter is {diameter} m"
            );
            let cure = format!("make it at least {} m thick", Shown(1.2 * largest));
            return Err(check.wrong(&key("shape"), &entry.shape, &why, &cure));
        }
        let feed = Feed {
            key: format!("insert.{index}"),
            section,
            velocity,
            inserted,
            when_blocked: entry.when_blocked,
            rate: entry.rate.map_or(Rate::Count(entry.rate_count.unwrap_or(0.0)), Rate::Mass),
            windows: Windows::new(entry),
            total: Total::new(entry),
            time: entry.from,
            count: 0,
            first_id,
            inlet,
            random: generator(entry.seed, INSERT, index as u64),
        };
        if let (Some(mass), None) = (entry.mass, feed.next_time()) {
            let (value, cure) = (format!("{mass} kg"), "give more mass, or count");
            return Err(check.wrong(&key("mass"), value, "is less than half a particle", cure));
        }
        feed.check_rate(check, index)?;
        Ok(feed)
    }

    /// The middle of where its grains become free, and how fast they are there.
    pub(in crate::plan) fn leaves(&self) -> (Vec3, Vec3) {
        (self.section.zone().plane.point, self.velocity)
    }

    /// The smallest and the largest that it brings of each of its classes.
    pub(in crate::plan) fn sizes(&self) -> impl Iterator<Item = Coming> + '_ {
        self.inserted.grading.sizes().map(|(material, radius)| {
            let clump = self.inserted.clump.map(|c| (c.shape, 2.0 * radius / c.size));
            Coming { material, radius, clump }
        })
    }

    /// Whether it comes through a place that another one comes through, at times when both are open or grains of the other are still on their way through it.
    pub(in crate::plan) fn meets(&self, other: &Feed) -> bool {
        let open = self.open().meet(&other.open(), self.way(), other.way());
        let beside = |n: &Vec3| {
            let ((a, b), (c, d)) = (self.section.along(n), other.section.along(n));
            a < d && c < b
        };
        open && self.section.frame.iter().chain(&other.section.frame).all(beside)
    }

    /// The time that a grain takes through the shape [s].
    fn way(&self) -> f64 {
        self.section.size(0) / self.velocity.norm()
    }

    /// How many come in a second while it is open [1/s], and after which time its number or mass has come in [s], both on average.
    fn pace(&self) -> (f64, f64) {
        let (mass, _) = self.inserted.grading.mean();
        let each = match self.rate {
            Rate::Mass(rate) => rate / mass,
            Rate::Count(rate) => rate,
        };
        (each, self.total.expected(mass) / each)
    }

    /// When it is open: until its number or mass has come in.
    fn open(&self) -> Windows {
        // Sizes are drawn: a mass may take a little longer than on average.
        let more = if self.total.is_mass() || matches!(self.rate, Rate::Mass(_)) { MORE } else { 1.0 };
        self.windows.within(more * self.pace().1)
    }

    /// When its last grain has left its shape [s]; ∞ without an end.
    pub(in crate::plan) fn is_empty_from(&self) -> f64 {
        self.open().last() + self.way()
    }

    /// Whether its grains keep their places among those of another one.
    pub(in crate::plan) fn moves_with(&self, other: &Feed) -> bool {
        self.velocity == other.velocity
    }

    /// Refuses a rate that needs more space than the cross-section has.
    fn check_rate(&self, check: &Check, index: usize) -> Result<()> {
        let radius = self.inserted.grading.range().high / 2.0;
        let mut random = generator(0, 3, index as u64);
        let inside = (0..10_000).filter(|_| self.section.candidate(radius, &mut random).is_some()).count()
            as f64
            / 1e4;
        // The section that spheres fill is wider than that of their centres by their radius.
        let area = inside * self.section.size(1) * self.section.size(2);
        let (mass, volume) = self.inserted.grading.mean();
        let (flow, key, written) = match self.rate {
            Rate::Mass(rate) => (rate / mass * volume, "rate", format!("{rate} kg/s")),
            Rate::Count(rate) => (rate * volume, "rate_count", format!("{rate} 1/s")),
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
    pub(in crate::plan) fn lowest_over(&self, plane: &Plane) -> f64 {
        let mut random = generator(0, 4, 0);
        let end = self.section.frame[0] * self.section.ranges[0].1;
        let radius = self.inserted.grading.range().low / 2.0;
        let places = (0..2_000).filter_map(|_| self.section.candidate(radius, &mut random));
        places.map(|across| plane.signed_distance(&(across + end))).fold(f64::INFINITY, f64::min)
    }

    /// Time of the next particle [s]; `None` when it has ended.
    pub fn next_time(&self) -> Option<f64> {
        let next = || self.inserted.grading.next(&mut self.random.clone()).mass;
        (self.time < self.windows.until() && self.total.has_room(next)).then_some(self.time)
    }

    /// Turns to a later window when this one is over. What would come so long after its end comes as long after the start of the next: a rate is one over
    /// the time that the windows are open.
    fn turn_over(&mut self) {
        if self.next_time().is_some() {
            return;
        }
        let length = self.windows.until() - self.windows.from();
        let over = (self.time - self.windows.until()).max(0.0);
        let mut whole = (over / length).floor();
        let mut rest = over - whole * length;
        while self.windows.advance(1.0 + whole) {
            self.time = self.windows.from() + rest;
            self.total.begin();
            if self.time < self.windows.until() {
                return;
            }
            // Rounded up to the end.
            (whole, rest) = (0.0, 0.0);
        }
    }

    /// Key, value and why, where it closes before its mass or number has come in.
    pub(in crate::plan) fn falls_short(&self) -> Option<(&'static str, String, String)> {
        let (mass, _) = self.inserted.grading.mean();
        let open = self.windows.until() - self.windows.from();
        let (rate, written) = match self.rate {
            Rate::Mass(rate) => (rate / mass, format!("{} kg/s", Shown(rate))),
            Rate::Count(rate) => (rate, format!("{} 1/s", Shown(rate))),
        };
        // The last may be half in time, and the first comes at once.
        let (comes, asked) = (rate * open, self.total.expected(mass));
        let told = |key, shown: &dyn Fn(f64) -> String| {
            let (value, part, open) = (shown(asked), shown(comes), Shown(open));
            (
                key,
                value,
                format!("does not come in: at {written} {part} are in when it closes after {open} s"),
            )
        };
        (comes + 1.0 < asked && asked.is_finite()).then(|| match self.total.is_mass() {
            true => told("mass", &|n| format!("{} kg", Shown(n * mass))),
            false => told("count", &|n| format!("{}", n.ceil())),
        })
    }

    /// Particles that come until a time [s] since t = 0; members of clumps count one by one.
    pub fn expected(&self, end: f64) -> Expected {
        let (each, longest) = self.pace();
        let rate = each * f64::from(self.inserted.ids);
        // The number grows while the insertion is open and stays afterwards.
        let open = self.windows.open(end, longest);
        Expected { all: rate * open.time, mean: if open.time > 0.0 { rate * open.moment / end } else { 0.0 } }
    }

    /// A grain at a place across the flow.
    pub fn entry(&mut self, time: f64, across: Vec3, grain: &Grain) -> Entry {
        self.inserted.grading.make(grain);
        self.total.add(grain.mass);
        self.time += match self.rate {
            Rate::Mass(rate) => grain.mass / rate,
            Rate::Count(rate) => 1.0 / rate,
        };
        let id = self.first_id.wrapping_add(self.count);
        self.count += self.inserted.ids;
        self.turn_over();
        let radius = grain.diameter / 2.0;
        let clump = self.inserted.clump.map(|c| EntryClump {
            shape: c.shape,
            // By way of the diameter it may be rounded out of the range.
            scale: (2.0 * radius / c.size).clamp(c.scales.low, c.scales.high),
            orientation: random_orientation(&mut self.random),
        });
        let position = across + self.section.frame[0] * self.section.ranges[0].0;
        let (velocity, spin) = (self.velocity, Vec3::zeros());
        let particle = Particle { id, material: grain.material, radius, position, velocity, spin };
        Entry { time, inlet: self.inlet, particle, clump, turn: None, cluster: 0 }
    }
}

/// Particles that are expected to come in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Until the end.
    pub all: f64,
    /// Of these, on average over the run, when none leaves.
    pub mean: f64,
}
