//! Holes beside a region that is four times as sparse: they are found by the spacing around them, and the report says how small they may be.

mod random;

use cloud::Cloud;
use cloud::fill::{Filled, Settings};
use geom::Vec3;
use random::Random;
use stream::Table;

/// Side of the two squares, of spacing 1 and 4.
const SIDE: f64 = 140.0;

/// The dense square without discs at (x, y, radius), beside the sparse one.
fn beside_sparse(holes: &[(f64, f64, f64)], regions: &[&str]) -> Filled {
    let mut random = Random(3);
    let mut points = Vec::new();
    for (first, spacing) in [(0.0, 1.0), (SIDE, 4.0)] {
        for _ in 0..(SIDE * SIDE / (spacing * spacing)) as usize {
            let (x, y) = (first + SIDE * random.next(), SIDE * random.next());
            points.push(Vec3::new(x, y, 0.2 * spacing * random.normal()));
        }
    }
    points.retain(|p| holes.iter().all(|(x, y, radius)| (p.x - x).hypot(p.y - y) >= *radius));
    let cloud = Cloud { attributes: Table::with_rows(points.len()), points, ..Cloud::default() };
    let regions = regions.iter().map(|text| text.parse().unwrap()).collect();
    cloud::fill(cloud, &Settings { regions, ..Settings::default() }).unwrap()
}

#[test]
fn a_hole_in_the_dense_part_is_found_beside_a_sparse_one_and_none_is_made_up() {
    let holes = [(40.0, 50.0, 6.0), (90.0, 100.0, 4.5), (SIDE + 70.0, 70.0, 20.0)];
    let filled = beside_sparse(&holes, &[]);
    assert_eq!(filled.report.holes.len(), 3, "{:?}", filled.report.holes);
    for (x, y, radius) in holes {
        let near = |h: &&cloud::fill::HoleReport| (h.centre[0] - x).hypot(h.centre[1] - y) < 0.5 * radius;
        assert!(
            filled.report.holes.iter().any(|h| near(&h) && h.added > 0),
            "{x}, {y}: {:?}",
            filled.report.holes
        );
    }
    // What each scale can find is said: from 8 spacings of the dense part to 8 of the sparse one.
    let smallest: Vec<f64> = filled.report.scales.iter().map(|s| s.smallest_hole).collect();
    assert!(smallest[0] < 10.0 && smallest[smallest.len() - 1] > 25.0, "{smallest:?}");
    assert_eq!(beside_sparse(&[], &[]).report.holes, [], "a whole surface has no hole");
}

#[test]
fn a_region_around_a_hole_finds_it_and_says_how_small_it_may_be() {
    let regions = ["sphere:40,50,0,12", "sphere:90,100,0,8", "sphere:40,50,900,12"];
    let filled = beside_sparse(&[(40.0, 50.0, 6.0)], &regions);
    assert_eq!(filled.report.holes.len(), 1, "{:?}", filled.report.holes);
    let [hole, whole, nowhere] = &filled.report.regions[..] else { panic!("{:?}", filled.report.regions) };
    assert_eq!([hole.holes, whole.holes, nowhere.holes], [1, 0, 0]);
    for region in [hole, whole] {
        assert!((0.8..1.25).contains(&region.spacing.unwrap()), "{region:?}");
        assert!((6.5..10.0).contains(&region.smallest_hole.unwrap()), "{region:?}");
    }
    assert_eq!((nowhere.points, nowhere.spacing, nowhere.smallest_hole), (0, None, None));
}
