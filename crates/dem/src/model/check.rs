//! What is refused before a run starts.

use crate::model::contact_check::{contacts, precision};
use crate::model::error::SetupError;
use crate::model::limit::largest_reach;
use crate::setup::{Drag, DragLaw, Particle, Servo, Setup, Sleep, Step, WallShape};
use geom::Vec3;
use std::collections::HashSet;
use std::fmt::{Display, Formatter};

/// Checks every number of a setup that would make a run meaningless.
pub fn check(setup: &Setup) -> Result<(), SetupError> {
    materials(setup)?;
    indices(setup)?;
    contacts(setup)?;
    precision(setup)?;
    particles(setup)?;
    crate::model::clumps::check(setup)?;
    crate::model::bonds::check::check(setup)?;
    walls(setup)?;
    zones(setup)?;
    periodic(setup)?;
    match setup.step {
        Step::Auto(share) => {
            within("time.safety", share, "[–]", share > 0.0 && share <= 1.0, "0 < safety ≤ 1")
        }
        Step::Fixed(dt) => within("time.dt", dt, "s", dt > 0.0 && dt.is_finite(), "dt > 0"),
    }?;
    within(
        "guards.overlap",
        setup.guards.overlap,
        "[–]",
        setup.guards.overlap > 0.0 && setup.guards.overlap <= 1.0,
        "0 < overlap ≤ 1",
    )?;
    within("guards.motion", setup.guards.motion, "[–]", setup.guards.motion > 0.0, "motion > 0")?;
    let energy = setup.guards.energy;
    let known = energy > 0.0 && (setup.ledger || energy == f64::INFINITY);
    within("guards.energy", energy, "[–]", known, "energy > 0, and the energy ledger is kept")?;
    let skin = setup.skin.unwrap_or(1.0);
    within("neighbours.skin", skin, "m", skin > 0.0 && skin.is_finite(), "skin > 0")?;
    finite("gravity", &setup.gravity, "m/s²")?;
    setup.drag.map_or(Ok(()), |d| drag(&d))?;
    if setup.drag.is_some() && setup.sleep.is_some() {
        return Err(SetupError::DragAndSleep);
    }
    setup.sleep.map_or(Ok(()), |s| sleep(&s, &setup.gravity))
}

fn drag(d: &Drag) -> Result<(), SetupError> {
    let (mu, rho) = (d.viscosity, d.density);
    within("drag.viscosity", mu, "Pa·s", mu > 0.0 && mu.is_finite(), "viscosity > 0")?;
    within("drag.density", rho, "kg/m³", rho >= 0.0 && rho.is_finite(), "density ≥ 0")?;
    let needed = d.buoyancy || d.law == DragLaw::SchillerNaumann;
    within(
        "drag.density",
        rho,
        "kg/m³",
        rho > 0.0 || !needed,
        "density > 0, which this law or buoyancy needs",
    )?;
    finite("drag.velocity", &d.velocity, "m/s")
}

fn sleep(s: &Sleep, gravity: &Vec3) -> Result<(), SetupError> {
    let positive = |what: &str, x: f64, unit, range| within(what, x, unit, x > 0.0 && x.is_finite(), range);
    positive("sleep.speed", s.speed, "m/s", "speed > 0")?;
    positive("sleep.time", s.time, "s", "time > 0")?;
    positive("sleep.wake", s.wake, "[–]", "wake > 0")?;
    let g = gravity.norm();
    within(
        "gravity, with [sleep]",
        g,
        "m/s²",
        g > 0.0,
        "scenes with gravity: a sleeper wakes by a share of its weight",
    )
}

/// Where a number stands: "particle 7: radius". Put into words only when it is refused: a large scene has millions of them.
struct Key<N, K = &'static str>(&'static str, N, K);

impl<N: Display, K: Display> Display for Key<N, K> {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        write!(f, "{} {}: {}", self.0, self.1, self.2)
    }
}

pub(crate) fn within(
    what: impl Display,
    value: f64,
    unit: &'static str,
    ok: bool,
    range: &str,
) -> Result<(), SetupError> {
    if ok {
        Ok(())
    } else {
        Err(SetupError::Range { what: what.to_string(), value, unit, range: range.to_owned() })
    }
}

pub(crate) fn finite(what: impl Display, v: &Vec3, unit: &'static str) -> Result<(), SetupError> {
    let bad = v.iter().find(|x| !x.is_finite());
    bad.map_or(Ok(()), |&x| within(what, x, unit, false, "the finite numbers"))
}

/// Share of its radius to which a position is known, or better.
const DIGITS: f64 = 1e-6;

/// Refuses a sphere so far away that its place has too few digits left: it would hang in the air.
pub(crate) fn near(what: impl Display, place: &Vec3, radius: f64) -> Result<(), SetupError> {
    let far = place.amax();
    if far * f64::EPSILON <= DIGITS * radius {
        return Ok(());
    }
    Err(SetupError::TooFar { what: what.to_string(), far, radius })
}

fn materials(setup: &Setup) -> Result<(), SetupError> {
    for m in &setup.materials {
        let at = |key: &str| format!("material '{}': {key}", m.name);
        within(at("density"), m.density, "kg/m³", m.density > 0.0 && m.density.is_finite(), "density > 0")?;
        within(at("young"), m.young, "Pa", m.young > 0.0 && m.young.is_finite(), "young > 0")?;
        within(at("poisson"), m.poisson, "[–]", m.poisson > -1.0 && m.poisson <= 0.5, "−1 < poisson ≤ 0.5")?;
    }
    Ok(())
}

/// Refuses numbers of materials that there are not: everything else looks them up.
pub(crate) fn indices(setup: &Setup) -> Result<(), SetupError> {
    fn known(setup: &Setup, what: impl Display, material: u16) -> Result<(), SetupError> {
        let known = (material as usize) < setup.materials.len();
        within(what, material.into(), "[–]", known, "the scene's materials")
    }
    for c in &setup.contacts {
        known(setup, "contact: between", c.between.0.max(c.between.1))?;
    }
    for p in &setup.particles {
        known(setup, Key("particle", p.id, "material"), p.material)?;
    }
    for shape in &setup.clumps.shapes {
        known(setup, Key("clump", format_args!("'{}'", shape.name), "material"), shape.material)?;
    }
    for wall in &setup.walls {
        known(setup, Key("wall", format_args!("'{}'", wall.name), "material"), wall.material)?;
    }
    setup.entry_materials.iter().try_for_each(|&m| known(setup, "inlet: material", m))
}

fn particles(setup: &Setup) -> Result<(), SetupError> {
    let mut ids = HashSet::with_capacity(setup.particles.len());
    for p in &setup.particles {
        let at = |key| Key("particle", p.id, key);
        within(at("radius"), p.radius, "m", p.radius > 0.0 && p.radius.is_finite(), "radius > 0")?;
        finite(at("position"), &p.position, "m")?;
        near(at("position"), &p.position, p.radius)?;
        finite(at("velocity"), &p.velocity, "m/s")?;
        finite(at("spin"), &p.spin, "rad/s")?;
        if !ids.insert(p.id) {
            return Err(SetupError::IdTwice(p.id));
        }
    }
    Ok(())
}

fn walls(setup: &Setup) -> Result<(), SetupError> {
    for w in &setup.walls {
        let name = format!("'{}'", w.name);
        let at = |key| Key("wall", &name, key);
        match &w.shape {
            WallShape::Spheres(spheres) => {
                for (centre, radius) in spheres {
                    finite(at("sphere"), centre, "m")?;
                    within(at("radius"), *radius, "m", *radius > 0.0 && radius.is_finite(), "radius > 0")?;
                    near(at("sphere"), centre, *radius)?;
                }
            }
            WallShape::Plane(plane) => {
                finite(at("plane"), &plane.point, "m")?;
                let behind = |p: &&Particle| plane.signed_distance(&p.position) <= 0.0;
                if let Some(p) = setup.particles.iter().find(behind) {
                    let depth = -plane.signed_distance(&p.position);
                    return Err(SetupError::BehindPlane { id: p.id, depth, wall: w.name.clone() });
                }
                // Only one that turns in itself, like a turntable, stays where it is known to be.
                if w.motion.turn.cross(&plane.normal).norm() > 1e-12 * w.motion.turn.norm() {
                    return Err(SetupError::TurningPlane(w.name.clone()));
                }
            }
            WallShape::Mesh(mesh) => mesh.vertices.iter().try_for_each(|v| finite(at("vertex"), v, "m"))?,
        }
        finite(at("velocity"), &w.motion.velocity, "m/s")?;
        finite(at("rotation"), &w.motion.turn, "rad/s")?;
        finite(at("rotation through"), &w.motion.through, "m")?;
        finite(at("vibration"), &w.motion.amplitude, "m")?;
        within(at("motion.from"), w.motion.from, "s", w.motion.from.is_finite(), "the finite numbers")?;
        let (from, until) = (w.motion.from, w.motion.until);
        within(at("motion.until"), until, "s", until > from, "times after motion.from")?;
        w.motion.servo.map_or(Ok(()), |s| servo(&w.name, &s))?;
        within(
            at("frequency"),
            w.motion.frequency,
            "Hz",
            w.motion.frequency.is_finite(),
            "the finite numbers",
        )?;
    }
    Ok(())
}

fn servo(wall: &str, s: &Servo) -> Result<(), SetupError> {
    let at = |key: &str| format!("wall '{wall}': servo.{key}");
    let length = s.direction.norm();
    within(at("direction"), length, "[–]", (length - 1.0).abs() < 1e-9, "directions of length 1")?;
    within(at("force"), s.force, "N", s.force.is_finite(), "the finite numbers")?;
    let v = s.speed_limit;
    within(at("speed_limit"), v, "m/s", v > 0.0 && v.is_finite(), "speed_limit > 0")
}

/// Of spheres, and of the spheres that hold whole clumps [m].
fn largest_radius(setup: &Setup) -> f64 {
    let clumps = setup.clumps.scales().map(|(shape, _, high)| shape.reach() * high);
    setup.particles.iter().map(|p| p.radius).chain(clumps).fold(setup.largest_entry, f64::max)
}

fn zones(setup: &Setup) -> Result<(), SetupError> {
    let diameter = 2.0 * largest_radius(setup);
    let gap = setup.bonds.iter().map(|b| b.gap).fold(0.0, f64::max);
    let own = if setup.bonds.is_empty() || setup.particles.is_empty() { 0.0 } else { diameter + gap };
    let longest = setup.entry_bonds.map_or(own, |b| own.max(b.longest));
    for z in setup.outlets.iter().chain(&setup.inlets) {
        if !(z.length > diameter) {
            return Err(SetupError::ZoneTooShort { length: z.length, diameter });
        }
        if !(z.length > longest) {
            return Err(SetupError::ZoneShorterThanBond { length: z.length, longest });
        }
    }
    Ok(())
}

fn periodic(setup: &Setup) -> Result<(), SetupError> {
    // Both ends of a bond are nearest images of each other.
    let bonded = setup.bonds.iter().map(|b| b.gap).fold(0.0, f64::max);
    let diameter = 2.0 * largest_radius(setup);
    let least = 2.5 * diameter + 2.0 * bonded;
    for (axis, range) in ['x', 'y', 'z'].into_iter().zip(&setup.periodic) {
        let Some((lo, hi)) = *range else { continue };
        for (end, place) in [("low", lo), ("high", hi)] {
            within(Key("domain", end, axis), place, "m", place.is_finite(), "the finite numbers")?;
        }
        let period = hi - lo;
        if !(period >= least) {
            return Err(SetupError::PeriodTooSmall { axis, period, least });
        }
        // Or lists would need images two periods away, and a particle would be listed with its own.
        let skin = setup.skin.map_or(0.0, |skin| skin.max(largest_reach(setup)));
        if !(period >= diameter + skin) {
            return Err(SetupError::PeriodBelowSkin { axis, period, skin, most: period - diameter });
        }
    }
    Ok(())
}
