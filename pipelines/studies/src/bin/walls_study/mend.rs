//! Ball radius of ball pivoting in cloud-fill against the error of what is filled in.

use crate::page::Page;
use crate::picture::Panel;
use grainpipe_tests::sphere_walls::filling::{Filled, Scan, Surface, fill};

/// Width of the hole [m].
const HOLE: f64 = 0.12;
/// Ball radii over the width of the hole.
const BALLS: [f64; 8] = [0.15, 0.25, 0.4, 0.5, 0.6, 0.8, 1.5, 3.0];

/// Noise of the scans [m].
const NOISES: [f64; 2] = [0.0, 0.0008];
const SURFACES: [(Surface, &str); 4] = [
    (Surface::Plane, "plane"),
    (Surface::Pipe(0.4), "half pipe, hole 0.3 of its radius"),
    (Surface::Pipe(0.15), "half pipe, hole 0.8 of its radius"),
    (Surface::Ball(0.4), "ball, hole 0.3 of its radius"),
];

/// One scan whose hole was filled.
struct Found {
    name: &'static str,
    /// [m].
    noise: f64,
    /// By each of [`BALLS`].
    given: Vec<Filled>,
    /// By the ball that cloud-fill chose.
    fitted: Filled,
}

impl Found {
    /// Balls over the width of the hole, where they closed it, and what came of them.
    fn closed(&self) -> impl Iterator<Item = (f64, &Filled)> {
        BALLS.into_iter().zip(&self.given).filter(|(_, f)| !f.open)
    }

    /// Least ball that closed the hole, over its width.
    fn closes(&self) -> f64 {
        self.closed().map(|(ball, _)| ball).fold(f64::INFINITY, f64::min)
    }

    /// Largest less least error of the balls that closed the hole, over its width.
    fn spread(&self) -> f64 {
        let off =
            |worst: fn(f64, f64) -> f64, from| self.closed().map(|(_, f)| f.off / HOLE).fold(from, worst);
        off(f64::max, 0.0) - off(f64::min, 1.0)
    }

    fn row(&self, ball: String, f: &Filled) -> Vec<String> {
        vec![
            self.name.to_owned(),
            format!("{:.1}", self.noise * 1e3),
            ball,
            format!("{:.2}", f.share),
            if f.open { "open" } else { "closed" }.to_owned(),
            format!("{:.2e}", f.off / HOLE),
            format!("{:.2e}", f.worst / HOLE),
        ]
    }

    fn rows(&self) -> Vec<Vec<String>> {
        let given = BALLS.into_iter().zip(&self.given);
        let mut rows: Vec<Vec<String>> = given.map(|(ball, f)| self.row(format!("{ball}"), f)).collect();
        rows.push(self.row(format!("fitted ({:.1})", self.fitted.ball / HOLE), &self.fitted));
        rows
    }
}

pub fn study(page: &mut Page) -> Result<(), String> {
    let scans = NOISES.iter().flat_map(|&noise| SURFACES.iter().map(move |&scanned| (scanned, noise)));
    let all: Vec<Found> = scans.map(|((surface, name), noise)| one(surface, name, noise)).collect();
    words(page, &all);
    let columns = [
        "surface",
        "noise [mm]",
        "ball / hole",
        "points added / missing",
        "hole",
        "rms distance / hole",
        "largest distance / hole",
    ];
    let rows: Vec<Vec<String>> = all.iter().flat_map(Found::rows).collect();
    page.table("fill", &columns, &rows)?;
    let (even, noisy): (Vec<&Found>, Vec<&Found>) = all.iter().partition(|f| f.noise == 0.0);
    let panels = [
        Panel { title: "no noise".into(), ..panel("points added / missing", &even, |f| f.share) },
        Panel { title: "noise of 0.8 mm".into(), ..panel("rms distance / hole", &noisy, |f| f.off / HOLE) },
    ];
    page.picture("fill", "Points added by ball radius", 2, &panels)
}

fn one(surface: Surface, name: &'static str, noise: f64) -> Found {
    let scan = Scan { surface, spacing: 0.006, hole: HOLE, noise };
    let given = BALLS.iter().map(|ball| fill(scan, &[ball * HOLE], 1)).collect();
    Found { name, noise, given, fitted: fill(scan, &[], 1) }
}

fn panel(what: &str, of: &[&Found], value: fn(&Filled) -> f64) -> Panel {
    let line = |f: &&Found| (f.name.to_owned(), BALLS.into_iter().zip(f.given.iter().map(value)).collect());
    Panel {
        axes: ("ball radius / width of the hole".into(), what.into()),
        lines: of.iter().map(line).collect(),
        from_zero: true,
        ..Panel::default()
    }
}

fn words(page: &mut Page, all: &[Found]) {
    let closes = all.iter().map(Found::closes).fold(0.0, f64::max);
    let spread = all.iter().map(Found::spread).fold(0.0, f64::max);
    page.head("Filling holes: ball radius against error");
    page.say(&format!(
        "Scans of known surfaces with points 6 mm apart have a round hole of {:.0} mm. cloud-fill fills it \
         with balls of one radius. Balls of at least {closes} of the hole's width closed every hole (by \
         geometry, half its width is needed). Smaller balls fall through and leave the hole open, and the \
         report says so.\n\nOnce the hole is closed the radius no longer matters: the error of the added \
         points changes \
         by at most {spread:.0e} of the hole's width. The points are put on the smooth surface of the \
         surroundings, not on the ball's triangles.",
        HOLE * 1e3
    ));
    page.advise(format!(
        "**cloud-fill**: leave `--ball` out; cloud-fill then chooses the ball. A given ball needs {closes} \
         of the hole's width to close it; a larger ball changes nothing."
    ));
}
