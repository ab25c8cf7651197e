//! Grazing impacts at 1° to 10°: no wall adds energy.

use crate::of_walls;
use crate::sphere_walls::grazing::{Impact, Target, graze};
use crate::sphere_walls::plates::{Layout, spheres};
use grainpipe_tests::findings::Case;
use grainpipe_tests::normals::{NORMALS, Normal};
use grainpipe_tests::setups::Law;
use sampling::Method;

const RUBS: Case =
    of_walls("grazing impact at 1° to 10° with friction or e < 1: no grain gains kinetic energy");
const KEEPS: Case =
    of_walls("grazing impact with e = 1 and no friction: kinetic energy gained at the default step");
const SEAMS: Case = of_walls(
    "grazing the seams of a mesh with JKR: the attraction ends at a seam, as the law states; energy gained",
);
const FALLS: Case = of_walls(
    "energy change in a grazing impact with e = 1 and no friction falls with the square of the step",
);

fn wall() -> Target {
    Target::Spheres(spheres(&Layout::Sampled(Method::Poisson, 1).points(0.01, 0.9), 0.001, 0.02).0)
}

/// Largest gain over laws, and where it was.
fn worst(target: &Target, normals: &[Normal], losing: bool, safety: f64) -> (String, f64) {
    let kinds = [(1.0, Some(0.5)), (0.7, None), (0.7, Some(0.5)), (1.0, Some(0.05))];
    let kinds: &[(f64, Option<f64>)] = if losing { &kinds } else { &[(1.0, None)] };
    let mut worst = (String::new(), f64::NEG_INFINITY);
    for &(restitution, friction) in kinds {
        for &normal in normals {
            let change = graze(target, Impact { normal, restitution, friction, safety });
            assert!(change.free >= 50, "{}: {} grains flew off", normal.name, change.free);
            if change.gain > worst.1 {
                let mu = friction.map_or("no friction".to_owned(), |mu| format!("μ = {mu}"));
                worst = (format!("{}, e = {restitution}, {mu}", normal.name), change.gain);
            }
        }
    }
    worst
}

/// With e = 1 and without friction what is gained is the error of the step, as often lost: spheres turn the velocity, and a grain grazes
/// several.
#[test]
fn no_surface_adds_energy() {
    let jkr = |n: &Normal| matches!(n.law, Law::Jkr { .. });
    let smooth: Vec<Normal> = NORMALS.into_iter().filter(|n| !jkr(n)).collect();
    for (name, target, normals, limits) in [
        ("plane", Target::Plane, &NORMALS[..], [1e-5, 1e-4]),
        ("seams of a mesh, without JKR", Target::Mesh, &smooth[..], [1e-5, 1e-4]),
        ("wall of spheres", wall(), &NORMALS[..], [1e-4, 4e-3]),
    ] {
        let (on, gain) = worst(&target, normals, true, 0.5);
        RUBS.within(&format!("{name}: worst of all laws ({on})"), gain.max(0.0), "of the energy", limits[0]);
        let (on, gain) = worst(&target, normals, false, 0.5);
        KEEPS.within(&format!("{name}: worst of all laws ({on})"), gain.max(0.0), "of the energy", limits[1]);
    }
    let pulled: Vec<Normal> = NORMALS.into_iter().filter(jkr).collect();
    let (on, gain) = worst(&Target::Mesh, &pulled, false, 0.5);
    SEAMS.within(&on, gain.max(0.0), "of the energy", 1e-3);
}

#[test]
fn the_error_falls_with_the_step() {
    let target = wall();
    for normal in [NORMALS[0], NORMALS[1]] {
        let error = |safety| {
            let change = graze(&target, Impact { normal, restitution: 1.0, friction: None, safety });
            (safety, change.gain.max(change.loss))
        };
        FALLS.order(normal.name, &[0.4, 0.2, 0.1, 0.05].map(error), 2.0, 0.3);
    }
}
