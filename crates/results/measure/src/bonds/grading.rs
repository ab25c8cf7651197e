//! Fragments and grading: what bonds leave of stones.
//!
//! ```text
//! B_g = Σ (ΔW_k > 0)          ΔW_k: share of the mass between two sieves, before less after
//! ```
//!
//! Marsal (1967), J. Soil Mech. Found. Div. ASCE 93(SM2): the sum of what the classes lost; 0 where nothing broke.

use super::pieces::{Piece, pieces};
use super::{Bonds, NO_BONDS};
use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::Observer;
use crate::sheet::{Chart, Curve, Head, Look, Row, Summary};
use crate::{Frame, MeasureError, Run, RunMessage};

/// The fragments of the first and of the last frame.
#[derive(Default)]
struct Ends {
    frame: Option<Frame>,
    first: Option<(f64, Vec<Piece>)>,
    last: Option<(f64, Vec<Piece>)>,
}

impl Ends {
    /// Frames come before the bonds of their time.
    fn take(&mut self, message: RunMessage) -> Result<(), MeasureError> {
        match message {
            RunMessage::Frame(frame) => self.frame = Some(frame),
            RunMessage::Bonds(bonds) => self.look(&bonds)?,
            _ => {}
        }
        Ok(())
    }

    fn look(&mut self, bonds: &Bonds) -> Result<(), MeasureError> {
        let time = bonds.time;
        let Some(frame) = self.frame.as_ref().filter(|f| f.time == time) else { return Ok(()) };
        let now = (time, pieces(frame, bonds, frame.periodic.lengths())?);
        if self.first.is_none() {
            self.first = Some(now.clone());
        }
        self.last = Some(now);
        Ok(())
    }

    /// The first and the last.
    fn both(&self) -> Result<[&(f64, Vec<Piece>); 2], MeasureError> {
        Ok([self.first.as_ref().ok_or(NO_BONDS)?, self.last.as_ref().ok_or(NO_BONDS)?])
    }
}

/// Lists the fragments of the last frame.
#[derive(Default)]
pub struct FragmentList(Ends);

impl Observer for FragmentList {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("id", "1"),
            ("grains", "1"),
            ("mass", "kg"),
            ("diameter", "m"),
            ("length", "m"),
            ("intermediate", "m"),
            ("shortest", "m"),
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
        ])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, _: &mut Vec<Row>) -> Result<(), MeasureError> {
        self.0.take(message)
    }

    fn end(&mut self, _: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let [_, (time, pieces)] = self.0.both()?;
        let row = |p: &Piece| {
            let [long, middle, short] = p.extents;
            let [x, y, z] = p.centre.into();
            vec![*time, p.id as f64, p.grains as f64, p.mass, p.diameter(), long, middle, short, x, y, z]
        };
        rows.extend(pieces.iter().map(row));
        let joined = pieces.iter().filter(|p| p.grains > 1);
        let largest = pieces.iter().map(|p| p.mass).fold(0.0, f64::max);
        Ok(Summary::default()
            .with("fragments", "1", pieces.len() as f64)
            .with("of_several_grains", "1", joined.count() as f64)
            .with("largest_mass", "kg", largest)
            .with("mass", "kg", pieces.iter().map(|p| p.mass).sum())
            .with("time", "s", *time))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let points = rows.iter().map(|row| [row[4], row[3]]).collect();
        let curve = Curve { name: String::new(), points, look: Look::Dots };
        Chart::new("Fragments").curves("diameter [m]", "mass [kg]", vec![curve])
    }
}

/// Compares gradings: before and after.
pub struct Grading {
    ends: Ends,
    sieves: Option<Vec<f64>>,
}

/// Ratio of a sieve to the next smaller one, where none are given.
const STEP: f64 = std::f64::consts::SQRT_2;
/// So many at most.
const SIEVES: usize = 40;

impl Grading {
    /// Of the first and the last frame, on sieves of these openings [m], the smallest first; `None`: from the largest piece down, each smaller
    /// by √2.
    pub fn new(sieves: Option<Vec<f64>>) -> Grading {
        Grading { ends: Ends::default(), sieves }
    }

    fn openings(&self, both: [&[Piece]; 2]) -> Vec<f64> {
        if let Some(sieves) = &self.sieves {
            return sieves.clone();
        }
        let sizes = || both.into_iter().flatten().map(|p| p.extents[1]);
        let (smallest, largest) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
        let sieve = |k: usize| largest * (1.0 + 1e-9) / STEP.powi(k as i32);
        let mut all: Vec<f64> = (0..SIEVES).map(sieve).take_while(|s| *s * STEP > smallest).collect();
        all.reverse();
        all
    }
}

/// Share of the mass that passes each sieve by its intermediate extent.
fn passing(pieces: &[Piece], sieves: &[f64]) -> Vec<f64> {
    let all: f64 = pieces.iter().map(|p| p.mass).sum();
    let below = |opening: f64| pieces.iter().filter(|p| p.extents[1] <= opening).map(|p| p.mass).sum::<f64>();
    sieves.iter().map(|sieve| below(*sieve) / all).collect()
}

/// Marsal's B_g of two gradings on the same sieves; what stays on the largest is a class, too.
pub fn breakage(before: &[f64], after: &[f64]) -> f64 {
    let classes = |passing: &[f64]| -> Vec<f64> {
        let ends = std::iter::once(0.0).chain(passing.iter().copied());
        ends.zip(passing.iter().copied().chain([1.0])).map(|(low, high)| high - low).collect()
    };
    let lost = classes(before).into_iter().zip(classes(after)).map(|(b, a)| (b - a).max(0.0));
    lost.sum()
}

impl Observer for Grading {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[("sieve", "m"), ("passing_before", "1"), ("passing_after", "1")])
    }

    fn observe(&mut self, _: &Run, message: RunMessage, _: &mut Vec<Row>) -> Result<(), MeasureError> {
        self.ends.take(message)
    }

    fn end(&mut self, _: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        let [(start, first), (end, last)] = self.ends.both()?;
        let sieves = self.openings([first, last]);
        let (before, after) = (passing(first, &sieves), passing(last, &sieves));
        rows.extend((0..sieves.len()).map(|k| vec![sieves[k], before[k], after[k]]));
        let summary = Summary::default()
            .with("breakage", "1", breakage(&before, &after))
            .with("fragments_before", "1", first.len() as f64)
            .with("fragments_after", "1", last.len() as f64)
            .with("before", "s", *start)
            .with("after", "s", *end);
        let same = start == end;
        Ok(if same {
            summary.note("one frame: nothing is compared; use --from and --until")
        } else {
            summary
        })
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let both = [("before", 1), ("after", 2)];
        Chart::new("Grading").columns(("sieve [m]", 0), "passing [1]", &both, rows)
    }
}

impl Measure for FragmentList {
    const NAME: &'static str = "fragments";
    const HELP: &'static str = "Mass and size of each piece that whole bonds hold together";
    const FRAMES: Frames = Frames::One;

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::<FragmentList>::default())
    }
}

impl Measure for Grading {
    const NAME: &'static str = "grading";
    const HELP: &'static str =
        "Share of the mass that passes sieves before and after, by pieces, and Marsal's breakage";
    const FRAMES: Frames = Frames::OverTime;
    const OPTIONS: &'static [&'static str] = &["sieves"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(Grading::new(asked.sieves.clone())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn breakage_is_what_the_classes_lost() {
        // Half of what was on the largest sieve went to the smallest class.
        assert!((breakage(&[0.0, 0.4, 0.6], &[0.2, 0.6, 0.8]) - 0.2).abs() < 1e-12);
        assert_eq!(breakage(&[0.1, 0.5], &[0.1, 0.5]), 0.0);
    }
}
