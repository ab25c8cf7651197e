//! Means and their uncertainty, medians, and a line through points with outliers.
//!
//! Theil–Sen: the slope is the median of the slopes of all pairs of points, and breaks down only when 29 % of the
//! points are wrong. Theil (1950), Proc. KNAW 53; Sen (1968), J. Am. Stat. Assoc. 63, DOI 10.1080/01621459.1968.10480934,
//! whose interval is used: with N slopes in order, those of rank (N ∓ C)/2, C = 1.96 √(n (n − 1)(2n + 5)/18).

use std::f64::consts::PI;

/// The value in the middle (of two, their mean); NaN for none.
pub fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// The value below which a share of all lies, with linear interpolation; NaN for none.
pub fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return f64::NAN };
    let at = share.clamp(0.0, 1.0) * last as f64;
    let below = at.floor() as usize;
    let above = (below + 1).min(last);
    values[below] + (values[above] - values[below]) * (at - below as f64)
}

/// A mean and what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Number of values.
    pub count: usize,
    /// The mean; NaN for no value.
    pub mean: f64,
    /// Standard deviation of the values; NaN for fewer than two.
    pub deviation: f64,
    /// Half width of the 95 % interval of the mean (Student's t); NaN for fewer than two values.
    pub interval: f64,
}

impl Mean {
    /// Of independent values.
    pub fn of(values: &[f64]) -> Mean {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let deviation = if n >= 2.0 { (squares / (n - 1.0)).sqrt() } else { f64::NAN };
        let interval = student(values.len().saturating_sub(1)) * deviation / n.sqrt();
        Mean { count: values.len(), mean, deviation, interval }
    }
}

/// t with P(|T| < t) = 0.95 for ν degrees of freedom, by halving on Abramowitz & Stegun 26.7.3 and 26.7.4. The crate statrs (0.18)
/// agrees to 3e-13 up to ν = 1000, but is off by 3.5e-6 at ν = 10⁵, where Fisher's expansion confirms this one.
pub fn student(nu: usize) -> f64 {
    if nu == 0 {
        return f64::NAN;
    }
    let (mut low, mut high) = (1.0, 20.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if within(middle, nu) < 0.95 { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// P(|T| < t) for ν degrees of freedom.
fn within(t: f64, nu: usize) -> f64 {
    let theta = libm::atan2(t, (nu as f64).sqrt());
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    let odd = nu % 2 == 1;
    let mut term = if odd { cos } else { 1.0 };
    let mut sum = 0.0;
    for k in 0..nu / 2 {
        sum += term;
        let (over, under) = if odd { (2 * k + 2, 2 * k + 3) } else { (2 * k + 1, 2 * k + 2) };
        term *= over as f64 / under as f64 * cos * cos;
    }
    if odd { 2.0 / PI * (theta + sin * sum) } else { sin * sum }
}

/// A robust line y = intercept + slope x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    pub slope: f64,
    /// 95 % interval of the slope.
    pub interval: [f64; 2],
    /// Value at x = 0.
    pub intercept: f64,
}

/// The Theil–Sen line; `None` for fewer than two different x.
pub fn theil_sen(points: &[[f64; 2]]) -> Option<Line> {
    let mut slopes = Vec::with_capacity(points.len() * points.len().saturating_sub(1) / 2);
    for (k, a) in points.iter().enumerate() {
        slopes.extend(points[k + 1..].iter().filter(|b| b[0] != a[0]).map(|b| (b[1] - a[1]) / (b[0] - a[0])));
    }
    if slopes.is_empty() {
        return None;
    }
    let slope = median(&mut slopes);
    let (n, all) = (points.len() as f64, slopes.len() as f64);
    let c = 1.96 * (n * (n - 1.0) * (2.0 * n + 5.0) / 18.0).sqrt();
    let ranked = |rank: f64| slopes[(rank.max(0.0) as usize).min(slopes.len() - 1)];
    // Sen (1968), doi:10.2307/2285891, counts ranks from 1: the lower one is M1, the upper one M2 + 1.
    let interval = [ranked(((all - c) / 2.0).floor() - 1.0), ranked(((all + c) / 2.0).ceil())];
    let mut rest: Vec<f64> = points.iter().map(|p| p[1] - slope * p[0]).collect();
    Some(Line { slope, interval, intercept: median(&mut rest) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SciPy's `theilslopes` finds 1, and −0.6 to 2.6, of these points; it rounds ranks, which are rounded outwards here.
    #[test]
    fn the_interval_of_a_slope_is_mirrored_with_the_points() {
        let points: Vec<[f64; 2]> =
            (0..12).map(|k| [f64::from(k), f64::from(k) + 2.0 * f64::from(k * k * 7 % 11)]).collect();
        let mirrored: Vec<[f64; 2]> = points.iter().map(|p| [p[0], -p[1]]).collect();
        let [a, b] = [points, mirrored].map(|points| theil_sen(&points).unwrap());
        assert!(a.slope == 1.0 && a.interval == [-2.0 / 3.0, 8.0 / 3.0], "{a:?}");
        assert_eq!(a.slope, -b.slope);
        assert_eq!(a.interval, [-b.interval[1], -b.interval[0]]);
    }

    #[test]
    fn students_t_is_that_of_the_tables() {
        for (nu, t) in [(1, 12.706), (2, 4.303), (5, 2.571), (7, 2.365), (30, 2.042), (1000, 1.962)] {
            assert!((student(nu) - t).abs() < 6e-4, "{nu}: {}", student(nu));
        }
        // Fisher's expansion about the normal distribution: z + (z³ + z)/4ν + (5 z⁵ + 16 z³ + 3 z)/96ν².
        let (z, nu) = (1.959963984540054f64, 1e5);
        let t = z
            + (z.powi(3) + z) / (4.0 * nu)
            + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * nu * nu);
        assert!((student(100_000) - t).abs() < 1e-9, "{} instead of {t}", student(100_000));
    }

    #[test]
    fn a_quarter_of_outliers_does_not_move_the_line() {
        let points: Vec<[f64; 2]> = (0..20)
            .map(|k| [f64::from(k), if k % 4 == 0 { 50.0 } else { 3.0 - 0.5 * f64::from(k) }])
            .collect();
        let line = theil_sen(&points).unwrap();
        assert!((line.slope + 0.5).abs() < 1e-12 && (line.intercept - 3.0).abs() < 1e-12, "{line:?}");
        assert!(line.interval[0] <= line.slope && line.slope <= line.interval[1]);
        assert!(theil_sen(&[[1.0, 2.0], [1.0, 3.0]]).is_none());
    }

    #[test]
    fn mean_and_interval() {
        let mean = Mean::of(&[1.0, 2.0, 3.0]);
        assert!((mean.mean - 2.0).abs() < 1e-15 && (mean.deviation - 1.0).abs() < 1e-15);
        assert!((mean.interval - 4.303 / 3f64.sqrt()).abs() < 1e-3);
        assert_eq!(quantile(&mut [3.0, 1.0, 2.0, 4.0], 0.5), 2.5);
    }
}
