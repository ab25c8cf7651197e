//! Which way grains run down a tilted wall: rows lead them more than blue noise.

use crate::of_walls;
use crate::sphere_walls::drift::{Run, Slope, anisotropy, runs, squared_drift};
use crate::sphere_walls::plates::{Layout, spheres};
use grainpipe_tests::findings::Case;
use sampling::Method;
use std::f64::consts::FRAC_PI_8;

const EVEN: Case = of_walls(
    "blue noise deflects grains less than rows do: upper end of the 95 % interval of its drift, from ten walls, over the lower end \
     of that of rows",
);
const ROWS: Case =
    of_walls("a grid deflects grains along its rows: lower end of the 95 % interval of the drift is above 0");

#[test]
fn rows_lead_grains_aside_more_than_blue_noise() {
    let lowest = [Layout::Square, Layout::Sampled(Method::Grid, 1)].map(|layout| {
        let found = anisotropy(&on(layout), 200).drift;
        ROWS.within(layout.name(), found.off / found.mean, "of the drift (half of the interval)", 0.8);
        found.mean - found.off
    });
    // One wall has patches that lead grains this way or that, and grains that start side by side run over the same ones.
    let walls: Vec<Vec<Run>> = (1..=10).map(|seed| on(Layout::Sampled(Method::Poisson, seed))).collect();
    let blue = squared_drift(&walls);
    let highest = (blue.mean + blue.off).max(0.0).sqrt();
    EVEN.within("ζ/P = 0.1, 15°", highest / lowest[0].min(lowest[1]), "of that of rows", 1.0);
}

fn on(layout: Layout) -> Vec<Run> {
    let (p, r) = (0.01, 0.006);
    let slope = Slope {
        tilt: 15f64.to_radians(),
        radius: r,
        friction: 0.5,
        restitution: 0.5,
        time: 0.8,
        side: 10,
        apart: 0.05,
    };
    let azimuths: Vec<f64> = (0..8).map(|k| f64::from(k) * FRAC_PI_8 / 2.0).collect();
    let (wall, _) = spheres(&layout.points(p, 2.0), 0.1 * p, 2.0 * r);
    runs(&wall, slope, &azimuths)
}
