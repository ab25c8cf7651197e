//! Regions of pixels of one value that share sides.
//!
//! Runs along rows are joined where they touch a run of the row before (union-find; Rosenfeld & Pfaltz 1966, doi:10.1145/321356.321357):
//! what it costs grows with the runs, after one look at each pixel.

use super::Raster;
use geom::Parts;
use std::ops::Range;

/// The regions of a picture, numbered in the order of their first pixels.
pub(super) struct Regions {
    width: usize,
    height: usize,
    /// Row, and columns, row by row.
    runs: Vec<(usize, Range<usize>)>,
    /// The region of each run.
    region: Vec<usize>,
}

impl Regions {
    /// Of the pixels of a value.
    pub fn new(raster: &Raster, value: bool) -> Regions {
        let (width, height) = (raster.width, raster.height);
        let mut runs: Vec<(usize, Range<usize>)> = Vec::new();
        let mut parts = Parts::new(0);
        let mut above = 0..0;
        for (y, row) in raster.pixels.chunks(width.max(1)).enumerate() {
            let first = runs.len();
            let mut x = 0;
            while let Some(from) = row[x..].iter().position(|p| *p == value).map(|off| x + off) {
                x = row[from..].iter().position(|p| *p != value).map_or(width, |off| from + off);
                while above.start < above.end && runs[above.start].1.end <= from {
                    above.start += 1;
                }
                let own = runs.len();
                parts.push();
                for other in above.clone().take_while(|other| runs[*other].1.start < x) {
                    parts.join(own as u32, other as u32);
                }
                runs.push((y, from..x));
            }
            above = first..runs.len();
        }
        let mut region = Vec::with_capacity(runs.len());
        let mut count = 0;
        for run in 0..runs.len() {
            // The first run of a region is its root.
            let root = parts.root(run as u32) as usize;
            region.push(if root == run { count } else { region[root] });
            count += usize::from(root == run);
        }
        Regions { width, height, runs, region }
    }

    fn count(&self) -> usize {
        self.region.iter().max().map_or(0, |last| last + 1)
    }

    /// The region with the most pixels, of two equal ones the first; none where there is none.
    pub fn largest(&self) -> Option<usize> {
        let mut sizes = vec![0; self.count()];
        self.runs.iter().zip(&self.region).for_each(|((_, run), region)| sizes[*region] += run.len());
        (0..sizes.len()).rev().max_by_key(|region| sizes[*region])
    }

    /// Whether each region touches the frame.
    pub fn on_frame(&self) -> Vec<bool> {
        let mut on_frame = vec![false; self.count()];
        for ((y, run), region) in self.runs.iter().zip(&self.region) {
            let touches = *y == 0 || y + 1 == self.height || run.start == 0 || run.end == self.width;
            on_frame[*region] |= touches;
        }
        on_frame
    }

    /// True on the pixels of some regions.
    pub fn drawn(&self, is_wanted: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut pixels = vec![false; self.width * self.height];
        for ((y, run), _) in self.runs.iter().zip(&self.region).filter(|(_, region)| is_wanted(**region)) {
            pixels[y * self.width + run.start..y * self.width + run.end].fill(true);
        }
        pixels
    }
}
