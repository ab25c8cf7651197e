//! Porosity in a shape: the share of its volume that no grain fills.
//!
//! Each ball counts with its part in the shape (see [`crate::region`] for the accuracy). The lens that two
//! overlapping grains share would count twice; lenses whose middle lies in the shape are subtracted. The spheres of a rigid clump count with
//! their shares of its volume ([`crate::clumped`]). Of a box, ball or cylinder that lies in the periodic box,
//! the part of a grain beyond a face counts where its image is.

use crate::coordination::touching;
use crate::observer::OfFrame;
use crate::region::Region;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{Frame, MeasureError, Run, ball};
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::HashSet;

/// How full a shape is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filling {
    /// Volume of grains in it [m³], overlaps taken off.
    pub solid: f64,
    /// Volume of overlaps [m³].
    pub overlaps: f64,
    /// Standard error of `solid` [m³].
    pub error: f64,
    /// Volume of the shape [m³].
    pub volume: f64,
    /// Grains that lie in it, at least in part.
    pub grains: usize,
}

/// How full a shape is of the grains of a frame.
///
/// # Errors
/// A shape without end or without room.
pub fn filling(run: &Run, frame: &Frame, region: &Region) -> Result<Filling, MeasureError> {
    let volume = region.room()?;
    let in_box = region.lies_in_box(run);
    let all = if in_box { frame.with_images(run) } else { Cow::Borrowed(frame) };
    let parts: Vec<_> = all.position.par_iter().zip(&all.radius).map(|(p, r)| region.part(p, *r)).collect();
    let body = frame.body();
    let lens = |(a, b): &(usize, usize)| {
        let way = run.way(&frame.position[*a], &frame.position[*b]);
        let (r, s, d) = (frame.radius[*a], frame.radius[*b], way.norm());
        let middle = frame.position[*a] + way * (0.5 * (d + r - s) / d);
        let middle = if in_box { run.wrapped(&middle) } else { middle };
        if d > 0.0 && region.shape.contains(&middle) { ball::lens(d, r, s) } else { 0.0 }
    };
    let apart = |(a, b): &&(usize, usize)| body[*a] != body[*b];
    let overlaps: f64 = touching(run, frame).iter().filter(apart).map(lens).sum();
    let bodies = all.body();
    let inside = bodies.iter().zip(&parts).filter(|(_, p)| p.volume > 0.0);
    Ok(Filling {
        solid: parts.iter().enumerate().map(|(row, p)| p.volume * all.share(row)).sum::<f64>() - overlaps,
        overlaps,
        error: parts.iter().map(|p| p.error * p.error).sum::<f64>().sqrt(),
        volume,
        grains: inside.map(|(body, _)| body).collect::<HashSet<_>>().len(),
    })
}

/// Measures the porosity of a shape in chosen frames.
pub struct Porosity {
    region: Region,
    last: Option<Filling>,
    most: usize,
    bounds: (geom::Vec3, geom::Vec3),
}

impl Porosity {
    /// Of this region.
    ///
    /// # Errors
    /// A shape without end or without room.
    pub fn new(region: Region) -> Result<Porosity, MeasureError> {
        region.room()?;
        Ok(Porosity { region, last: None, most: 0, bounds: Default::default() })
    }
}

impl OfFrame for Porosity {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[
            ("time", "s"),
            ("porosity", "1"),
            ("solid_fraction", "1"),
            ("error", "1"),
            ("solid", "m³"),
            ("overlaps", "m³"),
            ("volume", "m³"),
            ("grains", "1"),
        ])
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        let f = filling(run, frame, &self.region)?;
        self.last = Some(f);
        self.most = self.most.max(f.grains);
        if !frame.is_empty() {
            self.bounds = frame.bounds();
        }
        let phi = f.solid / f.volume;
        let error = f.error / f.volume;
        Ok(vec![vec![frame.time, 1.0 - phi, phi, error, f.solid, f.overlaps, f.volume, f.grains as f64]])
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let Some(f) = self.last.filter(|_| self.most > 0) else {
            let (low, high) = self.bounds;
            return Err(MeasureError::NothingInside { what: "grain", low: low.into(), high: high.into() });
        };
        let phi = f.solid / f.volume;
        let summary = Summary::default()
            .with("porosity", "1", 1.0 - phi)
            .with("solid_fraction", "1", phi)
            .with("error", "1", f.error / f.volume)
            .with("volume", "m³", f.volume)
            .with("grains", "1", f.grains as f64);
        Ok((Vec::new(), summary))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        Chart::new("Porosity").columns(("time [s]", 0), "porosity [1]", &[("", 1)], rows)
    }
}
