//! The spheres that went ahead of one that comes in, all with one velocity, as they are seen by one that moves with them.
//!
//! One that comes in at x touches a sphere at p, both of radii whose sum is r, until it is held back by h along the velocity's direction n:
//!
//! ```text
//! d = p − x,   (d·n + h)² + d² − (d·n)² = r²      h = √(r² − d² + (d·n)²) − d·n
//! ```

use geom::Vec3;
use std::collections::VecDeque;

/// Spheres that the next may touch.
#[derive(Debug, Clone, Default)]
pub(in crate::plan) struct Ahead {
    /// Centres and radii [m].
    spheres: VecDeque<(Vec3, f64)>,
}

impl Ahead {
    /// Forgets the first of them that are farther along the axis than this [m].
    pub fn forget(&mut self, axis: &Vec3, far: f64) {
        while self.spheres.front().is_some_and(|(p, _)| p.dot(axis) > far) {
            self.spheres.pop_front();
        }
    }

    /// One more.
    pub fn push(&mut self, centre: Vec3, radius: f64) {
        self.spheres.push_back((centre, radius));
    }

    /// How far [m] a sphere must be held back along the axis to touch none of them; from `most` on not exactly.
    pub fn clear_after(&self, centre: Vec3, radius: f64, axis: &Vec3, most: f64) -> f64 {
        let mut after = 0.0;
        while after < most {
            let here = centre - axis * after;
            let further = self.spheres.iter().filter_map(|(p, r)| {
                let (apart, reach) = (p - here, r + radius);
                let square = reach * reach - apart.norm_squared();
                let along = apart.dot(axis);
                // A little more than to the touch: rounding must not find the same one again.
                (square > 0.0).then(|| (square + along * along).sqrt() - along + 1e-9 * reach)
            });
            let further = further.fold(0.0, f64::max);
            if further == 0.0 {
                break;
            }
            after += further;
        }
        after
    }
}
