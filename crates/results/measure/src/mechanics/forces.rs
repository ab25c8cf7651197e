//! How contact forces are distributed: histogram of normal and tangential forces over their means.
//!
//! f = F/⟨F⟩; bars of width 0.2 up to 8, and one for all above; as density P(f), whose integral is 1, as usual since
//! Mueth, Jaeger & Nagel (1998), Phys. Rev. E 57, DOI 10.1103/PhysRevE.57.3164.

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::{NO_CONTACTS, Observer};
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::{Contacts, MeasureError, Partner, Run, RunMessage};

const WIDTH: f64 = 0.2;
const BARS: usize = 40;

/// Forces of contacts, over their means.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// Contacts.
    pub count: usize,
    /// Mean [N].
    pub mean: f64,
    /// Largest [N].
    pub largest: f64,
    /// Contacts in each bar of width 0.2, then those above 8.
    pub bars: Vec<u64>,
}

impl Distribution {
    /// Of magnitudes [N].
    pub fn of(forces: &[f64]) -> Distribution {
        let mean = forces.iter().sum::<f64>() / forces.len() as f64;
        let mut bars = vec![0; BARS + 1];
        // Of forces that are all 0, as frictions of a frictionless run are, there is no distribution.
        for f in forces.iter().filter(|_| mean > 0.0) {
            bars[((f / mean / WIDTH) as usize).min(BARS)] += 1;
        }
        Distribution { count: forces.len(), mean, largest: forces.iter().copied().fold(0.0, f64::max), bars }
    }

    /// P(f) of a bar; NaN for the last one, which has no end, and where all forces are 0.
    pub fn density(&self, bar: usize) -> f64 {
        if bar >= BARS || self.mean <= 0.0 {
            f64::NAN
        } else {
            self.bars[bar] as f64 / (self.count as f64 * WIDTH)
        }
    }
}

/// Normal and tangential magnitudes [N] of the contacts that are wanted.
pub fn magnitudes(contacts: &Contacts, walls: bool) -> [Vec<f64>; 2] {
    let wanted = contacts.acting().filter(|c| matches!(c.partner, Partner::Wall(_)) == walls);
    wanted
        .map(|c| {
            let normal = c.force.dot(&c.normal);
            (normal.abs(), (c.force - c.normal * normal).norm())
        })
        .unzip::<f64, f64, Vec<f64>, Vec<f64>>()
        .into()
}

/// Measures the distribution of forces between grains, or on walls.
pub struct Forces {
    walls: bool,
    last: Option<[Distribution; 2]>,
    contact_frames: u64,
}

impl Forces {
    /// Of the contacts between grains, or with walls.
    pub fn new(walls: bool) -> Forces {
        Forces { walls, last: None, contact_frames: 0 }
    }

    fn measure(&mut self, contacts: &Contacts) -> Vec<Row> {
        let both = magnitudes(contacts, self.walls);
        if both[0].is_empty() {
            return Vec::new();
        }
        let [normal, tangential] = both.map(|f| Distribution::of(&f));
        let row = |k: usize| {
            let end = if k == BARS { f64::NAN } else { (k + 1) as f64 * WIDTH };
            let [n, t] = [&normal, &tangential].map(|d| (d.bars[k] as f64, d.density(k)));
            vec![contacts.time, k as f64 * WIDTH, end, n.0, n.1, t.0, t.1]
        };
        let rows = (0..=BARS).map(row).collect();
        self.last = Some([normal, tangential]);
        rows
    }
}

impl Observer for Forces {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("from", "1"),
            ("to", "1"),
            ("normal", "1"),
            ("normal_density", "1"),
            ("tangential", "1"),
            ("tangential_density", "1"),
        ])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, rows: &mut Vec<Row>) -> Result<(), MeasureError> {
        let RunMessage::Contacts(contacts) = message else { return Ok(()) };
        self.contact_frames += 1;
        rows.extend(self.measure(&contacts));
        Ok(())
    }

    fn end(&mut self, _: &Run, _: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.contact_frames == 0 {
            return Err(NO_CONTACTS);
        }
        let Some([normal, tangential]) = &self.last else {
            let note = "no contacts in these frames";
            return Ok(Summary::default().with("contacts", "1", 0.0).note(note));
        };
        Ok(Summary::default()
            .with("contacts", "1", normal.count as f64)
            .with("mean_normal", "N", normal.mean)
            .with("largest_normal", "N", normal.largest)
            .with("mean_tangential", "N", tangential.mean)
            .with("largest_tangential", "N", tangential.largest))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let rows = &rows[rows.len().saturating_sub(BARS + 1)..];
        let curve = |(name, column): (&str, usize)| Curve {
            name: name.to_owned(),
            points: rows.iter().take(BARS).map(|row| [row[1], row[column]]).collect(),
            look: Look::Steps,
        };
        let curves = [("normal", 4), ("tangential", 6)].map(curve).to_vec();
        let kind = if self.walls { "walls" } else { "grains" };
        Chart::new(format!("Forces between {}", if self.walls { "grains and walls" } else { kind })).curves(
            "force over mean force [1]",
            "density [1]",
            curves,
        )
    }
}

impl Measure for Forces {
    const NAME: &'static str = "forces";
    const HELP: &'static str = "Distribution of contact forces";
    const FRAMES: Frames = Frames::Last;
    const OPTIONS: &'static [&'static str] = &["on-walls"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(Forces::new(asked.on_walls)))
    }
}
