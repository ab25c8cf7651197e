//! Clouds of which many points lie in one place.

use super::cloud::Cloud;
use super::places::distinct;
use super::units::{self, UnitWarning};
use geom::Vec3;

/// The cloud with one point of each place, if many of its points lie in one place, and how many points that leaves out. Points without finite coordinates stay.
pub fn without_crowds(cloud: Cloud) -> (Cloud, usize) {
    // Looks at some points only: most clouds have no such place, and cost no more.
    if !units::warnings(&cloud).iter().any(|warning| matches!(warning, UnitWarning::Crowd { .. })) {
        return (cloud, 0);
    }
    let is_finite = |row: &u32| cloud.points[*row as usize].iter().all(|c| c.is_finite());
    let (finite, mut rows): (Vec<u32>, Vec<u32>) = (0..cloud.points.len() as u32).partition(is_finite);
    let points: Vec<Vec3> = finite.iter().map(|&row| cloud.points[row as usize]).collect();
    rows.extend(distinct(&points, 0.0).into_iter().map(|at| finite[at as usize]));
    rows.sort_unstable();
    let left_out = cloud.points.len() - rows.len();
    (if left_out > 0 { cloud.select(&rows) } else { cloud }, left_out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_crowd_one_point_stays() {
        let mut points: Vec<Vec3> = (0..500).map(|k| Vec3::new(f64::from(k), 0.0, 0.0)).collect();
        points.splice(100..100, [Vec3::new(0.0, -0.0, 0.0); 60]);
        points.push(Vec3::repeat(f64::NAN));
        let attributes = stream::Table::with_rows(points.len());
        let (thinned, left_out) = without_crowds(Cloud { points, attributes, ..Cloud::default() });
        assert_eq!((thinned.points.len(), left_out), (501, 60));
        assert_eq!(without_crowds(thinned).1, 0);
    }
}
