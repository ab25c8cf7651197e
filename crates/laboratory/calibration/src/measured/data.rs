//! Data: a measured curve or number with the deviation of each point, and the covariance of all.
//!
//! ```text
//! C_ij = s_i s_j ρ(x_i − x_j; c) + d² ρ(x_i − x_j; max(c, 0.2))      ρ(Δ; c) = exp(−|Δ|/(c X)),   X: length of the curve
//! ```
//!
//! s: deviation of a point, from the scatter of specimens, from the curve's own scatter, or given; d: discrepancy, what the model cannot
//! reproduce (Kennedy & O'Hagan 2001, doi:10.1111/1467-9868.00294, with a fixed size instead of a fitted one).
//!
//! Own scatter: differences of points from the parabola through three neighbours, so that the curve's own bend does not count (after Gasser,
//! Sroka & Jennen-Steinmetz 1986, doi:10.1093/biomet/73.3.625: there the line through two).

use nalgebra::DMatrix;

/// A point of the data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Where, in the unit of the command's column; 0 of a number.
    pub x: f64,
    /// Value.
    pub y: f64,
    pub deviation: f64,
}

/// What a test is compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Points by growing x; one of a number.
    pub points: Vec<Point>,
    /// For each point the places that it is the mean of: a simulated curve is averaged over the same ones, since a bend would shift the mean.
    pub places: Vec<Vec<f64>>,
    /// Unit of x, as text; "" for none.
    pub x_unit: String,
    /// Distance over which deviations are alike, as a share of the length.
    pub correlation: f64,
    /// What the model cannot reproduce, in the unit of y.
    pub discrepancy: f64,
    /// Specimens that the points are the mean of.
    pub specimens: usize,
    /// How the deviation is known, for people.
    pub origin: String,
}

/// Distance over which a discrepancy is alike, as a share of the length.
const SMOOTH: f64 = 0.2;

impl Target {
    /// Indices of the points of a part.
    pub fn part(&self, from: f64, until: f64) -> Vec<usize> {
        (0..self.points.len()).filter(|&k| self.points[k].x >= from && self.points[k].x <= until).collect()
    }

    /// Covariance of some points.
    pub fn covariance(&self, of: &[usize]) -> DMatrix<f64> {
        let length = self.points.last().map_or(1.0, |p| p.x) - self.points.first().map_or(0.0, |p| p.x);
        let length = if length > 0.0 { length } else { 1.0 };
        let alike = |far: f64, c: f64| match far {
            0.0 => 1.0,
            _ if c > 0.0 => libm::exp(-far / (c * length)),
            _ => 0.0,
        };
        DMatrix::from_fn(of.len(), of.len(), |i, j| {
            let (a, b) = (&self.points[of[i]], &self.points[of[j]]);
            let far = (a.x - b.x).abs();
            a.deviation * b.deviation * alike(far, self.correlation)
                + self.discrepancy * self.discrepancy * alike(far, self.correlation.max(SMOOTH))
        })
    }

    /// Largest absolute value.
    pub fn size(&self) -> f64 {
        self.points.iter().map(|p| p.y.abs()).fold(0.0, f64::max)
    }
}

/// The deviation of a curve around a smooth one; `None` for fewer than six points.
pub fn own_scatter(curve: &[(f64, f64)]) -> Option<f64> {
    if curve.len() < 6 {
        return None;
    }
    // Lagrange's weights of three neighbours at the place of the second point.
    let square = |w: &[(f64, f64)]| {
        let others = [w[0], w[2], w[3]];
        let weight = |k: usize| {
            let rest = (0..3).filter(|j| *j != k);
            rest.map(|j| (w[1].0 - others[j].0) / (others[k].0 - others[j].0)).product::<f64>()
        };
        let weights = [0, 1, 2].map(weight);
        let off = w[1].1 - (0..3).map(|k| weights[k] * others[k].1).sum::<f64>();
        off * off / (1.0 + weights.iter().map(|w| w * w).sum::<f64>())
    };
    let sum: f64 = curve.windows(4).map(square).sum();
    Some((sum / (curve.len() - 3) as f64).sqrt())
}

/// At most `most` groups of points: bins of equal width.
pub fn binned(curve: &[(f64, f64)], most: usize) -> Vec<Vec<(f64, f64)>> {
    if curve.len() <= most {
        return curve.iter().map(|&p| vec![p]).collect();
    }
    let (first, last) = (curve[0].0, curve[curve.len() - 1].0);
    let bin = |x: f64| (((x - first) / (last - first) * most as f64) as usize).min(most - 1);
    let mut bins = vec![Vec::new(); most];
    curve.iter().for_each(|&p| bins[bin(p.0)].push(p));
    bins.retain(|bin| !bin.is_empty());
    bins
}

pub fn mean(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let sum = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
    (sum.0 / n, sum.1 / n)
}

/// The value of a curve at x; `None` outside of it (beyond a thousandth of its length).
pub fn at(curve: &[(f64, f64)], x: f64) -> Option<f64> {
    let (first, last) = (curve.first()?, curve.last()?);
    let slack = 1e-3 * (last.0 - first.0);
    if x < first.0 - slack || x > last.0 + slack {
        return None;
    }
    let after = curve.partition_point(|p| p.0 < x).clamp(1, curve.len().max(2) - 1);
    let (a, b) = (curve.get(after - 1)?, curve.get(after)?);
    let share = ((x - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
    Some(a.1 + share * (b.1 - a.1))
}

/// Points whose x grows; the others are left out. The x of a servo may stand still.
pub fn growing(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut curve: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if curve.last().is_none_or(|last| point.0 > last.0) {
            curve.push(point);
        }
    }
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_of_noise_on_a_smooth_curve_is_found() {
        let mut random = geom::random::generator(1, 0, 0);
        let noise = |k: usize, random: &mut _| {
            let x = k as f64 / 400.0;
            (x, (3.0 * x).sin() + 0.1 * (12.0f64).sqrt() * (geom::random::unit(random) - 0.5))
        };
        let curve: Vec<_> = (0..400).map(|k| noise(k, &mut random)).collect();
        let found = own_scatter(&curve).unwrap();
        assert!((found - 0.1).abs() < 0.01, "{found}");
        let bins = binned(&curve, 20);
        assert_eq!((bins.len(), bins.iter().map(Vec::len).sum::<usize>()), (20, 400));
    }

    #[test]
    fn curves_are_read_between_their_points_only() {
        let curve = [(0.0, 0.0), (1.0, 2.0), (3.0, 0.0)];
        assert_eq!((at(&curve, 0.5), at(&curve, 2.0), at(&curve, 3.0)), (Some(1.0), Some(1.0), Some(0.0)));
        assert_eq!((at(&curve, 3.1), at(&curve, -0.1)), (None, None));
        assert_eq!(
            growing([(0.0, 1.0), (0.0, 2.0), (1.0, 3.0), (0.5, 4.0)].into_iter()),
            [(0.0, 1.0), (1.0, 3.0)]
        );
    }

    #[test]
    fn covariance_is_that_of_scatter_and_discrepancy() {
        let point = |x: f64| Point { x, y: 1.0, deviation: 2.0 };
        let mut t = Target {
            points: vec![point(0.0), point(1.0)],
            places: Vec::new(),
            x_unit: String::new(),
            correlation: 0.0,
            discrepancy: 0.0,
            specimens: 1,
            origin: String::new(),
        };
        assert_eq!(t.covariance(&[0, 1]), DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 4.0]));
        (t.correlation, t.discrepancy) = (0.5, 3.0);
        let c = t.covariance(&[0, 1]);
        assert!((c[(0, 1)] - 13.0 * (-2.0f64).exp()).abs() < 1e-12 && c[(0, 0)] == 13.0, "{c}");
    }
}
