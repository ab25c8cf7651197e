//! `[domain]`: axes along which the domain is periodic.

use super::builder::PlanBuilder;
use crate::error::SceneError;

impl PlanBuilder<'_> {
    /// Lowest and highest coordinate [m] of each axis that is periodic.
    pub(super) fn periodic(&self) -> Result<[Option<(f64, f64)>; 3], SceneError> {
        let domain = &self.keys().domain;
        let mut periodic = [None; 3];
        for axis in &domain.periodic {
            let a = *axis as usize;
            let (Some(low), Some(high)) = (domain.low, domain.high) else {
                let why = "needs the corners of the domain";
                let cure = "add low and high, in metres";
                return Err(self.check.wrong("domain.periodic", format!("{axis:?}"), why, cure));
            };
            if low[a].is_nan() || high[a].is_nan() || low[a] >= high[a] {
                let value = format!("{} m", high[a]);
                let cure = "swap them, or widen the domain";
                return Err(self.check.wrong("domain.high", value, "is not above low", cure));
            }
            periodic[a] = Some((low[a], high[a]));
        }
        if domain.periodic.is_empty() && (domain.low.is_some() || domain.high.is_some()) {
            let why = "no axis is periodic, and a domain does not hold particles back";
            let cure = "add periodic = [\"x\"], or a [[wall]] with box";
            return Err(self.check.wrong("domain", "(low, high)", why, cure));
        }
        Ok(periodic)
    }
}
