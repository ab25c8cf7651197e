//! The page, its tables and its pictures.

use crate::measured::Measured;
use kuva::prelude::*;
use std::path::Path;

pub const HEAD: &str = "# Sampling\n\nWhich points of a scan become wall spheres. `bluenoise-sample` picks points of the cloud and moves none. This page is written by\n\
`make -C pipelines sampling-study`; every number on it comes from there, and what must hold of them is asserted by\n\
`crates/sampling/tests/laws.rs`.\n\n\
```sh\n\
bluenoise-sample scan.ply --spacing 0.012 -o even.ply                       # no two points nearer, no gap wider\n\
bluenoise-sample scan.ply --count 100000 --method eliminate -o even.ply     # exactly so many\n\
bluenoise-sample scan.ply --density 5000,7000 -o even.ply                   # points per m²\n\
bluenoise-sample scan.ply --spacing 0.012 --plot spectrum.svg --report even.json -o even.ply   # … and its measures\n\
bluenoise-sample scan.ply --spacing 0.012 --no-measures --report count.json -o even.ply        # a report without them: no time for measuring\n\
```\n\n\
| method | what it does | take it for |\n|---|---|---|\n\
| `poisson` | Poisson disk, the loneliest point first | the default: a guarantee both ways, and quick |\n\
| `eliminate` | removes the most crowded point again and again (after Yuksel 2015) | an exact count |\n\
| `relax` | Poisson disk, then each point moves to the middle of its share (Lloyd) | the least unevenness of large extent |\n\
| `tile` | an even pattern laid on patch by patch, seams closed by Poisson disk | dense scans: a pattern that was made beforehand; fewer points for the same spacing where the scan is coarse |\n\
| `grid` | the point nearest to each node of a grid along x, y, z | flows with one direction |\n\n\
A count is met within 1 %, below 200 and by `eliminate` exactly (a grid takes the nearest it has); what cannot be met is told. \
`--keep-filled` keeps\nthe points that `cloud-fill` added.";

pub const LEGEND: &str = "Variation: standard deviation over mean of the nearest distances. Power: radial power spectrum, 1 for chance, at ν waves per P; blue noise has little \
below ν = ½ and no sharp peak. Anisotropy: 1 when directions differ by chance only. Processor time of one core, the least of two; by count it \
takes several\nsamplings to find the spacing.";

pub const TAIL: &str = "## Which distance\n\nWith `--distance surface` distances are those along the surface where another sheet lies nearer than the spacing, such as the far side of a thin plate \
(the default is `space`, which is\nquicker and bears more noise): within a spacing, points that are only\nconnected by ways more than 1.5 spacings long, and that lie off the plane of this sheet, do not thin it. Nothing but the points is needed for that: no normals. \
Around a\nright-angled edge both sides thin each other as ever. Sheets are told apart where they are at least 1.7 times as far apart as the scan's own points (and a twentieth \
of the\nspacing), and where the spacing is at least five times that of the scan; otherwise they are thinned as one. The grid is one of space.\n\n\
Surfaces that are one sheet everywhere are sampled bit for bit as in space. Noise of about the spacing of the scan makes one sheet look like many: \
take `space` there.";

/// What is written when all is known.
#[derive(Default)]
pub struct Page(String);

impl Page {
    /// A paragraph, or a heading with one.
    pub fn say(&mut self, words: &str) {
        self.0 += &format!("{}{words}\n", if self.0.is_empty() { "" } else { "\n" });
    }

    /// A table.
    pub fn table(&mut self, columns: &[&str], rows: Vec<Vec<String>>) {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let head: Vec<String> = columns.iter().map(|c| (*c).to_owned()).collect();
        self.0 += &format!("\n{}|{}\n", line(&head), "---|".repeat(columns.len()));
        rows.iter().for_each(|row| self.0 += &line(row));
    }

    /// Spectra and anisotropies of all methods, beside the page as SVG, in the folder as PNG.
    pub fn picture(&mut self, folder: &Path, file: &Path, found: &[Measured]) -> Result<(), String> {
        for (name, y, of) in [
            ("power", "radial power", (|s| &s.power) as fn(&sampling::Spectrum) -> &Vec<f64>),
            ("anisotropy", "anisotropy", |s| &s.anisotropy),
        ] {
            let draw = || {
                let colours = ["steelblue", "darkorange", "seagreen", "crimson", "grey"];
                let plots: Vec<Plot> = found
                    .iter()
                    .zip(colours)
                    .filter_map(|(f, colour)| {
                        let s = f.spectrum.as_ref()?;
                        let data: Vec<(f64, f64)> =
                            s.wave_number.iter().copied().zip(of(s).iter().map(|v| v.min(4.0))).collect();
                        let line = LinePlot::new().with_data(data).with_color(colour).with_legend(f.name());
                        Some(Plot::from(line))
                    })
                    .collect();
                let layout =
                    Layout::auto_from_plots(&plots).with_x_label("waves per mean spacing").with_y_label(
                        if name == "power" { "radial power (cut at 4)" } else { "anisotropy (cut at 4)" },
                    );
                (plots, layout)
            };
            let (plots, layout) = draw();
            let svg = format!("sampling-{name}.svg");
            let out = file.with_file_name(&svg);
            std::fs::write(&out, kuva::render_to_svg(plots, layout))
                .map_err(|why| format!("{}: {why}", out.display()))?;
            let (plots, layout) = draw();
            let png = kuva::render_to_raster(plots, layout, 1.0)?;
            let out = folder.join(format!("sampling-{name}.png"));
            std::fs::write(&out, png).map_err(|why| format!("{}: {why}", out.display()))?;
            self.0 += &format!("\n![The {y} of the samples]({svg})\n");
        }
        Ok(())
    }

    /// Writes it.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, file: &Path) -> Result<(), String> {
        std::fs::write(file, &self.0).map_err(|why| format!("{}: {why}", file.display()))
    }
}
