//! The command line.

use anyhow::Context;
use clap::Parser;
use cli::OutPath;
use photos::{MaskSettings, Polarity, raster::WIDEST};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "A mask is a grey PNG with the name of its photograph: white is stone; grey on the edge is the share of the pixel that is stone.\n\n\
    Examples:\n\
    \x20 stone-mask photographs -o masks --sheet sheet.png\n\
    \x20 stone-mask photographs/01.png photographs/02.png --object bright --level 100 -o masks";

/// Find the masks of photographs: which pixels are stone
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Photographs (JPEG, PNG; detected by content), or folders of them
    #[arg(value_name = "PHOTO", required = true)]
    photographs: Vec<PathBuf>,
    /// Folder for the masks; it is made when it is missing
    #[arg(id = "output", short = 'o', long = "output", value_name = "DIR", required = true)]
    pub folder: OutPath,
    /// Take masks from this folder where it has one of the photograph's name, and find the others
    #[arg(long, value_name = "DIR")]
    pub given: Option<PathBuf>,
    /// Contact sheet: all photographs with the edges of their masks (PNG)
    #[arg(long, value_name = "FILE")]
    pub sheet: Option<OutPath>,
    /// Whether the stone is brighter or darker than what is behind it [default: what most of the frame is not]
    #[arg(long, value_enum)]
    object: Option<Object>,
    /// Value that parts stone and background, 0-255 [default: by Otsu's rule, for each photograph]
    #[arg(long, value_name = "VALUE")]
    level: Option<u8>,
    /// What is narrower than twice this is no stone [px] [default: a thousandth of the diagonal]
    #[arg(long, value_name = "PX", value_parser = pixels)]
    open: Option<f64>,
    /// Gaps narrower than twice this are stone [px] [default: as --open]
    #[arg(long, value_name = "PX", value_parser = pixels)]
    close: Option<f64>,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Object {
    /// The stone is brighter than the background
    Bright,
    /// The stone is darker than the background
    Dark,
}

/// Radius of the morphology, at most that of a large stone on a large photograph.
fn pixels(text: &str) -> Result<f64, String> {
    let value = geom::number::not_negative(text).map_err(|e| e.to_string())?;
    if value <= WIDEST { Ok(value) } else { Err(format!("give at most {WIDEST}")) }
}

impl Args {
    /// Refuses folders that would mix inputs and outputs.
    pub fn check_used(&self) -> anyhow::Result<()> {
        let same = |a: &Path, b: &Path| {
            a == b || a.canonicalize().ok().is_some_and(|a| b.canonicalize().ok() == Some(a))
        };
        if let Some(given) = self.given.as_ref().filter(|given| !given.is_dir()) {
            return Err(cli::usage(format!("--given {}: no such folder", given.display())));
        }
        if let Some(sheet) =
            self.sheet.as_ref().filter(|s| s.extension().is_none_or(|e| !e.eq_ignore_ascii_case("png")))
        {
            let sheet = sheet.display();
            return Err(cli::usage(format!(
                "--sheet {sheet}: the sheet is a PNG: use a name that ends in .png"
            )));
        }
        if self.given.as_ref().is_some_and(|given| same(given, &self.folder)) {
            return Err(cli::usage("-o: is the folder of --given: choose another one"));
        }
        let beside = |p: &PathBuf| same(if p.is_dir() { p } else { p.parent().unwrap_or(p) }, &self.folder);
        if self.photographs.iter().any(beside) {
            return Err(cli::usage("-o: is the folder of the photographs: choose another one for the masks"));
        }
        let Some(sheet) = &self.sheet else { return Ok(()) };
        let place = sheet.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let is_of = |p: &PathBuf| p.is_dir() && same(p, place) || same(p, sheet);
        if same(place, &self.folder) || self.photographs.iter().chain(&self.given).any(is_of) {
            let sheet = sheet.display();
            return Err(cli::usage(format!(
                "--sheet {sheet}: lies among the photographs or masks, and would be taken for one of them: choose another folder"
            )));
        }
        Ok(())
    }

    /// All photographs, those of folders in the order of their names.
    pub fn photographs(&self) -> anyhow::Result<Vec<PathBuf>> {
        let mut all = Vec::new();
        for path in &self.photographs {
            if path.is_dir() {
                all.extend(in_folder(path)?);
            } else {
                all.push(path.clone());
            }
        }
        let mut seen: HashMap<String, &PathBuf> = HashMap::new();
        for path in &all {
            let mask = photos::photograph::mask_name(path).display().to_string();
            if let Some(other) = seen.insert(mask.clone(), path) {
                return Err(cli::usage(format!(
                    "{}: its mask {mask} would replace that of {}: rename one of them",
                    path.display(),
                    other.display()
                )));
            }
        }
        Ok(all)
    }

    /// Whether an option says how masks are found.
    pub fn sets_how(&self) -> bool {
        self.object.is_some() || self.level.is_some() || self.open.is_some() || self.close.is_some()
    }

    /// How masks are found.
    pub fn settings(&self) -> MaskSettings {
        let polarity = self.object.map(|object| match object {
            Object::Bright => Polarity::Bright,
            Object::Dark => Polarity::Dark,
        });
        MaskSettings { polarity, level: self.level, open: self.open, close: self.close }
    }
}

fn in_folder(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let found = photos::photograph::in_folder(folder)
        .with_context(|| format!("{}: cannot read the folder", folder.display()))?;
    match found.len() {
        0 => anyhow::bail!("{}: has no photograph (.jpg, .jpeg, .png)", folder.display()),
        _ => Ok(found),
    }
}
