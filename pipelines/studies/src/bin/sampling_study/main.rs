//! Methods of sampling, measured: `sampling_study FOLDER PAGE.md` writes the page, its plots beside it, and the plots as PNG into the folder.
//!
//! Every number of the page comes from here. What must hold of them is asserted by `crates/scan/sampling/tests/laws/`.

mod clouds;
mod measured;
mod page;

use measured::{METHODS, Measured, measured};
use page::Page;
use sampling::{Amount, Distance, Method};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [folder, file] = words.as_slice() else {
        eprintln!("sampling_study: usage: sampling_study FOLDER PAGE.md");
        return ExitCode::from(2);
    };
    match study(Path::new(folder), Path::new(file)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("sampling_study: {why}");
            ExitCode::FAILURE
        }
    }
}

fn study(folder: &Path, file: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    let mut page = Page::default();
    page.say(page::HEAD);
    eprintln!("sampling_study: methods");
    dense(&mut page, folder, file)?;
    eprintln!("sampling_study: scans");
    scans(&mut page)?;
    eprintln!("sampling_study: plates");
    plates(&mut page);
    page.say(page::TAIL);
    page.write(file)
}

/// A sheet scanned much finer than the sample: what each method is by itself.
fn dense(page: &mut Page, folder: &Path, file: &Path) -> Result<(), String> {
    let count = 6000;
    let points = clouds::sheet(200_000);
    let before = sampling::nearest_distances(&points).map_or(0.0, |n| n.variation);
    page.say(&format!(
        "## The methods compared\n\nA bent sheet of 1 m² with {} random points (variation of their nearest \
         distances: {before:.2}), thinned to about {count}. P = √(area per point kept).",
        points.len()
    ));
    let wished = |method: Method| match method {
        // A grid's count follows from its nodes.
        Method::Grid => Amount::Spacing(1.0 / (count as f64).sqrt()),
        _ => Amount::Count(count),
    };
    let found: Vec<Measured> = METHODS
        .iter()
        .map(|&m| measured(&points, wished(m), m, Distance::Surface))
        .collect::<Result<_, _>>()?;
    let rows = found.iter().map(|f| {
        let spectrum = f.spectrum.as_ref();
        let number = |of: fn(&sampling::Spectrum) -> f64| {
            spectrum.map_or("–".to_owned(), |s| format!("{:.2}", of(s)))
        };
        vec![
            f.name().to_owned(),
            f.kept.to_string(),
            format!("{:.2}", f.nearest.min * (f.kept as f64).sqrt()),
            format!("{:.3}", f.nearest.variation),
            number(|s| s.power.first().copied().unwrap_or(0.0)),
            number(sampling::Spectrum::low),
            number(|s| s.peak().1),
            number(sampling::Spectrum::mean_anisotropy),
            format!("{:.2} s", f.seconds),
        ]
    });
    let columns = [
        "method",
        "kept",
        "least distance / P",
        "variation",
        "lowest power",
        "power below ν = ½",
        "highest power",
        "anisotropy",
        "processor time",
    ];
    page.table(&columns, rows.collect());
    page.say(page::LEGEND);
    page.picture(folder, file, &found)
}

/// Real scans and the sample of a chute, which are hardly finer than the sample.
fn scans(page: &mut Page) -> Result<(), String> {
    page.say(
        "## Scans\n\nAll methods get the same `--spacing`, so they keep different numbers of points. The \
         table shows the variation of the nearest distances before and after, and the processor time of one \
         core.",
    );
    let mut rows = Vec::new();
    for (name, file, spacing) in clouds::SCANS {
        let cloud = clouds::read(file)?;
        let before = sampling::nearest_distances(&cloud.points).map_or(0.0, |n| n.variation);
        for method in METHODS {
            let f = measured(&cloud.points, Amount::Spacing(spacing), method, Distance::Surface)?;
            rows.push(vec![
                format!("{name}, {} points", cloud.points.len()),
                format!("{} mm", 1e3 * spacing),
                f.name().to_owned(),
                f.kept.to_string(),
                format!("{before:.2} → {:.3}", f.nearest.variation),
                format!("{:.2}", f.nearest.min / spacing),
                format!("{:.2} s", f.seconds),
            ]);
        }
    }
    let columns =
        ["scan", "spacing", "method", "kept", "variation", "least distance / spacing", "processor time"];
    page.table(&columns, rows);
    Ok(())
}

/// Both sides of a plate thinner than the spacing.
fn plates(page: &mut Page) {
    page.say(
        "## Two sheets closer than the spacing\n\nBoth sides of a plate of 1 m² with 60 000 points are \
         thinned with a spacing r of 60 mm. The columns *lower side* and *upper side* show the number of \
         kept points on one side, times r² over the area. A full Poisson-disk sample of a single sheet has \
         about 0.69. In space (`--distance space`) \
         the two sides thin each other; along the surface each is sampled as if it were alone.",
    );
    let spacing = 0.06;
    let mut rows = Vec::new();
    for (thickness, noise) in [(0.01, 0.0), (0.02, 0.0), (0.02, 0.0015), (0.04, 0.0015)] {
        let points = clouds::plate(60_000, thickness, noise);
        for distance in [Distance::Space, Distance::Surface] {
            let Ok(f) = measured(&points, Amount::Spacing(spacing), Method::Poisson, distance) else {
                continue;
            };
            let side = |upper: bool| {
                let on = |p: &&geom::Vec3| (p.z > 0.5 * thickness) == upper;
                format!("{:.2}", f.points.iter().filter(on).count() as f64 * spacing * spacing)
            };
            let along = if distance == Distance::Space { "space" } else { "surface" };
            rows.push(vec![
                format!("{} mm", 1e3 * thickness),
                format!("{} mm", 1e3 * noise),
                along.to_owned(),
                f.kept.to_string(),
                side(false),
                side(true),
                format!("{:.2} s", f.seconds),
            ]);
        }
    }
    let columns = ["thickness", "noise σ", "distance", "kept", "lower side", "upper side", "processor time"];
    page.table(&columns, rows);
}
