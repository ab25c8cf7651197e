//! Mean strain of grains since the first frame that is measured.
//!
//! ```text
//! x − x̄ ≈ F (X − X̄)                 least squares over the grains, by id; X: in the first frame
//! ε = −½ (H + Hᵀ),  H = F − 1        positive where the grains come closer; for small strains
//! ε_v = 1 − det F                    rest: root mean square of what F does not explain, Σ |x − x̄ − F (X − X̄)|²
//! ```
//!
//! In a periodic domain x is the image that the grain has come to since the first frame, by any number of periods of the domain as it is now.
//!
//! The fit of Falk & Langer (1998), Phys. Rev. E 57, doi:10.1103/PhysRevE.57.7192, over all grains at once.

use crate::definition::{AskError, Asked, Frames, Measure};
use crate::observer::{Observer, PerFrame};
use crate::observer::{OfFrame, undefined};
use crate::path::{Passage, unsure_note};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{Frame, MeasureError, Run};
use geom::{Shape, Vec3};
use nalgebra::Matrix3;
use std::collections::BTreeMap;

/// Fewest grains that a fit of twelve numbers makes sense for.
const FEWEST: usize = 5;

/// Strain at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// F [–].
    pub gradient: Matrix3<f64>,
    /// Root mean square of what it does not explain [m].
    pub rest: f64,
    /// Grains that are there in both frames.
    pub grains: usize,
}

impl Fit {
    /// From places before and displacements since [m]; `None` where there are too few, or all lie in a plane.
    pub fn of(places: &[Vec3], moved: &[Vec3]) -> Option<Fit> {
        let n = places.len() as f64;
        let mean = |all: &[Vec3]| all.iter().sum::<Vec3>() / n;
        let (centre, shift) = (mean(places), mean(moved));
        let both = || places.iter().zip(moved).map(|(x, u)| (x - centre, u - shift));
        let spread: Matrix3<f64> = both().map(|(x, _)| x * x.transpose()).sum();
        let shares: Matrix3<f64> = both().map(|(x, u)| u * x.transpose()).sum();
        let flat = spread.symmetric_eigenvalues().min() <= 1e-12 * spread.trace();
        let inverse = spread.try_inverse().filter(|_| places.len() >= FEWEST && !flat)?;
        let slope = shares * inverse;
        let rest = (both().map(|(x, u)| (u - slope * x).norm_squared()).sum::<f64>() / n).sqrt();
        Some(Fit { gradient: Matrix3::identity() + slope, rest, grains: places.len() })
    }

    /// ε, positive in compression [–].
    pub fn strain(&self) -> Matrix3<f64> {
        Matrix3::identity() - (self.gradient + self.gradient.transpose()) * 0.5
    }

    /// ε_v [–].
    pub fn volumetric(&self) -> f64 {
        1.0 - self.gradient.determinant()
    }
}

/// Measures the mean strain of grains.
pub struct Strain {
    within: Option<Shape>,
    /// Each grain of the first frame, by id.
    start: BTreeMap<u64, Followed>,
    /// Ways through periodic faces that may be wrong by a period.
    unsure: u64,
    /// Most grains that a frame would have begun with.
    most: usize,
    last: Option<(f64, Fit)>,
}

/// A grain of the first frame.
#[derive(Debug, Clone, Copy)]
struct Followed {
    /// Where it was there [m].
    first: Vec3,
    /// Time [s], position [m] and velocity [m/s] in the last frame that holds it.
    time: f64,
    state: (Vec3, Vec3),
    /// Periods that it has passed along each axis [–].
    periods: Vec3,
}

impl Followed {
    fn new(time: f64, state: (Vec3, Vec3)) -> Followed {
        Followed { first: state.0, time, state, periods: Vec3::zeros() }
    }

    /// Takes it to the next frame; whether the number of periods is sure.
    fn follow(&mut self, frame: &Frame, state: (Vec3, Vec3)) -> bool {
        let passage = Passage::new(&frame.periodic, [self.time, frame.time], self.state, state);
        let count = |shift: f64, length: f64| if length > 0.0 { (shift / length).round() } else { 0.0 };
        self.periods += passage.shift.zip_map(&frame.periodic.lengths(), count);
        (self.time, self.state) = (frame.time, state);
        passage.sure
    }

    /// How far it is from where it was first [m], in a domain as it is in a frame.
    fn moved(&self, frame: &Frame) -> Vec3 {
        self.state.0 + self.periods.component_mul(&frame.periodic.lengths()) - self.first
    }
}

impl Strain {
    /// Of the grains whose centres a shape holds in the first frame; `None`: of all.
    pub fn new(within: Option<Shape>) -> Strain {
        Strain { within, start: BTreeMap::new(), unsure: 0, most: 0, last: None }
    }
}

impl OfFrame for Strain {
    fn heads(&self) -> Vec<Head> {
        let strains = ["xx", "yy", "zz", "xy", "xz", "yz"].map(|name| (name, "1"));
        Head::list(
            &[&[("time", "s")], &strains[..], &[("volumetric", "1"), ("rest", "m"), ("grains", "1")]]
                .concat(),
        )
    }

    fn measure(&mut self, _: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        if self.start.is_empty() {
            let held = |x: &Vec3| self.within.as_ref().is_none_or(|shape| frame.periodic.holds(shape, x));
            let states = frame.position.iter().copied().zip(frame.velocity.iter().copied());
            let all = frame.id.iter().copied().zip(states).filter(|(_, (x, _))| held(x));
            self.start = all.map(|(id, state)| (id, Followed::new(frame.time, state))).collect();
            self.most = self.most.max(self.start.len());
            if self.start.len() < FEWEST {
                // A run may begin without grains: the first frame is the first that has enough.
                self.start.clear();
                return Ok(vec![undefined(&self.heads(), frame.time)]);
            }
        }
        let (mut places, mut moved) = (Vec::new(), Vec::new());
        let states = frame.position.iter().copied().zip(frame.velocity.iter().copied());
        for (id, state) in frame.id.iter().zip(states) {
            if let Some(grain) = self.start.get_mut(id) {
                self.unsure += u64::from(!grain.follow(frame, state));
                places.push(grain.first);
                moved.push(grain.moved(frame));
            }
        }
        let Some(fit) = Fit::of(&places, &moved) else {
            return Ok(vec![undefined(&self.heads(), frame.time)]);
        };
        self.last = Some((frame.time, fit));
        let e = fit.strain();
        let parts = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|at| e[at]);
        let rest = [fit.volumetric(), fit.rest, fit.grains as f64];
        Ok(vec![[&[frame.time], &parts[..], &rest[..]].concat()])
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let (time, fit) = self.last.ok_or(MeasureError::FewGrains {
            what: "a mean strain",
            most: self.most,
            wanted: FEWEST,
        })?;
        let e = fit.strain();
        let summary = Summary::default()
            .with("xx", "1", e[(0, 0)])
            .with("yy", "1", e[(1, 1)])
            .with("zz", "1", e[(2, 2)])
            .with("volumetric", "1", fit.volumetric())
            .with("rest", "m", fit.rest)
            .with("time", "s", time);
        Ok((Vec::new(), unsure_note(self.unsure).into_iter().fold(summary, Summary::note)))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let parts = [("xx", 1), ("yy", 2), ("zz", 3), ("volumetric", 7)];
        Chart::new("Mean strain").columns(
            ("time [s]", 0),
            "strain, positive in compression [1]",
            &parts,
            rows,
        )
    }
}

impl Measure for Strain {
    const NAME: &'static str = "strain";
    const HELP: &'static str = "Mean strain of the grains since the first frame";
    const FRAMES: Frames = Frames::OverTime;
    const OPTIONS: &'static [&'static str] = &["within"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(PerFrame::new(Strain::new(asked.shape_within()))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::periodic::PeriodicBox;

    /// Grains that are squeezed, sheared and turned a little: found to the last digits, whatever the shift is.
    #[test]
    fn an_affine_motion_is_found() {
        let places: Vec<Vec3> = (0..27)
            .map(|k| Vec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)) * 0.1)
            .collect();
        let slope = Matrix3::new(0.002, 0.004, 0.0, 0.0, 0.003, 0.0, 0.0, 0.0, -0.01);
        let moved: Vec<Vec3> = places.iter().map(|x| slope * x + Vec3::new(5.0, -2.0, 1.0)).collect();
        let fit = Fit::of(&places, &moved).expect("enough grains");
        let e = fit.strain();
        for (at, wanted) in
            [((0, 0), -0.002), ((1, 1), -0.003), ((2, 2), 0.01), ((0, 1), -0.002), ((0, 2), 0.0)]
        {
            assert!((e[at] - wanted).abs() < 1e-12, "{at:?}: {}", e[at]);
        }
        assert!((fit.volumetric() - (1.0 - 1.002 * 1.003 * 0.99)).abs() < 1e-12 && fit.rest < 1e-12);
        // One that moves by itself is in the rest.
        let mut own = moved.clone();
        own[13] += Vec3::new(0.0, 0.0, 0.027);
        let rest = Fit::of(&places, &own).expect("enough grains").rest;
        assert!((rest / (0.027 / 27f64.sqrt()) - 1.0).abs() < 0.1, "{rest}");
    }

    /// Shear by three times the height of a periodic cell, in frames of which each is less than a period later.
    #[test]
    fn shear_beyond_a_period_is_found() {
        let periodic = PeriodicBox { range: [Some((0.0, 1.0)), None, None] };
        let run = Run { periodic, ..Default::default() };
        let mut strain = Strain::new(None);
        let places: Vec<Vec3> = (0..64)
            .map(|k| Vec3::new(f64::from(k % 4) / 4.0, f64::from(k / 4 % 4) / 4.0, f64::from(k / 16) / 4.0))
            .collect();
        let mut last = 0.0;
        for step in 0..=30 {
            let gamma = 0.1 * f64::from(step);
            let at = |x: &Vec3| Vec3::new((x.x + gamma * x.z).rem_euclid(1.0), x.y, x.z);
            let frame = Frame {
                time: f64::from(step),
                id: (0..64).collect(),
                position: places.iter().map(at).collect(),
                velocity: places.iter().map(|x| Vec3::new(0.1 * x.z, 0.0, 0.0)).collect(),
                periodic,
                ..Frame::default()
            };
            let rows = strain.measure(&run, &frame).unwrap();
            last = rows[0][5];
        }
        assert!((last + 1.5).abs() < 1e-9, "ε_xz = −γ/2: {last}");
    }

    #[test]
    fn grains_in_a_plane_have_no_strain_across_it() {
        let places: Vec<Vec3> = (0..9).map(|k| Vec3::new(f64::from(k % 3), f64::from(k / 3), 0.0)).collect();
        assert!(Fit::of(&places, &places).is_none() && Fit::of(&places[..2], &places[..2]).is_none());
    }
}
