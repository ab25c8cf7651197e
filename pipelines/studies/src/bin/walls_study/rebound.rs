//! Normal rebound and the height of impacts against roughness and spacing.

use crate::GRAIN;
use crate::page::Page;
use crate::picture::Panel;
use grainpipe_tests::sphere_walls::chance::mean;
use grainpipe_tests::sphere_walls::plates::{Layout, spheres};
use grainpipe_tests::sphere_walls::rebound::{impacts, on_a_pipe, on_a_square_lattice};
use sampling::Method;

const E: f64 = 0.9;

pub fn study(page: &mut Page) -> Result<(), String> {
    let (mut rows, mut rough) = (Vec::new(), Vec::new());
    let mut panel = Panel {
        title: format!("e = {E} asked for"),
        axes: ("ζ/P".into(), "mean rebound".into()),
        ..Panel::default()
    };
    let (mut worst, mut smooth, mut below) = (1.0f64, 0.0f64, 0.0f64);
    for spacing in [0.5, 1.0, 2.0] {
        let p = spacing * GRAIN;
        let mut line = Vec::new();
        let mut closed = Vec::new();
        for share in [0.02, 0.05, 0.1, 0.2, 0.3, 0.4] {
            let layout = Layout::Sampled(Method::Poisson, 1);
            let (wall, _) = spheres(&layout.points(p, 0.6), share * p, GRAIN);
            let all = impacts(&wall, E, 0.5 * GRAIN, (0.5, 300));
            let up = mean(&all.iter().map(|i| i.upward).collect::<Vec<f64>>());
            let high = mean(&all.iter().map(|i| i.height / GRAIN).collect::<Vec<f64>>());
            // The same by the formula at each place of impact; the lattice's for comparison.
            let formula = mean(&all.iter().map(|i| i.closed).collect::<Vec<f64>>()).mean;
            let square = on_a_square_lattice(E, p, wall[0].1, 0.5 * GRAIN);
            line.push((share, up.mean));
            closed.push((share, square));
            below = below.max(square - up.mean);
            (worst, smooth) =
                (worst.min(up.mean), if share == 0.02 { smooth.max(E - up.mean) } else { smooth });
            let numbers = [
                format!("{spacing}"),
                format!("{share}"),
                format!("{:.3}", share * spacing),
                format!("{:.2}", wall[0].1 / GRAIN),
                format!("{:.3} ± {:.3}", up.mean, up.off),
                format!("{formula:.3}"),
                format!("{square:.3}"),
                format!("{:.4}", high.deviation),
            ];
            rough.push((share, up.mean));
            rows.push(numbers.to_vec());
        }
        panel.lines.push((format!("P = {spacing} d"), line));
        panel.closed.push(closed);
    }
    page.head("Normal rebound");
    page.say(&format!(
        "Frictionless grains fall straight down on a Poisson-disk wall at random positions. A sphere tilts \
         the impact by θ, with sin θ = distance from its axis/(R + r), and the grain rebounds upwards with \
         (1 + e) cos² θ − 1 of its speed. The mean falls from {E} by at most {smooth:.3} at ζ = 0.02 P. It \
         is {worst:.3} at the roughest and widest wall here. The missing part goes sideways.\n\nOn a square \
         lattice the mean is (1 + e)(1 − P²/6(R + r)²) − 1 (dashed). Blue noise of the same P has wider \
         places between its spheres; its mean is lower by up to {below:.3}."
    ));
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
    page.table("rebound", &columns, &rows)?;
    page.picture("rebound", "Mean rebound over roughness", 1, &[panel])?;
    pipe(page)
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
