//! Hold and widest gap against sampling method, spacing and roughness: the plot to choose by.

use crate::GRAIN;
use crate::page::Page;
use crate::picture::Panel;
use grainpipe_tests::sphere_walls::chance::{Mean, mean, places};
use grainpipe_tests::sphere_walls::holding::{Grain, Tilting, leaving_tilts};
use grainpipe_tests::sphere_walls::plates::{Layout, spheres};
use rayon::prelude::*;
use sampling::Method;

const METHODS: [Method; 4] = [Method::Poisson, Method::Eliminate, Method::Relax, Method::Grid];
const SPACINGS: [f64; 3] = [0.5, 1.0, 2.0];
const SHARES: [f64; 5] = [0.02, 0.05, 0.1, 0.2, 0.4];
/// μ of the grain on the wall.
const MU: f64 = 0.3;

/// Down along 0.3 rad from a row, in steps of 1°.
const TILTING: Tilting =
    Tilting { azimuth: 0.3, from: 0.0, step: std::f64::consts::PI / 180.0, wait: 12.0, stiffness: 3e3 };

/// One wall.
struct Found {
    method: Method,
    spacing: f64,
    share: f64,
    radius: f64,
    /// Tilt that grains leave at that cannot roll, and that grains without friction leave at [°].
    blocked: Mean,
    free: Mean,
    /// Widest gap [d].
    gap: f64,
    /// Distance of neighbours as wallgen tells it [d].
    apart: f64,
}

pub fn study(page: &mut Page) -> Result<(), String> {
    let walls: Vec<(Method, f64, f64)> = METHODS
        .iter()
        .flat_map(|&m| SPACINGS.iter().flat_map(move |&p| SHARES.iter().map(move |&s| (m, p, s))))
        .collect();
    let all: Vec<Found> = walls.into_par_iter().map(|(m, p, s)| one(m, p, s)).collect();
    page.head("Wall friction and leaks: sampling method × spacing × roughness");
    words(page, &all);
    picture(page, &all)?;
    let row = |f: &Found| {
        vec![
            Layout::Sampled(f.method, 1).name().to_owned(),
            format!("{}", f.spacing),
            format!("{}", f.share),
            format!("{:.3}", f.share * f.spacing),
            format!("{:.2}", f.radius),
            format!("{:.2}", f.apart),
            format!("{:.1} ± {:.1}", f.blocked.mean, f.blocked.off),
            format!("{:.1} ± {:.1}", f.free.mean, f.free.off),
            if f.gap > 0.0 { format!("{:.2}", f.gap) } else { "closed".to_owned() },
        ]
    };
    let rows: Vec<Vec<String>> = all.iter().map(row).collect();
    let columns = [
        "method",
        "P/d",
        "ζ/P",
        "ζ/d",
        "R/d",
        "mean neighbour distance / d",
        "hold with μ = 0.3 [°]",
        "hold without friction [°]",
        "widest gap / d",
    ];
    page.csv("hold", &columns, &rows)?;
    let poisson: Vec<Vec<String>> =
        all.iter().filter(|f| f.method == Method::Poisson).map(|f| row(f)[1..].to_vec()).collect();
    page.say("The table is for Poisson disk; `hold.csv` has the other methods.");
    page.table("hold-poisson", &columns[1..], &poisson)
}

fn one(method: Method, spacing: f64, share: f64) -> Found {
    let p = spacing * GRAIN;
    let (wall, report) = spheres(&Layout::Sampled(method, 1).points(p, 0.4), share * p, GRAIN);
    let places = places(0.32, 0.06, 20);
    let hold = |friction: Option<f64>| {
        let kind = Grain { radius: 0.5 * GRAIN, friction, blocked: friction.is_some() };
        let left = leaving_tilts(&wall, kind, &places, TILTING);
        // One that fell through is held by nothing. It left somewhere within the step.
        let held = left.iter().filter(|(at, _)| at.z > 0.0);
        mean(&held.map(|(_, tilt)| (tilt - 0.5 * TILTING.step).to_degrees()).collect::<Vec<f64>>())
    };
    Found {
        method,
        spacing,
        share,
        radius: wall[0].1 / GRAIN,
        blocked: hold(Some(MU)),
        free: hold(None),
        gap: report.widest_gap.map_or(0.0, |g| g.diameter / GRAIN),
        apart: report.spacing / GRAIN,
    }
}

fn picture(page: &mut Page, all: &[Found]) -> Result<(), String> {
    let mut panels = Vec::new();
    type Value = fn(&Found) -> f64;
    let values: [(&str, Value); 3] = [
        ("hold, μ = 0.3 [°]", |f| f.blocked.mean),
        ("hold, no friction [°]", |f| f.free.mean),
        ("widest gap / d", |f| f.gap),
    ];
    for (what, value) in values {
        for spacing in SPACINGS {
            let line = |&m: &Method| {
                let of = all.iter().filter(|f| f.method == m && f.spacing == spacing);
                (Layout::Sampled(m, 1).name().to_owned(), of.map(|f| (f.share, value(f))).collect())
            };
            panels.push(Panel {
                title: format!("P = {spacing} d"),
                axes: ("ζ/P".into(), what.into()),
                lines: METHODS.iter().map(line).collect(),
                from_zero: true,
                ..Panel::default()
            });
        }
    }
    page.picture("hold", "Hold and widest gap over roughness, by method and spacing", SPACINGS.len(), &panels)
}

fn words(page: &mut Page, all: &[Found]) {
    let of = |m: Method, p: f64, s: f64| all.iter().find(|f| f.method == m && f.spacing == p && f.share == s);
    let at = |p: f64, s: f64| of(Method::Poisson, p, s).map_or(f64::NAN, |f| f.blocked.mean);
    let bare = MU.atan().to_degrees();
    let spread = SPACINGS.iter().flat_map(|&p| SHARES.iter().map(move |&s| (p, s))).map(|(p, s)| {
        let here: Vec<f64> = METHODS.iter().filter_map(|&m| of(m, p, s)).map(|f| f.blocked.mean).collect();
        here.iter().copied().fold(0.0, f64::max) - here.iter().copied().fold(90.0, f64::min)
    });
    let spread = spread.fold(0.0, f64::max);
    page.say(&format!(
        "A grain that cannot roll, with μ = {MU}, rests in a pocket of the wall. The *hold* of the wall is \
         the tilt at which the grain leaves its pocket. On a plane it is arctan μ = {bare:.1}°. A \
         Poisson-disk wall holds {:.1}° \
         at P = d/2, ζ = 0.02 P; {:.1}° at P = d, ζ = 0.1 P; {:.1}° at P = 2 d, ζ = 0.2 P.\n\nThe hold \
         follows from the slope of the surface on which the grain's centre moves: arcsin of (distance from \
         a sphere's axis)/(R + r). It grows with ζ/P and with P/d. Between methods the hold differs by at \
         most \
         {spread:.1}°; the intervals are in the table. The tilt changes in steps of 1°.",
        at(0.5, 0.02),
        at(1.0, 0.1),
        at(2.0, 0.2),
    ));
    let closed = |m: Method| {
        let open = all.iter().filter(|f| f.method == m && f.gap > 0.0);
        open.map(|f| f.share).fold(f64::INFINITY, f64::min)
    };
    let leaky = |p: f64| {
        let worst = all.iter().filter(|f| f.spacing == p && f.share == 0.2);
        worst.map(|f| f.gap).fold(0.0, f64::max)
    };
    page.say(&format!(
        "The lowest ζ/P in this study at which a wall has a gap is: poisson {}, eliminate {}, relax {}, \
         grid {}. \
         At ζ = 0.2 P the widest gap of any method is {:.2} d at P = d/2, {:.2} d at P = d and {:.2} d at P \
         = 2 d. Above 1 d the smallest grain falls through.",
        closed(Method::Poisson),
        closed(Method::Eliminate),
        closed(Method::Relax),
        closed(Method::Grid),
        leaky(0.5),
        leaky(1.0),
        leaky(2.0)
    ));
    advice(page, all, bare);
}

fn advice(page: &mut Page, all: &[Found], bare: f64) {
    let blue = |f: &&Found| f.method != Method::Grid;
    let tight: Vec<&Found> = all.iter().filter(blue).filter(|f| f.spacing <= 1.0 && f.share <= 0.1).collect();
    let gap = tight.iter().map(|f| f.gap).fold(0.0, f64::max);
    let low = tight.iter().filter(|f| f.share == SHARES[0]);
    let extra = low.map(|f| f.blocked.mean - bare).fold(f64::NEG_INFINITY, f64::max);
    let tightness =
        if gap > 0.0 { format!("had a gap wider than {gap:.2} d") } else { "had any gap".to_owned() };
    page.advise(format!(
        "**Spacing** P ≤ d (one smallest grain) and **roughness** ζ ≤ 0.1 P: no blue-noise wall here \
         {tightness}. Give wallgen `--smallest-particle d`: the widest gap that it reports is correct to 1 %."
    ));
    page.advise(format!(
        "**For a smooth wall**, whose friction is that of μ alone, take P ≤ d and ζ = 0.02 P: this adds at \
         most {extra:.1}° to arctan μ. **For a rough wall**, increase ζ: a plot below gives the angle up to \
         which the wall holds a grain."
    ));
}
