//! Angle of repose: a cylinder of grains on a rough plate is lifted, and the grains run out to a heap.
//!
//! The cylinder is a tube without bottom. It is lifted slowly against the speed at which grains fall over its radius, and the heap is measured in eight
//! sectors (docs/how-to/measure.md, heap angle) when the grains have come to rest.

use super::sectors::{of_sectors, sectors};
use super::*;
use crate::composing::walls::{PLATE, SIDE};
use std::f64::consts::PI;

pub struct Repose;

/// Speed of lifting over √(g r) [–].
const LIFT: f64 = 0.1;
/// Time for the heap to come to rest, over √(h/g) [–].
const REST: f64 = 10.0;

/// The tube as triangles.
fn tube(of: &Context) -> String {
    let (low, high) = (of.specimen.low.z, of.specimen.high.z);
    around(of.specimen, |[a, b]| rectangle(a(low), b(low), b(high), a(high)))
}

impl Recipe for Repose {
    fn name(&self) -> &'static str {
        "repose"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::None, &[])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([1.0, 1.0, 1.5], PI / 4.0)
    }

    fn space(&self, of: &Context) -> String {
        cylinder(of.specimen)
    }

    fn rest(&self) -> f64 {
        // The grains will move again.
        1e-2
    }

    fn check(&self, sample: &Sample, request: &Request) -> Result<()> {
        unused(request.strain.is_some(), "--strain", self.name(), "the heap ends the test")?;
        falls(self.name(), sample, request)
    }

    fn preparation(&self, of: &Context) -> Result<Option<Part>> {
        let until = REST * (of.specimen.high.z / of.sample.grains.gravity).sqrt();
        let text = output(until, 20)
            + damping(of.sample)
            + &wall("floor", &plane(of.specimen.low, [0, 0, 1]), PLATE, "")
            + &wall("tube", "mesh = \"tube.txt\"", SIDE, "");
        Ok(Some(Part {
            until,
            to_rest: true,
            text,
            files: vec![("tube.txt".into(), tube(of))],
            ..Part::default()
        }))
    }

    fn test(&self, of: &Context, _: &Prepared) -> Result<Part> {
        let gravity = of.sample.grains.gravity;
        let speed = of.request.speed.unwrap_or(LIFT * (gravity * of.specimen.radius()).sqrt());
        // At the height of the column the tube has left the heap.
        let lifted = of.specimen.height / speed;
        let until = lifted + REST * (of.specimen.height / gravity).sqrt();
        let lift =
            format!("motion = {{ translate = [0, 0, {}], until = {} }}\n", number(speed), number(lifted));
        let text = output(until, of.request.rows)
            + &wall("floor", &plane(of.specimen.low, [0, 0, 1]), PLATE, "")
            + &wall("tube", "mesh = \"tube.txt\"", SIDE, &lift);
        Ok(Part { until, text, files: vec![("tube.txt".into(), tube(of))], bonds: true, ..Part::default() })
    }

    fn tables(&self, _: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        vec![("repose", ["--repose", "--last"].map(str::to_owned).to_vec())]
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
