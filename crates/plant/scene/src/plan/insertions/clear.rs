//! Whether the grains of an insertion meet a wall at rest before they have left its shape.

use crate::plan::grains::random::generator;
use crate::plan::insertions::feed::Feed;
use dem::setup::{Wall, WallElement};
use geom::Vec3;
use geom::mesh::closest_point;

/// Places across the flow that are tried, of the smallest and of the largest grains each.
const PLACES: usize = 100;
/// Points on the way of each, at most.
const POINTS: usize = 64;
/// Overlap over the radius that counts [–]: walls of spheres stand out by more than their surface.
const INSIDE: f64 = 1e-2;

/// How deep a grain would be in a wall.
pub(in crate::plan) struct Met {
    /// [m].
    pub overlap: f64,
    /// Whether it is so when the grain becomes free; otherwise it meets the wall on its way.
    pub at_end: bool,
}

/// One that is on its way into or through a wall: of some random grains, the one that is deepest in it. A wall that they touch from the beginning is one that they come in through.
pub(in crate::plan) fn meets(feed: &Feed, wall: &Wall) -> Option<Met> {
    let (range, section) = (feed.inserted.grading.range(), &feed.section);
    let mut random = generator(0, 5, 0);
    let radii = [range.low / 2.0, range.high / 2.0];
    let all = section.box_around(radii[1]);
    let elements: Vec<WallElement> =
        wall.shape.elements().into_iter().filter(|element| touches(element, &all)).collect();
    let mut worst: Option<Met> = None;
    for radius in radii.into_iter().flat_map(|radius| [radius; PLACES]) {
        let Some(across) = section.candidate(radius, &mut random) else { continue };
        let [start, end] = [section.ranges[0].0, section.ranges[0].1].map(|x| across + section.frame[0] * x);
        let reach = Vec3::repeat(radius);
        let path = (start.inf(&end) - reach, start.sup(&end) + reach);
        let near: Vec<&WallElement> = elements.iter().filter(|element| touches(element, &path)).collect();
        let points = ((2.0 * (end - start).norm() / radius).ceil() as usize).clamp(1, POINTS);
        let mut clear = false;
        for n in 0..=points {
            let centre = start + (end - start) * (n as f64 / points as f64);
            let overlap = near.iter().map(|element| overlap(element, &centre, radius)).fold(0.0, f64::max);
            let (deep, at_end) = (overlap > INSIDE * radius, n == points);
            if deep && (clear || at_end) && worst.as_ref().is_none_or(|worst| overlap > worst.overlap) {
                worst = Some(Met { overlap, at_end: !clear });
            }
            clear |= overlap <= 0.0;
        }
    }
    worst
}

/// Overlap of a sphere with an element of a wall [m].
fn overlap(element: &WallElement, centre: &Vec3, radius: f64) -> f64 {
    match *element {
        WallElement::Sphere(of, other) => radius + other - (of - centre).norm(),
        WallElement::Plane(plane) => radius - plane.signed_distance(centre),
        WallElement::Triangle(corners) => radius - (closest_point(corners, *centre) - centre).norm(),
    }
}

/// Whether an element may reach into a box.
fn touches(element: &WallElement, (low, high): &(Vec3, Vec3)) -> bool {
    let (from, to) = match *element {
        WallElement::Sphere(centre, radius) => (centre - Vec3::repeat(radius), centre + Vec3::repeat(radius)),
        WallElement::Plane(_) => return true,
        WallElement::Triangle([a, b, c]) => (a.inf(&b).inf(&c), a.sup(&b).sup(&c)),
    };
    (0..3).all(|axis| from[axis] <= high[axis] && to[axis] >= low[axis])
}
