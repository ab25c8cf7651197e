//! The box around all grains, and how much of them there is.
//!
//! The volume is that of the solid, mass over density: overlaps of grains count twice, those of the members of a rigid clump do not. Along a periodic axis the length
//! is that of the domain.

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::{Observer, OfFrame, PerFrame};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{Frame, MeasureError, Run};

/// Measures the box around all grains, their number, mass and volume.
#[derive(Default)]
pub struct Extent {
    last: Option<Row>,
}

impl OfFrame for Extent {
    fn heads(&self) -> Vec<Head> {
        let lengths = ["length_x", "length_y", "length_z", "low_x", "low_y", "low_z"].map(|name| (name, "m"));
        Head::list(
            &[&[("time", "s")], &lengths[..], &[("grains", "1"), ("mass", "kg"), ("solid", "m³")]].concat(),
        )
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        let (mut low, mut high) = frame.bounds();
        for (axis, range) in frame.periodic.range.iter().enumerate() {
            if let Some((from, to)) = range {
                (low[axis], high[axis]) = (*from, *to);
            }
        }
        let lengths = if frame.is_empty() { [f64::NAN; 3] } else { (high - low).into() };
        let corner: [f64; 3] = if frame.is_empty() { [f64::NAN; 3] } else { low.into() };
        let masses = frame.masses()?;
        let density = |material: &u16| run.densities.get(usize::from(*material)).copied().unwrap_or(f64::NAN);
        let grains = frame.body().into_iter().collect::<std::collections::HashSet<_>>().len();
        let solid: f64 = masses.iter().zip(&frame.material).map(|(mass, m)| mass / density(m)).sum();
        let counts = [grains as f64, masses.iter().sum(), solid];
        let row = [&[frame.time], &lengths[..], &corner[..], &counts[..]].concat();
        self.last = Some(row.clone());
        Ok(vec![row])
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let last = self.last.as_ref().filter(|row| row[7] > 0.0).ok_or(MeasureError::FewGrains {
            what: "the box around all grains",
            most: 0,
            wanted: 1,
        })?;
        let heads = [("length_x", "m", 1), ("length_y", "m", 2), ("length_z", "m", 3)];
        let more = [("grains", "1", 7), ("mass", "kg", 8), ("solid", "m³", 9), ("time", "s", 0)];
        let all = heads.iter().chain(&more);
        Ok((Vec::new(), all.fold(Summary::default(), |s, (name, unit, at)| s.with(name, unit, last[*at]))))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let parts = [("x", 1), ("y", 2), ("z", 3)];
        Chart::new("Extent").columns(("time [s]", 0), "length [m]", &parts, rows)
    }
}

impl Measure for Extent {
    const NAME: &'static str = "extent";
    const HELP: &'static str = "Box around all grains, their number, mass and volume of the solid";
    const FRAMES: Frames = Frames::Every;

    fn observer(_: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(PerFrame::new(Extent::default())))
    }
}
