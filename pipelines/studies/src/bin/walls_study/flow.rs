//! Flow down a tilted wall in every direction: lattice, grid and blue noise.

use crate::GRAIN;
use crate::page::Page;
use crate::picture::Panel;
use grainpipe_tests::sphere_walls::chance::{Mean, mean};
use grainpipe_tests::sphere_walls::drift::{Anisotropy, Run, Slope, anisotropy, runs};
use grainpipe_tests::sphere_walls::plates::{Layout, spheres};
use sampling::Method;

const AZIMUTHS: u32 = 24;

/// Tilt of the slope that is drawn [°].
const DRAWN: f64 = 15.0;
/// Tilts of the slope [°].
const TILTS: [f64; 2] = [DRAWN, 20.0];
const LAYOUTS: [Layout; 5] = [
    Layout::Square,
    Layout::Sampled(Method::Grid, 1),
    Layout::Sampled(Method::Poisson, 1),
    Layout::Sampled(Method::Eliminate, 1),
    Layout::Sampled(Method::Relax, 1),
];

/// Flow down one wall.
struct Found {
    layout: Layout,
    /// [°].
    tilt: f64,
    runs: Vec<Run>,
    anisotropy: Anisotropy,
}

impl Found {
    fn has_rows(&self) -> bool {
        matches!(self.layout, Layout::Square | Layout::Sampled(Method::Grid, _))
    }
}

pub fn study(page: &mut Page) -> Result<(), String> {
    let walls = TILTS.iter().flat_map(|&tilt| LAYOUTS.iter().map(move |&layout| (layout, tilt)));
    let all: Vec<Found> = walls.map(|(layout, tilt)| one(layout, tilt)).collect();
    page.head("Flow in every direction: grid against blue noise");
    words(page, &all);
    let columns = ["points", "tilt [°]", "speed [m/s]", "unevenness [%]", "drift [%]"];
    let rows: Vec<Vec<String>> = all.iter().map(row).collect();
    page.table("flow", &columns, &rows)?;
    let drawn: Vec<&Found> = all.iter().filter(|f| f.tilt == DRAWN).take(3).collect();
    let panels = [
        panel("speed down / its mean", &drawn, |run, mean_speed| mean(&run.down).mean / mean_speed),
        panel("speed aside / mean speed down", &drawn, |run, mean_speed| mean(&run.aside).mean / mean_speed),
    ];
    page.picture("flow", "Speed down and aside over azimuth, tilt of 15°", 2, &panels)
}

fn one(layout: Layout, tilt: f64) -> Found {
    let p = GRAIN / 1.2;
    let slope = Slope {
        tilt: tilt.to_radians(),
        radius: 0.5 * GRAIN,
        friction: 0.5,
        restitution: 0.5,
        time: 0.8,
        side: 12,
        apart: 0.045,
    };
    let azimuths: Vec<f64> =
        (0..AZIMUTHS).map(|k| f64::from(k) / f64::from(AZIMUTHS) * std::f64::consts::TAU).collect();
    let (wall, _) = spheres(&layout.points(p, 2.2), 0.1 * p, GRAIN);
    let runs = runs(&wall, slope, &azimuths);
    let anisotropy = anisotropy(&runs, 400);
    Found { layout, tilt, runs, anisotropy }
}

fn row(f: &Found) -> Vec<String> {
    let percent = |m: Mean| format!("{:.1} ± {:.1}", 100.0 * m.mean, 100.0 * m.off);
    vec![
        f.layout.name().to_owned(),
        format!("{}", f.tilt),
        format!("{:.3}", f.anisotropy.speed.mean),
        percent(f.anisotropy.unevenness),
        percent(f.anisotropy.drift),
    ]
}

fn words(page: &mut Page, all: &[Found]) {
    let drifts =
        |rows: bool| all.iter().filter(move |f| f.has_rows() == rows).map(|f| f.anisotropy.drift.mean);
    let rowed = drifts(true).fold(f64::INFINITY, f64::min);
    let blue = drifts(false).fold(0.0, f64::max);
    page.say(&format!(
        "A wall of P = d/1.2 and ζ = 0.1 P (μ = 0.5, e = 0.5) is rotated to {AZIMUTHS} azimuths and tilted. \
         For each azimuth, 144 grains roll down it for 0.8 s.\n\n- Unevenness: standard deviation of the \
         mean downward speed over the azimuths.\n- Drift: root mean square of the mean sideways \
         speed.\n\nBoth are divided by the downward speed, in %, and random scatter is subtracted. Their \
         intervals come from resampling the grains 400 times. Rows deflect grains by at least {:.1} % of \
         their speed. The largest drift of a \
         blue-noise wall is {:.1} %; its interval shows whether that is more than scatter.",
        100.0 * rowed,
        100.0 * blue
    ));
    page.advise(format!(
        "**Method**: poisson (the default). Use grid only if the flow has one direction: its rows deflect \
         grains by at least {:.1} % of their speed, blue noise by at most {:.1} %.",
        100.0 * rowed,
        100.0 * blue
    ));
}

fn panel(what: &str, drawn: &[&Found], value: fn(&Run, f64) -> f64) -> Panel {
    let line = |f: &&Found| {
        let speed = mean(&f.runs.iter().flat_map(|r| r.down.iter().copied()).collect::<Vec<f64>>()).mean;
        let points = f.runs.iter().map(|r| (r.azimuth.to_degrees(), value(r, speed))).collect();
        (f.layout.name().to_owned(), points)
    };
    Panel {
        title: "tilt of 15°".into(),
        axes: ("azimuth from the rows [°]".into(), what.into()),
        lines: drawn.iter().map(line).collect(),
        ..Panel::default()
    }
}
