//! A parameter: bounds, scale and prior.
//!
//! Everything behind the recipe works on a coordinate z from 0 to 1 between the bounds, linear in the value or in its logarithm:
//!
//! ```text
//! lin:  v = a + z (b − a)        log:  v = a (b/a)^z
//! ```

use super::blanks::rounded;

/// What is known before the tests.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prior {
    /// Even in z.
    Uniform,
    /// Normal in z, cut at the bounds.
    Normal {
        /// Mean in z [–].
        mean: f64,
        /// Deviation in z [–].
        deviation: f64,
    },
}

/// Something to be found.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name: the blank of the commands.
    pub name: String,
    /// Unit, as text; "" for none.
    pub unit: String,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// Whether it is spread evenly in its logarithm.
    pub log: bool,
    /// What is known before.
    pub prior: Prior,
    /// Where the prior comes from.
    pub source: Option<String>,
    /// Value until a step fits it.
    pub start: f64,
}

impl Parameter {
    /// The value at a coordinate, with the digits that a command gets.
    pub fn value(&self, z: f64) -> f64 {
        rounded(self.exact(z))
    }

    fn exact(&self, z: f64) -> f64 {
        if self.log {
            self.low * libm::pow(self.high / self.low, z)
        } else {
            self.low + z * (self.high - self.low)
        }
    }

    /// The coordinate of a value.
    pub fn coordinate(&self, value: f64) -> f64 {
        if self.log {
            libm::log(value / self.low) / libm::log(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Logarithm of the prior's density in z, up to a constant.
    pub fn log_prior(&self, z: f64) -> f64 {
        match self.prior {
            Prior::Uniform => 0.0,
            Prior::Normal { mean, deviation } => -0.5 * ((z - mean) / deviation).powi(2),
        }
    }

    /// The coordinate below which a share of the prior lies.
    pub fn prior_quantile(&self, share: f64) -> f64 {
        match self.prior {
            Prior::Uniform => share,
            Prior::Normal { mean, deviation } => {
                let below = |z: f64| normal_below((z - mean) / deviation);
                let (first, last) = (below(0.0), below(1.0));
                let wanted = first + share * (last - first);
                let (mut a, mut b) = (0.0, 1.0);
                for _ in 0..60 {
                    let middle = 0.5 * (a + b);
                    if below(middle) < wanted { a = middle } else { b = middle }
                }
                0.5 * (a + b)
            }
        }
    }

    /// ` Pa`, or nothing.
    pub fn unit_suffix(&self) -> String {
        if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) }
    }
}

/// Share of the standard normal distribution below x.
pub(crate) fn normal_below(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(log: bool, prior: Prior) -> Parameter {
        let (name, unit) = ("young".to_owned(), "Pa".to_owned());
        Parameter { name, unit, low: 1e6, high: 1e8, log, prior, source: None, start: 1e7 }
    }

    #[test]
    fn coordinates_go_both_ways() {
        for log in [false, true] {
            let p = parameter(log, Prior::Uniform);
            for z in [0.0, 0.3, 1.0] {
                assert!((p.coordinate(p.value(z)) - z).abs() < 1e-8, "{log} {z}");
            }
        }
        assert_eq!(parameter(true, Prior::Uniform).value(0.5), 1e7);
    }

    #[test]
    fn quantiles_of_a_cut_normal_prior_stay_inside() {
        let p = parameter(false, Prior::Normal { mean: 0.0, deviation: 0.1 });
        // Half of the upper half of a normal distribution lies below 0.6745 deviations.
        assert!((p.prior_quantile(0.5) - 0.067449).abs() < 1e-5, "{}", p.prior_quantile(0.5));
        assert_eq!(parameter(false, Prior::Uniform).prior_quantile(0.05), 0.05);
    }
}
