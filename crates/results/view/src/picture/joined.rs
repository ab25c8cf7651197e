//! The spheres of several layers, numbered through, and read where they are: millions of points are held once.

use super::paint::PaintedLayer;
use crate::Role;
use geom::Vec3;

/// Spheres of several layers.
pub(super) struct Joined<'a> {
    parts: Vec<Part<'a>>,
    count: usize,
}

/// What is drawn of a layer.
struct Part<'a> {
    /// Number of its first sphere.
    first: usize,
    layer: &'a PaintedLayer<'a>,
    /// Rows that are drawn; none: all of them.
    rows: Option<Vec<u32>>,
}

impl<'a> Joined<'a> {
    /// All spheres of the layers; `keep` says for a layer which of its places [m] are drawn, or none where all are.
    pub fn new<K: Fn(Vec3) -> bool>(
        layers: &[&'a PaintedLayer<'a>],
        keep: impl Fn(&PaintedLayer) -> Option<K>,
    ) -> Joined<'a> {
        let mut joined = Joined { parts: Vec::new(), count: 0 };
        for layer in layers {
            let all = 0..layer.spheres.len() as u32;
            let rows = keep(layer)
                .map(|keep| all.filter(|&row| keep(layer.spheres.at(row as usize))).collect::<Vec<u32>>());
            let count = rows.as_ref().map_or(layer.spheres.len(), Vec::len);
            joined.parts.push(Part { first: joined.count, layer, rows });
            joined.count += count;
        }
        joined
    }

    /// The layers, each with the number of its first sphere.
    pub fn layers(&self) -> impl Iterator<Item = (&'a PaintedLayer<'a>, usize)> + '_ {
        self.parts.iter().map(|part| (part.layer, part.first))
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// The centre of one [m].
    pub fn at(&self, i: usize) -> Vec3 {
        let (layer, row) = self.row(i);
        layer.spheres.at(row)
    }

    /// The radius of one [m].
    pub fn radius(&self, i: usize) -> f64 {
        let (layer, row) = self.row(i);
        layer.spheres.radius(row)
    }

    /// The colour of one, parts 0 to 1.
    pub fn colour(&self, i: usize) -> [f32; 3] {
        let (layer, row) = self.row(i);
        layer.colour[row]
    }

    /// The radius that half of them do not exceed [m].
    pub fn usual_radius(&self) -> f64 {
        let mut radii: Vec<f64> = (0..self.count).map(|i| self.radius(i)).collect();
        let middle = radii.len() / 2;
        if radii.is_empty() { 0.0 } else { *radii.select_nth_unstable_by(middle, f64::total_cmp).1 }
    }

    /// What one is.
    pub fn role(&self, i: usize) -> Role {
        self.row(i).0.role
    }

    /// The layer and the row of one.
    fn row(&self, i: usize) -> (&PaintedLayer<'a>, usize) {
        let part = &self.parts[self.parts.partition_point(|part| part.first <= i) - 1];
        let row = i - part.first;
        (part.layer, part.rows.as_ref().map_or(row, |rows| rows[row] as usize))
    }
}
