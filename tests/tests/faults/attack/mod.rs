//! An attack on the tools as programs: damaged files, absurd values for every key and option, killed partners of a pipe.
//!
//! Each case is one call with bounded memory and time ([`case`]). `make -C pipelines attack` runs tens of thousands of them and writes
//! docs/reliability.md; the test runs a short form with another seed. A seed gives the same cases on every machine.

pub mod case;
pub mod files;
pub mod kills;
pub mod mutate;
pub mod options;
pub mod scenes;
pub mod values;

use case::{Case, Outcome, Verdict};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// How often each outcome came, for one kind of case.
pub type Totals = BTreeMap<Outcome, usize>;

/// What an attack found.
#[derive(Default)]
pub struct Findings {
    /// Outcomes by kind of case.
    pub totals: BTreeMap<&'static str, Totals>,
    /// Cases with a bad outcome.
    pub bad: Vec<(String, Verdict)>,
}

impl Findings {
    /// Runs cases, several at a time.
    pub fn run(&mut self, cases: Vec<Case>) {
        let verdicts: Vec<(Case, Verdict)> = cases.into_par_iter().map(|c| c.run()).collect();
        for (case, verdict) in verdicts {
            self.add(case.group, case.to_string(), verdict);
        }
    }

    /// Counts one outcome.
    pub fn add(&mut self, group: &'static str, name: String, verdict: Verdict) {
        *self.totals.entry(group).or_default().entry(verdict.outcome).or_default() += 1;
        if verdict.outcome.is_bad() {
            self.bad.push((name, verdict));
        }
    }

    /// Number of cases.
    pub fn count(&self) -> usize {
        self.totals.values().flat_map(Totals::values).sum()
    }
}
