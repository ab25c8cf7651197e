//! Oedometer: a box whose sides do not give way, under a lid whose stress follows a path.
//!
//! ```text
//! e = V/V_s − 1      M = Δσ/Δε between two stresses      K₀ = σ_h/σ_v      C_c = −Δe/Δ log₁₀ σ
//! ```
//! V_s is the volume of the solid. The sides are smooth; strains refer to the specimen under the first stress.

use super::boxes::{around, height, press, sides, upright};
use super::*;
use crate::composing::walls::PLATE;

pub struct Oedometer;

/// Strain that a step between two stresses takes, about, for its time [–].
const STEP: f64 = 0.01;

/// Times [s] at which the path reaches its stresses; the first is 0.
fn times(of: &Context) -> Vec<f64> {
    let grains = &of.sample.grains;
    let pairs = of.loading.path.windows(2);
    let spans = pairs.map(|pair| STEP / of.request.rate(grains, pair[0].min(pair[1])));
    std::iter::once(0.0)
        .chain(spans.scan(0.0, |sum, span| {
            *sum += span;
            Some(*sum)
        }))
        .collect()
}

/// Heights of the specimen in each row [m].
fn heights(of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Vec<f64>> {
    let start = height(of, prepared);
    Ok(tables.column("lid", "shift_z")?.iter().map(|shift| start + shift).collect())
}

impl Recipe for Oedometer {
    fn name(&self) -> &'static str {
        "oedometer"
    }

    fn stresses(&self) -> (Stresses, &'static [f64]) {
        (Stresses::Path, &[2.5e4, 5e4, 1e5, 5e4])
    }

    fn proportions(&self) -> ([f64; 3], f64) {
        ([2.0, 2.0, 1.0], 1.0)
    }

    fn check(&self, _: &Sample, request: &Request) -> Result<()> {
        unused(request.strain.is_some(), "--strain", "oedometer", "the stresses end the test")?;
        unused(request.speed.is_some(), "--speed", "oedometer", "the lid follows stresses")?;
        if request.stress.len() == 1 {
            return Err(LabError::Usage(
                "--stress: an oedometer follows at least two stresses, such as --stress 50000,100000".into(),
            ));
        }
        Ok(())
    }

    fn preparation(&self, of: &Context) -> Result<Option<Part>> {
        Ok(Some(press(of)))
    }

    fn placed(&self) -> &'static [&'static str] {
        &["lid"]
    }

    fn test(&self, of: &Context, prepared: &Prepared) -> Result<Part> {
        let (space, times) = (of.specimen, times(of));
        let until = times.last().copied().unwrap_or(0.0);
        let area = space.sides()[0] * space.sides()[1];
        let most = of.loading.path.iter().copied().fold(0.0, f64::max);
        let limit = of.request.speed_limit(&of.sample.grains, most, space.height);
        let press = servo(
            [0, 0, -1],
            "path = { source = \"stress.csv\" }",
            &format!("area = {}", number(area)),
            limit,
        );
        let lid = space.low + Vec3::z() * height(of, prepared);
        let text = output(until, of.request.rows)
            + &wall("floor", &plane(space.low, [0, 0, 1]), PLATE, "")
            + &wall("lid", &plane(lid, [0, 0, -1]), PLATE, &press)
            + &sides(of);
        let rows: String = times
            .iter()
            .zip(&of.loading.path)
            .map(|(t, s)| format!("{},{}\n", number(*t), number(*s)))
            .collect();
        Ok(Part {
            until,
            text,
            files: vec![("stress.csv".into(), format!("t,stress\n{rows}"))],
            bonds: true,
            ..Part::default()
        })
    }

    fn tables(&self, of: &Context, _: &Prepared) -> Vec<(&'static str, Vec<String>)> {
        let walls = ["lid", "right", "back"].map(|name| (name, force_on(name)));
        walls.into_iter().chain(cracks(of.sample)).collect()
    }

    fn curve(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Curve> {
        let start = height(of, prepared);
        let [x, y] = of.specimen.sides();
        let times = tables.column("lid", "time")?;
        let heights = heights(of, prepared, tables)?;
        let over = |force: Vec<f64>, side: f64| {
            force.into_iter().zip(&heights).map(|(f, h)| f / (side * h)).collect::<Vec<f64>>()
        };
        let (right, back) = (over(tables.column("right", "fx")?, y), over(tables.column("back", "fy")?, x));
        let curve = Curve::default()
            .with("time", "s", times.clone())
            .with("stress", "Pa", tables.column("lid", "fz")?.iter().map(|f| f / (x * y)).collect())
            .with("strain", "", heights.iter().map(|h| 1.0 - h / start).collect())
            .with("lateral_stress", "Pa", right.iter().zip(&back).map(|(a, b)| 0.5 * (a + b)).collect());
        tables.finish(curve, &times)
    }

    fn room(&self, of: &Context, prepared: &Prepared, tables: &Tables) -> Result<Option<Room>> {
        Ok(Some(upright(of, heights(of, prepared, tables)?)))
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

    fn grains(&self) -> u64 {
        // More than ten of them high.
        5000
    }

    fn values(&self, of: &Context, curve: &Curve) -> Vec<Value> {
        let nearest = |time: f64| {
            let off = |i: &usize| (curve.column("time")[*i] - time).abs();
            (0..curve.rows()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
        };
        let rows: Vec<usize> = times(of).into_iter().map(nearest).collect();
        let [stress, strain, voids, lateral] =
            ["stress", "strain", "void_ratio", "lateral_stress"].map(|name| curve.column(name));
        let Some(top) = (0..rows.len()).max_by(|a, b| of.loading.path[*a].total_cmp(&of.loading.path[*b]))
        else {
            return Vec::new();
        };
        let modulus = |a: usize, b: usize| (stress[b] - stress[a]) / (strain[b] - strain[a]);
        let value = |name, unit, value| Value { name, unit, value };
        let last = rows[top];
        let before = rows[top.saturating_sub(1)];
        let mut list = vec![
            value("initial_void_ratio", "", voids[rows[0]]),
            value("void_ratio_at_peak", "", voids[last]),
            value("constrained_modulus", "Pa", modulus(before, last)),
            value(
                "compression_index",
                "",
                -(voids[last] - voids[before]) / (stress[last] / stress[before]).log10(),
            ),
            value("K0", "", lateral[last] / stress[last]),
        ];
        if let Some(end) = rows.get(top + 1) {
            list.push(value("unloading_modulus", "Pa", modulus(last, *end)));
        }
        list
    }

    fn axes(&self) -> (&'static str, &'static [&'static str]) {
        ("stress", &["void_ratio", "lateral_stress"])
    }
}
