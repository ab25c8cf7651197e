//! The box of coordinates that most even points of a step lie in: all of it, or what the step that it refines has left.

use super::sample::Samples;

/// Share of the samples of the earlier step outside of the box, at each end.
const TAIL: f64 = 0.005;
/// Room on each side, over the width of what is left: the earlier step may have had other specimens.
const ROOM: f64 = 0.5;
/// Least width [–].
const LEAST: f64 = 0.1;
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

    #[cfg(test)]
    pub fn of(ends: Vec<[f64; 2]>) -> Region {
        Region(ends)
    }

    /// What samples of `d` parameters have left.
    pub fn left_by(samples: &Samples, d: usize) -> Region {
        let end = |at: usize| {
            let values = samples.sorted(at);
            let quantile = |share: f64| values[(share * (values.len() - 1) as f64).round() as usize];
            let (low, high) = (quantile(TAIL), quantile(1.0 - TAIL));
            let room = (ROOM * (high - low)).max(0.5 * (LEAST - (high - low)));
            let digits = |z: f64| (z.clamp(0.0, 1.0) * DIGITS).round() / DIGITS;
            [digits(low - room), digits(high + room)]
        };
        Region((0..d).map(end).collect())
    }

    /// Whether it is all of the coordinates.
    pub fn is_whole(&self) -> bool {
        self.0.iter().all(|ends| *ends == [0.0, 1.0])
    }

    /// Number of coordinates.
    pub fn dimensions(&self) -> usize {
        self.0.len()
    }

    /// The coordinates of a point of the unit cube.
    pub fn at(&self, cube: &[f64]) -> Vec<f64> {
        self.0.iter().zip(cube).map(|([low, high], u)| low + u * (high - low)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample::PosteriorPoint;
    use super::*;

    #[test]
    fn a_region_has_room_around_what_is_left() {
        let sample = |k: u32| PosteriorPoint { z: vec![0.4 + 0.2 * f64::from(k) / 1000.0, 0.95], log: 0.0 };
        let list: Vec<PosteriorPoint> = (0..=1000).map(sample).collect();
        let samples = Samples { list, ratio: 1.0 };
        let region = Region::left_by(&samples, 2);
        assert_eq!(region, Region(vec![[0.302, 0.698], [0.9, 1.0]]));
        assert_eq!(region.at(&[0.5, 0.5]), [0.5, 0.95]);
    }
}
