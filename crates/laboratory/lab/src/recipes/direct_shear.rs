//! Direct shear: a box of two halves under a constant normal stress; the upper half moves over the lower one.
//!
//! ```text
//!       │  lid ↓ σ   │          τ = F_x/A     σ' = (F_z − W)/A     of what the grains press on the lower half and the floor
//!   ────┤  upper → v │          W: weight of the grains below the shear plane
//!       │────────────├────      φ = atan(τ/σ')     tan ψ = dh/ds at the peak
//!       │  lower     │
//!       └────────────┘
//! ```
//! Plates at the height of the shear plane carry the grains of the half that overhangs, and close the other one. A is the area at the
//! start (ASTM D3080). The sides are smooth, floor and lid rough.

use super::boxes::{around, height, press, upright};
use super::*;
use crate::composing::walls::{PLATE, SIDE};
use crate::request::BAND;
use crate::series::{at, peak, reaches, slope};

pub struct DirectShear;

/// Displacement over the length of the box at the end [–].
const END: f64 = 0.12;
/// Share of the test in which the upper half gets up to speed [–].
const RAMP: f64 = 0.02;

impl DirectShear {
    fn way(&self, of: &Context) -> f64 {
        of.request.strain.unwrap_or(END) * of.specimen.sides()[0]
    }

    /// Lower and upper half as triangles; `middle` is the height of the shear plane, `top` that of the upper edge.
    fn halves(&self, of: &Context, middle: f64, top: f64) -> [String; 2] {
        let (a, b) = (of.specimen.low, of.specimen.high);
        let reach = self.way(of) + 2.0 * of.sample.grains.largest;
        let around = |low: f64, high: f64| {
            let side = |x0: f64, y0: f64, x1: f64, y1: f64| {
                rectangle([x0, y0, low], [x1, y1, low], [x1, y1, high], [x0, y0, high])
            };
            side(a.x, a.y, b.x, a.y)
                + &side(b.x, a.y, b.x, b.y)
                + &side(b.x, b.y, a.x, b.y)
                + &side(a.x, b.y, a.x, a.y)
        };
        let plate = |x0: f64, x1: f64| {
            rectangle([x0, a.y, middle], [x1, a.y, middle], [x1, b.y, middle], [x0, b.y, middle])
        };
        [around(a.z, middle) + &plate(b.x, b.x + reach), around(middle, top) + &plate(a.x - reach, a.x)]
    }
}

impl Recipe for DirectShear {
    fn name(&self) -> &'static str {
        "direct-shear"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::Each, &[2.5e4, 5e4, 1e5])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([2.0, 2.0, 1.0], 1.0)
    }

    fn check(&self, _: &Sample, _: &Request) -> Result<()> {
        Ok(())
    }

    fn preparation(&self, of: &Context) -> Result<Option<Part>> {
        Ok(Some(press(of)))
    }

    fn placed(&self) -> &'static [&'static str] {
        &["lid"]
    }

    fn test(&self, of: &Context, prepared: &Prepared) -> Result<Part> {
        let (space, stress) = (of.specimen, of.loading.stress);
        let height = height(of, prepared);
        let speed = of.request.speed_over(&of.sample.grains, stress, height);
        let time = self.way(of) / speed;
        let (ramp, lid) = (RAMP * time, Vec3::new(space.low.x, space.low.y, space.low.z + height));
        let move_ = translate(Vec3::x() * speed, ramp);
        let area = space.sides()[0] * space.sides()[1];
        let limit = of.request.speed_limit(&of.sample.grains, stress, height).max(speed);
        let press = pressing(stress, area, limit);
        let until = time + 0.5 * ramp;
        let text = output(until, of.request.rows)
            + &wall("floor", &plane(space.low, [0, 0, 1]), PLATE, "")
            + &wall("lid", &plane(lid, [0, 0, -1]), PLATE, &(press + &move_))
            + &wall("lower", "mesh = \"lower.txt\"", SIDE, "")
            + &wall("upper", "mesh = \"upper.txt\"", SIDE, &move_);
        let [lower, upper] = self.halves(of, space.low.z + 0.5 * height, space.low.z + 1.3 * height);
        let files = vec![("lower.txt".to_owned(), lower), ("upper.txt".to_owned(), upper)];
        Ok(Part { until, text, files, bonds: true, ..Part::default() })
    }

    fn tables(&self, of: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        let walls = ["floor", "lid", "lower", "upper"].map(|name| (name, force_on(name)));
        walls.into_iter().chain(cracks(of.sample)).collect()
    }

    fn curve(&self, of: &Context, _: &Prepared, tables: &Tables) -> Result<Curve> {
        let area = of.specimen.sides()[0] * of.specimen.sides()[1];
        let grains = &of.sample.grains;
        let weight = 0.5 * of.specimen.mass(grains) * grains.gravity;
        let times = tables.column("upper", "time")?;
        let below = |column: &str| tables.sum(&["floor", "lower"], column);
        let normal = below("fz")?.iter().map(|f| (-f - weight) / area).collect();
        let lid = tables.column("lid", "fz")?.iter().map(|f| f / area).collect();
        let curve = Curve::default()
            .with("time", "s", times.clone())
            .with("displacement", "m", tables.column("upper", "shift_x")?)
            .with("shear_stress", "Pa", below("fx")?.iter().map(|f| f / area).collect())
            .with("normal_stress", "Pa", normal)
            .with("lid_stress", "Pa", lid)
            .with("rise", "m", tables.column("lid", "shift_z")?);
        tables.finish(curve, &times)
    }

    fn room(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Option<Room>> {
        let height = height(of, prepared);
        let heights = tables.column("lid", "shift_z")?.iter().map(|rise| height + rise).collect();
        Ok(Some(upright(of, heights)))
    }

    fn measured(&self, of: &Context) -> Option<(String, Option<f64>)> {
        Some(around(of))
    }

    fn sheared(&self, of: &Context, curve: &Curve) -> Option<Vec<f64>> {
        let band = of.specimen.height.min(BAND * of.sample.grains.diameter);
        Some(curve.column("displacement").iter().map(|way| way / band).collect())
    }

    fn peak(&self) -> Option<&'static str> {
        Some("shear_stress")
    }

    fn values(&self, _: &Context, curve: &Curve) -> Vec<Value> {
        let (way, rise) = (curve.column("displacement"), smoothed(curve.column("rise")));
        let (shear, normal) =
            (smoothed(curve.column("shear_stress")), smoothed(curve.column("normal_stress")));
        let ratio: Vec<f64> = shear.iter().zip(&normal).map(|(t, n)| t / n).collect();
        let Some(top) = peak(&shear) else { return Vec::new() };
        let half = shear.len() / 20;
        let (from, to) = (top.saturating_sub(half), (top + half + 1).min(shear.len()));
        let stiffness =
            reaches(&shear, 0.5 * shear[top]).map_or(f64::NAN, |half| 0.5 * shear[top] / at(way, half));
        let value = |name, unit, value| Value { name, unit, value };
        vec![
            value("peak_shear_stress", "Pa", shear[top]),
            value("peak_normal_stress", "Pa", normal[top]),
            value("peak_angle", "deg", ratio[top].atan().to_degrees()),
            value("peak_displacement", "m", way[top]),
            value("residual_shear_stress", "Pa", residual(&shear)),
            value("residual_normal_stress", "Pa", residual(&normal)),
            value("residual_angle", "deg", residual(&ratio).atan().to_degrees()),
            value("dilation_angle", "deg", slope(&way[from..to], &rise[from..to]).atan().to_degrees()),
            value("stiffness", "Pa/m", stiffness),
        ]
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        ("displacement", &["shear_stress", "rise"])
    }

    fn envelope(&self) -> Option<Envelope> {
        Some(Envelope::Plane)
    }
}
