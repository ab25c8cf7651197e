//! Checks of the domain and of what its axes follow.

use super::Check;
use crate::error::Result;
use crate::keys::{Domain, SceneKeys, Strain};

impl Check<'_> {
    pub(super) fn domain(&self, m: &SceneKeys) -> Result<()> {
        let Domain { periodic, low, high, source, strain, outside: _ } = &m.domain;
        for (key, corner) in [("domain.low", low), ("domain.high", high)] {
            if let (Some(source), Some(_)) = (source, corner) {
                let why = format!("source = \"{source}\" gives the corners already");
                return Err(self.wrong(key, "(with source)", &why, "take one of them out"));
            }
        }
        let mut sides = low.iter().flatten().zip(high.iter().flatten());
        if let Some((low, high)) = sides.find(|(low, high)| low > high) {
            let why = format!("is below low, {low} m");
            return Err(self.wrong("domain.high", format!("{high} m"), &why, "swap them"));
        }
        for (axis, strain) in strain.axes() {
            let Some(strain) = strain else { continue };
            if !periodic.iter().any(|a| format!("{a:?}").eq_ignore_ascii_case(axis)) {
                let cure = format!("add \"{axis}\" to domain.periodic, or take it out");
                return Err(self.wrong(
                    &format!("domain.strain.{axis}"),
                    "(open axis)",
                    "the axis is not periodic",
                    &cure,
                ));
            }
            self.strain(&format!("domain.strain.{axis}"), strain)?;
        }
        Ok(())
    }

    fn strain(&self, entry: &str, s: &Strain) -> Result<()> {
        let key = |k: &str| format!("{entry}.{k}");
        let of = [("rate", s.rate.is_some()), ("stress", s.stress.is_some()), ("path", s.path.is_some())];
        self.one_of(entry, &of)?;
        if s.rate == Some(0.0) {
            let why = "leaves the axis as it is";
            return Err(self.wrong(&key("rate"), "0 1/s", why, &format!("take {entry} out")));
        }
        if let Some(stress) = s.stress.filter(|stress| *stress < 0.0) {
            let why = "pulls, and compression is positive";
            return Err(self.wrong(
                &key("stress"),
                format!("{stress} Pa"),
                why,
                "give 0 or more, or stretch the axis by a negative rate",
            ));
        }
        if s.rate_limit.is_some() {
            if s.rate.is_some() {
                let why = "limits the rate with which a stress is followed, and rate gives it";
                return Err(self.wrong(&key("rate_limit"), "(with rate)", why, "take one of them out"));
            }
        } else if s.stress.is_some() {
            return self.rate_limit_is_missing(entry);
        }
        Ok(())
    }

    /// A stress is followed no faster than a rate that the scene gives.
    pub(crate) fn rate_limit_is_missing<T>(&self, entry: &str) -> Result<T> {
        let why = "a stress is followed no faster than this";
        Err(self.wrong(
            &format!("{entry}.rate_limit"),
            "(missing)",
            why,
            "give the largest rate of strain, such as \"1 1/s\"",
        ))
    }
}
