//! Normal rebound and the height of impacts against roughness and spacing.

use crate::GRAIN;
use crate::page::Page;
use crate::picture::Panel;
use grainpipe_tests::sphere_walls::chance::{Mean, mean};
use grainpipe_tests::sphere_walls::plates::{Layout, spheres};
use grainpipe_tests::sphere_walls::rebound::{Impact, impacts, on_a_pipe, on_a_square_lattice};
use sampling::Method;

const E: f64 = 0.9;

/// P/d of the walls.
const SPACINGS: [f64; 3] = [0.5, 1.0, 2.0];
/// ζ/P of the walls.
const SHARES: [f64; 6] = [0.02, 0.05, 0.1, 0.2, 0.3, 0.4];

/// Impacts on one wall.
struct Found {
    /// P/d.
    spacing: f64,
    /// ζ/P.
    share: f64,
    /// Radius of the wall spheres [d].
    radius: f64,
    /// Mean rebound.
    upward: Mean,
    /// Mean rebound by the formula at each place of impact.
    formula: f64,
    /// Mean rebound on a square lattice, for comparison.
    square: f64,
    /// Height of the centre at touch [d].
    height: Mean,
}

pub fn study(page: &mut Page) -> Result<(), String> {
    let walls = SPACINGS.iter().flat_map(|&spacing| SHARES.iter().map(move |&share| (spacing, share)));
    let all: Vec<Found> = walls.map(|(spacing, share)| one(spacing, share)).collect();
    page.head("Normal rebound");
    words(page, &all);
    let columns = [
        "P/d",
        "ζ/P",
        "ζ/d",
        "R/d",
        "mean rebound",
        "formula at these places",
        "formula, square lattice",
        "deviation of height / d",
    ];
    let rows: Vec<Vec<String>> = all.iter().map(row).collect();
    page.table("rebound", &columns, &rows)?;
    page.picture("rebound", "Mean rebound over roughness", 1, &[panel(&all)])?;
    pipe(page)
}

fn one(spacing: f64, share: f64) -> Found {
    let p = spacing * GRAIN;
    let layout = Layout::Sampled(Method::Poisson, 1);
    let (wall, _) = spheres(&layout.points(p, 0.6), share * p, GRAIN);
    let all = impacts(&wall, E, 0.5 * GRAIN, (0.5, 300));
    let mean_of = |value: fn(&Impact) -> f64| mean(&all.iter().map(value).collect::<Vec<f64>>());
    Found {
        spacing,
        share,
        radius: wall[0].1 / GRAIN,
        upward: mean_of(|i| i.upward),
        formula: mean_of(|i| i.closed).mean,
        square: on_a_square_lattice(E, p, wall[0].1, 0.5 * GRAIN),
        height: mean_of(|i| i.height / GRAIN),
    }
}

fn row(f: &Found) -> Vec<String> {
    vec![
        format!("{}", f.spacing),
        format!("{}", f.share),
        format!("{:.3}", f.share * f.spacing),
        format!("{:.2}", f.radius),
        format!("{:.3} ± {:.3}", f.upward.mean, f.upward.off),
        format!("{:.3}", f.formula),
        format!("{:.3}", f.square),
        format!("{:.4}", f.height.deviation),
    ]
}

fn panel(all: &[Found]) -> Panel {
    let of = |spacing: f64| all.iter().filter(move |f| f.spacing == spacing);
    let line = |p: f64| (format!("P = {p} d"), of(p).map(|f| (f.share, f.upward.mean)).collect());
    Panel {
        title: format!("e = {E} asked for"),
        axes: ("ζ/P".into(), "mean rebound".into()),
        lines: SPACINGS.map(line).into(),
        closed: SPACINGS.map(|p| of(p).map(|f| (f.share, f.square)).collect()).into(),
        ..Panel::default()
    }
}

fn words(page: &mut Page, all: &[Found]) {
    let worst = all.iter().map(|f| f.upward.mean).fold(1.0, f64::min);
    let smoothest = all.iter().filter(|f| f.share == SHARES[0]);
    let smooth = smoothest.map(|f| E - f.upward.mean).fold(0.0, f64::max);
    let below = all.iter().map(|f| f.square - f.upward.mean).fold(0.0, f64::max);
    page.say(&format!(
        "Frictionless grains fall straight down on a Poisson-disk wall at random positions. A sphere tilts \
         the impact by θ, with sin θ = distance from its axis/(R + r), and the grain rebounds upwards with \
         (1 + e) cos² θ − 1 of its speed. On a plane this is e = {E}. At ζ = 0.02 P the mean is lower by at \
         most {smooth:.3}. The lowest mean of all these walls is {worst:.3}. The missing part of \
         the speed goes sideways.\n\nOn a square \
         lattice the mean is (1 + e)(1 − P²/6(R + r)²) − 1 (dashed). Blue noise of the same P has wider \
         gaps between some spheres; its mean is lower by up to {below:.3}."
    ));
}

fn pipe(page: &mut Page) -> Result<(), String> {
    let (p, layout) = (GRAIN, Layout::Sampled(Method::Poisson, 1));
    let flat = spheres(&layout.points(p, 0.6), 0.1 * p, GRAIN).0;
    let flat: Vec<f64> = impacts(&flat, E, 0.5 * GRAIN, (0.5, 300)).iter().map(|i| i.upward).collect();
    let bent = spheres(&layout.pipe_points(p, 0.3, 0.6), 0.1 * p, GRAIN).0;
    let bent = on_a_pipe(&bent, E, (0.5 * GRAIN, 0.3), (0.5, 300));
    let (flat, bent) = (mean(&flat), mean(&bent));
    page.say(&format!(
        "In a half pipe of radius 25 d, grains that hit the wall along its radius rebound with {:.3} ± \
         {:.3}. On a flat wall of the same P = d and ζ = 0.1 P it is {:.3} ± {:.3}.",
        bent.mean, bent.off, flat.mean, flat.off
    ));
    Ok(())
}
