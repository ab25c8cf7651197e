//! Photograph by photograph: read, find or take the mask, write it.

use crate::args::Args;
use anyhow::Context;
use photos::mask::{Found, among};
use photos::sheet::Thumbnail;
use photos::{Mask, MaskSettings, MaskWarning, Photograph, find_mask, photograph};
use rayon::prelude::*;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Photographs in memory at a time, at most.
const AT_ONCE: usize = 8;

/// What is kept of a mask that is written.
pub struct Done {
    pub area: f64,
    pub pixels: usize,
    pub found: Option<Found>,
    pub warnings: Vec<MaskWarning>,
    thumbnail: Option<Thumbnail>,
}

/// Finds or takes all masks, and writes them.
pub fn masks(args: &Args, photographs: &[PathBuf]) -> anyhow::Result<Vec<Done>> {
    std::fs::create_dir_all(&args.folder)
        .with_context(|| format!("{}: cannot make the folder", args.folder.display()))?;
    let progress = cli::Progress::new("photographs", photographs.len() as u64);
    let settings = args.settings();
    let mut all = Vec::with_capacity(photographs.len());
    let mut given = 0;
    for some in photographs.chunks(AT_ONCE) {
        let done: Vec<anyhow::Result<(Done, bool)>> = some
            .par_iter()
            .map(|path| {
                let done = one(args, &settings, path).with_context(|| path.display().to_string());
                progress.add(1);
                done
            })
            .collect();
        for done in done {
            let (done, taken) = done?;
            given += usize::from(taken);
            all.push(done);
        }
    }
    if args.given.is_some() && given == 0 {
        return Err(cli::usage("--given: has no mask of the name of a photograph (NAME.png): leave it out"));
    }
    Ok(all)
}

/// One photograph; whether its mask was given.
fn one(args: &Args, settings: &MaskSettings, path: &Path) -> anyhow::Result<(Done, bool)> {
    let bytes = std::fs::read(path).context("cannot open it")?;
    let photograph = Photograph::read(&bytes)?;
    drop(bytes);
    let name = Path::new(path.file_stem().unwrap_or_default()).with_extension("png");
    let given = args.given.as_ref().map(|dir| dir.join(&name)).filter(|p| p.is_file());
    let mask = match &given {
        Some(given) => taken(given, &photograph).with_context(|| format!("--given: {}", given.display()))?,
        None => find_mask(&photograph, settings),
    };
    let png = photograph::png(mask.width, mask.height, &mask.coverage)?;
    let mut out = cli::OutputStream::file(&args.folder.join(name))?;
    out.write_all(&png)?;
    out.commit()?;
    let done = Done {
        area: mask.area(),
        pixels: mask.coverage.len(),
        found: mask.found,
        warnings: mask.warnings(),
        thumbnail: args.sheet.is_some().then(|| Thumbnail::new(&photograph, &mask)),
    };
    Ok((done, given.is_some()))
}

/// A mask from elsewhere.
fn taken(path: &Path, photograph: &Photograph) -> anyhow::Result<Mask> {
    let bytes = std::fs::read(path).context("cannot open it")?;
    let (width, height, values) = photograph::read_values(&bytes)?;
    if (width, height) != (photograph.width, photograph.height) {
        anyhow::bail!(
            "has {width} × {height} pixels, its photograph {} × {}: give the mask of the photograph as it is",
            photograph.width,
            photograph.height
        );
    }
    Ok(Mask::given(width, height, values))
}

/// Prints all warnings with the names of the photographs; which have one.
pub fn warn(photographs: &[PathBuf], done: &[Done]) -> Vec<bool> {
    let areas: Vec<f64> = done.iter().map(|d| d.area).collect();
    let widths: Vec<Option<f64>> = done.iter().map(|d| d.found.map(|f| f.edge_width)).collect();
    let mut others = among(&areas, &widths);
    // A blurred photograph is named once.
    others.retain(|(k, w)| {
        let blurred = |w: &MaskWarning| matches!(w, MaskWarning::Blurred { .. });
        !(blurred(w) && done[*k].warnings.iter().any(blurred))
    });
    let mut warned = vec![false; done.len()];
    for (k, done) in done.iter().enumerate() {
        let all = done.warnings.iter().chain(others.iter().filter(|(n, _)| *n == k).map(|(_, w)| w));
        for warning in all {
            cli::warn(&format!("{}: {warning}", photographs[k].display()));
            warned[k] = true;
        }
    }
    warned
}

/// Writes the contact sheet.
pub fn write_sheet(path: &Path, done: &[Done], warned: &[bool]) -> anyhow::Result<()> {
    let thumbnails: Vec<Thumbnail> = done.iter().filter_map(|d| d.thumbnail.clone()).collect();
    let png = photos::sheet::sheet(&thumbnails, warned).context("--sheet")?;
    let mut out = cli::OutputStream::file(path)?;
    out.write_all(&png)?;
    out.commit()
}
