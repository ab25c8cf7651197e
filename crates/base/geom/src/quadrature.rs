//! Gauss and Legendre's quadrature.

use std::f64::consts::PI;

/// Nodes and weights for `count` points on [−1, 1]: Newton's method on the Legendre polynomial, from Tricomi's estimate.
pub fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let node = |k: usize| {
        let mut x = libm::cos(PI * (k as f64 + 0.75) / (n + 0.5));
        let mut slope = 0.0;
        for _ in 0..20 {
            let (mut before, mut now) = (1.0, x);
            for m in 2..=count {
                let m = m as f64;
                (before, now) = (now, ((2.0 * m - 1.0) * x * now - (m - 1.0) * before) / m);
            }
            slope = n * (x * now - before) / (x * x - 1.0);
            x -= now / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exact for polynomials up to the degree 2n − 1.
    #[test]
    fn polynomials_are_exact() {
        for count in [1, 2, 7, 24] {
            for degree in 0..2 * count as i32 {
                let sum: f64 = gauss_legendre(count).iter().map(|(x, w)| w * x.powi(degree)).sum();
                let exact = if degree % 2 == 0 { 2.0 / f64::from(degree + 1) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-13, "{count} {degree}: {sum} {exact}");
            }
        }
    }
}
