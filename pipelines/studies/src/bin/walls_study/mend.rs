//! Ball radius of ball pivoting in cloud-fill against the error of what is filled in.

use crate::page::Page;
use crate::picture::Panel;
use grainpipe_tests::sphere_walls::filling::{Scan, Surface, fill};

/// Width of the hole [m].
const HOLE: f64 = 0.12;
/// Ball radii over the width of the hole.
const BALLS: [f64; 8] = [0.15, 0.25, 0.4, 0.5, 0.6, 0.8, 1.5, 3.0];

pub fn study(page: &mut Page) -> Result<(), String> {
    let surfaces = [
        (Surface::Plane, "plane"),
        (Surface::Pipe(0.4), "half pipe, hole 0.3 of its radius"),
        (Surface::Pipe(0.15), "half pipe, hole 0.8 of its radius"),
        (Surface::Ball(0.4), "ball, hole 0.3 of its radius"),
    ];
    let (mut rows, mut shares, mut offs) = (Vec::new(), Vec::new(), Vec::new());
    let (mut closes, mut spread) = (0.0f64, 0.0f64);
    for noise in [0.0, 0.0008] {
        for (surface, name) in surfaces {
            let scan = Scan { surface, spacing: 0.006, hole: HOLE, noise };
            let all: Vec<_> = BALLS.iter().map(|b| fill(scan, &[b * HOLE], 1)).collect();
            let whole = || all.iter().zip(BALLS).filter(|(f, _)| !f.open);
            closes = closes.max(whole().map(|w| w.1).fold(f64::INFINITY, f64::min));
            let off = |worst: fn(f64, f64) -> f64, from| whole().map(|w| w.0.off / HOLE).fold(from, worst);
            spread = spread.max(off(f64::max, 0.0) - off(f64::min, 1.0));
            for (f, ball) in all.iter().zip(BALLS) {
                rows.push(vec![
                    name.to_owned(),
                    format!("{:.1}", noise * 1e3),
                    format!("{ball}"),
                    format!("{:.2}", f.share),
                    if f.open { "open" } else { "closed" }.to_owned(),
                    format!("{:.2e}", f.off / HOLE),
                    format!("{:.2e}", f.worst / HOLE),
                ]);
            }
            let own = fill(scan, &[], 1);
            rows.push(vec![
                name.to_owned(),
                format!("{:.1}", noise * 1e3),
                format!("fitted ({:.1})", own.ball / HOLE),
                format!("{:.2}", own.share),
                if own.open { "open" } else { "closed" }.to_owned(),
                format!("{:.2e}", own.off / HOLE),
                format!("{:.2e}", own.worst / HOLE),
            ]);
            if noise == 0.0 {
                shares.push((
                    name.to_owned(),
                    BALLS.iter().copied().zip(all.iter().map(|f| f.share)).collect(),
                ));
            } else {
                offs.push((
                    name.to_owned(),
                    BALLS.iter().copied().zip(all.iter().map(|f| f.off / HOLE)).collect(),
                ));
            }
        }
    }
    words(page, closes, spread);
    let columns = [
        "surface",
        "noise [mm]",
        "ball / hole",
        "points added / missing",
        "hole",
        "rms distance / hole",
        "largest distance / hole",
    ];
    page.table("fill", &columns, &rows)?;
    let x = "ball radius / width of the hole";
    let panels = [
        Panel {
            title: "no noise".into(),
            axes: (x.into(), "points added / missing".into()),
            lines: shares,
            from_zero: true,
            ..Panel::default()
        },
        Panel {
            title: "noise of 0.8 mm".into(),
            axes: (x.into(), "rms distance / hole".into()),
            lines: offs,
            from_zero: true,
            ..Panel::default()
        },
    ];
    page.picture("fill", "What is filled in, by ball radius", 2, &panels)
}

fn words(page: &mut Page, closes: f64, spread: f64) {
    page.head("Filling holes: ball radius against error");
    page.say(&format!(
        "Scans of known surfaces with points 6 mm apart have a round hole of {:.0} mm. cloud-fill closes it \
         with balls of one radius. Every hole was closed by balls of {closes} of its width or more (geometry \
         asks for half its width). Smaller balls fall through and leave it open, and the report says \
         so.\n\nOnce the hole is closed the radius no longer matters: the error of the added points changes \
         by at most {spread:.0e} of the hole's width. The points are put on the smooth surface of the \
         surroundings, not on the ball's triangles.",
        HOLE * 1e3
    ));
    page.advise(format!(
        "**cloud-fill**: leave `--ball` out, so that it chooses the ball. A given ball needs {closes} of the \
         hole's width to close it; larger ones change nothing."
    ));
}
