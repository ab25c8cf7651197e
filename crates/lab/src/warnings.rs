//! What the user should know of a specimen whose programs all came to their end.

use crate::chain::Chain;
use crate::error::Result;
use crate::lab::Lab;
use crate::recipes::{Loading, Part};
use serde_json::Value as Json;

/// Largest speed of a prepared specimen over √(p/ρ) [–].
const STILL: f64 = 2e-3;

impl Lab {
    /// A warning where the specimen still moves when it is prepared: root mean square speed against √(p/ρ), which is how inertial numbers count.
    pub(crate) fn moves(&self, loading: &Loading, chain: &Chain) -> Result<Option<String>> {
        let kinetic = chain.measure("prepare", "settling.csv", &["--settling"])?.column("kinetic")?;
        let grains = &self.sample.grains;
        let mass = self.specimen.mass(grains);
        let speed = (2.0 * kinetic.last().copied().unwrap_or(0.0) / mass).sqrt();
        let over = speed / (loading.stress / grains.density).sqrt();
        let words =
            || format!("the grains still move at {speed:.2e} m/s when the test begins: use a smaller --rest");
        Ok((loading.stress > 0.0 && over > STILL).then(words))
    }

    /// A warning where bonds broke in the preparation: the test bonds the grains again.
    pub(crate) fn broke(&self, part: &Part, chain: &Chain) -> Result<Option<String>> {
        if !part.bonds || !self.sample.has("bond") {
            return Ok(None);
        }
        let cracks = chain.measure("prepare", "prepared-cracks.csv", &["--cracks"])?.column("time")?.len();
        let words = || {
            format!(
                "{cracks} bonds broke in the preparation, and are whole again in the test: use a smaller --stress, or stronger bonds"
            )
        };
        Ok((cracks > 0).then(words))
    }
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
