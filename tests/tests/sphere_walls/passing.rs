//! What wallgen says of gaps, against grains that fall.

use crate::of_walls;
use crate::sphere_walls::chance::Chance;
use crate::sphere_walls::passing::{passes, share};
use crate::sphere_walls::plates::{Layout, spheres};
use geom::Vec3;
use grainpipe_tests::findings::Case;
use grainpipe_tests::tools::line;
use sampling::Method;

const WIDTH: Case = of_walls(
    "a grain 1 % smaller than the gap that wallgen reports falls through, a grain 1 % larger does not",
);
const SQUARE: Case = of_walls("widest gap of a square lattice: √2 P − 2R");
const CLOSED: Case = of_walls("a wall without a gap lets no grain through: share of grains below it");
const TOOLS: Case = of_walls(
    "through wallgen and dem-run: a grain 2 % smaller than the gap falls through, a grain 2 % larger stays",
);

const P: f64 = 0.01;

#[test]
fn grains_pass_as_wallgen_says() {
    let layouts =
        [Method::Poisson, Method::Eliminate, Method::Relax, Method::Grid].map(|m| Layout::Sampled(m, 1));
    for layout in [Layout::Square].into_iter().chain(layouts) {
        for zeta in [0.3, 0.5] {
            let (wall, report) = spheres(&layout.points(P, 0.3), zeta * P, 0.002);
            let gap = report.widest_gap.expect("so rough a wall has gaps");
            let falls = |size: f64| {
                let from = Vec3::new(gap.at[0], gap.at[1], gap.at[2] + wall[0].1);
                passes(&wall, &[(from, 0.5 * size * gap.diameter)], (0.4, 0.002))[0]
            };
            let on = format!("{}, ζ/P = {zeta}", layout.name());
            WIDTH.within(&on, f64::from(u8::from(!falls(0.99)) + u8::from(falls(1.01))), "wrong of 2", 0.0);
            if layout == Layout::Square {
                SQUARE.equals(&on, gap.diameter, "m", 2f64.sqrt() * P - 2.0 * wall[0].1, 1e-9);
            }
        }
    }
}

#[test]
fn a_closed_wall_lets_nothing_through() {
    let (wall, report) = spheres(&Layout::Sampled(Method::Poisson, 1).points(P, 0.3), 0.1 * P, 0.002);
    assert_eq!(report.widest_gap, None);
    for radius in [0.0005, 0.002] {
        let through = share(&wall, radius, 0.2, 0.3);
        CLOSED.within(&format!("poisson, ζ/P = 0.1, grains of {} P", 2.0 * radius / P), through, "–", 0.0);
    }
}

/// `pipelines/walls/leak.sh`: a wall from a scan, then dem-run with a grain over its widest gap.
#[test]
fn grains_pass_as_wallgen_says_in_dem_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../pipelines/walls/leak.sh");
    let mut chance = Chance::new(2);
    let scan =
        (0..40_000).map(|_| format!("{:.6} {:.6} 0\n", chance.between(0.0, 0.3), chance.between(0.0, 0.3)));
    std::fs::write(folder.path().join("scan.xyz"), scan.collect::<String>()).expect("written");
    let done = line(folder.path(), &format!("'{script}' scan.xyz 0.01 0.004 ."));
    assert_eq!(done.code, 0, "{}", done.stderr);
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    let words = |name: &str| said.lines().find(|l| l.starts_with(name)).unwrap_or_default().to_owned();
    let wrong = u8::from(!words("0.98").ends_with("through")) + u8::from(!words("1.02").ends_with("held"));
    TOOLS.within("scan of a plate, P = 10 mm, ζ = 4 mm", f64::from(wrong), "wrong of 2", 0.0);
}
