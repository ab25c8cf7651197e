//! How many grains, wall spheres and points a picture shows.

use crate::GrainCount;
use crate::things::bodies::counted;

/// What there is of each kind.
#[derive(Clone, Copy, Default)]
pub(super) struct Counts {
    pub grains: GrainCount,
    pub walls: usize,
    pub points: usize,
}

impl Counts {
    /// In words; the grains are drawn at the share `shrunk` of their size.
    pub fn words(self, shrunk: f64) -> String {
        let of = |count: usize, word: &str| (count > 0).then(|| counted(count, word));
        let grains = Some(self.grains.to_string()).filter(|words| !words.is_empty());
        let grains = grains.map(|words| match shrunk {
            1.0 => words,
            shrunk => format!("{words} at {:.0} % of their size", 100.0 * shrunk),
        });
        let words = [grains, of(self.walls, "wall spheres"), of(self.points, "points")];
        words.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}
