//! Normal rebound: the mean over a wall is e less what the tilt of the spheres takes.

use crate::of_walls;
use crate::sphere_walls::chance::mean;
use crate::sphere_walls::plates::{Layout, spheres};
use crate::sphere_walls::rebound::{impacts, impacts_in, on_a_pipe, on_a_square_lattice};
use dem::setup::Precision;
use grainpipe_tests::findings::Case;
use sampling::Method;

const P: f64 = 0.01;
const R: f64 = 0.006;
const EACH: Case = of_walls("a grain rebounds from a wall sphere by the formula (1 + e) cos² θ − 1");
const MEAN: Case =
    of_walls("mean rebound on a square lattice: (1 + e)(1 − P²/6(R + r)²) − 1, within its 95 % interval");
const FLAT: Case =
    of_walls("ζ → 0: a grain that touches one wall sphere at a time rebounds as from a plane, with e");
const PIPE: Case =
    of_walls("rebound in a half pipe of spheres equals that on a flat wall, within both 95 % intervals");

#[test]
fn each_grain_rebounds_by_the_tilt_of_the_sphere_it_hits() {
    let precisions = [(Precision::Double, ""), (Precision::Mixed, ", mixed precision")];
    for (e, (precision, told)) in [0.3, 0.9].into_iter().flat_map(|e| precisions.map(|p| (e, p))) {
        for share in [0.05, 0.2, 0.5] {
            let (wall, _) = spheres(&Layout::Sampled(Method::Poisson, 1).points(P, 0.6), share * P, 2.0 * R);
            let all = impacts_in(precision, &wall, e, R, (0.5, 150));
            let single = all.iter().filter(|i| !i.double);
            let off = single.map(|i| (i.upward - i.closed).abs()).fold(0.0, f64::max);
            assert!(all.iter().filter(|i| i.double).count() < all.len() / 20);
            EACH.within(&format!("e = {e}, ζ/P = {share}{told}"), off, "of the speed", 1e-3);
        }
    }
}

#[test]
fn mean_rebound_falls_with_roughness_as_the_formula_says() {
    let mut curve = Vec::new();
    for share in [0.02, 0.05, 0.1, 0.2, 0.4] {
        let (wall, _) = spheres(&Layout::Square.points(P, 0.6), share * P, 2.0 * R);
        let all = impacts(&wall, 0.9, R, (0.5, 400));
        let found = mean(&all.iter().map(|i| i.upward).collect::<Vec<f64>>());
        let closed = on_a_square_lattice(0.9, P, wall[0].1, R);
        MEAN.within(
            &format!("ζ/P = {share}"),
            (found.mean - closed) / (1.3 * found.off),
            "of the interval × 1.3",
            1.0,
        );
        curve.push((share * P / R, found.mean));
    }
    MEAN.curve("e = 0.9, P = 1.67 r", "roughness over grain radius", "mean rebound", &curve);
}

#[test]
fn smooth_walls_rebound_as_the_plane() {
    for e in [0.3, 0.9] {
        let (wall, _) = spheres(&Layout::Square.points(P, 0.6), P / 400.0, 2.0 * R);
        let all = impacts(&wall, e, R, (0.5, 50));
        let found = mean(&all.iter().filter(|i| !i.double).map(|i| i.upward).collect::<Vec<f64>>());
        FLAT.within(&format!("e = {e}, ζ = P/400"), found.mean - e, "–", 1e-3);
    }
}

#[test]
fn half_pipe_as_the_flat_wall() {
    let layout = Layout::Sampled(Method::Poisson, 1);
    let zeta = 0.1 * P;
    let flat = spheres(&layout.points(P, 0.6), zeta, 2.0 * R).0;
    let pipe = spheres(&layout.pipe_points(P, 0.3, 0.6), zeta, 2.0 * R).0;
    let flat: Vec<f64> = impacts(&flat, 0.9, R, (0.5, 300)).iter().map(|i| i.upward).collect();
    let pipe = on_a_pipe(&pipe, 0.9, (R, 0.3), (0.5, 300));
    let (flat, pipe) = (mean(&flat), mean(&pipe));
    PIPE.within(
        "ζ/P = 0.1, pipe of 50 r",
        (flat.mean - pipe.mean) / (flat.off + pipe.off),
        "of both intervals",
        1.0,
    );
}
