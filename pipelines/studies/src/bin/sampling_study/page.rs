//! The page, its tables and its pictures.

use crate::measured::Measured;
use kuva::prelude::*;
use std::path::Path;

pub const HEAD: &str = r#"# Sampling

`bluenoise-sample` chooses the points of a scan that become wall spheres. It does not move points.

```sh
bluenoise-sample scan.ply --spacing 0.012 -o even.ply                       # at least 12 mm between kept points; every other point within 12 mm of one
bluenoise-sample scan.ply --count 100000 --method eliminate -o even.ply     # an exact number of points
bluenoise-sample scan.ply --density 5000,7000 -o even.ply                   # points per m²
bluenoise-sample scan.ply --spacing 0.012 --plot spectrum.svg --report even.json -o even.ply   # a plot and a report of the spectrum
bluenoise-sample scan.ply --spacing 0.012 --no-measures --report count.json -o even.ply        # a short report, which takes less time
```

| `--method` | what it does | use it for |
|---|---|---|
| `poisson` | Poisson disk: takes the point with the fewest rivals left first | the default: guarantees both distances, and is fast |
| `eliminate` | removes the most crowded point repeatedly (after Yuksel 2015) | an exact count |
| `relax` | Poisson disk; then each kept point is replaced by the point nearest to the middle of its share (Lloyd) | the most even density over long distances |
| `tile` | lays a prepared even pattern patch by patch and closes the seams by Poisson disk | dense scans. On coarse scans it keeps fewer points for the same spacing |
| `grid` | the point nearest to each node of a grid along x, y, z | flows with one direction |

The number of points differs from `--count` by at most 1 %. It is exact below 200, and with `eliminate`. `grid` takes the nearest count that a grid can have. A count that cannot be met prints a warning. `--keep-filled` keeps the points that `cloud-fill` added. A scan that is too sparse for the spacing is filled before: `cloud-fill --for-spacing` ([filling.md](../reference/filling.md#where-the-scan-is-sparse)).

`make -C pipelines sampling-study` writes this page. The tests `crates/scan/sampling/tests/laws.rs` check the guarantees."#;

pub const LEGEND: &str = r#"| column | meaning |
|---|---|
| variation | standard deviation over mean of the nearest distances |
| power | radial power spectrum at ν waves per P; 1 for random points. Blue noise has little power below ν = ½ and no sharp peak |
| anisotropy | 1 if directions differ only by random scatter |
| processor time | time of one core, the smaller of two runs. With a count, it includes the search for the spacing, which takes several samplings |"#;

pub const TAIL: &str = r#"## Which distance

| `--distance` | meaning |
|---|---|
| `space` (default) | straight distance. It is faster and tolerates more noise |
| `surface` | distance along the surface where another sheet is nearer than the spacing, such as the far side of a thin plate |

With `surface`, two points within the spacing do not thin each other if every connection between them along the points is longer than 1.5 spacings and one lies off the plane of the other's sheet. This needs only the points, no normals. At a right-angled edge both sides thin each other as usual.

Two sheets are detected if the distance between them is at least 1.7 times the spacing of the scan and a twentieth of the wanted spacing, and if the wanted spacing is at least five times that of the scan. Otherwise they are thinned as one. The method `grid` always works in space.

On a surface that is a single sheet everywhere, `surface` gives the same points as `space`, bit for bit. Noise of about the spacing of the scan makes one sheet look like many: use `space` there."#;

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
            let svg = format!("sampling-{name}.svg");
            for out in [file.with_file_name(&svg), folder.join(format!("sampling-{name}.png"))] {
                let (plots, layout) = draw();
                let picture = plot::diagram(&out, plots, layout).map_err(|e| e.to_string())?;
                std::fs::write(&out, picture).map_err(|why| format!("{}: {why}", out.display()))?;
            }
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
