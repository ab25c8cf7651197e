//! The tilt at which a grain leaves its pocket.

use crate::of_walls;
use crate::sphere_walls::chance::places;
use crate::sphere_walls::holding::{Grain, Tilting, blocked_tilt, bound, closed_tilt, leaving_tilts};
use crate::sphere_walls::plates::{Layout, spheres};
use grainpipe_tests::findings::Case;
use sampling::Method;

const P: f64 = 0.01;
const R: f64 = 0.006;
const HOLDS: Case = of_walls("a grain rolls or slides out of its pocket at tan α = s(u)/H");
const WEDGED: Case = of_walls("a grain that cannot roll slides out at arctan(s/H) + arctan(μ/cos β)");
const BOUND: Case =
    of_walls("no grain without friction is held above tan α = c/H, the steepest slope of the wall");
/// Step of tilt [rad].
const TILT: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// Steps of tilt, in which a grain may be slow to leave.
const LATE: f64 = 2.5 * TILT;

#[test]
fn pockets_hold_up_to_their_tilt() {
    let layouts = [
        (Layout::Square, 0.0),
        (Layout::Square, 0.5),
        (Layout::Triangles, 0.3),
        (Layout::Sampled(Method::Poisson, 1), 0.3),
    ];
    for (layout, azimuth) in layouts {
        let (wall, _) = spheres(&layout.points(P, 0.4), 0.1 * P, 2.0 * R);
        let rolling = matches!(layout, Layout::Sampled(..));
        for friction in [None, Some(0.5)].into_iter().take(1 + usize::from(rolling)) {
            let kind = Grain { radius: R, friction, blocked: false };
            let left = leaving_tilts(
                &wall,
                kind,
                &places(0.3, 0.05, 25),
                Tilting { azimuth, from: 0.0, step: TILT, wait: 6.0, stiffness: 3e4 },
            );
            let tops =
                left.iter().filter_map(|(at, tilt)| Some((tilt, closed_tilt(&wall, R, *at, azimuth)?)));
            let off: Vec<f64> = tops.map(|(found, closed)| found - closed).collect();
            assert!(off.len() >= 8, "{}: {} grains rest on three spheres", layout.name(), off.len());
            // The tilt was there at the latest in the step before.
            let worst = off.iter().map(|o| (o - 0.5 * LATE).abs()).fold(0.0, f64::max);
            let mu = friction.map_or("no friction".to_owned(), |mu| format!("μ = {mu}, rolling"));
            HOLDS.within(
                &format!("{}, {azimuth} rad, {mu}", layout.name()),
                worst.to_degrees(),
                "°",
                0.5 * LATE.to_degrees(),
            );
            if friction.is_none() {
                let steepest = left.iter().map(|l| l.1).fold(0.0, f64::max);
                BOUND.within(layout.name(), steepest / (bound(&wall, R, &left) + LATE), "of the bound", 1.0);
            }
        }
    }
}

#[test]
fn grains_that_cannot_roll_are_wedged() {
    for (share, mu) in [(0.05, 0.4), (0.1, 0.2), (0.3, 0.3)] {
        let (wall, _) = spheres(&Layout::Square.points(P, 0.2), share * P, 2.0 * R);
        let kind = Grain { radius: R, friction: Some(mu), blocked: true };
        let closed = blocked_tilt(P, wall[0].1, R, mu);
        let left = leaving_tilts(
            &wall,
            kind,
            &places(0.1, 0.04, 3),
            Tilting { azimuth: 0.0, from: 0.6 * closed, step: TILT, wait: 6.0, stiffness: 3e4 },
        );
        let off = left.iter().map(|l| (l.1 - closed - 0.5 * LATE).abs()).fold(0.0, f64::max);
        let on = format!("square, ζ/P = {share}, μ = {mu}");
        WEDGED.within(&on, off.to_degrees(), "°", 0.5 * LATE.to_degrees());
    }
}
