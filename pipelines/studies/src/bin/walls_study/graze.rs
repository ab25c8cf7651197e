//! Energy after grazing impacts over that before, against the step.

use crate::page::Page;
use grainpipe_tests::normals::NORMALS;
use grainpipe_tests::sphere_walls::grazing::{Impact, Target, graze};
use grainpipe_tests::sphere_walls::plates::{Layout, spheres};
use sampling::Method;

const STEPS: [f64; 3] = [0.5, 0.25, 0.125];

pub fn study(page: &mut Page) -> Result<(), String> {
    let wall = spheres(&Layout::Sampled(Method::Poisson, 1).points(0.01, 0.9), 0.001, 0.02).0;
    let targets = [
        ("plane", Target::Plane),
        ("flat mesh", Target::Mesh),
        ("wall of spheres, P = d/2, ζ = 0.1 P", Target::Spheres(wall)),
    ];
    let mut rows = Vec::new();
    let mut most = [0.0f64; 2];
    for (name, target) in &targets {
        for (restitution, friction) in [(1.0, None), (1.0, Some(0.5)), (0.7, Some(0.5))] {
            let gains = STEPS.map(|safety| {
                let laws =
                    NORMALS.into_iter().filter(|n| !(matches!(target, Target::Mesh) && n.name == "jkr"));
                let gain = |normal| graze(target, Impact { normal, restitution, friction, safety }).gain;
                laws.map(gain).fold(f64::NEG_INFINITY, f64::max)
            });
            let loses = usize::from(friction.is_some());
            most[loses] = most[loses].max(gains[0]);
            let mu = friction.map_or("–".to_owned(), |mu| format!("{mu}"));
            let mut row = vec![(*name).to_owned(), format!("{restitution}"), mu];
            row.extend(gains.map(|g| format!("{g:.1e}")));
            rows.push(row);
        }
    }
    page.head("Grazing impacts");
    page.say(&format!(
        "Grains hit the surface at 1°, 3°, 6° and 10°, with forward spin, backward spin or none. The table \
         shows the largest change of kinetic energy of any grain, over the initial energy: the worst case \
         of Hooke, Hertz and JKR with and without cohesion. JKR is left out on the mesh, because its \
         attraction ends at a seam.\n\nWith friction, the largest gain of any grain at the default step is \
         {:.0e} (negative values: all grains lose energy). With e = 1 and no friction the energy should not \
         change. Its change is the error of the time step: {:.0e} on a wall of spheres, and less with a \
         shorter step.",
        most[1], most[0]
    ));
    let columns = ["surface", "e", "μ", "step 0.5 (default)", "step 0.25", "step 0.125"];
    page.table("grazing", &columns, &rows)
}
