//! What is refused before a run starts.

use crate::model::contact_check::{contacts, precision};
use crate::model::in_range::indices;
use crate::model::limit::largest_reach;
use crate::model::quantity::material_names;
use crate::model::{Allowed, Check, SetupError, Subject};
use crate::setup::{Bond, BondKind, BondSprings, BondStrength, Spread};
use crate::setup::{Drag, DragLaw, Particle, Setup, Sleep, Step, Strain, WallShape};
use geom::{Motion, Vec3};
use std::collections::HashSet;

/// Checks every number of a setup that would make a run meaningless.
pub fn check(setup: &Setup) -> Result<(), SetupError> {
    materials(setup)?;
    indices(setup)?;
    contacts(setup)?;
    precision(setup)?;
    particles(setup)?;
    crate::model::clumps::check(setup)?;
    bonds(setup)?;
    walls(setup)?;
    zones(setup)?;
    periodic(setup)?;
    strain(setup)?;
    step(&setup.step)?;
    guards(setup)?;
    let skin = setup.skin.unwrap_or(1.0);
    Check(|| Subject::NeighbourLists).positive("skin", skin, "m")?;
    Check(|| Subject::Setup).vector("gravity", &setup.gravity, "m/s²")?;
    setup.drag.map_or(Ok(()), |d| drag(&d))?;
    if setup.drag.is_some() && setup.sleep.is_some() {
        return Err(SetupError::DragAndSleep);
    }
    local_damping(setup)?;
    setup.sleep.map_or(Ok(()), |s| sleep(&s, &setup.gravity))
}

/// Refuses setups in which local damping is not followed.
fn local_damping(setup: &Setup) -> Result<(), SetupError> {
    let Some(factor) = setup.local_damping else { return Ok(()) };
    let within = factor > 0.0 && factor < 1.0;
    Check(|| Subject::Setup).within("local_damping.factor", factor, "[–]", within, "0 < factor < 1")?;
    match setup.sleep {
        Some(_) => Err(SetupError::LocalDampingWith("particles that sleep")),
        None => Ok(()),
    }
}

fn step(step: &Step) -> Result<(), SetupError> {
    let check = Check(|| Subject::TimeStep);
    match *step {
        Step::Auto(share) => {
            check.within("safety", share, "[–]", share > 0.0 && share <= 1.0, "0 < safety ≤ 1")
        }
        Step::Fixed(dt) => check.positive("dt", dt, "s"),
    }
}

fn guards(setup: &Setup) -> Result<(), SetupError> {
    let check = Check(|| Subject::Guards);
    let (overlap, motion, energy) = (setup.guards.overlap, setup.guards.motion, setup.guards.energy);
    check.within("overlap", overlap, "[–]", overlap > 0.0 && overlap <= 1.0, "0 < overlap ≤ 1")?;
    check.within("motion", motion, "[–]", motion > 0.0, "motion > 0")?;
    let known = energy > 0.0 && (setup.ledger || energy == f64::INFINITY);
    check.within("energy", energy, "[–]", known, "energy > 0, and the energy ledger is kept")
}

fn drag(d: &Drag) -> Result<(), SetupError> {
    let (check, rho) = (Check(|| Subject::Drag), d.density);
    check.positive("viscosity", d.viscosity, "Pa·s")?;
    check.within("density", rho, "kg/m³", rho >= 0.0 && rho.is_finite(), "density ≥ 0")?;
    let needed = d.buoyancy || d.law == DragLaw::SchillerNaumann;
    let dense = rho > 0.0 || !needed;
    check.within("density", rho, "kg/m³", dense, "density > 0, which this law or buoyancy needs")?;
    check.vector("velocity", &d.velocity, "m/s")
}

fn sleep(s: &Sleep, gravity: &Vec3) -> Result<(), SetupError> {
    let check = Check(|| Subject::Sleep);
    check.positive("speed", s.speed, "m/s")?;
    check.positive("time", s.time, "s")?;
    check.positive("wake", s.wake, "[–]")?;
    let g = gravity.norm();
    check.within("gravity", g, "m/s²", g > 0.0, Allowed::SomeWeight)
}

fn materials(setup: &Setup) -> Result<(), SetupError> {
    for m in &setup.materials {
        let check = Check(|| Subject::Material(m.name.clone()));
        check.positive("density", m.density, "kg/m³")?;
        check.positive("young", m.young, "Pa")?;
        check.within(
            "poisson",
            m.poisson,
            "[–]",
            m.poisson > -1.0 && m.poisson <= 0.5,
            "−1 < poisson ≤ 0.5",
        )?;
    }
    Ok(())
}

fn particles(setup: &Setup) -> Result<(), SetupError> {
    for p in &setup.particles {
        let check = Check(|| Subject::Particle(p.id));
        check.positive("radius", p.radius, "m")?;
        check.place("position", &p.position, p.radius)?;
        check.vector("velocity", &p.velocity, "m/s")?;
        check.vector("spin", &p.spin, "rad/s")?;
    }
    // Where ids rise, as those of a fill do, none is there twice.
    if setup.particles.is_sorted_by(|a, b| a.id < b.id) {
        return Ok(());
    }
    let mut ids = HashSet::with_capacity(setup.particles.len());
    match setup.particles.iter().find(|p| !ids.insert(p.id)) {
        Some(twice) => Err(SetupError::DuplicateId(twice.id)),
        None => Ok(()),
    }
}

/// Refuses numbers that make no beam, and setups in which bonds are not followed.
fn bonds(setup: &Setup) -> Result<(), SetupError> {
    for bond in &setup.bonds {
        let last = bond.between.0.max(bond.between.1);
        Check(|| Subject::Bond(None)).material("between", last, setup)?;
        let check = Check(|| Subject::Bond(Some(material_names(setup, bond.between))));
        let (gap, damping) = (bond.gap, bond.damping);
        check.within("gap", gap, "m", gap >= 0.0 && gap.is_finite(), "gap ≥ 0")?;
        check.positive("radius_ratio", bond.radius_ratio, "[–]")?;
        bond_springs(bond, &check)?;
        bond_strength(bond, &check)?;
        check.within("damping", damping, "[–]", (0.0..=2.0).contains(&damping), "0 ≤ damping ≤ 2")?;
    }
    if setup.sleep.is_some() && !setup.bonds.is_empty() { Err(SetupError::BondsAndSleep) } else { Ok(()) }
}

fn bond_springs<F: Fn() -> Subject>(bond: &Bond, check: &Check<F>) -> Result<(), SetupError> {
    let (springs, unit) = match bond.kind {
        BondKind::Beam { young, shear_modulus } => {
            check.positive("young", young, "Pa")?;
            return check.positive("shear_modulus", shear_modulus, "Pa");
        }
        BondKind::Parallel { springs, moments } => {
            check.within("moments", moments, "[–]", (0.0..=1.0).contains(&moments), "0 ≤ moments ≤ 1")?;
            (springs, "Pa/m")
        }
        BondKind::Contact(springs) => (springs, "N/m"),
    };
    match springs {
        BondSprings::Given([normal, shear]) => {
            check.positive("normal_stiffness", normal, unit)?;
            check.positive("shear_stiffness", shear, unit)
        }
        BondSprings::Modulus { modulus, ratio } => {
            check.positive("modulus", modulus, "Pa")?;
            check.positive("stiffness_ratio", ratio, "[–]")
        }
    }
}

fn bond_strength<F: Fn() -> Subject>(bond: &Bond, check: &Check<F>) -> Result<(), SetupError> {
    let BondStrength { tension, shear, friction, spread, .. } = bond.strength;
    for (name, x) in [("tensile_strength", tension), ("shear_strength", shear)] {
        check.within(name, x, "Pa", x >= 0.0, "strengths ≥ 0")?;
    }
    let sloped = friction >= 0.0 && friction.is_finite();
    check.within("friction_angle", friction, "tan φ", sloped, "0 ≤ tan φ")?;
    match spread {
        Spread::None => Ok(()),
        Spread::Normal { deviation } => {
            let drawn = (0.0..=1.0).contains(&deviation);
            check.within("deviation", deviation, "[–]", drawn, "0 ≤ deviation ≤ 1")
        }
        Spread::Weibull { modulus, reference_radius } => {
            check.positive("weibull_modulus", modulus, "[–]")?;
            reference_radius.map_or(Ok(()), |r| check.positive("reference_radius", r, "m"))
        }
    }
}

fn walls(setup: &Setup) -> Result<(), SetupError> {
    for w in &setup.walls {
        let check = Check(|| Subject::Wall(w.name.clone()));
        match &w.shape {
            WallShape::Spheres(spheres) => {
                spheres.iter().try_for_each(|sphere| check.sphere(sphere))?;
            }
            WallShape::Plane(plane) => {
                check.vector("plane", &plane.point, "m")?;
                let behind = |p: &&Particle| plane.signed_distance(&p.position) <= 0.0;
                if let Some(p) = setup.particles.iter().find(behind) {
                    let depth = -plane.signed_distance(&p.position);
                    return Err(SetupError::BehindPlane { id: p.id, depth, wall: w.name.clone() });
                }
                // Only one that turns in itself, like a turntable, stays where it is known to be.
                let tilts = |axis: &Vec3| axis.cross(&plane.normal).norm() > 1e-12 * axis.norm();
                if w.motion.axes().iter().any(tilts) {
                    return Err(SetupError::RotatingPlane(w.name.clone()));
                }
                let across = w.surface.velocity.dot(&plane.normal);
                if across.abs() > 1e-9 * w.surface.velocity.norm() || tilts(&w.surface.turn) {
                    return Err(SetupError::BeltLeavesPlane(w.name.clone()));
                }
            }
            WallShape::Mesh(mesh) => mesh.vertices.iter().try_for_each(|v| check.vector("vertex", v, "m"))?,
        }
        w.motion.parts().try_for_each(|part| motion(part, &check))?;
        check.vector("surface_velocity", &w.surface.velocity, "m/s")?;
        check.vector("surface_rotation", &w.surface.turn, "rad/s")?;
        check.vector("surface_rotation through", &w.surface.through, "m")?;
        crate::model::servo::check(setup, w, &check)?;
        crate::model::mount::check(setup, w, &check)?;
    }
    Ok(())
}

/// One part of the motion of a wall.
fn motion<F: Fn() -> Subject>(m: &Motion, check: &Check<F>) -> Result<(), SetupError> {
    check.vector("velocity", &m.velocity, "m/s")?;
    check.vector("rotation", &m.turn, "rad/s")?;
    check.vector("rotation through", &m.through, "m")?;
    check.vector("vibration", &m.amplitude, "m")?;
    check.finite("frequency", m.frequency, "Hz")?;
    check.vector("swing", &m.swing, "rad")?;
    check.finite("swing frequency", m.swing_frequency, "Hz")?;
    check.finite("motion.from", m.from, "s")?;
    let (from, until, ramp) = (m.from, m.until, m.ramp);
    check.within("motion.until", until, "s", until > from, "times after motion.from")?;
    let fits = ramp >= 0.0 && ramp.is_finite() && 2.0 * ramp <= until - from;
    check.within("motion.ramp", ramp, "s", fits, "0 to half of the time from motion.from to motion.until")?;
    let longer = m.period >= until - from && m.period > 0.0;
    check.within("motion.repeat", m.period, "s", longer, "at least the time from motion.from to motion.until")
}

/// Of spheres, and of the spheres that hold whole clumps [m].
fn largest_radius(setup: &Setup) -> f64 {
    let clumps = setup.clumps.scales().map(|(shape, scales)| shape.reach() * scales.most);
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

/// Refuses a strained cell with what does not take part in its flow.
fn strain(setup: &Setup) -> Result<(), SetupError> {
    if setup.strain.iter().all(Option::is_none) {
        return Ok(());
    }
    let has = [
        (!setup.walls.is_empty(), "walls"),
        (!(setup.inlets.is_empty() && setup.outlets.is_empty()), "inlets and outlets"),
        (!setup.removals.is_empty(), "regions that take particles out"),
        (setup.gravity.norm() > 0.0, "gravity"),
        (setup.drag.is_some(), "fluid"),
        (setup.sleep.is_some(), "particles that sleep"),
    ];
    if let Some((_, what)) = has.iter().find(|(has, _)| *has) {
        return Err(SetupError::StrainedWith(what));
    }
    let check = Check(|| Subject::Setup);
    for (a, axis) in ['x', 'y', 'z'].into_iter().enumerate() {
        let Some(strain) = &setup.strain[a] else { continue };
        if setup.periodic[a].is_none() {
            return Err(SetupError::StrainedOpen { axis });
        }
        match strain {
            Strain::Rate(rate) => check.finite("strain.rate", *rate, "1/s")?,
            Strain::Path(path) => path.rows().iter().try_for_each(|r| check.finite("strain", r[1], "[–]"))?,
            Strain::Stress { target, rate_limit } => {
                target.rows().iter().try_for_each(|r| check.finite("strain.stress", r[1], "Pa"))?;
                check.positive("strain.rate_limit", *rate_limit, "1/s")?;
                let open = setup.periodic.iter().position(Option::is_none);
                if let Some(open) = open {
                    return Err(SetupError::StrainedOpen { axis: ['x', 'y', 'z'][open] });
                }
            }
        }
    }
    Ok(())
}

/// Least length of a periodic axis [m].
pub fn least_period(setup: &Setup) -> f64 {
    // Both ends of a bond are nearest images of each other.
    let bonded = setup.bonds.iter().map(|b| b.gap).fold(0.0, f64::max);
    5.0 * largest_radius(setup) + 2.0 * bonded
}

fn periodic(setup: &Setup) -> Result<(), SetupError> {
    let (least, diameter) = (least_period(setup), 2.0 * largest_radius(setup));
    for ((axis, name), range) in [('x', "x"), ('y', "y"), ('z', "z")].into_iter().zip(&setup.periodic) {
        let Some((lo, hi)) = *range else { continue };
        for (end, position) in [("low", lo), ("high", hi)] {
            Check(|| Subject::PeriodicEnd(end)).finite(name, position, "m")?;
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
