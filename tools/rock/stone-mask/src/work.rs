//! Photograph by photograph: read, find or take the mask, write it.

use crate::args::Args;
use crate::kept::{self, Before, Note};
use anyhow::Context;
use photos::mask::{Found, among};
use photos::sheet::Thumbnail;
use photos::{Mask, MaskSettings, MaskWarning, Photograph, find_mask, photograph};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Photographs in memory at a time, at most.
const AT_ONCE: usize = 8;

/// Where a mask came from.
#[derive(Clone, Copy, PartialEq)]
pub enum Origin {
    /// It was found in the photograph.
    Photograph,
    /// `--given` has it.
    Given,
    /// An earlier call has found it.
    Before,
}

/// What is kept of a mask that is written.
pub struct Done {
    pub origin: Origin,
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
    let (mut all, mut failed) = (Vec::with_capacity(photographs.len()), Vec::new());
    for some in photographs.chunks(AT_ONCE) {
        let done: Vec<anyhow::Result<Done>> = some
            .par_iter()
            .map(|path| {
                let done = one(args, &settings, path).with_context(|| path.display().to_string());
                progress.add(1);
                done
            })
            .collect();
        for done in done {
            match done {
                Ok(done) => all.push(done),
                Err(error) => failed.push(error),
            }
        }
    }
    if let Some(last) = failed.pop() {
        failed.iter().for_each(|error| cli::warn(&format!("{error:#}")));
        let of = format!(
            "{} of {} have no mask",
            failed.len() + 1,
            geom::counted(photographs.len(), "photograph")
        );
        return Err(last.context(format!("{of}; those of the others are in {}", args.folder.display())));
    }
    if args.given.is_some() && all.iter().all(|done| done.origin != Origin::Given) {
        return Err(cli::usage("--given: has no mask of the name of a photograph (NAME.png): leave it out"));
    }
    if args.sets_how() && all.iter().all(|done| done.origin == Origin::Given) {
        cli::warn(
            "--object, --level, --open and --close changed nothing: --given has the masks of all photographs",
        );
    }
    Ok(all)
}

/// One photograph.
fn one(args: &Args, settings: &MaskSettings, path: &Path) -> anyhow::Result<Done> {
    let bytes = stream::whole::file(path).context("cannot open it")?;
    let name = photograph::mask_name(path);
    let file = args.folder.join(&name);
    let given = args.given.as_ref().map(|dir| dir.join(&name)).filter(|p| p.is_file());
    let stamp = kept::stamp(&bytes, settings);
    let before = match given.is_none().then(|| kept::read(&file, &stamp)) {
        Some(Before::Mask(mask)) => Some(mask),
        Some(Before::Foreign) => {
            let name = name.display();
            cli::warn(&format!(
                "{name} of an earlier call was drawn or changed elsewhere, and is replaced: --given DIR takes such masks from another folder"
            ));
            None
        }
        Some(Before::Other) | None => None,
    };
    let read = || Photograph::read(&bytes);
    let (mut mask, origin, photograph) = match before {
        Some(mask) => (mask, Origin::Before, args.sheet.is_some().then(read).transpose()?),
        None => {
            let photograph = read()?;
            let (mask, origin) = match &given {
                Some(given) => {
                    let mask = taken(given, &photograph);
                    (mask.with_context(|| format!("--given: {}", given.display()))?, Origin::Given)
                }
                None => (find_mask(&photograph, settings), Origin::Photograph),
            };
            (mask, origin, Some(photograph))
        }
    };
    if origin != Origin::Before {
        let note = Note::new(stamp, &mask)?;
        mask.found = note.as_ref().map(|note| note.found);
        let png = kept::png(&mask, note.as_ref())?;
        cli::OutputStream::write_file(&file, &png)?;
    }
    Ok(Done {
        origin,
        area: mask.area(),
        pixels: mask.coverage.len(),
        found: mask.found,
        warnings: mask.warnings(),
        thumbnail: photograph.filter(|_| args.sheet.is_some()).map(|p| Thumbnail::new(&p, &mask)),
    })
}

/// A mask from elsewhere.
fn taken(path: &Path, photograph: &Photograph) -> anyhow::Result<Mask> {
    let bytes = stream::whole::file(path).context("cannot open it")?;
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
    cli::OutputStream::write_file(path, &png)
}
