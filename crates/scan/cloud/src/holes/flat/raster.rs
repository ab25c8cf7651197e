//! A picture of a patch: counts of points in square cells, and regions of cells.

/// Cells over a square patch of the plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raster {
    /// Half the side of the patch [m].
    pub half: f64,
    /// Width of a cell [m].
    pub cell: f64,
    /// Cells along a side.
    pub side: usize,
}

impl Raster {
    pub fn new(half: f64, cell: f64) -> Raster {
        Raster { half, cell, side: (2.0 * half / cell).ceil() as usize + 1 }
    }

    pub fn len(&self) -> usize {
        self.side * self.side
    }

    /// The cell that holds a position.
    pub fn at(&self, u: f64, v: f64) -> Option<usize> {
        let [x, y] = [u, v].map(|c| (c + self.half) / self.cell);
        let inside = |c: f64| c >= 0.0 && c < self.side as f64;
        // Above zero, to cut the fraction off is to round down.
        (inside(x) && inside(y)).then(|| y as usize * self.side + x as usize)
    }

    /// Middle of a cell [m].
    pub fn middle(&self, cell: usize) -> (f64, f64) {
        let along = |i: usize| (i as f64 + 0.5) * self.cell - self.half;
        (along(cell % self.side), along(cell / self.side))
    }

    /// Sums over windows of `2 reach + 1` cells a side.
    pub fn windows(&self, counts: &[u32], reach: usize) -> Vec<u32> {
        let rows = self.slide(counts, reach, 1);
        self.slide(&rows, reach, self.side)
    }

    /// Running sums along x (`step` 1) or y (`step` side).
    fn slide(&self, counts: &[u32], reach: usize, step: usize) -> Vec<u32> {
        let mut sums = vec![0; counts.len()];
        for line in 0..self.side {
            let first = if step == 1 { line * self.side } else { line };
            let at = |i: usize| first + i * step;
            let mut sum: u32 = (0..reach.min(self.side)).map(|i| counts[at(i)]).sum();
            for i in 0..self.side {
                if i + reach < self.side {
                    sum += counts[at(i + reach)];
                }
                sums[at(i)] = sum;
                if i >= reach {
                    sum -= counts[at(i - reach)];
                }
            }
        }
        sums
    }

    /// The cells that are as `wanted` in `map` and share a side with one that is not.
    pub fn border(&self, map: &[bool], wanted: bool) -> Vec<usize> {
        let mut border = Vec::new();
        for y in 0..self.side {
            let row = y * self.side;
            let ends = |&cell: &usize| {
                map[cell] == wanted
                    && (cell > row && map[cell - 1] != wanted
                        || cell + 1 < row + self.side && map[cell + 1] != wanted
                        || y > 0 && map[cell - self.side] != wanted
                        || y + 1 < self.side && map[cell + self.side] != wanted)
            };
            border.extend((row..row + self.side).filter(ends));
        }
        border
    }

    /// Neighbours of a cell: four that share a side, or all eight.
    pub fn beside(&self, cell: usize, corners: bool) -> impl Iterator<Item = usize> {
        const STEPS: [(i64, i64); 8] = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];
        let (x, y, side) = ((cell % self.side) as i64, (cell / self.side) as i64, self.side as i64);
        STEPS[..if corners { 8 } else { 4 }].iter().filter_map(move |(dx, dy)| {
            let (x, y) = (x + dx, y + dy);
            ((0..side).contains(&x) && (0..side).contains(&y)).then_some((y * side + x) as usize)
        })
    }

    /// The cells of `open` that are reached from `start` without leaving `open`; taken out of it.
    pub fn flood(&self, open: &mut [bool], start: usize, corners: bool) -> Vec<usize> {
        let mut reached = vec![start];
        open[start] = false;
        let mut next = 0;
        while next < reached.len() {
            for cell in self.beside(reached[next], corners) {
                if std::mem::take(&mut open[cell]) {
                    reached.push(cell);
                }
            }
            next += 1;
        }
        reached
    }

    /// Takes out of `open` what is joined to the rim of the patch.
    pub fn drop_outside(&self, open: &mut [bool]) {
        let last = self.side - 1;
        for i in 0..self.side {
            for cell in [i, last * self.side + i, i * self.side, i * self.side + last] {
                if open[cell] {
                    self.flood(open, cell, false);
                }
            }
        }
    }

    /// The connected parts of `open`, each a list of cells.
    pub fn parts(&self, mut open: Vec<bool>) -> Vec<Vec<usize>> {
        let mut parts = Vec::new();
        for cell in 0..open.len() {
            if open[cell] {
                parts.push(self.flood(&mut open, cell, true));
            }
        }
        parts
    }

    /// The cells within `radius` cells of some of `cells`.
    pub fn grown(&self, cells: &[usize], radius: f64) -> Vec<bool> {
        let mut mask = vec![false; self.len()];
        let (reach, side) = (radius.ceil() as i64, self.side as i64);
        let disc: Vec<(i64, i64)> = (-reach..=reach)
            .flat_map(|y| (-reach..=reach).map(move |x| (x, y)))
            .filter(|(x, y)| (x * x + y * y) as f64 <= radius * radius)
            .collect();
        for &cell in cells {
            let (x, y) = ((cell % self.side) as i64, (cell / self.side) as i64);
            for (dx, dy) in &disc {
                let (x, y) = (x + dx, y + dy);
                if (0..side).contains(&x) && (0..side).contains(&y) {
                    mask[(y * side + x) as usize] = true;
                }
            }
        }
        mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_sums() {
        let raster = Raster::new(2.0, 0.5);
        let counts: Vec<u32> = (0..raster.len() as u32).map(|i| i * 7 % 5).collect();
        let side = raster.side as i64;
        for (cell, sum) in raster.windows(&counts, 2).into_iter().enumerate() {
            let (x, y) = (cell as i64 % side, cell as i64 / side);
            let near = |c: usize| (c as i64 % side - x).abs() <= 2 && (c as i64 / side - y).abs() <= 2;
            assert_eq!(sum, (0..counts.len()).filter(|&c| near(c)).map(|c| counts[c]).sum::<u32>());
        }
    }

    #[test]
    fn an_enclosed_part_stays_and_the_outside_goes() {
        let raster = Raster::new(4.0, 1.0);
        let ring = |c: usize| {
            let (u, v) = raster.middle(c);
            let r = u.abs().max(v.abs());
            (1.0..3.0).contains(&r)
        };
        let mut open: Vec<bool> = (0..raster.len()).map(|c| !ring(c)).collect();
        raster.drop_outside(&mut open);
        let parts = raster.parts(open);
        assert_eq!(parts.len(), 1);
        assert!(parts[0].iter().all(|&c| raster.middle(c).0.abs() < 1.0));
        let grown = raster.grown(&parts[0], 1.0).iter().filter(|g| **g).count();
        assert!(grown > parts[0].len());
    }
}
