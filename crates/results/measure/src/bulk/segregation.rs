//! How well two kinds of grains are mixed.
//!
//! Lacey (1954), J. Appl. Chem. 4, DOI 10.1002/jctb.5010040504: the variance of the share p of one kind between cells,
//! on the scale from fully segregated (0) to randomly mixed (1),
//!
//! ```text
//! M = (σ₀² − σ²) / (σ₀² − σᵣ²)       σ² = Σ n_c (p_c − p)² / N      σ₀² = p (1 − p)      σᵣ² = p (1 − p)(C − 1)/(N − 1)
//! ```
//!
//! with n_c grains in cell c of C cells that hold any, N in all. Deviation from Lacey, whose samples are equal: cells
//! weigh by their grains, and σᵣ² is the exact mean of σ² when the kinds are dealt at random (the hypergeometric
//! variance p (1 − p)(N − n_c)/(n_c (N − 1)), summed), whatever the n_c are. M depends on the size of the cells, which is reported: 3 mean diameters unless given.
//!
//! The difference of the centres of mass of the kinds along an axis, over half of the bed's height,
//! S = (z_A − z_B) / (H/2), H = √12 · deviation of z (mass-weighted): 0 mixed, 1 all of A above all of B.

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::geometry::cells::cell_of;
use crate::observer::{Observer, PerFrame};
use crate::observer::{OfFrame, undefined};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::median;
use crate::{Frame, MeasureError, Run};
use geom::Vec3;
use std::collections::BTreeMap;

/// What the two kinds are.
#[derive(Debug, Clone, PartialEq)]
pub enum Kinds {
    /// Grains larger than this diameter [m], and the others; `None`: the median of the first frame.
    Size(Option<f64>),
    /// Grains of this material, by name, and the others.
    Material(String),
}

/// Degrees of mixing at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mixing {
    /// Lacey's index M [–].
    pub lacey: f64,
    /// Difference of the centres of mass S [–].
    pub difference: f64,
    /// Share of the first kind by number, p [–].
    pub share: f64,
    /// Cells that hold grains.
    pub cells: usize,
    /// Grains a cell.
    pub per_cell: f64,
}

/// How mixed the grains `first` are with the others, in cubes of side `cell` [m].
///
/// # Errors
/// A material without density; only one kind of grains.
pub fn mixing(frame: &Frame, first: &[bool], cell: f64, up: &Vec3) -> Result<Mixing, MeasureError> {
    let masses = frame.masses()?;
    let mut counts: BTreeMap<[i64; 3], [u64; 2]> = BTreeMap::new();
    let mut moments = [[0.0; 2]; 2];
    for ((p, is_first), m) in frame.position.iter().zip(first).zip(masses) {
        let key = cell_of(p, cell)?;
        let kind = usize::from(!*is_first);
        counts.entry(key).or_default()[kind] += 1;
        let z = p.dot(up);
        moments[kind][0] += m;
        moments[kind][1] += m * z;
    }
    let n = frame.len() as f64;
    let share = first.iter().filter(|f| **f).count() as f64 / n;
    if !(share > 0.0 && share < 1.0) {
        let kind = if share == 0.0 { "the second" } else { "the first" };
        let cure = "choose another --split, or --kind MATERIAL";
        return Err(MeasureError::OneKind { kind: kind.to_owned(), cure });
    }
    let off = |[a, b]: &[u64; 2]| {
        let all = (a + b) as f64;
        all * (*a as f64 / all - share) * (*a as f64 / all - share)
    };
    let variance = counts.values().map(off).sum::<f64>() / n;
    let apart = share * (1.0 - share);
    let mixed = apart * (counts.len() as f64 - 1.0) / (n - 1.0);
    let [a, b] = moments.map(|[m, mz]| mz / m);
    let mass: f64 = masses.iter().sum();
    let mean = (moments[0][1] + moments[1][1]) / mass;
    let spread = frame.position.iter().zip(masses).map(|(p, m)| m * (p.dot(up) - mean) * (p.dot(up) - mean));
    let height = (12.0 * spread.sum::<f64>() / mass).sqrt();
    Ok(Mixing {
        lacey: (apart - variance) / (apart - mixed),
        difference: 2.0 * (a - b) / height,
        share,
        cells: counts.len(),
        per_cell: n / counts.len() as f64,
    })
}

/// Measures the mixing of chosen frames.
pub struct Segregation {
    kinds: Kinds,
    cell: Option<f64>,
    axis: Option<Vec3>,
    last: Option<(Mixing, f64)>,
    most: usize,
    /// Why a frame of one kind was not measured.
    one_kind: Option<MeasureError>,
}

impl Segregation {
    /// Two kinds; cubes of side `cell` [m] (default: 3 mean diameters); along `axis` (default: against gravity, or z).
    ///
    /// # Errors
    /// A cell or a size not above zero.
    pub fn new(kinds: Kinds, cell: Option<f64>, axis: Option<Vec3>) -> Result<Segregation, MeasureError> {
        let split = if let Kinds::Size(size) = &kinds { *size } else { None };
        for (what, value) in [("cell", cell), ("split", split)] {
            if let Some(value) = value.filter(|v| !(*v > 0.0 && v.is_finite())) {
                return Err(MeasureError::Setting { what, value, unit: "m", cure: "give a length above 0" });
            }
        }
        Ok(Segregation {
            kinds,
            cell,
            axis: axis.map(|a| a.normalize()),
            last: None,
            most: 0,
            one_kind: None,
        })
    }

    fn first(&mut self, run: &Run, frame: &Frame) -> Result<Vec<bool>, MeasureError> {
        if let Kinds::Size(split @ None) = &mut self.kinds {
            let mut all: Vec<f64> = frame.radius.iter().map(|r| 2.0 * r).collect();
            *split = Some(median(&mut all));
        }
        match &self.kinds {
            Kinds::Size(split) => {
                Ok(frame.radius.iter().map(|r| split.is_none_or(|s| 2.0 * r > s)).collect())
            }
            Kinds::Material(name) => {
                let index = run.materials.iter().position(|m| m == name);
                let missing = || MeasureError::Name { name: name.clone(), has: run.materials.clone() };
                let index = index.ok_or_else(missing)?;
                Ok(frame.material.iter().map(|m| usize::from(*m) == index).collect())
            }
        }
    }
}

impl OfFrame for Segregation {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("lacey_index", "1"),
            ("centre_difference", "1"),
            ("share", "1"),
            ("cells", "1"),
            ("grains_per_cell", "1"),
        ])
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        let frame = frame.grains();
        self.most = self.most.max(frame.len());
        if frame.len() < 2 {
            return Ok(vec![undefined(&self.heads(), frame.time)]);
        }
        let first = self.first(run, frame)?;
        let cell = *self.cell.get_or_insert(3.0 * frame.mean_diameter());
        let up = self.axis.or(run.up).unwrap_or(Vec3::z());
        let m = match mixing(frame, &first, cell, &up) {
            Ok(m) => m,
            // The other kind may come later.
            Err(why @ MeasureError::OneKind { .. }) => {
                self.one_kind = Some(why);
                return Ok(vec![undefined(&self.heads(), frame.time)]);
            }
            Err(other) => return Err(other),
        };
        self.last = Some((m, frame.time));
        Ok(vec![vec![frame.time, m.lacey, m.difference, m.share, m.cells as f64, m.per_cell]])
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let few = MeasureError::FewGrains { what: "mixing", most: self.most, wanted: 2 };
        let (m, time) = self.last.ok_or_else(|| self.one_kind.take().unwrap_or(few))?;
        let mut summary = Summary::default()
            .with("lacey_index", "1", m.lacey)
            .with("centre_difference", "1", m.difference)
            .with("time", "s", time)
            .with("cell", "m", self.cell.unwrap_or(f64::NAN));
        if let Kinds::Size(Some(split)) = self.kinds {
            summary = summary.with("split", "m", split);
        }
        Ok((Vec::new(), summary))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let both = [("Lacey's index", 1), ("difference of centres", 2)];
        Chart::new("Mixing").columns(("time [s]", 0), "index [1]", &both, rows)
    }
}

impl Measure for Segregation {
    const NAME: &'static str = "segregation";
    const HELP: &'static str =
        "How well two kinds of grains are mixed: Lacey's index, difference of the centres of mass";
    const FRAMES: Frames = Frames::Every;
    const OPTIONS: &'static [&'static str] = &["up", "cell", "split", "kind"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let kinds = asked.kind.clone().map_or(Kinds::Size(asked.split), Kinds::Material);
        Ok(Box::new(PerFrame::new(Segregation::new(kinds, asked.cell, asked.up)?)))
    }
}
