//! The box of coordinates that a step looks at: all of it, or what an earlier step has left.

use super::sample::Samples;

/// Share of the samples of the earlier step outside of the box, at each end.
const TAIL: f64 = 0.005;
/// Room on each side, over the width of what is left: the earlier step may have had other specimens.
const ROOM: f64 = 0.5;
/// Least width [–].
const LEAST: f64 = 0.1;
/// Outer part of the box at each end, over its width, and the share of the samples that an even posterior has there: more than half of it reach the end.
const OUTER: f64 = 0.05;
/// Digits of its ends.
const DIGITS: f64 = 1e4;

/// Lower and upper end of each fitted parameter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Region(Vec<[f64; 2]>);

impl Region {
    /// All of `d` coordinates.
    pub fn whole(d: usize) -> Region {
        Region(vec![[0.0, 1.0]; d])
    }

    /// What samples of an earlier step have left, for the parameters `fit`; `earlier` are those of the samples.
    pub fn left_by(samples: &Samples, earlier: &[usize], fit: &[usize]) -> Region {
        let end = |p: &usize| {
            let Some(at) = earlier.iter().position(|e| e == p) else { return [0.0, 1.0] };
            let values = samples.sorted(at);
            let quantile = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
            let (low, high) = (quantile(TAIL), quantile(1.0 - TAIL));
            let room = (ROOM * (high - low)).max(0.5 * (LEAST - (high - low)));
            let digits = |z: f64| (z.clamp(0.0, 1.0) * DIGITS).round() / DIGITS;
            [digits(low - room), digits(high + room)]
        };
        Region(fit.iter().map(end).collect())
    }

    /// Number of coordinates.
    pub fn dimensions(&self) -> usize {
        self.0.len()
    }

    /// The coordinates of a point of the unit cube.
    pub fn at(&self, cube: &[f64]) -> Vec<f64> {
        self.0.iter().zip(cube).map(|([low, high], u)| low + u * (high - low)).collect()
    }

    /// The point of the unit cube with these coordinates, if it lies in it.
    pub fn cube(&self, z: &[f64]) -> Option<Vec<f64>> {
        let of =
            |([low, high], z): (&[f64; 2], &f64)| (z >= low && z <= high).then(|| (z - low) / (high - low));
        self.0.iter().zip(z).map(of).collect()
    }

    /// Whether samples of a parameter reach an end that is not one of its bounds.
    pub fn cuts(&self, at: usize, sorted: &[f64]) -> bool {
        let [low, high] = self.0[at];
        let outer = OUTER * (high - low);
        let share = |n: usize| n as f64 / sorted.len() as f64;
        let below = share(sorted.partition_point(|z| *z < low + outer));
        let above = 1.0 - share(sorted.partition_point(|z| *z <= high - outer));
        low > 0.0 && below > 0.5 * OUTER || high < 1.0 && above > 0.5 * OUTER
    }

    /// Width of a parameter's box.
    pub fn width(&self, at: usize) -> f64 {
        let [low, high] = self.0[at];
        high - low
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample::Sample;
    use super::*;

    #[test]
    fn a_region_has_room_around_what_is_left() {
        let sample = |k: u32| Sample { z: vec![0.4 + 0.2 * f64::from(k) / 1000.0, 0.95], log: 0.0 };
        let list: Vec<Sample> = (0..=1000).map(sample).collect();
        let samples = Samples { best: list[0].clone(), list, ratio: 1.0 };
        let region = Region::left_by(&samples, &[3, 5], &[3, 4, 5]);
        assert_eq!(region, Region(vec![[0.302, 0.698], [0.0, 1.0], [0.9, 1.0]]));
        assert_eq!(region.at(&[0.5, 0.5, 0.5]), [0.5, 0.5, 0.95]);
        assert!((region.cube(&[0.5, 0.25, 0.95]).unwrap()[2] - 0.5).abs() < 1e-12);
        assert_eq!(region.cube(&[0.2, 0.25, 0.95]), None);
        let even = |low: f64, high: f64| {
            (0..200).map(|k| low + (high - low) * f64::from(k) / 199.0).collect::<Vec<_>>()
        };
        assert!(region.cuts(0, &even(0.302, 0.698)) && !region.cuts(0, &even(0.35, 0.65)));
        assert!(region.cuts(0, &even(0.6, 0.698)) && !region.cuts(1, &even(0.0, 1.0)));
        assert!(!region.cuts(2, &even(0.95, 1.0)) && region.cuts(2, &even(0.9, 1.0)));
    }
}
