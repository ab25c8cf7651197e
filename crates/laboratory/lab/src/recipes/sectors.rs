//! Angles of a heap by sectors.

use super::{Curve, Result, Tables, Value};

/// Angle of a heap by sectors, as a curve.
pub(super) fn sectors(tables: &Tables) -> Result<Curve> {
    let angles = tables.column("repose", "angle")?;
    Ok(Curve::default()
        .with("sector", "", (0..angles.len()).map(|k| k as f64).collect())
        .with("angle", "deg", angles)
        .with("angle_low", "deg", tables.column("repose", "angle_low")?)
        .with("angle_high", "deg", tables.column("repose", "angle_high")?))
}

/// What the angles of the sectors come to.
pub(super) fn of_sectors(curve: &Curve) -> Vec<Value> {
    let angles: Vec<f64> = curve.column("angle").iter().copied().filter(|a| !a.is_nan()).collect();
    let mean = measure::statistics::Mean::of(&angles);
    vec![
        Value { name: "angle", unit: "deg", value: mean.mean },
        Value { name: "interval_over_sectors", unit: "deg", value: mean.interval },
    ]
}
