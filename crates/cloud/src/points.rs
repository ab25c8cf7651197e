//! The cloud: positions as `f64`, and every other property as it came.

use geom::Vec3;
use stream::Table;

/// Points of a scanned surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    /// Positions [m].
    pub points: Vec<Vec3>,
    /// Every property besides x, y, z, in the order of the file; as many rows as points.
    pub attributes: Table,
    /// Whether x, y, z are `double` in the file (they are written as they came).
    pub double: bool,
    /// Place of x among the columns of the file (y and z follow it), so that order is kept.
    pub position_column: usize,
    /// Comment lines of the header.
    pub comments: Vec<String>,
}

impl Cloud {
    /// The given points with their properties, in that order.
    pub fn select(&self, rows: &[u32]) -> Cloud {
        Cloud {
            points: rows.iter().map(|&r| self.points[r as usize]).collect(),
            attributes: self.attributes.select(rows),
            comments: self.comments.clone(),
            ..*self
        }
    }

    /// The points whose coordinates are all finite, and how many were not.
    pub fn finite(self) -> (Cloud, usize) {
        let is_finite = |p: &Vec3| p.x.is_finite() && p.y.is_finite() && p.z.is_finite();
        let bad = self.points.iter().filter(|p| !is_finite(p)).count();
        if bad == 0 {
            return (self, 0);
        }
        let rows = (0u32..).zip(&self.points).filter(|(_, p)| is_finite(p)).map(|(i, _)| i);
        let rows: Vec<u32> = rows.collect();
        (self.select(&rows), bad)
    }
}
