//! Angle of repose: grains are poured onto a raised round plate until they run over its edge.
//!
//! ```text
//!           ::          stream
//!           /\\
//!       ___/  \\___      heap on a plate with a rim of half a grain, which holds the first layer
//! ```
//! The plate limits the heap, so it does not run out flat: its flank is that of a heap that grains run down. What falls off lies on a floor below. The
//! heap is measured in eight sectors (docs/how-to/measure.md, heap angle) when the grains have come to rest.

use super::sectors::{of_sectors, sectors};
use super::*;
use crate::composing::walls::PLATE;
use std::f64::consts::PI;

pub struct Heap;

/// Height of the outlet over the radius of the plate [–]: above a heap of 31°.
const OUTLET: f64 = 0.6;
/// Radius of the stream over that of the plate [–], and at least so many of the largest diameters.
const STREAM: (f64, f64) = (1.0 / 6.0, 2.0);
/// Share of the stream's volume that is solid [–].
const SOLID: f64 = 0.15;
/// Depth of the floor below the plate, in largest diameters.
const FLOOR: f64 = 4.0;
/// Time for the heap to come to rest, over √(R/g) [–].
const REST: f64 = 15.0;

/// The plate and its rim as triangles.
fn plate(of: &Context) -> String {
    let (low, r) = (of.specimen.low, of.specimen.radius());
    let (centre, rim) = ([low.x + r, low.y + r, low.z], low.z + 0.5 * of.sample.grains.diameter);
    around(of.specimen, |[a, b]| {
        triangle([centre, a(low.z), b(low.z)]) + &rectangle(a(low.z), b(low.z), b(rim), a(rim))
    })
}

impl Recipe for Heap {
    fn name(&self) -> &'static str {
        "heap"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::None, &[])
    }

    /// Half as much again as a cone of 30° holds.
    fn proportions(&self) -> ([f64; 3], f64) {
        ([1.0, 1.0, 0.3], 0.378)
    }

    fn check(&self, sample: &Sample, request: &Request) -> Result<()> {
        unused(request.strain.is_some(), "--strain", self.name(), "the heap ends the test")?;
        unused(request.rest.is_some(), "--rest", self.name(), "nothing is prepared")?;
        unused(request.friction.is_some(), "--friction", self.name(), "nothing is prepared")?;
        one_length(self.name(), request)?;
        if let Some(key) = ["cluster", "velocity"].into_iter().find(|key| sample.fill_has(key)) {
            let cure = "take it out: --speed is that of the stream";
            return Err(sample.refusal(format!("has fill.0.{key}"), cure));
        }
        falls(self.name(), sample, request)
    }

    fn preparation(&self, _: &Context) -> Result<Option<Part>> {
        Ok(None)
    }

    fn test(&self, of: &Context, _: &Prepared) -> Result<Part> {
        let (low, r, grains) = (of.specimen.low, of.specimen.radius(), &of.sample.grains);
        let stream = (STREAM.0 * r).max(STREAM.1 * grains.largest);
        let speed = of.request.speed.unwrap_or((4.0 * grains.gravity * grains.largest).sqrt());
        let rate = SOLID * grains.density * PI * stream * stream * speed;
        let outlet = low.z + OUTLET * r + 3.0 * grains.largest;
        let [x, y] = [low.x + r, low.y + r].map(number);
        let [from, to] = [outlet, outlet + 2.0 * grains.largest].map(number);
        let shape = format!("cylinder:{x},{y},{from},{x},{y},{to},{}", number(stream));
        let until = of.specimen.mass(grains) / rate + REST * (r / grains.gravity).sqrt();
        let floor = low - Vec3::z() * FLOOR * grains.largest;
        let text = output(until, of.request.rows)
            + &wall("floor", &plane(floor, [0, 0, 1]), PLATE, "")
            + &wall("disc", "mesh = \"disc.txt\"", PLATE, "");
        let files = vec![("disc.txt".into(), plate(of))];
        Ok(Part { until, text, files, pour: Some(Pour { shape, speed, rate }), ..Part::default() })
    }

    fn tables(&self, of: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        let (low, r) = (of.specimen.low, of.specimen.radius());
        let [x, y, z] = [low.x + r, low.y + r, low.z].map(number);
        let [top, radius] = [low.z + 2.0 * r, r].map(number);
        let heap = format!("cylinder:{x},{y},{z},{x},{y},{top},{radius}");
        vec![(
            "repose",
            ["--repose", "--last", "--ground", &z, "--within", &heap].map(str::to_owned).to_vec(),
        )]
    }

    fn curve(&self, _: &Context, _: &Prepared, tables: &Tables) -> Result<Curve> {
        sectors(tables)
    }

    fn values(&self, _: &Context, curve: &Curve) -> Vec<Value> {
        of_sectors(curve)
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        ("sector", &["angle"])
    }
}
