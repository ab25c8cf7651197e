//! Cubic cells that fill a box, numbered by blocks: the order in which the cell grid sorts its points.

use crate::Vec3;
use core::iter::from_fn;
use core::ops::Range;

/// Cells over a box.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct Lattice {
    /// Lowest corner [m].
    pub origin: Vec3,
    /// Width of a cell [m].
    pub cell: f64,
    /// Number of cells along x, y, z.
    pub dims: [i64; 3],
    /// Cells of a block along each axis.
    pub block: [i64; 3],
    /// Number of blocks along each axis: one of all cells, or several of one size, the last of which may reach beyond the cells.
    pub blocks: [i64; 3],
}

impl Lattice {
    /// The cell that holds `p` [m], clamped to the box.
    #[inline(always)]
    pub fn cell_of(&self, p: &Vec3) -> [i64; 3] {
        [0, 1, 2].map(|a| self.along(p[a], a).clamp(0, (self.dims[a] - 1).max(0)))
    }

    /// Cells from the origin to `x` [m] along an axis, rounded towards the origin.
    #[inline(always)]
    fn along(&self, x: f64, axis: usize) -> i64 {
        ((x - self.origin[axis]) / self.cell) as i64
    }

    /// Number of a cell: by block, in each z slowest, x fastest.
    #[inline(always)]
    pub fn key(&self, [x, y, z]: [i64; 3]) -> u64 {
        let number = |[x, y, z]: [i64; 3], of: [i64; 3]| (z * of[1] + y) * of[0] + x;
        if self.blocks.iter().all(|&n| n == 1) {
            return number([x, y, z], self.block) as u64;
        }
        let b = self.block;
        // No axis has 2³² cells, and four bytes are divided faster than eight.
        let blocks = |cell: i64, a: usize| i64::from(cell as u32 / b[a] as u32);
        let within = |cell: i64, a: usize| i64::from(cell as u32 % b[a] as u32);
        let before = number([blocks(x, 0), blocks(y, 1), blocks(z, 2)], self.blocks) * (b[0] * b[1] * b[2]);
        (before + number([within(x, 0), within(y, 1), within(z, 2)], b)) as u64
    }

    /// How many numbers cells may have.
    pub fn keys(&self) -> f64 {
        (0..3).map(|a| (self.block[a] * self.blocks[a]) as f64).product()
    }

    /// Lowest and highest cell that a ball of `radius` [m] around `centre` [m] may touch; there are none where a highest is below its lowest.
    #[inline(always)]
    pub fn around(&self, centre: &Vec3, radius: f64) -> [[i64; 3]; 2] {
        // What is rounded towards the origin may be one cell too many there.
        let low = [0, 1, 2].map(|a| self.along(centre[a] - radius, a).max(0));
        let high = [0, 1, 2].map(|a| self.along(centre[a] + radius, a).min(self.dims[a] - 1));
        [low, high]
    }

    /// The cells `x` of row (`y`, `z`): for each block the number of the first, and how many follow each other.
    #[inline(always)]
    pub fn row(self, x: Range<i64>, y: i64, z: i64) -> impl Iterator<Item = (u64, u64)> {
        let inside = y >= 0 && z >= 0 && y < self.dims[1] && z < self.dims[2];
        let (mut from, to) = (x.start.max(0), if inside { x.end.min(self.dims[0]) } else { 0 });
        from_fn(move || {
            let start = from;
            let whole = self.blocks[0] == 1;
            from = if whole {
                to
            } else {
                to.min((i64::from(start as u32 / self.block[0] as u32) + 1) * self.block[0])
            };
            (start < to).then(|| (self.key([start, y, z]), (from - start) as u64))
        })
    }
}
