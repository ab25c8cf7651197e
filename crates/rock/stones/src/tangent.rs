//! Spheres that touch the surface from inside: Ferellec & McDowell (2010), Granular Matter 12, 459–467, doi:10.1007/s10035-010-0205-8.
//!
//! From a random point of the surface a sphere grows along the inward normal until it meets the surface elsewhere. If it is at least as large as the
//! smallest allowed radius, it is taken, and all surface points within a distance d of it are done. The next point is a random one of those that are
//! left. Small d: many spheres. If a number of spheres is wanted, d is found by bisection.
//!
//! Deviations: the points are spread over the faces, not the vertices of the mesh. The largest radius is found by shrinking a ball to the nearest point of the surface, r = |q − p|²/(2 n·(q − p)), until nothing of the
//! surface is inside (Ma, Bae & Choi 2012, doi:10.1007/s00371-011-0594-7), not by growing it in steps. It is cut to the distance of its centre to the
//! surface, so a sphere never leaves the stone.

use crate::clump::{ClumpSettings, MOST_SPHERES, Sphere};
use crate::samples::{Samples, SurfacePoint};
use crate::stone::Stone;
use geom::random::{generator, unit};
use rayon::prelude::*;

/// Steps of shrinking, and of the bisection.
const SHRINK: usize = 60;
const HALVES: usize = 40;
/// Stream of random numbers.
const ORDER: u64 = 0x7461_6e67;

/// The spheres that the settings ask for; covers them in `samples`.
pub(crate) fn spheres(
    stone: &Stone,
    settings: &ClumpSettings,
    points: &[SurfacePoint],
    samples: &mut Samples,
    least_radius: f64,
    enough: impl Fn(usize, f64) -> bool,
) -> Vec<Sphere> {
    let inscribed: Vec<Sphere> = points.par_iter().map(|p| inscribed(stone, p)).collect();
    let order = shuffled(points.len(), settings.seed);
    let chosen = |d: f64, most: usize| choose(points, &inscribed, &order, least_radius, d, most);
    let diameter = stone.diameter();
    let taken = match (settings.distance, settings.spheres) {
        (Some(d), most) => chosen(d, most.unwrap_or(MOST_SPHERES)),
        (None, Some(most)) => {
            // A larger distance takes fewer spheres.
            let (mut low, mut high) = ((1e-6 * diameter).ln(), diameter.ln());
            for _ in 0..HALVES {
                let middle = 0.5 * (low + high);
                match chosen(middle.exp(), most + 1).len() <= most {
                    true => high = middle,
                    false => low = middle,
                }
            }
            chosen(high.exp(), most)
        }
        (None, None) => {
            let mut d = diameter / 4.0;
            loop {
                let taken = chosen(d, MOST_SPHERES);
                let mut trial = samples.clone();
                taken.iter().for_each(|s| trial.cover(*s));
                if enough(taken.len(), trial.uncovered())
                    || taken.len() == MOST_SPHERES
                    || d < 1e-5 * diameter
                {
                    break taken;
                }
                d *= 0.8;
            }
        }
    };
    taken.iter().for_each(|s| samples.cover(*s));
    taken
}

/// The largest sphere inside that touches the surface at a point.
fn inscribed(stone: &Stone, at: &SurfacePoint) -> Sphere {
    let (p, n) = (at.place, at.inwards);
    let (lo, hi) = stone.inside.bounds();
    let mut r = (hi - lo).norm();
    for _ in 0..SHRINK {
        let (q, _) = stone.closest(&(p + n * r));
        let along = (q - p).dot(&n);
        let smaller = (q - p).norm_squared() / (2.0 * along);
        // The nearest point is the one that it touches, or beyond rounding of it.
        if !(along > 0.0) || !(smaller < r * (1.0 - 1e-9)) {
            break;
        }
        r = smaller;
    }
    let centre = p + n * r;
    let room = if stone.inside.contains(&centre) { stone.inside.distance(&centre) } else { 0.0 };
    (centre, r.min(room))
}

/// The numbers below `count` in random order.
fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut random = generator(seed, ORDER, 0);
    let mut order: Vec<usize> = (0..count).collect();
    for k in (1..count).rev() {
        order.swap(k, (unit(&mut random) * (k + 1) as f64) as usize);
    }
    order
}

fn choose(
    points: &[SurfacePoint],
    inscribed: &[Sphere],
    order: &[usize],
    least_radius: f64,
    distance: f64,
    most: usize,
) -> Vec<Sphere> {
    let mut done = vec![false; points.len()];
    let mut taken = Vec::new();
    for &k in order {
        if taken.len() == most {
            break;
        }
        let (centre, radius) = inscribed[k];
        if done[k] || radius < least_radius {
            continue;
        }
        for (done, point) in done.iter_mut().zip(points) {
            *done |= ((point.place - centre).norm() - radius).abs() <= distance;
        }
        taken.push(inscribed[k]);
    }
    taken
}
