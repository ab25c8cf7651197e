//! Triaxial compression, drained: the sides hold σ₃ while the lid comes down.
//!
//! ```text
//! q = σ₁ − σ₃      sin φ = (σ₁ − σ₃)/(σ₁ + σ₃)      E50 = q/ε₁ and ν = −ε₃/ε₁ at half of the peak
//! sin ψ = −dε_v/(2 dε₁ − dε_v)      Vermeer & de Borst (1984), Heron 29(3): ε_v and ε₁ positive in compression
//! ```
//! Stresses are forces over the areas as they are; strains refer to the specimen under σ₃ on all sides. All walls are smooth, so that the specimen
//! stays a box.

use super::boxes::{around, settling};
use super::*;
use crate::composing::walls::SIDE;
use crate::series::{at, peak, reaches, slope};

pub struct Triaxial;

/// Axial strain at the end [–].
pub(super) const END: f64 = 0.15;
/// Share of the test in which the lid gets up to speed [–].
const RAMP: f64 = 0.05;

/// Walls that move: name, axis, and direction in which each presses.
const MOVING: [(&str, usize, [i8; 3]); 3] =
    [("right", 0, [-1, 0, 0]), ("back", 1, [0, -1, 0]), ("lid", 2, [0, 0, -1])];
/// Walls at rest.
const RESTING: [(&str, [i8; 3]); 3] = [("left", [1, 0, 0]), ("front", [0, 1, 0]), ("floor", [0, 0, 1])];
/// The walls between which the area of each axis lies.
const AREAS: [&str; 3] = [
    "area_between = [[\"front\", \"back\"], [\"floor\", \"lid\"]]",
    "area_between = [[\"left\", \"right\"], [\"floor\", \"lid\"]]",
    "area_between = [[\"left\", \"right\"], [\"front\", \"back\"]]",
];

/// Lengths of the specimen when it is prepared [m].
fn lengths(of: &Context, prepared: &Prepared) -> Vec3 {
    let mut lengths = of.specimen.high - of.specimen.low;
    for (name, axis, _) in MOVING {
        lengths[axis] += prepared.shifts.get(name).map_or(0.0, |shift| shift[axis]);
    }
    lengths
}

/// The same in each row [m].
fn sides(of: &Context, prepared: &Prepared, tables: &Tables) -> Result<[Vec<f64>; 3]> {
    let start = lengths(of, prepared);
    let mut sides = [const { Vec::new() }; 3];
    for (name, axis, _) in MOVING {
        let shifts = tables.column(name, ["shift_x", "shift_y", "shift_z"][axis])?;
        sides[axis] = shifts.iter().map(|shift| start[axis] + shift).collect();
    }
    Ok(sides)
}

/// Speed limit of the sides over that of the lid while the lid presses the loose grains together [–].
const SIDES: f64 = 0.05;

/// The six walls; `lid` is how the lid moves, a servo of its own where empty. `limits` bound the speeds of sides and lid [m/s].
fn walls(of: &Context, high: Vec3, lid: &str, limits: [f64; 2]) -> String {
    let still = RESTING.iter().map(|(name, normal)| wall(name, &plane(of.specimen.low, *normal), SIDE, ""));
    let moving = MOVING.iter().map(|(name, axis, normal)| {
        let stress = format!("stress = {}", number(of.loading.stress));
        let press = servo(*normal, &stress, AREAS[*axis], limits[usize::from(*name == "lid")]);
        wall(name, &plane(high, *normal), SIDE, if *name == "lid" && !lid.is_empty() { lid } else { &press })
    });
    still.chain(moving).collect()
}

impl Recipe for Triaxial {
    fn name(&self) -> &'static str {
        "triaxial"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::Each, &[2.5e4, 5e4, 1e5])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([1.0, 1.0, 2.0], 1.0)
    }

    fn check(&self, _: &Sample, _: &Request) -> Result<()> {
        Ok(())
    }

    fn preparation(&self, of: &Context) -> Result<Option<Part>> {
        let limit = of.request.speed_limit(&of.sample.grains, of.loading.stress, of.specimen.height);
        let until = settling(of, of.loading.stress);
        let text =
            output(until, 20) + damping(of.sample) + &walls(of, of.specimen.high, "", [SIDES * limit, limit]);
        Ok(Some(Part { until, to_rest: true, text, bonds: of.sample.is_packed(), ..Part::default() }))
    }

    fn placed(&self) -> &'static [&'static str] {
        &["right", "back", "lid"]
    }

    fn test(&self, of: &Context, prepared: &Prepared) -> Result<Part> {
        let lengths = lengths(of, prepared);
        let speed = of
            .request
            .speed
            .unwrap_or_else(|| of.request.rate(&of.sample.grains, of.loading.stress) * lengths.z);
        let time = of.request.strain.unwrap_or(END) * lengths.z / speed;
        let ramp = RAMP * time;
        let until = time + 0.5 * ramp;
        let limit = of.request.speed_limit(&of.sample.grains, of.loading.stress, lengths.z).max(2.0 * speed);
        let text = output(until, of.request.rows)
            + &walls(of, of.specimen.low + lengths, &translate(Vec3::z() * -speed, ramp), [limit; 2]);
        Ok(Part { until, text, bonds: true, ..Part::default() })
    }

    fn tables(&self, of: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        let walls = MOVING.map(|(name, ..)| (name, force_on(name)));
        walls.into_iter().chain(cracks(of.sample)).collect()
    }

    fn curve(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Curve> {
        let start = lengths(of, prepared);
        let times = tables.column("lid", "time")?;
        let sides = sides(of, prepared, tables)?;
        let mut forces = Vec::new();
        for (name, axis, _) in MOVING {
            forces.push(tables.column(name, ["fx", "fy", "fz"][axis])?);
        }
        let rows = 0..times.len();
        let strain =
            |axis: usize| rows.clone().map(|i| 1.0 - sides[axis][i] / start[axis]).collect::<Vec<f64>>();
        let area = |axis: usize, i: usize| sides[(axis + 1) % 3][i] * sides[(axis + 2) % 3][i];
        let stress =
            |axis: usize| rows.clone().map(|i| forces[axis][i] / area(axis, i)).collect::<Vec<f64>>();
        let volume = start.x * start.y * start.z;
        let volumetric =
            rows.clone().map(|i| 1.0 - sides[0][i] * sides[1][i] * sides[2][i] / volume).collect();
        let curve = drawn(&times, [0, 1, 2].map(strain), volumetric, [0, 1, 2].map(stress));
        tables.finish(curve, &times)
    }

    fn room(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Option<Room>> {
        Ok(Some(Room::of_box(sides(of, prepared, tables)?)))
    }

    fn measured(&self, of: &Context) -> Option<(String, Option<f64>)> {
        Some(around(of))
    }

    fn sheared(&self, _: &Context, curve: &Curve) -> Option<Vec<f64>> {
        Some(curve.column("axial_strain").to_vec())
    }

    fn peak(&self) -> Option<&'static str> {
        Some("deviator_stress")
    }

    fn values(&self, _: &Context, curve: &Curve) -> Vec<Value> {
        compressed(curve)
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        ("axial_strain", &["deviator_stress", "volumetric_strain"])
    }

    fn envelope(&self) -> Option<Envelope> {
        Some(Envelope::Circles)
    }
}

/// The curve of triaxial compression over time [s], from strains along x, y and z, that of the volume, and stresses [Pa]; z is the axis.
pub(super) fn drawn(
    times: &[f64],
    [x, y, axial]: [Vec<f64>; 3],
    volumetric: Vec<f64>,
    [sx, sy, stress]: [Vec<f64>; 3],
) -> Curve {
    let mean = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect::<Vec<f64>>();
    let lateral = mean(&sx, &sy);
    Curve::default()
        .with("time", "s", times.to_vec())
        .with("axial_strain", "", axial)
        .with("volumetric_strain", "", volumetric)
        .with("lateral_strain", "", mean(&x, &y))
        .with("deviator_stress", "Pa", stress.iter().zip(&lateral).map(|(a, l)| a - l).collect())
        .with("axial_stress", "Pa", stress)
        .with("lateral_stress", "Pa", lateral)
}

/// What a curve of triaxial compression comes to.
pub(super) fn compressed(curve: &Curve) -> Vec<Value> {
    let strain = curve.column("axial_strain");
    let [deviator, axial, lateral, volumetric, sideways] =
        ["deviator_stress", "axial_stress", "lateral_stress", "volumetric_strain", "lateral_strain"]
            .map(|name| smoothed(curve.column(name)));
    let Some(top) = peak(&deviator) else { return Vec::new() };
    let half = deviator.len() / 20;
    let (from, to) = (top.saturating_sub(half), (top + half + 1).min(deviator.len()));
    let dilation = slope(&strain[from..to], &volumetric[from..to]);
    let middle = reaches(&deviator, 0.5 * deviator[top]);
    let of_half = |values: &[f64]| middle.map_or(f64::NAN, |half| at(values, half));
    let angle = |a: f64, l: f64| ((a - l) / (a + l)).asin().to_degrees();
    let value = |name, unit, value| Value { name, unit, value };
    vec![
        value("peak_deviator_stress", "Pa", deviator[top]),
        value("peak_lateral_stress", "Pa", lateral[top]),
        value("peak_axial_strain", "", strain[top]),
        value("peak_angle", "deg", angle(axial[top], lateral[top])),
        value("residual_deviator_stress", "Pa", residual(&deviator)),
        value("residual_lateral_stress", "Pa", residual(&lateral)),
        value("residual_angle", "deg", angle(residual(&axial), residual(&lateral))),
        value("dilation_angle", "deg", (-dilation / (2.0 - dilation)).asin().to_degrees()),
        value("E50", "Pa", 0.5 * deviator[top] / of_half(strain)),
        value("poisson", "", -of_half(&sideways) / of_half(strain)),
    ]
}
