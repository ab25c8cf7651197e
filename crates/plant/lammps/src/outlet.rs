//! Outlets: crossings of storage planes, found in a second dump of the atoms near them.
//!
//! ```text
//! s = (x − p)·n     crosses between two samples (s + r with test = "lowest") with s₀ < 0 ≤ s₁, at the share −s₀/(s₁ − s₀) of the time between them
//! ```
//!
//! Behind the plane a grain moves freely and acts on all others, up to the exclusion plane; LAMMPS takes it out there.

use crate::arrival::{self, Arrival};
use crate::dump::{Block, Dump, Ended, Parts};
use crate::error::Refusal;
use crate::files::{COLUMNS, ZONE};
use dem::setup::{Crossing, Particle, Setup, Zone, ZoneMotion, ZoneTest};
use geom::Vec3;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Steps between two samples.
const EVERY: u64 = 10;
/// Steps between looks behind the exclusion plane.
const TAKEN_OUT: u64 = 100;

/// Outlets that LAMMPS does not have.
pub fn refused(setup: &Setup) -> Vec<Refusal> {
    let mut all = Vec::new();
    for outlet in &setup.outlets {
        if outlet.motion == ZoneMotion::Recorded {
            all.push(Refusal::new(
                "outlet.motion = \"recorded\"",
                "paths are not sampled on LAMMPS",
                "use \"constant\" or \"ballistic\"",
            ));
        }
    }
    all
}

/// Outlets that would take out grains which wait to come in.
pub fn takes_waiting(setup: &Setup, waiting: &[Particle]) -> Option<Refusal> {
    let past = |zone: &Zone| waiting.iter().any(|p| zone.plane.signed_distance(&p.position) > zone.length);
    let outlet = setup.outlets.iter().position(past)?;
    Some(Refusal::new(
        format!("outlet.{outlet}"),
        "grains that come in wait behind it, upstream of their inlet, and LAMMPS would take them out there",
        "cut the plant so that inlets are before outlets, or use dem-run",
    ))
}

/// Commands: regions, the dump of the atoms near the planes, and what is taken out.
pub fn commands(setup: &Setup) -> String {
    let mut text = String::new();
    let three = |v: Vec3| format!("{:?} {:?} {:?}", v.x, v.y, v.z);
    for (i, Zone { plane, length, .. }) in setup.outlets.iter().enumerate() {
        let (from, to) = (plane.point - plane.normal * *length, plane.point + plane.normal * *length);
        let (n, back) = (three(plane.normal), three(-plane.normal));
        let _ = write!(
            text,
            "\n# outlet {i}: grains near its plane are sampled, those behind its zone taken out\n\
             region before{i} plane {} {n} units box\nregion behind{i} plane {} {back} units box\n\
             region near{i} intersect 2 before{i} behind{i}\nregion past{i} plane {} {n} units box\n\
             fix past{i} grains evaporate {TAKEN_OUT} 1000000 past{i} {}\n",
            three(from),
            three(to),
            three(to),
            i + 1
        );
    }
    let near: Vec<String> = (0..setup.outlets.len()).map(|i| format!("near{i}")).collect();
    let region = match &near[..] {
        [] => return text,
        [one] => one.clone(),
        all => {
            let _ = writeln!(text, "region near union {} {}", all.len(), all.join(" "));
            "near".to_owned()
        }
    };
    let _ = write!(
        text,
        "variable zone index {ZONE}\ndump zone grains custom {EVERY} ${{zone}} {COLUMNS}\n\
         dump_modify zone first ${{first}} flush yes region {region} format float %.17g\n"
    );
    text
}

/// Crossings that were found so far.
#[derive(Debug, Default)]
pub struct Found {
    /// In the order of their times, those that are not written yet.
    pub crossings: Vec<Crossing>,
    /// No more come before this time [s].
    pub until: f64,
    /// What is wrong with the dump.
    pub wrong: Option<String>,
}

/// Looks for crossings in samples.
pub struct Search<'a> {
    /// Those that come in, by id.
    arrivals: &'a [Arrival],
    outlets: Vec<Zone>,
    /// By id.
    particles: Vec<Particle>,
    dt: f64,
    /// Step and numbers of the sample before, by the number of the atom.
    before: BTreeMap<u64, [f64; NUMBERS]>,
    last: Option<u64>,
}

impl<'a> Search<'a> {
    /// Of the outlets of a setup, in steps of `dt` [s]; grains that come in cross when they are free.
    pub fn new(setup: &Setup, arrivals: &'a [Arrival], dt: f64) -> Search<'a> {
        let mut particles = setup.particles.clone();
        particles.sort_by_key(|p| p.id);
        Search {
            arrivals,
            outlets: setup.outlets.clone(),
            particles,
            dt,
            before: BTreeMap::new(),
            last: None,
        }
    }

    /// Reads samples to the end; `tell` gets what each adds.
    pub fn read(mut self, samples: Parts, tell: impl Fn(Found)) {
        let mut frames = Dump::new(samples, COLUMNS);
        let wrong = loop {
            match frames.next_block() {
                Ok(frame) => tell(self.take(&frame)),
                Err(Ended::Over) => return,
                Err(Ended::Torn) => break "it ends inside a frame".to_owned(),
                Err(Ended::Wrong(what)) => break what,
            }
        };
        tell(Found { wrong: Some(wrong), ..Found::default() });
    }

    fn take(&mut self, frame: &Block) -> Found {
        let until = frame.step as f64 * self.dt;
        let from = self.last.replace(frame.step).unwrap_or(frame.step) as f64 * self.dt;
        let mut crossings = Vec::new();
        let rows = || frame.rows().filter_map(numbered);
        for (number, now) in rows() {
            let Some(before) = self.before.get(&number) else { continue };
            if !arrival::is_free(self.arrivals, number, from) {
                continue;
            }
            for (outlet, zone) in (0..).zip(&self.outlets) {
                let found = self.particles.binary_search_by_key(&number, |p| crate::places::number_of(p.id));
                let Ok(particle) = found.map(|index| &self.particles[index]) else { continue };
                let ahead = if zone.test == ZoneTest::Lowest { particle.radius } else { 0.0 };
                let [a, b] = [before, &now].map(|v| {
                    let position = Vec3::new(v[0], v[1], v[2]);
                    zone.plane.normal.dot(&(position - zone.plane.point)) + ahead
                });
                if a < 0.0 && b >= 0.0 {
                    let share = a / (a - b);
                    let time = from + share * (until - from);
                    crossings.push(crossing(time, outlet, between(particle, [before, &now], share)));
                }
            }
        }
        crossings.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.particle.id.cmp(&b.particle.id)));
        self.before = rows().collect();
        Found { crossings, until, wrong: None }
    }
}

/// Numbers of an atom after its own.
const NUMBERS: usize = 9;

/// The number of an atom, and its position, velocity and angular velocity.
fn numbered(row: &[f64]) -> Option<(u64, [f64; NUMBERS])> {
    let (number, values) = row.split_first()?;
    Some((*number as u64, values.try_into().ok()?))
}

/// A particle at a share of the way between two samples.
fn between(particle: &Particle, [a, b]: [&[f64; NUMBERS]; 2], share: f64) -> Particle {
    let at = |k: usize| a[k] + share * (b[k] - a[k]);
    let three = |k: usize| Vec3::new(at(k), at(k + 1), at(k + 2));
    Particle { position: three(0), velocity: three(3), spin: three(6), ..*particle }
}

fn crossing(time: f64, outlet: u32, particle: Particle) -> Crossing {
    Crossing {
        time,
        outlet,
        particle,
        clump: None,
        turn: None,
        cluster: 0,
        touching: Vec::new(),
        bonds: Vec::new(),
    }
}
