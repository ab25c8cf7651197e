//! What the user should know of a specimen whose programs all came to their end.

use crate::error::Result;
use crate::recipes::{Loading, Part};
use crate::request::Specimen;
use crate::running::chain::Chain;
use crate::sample::Sample;
use crate::series::{Curve, smoothed};
use serde_json::Value as Json;

/// Largest speed of a prepared specimen over √(p/ρ) [–].
const STILL: f64 = 2e-3;

/// Rise over three tenths of a curve, from tenth to tenth, that is more than scatter [–].
const RISE: f64 = 0.05;

/// A warning where the specimen still moves when it is prepared: root mean square speed against √(p/ρ), which is how inertial numbers count.
pub(crate) fn moves(
    (sample, specimen): (&Sample, &Specimen),
    loading: &Loading,
    chain: &Chain,
) -> Result<Option<String>> {
    let kinetic = chain.measure("prepare", "settling.csv", &["--settling"])?.column("kinetic")?;
    let grains = &sample.grains;
    let mass = specimen.mass(grains);
    let speed = (2.0 * kinetic.last().copied().unwrap_or(0.0) / mass).sqrt();
    let over = speed / (loading.stress / grains.density).sqrt();
    let words =
        || format!("the grains still move at {speed:.2e} m/s when the test begins: use a smaller --rest");
    Ok((loading.stress > 0.0 && over > STILL).then(words))
}

/// A warning where bonds broke in the preparation: the test bonds the grains again.
pub(crate) fn broke(sample: &Sample, part: &Part, chain: &Chain) -> Result<Option<String>> {
    if !part.bonds || !sample.has("bond") {
        return Ok(None);
    }
    let cracks = chain.measure("prepare", "prepared-cracks.csv", &["--cracks"])?.column("time")?.len();
    let words = || {
        format!(
            "in the preparation {} broken, but whole again in the test: use a smaller --stress, or stronger bonds",
            geom::counted_as(cracks, "bond", ["was", "were"])
        )
    };
    Ok((cracks > 0).then(words))
}

/// A warning where the stress still rises when the test ends: its peak is the end of the test, and nothing is residual.
pub(crate) fn still_rises(curve: &Curve) -> Option<String> {
    let name = ["deviator_stress", "shear_stress"].into_iter().find(|name| !curve.column(name).is_empty())?;
    let values = smoothed(curve.column(name));
    let part = values.len() / 10;
    let mean = |from_end: usize| {
        let end = values.len() - from_end * part;
        values[end - part..end].iter().sum::<f64>() / part as f64
    };
    let [last, before, first] = [0, 1, 2].map(mean);
    let rises = part > 0 && last > before && before > first && last > (1.0 + RISE) * first;
    rises.then(|| {
        format!(
            "the {} still rises when the test ends{}: what is called peak is the end of the test, and residual is none: give a larger \
             --strain",
            name.replace('_', " "),
            // Where it was negative before, its rise has no share.
            if first > 0.0 {
                format!(", by {:.0} % over its last parts", 100.0 * (last / first - 1.0))
            } else {
                String::new()
            }
        )
    })
}

/// A warning where the preparation has ended before the grains rest.
pub(crate) fn not_at_rest(report: &Json) -> Option<String> {
    let time = report["time"].as_f64().unwrap_or(f64::NAN);
    let rests = report["settled"].is_string();
    (!rests).then(|| format!("the grains were not at rest when the preparation ended at {time:.3} s: raise --rest, or change the sample (damping, friction)"))
}

/// Warnings of servos that did not hold their stress.
pub(crate) fn not_held(report: &Json) -> Vec<String> {
    let servos = report["servos"].as_array().map_or(&[][..], Vec::as_slice);
    let off = |servo: &Json| {
        let mean = servo["mean_deviation"].as_f64().filter(|mean| *mean > 0.01)?;
        let wall = servo["wall"].as_str().unwrap_or_default();
        let place = match wall.strip_prefix("domain.strain.") {
            Some(axis) => format!("along {axis}"),
            None => format!("on wall '{wall}'"),
        };
        Some(format!(
            "the stress {place} was off by {:.1} % in the mean: test more slowly (--inertial, --speed)",
            100.0 * mean
        ))
    };
    servos.iter().filter_map(off).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_test_that_ends_before_its_peak_is_told() {
        let curve = |stress: fn(f64) -> f64| {
            Curve::default().with(
                "shear_stress",
                "Pa",
                (0..100).map(|k| stress(f64::from(k) / 100.0)).collect(),
            )
        };
        assert!(still_rises(&curve(|x| 1e3 * x)).expect("it rises").contains("the shear stress still rises"));
        assert_eq!(still_rises(&curve(|x| 1e3 * (20.0 * x).tanh())), None);
        assert_eq!(still_rises(&curve(|x| 1e3 * x * (1.4 - x))), None, "past its peak");
        assert_eq!(still_rises(&Curve::default()), None);
    }
}
