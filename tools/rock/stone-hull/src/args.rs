//! The command line.

use clap::Parser;
use std::path::PathBuf;

const EXAMPLES: &str = "The hull holds the stone and does not enter its hollows: its volume is an upper bound, unless --refine finds them.\n\nExamples:\n\
    \x20 stone-hull photographs --masks masks --turntable turntable.toml --refine -o stone.ply\n\
    \x20 stone-hull photographs --masks masks --poses poses.txt --length 0.12 -o stone.ply\n\
    \x20 stone-hull photographs --masks masks --poses poses.txt --hold-out 3 -o try.ply";

/// Carve the visual hull of a stone from the masks of its photographs
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
#[command(group = clap::ArgGroup::new("from").required(true).args(["turntable", "poses"]))]
pub struct Args {
    /// Folder of the photographs
    #[arg(value_name = "PHOTO-DIR")]
    pub photographs: PathBuf,
    /// Folder of their masks, NAME.png (stone-mask)
    #[arg(long, value_name = "DIR")]
    pub masks: PathBuf,
    /// Turntable: camera, and turns with their tilts and steps (TOML, docs/how-to/photographs.md)
    #[arg(long, value_name = "FILE.toml")]
    pub turntable: Option<PathBuf>,
    /// Change focal length, axis, tilts and steps of --turntable a little until the silhouettes agree
    #[arg(long, requires = "turntable", conflicts_with = "poses")]
    pub adjust: bool,
    /// Poses: a table of a name and twelve numbers (3 × 4 matrix, row by row) a line, a folder with one matrix for each photograph, or COLMAP's folder with cameras.txt and images.txt
    #[arg(long, value_name = "FILE|DIR")]
    pub poses: Option<PathBuf>,
    /// Size of the photographs that the matrices of --poses are for [px] [default: that of the masks]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size, requires = "poses", conflicts_with = "turntable")]
    pub poses_size: Option<[usize; 2]>,
    /// Longest side of the stone's smallest box, which gives the scale [m]
    #[arg(long, value_name = "M", value_parser = cli::length)]
    pub length: Option<f64>,
    /// Side of the black square of the tags that lie beside the stone (AprilTag, family 36h11), which gives the scale [m]
    #[arg(long, value_name = "M", value_parser = cli::length, conflicts_with = "length")]
    pub tag_size: Option<f64>,
    /// Cells along the longest side of the hull
    #[arg(long, value_name = "N", default_value = "200", value_parser = cells)]
    pub cells: usize,
    /// Move the surface inwards to where the photographs agree: hollows that no silhouette shows; needs speckle
    #[arg(long)]
    pub refine: bool,
    /// Every Nth photograph does not carve: the mesh is compared with its mask, which tells how well it fits what it was not made from
    #[arg(long, value_name = "N", value_parser = every)]
    pub hold_out: Option<usize>,
    #[command(flatten)]
    pub output: cli::Output,
}

fn size(text: &str) -> Result<[usize; 2], String> {
    let wrong = || "give WIDTHxHEIGHT in pixels, such as 4000x3000".to_owned();
    let (w, h) = text.split_once('x').ok_or_else(wrong)?;
    let number = |t: &str| t.parse().ok().filter(|n| (1..=100_000).contains(n)).ok_or_else(wrong);
    Ok([number(w)?, number(h)?])
}

fn cells(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|n| (8..=600).contains(n))
        .ok_or_else(|| "give a number from 8 to 600".to_owned())
}

fn every(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|n| (2..=1000).contains(n))
        .ok_or_else(|| "give a number from 2 to 1000".to_owned())
}
