//! The spacing of a cloud around each position, as a smooth field.
//!
//! ```text
//! sample    a random part q of the points, about N/64 + 16 000
//! density   D = k / (π r² q f) from the distance r of the k-th neighbour in the sample; f is the share of 8 sectors around the
//!           position that hold neighbours, so that the rim of a surface is not taken for a sparse place
//! spacing   s = 1/√D, then the median of the spacings of the nearest 16 of the sample
//! ```

use super::density;
use geom::{Vec3, least_axis};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::num::NonZero;

/// Points of the sample beside one of every [`EVERY`].
const SAMPLE: usize = 16_000;
/// See [`SAMPLE`].
const EVERY: usize = 64;
/// Neighbours that a density is measured by.
const NEIGHBOURS: usize = 24;
/// Of these, the nearest whose median smooths the field.
const SMOOTH: usize = 16;
/// Sectors around a position.
const SECTORS: usize = 8;

/// Spacings at the positions of a sample.
pub(crate) struct LocalSpacing {
    tree: ImmutableKdTree<f64, 3>,
    positions: Vec<[f64; 3]>,
    /// 1/√density at each [m], above 0 and finite.
    spacings: Vec<f64>,
    /// Points of the cloud that one of the sample stands for.
    pub share: f64,
}

impl LocalSpacing {
    /// None when points are too few or all at one position.
    pub fn new(points: &[Vec3]) -> Option<LocalSpacing> {
        if points.len() < density::FEWEST {
            return None;
        }
        let positions = density::spread(points, SAMPLE + points.len() / EVERY);
        let share = points.len() as f64 / positions.len() as f64;
        let tree = ImmutableKdTree::<f64, 3>::new_from_slice(&positions).ok()?;
        let mut field = LocalSpacing { tree, positions, spacings: Vec::new(), share };
        let found: Vec<(f64, [u32; SMOOTH])> = field.positions.par_iter().map(|p| field.measure(p)).collect();
        let smooth = |(own, near): &(f64, [u32; SMOOTH])| {
            let mut some: Vec<f64> =
                near.iter().map(|&i| found[i as usize].0).filter(|s| is_sound(*s)).collect();
            some.sort_by(f64::total_cmp);
            some.get(some.len() / 2).copied().unwrap_or(*own)
        };
        field.spacings = found.par_iter().map(smooth).collect();
        field.spacings.iter().any(|s| is_sound(*s)).then_some(field)
    }

    /// 1/√density at a position of the sample [m], and the nearest of the sample.
    fn measure(&self, position: &[f64; 3]) -> (f64, [u32; SMOOTH]) {
        let wanted = NonZero::new(NEIGHBOURS + 1).unwrap_or(NonZero::<usize>::MIN);
        let found = self.tree.query(position).nearest_n::<SquaredEuclidean<f64>>(wanted).execute();
        let radius2 = found.iter().map(|n| n.distance).fold(0.0, f64::max);
        let rows: Vec<u32> = found.iter().map(|n| n.item).collect();
        let offset = |&row: &u32| Vec3::from(self.positions[row as usize]) - Vec3::from(*position);
        let offsets: Vec<Vec3> = rows.iter().map(offset).collect();
        let count = rows.len().saturating_sub(1) as f64;
        let density = count / (PI * radius2 * self.share.recip() * share_of_sectors(&offsets));
        let near = std::array::from_fn(|k| rows[k.min(rows.len() - 1)]);
        (density.sqrt().recip(), near)
    }

    /// Spacing at a position [m]: that of the nearest of the sample.
    pub fn at(&self, p: &Vec3) -> f64 {
        self.spacings
            [self.tree.query(&[p.x, p.y, p.z]).nearest_one::<SquaredEuclidean<f64>>().execute().item as usize]
    }

    /// Positions of the sample and the spacings there [m], where there is one.
    pub fn all(&self) -> impl Iterator<Item = (Vec3, f64)> + '_ {
        let both = self.positions.iter().zip(&self.spacings);
        both.filter(|(_, s)| is_sound(**s)).map(|(p, s)| (Vec3::from(*p), *s))
    }
}

fn is_sound(spacing: f64) -> bool {
    spacing > 0.0 && spacing.is_finite()
}

/// Share of the sectors around the axis of least spread that hold some of the vectors [–]; 1 of vectors along one line.
fn share_of_sectors(offsets: &[Vec3]) -> f64 {
    let mean = offsets.iter().sum::<Vec3>() / offsets.len() as f64;
    let spread: Matrix3<f64> = offsets.iter().map(|d| (d - mean) * (d - mean).transpose()).sum();
    let Some(normal) = least_axis(&spread) else { return 1.0 };
    let u = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let v = normal.cross(&u);
    let mut filled = [false; SECTORS];
    for d in offsets.iter().filter(|d| d.norm_squared() > 0.0) {
        let turn = libm::atan2(d.dot(&v), d.dot(&u)) / TAU + 0.5;
        filled[(turn * SECTORS as f64) as usize % SECTORS] = true;
    }
    filled.iter().filter(|filled| **filled).count().max(1) as f64 / SECTORS as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::random::{generator, unit};

    /// A square of spacing 1 beside one of spacing 4: each is measured as it is, also at the outer rim of both.
    #[test]
    fn two_densities_are_measured_where_they_are() {
        let mut random = generator(1, 0, 0);
        let mut point =
            |first: f64| Vec3::new(first + 160.0 * unit(&mut random), 160.0 * unit(&mut random), 0.0);
        let mut points: Vec<Vec3> = (0..160 * 160).map(|_| point(0.0)).collect();
        points.extend((0..40 * 40).map(|_| point(160.0)));
        let field = LocalSpacing::new(&points).unwrap();
        for (x, wanted) in [(5.0, 1.0), (40.0, 1.0), (120.0, 1.0), (200.0, 4.0), (300.0, 4.0)] {
            for y in [20.0, 50.0, 90.0, 140.0] {
                let found = field.at(&Vec3::new(x, y, 0.0));
                assert!((0.8..1.25).contains(&(found / wanted)), "{found} for {wanted} at {x}, {y}");
            }
        }
    }

    #[test]
    fn few_or_equal_points_have_none() {
        assert!(LocalSpacing::new(&[Vec3::x(); 20]).is_none());
        assert!(LocalSpacing::new(&[Vec3::x(); 1000]).is_none());
    }
}
