//! The box of the stone, from the views alone.

use super::carve::carve;
use super::{HullError, View};
use geom::Vec3;
use nalgebra::Matrix3;
use remesh::Samples;

/// Cells of the coarse hulls.
const COARSE: usize = 48;
/// Times that the box may grow, and then shrink.
const TIMES: usize = 4;

/// Lowest and highest corner of a box around the hull [m].
///
/// # Errors
/// As [`super::hull`].
pub fn region(views: &[View]) -> Result<[Vec3; 2], HullError> {
    if views.len() < 3 {
        return Err(HullError::Few(views.len()));
    }
    let centre = crossing(views).ok_or(HullError::Apart)?;
    let reach =
        views.iter().map(|v| reach(v, &centre)).collect::<Option<Vec<f64>>>().ok_or(HullError::Apart)?;
    let mut most = reach.iter().copied().fold(0.0, f64::max);
    for _ in 0..TIMES {
        let around = [centre - Vec3::repeat(1.5 * most), centre + Vec3::repeat(1.5 * most)];
        let samples = carve(views, &around, COARSE);
        let Some([lo, hi]) = samples.bounds() else { return Err(empty(views, &centre, most)) };
        if (0..3).all(|a| lo[a] > around[0][a] && hi[a] < around[1][a]) {
            return Ok(shrunk(views, around, samples));
        }
        most *= 2.0;
    }
    Err(HullError::Open)
}

/// A closer box, from hulls of smaller and smaller cells.
fn shrunk(views: &[View], mut around: [Vec3; 2], mut samples: Samples) -> [Vec3; 2] {
    for _ in 0..TIMES {
        let Some([lo, hi]) = samples.bounds() else { break };
        // What is thinner than a cell may lie beyond the nodes inside.
        let margin = Vec3::repeat(2.0 * samples.step);
        let next = [(lo - margin).sup(&around[0]), (hi + margin).inf(&around[1])];
        let shrinks = (next[1] - next[0]).max() < 0.8 * (around[1] - around[0]).max();
        around = next;
        if !shrinks {
            break;
        }
        samples = carve(views, &around, COARSE);
    }
    around
}

/// The place nearest to the rays through the middles of the silhouettes.
fn crossing(views: &[View]) -> Option<Vec3> {
    let (mut sum, mut right) = (Matrix3::zeros(), Vec3::zeros());
    for view in views {
        let ray = view.camera.ray(view.field.middle());
        let across = Matrix3::identity() - ray * ray.transpose();
        sum += across;
        right += across * view.camera.eye();
    }
    sum.try_inverse().map(|inverse| inverse * right).filter(|p| p.iter().all(|c| c.is_finite()))
}

/// How far the silhouette reaches from a place, at its depth [m]; `None` behind the camera.
fn reach(view: &View, centre: &Vec3) -> Option<f64> {
    let ([x, y], depth) = view.camera.project(centre);
    let far = view.field.corners().into_iter().map(|[u, v]| (u - x).hypot(v - y)).fold(0.0, f64::max);
    (depth > 0.0).then(|| far * depth / view.camera.mean_focal())
}

/// What the views agree on most: how many of them, and which not.
fn empty(views: &[View], centre: &Vec3, reach: f64) -> HullError {
    const SIDE: usize = 24;
    let mut best = (0, *centre);
    for n in 0..SIDE.pow(3) {
        let at =
            [n % SIDE, n / SIDE % SIDE, n / SIDE / SIDE].map(|k| 2.0 * (k as f64 + 0.5) / SIDE as f64 - 1.0);
        let p = centre + Vec3::from(at) * reach;
        let seen = views.iter().filter(|v| v.distance(&p) > 0.0).count();
        if seen > best.0 {
            best = (seen, p);
        }
    }
    let mut others: Vec<usize> =
        (0..views.len()).filter(|k| !(views[*k].distance(&best.1) > 0.0)).map(|k| k + 1).collect();
    others.truncate(10);
    HullError::Empty { seen: best.0, views: views.len(), others }
}

#[cfg(test)]
mod tests {
    use super::super::carve::spread;

    #[test]
    fn every_view_has_its_turn() {
        for n in [1, 2, 3, 10, 144] {
            let mut all = spread(n);
            all.sort_unstable();
            assert_eq!(all, (0..n).collect::<Vec<_>>());
        }
    }
}
