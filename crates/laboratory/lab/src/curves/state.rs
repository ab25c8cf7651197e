//! The state of a specimen in each row of its test: size, voids, contacts, stress, fabric, inertial number. One implementation for all tests.
//!
//! ```text
//! n = 1 − V_s/V     e = n/(1 − n)      V_s: mass over density of the grains, overlaps counted twice; V: between the walls, or of the periodic domain
//! σ_ab = 1/V Σ f_a l_b                 over all contacts and bonds, those with walls included; positive in compression
//! F_ab = 1/C Σ n_a n_b                 over contacts between grains
//! I = |dγ/dt| d √(ρ/p),  p = tr σ/3    γ: how far the specimen is sheared, as the test defines it
//! ```
//!
//! A specimen that no walls bound (a heap, a bed in a drum, a single stone) has the extent of its grains as its size, and neither volume nor stress.

use crate::error::Result;
use crate::recipes::{Context, Prepared, Recipe, Tables};
use crate::series::{Column, Curve, peak, smoothed};
use serde::Serialize;

/// A symmetric tensor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tensor {
    pub xx: Option<f64>,
    pub yy: Option<f64>,
    pub zz: Option<f64>,
    pub xy: Option<f64>,
    pub xz: Option<f64>,
    pub yz: Option<f64>,
}

/// A specimen at one moment; what it has not is none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moment {
    /// Time since the start of the test [s].
    pub time: f64,
    /// Lengths along x, y and z [m].
    pub size: [Option<f64>; 3],
    /// Volume [m³].
    pub volume: Option<f64>,
    pub grains: Option<f64>,
    /// Mass of its grains [kg].
    pub mass: Option<f64>,
    /// Volume of the solid [m³].
    pub solid_volume: Option<f64>,
    pub void_ratio: Option<f64>,
    pub porosity: Option<f64>,
    /// Contacts of a grain with grains.
    pub coordination: Option<f64>,
    /// Contacts of a grain that is no rattler, walls included.
    pub mechanical_coordination: Option<f64>,
    /// Share of grains with fewer than two contacts.
    pub rattlers: Option<f64>,
    /// Mean stress [Pa].
    pub stress: Tensor,
    pub fabric: Tensor,
    pub inertial_number: Option<f64>,
}

/// The moments of a test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moments {
    pub start: Option<Moment>,
    /// Where the test has its largest value; none where it has no such value.
    pub peak: Option<Moment>,
    pub end: Option<Moment>,
}

/// Names of the parts of both tensors.
const PARTS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];
const STRESSES: [&str; 6] = ["stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz"];
const FABRICS: [&str; 6] = ["fabric_xx", "fabric_yy", "fabric_zz", "fabric_xy", "fabric_xz", "fabric_yz"];
/// Columns that only the moments have.
const INNER: [&str; 4] = ["volume", "grains", "mass", "solid_volume"];

/// Tables that the state needs: name, and options of dem-measure.
pub(crate) fn tables(recipe: &dyn Recipe, of: &Context) -> Vec<(&'static str, Vec<String>)> {
    let one = |option: &str| vec![option.to_owned()];
    let mut list =
        vec![("contacts", one("--contacts")), ("extent", [one("--extent"), one("--all")].concat())];
    list.push(("fabric", one("--fabric")));
    if let Some((shape, _)) = recipe.measured(of) {
        list.push(("mean_stress", vec!["--stress".to_owned(), shape]));
    }
    list
}

/// The state in each row of the run, by time.
pub(crate) fn states(
    recipe: &dyn Recipe,
    of: &Context,
    prepared: &Prepared,
    tables: &Tables,
    curve: &Curve,
) -> Result<Curve> {
    let column = |table: &str, name: &str| tables.column(table, name);
    let times = column("extent", "time")?;
    let at_times = |from: &[f64], values: &[f64]| -> Vec<f64> {
        let near = |t: &f64| from.iter().position(|s| (s - t).abs() <= 1e-9 * (1.0 + t.abs()));
        times.iter().map(|t| near(t).and_then(|k| values.get(k)).copied().unwrap_or(f64::NAN)).collect()
    };
    let of_table = |table: &str, name: &str| -> Result<Vec<f64>> {
        Ok(at_times(&column(table, "time")?, &column(table, name)?))
    };
    let none = || vec![f64::NAN; times.len()];
    let room = recipe.room(of, prepared, tables)?;
    let own = curve.column("time");
    let by_row = |values: &Vec<f64>| at_times(own, values);
    let (lengths, volume) = match &room {
        Some(room) => (room.lengths.each_ref().map(by_row), by_row(&room.volume)),
        None => {
            let [x, y, z] = ["length_x", "length_y", "length_z"].map(|name| column("extent", name));
            ([x?, y?, z?], none())
        }
    };
    let solid = column("extent", "solid")?;
    let porosity: Vec<f64> = solid.iter().zip(&volume).map(|(s, v)| 1.0 - s / v).collect();
    // The table is of a shape around all grains: its volume is not that of the specimen.
    let shape = recipe.measured(of).and_then(|(_, volume)| volume);
    let stress = |name: &str| -> Result<Vec<f64>> {
        if room.is_none() {
            return Ok(none());
        }
        let scale = |(s, v): (f64, &f64)| shape.map_or(s, |whole| s * whole / v);
        Ok(of_table("mean_stress", name)?.into_iter().zip(&volume).map(scale).collect())
    };
    let stresses = PARTS.iter().map(|name| stress(name)).collect::<Result<Vec<_>>>()?;
    let sheared = recipe.sheared(of, curve).map_or_else(none, |strain| rates(&times, &by_row(&strain)));
    let grains = &of.sample.grains;
    let inertial = (0..times.len()).map(|i| {
        let pressure = (stresses[0][i] + stresses[1][i] + stresses[2][i]) / 3.0;
        sheared[i].abs() * grains.diameter * (grains.density / pressure).sqrt()
    });
    let inertial: Vec<f64> = inertial.collect();
    let [x, y, z] = lengths;
    let mut all = Curve::default()
        .with("time", "s", times.clone())
        .with("size_x", "m", x)
        .with("size_y", "m", y)
        .with("size_z", "m", z)
        .with("volume", "m³", volume)
        .with("grains", "", column("extent", "grains")?)
        .with("mass", "kg", column("extent", "mass")?)
        .with("solid_volume", "m³", solid)
        .with("void_ratio", "", porosity.iter().map(|n| n / (1.0 - n)).collect())
        .with("porosity", "", porosity);
    for name in ["coordination", "mechanical_coordination", "rattlers"] {
        all = all.with(name, "", of_table("contacts", name)?);
    }
    for (name, values) in STRESSES.iter().zip(stresses) {
        all = all.with(name, "Pa", values);
    }
    for (name, part) in FABRICS.iter().zip(PARTS) {
        all = all.with(name, "", of_table("fabric", part)?);
    }
    Ok(all.with("inertial_number", "", inertial))
}

/// Rates of change over the neighbours of each row.
fn rates(times: &[f64], values: &[f64]) -> Vec<f64> {
    let last = times.len().saturating_sub(1);
    let rate = |i: usize| {
        let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
        (values[b] - values[a]) / (times[b] - times[a])
    };
    (0..times.len()).map(rate).collect()
}

/// The curve with the columns of the state, where its rows are moments.
pub(crate) fn joined(curve: Curve, states: &Curve) -> Curve {
    let times: Vec<f64> = curve.column("time").to_vec();
    let of_states = states.column("time");
    let row = |t: &f64| of_states.iter().position(|s| (s - t).abs() <= 1e-9 * (1.0 + t.abs()));
    let rows: Vec<Option<usize>> = times.iter().map(row).collect();
    if times.is_empty() {
        return curve;
    }
    let wanted = |c: &&Column| c.name != "time" && !INNER.contains(&c.name);
    states.columns.iter().filter(wanted).fold(curve, |curve, c| {
        let values = rows.iter().map(|row| row.map_or(f64::NAN, |k| c.values[k])).collect();
        curve.with(c.name, c.unit, values)
    })
}

/// The state at the start, at the peak of a column of the curve, and at the end.
pub(crate) fn moments(recipe: &dyn Recipe, curve: &Curve, states: &Curve) -> Moments {
    let top = recipe.peak().and_then(|name| peak(&smoothed(curve.column(name))));
    let time = top.and_then(|row| curve.column("time").get(row));
    let at_peak =
        time.and_then(|t| states.column("time").iter().position(|s| (s - t).abs() <= 1e-9 * (1.0 + t.abs())));
    let of = |row: Option<usize>| row.filter(|row| *row < states.rows()).map(|row| moment(states, row));
    Moments { start: of(Some(0)), peak: of(at_peak), end: of(states.rows().checked_sub(1)) }
}

fn moment(states: &Curve, row: usize) -> Moment {
    let at = |name: &str| states.column(name).get(row).copied().filter(|v| v.is_finite());
    let tensor = |names: [&str; 6]| {
        let [xx, yy, zz, xy, xz, yz] = names.map(at);
        Tensor { xx, yy, zz, xy, xz, yz }
    };
    Moment {
        time: at("time").unwrap_or(f64::NAN),
        size: ["size_x", "size_y", "size_z"].map(at),
        volume: at("volume"),
        grains: at("grains"),
        mass: at("mass"),
        solid_volume: at("solid_volume"),
        void_ratio: at("void_ratio"),
        porosity: at("porosity"),
        coordination: at("coordination"),
        mechanical_coordination: at("mechanical_coordination"),
        rattlers: at("rattlers"),
        stress: tensor(STRESSES),
        fabric: tensor(FABRICS),
        inertial_number: at("inertial_number"),
    }
}
