//! Height of a bed: the median height of its surface over the ground.
//!
//! The surface is that of the heap angle (see [`crate::repose`]): the highest grain over each point of a grid of a quarter of
//! a mean diameter; cells without grains are left out. Grains in the air do not affect the median.

use crate::observer::OfFrame;
use crate::repose::{Frame3, HeapSurface};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::statistics::quantile;
use crate::{Frame, MeasureError, Run};
use geom::Vec3;

/// Measures the height of a bed in chosen frames.
pub struct BedHeight {
    up: Option<Vec3>,
    ground: Option<f64>,
    last: [f64; 4],
}

impl BedHeight {
    /// Along `up` (`None`: against gravity, or z) over the `ground` [m] (`None`: the lowest grains').
    pub fn new(up: Option<Vec3>, ground: Option<f64>) -> BedHeight {
        BedHeight { up, ground, last: [f64::NAN; 4] }
    }
}

impl OfFrame for BedHeight {
    fn heads(&self) -> Vec<Head> {
        Head::list(&[("time", "s"), ("height", "m"), ("tenth", "m"), ("nine_tenths", "m")])
    }

    fn measure(&mut self, run: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        if frame.is_empty() {
            return Err(MeasureError::NoGrains { time: frame.time });
        }
        let up = self.up.or(run.up).unwrap_or(Vec3::z());
        let surface = HeapSurface::new(frame, &Frame3::new(up), self.ground);
        let mut heights: Vec<f64> = surface.points.iter().map(|p| p[2] - surface.ground).collect();
        let [height, low, high] = [0.5, 0.1, 0.9].map(|share| quantile(&mut heights, share));
        self.last = [frame.time, height, low, high];
        Ok(vec![self.last.to_vec()])
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let [time, height, low, high] = self.last;
        let summary = Summary::default()
            .with("height", "m", height)
            .with("tenth", "m", low)
            .with("nine_tenths", "m", high)
            .with("time", "s", time);
        Ok((Vec::new(), summary))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let lines = [("median", 1), ("tenth", 2), ("nine tenths", 3)];
        Chart::new("Height of the bed").columns(("time [s]", 0), "height [m]", &lines, rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square layer of equal balls of radius r on the ground: over the rays that meet a ball the surface is r + √(r² − ρ²) high, ρ uniform
    /// in the disc, so that half of it lies above r (1 + √½).
    #[test]
    fn the_median_of_a_layer_of_balls_is_that_of_a_half_sphere() {
        let r = 0.01;
        let position = |k: i32| Vec3::new(0.0213 * f64::from(k % 40), 0.0217 * f64::from(k / 40), 0.3 + r);
        let frame = Frame {
            time: 1.0,
            id: (0..1600).collect(),
            position: (0..1600).map(position).collect(),
            radius: vec![r; 1600],
            ..Frame::default()
        };
        let mut bed = BedHeight::new(None, Some(0.3));
        let rows = bed.measure(&Run::default(), &frame).unwrap();
        let right = r * (1.0 + 0.5f64.sqrt());
        println!("{} {right}", rows[0][1]);
        assert!((rows[0][1] / right - 1.0).abs() < 0.01, "{} is not {right}", rows[0][1]);
        let empty = Frame::default();
        assert!(matches!(bed.measure(&Run::default(), &empty), Err(MeasureError::NoGrains { .. })));
    }
}
