//! Which way grains run down a tilted wall: rows lead them, blue noise does not.

use crate::of_walls;
use crate::sphere_walls::drift::{Slope, anisotropy, runs};
use crate::sphere_walls::plates::{Layout, spheres};
use grainpipe_tests::findings::Case;
use sampling::Method;

const EVEN: Case = of_walls(
    "blue noise does not deflect grains: sideways drift over downward speed, within its 95 % interval",
);
const ROWS: Case =
    of_walls("a grid deflects grains along its rows: lower end of the 95 % interval of the drift is above 0");

#[test]
fn rows_lead_grains_aside_and_blue_noise_does_not() {
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
    let azimuths: Vec<f64> = (0..8).map(|k| f64::from(k) * std::f64::consts::FRAC_PI_8 / 2.0).collect();
    for layout in [Layout::Square, Layout::Sampled(Method::Grid, 1), Layout::Sampled(Method::Poisson, 1)] {
        let (wall, _) = spheres(&layout.points(p, 2.0), 0.1 * p, 2.0 * r);
        let all = runs(&wall, slope, &azimuths);
        let found = anisotropy(&all, 200).drift;
        if layout == Layout::Sampled(Method::Poisson, 1) {
            EVEN.within("ζ/P = 0.1, 15°", found.mean / found.off, "of the interval", 1.0);
        } else {
            ROWS.within(layout.name(), found.off / found.mean, "of the drift (half of the interval)", 0.8);
        }
    }
}
