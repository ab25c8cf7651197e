//! Signed distance to the edge of a mask: positive inside the stone.
//!
//! Every sample knows its nearest piece of the edge, which it takes from its neighbours in four sweeps: Danielsson (1980), Comput. Graph.
//! Image Process. 14, doi:10.1016/0146-664X(80)90054-4, with pieces of lines instead of pixels.

use crate::contour::{HALF, Segment, of_values};
use crate::mask::Mask;

/// Samples beside the box of the mask.
const MARGIN: usize = 4;

/// Signed distance [px of the photograph] on a grid of samples around a mask.
#[derive(Debug, Clone)]
pub struct Field {
    width: usize,
    height: usize,
    /// Place of the first sample [px].
    origin: [f64; 2],
    /// From sample to sample [px].
    step: f64,
    values: Vec<f32>,
    /// Width and height of the photograph [px].
    frame: [f64; 2],
    /// Whether the stone may go on beyond the frame.
    cut: bool,
    /// Some places on the edge [px].
    edge: Vec<[f64; 2]>,
}

/// Places on the edge that are kept, at most.
const EDGE: usize = 64;

impl Field {
    /// The field of a mask, with at most about `most` samples along the longest side of the stone; `None` when the mask is empty.
    pub fn new(mask: &Mask, most: usize) -> Option<Field> {
        let [x0, y0, x1, y1] = mask.bounds()?;
        let longest = (x1 - x0).max(y1 - y0) + 1;
        let k = longest.div_ceil(most.max(1));
        let start = |lo: usize| lo as i64 - (MARGIN * k) as i64;
        let samples = |lo: usize, hi: usize| (hi - lo) / k + 1 + 2 * MARGIN;
        let (left, top) = (start(x0), start(y0));
        let (width, height) = (samples(x0, x1), samples(y0, y1));
        let mean = |n: usize| block(mask, left + ((n % width) * k) as i64, top + ((n / width) * k) as i64, k);
        let means: Vec<f32> = (0..width * height).map(mean).collect();
        let edge = of_values(width, height, |n| means[n]);
        let mut values = distances(width, height, &edge);
        for (value, mean) in values.iter_mut().zip(&means) {
            *value *= if *mean > HALF { k as f32 } else { -(k as f32) };
        }
        let half = (k as f64 - 1.0) / 2.0;
        Some(Field {
            width,
            height,
            origin: [left as f64 + half, top as f64 + half],
            step: k as f64,
            values,
            frame: [mask.width as f64, mask.height as f64],
            cut: mask.on_frame() > 0,
            edge: some(&edge, |[x, y]| [left as f64 + half + x * k as f64, top as f64 + half + y * k as f64]),
        })
    }

    /// Signed distance at a place [px]: linear between samples. Beyond the frame a stone that it cuts may be anywhere: above 0 there, and
    /// growing with the distance to the frame, so that the value is a lower bound of the distance to what the mask excludes.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let [u, v] = [(x, self.frame[0]), (y, self.frame[1])].map(|(p, size)| p.clamp(0.0, size - 1.0));
        let beyond = (x - u).hypot(y - v);
        if self.cut && beyond > 0.0 {
            return self.within(u, v).max(0.0) + beyond;
        }
        self.within(x, y)
    }

    fn within(&self, x: f64, y: f64) -> f64 {
        let (u, v) = ((x - self.origin[0]) / self.step, (y - self.origin[1]) / self.step);
        let (a, b) = (u.clamp(0.0, self.width as f64 - 1.001), v.clamp(0.0, self.height as f64 - 1.001));
        let (i, j) = (a as usize, b as usize);
        let (s, t) = ((a - i as f64) as f32, (b - j as f64) as f32);
        let k = j * self.width + i;
        let row = |k: usize| self.values[k] + s * (self.values[k + 1] - self.values[k]);
        let (top, bottom) = (row(k), row(k + self.width));
        let value = f64::from(top + t * (bottom - top));
        if a == u && b == v {
            return value;
        }
        value - self.step * (u - a).hypot(v - b)
    }

    /// Some places on the edge, spread over it [px].
    pub fn edge(&self) -> &[[f64; 2]] {
        &self.edge
    }

    /// Width and height of the photograph [px].
    pub fn frame(&self) -> [f64; 2] {
        self.frame
    }

    /// Samples along x and y, place of the first one [px], and the distance between them [px].
    pub fn grid(&self) -> ([usize; 2], [f64; 2], f64) {
        ([self.width, self.height], self.origin, self.step)
    }

    /// Middle of the box of the stone [px].
    pub fn middle(&self) -> [f64; 2] {
        let [a, _, _, b] = self.corners();
        [0, 1].map(|k| (a[k] + b[k]) / 2.0)
    }

    /// Corners of the box of the samples, a little beyond the stone [px].
    pub fn corners(&self) -> [[f64; 2]; 4] {
        let [x, y] = self.origin;
        let (u, v) = (x + self.step * (self.width - 1) as f64, y + self.step * (self.height - 1) as f64);
        [[x, y], [u, y], [x, v], [u, v]]
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        4 * self.values.len()
    }
}

/// Middles of some segments.
fn some(edge: &[Segment], place: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
    let count = EDGE.min(edge.len());
    (0..count).map(|n| place(edge[n * edge.len() / count].middle().map(f64::from))).collect()
}

/// Mean coverage of k × k pixels; pixels beyond the frame are as the nearest on it.
fn block(mask: &Mask, left: i64, top: i64, k: usize) -> f32 {
    let within = |p: i64, size: usize| p.clamp(0, size as i64 - 1) as usize;
    let mut sum = 0u32;
    for y in 0..k as i64 {
        let row = within(top + y, mask.height) * mask.width;
        sum +=
            (0..k as i64).map(|x| u32::from(mask.coverage[row + within(left + x, mask.width)])).sum::<u32>();
    }
    sum as f32 / (k * k) as f32
}

/// Distance of each sample to the nearest segment [samples].
fn distances(width: usize, height: usize, edge: &[Segment]) -> Vec<f32> {
    let mut nearest = vec![u32::MAX; width * height];
    let mut distance = vec![f32::INFINITY; width * height];
    for (n, s) in (0u32..).zip(edge) {
        let [x, y] = s.middle();
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (x, y) = (x as usize + i, y as usize + j);
            if x < width && y < height {
                take(&mut nearest, &mut distance, y * width + x, [x, y], n, edge);
            }
        }
    }
    // Down with both directions along rows, then up.
    for y in 0..height {
        sweep(&mut nearest, &mut distance, [width, y], y.checked_sub(1), edge);
    }
    for y in (0..height).rev() {
        sweep(&mut nearest, &mut distance, [width, y], Some(y + 1).filter(|y| *y < height), edge);
    }
    distance
}

fn take(nearest: &mut [u32], distance: &mut [f32], k: usize, [x, y]: [usize; 2], n: u32, edge: &[Segment]) {
    if n != u32::MAX && n != nearest[k] {
        let found = edge[n as usize].distance([x as f32, y as f32]);
        if found < distance[k] {
            (nearest[k], distance[k]) = (n, found);
        }
    }
}

/// One row: from the row before, then from the left, then from the right.
fn sweep(
    nearest: &mut [u32],
    distance: &mut [f32],
    [width, y]: [usize; 2],
    before: Option<usize>,
    edge: &[Segment],
) {
    if let Some(before) = before {
        for x in 0..width {
            for beside in
                [x.checked_sub(1), Some(x), Some(x + 1).filter(|x| *x < width)].into_iter().flatten()
            {
                let n = nearest[before * width + beside];
                take(nearest, distance, y * width + x, [x, y], n, edge);
            }
        }
    }
    for x in 1..width {
        let n = nearest[y * width + x - 1];
        take(nearest, distance, y * width + x, [x, y], n, edge);
    }
    for x in (0..width.saturating_sub(1)).rev() {
        let n = nearest[y * width + x + 1];
        take(nearest, distance, y * width + x, [x, y], n, edge);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(size: usize, c: [f32; 2], r: f32) -> Mask {
        let value = |k: usize| {
            let d = r - ((k % size) as f32 - c[0]).hypot((k / size) as f32 - c[1]);
            (255.0 * (d + 0.5)).clamp(0.0, 255.0) as u8
        };
        Mask::given(size, size, (0..size * size).map(value).collect())
    }

    #[test]
    fn the_field_of_a_disc_is_the_distance_to_it() {
        for (most, tolerance) in [(1000, 0.1), (40, 0.3)] {
            let field = Field::new(&disc(160, [80.3, 78.6], 50.4), most).unwrap();
            for (x, y) in
                [(95.0, 78.0), (120.0, 78.0), (131.1, 79.2), (150.0, 100.0), (20.0, 20.0), (-50.0, 78.6)]
            {
                let wanted = 50.4 - (x - 80.3f64).hypot(y - 78.6);
                // Beyond the samples a bound is enough.
                let off = field.at(x, y) - wanted;
                assert!(off.abs() < tolerance || (wanted < -8.0 && field.at(x, y) < -8.0), "{x}, {y}: {off}");
            }
        }
    }

    #[test]
    fn beyond_the_frame_a_cut_stone_may_go_on() {
        let cut = Field::new(&disc(60, [10.0, 30.0], 15.0), 1000).unwrap();
        assert!(cut.at(-3.0, 30.0) > 3.0 + cut.at(0.0, 30.0) - 1e-9);
        // The mask excludes the place on the frame at 5 pixels beside it.
        assert!(cut.at(0.0, 58.0) < -5.0);
        assert!((cut.at(-5.0, 58.0) - 5.0).abs() < 1e-9, "{}", cut.at(-5.0, 58.0));
        assert!(cut.at(2.0, 30.0) > 5.0 && cut.at(40.0, 30.0) < 0.0);
        let whole = Field::new(&disc(60, [30.0, 30.0], 15.0), 1000).unwrap();
        assert!(whole.at(-3.0, 30.0) < -10.0);
        assert!(Field::new(&Mask::given(4, 4, vec![0; 16]), 10).is_none());
    }
}
