//! What a simulation begins with: its step, its kinds of contact.

use crate::model::compose::compose;
use crate::model::limit::{contact_between, critical_step, grains, largest, normal, radii_by_material};
use crate::model::matched;
use crate::model::{DenseWalls, Kind, RepeatedMotion, SetupError, With};
use crate::setup::{Setup, Step, WallShape};
use crate::walls::WallBody;
use laws::contact::touch::PatchLaw;
use laws::effects::{ContactLaw, Damping, Elastic, Pair};

/// By how much a step that is read from a message may be rounded [–].
const ROUNDING: f64 = 1e-4;

/// The step [s] that a setup asks for.
///
/// # Errors
/// A step above the critical one, a share of it where nothing can touch, a pair of materials without a contact law.
pub fn time_step(setup: &Setup) -> Result<f64, SetupError> {
    let limit = critical_step(setup)?;
    let most = limit.cause.motion.as_ref().map_or(f64::INFINITY, RepeatedMotion::step);
    match setup.step {
        Step::Auto(_) if limit.dt.is_infinite() => Err(SetupError::NoStep),
        Step::Auto(share) => Ok(most.min(share * limit.dt)),
        Step::Fixed(dt) if dt > most * (1.0 + ROUNDING) => {
            Err(SetupError::StepAbovePeriod { dt, most, cause: Box::new(limit.cause) })
        }
        Step::Fixed(dt) if dt > limit.dt => {
            Err(SetupError::StepTooLarge { dt, critical: limit.dt, cause: Box::new(limit.cause) })
        }
        Step::Fixed(dt) => Ok(dt),
    }
}

/// A wall must not pass a particle within a few steps.
pub fn slow_enough(setup: &Setup, walls: &[WallBody], dt: f64) -> Result<(), SetupError> {
    let smallest = radii_by_material(setup).iter().flatten().map(|r| r.0).fold(f64::INFINITY, f64::min);
    for (body, wall) in walls.iter().zip(&setup.walls) {
        let (speed, limit) = (body.fastest(), setup.guards.motion);
        let share = speed * dt / smallest;
        if share > limit {
            return Err(SetupError::WallTooFast { wall: wall.name.clone(), speed, dt, share, limit });
        }
    }
    Ok(())
}

/// Smallest speed of a wall over the speed of sleep [–]: grains that it carries are to be faster than those at rest.
const AWAKE: f64 = 2.0;

/// A wall that moves must not carry particles so slowly that they count as at rest. A servo pushes, which wakes them.
pub fn faster_than_sleep(setup: &Setup, walls: &[WallBody]) -> Result<(), SetupError> {
    let Some(sleep) = setup.sleep else { return Ok(()) };
    for (body, wall) in walls.iter().zip(&setup.walls) {
        for speed in [body.fastest_driven(), body.belt_speed()] {
            if speed > 0.0 && speed < AWAKE * sleep.speed {
                let (wall, most) = (wall.name.clone(), speed / AWAKE);
                return Err(SetupError::WallSlowerThanSleep { wall, speed, sleep: sleep.speed, most });
            }
        }
    }
    Ok(())
}

/// Mean radius of the particles, or of those that will enter [m].
pub fn mean_radius(setup: &Setup) -> f64 {
    let members = setup.clumps.member_radii();
    let radii = || setup.particles.iter().map(|p| p.radius).chain(members.iter().copied());
    let count = radii().count() as f64;
    let mean = radii().sum::<f64>() / count;
    if count > 0.0 { mean } else { 0.5 * (setup.smallest_entry + setup.largest_entry).max(1e-30) }
}

/// One kind for each pair of materials that particles have, and for each wall and material.
pub fn kinds(setup: &Setup, dt: f64) -> Result<Vec<Kind>, SetupError> {
    let present: Vec<u16> =
        (0u16..).zip(radii_by_material(setup)).filter(|(_, r)| r.is_some()).map(|(m, _)| m).collect();
    let periodic = setup.periodic.iter().any(|p| p.is_some());
    let mut list = Vec::new();
    let grains = grains(setup);
    let crowds = DenseWalls::new(setup, largest(&grains));
    let crowd = |a: u16, with: With| {
        let With::Wall(w) = with else { return 1.0 };
        let own = grains.iter().filter(|g| g.material == a);
        own.map(|g| crowds.on(w, g.radius)).fold(1.0, f64::max)
    };
    let matched: Vec<Damping> =
        setup.contacts.iter().map(|law| matched::damping(law, setup.sampling, dt)).collect();
    let kind = |a: u16, b: u16, with: With| -> Result<Kind, SetupError> {
        let elastic = Elastic::of(&setup.materials[a as usize], &setup.materials[b as usize]);
        let law = contact_between(setup, a, b)?;
        let (known, damping) = (|c: &&ContactLaw| std::ptr::eq(*c, law), Damping::NONE);
        let damping =
            setup.contacts.iter().zip(&matched).find(|(c, _)| known(c)).map_or(damping, |(_, d)| *d);
        let pair = Pair { law, elastic, compliance: setup.compliance(a, b, crowd(a, with)), damping };
        let patch = patch(setup, law, elastic, (a, b), with);
        Ok(Kind { composition: compose(&pair, setup.precision), between: (a, b), with, patch })
    };
    for &a in &present {
        for &b in present.iter().filter(|&&b| a <= b) {
            list.push(kind(a, b, With::Particles)?);
            if periodic {
                list.push(kind(a, b, With::Images)?);
            }
        }
        for (w, wall) in setup.walls.iter().enumerate() {
            list.push(kind(a, wall.material, With::Wall(w))?);
        }
    }
    Ok(list)
}

/// How contacts of a kind act together: those with the spheres of a wall, those of clumps, and those with a wall that a spring lets move.
fn patch(
    setup: &Setup,
    law: &ContactLaw,
    elastic: Elastic,
    (a, b): (u16, u16),
    with: With,
) -> Option<PatchLaw> {
    let normal = normal(law).filter(|_| setup.patches)?;
    let clumps = setup.clumps.shapes.iter().any(|shape| shape.material == a || shape.material == b);
    let wall = if let With::Wall(w) = with { Some(&setup.walls[w]) } else { None };
    let shared = wall.is_some_and(|wall| matches!(wall.shape, WallShape::Spheres(_))) && !normal.yields;
    let gap = (normal.reach)(law, elastic, 1.0);
    let together = shared || clumps || wall.is_some_and(|wall| wall.mount.is_some());
    together.then_some(PatchLaw { shared, hertz: normal.stiffens, gap })
}
