//! Signed distances on the nodes of a grid.

use geom::Vec3;
use rayon::prelude::*;

/// Values on a grid of nodes, above 0 inside.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Place of the first node [m].
    pub origin: Vec3,
    /// From node to node [m].
    pub step: f64,
    /// Nodes along x, y and z.
    pub size: [usize; 3],
    /// Signed distances [m]; x runs fastest.
    pub values: Vec<f32>,
}

impl Samples {
    /// A grid over a box, with about `cells` cells along its longest side and `margin` nodes around it; all values are `value`.
    pub fn over(lo: &Vec3, hi: &Vec3, cells: usize, margin: usize, value: f32) -> Samples {
        let extent = hi - lo;
        let step = extent.max() / cells.max(1) as f64;
        let nodes = |a: usize| (extent[a] / step).ceil() as usize + 1 + 2 * margin;
        let size = [nodes(0), nodes(1), nodes(2)];
        let origin = lo - Vec3::repeat(margin as f64 * step);
        Samples { origin, step, size, values: vec![value; size.iter().product()] }
    }

    /// Number of a node.
    pub fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.size[1] + j) * self.size[0] + i
    }

    /// Columns of a node.
    pub fn node(&self, index: usize) -> [usize; 3] {
        let [x, y, _] = self.size;
        [index % x, index / x % y, index / x / y]
    }

    /// Place of a node [m].
    pub fn place(&self, node: [usize; 3]) -> Vec3 {
        self.origin + Vec3::from(node.map(|n| n as f64)) * self.step
    }

    /// The value at a place, linear between nodes; beyond the grid `None`.
    pub fn at(&self, p: &Vec3) -> Option<f64> {
        let u = (p - self.origin) / self.step;
        if (0..3).any(|a| !(u[a] >= 0.0 && u[a] < (self.size[a] - 1) as f64)) {
            return None;
        }
        let node = [0, 1, 2].map(|a| u[a] as usize);
        let t = [0, 1, 2].map(|a| u[a] - node[a] as f64);
        let corner = |c: usize| {
            let at = [0, 1, 2].map(|a| node[a] + (c >> a & 1));
            let weight: f64 = (0..3).map(|a| if c >> a & 1 == 1 { t[a] } else { 1.0 - t[a] }).product();
            weight * f64::from(self.values[self.index(at)])
        };
        Some((0..8).map(corner).sum())
    }

    /// Lowest and highest corner of the nodes inside [m]; none without any.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let inside =
            (0..self.values.len()).filter(|n| self.values[*n] > 0.0).map(|n| self.place(self.node(n)));
        inside.fold(None, |b: Option<[Vec3; 2]>, p| {
            let [lo, hi] = b.unwrap_or([p, p]);
            Some([lo.inf(&p), hi.sup(&p)])
        })
    }

    /// Whether a node lies on the outside of the grid.
    pub fn on_border(&self, node: [usize; 3]) -> bool {
        (0..3).any(|a| node[a] == 0 || node[a] + 1 == self.size[a])
    }

    /// Works on all nodes, in blocks of `side` nodes along each side; each layer of blocks along z by one thread.
    pub fn in_blocks(&mut self, side: usize, work: impl Fn(&mut Block) + Sync) {
        let ([x, y, _], step, origin) = (self.size, self.step, self.origin);
        self.values.par_chunks_mut(x * y * side).enumerate().for_each(|(k, values)| {
            let depth = values.len() / (x * y);
            for (j, i) in (0..y).step_by(side).flat_map(|j| (0..x).step_by(side).map(move |i| (j, i))) {
                let (first, count) = ([i, j, k * side], [side.min(x - i), side.min(y - j), depth]);
                work(&mut Block { count, first, row: [x, y], step, origin, values });
            }
        });
    }
}

/// Some neighbouring nodes of a grid. A node of it is counted from its first one.
pub struct Block<'a> {
    /// Nodes along x, y and z.
    pub count: [usize; 3],
    first: [usize; 3],
    /// Nodes of the grid along x and y.
    row: [usize; 2],
    step: f64,
    origin: Vec3,
    /// The values of its layer.
    values: &'a mut [f32],
}

impl Block<'_> {
    /// All nodes, x fastest.
    pub fn nodes(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [x, y, z] = self.count;
        (0..x * y * z).map(move |c| [c % x, c / x % y, c / x / y])
    }

    /// Place of a node [m].
    pub fn place(&self, at: [usize; 3]) -> Vec3 {
        self.between(at.map(|n| n as f64))
    }

    /// The place so many steps along x, y and z from its first node [m].
    pub fn between(&self, at: [f64; 3]) -> Vec3 {
        self.origin + Vec3::from([0, 1, 2].map(|a| self.first[a] as f64 + at[a])) * self.step
    }

    /// The value of a node.
    pub fn value(&mut self, at: [usize; 3]) -> &mut f32 {
        let [x, y] = self.row;
        &mut self.values[(at[2] * y + self.first[1] + at[1]) * x + self.first[0] + at[0]]
    }
}
