//! The domain of a plan: which axes are periodic, how long they are and what they follow.

use crate::error::Result;
use crate::input::{STRAIN_COLUMNS, read_domain, read_load};
use crate::keys::Strain;
use crate::plan::builder::PlanBuilder;
use dem::setup::{self, Target};

/// Lowest and highest coordinate [m] of each axis that is periodic.
type Ranges = [Option<(f64, f64)>; 3];

impl PlanBuilder<'_> {
    /// What a file says of the domain.
    fn domain_of_file(&self) -> Result<Option<Ranges>> {
        let source = self.keys().domain.source.as_ref();
        source.map(|source| self.file("domain.source", source, read_domain)).transpose()
    }

    /// Adds that to what the run is made from.
    pub(super) fn note_domain(&mut self) -> Result<()> {
        let read = self.domain_of_file()?;
        self.inputs.extend(read.map(|range| ("domain".to_owned(), format!("{range:?}"))));
        Ok(())
    }

    /// Lowest and highest coordinate [m] of each axis that is periodic.
    pub(super) fn periodic(&self) -> Result<Ranges> {
        let domain = self.keys().domain.clone();
        let mut periodic = [None; 3];
        let read = self.domain_of_file()?;
        for axis in &domain.periodic {
            let a = *axis as usize;
            if let (Some(range), Some(source)) = (&read, &domain.source) {
                periodic[a] = range[a];
                if range[a].is_none() {
                    let why = format!("has a domain that is not periodic along {axis:?}");
                    let cure = "take the axis out of domain.periodic, or give low and high instead";
                    return Err(self.check.wrong("domain.source", format!("\"{source}\""), &why, cure));
                }
                continue;
            }
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
        let given = if domain.source.is_some() { "(source)" } else { "(low, high)" };
        let corners = domain.low.is_some() || domain.high.is_some() || domain.source.is_some();
        if domain.periodic.is_empty() && corners {
            let why = "no axis is periodic, and a domain does not hold particles back";
            let cure = "add periodic = [\"x\"], or a [[wall]] with box";
            return Err(self.check.wrong("domain", given, why, cure));
        }
        Ok(periodic)
    }

    /// What each axis follows.
    pub(super) fn strain(&mut self) -> Result<[Option<setup::Strain>; 3]> {
        let strains = self.keys().domain.strain.clone();
        let mut all = [const { None }; 3];
        for (a, (axis, strain)) in strains.axes().into_iter().enumerate() {
            if let Some(strain) = strain {
                all[a] = Some(self.strain_of(&format!("domain.strain.{axis}"), strain)?);
            }
        }
        Ok(all)
    }

    fn strain_of(&mut self, entry: &str, strain: &Strain) -> Result<setup::Strain> {
        if let Some(rate) = strain.rate {
            return Ok(setup::Strain::Rate(rate));
        }
        let (target, of_stress) = match &strain.path {
            None => (Target::constant(strain.stress.unwrap_or(0.0)), true),
            Some(path) => {
                let (at, value) = (format!("{entry}.path.source"), format!("\"{}\"", path.source));
                let (rows, column, hash) =
                    self.file(&at, &path.source, |file| read_load(file, &STRAIN_COLUMNS))?;
                self.inputs.push(("strain".to_owned(), hash));
                (self.target(&at, &value, rows)?, column == 1)
            }
        };
        match (of_stress, strain.rate_limit) {
            (true, Some(rate_limit)) => Ok(setup::Strain::Stress { target, rate_limit }),
            (true, None) => self.check.rate_limit_is_missing(entry),
            (false, None) => self.path_from_zero(entry, strain, target),
            (false, Some(_)) => {
                let why = "limits the rate with which a stress is followed, and the file gives strains";
                Err(self.check.wrong(&format!("{entry}.rate_limit"), "(with strains)", why, "take it out"))
            }
        }
    }

    /// Strain counts from the corners that the scene gives.
    fn path_from_zero(&self, entry: &str, strain: &Strain, target: Target) -> Result<setup::Strain> {
        let first = target.at(0.0);
        if first == 0.0 {
            return Ok(setup::Strain::Path(target));
        }
        let source = strain.path.as_ref().map_or("", |path| path.source.as_str());
        let why = format!("has a strain of {} at t = 0, and strain counts from there", geom::Shown(first));
        let cure = "begin with a strain of 0";
        Err(self.check.wrong(&format!("{entry}.path.source"), format!("\"{source}\""), &why, cure))
    }

    /// A table over time.
    pub(super) fn target(&self, at: &str, value: &str, rows: Vec<[f64; 2]>) -> Result<Target> {
        Target::new(rows).ok_or_else(|| {
            let why = "has no rows, times that do not increase, or a value that is not finite";
            self.check.wrong(at, value, why, "give t in ascending order, one row for each time")
        })
    }
}
