//! `sizes` of `[[fill]]` and `[[insert]]`: a list with shares, a sieve curve, or a distribution.
//!
//! ```text
//! log-normal      P(d) = Φ(ln(d/median)/deviation)
//! Rosin–Rammler   P(d) = 1 − exp(−(d/size)^spread)         Rosin & Rammler 1933; 63.2 % pass `size`
//! ```
//!
//! P is the share, of mass unless `by = "number"`, that is smaller than d. Distributions end at `from` and `to`, and become [`CLASSES`] classes of equal
//! width in ln d. Between two sieves, and within a class, shares are even over ln d.

use crate::error::{Result, SceneError};
use crate::input::table_of;
use crate::keys::{GrainKeys, OneOrRange, ShareOf};
use crate::plan::builder::{GrainMaterial, PlanBuilder};
use crate::plan::grains::grading::{Class, Grading, Spread};
use geom::{Shown, units};
use toml::{Table, Value};

/// Classes of a distribution: so many that even shares over ln d within a class leave P right to 10⁻³.
const CLASSES: usize = 60;

/// Share of a distribution that no class is made for, at each end.
const REST: f64 = 1e-6;

/// A range of diameters [m], its share, and its material where it names one.
struct Part {
    range: OneOrRange,
    /// Whether it is one of a curve, with even shares over ln d.
    of_curve: bool,
    share: f64,
    material: Option<String>,
}

/// The grains of an entry, by the name of the entry: `fill.0`.
pub(in crate::plan) struct EntryGrains<'a> {
    pub entry: String,
    pub keys: GrainKeys<'a>,
}

impl PlanBuilder<'_> {
    /// The grains of an entry without clumps.
    ///
    /// # Errors
    /// Sizes or shares that are no numbers above 0, a material that is missing or has no density.
    pub(in crate::plan) fn grading(&self, grains: &EntryGrains) -> Result<Grading> {
        let Some(value) = grains.keys.sizes else {
            let GrainMaterial { index, density } =
                self.grain(&grains.key("material"), grains.keys.material.unwrap_or_default())?;
            return Ok(Grading::uniform(grains.keys.diameter.unwrap_or_default(), index, density));
        };
        let parts = grains.parts(self, value)?;
        let class = |part: &Part| {
            let (key, name) = match &part.material {
                Some(name) => (grains.key("sizes"), name.as_str()),
                None => (grains.key("material"), grains.keys.material.unwrap_or_default()),
            };
            let GrainMaterial { index: material, density } = self.grain(&key, name)?;
            let spread = match (part.of_curve, grains.by()) {
                (false, _) => Spread::Uniform,
                (true, ShareOf::Mass) => Spread::Mass,
                (true, ShareOf::Number) => Spread::Number,
            };
            Ok(Class { range: part.range, spread, share: part.share, material, density })
        };
        Ok(Grading::new(parts.iter().map(class).collect::<Result<_>>()?, grains.by()))
    }
}

impl EntryGrains<'_> {
    fn key(&self, key: &str) -> String {
        format!("{}.{key}", self.entry)
    }

    fn by(&self) -> ShareOf {
        self.keys.by.unwrap_or_default()
    }

    /// The largest diameter [m], for stages that are cut before anything is planned.
    pub(in crate::plan) fn largest(&self, plan: &PlanBuilder) -> Result<f64> {
        let Some(value) = self.keys.sizes else { return Ok(self.keys.diameter.unwrap_or_default().high) };
        Ok(self.parts(plan, value)?.iter().map(|p| p.range.high).fold(0.0, f64::max))
    }

    fn wrong(&self, plan: &PlanBuilder, value: &str, why: &str) -> SceneError {
        let cure = "write [[diameter, share], …], a file with a sieve curve, or { law = \"log-normal\", … }";
        plan.check.wrong(&self.key("sizes"), value, why, cure)
    }

    fn parts(&self, plan: &PlanBuilder, value: &Value) -> Result<Vec<Part>> {
        let parts = match value {
            Value::Array(list) => {
                list.iter().map(|row| self.row(plan, row)).collect::<Result<Vec<Part>>>()?
            }
            Value::String(file) => self.sieve(plan, file, 1.0)?,
            Value::Table(table) if table.contains_key("file") => self.file(plan, table)?,
            Value::Table(table) => self.law(plan, table)?,
            other => return Err(self.wrong(plan, &other.to_string(), "is no list, file or law")),
        };
        match parts.is_empty() {
            true => Err(self.wrong(plan, &value.to_string(), "has no size")),
            false => Ok(parts),
        }
    }

    /// `[diameter, share]`, or with the name of a material behind; a diameter may be a range.
    fn row(&self, plan: &PlanBuilder, row: &Value) -> Result<Part> {
        let cells = row.as_array().map_or(&[][..], Vec::as_slice);
        let (size, share, material) = match cells {
            [size, share] => (size, share, None),
            [size, share, Value::String(name)] => (size, share, Some(name.clone())),
            _ => return Err(self.wrong(plan, &row.to_string(), "is not a diameter and a share")),
        };
        let range = match size.as_array().map(Vec::as_slice) {
            Some([low, high]) => OneOrRange { low: self.length(plan, low)?, high: self.length(plan, high)? },
            _ => {
                let d = self.length(plan, size)?;
                OneOrRange { low: d, high: d }
            }
        };
        if range.low > range.high {
            return Err(self.wrong(plan, &size.to_string(), "is a range that ends before it begins"));
        }
        Ok(Part { range, of_curve: false, share: self.positive(plan, "a share", share)?, material })
    }

    /// A number above 0.
    fn positive(&self, plan: &PlanBuilder, what: &str, value: &Value) -> Result<f64> {
        let number = value.as_float().or(value.as_integer().map(|i| i as f64));
        let above = number.filter(|v| *v > 0.0 && v.is_finite());
        above.ok_or_else(|| self.wrong(plan, &value.to_string(), &format!("is not {what} above 0")))
    }

    /// A diameter [m]: a number, or text with a unit.
    fn length(&self, plan: &PlanBuilder, value: &Value) -> Result<f64> {
        let length = match value {
            Value::String(text) => {
                units::parse(text, "m").map_err(|e| self.wrong(plan, text, &e.to_string()))?
            }
            other => self.positive(plan, "a diameter", other)?,
        };
        if length > 0.0 && length <= 100.0 {
            return Ok(length);
        }
        Err(self.wrong(plan, &format!("{} m", Shown(length)), "is no diameter from 0 to 100 m"))
    }

    /// `{ file = "sieve.csv", units = "mm" }`
    fn file(&self, plan: &PlanBuilder, table: &Table) -> Result<Vec<Part>> {
        self.known(plan, table, &["file", "units"])?;
        let Some(Value::String(file)) = table.get("file") else {
            return Err(self.wrong(plan, &table.to_string(), "has no name of a file in 'file'"));
        };
        let scale = match table.get("units") {
            None => 1.0,
            Some(Value::String(name)) => {
                let value = format!("units = \"{name}\"");
                units::factor(name, "m").map_err(|_| self.wrong(plan, &value, "is no unit of length"))?
            }
            Some(other) => return Err(self.wrong(plan, &other.to_string(), "is no unit")),
        };
        self.sieve(plan, file, scale)
    }

    /// Columns `diameter` and `passing` (share or percent that is smaller), rising.
    fn sieve(&self, plan: &PlanBuilder, file: &str, scale: f64) -> Result<Vec<Part>> {
        let (name, table) = plan.file(&self.key("sizes"), file, table_of)?;
        let columns = record::Columns { name: &name, table: &table };
        let (sizes, passing) = (columns.numbers("diameter")?, columns.numbers("passing")?);
        let wrong = |why: String| {
            SceneError::file(
                &name,
                why,
                "wanted: columns diameter and passing, both rising, the first passing 0, the last 1 or 100",
            )
        };
        let whole = passing.last().copied().unwrap_or(0.0);
        let rising = |v: &[f64]| v.windows(2).all(|w| w[1] >= w[0]) && v.iter().all(|x| x.is_finite());
        let strictly = sizes.windows(2).all(|w| w[1] > w[0]) && sizes.first().is_some_and(|d| *d > 0.0);
        if sizes.len() < 2 || !strictly || !rising(&sizes) || !rising(&passing) {
            return Err(wrong("is no sieve curve".to_owned()));
        }
        if passing[0] != 0.0 || !(whole == 1.0 || whole == 100.0) {
            return Err(wrong(format!("passing goes from {} to {}", Shown(passing[0]), Shown(whole))));
        }
        let part = |k: usize| {
            let range = OneOrRange { low: scale * sizes[k], high: scale * sizes[k + 1] };
            let share = passing[k + 1] - passing[k];
            (share > 0.0).then_some(Part { range, of_curve: true, share, material: None })
        };
        Ok((0..sizes.len() - 1).filter_map(part).collect())
    }

    fn known(&self, plan: &PlanBuilder, table: &Table, keys: &[&str]) -> Result<()> {
        match table.keys().find(|key| !keys.contains(&key.as_str())) {
            Some(key) => Err(self.wrong(plan, key, &format!("is not known here: {}", keys.join(", ")))),
            None => Ok(()),
        }
    }

    /// `{ law = "log-normal", median = …, deviation = …, from = …, to = … }`, or `{ law = "rosin-rammler", size = …, spread = …, from = …, to = … }`
    fn law(&self, plan: &PlanBuilder, table: &Table) -> Result<Vec<Part>> {
        let needed = |key: &str| {
            table.get(key).ok_or_else(|| self.wrong(plan, &inline(table), &format!("'{key}' is missing")))
        };
        let length = |key: &str| self.length(plan, needed(key)?);
        let number = |key: &str| self.positive(plan, key, needed(key)?);
        let law = needed("law")?.as_str().unwrap_or_default();
        let smaller: Box<dyn Fn(f64) -> f64> = match law {
            "log-normal" => {
                self.known(plan, table, &["law", "median", "deviation", "from", "to"])?;
                let (median, deviation) = (length("median")?, number("deviation")?);
                let root = std::f64::consts::SQRT_2 * deviation;
                Box::new(move |d| 0.5 + 0.5 * libm::erf(libm::log(d / median) / root))
            }
            "rosin-rammler" => {
                self.known(plan, table, &["law", "size", "spread", "from", "to"])?;
                let (size, spread) = (length("size")?, number("spread")?);
                Box::new(move |d| -libm::expm1(-libm::pow(d / size, spread)))
            }
            other => {
                let why = "is no law of sizes: there are \"log-normal\" and \"rosin-rammler\"";
                return Err(self.wrong(plan, &format!("\"{other}\""), why));
            }
        };
        let range = OneOrRange { low: length("from")?, high: length("to")? };
        if range.low >= range.high {
            return Err(self.wrong(plan, &inline(table), "ends ('to') before it begins ('from')"));
        }
        let share = |range: &OneOrRange| smaller(range.high) - smaller(range.low);
        // Where hardly anything is there is no class: a narrow law is not spread by a wide range.
        let parts = edges(within(range, &smaller), CLASSES).map(|range| Part {
            share: share(&range),
            range,
            of_curve: true,
            material: None,
        });
        let parts: Vec<Part> = parts.filter(|part| part.share > 0.0).collect();
        let kept: f64 = parts.iter().map(|p| p.share).fold(0.0, |sum, share| sum + share);
        if kept < 0.5 {
            let why =
                format!("'from' and 'to' leave {:.3} % of the distribution, less than half", 100.0 * kept);
            let cure =
                "give a range that holds most of it, or the share of each size as [[diameter, share], …]";
            return Err(plan.check.wrong(&self.key("sizes"), inline(table), &why, cure));
        }
        Ok(parts)
    }
}

/// A table on one line, as it is in a scene.
fn inline(table: &Table) -> String {
    Value::from(table.clone()).to_string()
}

/// The part of a range outside of which the share `smaller` of a distribution changes by less than [`REST`].
fn within(range: OneOrRange, smaller: &dyn Fn(f64) -> f64) -> OneOrRange {
    let whole = smaller(range.high) - smaller(range.low);
    let at = |part: f64| {
        let (mut low, mut high) = (range.low, range.high);
        for _ in 0..100 {
            let middle = libm::sqrt(low * high);
            if smaller(middle) - smaller(range.low) < part * whole { low = middle } else { high = middle }
        }
        (low, high)
    };
    let OneOrRange { low, high } = OneOrRange { low: at(REST).0, high: at(1.0 - REST).1 };
    if low < high { OneOrRange { low, high } } else { range }
}

/// A range in parts of equal width in ln d.
fn edges(range: OneOrRange, count: usize) -> impl Iterator<Item = OneOrRange> {
    let ratio = range.high / range.low;
    let edge = move |k: usize| match k {
        0 => range.low,
        k if k == count => range.high,
        k => range.low * libm::pow(ratio, k as f64 / count as f64),
    };
    (0..count).map(move |k| OneOrRange { low: edge(k), high: edge(k + 1) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::grains::random::generator;

    /// Of 20 000 grains the share that passes any sieve is that of the distribution, cut off at both ends.
    #[test]
    fn a_distribution_is_drawn_to_a_thousandth() {
        [0.005, 0.05, 0.3].into_iter().for_each(drawn);
    }

    fn drawn(deviation: f64) {
        let median = 0.01;
        let root = std::f64::consts::SQRT_2 * deviation;
        let smaller = |d: f64| 0.5 + 0.5 * libm::erf(libm::log(d / median) / root);
        let range = OneOrRange { low: 0.004, high: 0.025 };
        for (by, spread) in [(ShareOf::Mass, Spread::Mass), (ShareOf::Number, Spread::Number)] {
            let class = |range: OneOrRange| {
                let share = smaller(range.high) - smaller(range.low);
                Class { range, spread, share, material: 0, density: 1000.0 }
            };
            let mut grading = Grading::new(edges(within(range, &smaller), CLASSES).map(class).collect(), by);
            let mut random = generator(0, 1, 0);
            let mut found: Vec<(f64, f64)> = Vec::new();
            for _ in 0..20_000 {
                let grain = grading.next(&mut random);
                grading.make(&grain);
                found.push((grain.diameter, if by == ShareOf::Mass { grain.mass } else { 1.0 }));
            }
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            let whole: f64 = found.iter().map(|g| g.1).sum();
            let (mut sum, mut worst) = (0.0, 0.0f64);
            for (diameter, weight) in found {
                sum += weight;
                let kept = smaller(range.high) - smaller(range.low);
                worst = worst.max((sum / whole - (smaller(diameter) - smaller(range.low)) / kept).abs());
            }
            assert!(worst < 2e-3, "deviation {deviation}, {by:?}: {worst}");
        }
    }
}
