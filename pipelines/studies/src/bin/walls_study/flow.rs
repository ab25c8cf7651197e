//! Flow down a tilted wall in every direction: lattice, grid and blue noise.

use crate::GRAIN;
use crate::page::Page;
use crate::picture::Panel;
use grainpipe_tests::sphere_walls::chance::mean;
use grainpipe_tests::sphere_walls::drift::{Run, Slope, anisotropy, runs};
use grainpipe_tests::sphere_walls::plates::{Layout, spheres};
use sampling::Method;

const AZIMUTHS: u32 = 24;

pub fn study(page: &mut Page) -> Result<(), String> {
    let p = GRAIN / 1.2;
    let layouts = [
        Layout::Square,
        Layout::Sampled(Method::Grid, 1),
        Layout::Sampled(Method::Poisson, 1),
        Layout::Sampled(Method::Eliminate, 1),
        Layout::Sampled(Method::Relax, 1),
    ];
    let azimuths: Vec<f64> =
        (0..AZIMUTHS).map(|k| f64::from(k) / f64::from(AZIMUTHS) * std::f64::consts::TAU).collect();
    let (mut rows, mut drawn) = (Vec::new(), Vec::new());
    let (mut blue, mut rowed) = (0.0f64, f64::INFINITY);
    for tilt in [15f64, 20.0] {
        let slope = Slope {
            tilt: tilt.to_radians(),
            radius: 0.5 * GRAIN,
            friction: 0.5,
            restitution: 0.5,
            time: 0.8,
            side: 12,
            apart: 0.045,
        };
        for layout in layouts {
            let (wall, _) = spheres(&layout.points(p, 2.2), 0.1 * p, GRAIN);
            let all = runs(&wall, slope, &azimuths);
            let found = anisotropy(&all, 400);
            let grid = matches!(layout, Layout::Square | Layout::Sampled(Method::Grid, _));
            if grid {
                rowed = rowed.min(found.drift.mean)
            } else {
                blue = blue.max(found.drift.mean)
            }
            let percent = |m: grainpipe_tests::sphere_walls::chance::Mean| {
                format!("{:.1} ± {:.1}", 100.0 * m.mean, 100.0 * m.off)
            };
            rows.push(vec![
                layout.name().to_owned(),
                format!("{tilt}"),
                format!("{:.3}", found.speed.mean),
                percent(found.unevenness),
                percent(found.drift),
            ]);
            if tilt == 15.0 {
                drawn.push((layout.name().to_owned(), all));
            }
        }
    }
    page.head("Flow in every direction: grid against blue noise");
    page.say(&format!(
        "144 grains for each of {AZIMUTHS} azimuths roll for 0.8 s down a wall of P = d/1.2 and ζ = 0.1 P (μ \
         = 0.5, e = 0.5) that is rotated under the tilt.\n\n- Unevenness: deviation of the mean downward \
         speed over the azimuths.\n- Drift: root mean square of the mean sideways speed.\n\nBoth are given \
         over the downward speed, in %, with random scatter subtracted. Their intervals come from resampling \
         the grains 400 times. Rows deflect grains by {:.1} % of their speed or more. The largest drift of a \
         blue-noise wall is {:.1} %; its interval shows whether that is more than scatter.",
        100.0 * rowed,
        100.0 * blue
    ));
    page.advise(format!(
        "**Method**: poisson (the default). Use grid only if the flow has one direction: rows deflect grains \
         by {:.1} % of their speed or more, blue noise by {:.1} % at most.",
        100.0 * rowed,
        100.0 * blue
    ));
    let columns = ["points", "tilt [°]", "speed [m/s]", "unevenness [%]", "drift [%]"];
    page.table("flow", &columns, &rows)?;
    let panels = [
        panel("speed down / its mean", &drawn, |run, mean_speed| mean(&run.down).mean / mean_speed),
        panel("speed aside / mean speed down", &drawn, |run, mean_speed| mean(&run.aside).mean / mean_speed),
    ];
    page.picture("flow", "Speed down and aside over azimuth, tilt of 15°", 2, &panels)
}

fn panel(what: &str, drawn: &[(String, Vec<Run>)], value: fn(&Run, f64) -> f64) -> Panel {
    let line = |(name, all): &(String, Vec<Run>)| {
        let speed = mean(&all.iter().flat_map(|r| r.down.iter().copied()).collect::<Vec<f64>>()).mean;
        (name.clone(), all.iter().map(|r| (r.azimuth.to_degrees(), value(r, speed))).collect())
    };
    Panel {
        title: "tilt of 15°".into(),
        axes: ("azimuth from the rows [°]".into(), what.into()),
        lines: drawn.iter().take(3).map(line).collect(),
        ..Panel::default()
    }
}
