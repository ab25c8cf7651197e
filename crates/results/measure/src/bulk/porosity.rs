//! Porosity in a shape: the share of its volume that no grain fills.
//!
//! Each ball counts with its part in the shape (see [`crate::region`] for the accuracy). The lens that two
//! overlapping grains share would count twice; lenses whose middle lies in the shape are subtracted. The spheres of a rigid clump count with
//! their shares of its volume (`reading::clumped`). In a periodic box every image of a grain counts ([`crate::periodic`]).

use crate::coordination::touching;
use crate::definition::{ArgumentKind, AskError, Asked, Figure, Frames, Measure, number};
use crate::observer::{Observer, OfFrame, PerFrame};
use crate::region::Region;
use crate::sheet::{Chart, Head, Row, Summary};
use crate::{Frame, MeasureError, Run, ball};
use rayon::prelude::*;
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
pub fn filling(frame: &Frame, region: &Region) -> Result<Filling, MeasureError> {
    let periodic = &frame.periodic;
    let region = region.within(periodic)?;
    let volume = region.room()?;
    region.fits(periodic)?;
    let rows = frame.position.par_iter().zip(&frame.radius);
    let parts: Vec<_> = rows.map(|(p, r)| region.part_of_images(periodic, p, *r)).collect();
    let body = frame.body();
    let lens = |(a, b): &(usize, usize)| {
        let way = periodic.way(&frame.position[*a], &frame.position[*b]);
        let (r, s, d) = (frame.radius[*a], frame.radius[*b], way.norm());
        let middle = frame.position[*a] + way * (0.5 * (d + r - s) / d);
        if d > 0.0 { region.images(periodic, &middle) as f64 * ball::lens(d, r, s) } else { 0.0 }
    };
    let apart = |(a, b): &&(usize, usize)| body[*a] != body[*b];
    let overlaps: f64 = touching(frame).iter().filter(apart).map(lens).sum();
    let inside = body.iter().zip(&parts).filter(|(_, p)| p.volume > 0.0);
    Ok(Filling {
        solid: parts.iter().enumerate().map(|(row, p)| p.volume * frame.share(row)).sum::<f64>() - overlaps,
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
        region.may_have_room()?;
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

    fn measure(&mut self, _: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        let f = filling(frame, &self.region)?;
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

impl Measure for Porosity {
    const NAME: &'static str = "porosity";
    const HELP: &'static str = "Porosity in SHAPE";
    const ARGUMENT: ArgumentKind = ArgumentKind::Room;
    const FRAMES: Frames = Frames::Every;
    const FIGURES: &'static [Figure] = &[number("packing-fraction", "solid_fraction")];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let region = Region::new(asked.shape()?.shape.clone(), asked.volume);
        Ok(Box::new(PerFrame::new(Porosity::new(region)?)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::periodic::PeriodicBox;
    use geom::Vec3;

    /// One ball in a cell: the porosity is the same in the cell, in one that is moved, in eight of them, and around a corner of the cell.
    #[test]
    fn images_fill_a_shape_beyond_the_faces() {
        let periodic = PeriodicBox { range: [Some((0.0, 1.0)), Some((0.0, 1.0)), Some((0.0, 1.0))] };
        let frame = Frame {
            id: vec![0],
            position: vec![Vec3::new(0.1, 0.9, 0.3)],
            radius: vec![0.25],
            material: vec![0],
            periodic,
            ..Frame::default()
        };
        let right = ball::volume(0.25);
        for (shape, volume) in [
            ("box:0,0,0,1,1,1", 1.0),
            ("box:-0.4,0.2,0.3,0.6,1.2,1.3", 1.0),
            ("box:-0.5,-0.5,-0.5,1.5,1.5,1.5", 8.0),
            // The SHAPE `all`.
            ("halfspace:0,0,-1e100,0,0,1", 1.0),
        ] {
            let found = filling(&frame, &Region::new(shape.parse().unwrap(), 0.0)).unwrap();
            assert!((found.solid / volume / right - 1.0).abs() < 1e-12, "{shape}: {found:?}");
        }
        // A ball around the grain's image at the other side of the cell holds all of it.
        let around = Region::new("sphere:1.1,-0.1,0.3,0.3".parse().unwrap(), 0.0);
        assert!((filling(&frame, &around).unwrap().solid / right - 1.0).abs() < 1e-12);
        let huge = Region::new("box:-50,-50,-50,50,50,50".parse().unwrap(), 0.0);
        assert!(matches!(filling(&frame, &huge), Err(MeasureError::Setting { .. })));
        // Without a face along z everything has no end.
        let all = Region::new("halfspace:0,0,-1e100,0,0,1".parse().unwrap(), 0.0);
        let open = PeriodicBox { range: [Some((0.0, 1.0)), Some((0.0, 1.0)), None] };
        let found = filling(&Frame { periodic: open, ..frame }, &all);
        assert!(matches!(found, Err(MeasureError::EndlessDomain { axis: "z" })), "{found:?}");
    }
}
