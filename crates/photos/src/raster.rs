//! True and false pixels: growing, shrinking, the largest region, holes.

use rayon::prelude::*;

/// A picture of true and false.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Raster {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row.
    pub pixels: Vec<bool>,
}

impl Raster {
    /// Pixels that are true.
    pub fn count(&self) -> usize {
        self.pixels.iter().filter(|p| **p).count()
    }

    /// Pixels that are true and lie on the frame.
    pub fn on_frame(&self) -> usize {
        self.frame().filter(|k| self.pixels[*k]).count()
    }

    /// Numbers of the pixels of the frame, each once.
    pub fn frame(&self) -> impl Iterator<Item = usize> + use<> {
        let (w, h) = (self.width, self.height);
        let rows = (0..w).chain(if h > 1 { (h - 1) * w..h * w } else { 0..0 });
        let sides = (1..h.saturating_sub(1)).flat_map(move |y| {
            let last = if w > 1 { Some(y * w + w - 1) } else { None };
            std::iter::once(y * w).chain(last)
        });
        rows.chain(sides)
    }

    /// True where a true pixel is within `radius` [px].
    pub fn grown(&self, radius: f64) -> Raster {
        let near = self.squared_distance(true);
        self.like(near.into_iter().map(|d| f64::from(d) <= radius * radius))
    }

    /// True where no false pixel is within `radius` [px]; beyond the frame all is as on it.
    pub fn shrunk(&self, radius: f64) -> Raster {
        let near = self.squared_distance(false);
        self.like(near.into_iter().map(|d| f64::from(d) > radius * radius))
    }

    /// Without what is narrower than about twice `radius` [px].
    pub fn opened(&self, radius: f64) -> Raster {
        if radius > 0.0 { self.shrunk(radius).grown(radius) } else { self.clone() }
    }

    /// Without gaps that are narrower than about twice `radius` [px].
    pub fn closed(&self, radius: f64) -> Raster {
        if radius > 0.0 { self.grown(radius).shrunk(radius) } else { self.clone() }
    }

    fn like(&self, pixels: impl Iterator<Item = bool>) -> Raster {
        Raster { pixels: pixels.collect(), ..*self }
    }

    /// The largest region of true pixels that share sides, and the pixels of the others.
    pub fn largest(&self) -> (Raster, usize) {
        let regions = self.regions(true);
        let sizes = sizes(&regions);
        // Of two equal ones the first.
        let best = (1..sizes.len()).rev().max_by_key(|r| sizes[*r]).unwrap_or(0);
        let rest = self.count() - if best == 0 { 0 } else { sizes[best] };
        (self.like(regions.iter().map(|r| best > 0 && *r as usize == best)), rest)
    }

    /// False regions that do not touch the frame become true.
    pub fn filled(&self) -> Raster {
        let regions = self.regions(false);
        let mut open = vec![false; sizes(&regions).len()];
        self.frame().for_each(|k| open[regions[k] as usize] = true);
        self.like((0..self.pixels.len()).map(|k| self.pixels[k] || !open[regions[k] as usize]))
    }

    /// Numbers from 1 of the regions of pixels of this value that share sides; 0 elsewhere.
    fn regions(&self, value: bool) -> Vec<u32> {
        let (w, mut region, mut open) = (self.width, vec![0u32; self.pixels.len()], Vec::new());
        let mut count = 0;
        for start in 0..self.pixels.len() {
            if self.pixels[start] != value || region[start] > 0 {
                continue;
            }
            count += 1;
            region[start] = count;
            open.push(start);
            while let Some(k) = open.pop() {
                let (x, y) = (k % w, k / w);
                let beside = [
                    (x > 0).then(|| k - 1),
                    (x + 1 < w).then_some(k + 1),
                    (y > 0).then(|| k - w),
                    (y + 1 < self.height).then_some(k + w),
                ];
                for next in beside.into_iter().flatten() {
                    if self.pixels[next] == value && region[next] == 0 {
                        region[next] = count;
                        open.push(next);
                    }
                }
            }
        }
        region
    }

    /// Square of the distance of each pixel to the nearest one of this value [px²], exactly: Felzenszwalb & Huttenlocher (2012), Theory of
    /// Computing 8, doi:10.4086/toc.2012.v008a019, with integer parabolas.
    pub fn squared_distance(&self, value: bool) -> Vec<u32> {
        let (w, h) = (self.width, self.height);
        let far = (w + h) as u32;
        // Along all columns at once, down and up.
        let mut column = vec![far; w * h];
        let mut last = vec![far; w];
        for (column, pixels) in column.chunks_mut(w).zip(self.pixels.chunks(w)) {
            nearer(column, &mut last, pixels, value, far);
        }
        last.fill(far);
        for (column, pixels) in column.chunks_mut(w).zip(self.pixels.chunks(w)).rev() {
            nearer(column, &mut last, pixels, value, far);
        }
        // Along each row.
        let mut out = vec![0u32; w * h];
        out.par_chunks_mut(w).zip(column.par_chunks(w)).for_each(|(out, column)| along(column, far, out));
        out
    }
}

/// One row further: `last` is the distance along each column to the pixel of this value that was met last, and `column` the least one so far.
fn nearer(column: &mut [u32], last: &mut [u32], pixels: &[bool], value: bool, far: u32) {
    for ((column, last), pixel) in column.iter_mut().zip(last).zip(pixels) {
        *last = if *pixel == value { 0 } else { (*last + 1).min(far) };
        *column = (*last).min(*column);
    }
}

/// Lower envelope of the parabolas (x − i)² + column[i]².
fn along(column: &[u32], far: u32, out: &mut [u32]) {
    let f = |i: usize| i64::from(column[i]).pow(2);
    let (mut hull, mut from): (Vec<usize>, Vec<i64>) = (Vec::new(), Vec::new());
    for i in (0..column.len()).filter(|i| column[*i] < far) {
        loop {
            let Some(&j) = hull.last() else {
                hull.push(i);
                from.push(0);
                break;
            };
            // First whole x at which the parabola of i is not above that of j.
            let (a, b) = (i as i64, j as i64);
            let x = (f(i) + a * a - f(j) - b * b).div_euclid(2 * (a - b)) + 1;
            if x <= from[from.len() - 1] {
                hull.pop();
                from.pop();
            } else {
                hull.push(i);
                from.push(x);
                break;
            }
        }
    }
    let mut k = 0;
    for (x, out) in out.iter_mut().enumerate() {
        while k + 1 < hull.len() && from[k + 1] <= x as i64 {
            k += 1;
        }
        *out = match hull.get(k) {
            Some(&i) => ((x as i64 - i as i64).pow(2) + f(i)).min(i64::from(u32::MAX)) as u32,
            None => u32::MAX,
        };
    }
}

/// Pixels of each region.
fn sizes(regions: &[u32]) -> Vec<usize> {
    let mut sizes = vec![0; regions.iter().max().map_or(1, |r| *r as usize + 1)];
    regions.iter().for_each(|r| sizes[*r as usize] += 1);
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raster(rows: &[&str]) -> Raster {
        let pixels = rows.iter().flat_map(|r| r.chars().map(|c| c == '#')).collect();
        Raster { width: rows[0].len(), height: rows.len(), pixels }
    }

    #[test]
    fn distances_are_those_of_a_look_at_every_pixel() {
        let mut seed = 12345u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            seed >> 8
        };
        for (w, h) in [(1, 9), (9, 1), (23, 17), (40, 31)] {
            let pixels: Vec<bool> = (0..w * h).map(|_| next() % 19 == 0).collect();
            let raster = Raster { width: w, height: h, pixels };
            let found = raster.squared_distance(true);
            for (k, found) in found.into_iter().enumerate() {
                let square = |j: usize| (k % w).abs_diff(j % w).pow(2) + (k / w).abs_diff(j / w).pow(2);
                let wanted = (0..w * h).filter(|j| raster.pixels[*j]).map(square).min();
                assert_eq!(found, wanted.map_or(u32::MAX, |d| d as u32), "{w} × {h}, {k}");
            }
        }
    }

    #[test]
    fn the_largest_region_stays_and_its_hole_closes() {
        let r = raster(&["#..####", "#..#..#", "...####", "##....."]);
        let (largest, rest) = r.largest();
        assert_eq!((largest.count(), rest), (10, 4));
        assert_eq!(largest.filled().count(), 12);
        // Open to the frame is no hole.
        assert_eq!(raster(&["###", "#.#", "#.#"]).filled().count(), 7);
        assert_eq!(raster(&["...", "..."]).largest().0.count(), 0);
    }

    #[test]
    fn opening_takes_a_thread_and_closing_a_crack() {
        let thread = raster(&["......", ".###..", ".#####", ".###..", "......"]);
        assert_eq!(thread.opened(1.0).count(), 8);
        let crack = raster(&["#####", "##.##", "#####", "#####"]);
        assert_eq!(crack.closed(1.0).count(), 20);
    }
}
