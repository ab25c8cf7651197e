//! The energy ledger of a run, and how well it closes.
//!
//! ```text
//! balance = Σ terms − 2 (walls + entered + integration)        all terms count with +, these three with −
//! closure error = Σ Δ balance
//! ```
//!
//! over the intervals between ledgers; there the balance is constant to rounding. A run whose balance is not this sum is reported. Ledgers without that term leave out what particles bring along that
//! come and go, too: of those only intervals in which no grain enters or leaves count (by the ids of the frames). The energy that the finite time step created is the term `integration`, the error of the run's energy. Both are given
//! also relative to the energy exchanged so far: the largest change of any other term.

use crate::definition::{AskError, Asked, Figure, Frames, Measure, number};
use crate::observer::Observer;
use crate::run::Ledger;
use crate::sheet::{CURVES, Chart, Head, Row, Summary};
use crate::{MeasureError, Run, RunMessage};
use geom::{Shown, counted};

/// Terms in this order; what a run has besides follows by name.
const ORDER: [&str; 8] =
    ["translation", "rotation", "potential", "elastic", "normal", "sliding", "rolling", "walls"];

/// What the finite time step made.
const MADE: &str = "integration";
/// What was brought: these terms count with − in the balance, all others with +.
pub const BROUGHT: [&str; 3] = ["walls", "entered", MADE];
/// Rounding of the sum, relative to its largest term [–].
const ROUNDING: f64 = 1e-12;
/// What is under way at the instant of the ledger.
const HALF: &str = "half_step";

/// Number of grains, sum of their ids and of the squares of these: other grains give others.
type Grains = (usize, u64, u64);

impl Ledger {
    /// The sum of its terms, each with its sign [J].
    pub fn sum(&self) -> f64 {
        let signed =
            |(name, value): (&String, &f64)| if BROUGHT.contains(&name.as_str()) { -value } else { *value };
        self.terms.iter().map(signed).sum()
    }

    /// Whether the balance that the run holds is the sum of its terms.
    fn adds_up(&self) -> bool {
        let largest = self.terms.values().fold(self.balance.abs(), |most, value| most.max(value.abs()));
        (self.sum() - self.balance).abs() <= ROUNDING * largest * self.terms.len() as f64
    }
}

/// Reads the ledger.
pub struct Energy {
    terms: Vec<String>,
    first: Option<Ledger>,
    exchanged: f64,
    /// Largest that the step has made since the first ledger [J]; none in runs that do not tell.
    made: Option<f64>,
    error: f64,
    worst: f64,
    last: f64,
    /// Balance of the ledger before [J], and whose it was.
    before: Option<(f64, Grains)>,
    now: Grains,
    /// Intervals in which grains entered or left.
    left_out: u64,
    /// Time [s], balance and sum of terms [J] of the first ledger in which they differ.
    wrong: Option<[f64; 3]>,
}

impl Default for Energy {
    fn default() -> Energy {
        Energy::new()
    }
}

impl Energy {
    /// Nothing read yet.
    pub fn new() -> Energy {
        Energy {
            terms: ORDER.map(str::to_owned).to_vec(),
            first: None,
            exchanged: 0.0,
            made: None,
            error: 0.0,
            worst: 0.0,
            last: 0.0,
            before: None,
            now: Grains::default(),
            left_out: 0,
            wrong: None,
        }
    }

    fn row(&mut self, ledger: Ledger) -> Row {
        if !ledger.adds_up() {
            self.wrong.get_or_insert([ledger.time, ledger.balance, ledger.sum()]);
        }
        if self.first.is_none() {
            self.terms.retain(|term| ledger.terms.contains_key(term));
            self.terms.extend(ledger.terms.keys().filter(|k| !ORDER.contains(&k.as_str())).cloned());
            self.first = Some(ledger.clone());
        }
        let value = |l: &Ledger, term: &String| l.terms.get(term).copied().unwrap_or(0.0);
        if let Some(first) = &self.first {
            let made = |l: &Ledger| l.terms.get(MADE).copied();
            if let (Some(now), Some(then)) = (made(&ledger), made(first)) {
                self.made = Some((now - then).abs().max(self.made.unwrap_or(0.0)));
            }
            for term in self.terms.iter().filter(|t| *t != MADE && *t != HALF) {
                self.exchanged = self.exchanged.max((value(&ledger, term) - value(first, term)).abs());
            }
        }
        match self.before.replace((ledger.balance, self.now)) {
            // A ledger with the energy of the step also counts particles that come and go.
            Some((balance, grains)) if grains == self.now || self.made.is_some() => {
                self.error += ledger.balance - balance
            }
            Some(_) => self.left_out += 1,
            None => {}
        }
        self.worst = self.worst.max(self.error.abs());
        self.last = ledger.time;
        let relative = if self.exchanged > 0.0 { self.error / self.exchanged } else { f64::NAN };
        let mut row = vec![ledger.time];
        row.extend(self.terms.iter().map(|term| value(&ledger, term)));
        row.extend([ledger.balance, self.error, relative]);
        row
    }
}

impl Observer for Energy {
    fn heads(&self) -> Vec<Head> {
        let mut heads = Head::list(&[("time", "s")]);
        heads.extend(self.terms.iter().map(|name| Head { name: name.clone(), unit: "J" }));
        heads.extend(Head::list(&[("balance", "J"), ("closure_error", "J"), ("closure_relative", "1")]));
        heads
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        match message {
            RunMessage::Frame(frame) => {
                let sum = |of: fn(u64) -> u64| frame.id.iter().fold(0, |s: u64, id| s.wrapping_add(of(*id)));
                self.now = (frame.len(), sum(|id| id), sum(|id| id.wrapping_mul(id)));
            }
            RunMessage::Ledger(l) => rows.push(self.row(l)),
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.first.is_none() {
            let cure = "set [output] energy = true";
            return Err(MeasureError::Channel { topic: record::topic::ENERGY, what: "energy ledger", cure });
        }
        let summary = Summary::default()
            .with("closure_error", "J", self.error)
            .with("largest_closure_error", "J", self.worst)
            .with("exchanged", "J", self.exchanged)
            .with("largest_relative", "1", self.worst / self.exchanged)
            .with("time", "s", self.last);
        let summary = match self.made {
            None => summary,
            Some(made) => summary.with("largest_integration_error", "J", made).with(
                "largest_integration_relative",
                "1",
                made / self.exchanged,
            ),
        };
        let left_out = counted(self.left_out, "interval");
        let note = format!("{left_out} left out of the closure: grains entered or left");
        let summary = if self.left_out > 0 { summary.note(note) } else { summary };
        let wrong = self.wrong.map(|[time, balance, sum]| {
            let [time, balance, sum] = [time, balance, sum].map(Shown);
            format!("at {time} s the balance of the run is {balance} J, and its terms add up to {sum} J: write the run again")
        });
        Ok(wrong.into_iter().fold(summary, Summary::note))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let largest = |column: usize| rows.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
        let terms = self.terms.iter().enumerate().map(|(k, term)| (term.as_str(), k + 1));
        let mut terms: Vec<(&str, usize)> = terms.filter(|(_, column)| largest(*column) > 0.0).collect();
        terms.sort_by(|a, b| largest(b.1).total_cmp(&largest(a.1)));
        let mut chart = Chart::new("Energy");
        for (n, some) in terms.chunks(CURVES).enumerate() {
            let label = if n == 0 { "energy [J]" } else { "energy, smaller terms [J]" };
            chart = chart.columns(("time [s]", 0), label, some, rows);
        }
        chart.columns(("time [s]", 0), "closure error [J]", &[("", self.terms.len() + 2)], rows)
    }
}

impl Measure for Energy {
    const NAME: &'static str = "energy";
    const HELP: &'static str = "The energy ledger and how well it closes";
    const FRAMES: Frames = Frames::OverTime;
    const FIGURES: &'static [Figure] = &[number("energy-error", "largest_integration_relative")];

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::<Energy>::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::Panel;
    use std::collections::BTreeMap;

    /// Terms that are 0 have no curve, and no panel has two curves of one colour.
    #[test]
    fn curves_of_a_panel_have_colours_of_their_own() {
        let names: Vec<String> = (0..20).map(|k| format!("term{k}")).collect();
        let mut energy = Energy::new();
        energy.terms = names;
        let row = |time: f64| {
            let terms = (0..20).map(|k| if k < 11 { f64::from(k) * time } else { 0.0 });
            [time].into_iter().chain(terms).chain([0.0; 3]).collect::<Row>()
        };
        let chart = energy.chart(&[row(0.0), row(1.0)]);
        let curves = |panel: &Panel| match panel {
            Panel::Curves { curves, .. } => curves.iter().map(|c| c.name.clone()).collect::<Vec<_>>(),
            Panel::Map { .. } => Vec::new(),
        };
        let found: Vec<Vec<String>> = chart.panels.iter().map(curves).collect();
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [8, 2, 1]);
        assert_eq!((&*found[0][0], &*found[1][1]), ("term10", "term1"));
    }

    fn ledger(balance: f64) -> Ledger {
        let terms =
            [("translation", 5.0), ("sliding", 2.0), ("walls", 1.5), ("entered", 0.25), ("integration", 0.5)];
        let terms =
            terms.into_iter().map(|(name, value)| (name.to_owned(), value)).collect::<BTreeMap<_, _>>();
        Ledger { time: 0.5, terms, balance }
    }

    #[test]
    fn the_balance_is_the_sum_of_its_terms_with_their_signs() {
        assert_eq!(ledger(0.0).sum(), 5.0 + 2.0 - 1.5 - 0.25 - 0.5);
        let notes = |balance: f64| {
            let (mut energy, mut rows) = (Energy::new(), Vec::new());
            energy.observe(&Run::default(), RunMessage::Ledger(ledger(balance)), &mut rows).unwrap();
            energy.end(&Run::default(), &mut rows).unwrap().notes
        };
        assert!(notes(4.75).is_empty());
        let wrong = notes(9.25);
        assert!(wrong.len() == 1 && wrong[0].contains("9.25 J") && wrong[0].contains("4.75 J"), "{wrong:?}");
    }
}
