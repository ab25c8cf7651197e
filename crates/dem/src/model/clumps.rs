//! Clumps that are refused before a run starts.

use crate::model::check::{finite, near, within};
use crate::model::error::SetupError;
use crate::setup::{Body, ClumpShape, EntryClump, Particle, Setup, WallShape, Zone, ZoneTest};
use geom::Vec3;
use nalgebra::UnitQuaternion;
use std::collections::HashSet;

/// Checks shapes and bodies.
pub fn check(setup: &Setup) -> Result<(), SetupError> {
    let clumps = &setup.clumps;
    clumps.shapes.iter().try_for_each(shape)?;
    let unfit = |z: &Zone| z.test == ZoneTest::Lowest;
    if let Some((first, ..)) = clumps.scales().next().filter(|_| setup.outlets.iter().any(unfit)) {
        return Err(SetupError::ClumpOutlet(first.name.clone()));
    }
    for &(index, low, high) in &clumps.entries {
        let known = (index as usize) < clumps.shapes.len() && 0.0 < low && low <= high && high.is_finite();
        within("inlet: scale of clumps", low, "[–]", known, "0 < smallest ≤ largest")?;
    }
    if let Some((first, ..)) = clumps.scales().next().filter(|_| setup.sleep.is_some()) {
        return Err(SetupError::ClumpSleep(first.name.clone()));
    }
    let mut ids: HashSet<u32> = if clumps.bodies.is_empty() {
        HashSet::new()
    } else {
        setup.particles.iter().map(|p| p.id).collect()
    };
    for b in &clumps.bodies {
        let shape = body(b, setup)?;
        for k in 0..shape.spheres.len() as u32 {
            if !ids.insert(b.id.wrapping_add(k)) {
                return Err(SetupError::IdTwice(b.id.wrapping_add(k)));
            }
        }
    }
    Ok(())
}

/// Checks the shape of an entry.
pub fn check_entry(clump: &EntryClump, start: &Particle, setup: &Setup) -> Result<(), SetupError> {
    let id = start.id;
    let what = format!("inlet: clump {id}");
    let announced = |e: &&(u32, f64, f64)| e.0 == clump.shape && e.1 <= clump.scale && clump.scale <= e.2;
    let known = (clump.shape as usize) < setup.clumps.shapes.len();
    let known = known && setup.clumps.entries.iter().any(|e| announced(&e));
    within(&what, clump.shape.into(), "[–]", known, "the clumps and scales that the inlet announced")?;
    let length = clump.orientation.norm();
    within(&what, length, "[–]", (length - 1.0).abs() < 1e-9, "quaternions of length 1")?;
    let shape = &setup.clumps.shapes[clump.shape as usize];
    let mut all = members(shape, (&start.position, &clump.orientation, clump.scale));
    all.try_for_each(|(place, radius)| near(&what, &place, radius))
}

fn shape(shape: &ClumpShape) -> Result<(), SetupError> {
    let at = |key: &str| format!("clump '{}': {key}", shape.name);
    let count = shape.spheres.len();
    within(at("spheres"), count as f64, "[–]", (1..=1_000_000).contains(&count), "1 to 1000000 spheres")?;
    for (centre, radius) in &shape.spheres {
        finite(at("sphere"), centre, "m")?;
        within(at("radius"), *radius, "m", *radius > 0.0 && radius.is_finite(), "radius > 0")?;
    }
    let volume = shape.volume;
    within(at("volume"), volume, "m³", volume > 0.0 && volume.is_finite(), "volume > 0")?;
    let [a, b, c] = shape.inertia;
    for moment in [a, b, c] {
        within(at("inertia"), moment, "m⁵", moment > 0.0 && moment.is_finite(), "inertia > 0")?;
    }
    // Of a body, no moment is larger than the two others together.
    let excess = 2.0 * a.max(b).max(c) - (a + b + c);
    within(at("inertia"), excess, "m⁵", excess <= 1e-9 * (a + b + c), "what a body can have")
}

/// Place and radius [m] of the spheres of a body that lies like this: centre of mass [m], orientation, scale.
fn members<'a>(
    shape: &'a ClumpShape,
    (centre, orientation, scale): (&'a Vec3, &'a UnitQuaternion<f64>, f64),
) -> impl Iterator<Item = (Vec3, f64)> + 'a {
    let turn = orientation * shape.frame;
    shape.spheres.iter().map(move |(arm, radius)| (centre + turn * (arm * scale), radius * scale))
}

fn body<'a>(body: &Body, setup: &'a Setup) -> Result<&'a ClumpShape, SetupError> {
    let at = |key: &str| format!("clump {}: {key}", body.id);
    let Some(shape) = setup.clumps.shapes.get(body.shape as usize) else {
        let value = body.shape.into();
        return Err(SetupError::Range {
            what: at("shape"),
            value,
            unit: "[–]",
            range: "the scene's clumps".to_owned(),
        });
    };
    within(at("scale"), body.scale, "[–]", body.scale > 0.0 && body.scale.is_finite(), "scale > 0")?;
    finite(at("position"), &body.position, "m")?;
    finite(at("velocity"), &body.velocity, "m/s")?;
    finite(at("spin"), &body.spin, "rad/s")?;
    let length = body.orientation.norm();
    within(at("orientation"), length, "[–]", (length - 1.0).abs() < 1e-9, "quaternions of length 1")?;
    for (place, radius) in members(shape, (&body.position, &body.orientation, body.scale)) {
        near(at("position"), &place, radius)?;
    }
    for wall in &setup.walls {
        let WallShape::Plane(plane) = &wall.shape else { continue };
        for (place, _) in members(shape, (&body.position, &body.orientation, body.scale)) {
            let depth = -plane.signed_distance(&place);
            if depth >= 0.0 {
                return Err(SetupError::BehindPlane { id: body.id, depth, wall: wall.name.clone() });
            }
        }
    }
    Ok(shape)
}
