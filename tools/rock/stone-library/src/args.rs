//! The command line.

use crate::Entry;
use clap::Parser;
use geom::Shown;
use std::path::PathBuf;

const EXAMPLES: &str = "DIR has rock_N_H.ply (stone H of size class N), table.csv and sheet.png. Variants are marked in the table and in their files.\n\n\
    Examples:\n\
    \x20 stone-library pebble.ply stone.ply -o rocks\n\
    \x20 stone-library pebble.ply --variants 10 --sieves 0.01,0.02,0.04,0.08,0.16 -o more-rocks";

/// Sieve sizes [m]: the basic set of EN 933-2, continued.
const SIEVES: [f64; 13] = [0.001, 0.002, 0.004, 0.008, 0.016, 0.0315, 0.063, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0];

/// Make a library of stones: named meshes, a table of their shapes, a page of pictures, and variants
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Closed meshes (PLY, STL, OBJ; detected by content)
    #[arg(value_name = "MESH", required = true)]
    pub meshes: Vec<PathBuf>,
    #[command(flatten)]
    pub lengths: cli::Lengths,
    #[command(flatten)]
    pub placing: cli::Placing,
    /// Folder for the library; it is made when it is missing
    #[arg(id = "output", short = 'o', long = "output", value_name = "DIR", required = true)]
    pub folder: cli::OutPath,
    /// Add this number of variants: stones between two scans, with measures of shape within theirs
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub variants: Option<u32>,
    /// Sieves between the size classes, growing [m]; class 1 is below the first [default: 1, 2, 4, 8, 16, 31.5, 63, 125 mm and so on]
    #[arg(long, value_name = "M,…", value_delimiter = ',', value_parser = cli::length, allow_hyphen_values = true)]
    sieves: Vec<f64>,
    #[command(flatten)]
    pub seed: cli::Seed,
}

/// Sieves that are so many times larger or smaller than all stones are in another unit.
const FAR: f64 = 10.0;

impl Args {
    /// Refuses options that change nothing, and a folder that has a library.
    pub fn check_used(&self) -> anyhow::Result<()> {
        if self.variants.is_none() {
            self.seed.none("a library without --variants")?;
        }
        if self.sieves.windows(2).any(|w| w[0] >= w[1]) {
            return Err(cli::usage("--sieves: give sizes that grow"));
        }
        let has_rock = |entry: std::fs::DirEntry| entry.file_name().to_string_lossy().starts_with("rock_");
        let here = std::fs::read_dir(&self.folder).into_iter().flatten().filter_map(Result::ok);
        if let Some(rock) = here.filter(|e| e.path().is_file()).map(has_rock).find(|r| *r) {
            debug_assert!(rock);
            anyhow::bail!(
                "-o {}: has stones already (rock_…): choose another folder, or remove them",
                self.folder.display()
            );
        }
        Ok(())
    }

    /// Warns of sieves that are in another unit than the stones, whose sieve sizes are from `lo` to `hi` [m].
    pub fn warn_of_sieves(&self, lo: f64, hi: f64) {
        let [Some(first), Some(last)] = [self.sieves.first(), self.sieves.last()] else { return };
        if *first > FAR * hi || FAR * last < lo {
            cli::warn(&format!(
                "--sieves: from {} to {} m, and the stones from {} to {} m: sieves are in metres, 16 mm is 0.016",
                Shown(*first),
                Shown(*last),
                Shown(lo),
                Shown(hi)
            ));
        }
    }

    /// rock_N_H: H counts the stones of class N, scans first.
    pub fn names(&self, all: &[Entry]) -> Vec<String> {
        let sieves = if self.sieves.is_empty() { &SIEVES[..] } else { &self.sieves };
        let mut counts = vec![0; sieves.len() + 1];
        let mut name = |entry: &Entry| {
            let class = sieves.iter().filter(|s| entry.shape.sieve_size >= **s).count();
            counts[class] += 1;
            format!("rock_{}_{}", class + 1, counts[class])
        };
        all.iter().map(&mut name).collect()
    }
}
