//! Clumps that are refused before a run starts.

use crate::model::in_range::out_of_range;
use crate::model::{Allowed, Check, SetupError, Subject};
use crate::setup::{Body, ClumpScales, ClumpShape, EntryClump, Particle, Setup, WallShape, Zone, ZoneTest};
use std::collections::HashSet;

/// Checks shapes and clumps.
pub fn check(setup: &Setup) -> Result<(), SetupError> {
    let clumps = &setup.clumps;
    clumps.shapes.iter().try_for_each(shape)?;
    let unfit = |z: &Zone| z.test == ZoneTest::Lowest;
    if let Some((first, ..)) = clumps.scales().next().filter(|_| setup.outlets.iter().any(unfit)) {
        return Err(SetupError::ClumpOutlet(first.name.clone()));
    }
    for &ClumpScales { shape, least, most } in &clumps.entries {
        let known =
            (shape as usize) < clumps.shapes.len() && 0.0 < least && least <= most && most.is_finite();
        let check = Check(|| Subject::Inlet);
        check.within("scale of clumps", least, "[–]", known, "0 < smallest ≤ largest")?;
    }
    if let Some((first, ..)) = clumps.scales().next().filter(|_| setup.sleep.is_some()) {
        return Err(SetupError::ClumpSleep(first.name.clone()));
    }
    let mut ids: HashSet<u32> = if clumps.placed.is_empty() {
        HashSet::new()
    } else {
        setup.particles.iter().map(|p| p.id).collect()
    };
    for b in &clumps.placed {
        let shape = body(b, setup)?;
        for k in 0..shape.spheres.len() as u32 {
            if !ids.insert(b.id.wrapping_add(k)) {
                return Err(SetupError::DuplicateId(b.id.wrapping_add(k)));
            }
        }
    }
    Ok(())
}

/// Checks the shape of an entry.
pub fn check_entry(clump: &EntryClump, start: &Particle, setup: &Setup) -> Result<(), SetupError> {
    let id = start.id;
    let check = Check(|| Subject::EntryClump(id));
    let announced =
        |e: &ClumpScales| e.shape == clump.shape && e.least <= clump.scale && clump.scale <= e.most;
    let known = (clump.shape as usize) < setup.clumps.shapes.len();
    let known = known && setup.clumps.entries.iter().any(announced);
    check.within(
        "shape",
        clump.shape.into(),
        "[–]",
        known,
        "the clumps and scales that the inlet announced",
    )?;
    let length = clump.orientation.norm();
    check.within("orientation", length, "[–]", (length - 1.0).abs() < 1e-9, "quaternions of length 1")?;
    let shape = &setup.clumps.shapes[clump.shape as usize];
    let mut all = shape.spheres_at(start.position, &clump.orientation, clump.scale);
    all.try_for_each(|(position, radius)| check.near("position", &position, radius))
}

fn shape(shape: &ClumpShape) -> Result<(), SetupError> {
    let check = Check(|| Subject::ClumpShape(shape.name.clone()));
    let count = shape.spheres.len();
    check.within("spheres", count as f64, "[–]", (1..=1_000_000).contains(&count), "1 to 1000000 spheres")?;
    shape.spheres.iter().try_for_each(|sphere| check.sphere(sphere))?;
    check.positive("volume", shape.volume, "m³")?;
    let [a, b, c] = shape.inertia;
    [a, b, c].into_iter().try_for_each(|moment| check.positive("inertia", moment, "m⁵"))?;
    // Of a rigid body, no moment is larger than the two others together.
    let excess = 2.0 * a.max(b).max(c) - (a + b + c);
    check.within("inertia", excess, "m⁵", excess <= 1e-9 * (a + b + c), "what a body can have")
}

fn body<'a>(body: &Body, setup: &'a Setup) -> Result<&'a ClumpShape, SetupError> {
    let check = Check(|| Subject::Clump(body.id));
    let Some(shape) = setup.clumps.shapes.get(body.shape as usize) else {
        let value = body.shape.into();
        let quantity = Subject::Clump(body.id).quantity("shape");
        return Err(out_of_range(quantity, value, "[–]", Allowed::IndexOf("clumps")));
    };
    check.positive("scale", body.scale, "[–]")?;
    check.vector("position", &body.position, "m")?;
    check.vector("velocity", &body.velocity, "m/s")?;
    check.vector("spin", &body.spin, "rad/s")?;
    let length = body.orientation.norm();
    check.within("orientation", length, "[–]", (length - 1.0).abs() < 1e-9, "quaternions of length 1")?;
    for (position, radius) in shape.spheres_at(body.position, &body.orientation, body.scale) {
        check.near("position", &position, radius)?;
    }
    for wall in &setup.walls {
        let WallShape::Plane(plane) = &wall.shape else { continue };
        for (position, _) in shape.spheres_at(body.position, &body.orientation, body.scale) {
            let depth = -plane.signed_distance(&position);
            if depth >= 0.0 {
                return Err(SetupError::BehindPlane { id: body.id, depth, wall: wall.name.clone() });
            }
        }
    }
    Ok(shape)
}
