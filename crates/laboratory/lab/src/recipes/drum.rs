//! Angle of repose: the surface of grains in a drum that turns.
//!
//! A slice of the drum, periodic along its axis y. Its wall has grooves of half a grain, so that the bed turns with it and does not slip as a whole. The
//! surface falls towards x (docs/how-to/measure.md, bed slope).

use super::*;
use crate::composing::walls::PLATE;
use std::f64::consts::PI;

pub struct Drum;

/// Share of the drum that the bed fills, about [–].
const FILLED: f64 = 0.25;
/// Width of the slice over the diameter of the drum [–].
const WIDTH: f64 = 0.4;
/// Froude number ω² R/g, below which grains roll down steadily (Mellmann 2001, DOI 10.1016/S0032-5910(00)00402-2) [–].
const FROUDE: f64 = 0.01;
/// Turns of a test, and the fewest [–].
const TURNS: f64 = 0.3;
const LEAST: f64 = 0.2;
/// Share of the test in which the drum gets up to speed, and after which the bed flows steadily [–].
const RAMP: f64 = 0.02;
const STEADY: f64 = 0.5;
/// Depth of a groove over the mean diameter [–].
const GROOVE: f64 = 0.5;
/// Time for the bed to come to rest, over √(2 R/g) [–].
const REST: f64 = 20.0;

/// Centre of the drum [m], at the front face.
fn centre(of: &Specimen) -> Vec3 {
    of.low + Vec3::new(of.radius(), 0.0, of.radius())
}

/// Speed of the wall [m/s].
fn speed(of: &Context) -> f64 {
    of.request.speed.unwrap_or_else(|| (FROUDE * of.sample.grains.gravity * of.specimen.radius()).sqrt())
}

/// Turns in a second [1/s].
fn frequency(of: &Context) -> f64 {
    speed(of) / (2.0 * PI * of.specimen.radius())
}

/// Duration of the test at full speed, and that of the ramp before [s]; on the ramp the drum turns half as far.
fn durations(of: &Context) -> [f64; 2] {
    let whole = of.request.strain.unwrap_or(TURNS) * 2.0 * PI * of.specimen.radius() / speed(of);
    [whole, RAMP * whole]
}

/// The grooved wall as triangles: every second edge is half a grain farther in.
fn wall_of(of: &Context) -> String {
    let (space, grain) = (of.specimen, of.sample.grains.diameter);
    let (middle, width) = (centre(space), space.sides()[1]);
    let grooves = (2.0 * PI * space.radius() / grain).floor().max(8.0) as usize;
    let edge = |k: usize, y: f64| {
        let r = space.radius() - if k % 2 == 1 { GROOVE * grain } else { 0.0 };
        let turn = PI * k as f64 / grooves as f64;
        [middle.x + r * turn.cos(), middle.y + y, middle.z + r * turn.sin()]
    };
    (0..2 * grooves)
        .map(|k| rectangle(edge(k, 0.0), edge(k + 1, 0.0), edge(k + 1, width), edge(k, width)))
        .collect()
}

/// The drum with its domain.
fn drum(of: &Context, until: f64, rows: u64, motion: &str) -> Part {
    let space = of.specimen;
    let high = space.low + Vec3::new(space.sides()[0], space.sides()[1], space.sides()[0]);
    let corner = |p: Vec3| format!("[{}, {}, {}]", number(p.x), number(p.y), number(p.z));
    let domain =
        format!("[domain]\nperiodic = [\"y\"]\nlow = {}\nhigh = {}\n\n", corner(space.low), corner(high));
    let text = output(until, rows) + &domain + &wall("drum", "mesh = \"drum.txt\"", PLATE, motion);
    Part { until, text, files: vec![("drum.txt".into(), wall_of(of))], ..Part::default() }
}

impl Recipe for Drum {
    fn name(&self) -> &'static str {
        "drum"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::None, &[])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([1.0, WIDTH, 1.0], FILLED * PI / 4.0)
    }

    fn space(&self, of: &Context) -> String {
        let (middle, width) = (centre(of.specimen), of.specimen.sides()[1]);
        let [x, y, z] = [middle.x, middle.y, middle.z].map(number);
        let inside = of.specimen.radius() - 1.1 * GROOVE * of.sample.grains.diameter;
        format!("cylinder:{x},{y},{z},{x},{},{z},{}", number(middle.y + width), number(inside))
    }

    fn rest(&self) -> f64 {
        // The grains will move again.
        1e-2
    }

    fn check(&self, sample: &Sample, request: &Request) -> Result<()> {
        one_length(self.name(), request)?;
        if let Some(turns) = request.strain.filter(|turns| *turns < LEAST) {
            return Err(LabError::Usage(format!(
                "--strain {}: the bed turns with the drum until it flows: give at least {LEAST} turns",
                geom::Shown(turns)
            )));
        }
        falls(self.name(), sample, request)
    }

    fn preparation(&self, of: &Context) -> Result<Option<Part>> {
        let until = REST * (2.0 * of.specimen.radius() / of.sample.grains.gravity).sqrt();
        let part = drum(of, until, 20, "");
        Ok(Some(Part { to_rest: true, text: part.text + damping(of.sample), ..part }))
    }

    fn test(&self, of: &Context, _: &Prepared) -> Result<Part> {
        let [whole, ramp] = durations(of);
        let middle = centre(of.specimen);
        let [x, y, z] = [middle.x, middle.y, middle.z].map(number);
        let motion = format!(
            "motion = {{ rotate = {{ about = [0, 1, 0], through = [{x}, {y}, {z}], rpm = {} }}, ramp = {} }}\n",
            number(60.0 * frequency(of)),
            number(ramp)
        );
        Ok(Part { bonds: true, ..drum(of, whole + 0.5 * ramp, of.request.rows, &motion) })
    }

    fn tables(&self, _: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        vec![("slope", ["--bed-slope", "x+"].map(str::to_owned).to_vec())]
    }

    fn curve(&self, of: &Context, _: &Prepared, tables: &Tables) -> Result<Curve> {
        let times = tables.column("slope", "time")?;
        let late = 0.5 * durations(of)[1];
        let turns = times.iter().map(|t| (t - late).max(0.0) * frequency(of)).collect();
        Ok(Curve::default().with("time", "s", times).with("turn", "", turns).with(
            "angle",
            "deg",
            tables.column("slope", "angle")?,
        ))
    }

    fn values(&self, of: &Context, curve: &Curve) -> Vec<Value> {
        let (times, angles) = (curve.column("time"), smoothed(curve.column("angle")));
        let steady: Vec<f64> = times
            .iter()
            .zip(&angles)
            .filter(|(t, _)| **t >= STEADY * durations(of)[0])
            .map(|(_, a)| *a)
            .collect();
        let value = |name, value| Value { name, unit: "deg", value };
        let largest = angles.iter().copied().fold(f64::NAN, f64::max);
        vec![value("angle", measure::statistics::Mean::of(&steady).mean), value("largest_angle", largest)]
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        ("turn", &["angle"])
    }
}
