//! What of a scene LAMMPS cannot do, by name, with the nearest that it can.

use crate::bonds;
use crate::breaking;
use crate::clumps;
use crate::error::{LammpsError, Refusal, Result};
use crate::law::Target;
use crate::outlet;
use dem::setup::{Precision, Setup, WallShape, WhenBlocked, ZoneMotion};
use scene::keys::SceneKeys;
use scene::{Plan, Scene};

/// A condition, what it makes impossible, why, and the nearest.
type Case = (bool, &'static str, &'static str, &'static str);

fn all_of(cases: impl IntoIterator<Item = Case>) -> Vec<Refusal> {
    let held = cases.into_iter().filter(|case| case.0);
    held.map(|(_, what, why, nearest)| Refusal::new(what, why, nearest)).collect()
}

/// A scene whose laws and particles are left to look at.
#[derive(Debug, Clone)]
pub struct Allowed {
    /// Version, and whether the nearest is taken.
    pub target: Target,
    /// What the nearest is taken for.
    pub(crate) bent: Vec<Refusal>,
}

/// Refuses everything apart from laws and particles, before inlets are read: that may take as long as the stage upstream runs.
///
/// # Errors
/// What LAMMPS cannot do.
pub fn allow(scene: &Scene, plan: &Plan, target: Target) -> Result<Allowed> {
    let mut refused = parts(&scene.keys, &plan.setup, target);
    let mut bent = leavable(&scene.keys, &plan.setup);
    bent.extend(breaking::bendable(&plan.setup));
    if !target.nearest {
        refused.append(&mut bent);
    }
    if refused.is_empty() { Ok(Allowed { target, bent }) } else { Err(LammpsError::Cannot(refused)) }
}

/// Everything in a scene apart from laws and particles that LAMMPS does not have.
fn parts(keys: &SceneKeys, setup: &Setup, target: Target) -> Vec<Refusal> {
    let mut all = scene(keys, setup);
    all.extend(walls(setup));
    all.extend(outlet::refused(setup));
    all.extend(clumps::refused(setup));
    all.extend(bonds::refused(setup, target));
    all
}

/// Parts of a scene apart from laws and walls without which it would be another one; laws and walls say themselves what they cannot.
fn scene(keys: &SceneKeys, setup: &Setup) -> Vec<Refusal> {
    let ends = "a LAMMPS run ends at time.until";
    all_of([
        (
            setup.inlets.iter().any(|zone| zone.motion == ZoneMotion::Recorded),
            "inlet.motion = \"recorded\"",
            "LAMMPS moves no grain along a recorded path",
            "use \"ballistic\", and stage-replay --move ballistic",
        ),
        (
            !keys.domain.strain.is_empty(),
            "domain.strain",
            "a domain that is strained is not written for LAMMPS",
            "use dem-run, or walls with a motion",
        ),
        (keys.drag.is_some(), "drag", "drag is not written for LAMMPS", "leave it out, or use dem-run"),
        (
            keys.local_damping.is_some(),
            "local_damping",
            "local damping is not written for LAMMPS",
            "leave it out, or lower restitution",
        ),
        (keys.time.until_unbalanced.is_some(), "time.until_unbalanced", ends, "leave it out"),
        (keys.time.until_kinetic.is_some(), "time.until_kinetic", ends, "leave it out"),
        (
            !keys.remove.is_empty(),
            "remove",
            "LAMMPS takes no grains out of a shape here",
            "use an [[outlet]] with a plane, or dem-run",
        ),
        (
            keys.insert.iter().any(|insert| insert.when_blocked != WhenBlocked::Wait),
            "insert.when_blocked",
            "LAMMPS does not look whether there is room for a grain",
            "leave it out and keep the shape free, or use dem-run",
        ),
    ])
}

/// Keys that LAMMPS has nothing for, and whose absence leaves the motion of the grains nearly as it is.
fn leavable(keys: &SceneKeys, setup: &Setup) -> Vec<Refusal> {
    let ledger = "LAMMPS keeps no energy ledger";
    all_of([
        (keys.sleep.is_some(), "sleep", "particles of LAMMPS do not sleep", "leave it out"),
        (keys.output.energy, "output.energy", ledger, "leave it out"),
        (keys.output.wear, "output.wear", ledger, "leave it out, or use dem-run"),
        (keys.guards.energy_share().is_some(), "guards.energy", ledger, "leave it out"),
        (
            setup.precision != Precision::Double,
            "precision",
            "LAMMPS computes in double precision",
            "leave it out",
        ),
        (
            !setup.kept.is_empty() && has_springs(setup),
            "particles",
            "the contact history of a run cannot be given to LAMMPS",
            "contacts begin without history (name the material of the particles)",
        ),
    ])
}

/// Whether contacts have springs.
pub fn has_springs(setup: &Setup) -> bool {
    let keys = ["sliding_friction", "rolling_resistance", "twisting_resistance"];
    setup.contacts.iter().any(|law| keys.iter().any(|key| law.number(key).is_some()))
}

/// Walls that LAMMPS does not have.
fn walls(setup: &Setup) -> Vec<Refusal> {
    let mut all = Vec::new();
    for wall in &setup.walls {
        let what = format!("wall '{}'", wall.name);
        let mut refuse = |why: &str, nearest: &str| all.push(Refusal::new(&what, why, nearest));
        if matches!(wall.shape, WallShape::Mesh(_)) {
            refuse(
                "LAMMPS has no walls of triangles",
                "make wall spheres of the drawing (wallgen --from-mesh), or use planes or box",
            );
        }
        if wall.surface.moves() && !matches!(wall.shape, WallShape::Plane(_)) {
            refuse("LAMMPS has no belts of spheres", "use a plane, or dem-run");
        }
        if wall.servo.is_some() {
            refuse("LAMMPS has no walls that follow a force", "give the wall a motion, or use dem-run");
        }
        if wall.mount.is_some() {
            refuse("LAMMPS has no walls on springs", "leave spring out, or use dem-run");
        }
    }
    all
}
