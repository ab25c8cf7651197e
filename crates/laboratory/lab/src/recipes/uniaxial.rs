//! Uniaxial compression: a specimen of bonded grains between two plates.
//!
//! ```text
//! σ = F/A     ε = 1 − h/h₀     strength: largest σ     E = Δσ/Δε from a quarter to half of the way to it     ν = −Δε_lateral/Δε_axial of the grains in the middle half there
//! ```
//! Changes count, since a specimen that was pressed together spreads when its vessel is gone, and begins under a stress.
//!
//! A filled specimen is a cylinder: grains without friction are pressed together in a round vessel, and bonded when the vessel is gone. A packed one is
//! taken as it is; A is then the area of its outline from above.

use super::boxes::{around, height, settling};
use super::plates::{on_the_way, uneven};
use super::*;
use crate::composing::walls::{PLATE, SIDE};
use crate::series::{at, peak};
use std::f64::consts::PI;

pub struct Uniaxial;

/// Axial strain at the end [–].
const END: f64 = 0.02;
/// Share of the test in which the plate gets up to speed [–].
const RAMP: f64 = 0.1;

/// Area of the specimen across its axis [m²].
fn area(of: &Context) -> f64 {
    match &of.sample.grains.packed {
        None => PI / 4.0 * of.specimen.sides()[0] * of.specimen.sides()[1],
        Some(packed) => outline(packed.spheres.iter().map(|(centre, radius)| (centre.x, centre.y, *radius))),
    }
}

/// Area of the convex outline of circles (x, y, radius), each as 64 points [m²].
fn outline(circles: impl Iterator<Item = (f64, f64, f64)>) -> f64 {
    const POINTS: usize = 64;
    let around = |(x, y, r): (f64, f64, f64)| {
        (0..POINTS).map(move |k| {
            let turn = 2.0 * PI * k as f64 / POINTS as f64;
            [x + r * turn.cos(), y + r * turn.sin()]
        })
    };
    let mut points: Vec<[f64; 2]> = circles.flat_map(around).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut hull: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = hull[..] {
                if (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    let next = hull.iter().cycle().skip(1);
    0.5 * hull.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>()
}

impl Recipe for Uniaxial {
    fn name(&self) -> &'static str {
        "uniaxial"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::Preparation, &[2e4])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([1.0, 1.0, 2.0], PI / 4.0)
    }

    fn space(&self, of: &Context) -> String {
        cylinder(of.specimen)
    }

    fn friction(&self) -> Option<f64> {
        Some(0.0)
    }

    fn restitution(&self) -> f64 {
        // Without friction grains creep for a long time: three times as many steps with 0.2.
        0.9
    }

    fn check(&self, sample: &Sample, request: &Request) -> Result<()> {
        unused(
            request.inertial.is_some(),
            "--inertial",
            "uniaxial",
            "no stress acts on the sides (use --speed)",
        )?;
        unused(
            sample.is_packed() && !request.stress.is_empty(),
            "--stress",
            "uniaxial",
            "the grains are packed already",
        )?;
        unused(
            sample.is_packed() && request.friction.is_some(),
            "--friction",
            "uniaxial",
            "the grains are packed already",
        )?;
        unused(
            sample.is_packed() && request.rest.is_some(),
            "--rest",
            "uniaxial",
            "the grains are packed already",
        )?;
        if sample.has("bond") {
            return Ok(());
        }
        let (what, cure) = (
            "has no [[bond]]".to_owned(),
            "grains without bonds have no strength in uniaxial compression: add a [[bond]], or use triaxial",
        );
        Err(sample.refusal(what, cure))
    }

    fn preparation(&self, of: &Context) -> Result<Option<Part>> {
        if of.sample.is_packed() {
            return Ok(None);
        }
        let (space, stress) = (of.specimen, of.loading.stress);
        let (until, middle) = (settling(of, stress), 0.5 * (space.low + space.high));
        let [x, y, low, high, radius] =
            [middle.x, middle.y, space.low.z - 0.01, space.high.z + 0.01, 0.5 * space.sides()[0]].map(number);
        let limit = of.request.speed_limit(&of.sample.grains, stress, space.height);
        let press = pressing(stress, area(of), limit);
        let text = output(until, 20)
            + damping(of.sample)
            + &wall(
                "vessel",
                &format!("solid = \"cylinder:{x},{y},{low},{x},{y},{high},{radius}\""),
                SIDE,
                "",
            )
            + &wall("floor", &plane(space.low, [0, 0, 1]), SIDE, "")
            + &wall("lid", &plane(space.high, [0, 0, -1]), SIDE, &press);
        Ok(Some(Part { until, to_rest: true, text, ..Part::default() }))
    }

    fn placed(&self) -> &'static [&'static str] {
        &["lid"]
    }

    fn test(&self, of: &Context, prepared: &Prepared) -> Result<Part> {
        let height = height(of, prepared);
        let speed = of.request.speed_of_plate(&of.sample.grains);
        let time = of.request.strain.unwrap_or(END) * height / speed;
        let ramp = RAMP * time;
        let until = time + 0.5 * ramp;
        let upper = of.specimen.low + Vec3::z() * height;
        let text = output(until, of.request.rows)
            + &wall("lower", &plane(of.specimen.low, [0, 0, 1]), PLATE, "")
            + &wall("upper", &plane(upper, [0, 0, -1]), PLATE, &translate(Vec3::z() * -speed, ramp));
        Ok(Part { until, text, bonds: true, ..Part::default() })
    }

    fn tables(&self, of: &Context, prepared: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        let (low, height) = (of.specimen.low.z, height(of, prepared));
        let middle = format!("box:-1e3,-1e3,{},1e3,1e3,{}", low + 0.25 * height, low + 0.75 * height);
        let strain = ["--strain", "--within", &middle].map(str::to_owned).to_vec();
        let walls = ["lower", "upper"].map(|name| (name, force_on(name)));
        walls.into_iter().chain([("strain", strain)]).chain(cracks(of.sample)).collect()
    }

    fn curve(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Curve> {
        let (area, height) = (area(of), height(of, prepared));
        let times = tables.column("upper", "time")?;
        let over = |force: Vec<f64>, sign: f64| force.iter().map(|f| sign * f / area).collect::<Vec<f64>>();
        let sideways = tables
            .column("strain", "xx")?
            .iter()
            .zip(tables.column("strain", "yy")?)
            .map(|(x, y)| 0.5 * (x + y))
            .collect();
        let curve = Curve::default()
            .with("time", "s", times.clone())
            .with(
                "strain",
                "",
                tables.column("upper", "shift_z")?.iter().map(|shift| -shift / height).collect(),
            )
            .with("stress", "Pa", over(tables.column("upper", "fz")?, 1.0))
            .with("lower_stress", "Pa", over(tables.column("lower", "fz")?, -1.0))
            .with("middle_axial_strain", "", tables.column("strain", "zz")?)
            .with("middle_lateral_strain", "", sideways);
        tables.finish(curve, &times)
    }

    /// Grains that break off widen the extent, so that the section is that at the start, strained as the grains in the middle half.
    fn room(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Option<Room>> {
        let height = height(of, prepared);
        let heights: Vec<f64> = tables.column("upper", "shift_z")?.iter().map(|way| height + way).collect();
        let [x, y] = ["xx", "yy"].map(|name| tables.column("strain", name));
        let [across_x, across_y] = of.specimen.sides();
        let along = |side: f64, strain: &[f64]| strain.iter().map(|e| side * (1.0 - e)).collect::<Vec<f64>>();
        let lengths = [along(across_x, &x?), along(across_y, &y?), heights];
        let share = area(of) / (across_x * across_y);
        let whole = Room::of_box(lengths);
        let volume = whole.volume.iter().map(|v| v * share).collect();
        Ok(Some(Room { volume, ..whole }))
    }

    fn measured(&self, of: &Context) -> Option<(String, Option<f64>)> {
        Some(around(of))
    }

    fn sheared(&self, _: &Context, curve: &Curve) -> Option<Vec<f64>> {
        Some(curve.column("strain").to_vec())
    }

    fn peak(&self) -> Option<&'static str> {
        Some("stress")
    }

    fn values(&self, _: &Context, curve: &Curve) -> Vec<Value> {
        let (strain, stress) = (curve.column("strain"), curve.column("stress"));
        let Some(top) = peak(stress) else { return Vec::new() };
        let ends = [0.25, 0.5].map(|share| on_the_way(stress, top, share));
        let change = |name: &str| match ends {
            [Some(quarter), Some(half)] => at(curve.column(name), half) - at(curve.column(name), quarter),
            _ => f64::NAN,
        };
        let cracks = curve.column("cracks").get(top).copied().unwrap_or(f64::NAN);
        let value = |name, unit, value| Value { name, unit, value };
        vec![
            value("strength", "Pa", stress[top]),
            value("strain_at_strength", "", strain[top]),
            value("young", "Pa", change("stress") / change("strain")),
            value("poisson", "", -change("middle_lateral_strain") / change("middle_axial_strain")),
            value("cracks_at_strength", "", cracks),
            value("residual_stress", "Pa", residual(stress)),
        ]
    }

    fn warnings(&self, of: &Context, curve: &Curve) -> Vec<String> {
        let speed = of.request.speed_of_plate(&of.sample.grains);
        let top = peak(curve.column("stress"));
        top.and_then(|top| uneven(curve, ["stress", "lower_stress"], "Pa", top, speed)).into_iter().collect()
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        ("strain", &["stress", "cracks"])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outline_of_circles() {
        let polygon = 0.5 * 64.0 * (2.0 * PI / 64.0).sin();
        assert!((outline([(1.0, 2.0, 1.0)].into_iter()) - polygon).abs() < 1e-12);
        let two = [(0.0, 0.0, 1.0), (3.0, 0.0, 1.0), (1.5, 0.0, 0.5)];
        assert!((outline(two.into_iter()) - polygon - 6.0).abs() < 1e-12);
    }
}
