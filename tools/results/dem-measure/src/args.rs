//! The command line.

use crate::measures::{Chosen, GROUP};
use clap::{ArgGroup, Parser};
use cli::{OutPath, Output, Source, usage};
use geom::Vec3;
use geom::number::finite;
use measure::definition::{Bins, Frames, GivenShape};
use measure::profile::Turn;
use measure::registry::{ALL, Entry};

const SHAPES: &str = "SHAPE: box:x0,y0,z0,x1,y1,z1 | sphere:x,y,z,r | cylinder:x0,y0,z0,x1,y1,z1,r | \
    cone:x0,y0,z0,x1,y1,z1,r0,r1 | halfspace:px,py,pz,nx,ny,nz | prism:FILE.json | mesh:FILE | mesh:FILE,units=mm | mesh:FILE,transform=MATRIX.txt | all (where no volume \
    is needed); a ! before a SHAPE means its outside. PLANE: px,py,pz,nx,ny,nz, with n in the direction of flow. \
    All lengths in metres.\n\
    docs/how-to/measure.md defines each measure and its columns.\n\n\
    Examples:\n\
    \x20 dem-measure run.mcap --profile --axis z --bins 5\n\
    \x20 dem-measure heap.mcap --repose --side x- --within box:-1,-1,0,1,1,0.5\n\
    \x20 dem-measure run.mcap --flow 0,0,0.02,0,0,-1 --plot flow.svg -o flow.csv\n\
    \x20 dem-measure run.mcap --porosity box:0,0,0,0.05,0.05,0.02\n\
    \x20 dem-measure run.mcap --wall-force all --wall floor\n\
    \x20 dem-measure worn.mcap --wear all --wear-coefficient 1e-13 --thickness '12 mm' -o worn.vtp\n\
    \x20 dem-measure bonded.mcap --bonds --plot bonds.svg\n\
    \x20 dem-measure bonded.mcap --grading --sieves 0.004,0.008,0.016";

/// Measure a run (MCAP), also while it is still being written; CSV (or JSON) to stdout
#[derive(Parser, Debug)]
#[command(after_help = SHAPES)]
#[command(group(ArgGroup::new(GROUP).required(true)))]
pub struct Args {
    /// The run (MCAP), - for stdin
    #[arg(value_name = "RUN.mcap", default_value = "-", hide_default_value = true)]
    pub run: Source,
    #[command(flatten)]
    pub measure: Chosen,

    /// The frame nearest to S [s], as in dem-view
    #[arg(long, value_name = "S", value_parser = cli::seconds, help_heading = "Which frames")]
    pub time: Option<f64>,
    /// The last frame (repose, profile and forces: the default)
    #[arg(long, conflicts_with = "time", help_heading = "Which frames")]
    pub last: bool,
    /// Every frame (default of the other measures)
    #[arg(long, conflicts_with_all = ["time", "last"], help_heading = "Which frames")]
    pub all: bool,
    /// Every frame from S on [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds, conflicts_with_all = ["time", "last"], help_heading = "Which frames")]
    pub from: Option<f64>,
    /// Every frame until S [s]
    #[arg(long, value_name = "S", value_parser = cli::seconds, conflicts_with_all = ["time", "last"], help_heading = "Which frames")]
    pub until: Option<f64>,

    /// Up (default: against the scene's gravity, else z) [repose, segregation, bed-height, bed-slope]
    #[arg(long, value_name = "x,y,z", value_parser = vector, allow_hyphen_values = true, help_heading = "How")]
    pub up: Option<Vec3>,
    /// Sectors around the axis, or lanes from the wall (default 8) [repose]; sectors of the rings (default 1) [radial]
    #[arg(long, value_name = "N", help_heading = "How")]
    pub sectors: Option<usize>,
    /// Radius of the outermost ring [m] (default: that of the farthest grain in the first frame) [radial]
    #[arg(long, value_name = "M", help_heading = "How")]
    pub outer: Option<f64>,
    /// Fractions of the heap's height, or of the bed's length, between which a line is fitted (default 0.2,0.8) [repose, bed-slope]
    #[arg(long, value_name = "LO,HI", value_parser = pair, help_heading = "How")]
    pub fractions: Option<[f64; 2]>,
    /// Width of the bins of the profile [m] (default: a mean diameter) [repose, bed-slope]
    #[arg(long, value_name = "M", value_parser = cli::length, help_heading = "How")]
    pub bin: Option<f64>,
    /// Height of the ground [m] (default: that of the lowest grains) [repose, bed-height, radial]
    #[arg(long, value_name = "M", value_parser = finite, allow_hyphen_values = true, help_heading = "How")]
    pub ground: Option<f64>,
    /// The heap leans on a wall at this side: x- x+ y- y+ z- z+ [repose]
    #[arg(long, value_name = "SIDE", value_parser = side, allow_hyphen_values = true, help_heading = "How")]
    pub side: Option<Vec3>,
    /// Only inside SHAPE: the grains of the heap, without falling ones [repose], the crossings [flow]; the box of the grid [profile]; the grains of the first frame [strain]; the grains of the bed [bed-height]
    #[arg(long, value_name = "SHAPE", value_parser = shape, help_heading = "How")]
    pub within: Option<GivenShape>,
    /// Rows for spans of S [s] (default: from frame to frame) [flow]
    #[arg(long, value_name = "S", value_parser = cli::span, help_heading = "How")]
    pub span: Option<f64>,
    /// Axis of the bins: x, y or z (default z) [profile]
    #[arg(long, value_name = "AXIS", value_parser = axis, help_heading = "How")]
    pub axis: Option<usize>,
    /// Number of bins along the axis (default 20), or along all three axes [profile]; number of rings (default 20) [radial]
    #[arg(long, value_name = "N|NX,NY,NZ", value_parser = bins, help_heading = "How")]
    pub bins: Option<Bins>,
    /// Turn the axes of the grid by DEG degrees about x, y or z: y,30 tilts x down by 30° [profile]
    #[arg(long, value_name = "AXIS,DEG", value_parser = turn, help_heading = "How")]
    pub turn_deg: Option<Turn>,
    /// One profile, averaged over the frames [profile]
    #[arg(long, conflicts_with_all = ["time", "last"], help_heading = "How")]
    pub mean: bool,
    /// Also the mean of this column of /particles (repeat) [profile]
    #[arg(long, value_name = "NAME", help_heading = "How")]
    pub field: Vec<String>,
    /// Side of the cells [m] [segregation: default 3 mean diameters; wear]
    #[arg(long, value_name = "M", value_parser = cli::length, help_heading = "How")]
    pub cell: Option<f64>,
    /// The first kind is grains larger than M [m] (default: the median) [segregation]
    #[arg(long, value_name = "M", value_parser = cli::length, conflicts_with = "kind", help_heading = "How")]
    pub split: Option<f64>,
    /// The first kind is grains of this material [segregation]
    #[arg(long, value_name = "MATERIAL", help_heading = "How")]
    pub kind: Option<String>,
    /// Openings of the sieves [m], the smallest first (default: from the largest piece down by √2) [grading]
    #[arg(long, value_name = "M,M,…", value_parser = sieves, help_heading = "How")]
    pub sieves: Option<Sieves>,
    /// Only this wall, by name or index [wall-force, wear]
    #[arg(long, value_name = "WALL", help_heading = "How")]
    pub wall: Option<String>,
    /// Worn volume per sliding work K [m³/J], of all walls or of those of a material (repeat): adds the depth, and the rate in 1000 h [wear]
    #[arg(long, value_name = "K|NAME=K", value_parser = coefficient, help_heading = "How")]
    pub wear_coefficient: Vec<(Option<String>, f64)>,
    /// Thickness of the walls [m], or with a unit: adds the hours until it is worn through [wear]
    #[arg(long, value_name = "M", value_parser = cli::length, help_heading = "How")]
    pub thickness: Option<f64>,
    /// Forces on walls instead of forces between grains [forces]
    #[arg(long, help_heading = "How")]
    pub on_walls: bool,
    /// Forces at the instants of frames, as curves over the way of a wall need, instead of means over the steps between frames [wall-force]
    #[arg(long, help_heading = "How")]
    pub instants: bool,

    /// Also draw a plot
    #[arg(long, value_name = "FILE.svg|png")]
    pub plot: Option<OutPath>,
    /// JSON instead of CSV
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub output: Output,
}

impl Args {
    /// Refuses options of other measures than the one that is asked for.
    pub fn check(&self) -> anyhow::Result<()> {
        let Entry { name, options, frames, .. } = *self.measure.entry;
        if let Some(option) = self.measure.options.iter().find(|option| !options.contains(*option)) {
            let of = ALL.iter().filter(|entry| entry.options.contains(option));
            let of: Vec<String> = of.map(|entry| format!("--{}", entry.name)).collect();
            let of = of.join(" and ");
            return Err(usage(format!("--{option}: is an option of {of}: leave it out with --{name}")));
        }
        if frames == Frames::One && (self.all || self.from.is_some()) {
            let option = if self.all { "--all" } else { "--from" };
            return Err(usage(format!(
                "{option}: --{name} lists the pieces of one frame: choose it with --time or --until"
            )));
        }
        if !frames.has_single() && (self.time.is_some() || self.last) {
            let option = if self.last { "--last" } else { "--time" };
            return Err(usage(format!(
                "{option}: --{name} is measured over time: choose frames with --from and --until"
            )));
        }
        Ok(())
    }
}

pub fn shape(text: &str) -> Result<GivenShape, String> {
    // Everything is above a plane that is far enough below.
    let wanted = if text == "all" { "halfspace:0,0,-1e100,0,0,1" } else { text };
    let shape = mesh::shape(wanted).map_err(|e| e.to_string())?;
    Ok(GivenShape { text: text.to_owned(), shape })
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let list: Vec<f64> = text.split(',').map(|part| part.trim().parse().ok()).collect::<Option<_>>()?;
    <[f64; N]>::try_from(list).ok().filter(|all| all.iter().all(|v| v.is_finite()))
}

fn vector(text: &str) -> Result<Vec3, String> {
    let v = numbers(text).map(|v: [f64; 3]| Vec3::from(v)).filter(|v| v.norm() > 0.0);
    v.ok_or_else(|| "give a direction of three numbers, such as 0,0,1".into())
}

fn pair(text: &str) -> Result<[f64; 2], String> {
    numbers(text).ok_or_else(|| "give two numbers, such as 0.2,0.8".into())
}

pub fn side(text: &str) -> Result<Vec3, String> {
    let names = ["x-", "x+", "y-", "y+", "z-", "z+"];
    let found = names.iter().position(|name| *name == text).ok_or("give one of x- x+ y- y+ z- z+")?;
    Ok(Vec3::ith(found / 2, if found % 2 == 0 { -1.0 } else { 1.0 }))
}

/// `K` or `NAME=K`.
fn coefficient(text: &str) -> Result<(Option<String>, f64), String> {
    let (name, number) = match text.rsplit_once('=') {
        Some((name, number)) => (Some(name.trim()), number),
        None => (None, text),
    };
    let such = "give a volume per work in m³/J, such as 1e-13, or that of a material: steel=1e-13";
    let value = number.trim().parse().ok().filter(|k: &f64| *k > 0.0 && *k < 1.0).ok_or(such)?;
    match name {
        Some("") => Err(such.to_owned()),
        name => Ok((name.map(str::to_owned), value)),
    }
}

fn axis(text: &str) -> Result<usize, String> {
    ["x", "y", "z"].iter().position(|name| *name == text).ok_or_else(|| "give x, y or z".into())
}

fn turn(text: &str) -> Result<Turn, String> {
    let wrong = || "give an axis and an angle in degrees from -360 to 360, such as y,30".to_owned();
    let (name, angle) = text.split_once(',').ok_or_else(wrong)?;
    let degrees: f64 = angle.trim().parse().map_err(|_| wrong())?;
    let turns = degrees != 0.0 && degrees.abs() <= 360.0;
    if turns { Ok(Turn { axis: axis(name.trim())?, degrees }) } else { Err(wrong()) }
}

/// Openings of sieves [m].
#[derive(Debug, Clone)]
pub struct Sieves(pub Vec<f64>);

fn sieves(text: &str) -> Result<Sieves, String> {
    let list: Option<Vec<f64>> = text.split(',').map(|p| p.trim().parse().ok()).collect();
    let rises = |all: &Vec<f64>| {
        all[0] > 0.0 && all.windows(2).all(|w| w[0] < w[1]) && all[all.len() - 1].is_finite()
    };
    list.filter(rises)
        .map(Sieves)
        .ok_or_else(|| "give openings in metres, the smallest first, such as 0.004,0.008,0.016".into())
}

fn bins(text: &str) -> Result<Bins, String> {
    let list: Option<Vec<usize>> = text.split(',').map(|p| p.trim().parse().ok()).collect();
    match list.as_deref() {
        Some([n]) if *n > 0 => Ok(Bins::One(*n)),
        Some([x, y, z]) if *x > 0 && *y > 0 && *z > 0 => Ok(Bins::All([*x, *y, *z])),
        _ => Err("give a number of bins, or three for x, y and z, such as 20 or 10,1,20".into()),
    }
}
