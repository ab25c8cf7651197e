//! Points that cloud-fill adds, against the surface that was scanned.

use crate::of_walls;
use crate::sphere_walls::filling::{Scan, Surface, fill};
use grainpipe_tests::findings::Case;

const CLOSES: Case = of_walls(
    "a ball wider than the hole closes it, a ball half as wide does not: share of missing points added",
);
const LIES: Case = of_walls(
    "points that cloud-fill adds lie on the scanned surface: root mean square distance over the hole's width",
);

#[test]
fn added_points_lie_on_the_surface() {
    for surface in [Surface::Plane, Surface::Pipe(0.4), Surface::Ball(0.4)] {
        let scan = Scan { surface, spacing: 0.006, hole: 0.12, noise: 0.0 };
        for ball in [0.07, 0.12, 0.4] {
            let filled = fill(scan, &[ball], 1);
            assert!(!filled.open, "{} with a ball of {ball} m", surface.name());
            let on = format!("{}, ball of {:.1} holes", surface.name(), ball / scan.hole);
            CLOSES.within(&on, filled.share - 1.0, "of the points", 0.1);
            LIES.within(&on, filled.off / scan.hole, "–", 1e-3);
        }
        let small = fill(scan, &[0.03], 1);
        assert!(small.open && small.share < 0.5, "{}: {small:?}", surface.name());
    }
}
