//! Images of a place across periodic faces, for what is placed at t = 0.

use geom::Vec3;

/// Images along one axis, at most: more are those of a cell that is far smaller than what is in it.
const MOST: usize = 5;

/// Which axes are periodic, and the lowest and highest coordinate of each of these [m].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::plan) struct Images {
    range: [Option<(f64, f64)>; 3],
}

impl Images {
    pub(in crate::plan) fn new(range: [Option<(f64, f64)>; 3]) -> Images {
        Images { range }
    }

    /// Whether there are none.
    pub(in crate::plan) fn is_empty(&self) -> bool {
        self.range.iter().all(Option::is_none)
    }

    /// Length of the cell along an axis [m]; `None` along an open one.
    pub(in crate::plan) fn length(&self, axis: usize) -> Option<f64> {
        self.range[axis].map(|(low, high)| high - low)
    }

    /// The image in the cell [m].
    pub(in crate::plan) fn home(&self, at: &Vec3) -> Vec3 {
        Vec3::from_fn(|a, _| match self.range[a] {
            Some((low, high)) => at[a] - ((at[a] - low) / (high - low)).floor() * (high - low),
            None => at[a],
        })
    }

    /// All images of a place that lie between two corners [m] along the periodic axes; itself, wherever it is, where there are none.
    pub(in crate::plan) fn between(
        &self,
        at: Vec3,
        low: &Vec3,
        high: &Vec3,
    ) -> impl Iterator<Item = Vec3> + use<> {
        let along = |a: usize| {
            let Some(length) = self.length(a) else { return (1, [at[a]; MOST]) };
            let first = ((low[a] - at[a]) / length).ceil();
            let mut places = [at[a]; MOST];
            let mut count = 0;
            for (k, place) in places.iter_mut().enumerate() {
                // The place itself keeps its bits.
                *place = at[a] + (first + k as f64) * length;
                if *place > high[a] {
                    break;
                }
                count += 1;
            }
            (count, places)
        };
        let [x, y, z] = [0, 1, 2].map(along);
        let all = (0..z.0).flat_map(move |k| (0..y.0).flat_map(move |j| (0..x.0).map(move |i| (i, j, k))));
        all.map(move |(i, j, k)| Vec3::new(x.1[i], y.1[j], z.1[k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_lie_whole_periods_apart_and_between_the_corners() {
        let images = Images::new([Some((0.0, 2.0)), None, Some((-1.0, 1.0))]);
        let at = Vec3::new(0.25, 7.0, 0.5);
        let found: Vec<Vec3> =
            images.between(at, &Vec3::new(-2.0, 0.0, 0.0), &Vec3::new(3.0, 0.0, 1.0)).collect();
        assert_eq!(found, [-1.75, 0.25, 2.25].map(|x| Vec3::new(x, 7.0, 0.5)));
        assert_eq!(images.between(at, &Vec3::repeat(1.0), &Vec3::repeat(2.0)).count(), 0);
        assert_eq!(images.home(&Vec3::new(-0.5, 9.0, 3.25)), Vec3::new(1.5, 9.0, -0.75));
        let none = Images::default();
        assert!(none.is_empty() && !images.is_empty());
        assert_eq!(none.between(at, &Vec3::repeat(8.0), &Vec3::repeat(9.0)).collect::<Vec<_>>(), [at]);
        assert_eq!(images.between(at, &Vec3::repeat(-1e9), &Vec3::repeat(1e9)).count(), MOST * MOST);
    }
}
