//! An attack on the tools as programs: damaged files, absurd values for every key and option, too little memory, signals, modes of files, hostile names, changed inputs, what
//! messages say to do, killed partners of a pipe.
//!
//! Each case is one call with bounded memory and time ([`case`]). `make -C pipelines attack` runs tens of thousands of them and writes
//! docs/evidence/reliability.md; the test runs a short form with another seed. A seed gives the same cases on every machine.

pub mod caches;
pub mod case;
#[allow(dead_code)]
#[path = "../../tools/every_option/files.rs"]
pub mod example_files;
#[allow(dead_code)]
#[path = "../../tools/every_key/scenes.rs"]
pub mod example_scenes;
#[allow(dead_code)]
#[path = "../../tools/every_option/examples.rs"]
pub mod examples;
pub mod files;
pub mod folders;
pub mod kills;
pub mod limits;
pub mod modes;
pub mod mutate;
pub mod names;
pub mod options;
pub mod remedies;
pub mod scenes;
pub mod signals;
pub mod silent;
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

    /// Counts verdicts of one kind of case.
    pub fn all(&mut self, group: &'static str, verdicts: Vec<(String, Verdict)>) {
        verdicts.into_iter().for_each(|(name, verdict)| self.add(group, name, verdict));
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

    /// A Markdown table: a row for each kind of case, a column for each outcome.
    pub fn table(&self) -> String {
        let titles = "accepted | refused | panic | killed | too long | no message | half output | not finite | raw text | silent | unquoted | no remedy | stale";
        let mut table =
            format!("| what | cases | {titles} |\n|---|{}\n", "---:|".repeat(Outcome::ALL.len() + 1));
        for (group, totals) in &self.totals {
            let cells = Outcome::ALL.map(|o| totals.get(&o).copied().unwrap_or(0).to_string());
            table += &format!("| {group} | {} | {} |\n", totals.values().sum::<usize>(), cells.join(" | "));
        }
        table
    }

    /// Two lines for each bad case: the call and the message.
    pub fn list(&self) -> String {
        let line = |(name, verdict): &(String, Verdict)| {
            format!("{:?}: {name}\n    {}\n", verdict.outcome, verdict.message)
        };
        self.bad.iter().map(line).collect()
    }
}
