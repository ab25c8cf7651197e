//! Random orientations, and numbers that fill a square evenly.

pub(crate) use geom::random::{even, orientation, random_orientation};

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    /// Of a uniform rotation, the mean of R is 0 and that of R₁₁² is 1/3, R₁₁⁴ is 1/5; a random axis with a uniform angle has 0.47 and 0.38.
    #[test]
    fn orientations_are_uniform() {
        let mut random = geom::random::generator(1, 2, 3);
        let n = 20_000;
        let (mut mean, mut square, mut fourth) = (Vec3::zeros(), Vec3::zeros(), 0.0);
        for _ in 0..n {
            let x = random_orientation(&mut random) * Vec3::x();
            mean += x / f64::from(n);
            square += x.component_mul(&x) / f64::from(n);
            fourth += x.x.powi(4) / f64::from(n);
        }
        // Four deviations of the mean of n.
        assert!(mean.amax() < 4.0 * (1.0 / 3.0 / f64::from(n)).sqrt(), "{mean}");
        assert!(
            (square - Vec3::repeat(1.0 / 3.0)).amax() < 4.0 * (4.0 / 45.0 / f64::from(n)).sqrt(),
            "{square}"
        );
        assert!((fourth - 0.2).abs() < 4.0 * (16.0 / 225.0 / f64::from(n)).sqrt(), "{fourth}");
    }
}
