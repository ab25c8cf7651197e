//! Keeps or removes the points of a cloud that lie inside given shapes.

mod words;

use anyhow::Context;
use clap::Parser;
use cli::Report;
use cloud::crop::CropError;
use cloud::crop::Rules;
use cloud::crop::filter::Filter;
use cloud::crop::ground::Ground;
use cloud::crop::outliers::Outliers;
use cloud::crop::rows;
use cloud::crop::scatter::Scattered;
use geom::{Shape, Vec3};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use stream::ply::{Blocks, Opened};

const SHAPES: &str = "SHAPE: box:x0,y0,z0,x1,y1,z1 | sphere:x,y,z,r | cylinder:x0,y0,z0,x1,y1,z1,r | \
    cone:x0,y0,z0,x1,y1,z1,r0,r1 | halfspace:px,py,pz,nx,ny,nz (the side n points to) | prism:FILE.json | mesh:FILE | mesh:FILE,units=mm | mesh:FILE,transform=MATRIX.txt; \
    a ! before a SHAPE means its outside. All lengths in metres.\n\n\
    With --check: exit 0 if there is nothing to remove, 3 if there is a part beyond the outer shape.\n\n\
    Examples:\n\
    \x20 cloud-crop scan.ply --remove halfspace:0,0,-0.1,0,0,-1 -o cropped.ply\n\
    \x20 cloud-crop scan.ply --outliers 12,3 --largest 0.03 | cloud-fill -o filled.ply\n\
    \x20 cloud-crop scan.ply cropped.ply --where 'scan == 0 || z > 0.1' -o both.ply\n\
    \x20 cloud-crop scan.ply --grazing 75 --seen-from 0,0,1.8 --ground 3,0.05 --mark -o marked.ply\n\
    \x20 cloud-crop scan.ply --outer box:-1,-1,-1,1,1,1 --check";

/// Keep or remove points of a cloud by shapes, named regions, outliers and connected parts
#[derive(Parser)]
#[command(after_help = SHAPES)]
struct Args {
    #[command(flatten)]
    input: cloud_cli::Input,
    /// Further clouds in the same coordinate system; the property `scan` then says which cloud a point is of
    #[arg(value_name = "CLOUD")]
    further: Vec<cli::Source>,
    #[command(flatten)]
    output: cloud_cli::CloudOutput,
    /// Keep the points inside SHAPE (repeat: inside any of the shapes)
    #[arg(long, value_name = "SHAPE", value_parser = mesh::shape)]
    keep: Vec<Shape>,
    /// Remove the points inside SHAPE
    #[arg(long, value_name = "SHAPE", value_parser = mesh::shape)]
    remove: Vec<Shape>,
    /// Named regions to keep and to remove (docs/reference/files.md)
    #[arg(long, value_name = "FILE.toml")]
    regions: Option<PathBuf>,
    /// Remove points beyond the outer shape of the equipment and report them as parts (repeat: the shapes together enclose the equipment)
    #[arg(long, value_name = "SHAPE", value_parser = outer_shape)]
    outer: Vec<Shape>,
    /// How far beyond the outer shape a point may be and still belong to the equipment [m]
    #[arg(long, value_name = "M", value_parser = not_negative)]
    tolerance: Option<f64>,
    /// Only check for parts beyond the outer shape: write one CSV line for each part to stdout, and no cloud
    #[arg(long, conflicts_with_all = ["output", "ascii", "distinct", "outliers", "grazing", "seen_from", "ground", "scattered", "largest", "restore", "mark"])]
    check: bool,
    /// Keep the points whose properties fulfil a condition, such as 'classification != 7 && intensity > 20' (==, !=, <, <=, >, >=, &&, ||, !, brackets; x, y, z and every property; other names in single quotes)
    #[arg(long = "where", value_name = "EXPR")]
    condition: Option<Filter>,
    /// Keep points more than M [m] apart, the first ones in the file; with 0, one of the points that lie in one place
    #[arg(long, value_name = "M", value_parser = not_negative)]
    distinct: Option<f64>,
    /// Remove points whose mean distance to K neighbours is more than SIGMA deviations above the mean
    #[arg(long, value_name = "K,SIGMA")]
    outliers: Option<Outliers>,
    /// Remove points whose surface every scanner sees at more than DEG to its normal: mixed pixels and streaks beside edges
    #[arg(long, value_name = "DEG", value_parser = grazing)]
    grazing: Option<f64>,
    /// Where a scanner stood [m], for --grazing, beside the viewpoints that the scan states (repeat)
    #[arg(long, value_name = "x,y,z", value_parser = cloud::points::viewpoint, allow_hyphen_values = true, requires = "grazing")]
    seen_from: Vec<Vec3>,
    /// Remove the ground, which need not be flat: nothing on it is wider than WIDTH [m], and points up to HEIGHT [m] from it are ground
    #[arg(long, value_name = "WIDTH,HEIGHT[,SLOPE]")]
    ground: Option<Ground>,
    /// Remove points on no surface, such as leaves: within RADIUS [m] the mean variation is at least SHARE (0 on a plane, 1/3 at most)
    #[arg(long, value_name = "RADIUS,SHARE")]
    scattered: Option<Scattered>,
    /// Keep only the largest part connected by steps of at most RADIUS [m]
    #[arg(long, value_name = "RADIUS", value_parser = positive)]
    largest: Option<f64>,
    /// Keep points inside SHAPE that the rules behind the outer shape, or marks, remove (repeat)
    #[arg(long, value_name = "SHAPE", value_parser = mesh::shape)]
    restore: Vec<Shape>,
    /// Keep all points with finite coordinates, and write into the property `removed` why each would go: for dem-view --pick
    #[arg(long)]
    mark: bool,
}

fn main() -> ExitCode {
    cli::run("cloud-crop", crop)
}

fn crop(args: Args) -> anyhow::Result<Report> {
    args.output.to.check_ending(&["ply"])?;
    let rules = rules(&args)?;
    if !args.further.is_empty() {
        return cropped(&args, &rules, &merged(&args)?);
    }
    let opened = Opened::new(args.input.open()?).with_context(|| args.input.name())?;
    let opened = match opened {
        Opened::Blocks(blocks) if !args.check && args.is_plain() && rows::can(&blocks, &rules) => {
            return rows(&args, blocks, &rules);
        }
        other => other,
    };
    let cloud = args.input.go_on(opened)?;
    cropped(&args, &rules, &cloud)
}

/// All clouds as one.
fn merged(args: &Args) -> anyhow::Result<cloud::Cloud> {
    cli::Source::one_stdin(std::iter::once(&args.input.cloud).chain(&args.further))?;
    let further =
        args.further.iter().map(|cloud| cloud_cli::Input { cloud: cloud.clone(), ..args.input.clone() });
    let inputs = std::iter::once(args.input.clone()).chain(further);
    let clouds = inputs.map(|input| input.read_among()).collect::<anyhow::Result<Vec<_>>>()?;
    let (clouds, named): (Vec<_>, Vec<bool>) = clouds.into_iter().unzip();
    if !named.contains(&true) {
        args.input.columns.none("it names the columns of text, and no cloud is text")?;
    }
    cloud::merge(clouds).context("cannot merge the clouds")
}

fn cropped(args: &Args, rules: &Rules, cloud: &cloud::Cloud) -> anyhow::Result<Report> {
    let (kept, counts) = match cloud::crop(cloud, rules) {
        Err(e @ (CropError::NoViewpoint | CropError::NothingToRestore | CropError::NothingToMark)) => {
            return Err(cli::usage(format!("{}: {e}", args.input.name())));
        }
        done => done.with_context(|| args.input.name())?,
    };
    words::warn(&counts, rules);
    let report = args.input.placing.report(words::report(&counts, rules, kept.points.len()));
    if args.check {
        return words::checked(&counts, report);
    }
    words::parts(&counts);
    args.output.write_cloud(&kept)?;
    Ok(report)
}

/// The same for a plain PLY, row by row.
fn rows(args: &Args, blocks: Blocks<impl Read>, rules: &Rules) -> anyhow::Result<Report> {
    let (kept, counts) = rows::crop_rows(blocks, rules).with_context(|| args.input.name())?;
    args.input.warn_about(&kept.warnings);
    words::warn(&counts, rules);
    let mut out = args.output.to.open()?;
    kept.write(&mut out).with_context(|| format!("{}: cannot write", args.output.to.name()))?;
    out.commit()?;
    Ok(words::report(&counts, rules, counts.points_out))
}

impl Args {
    /// Whether rows go out as they came in.
    fn is_plain(&self) -> bool {
        let moved = self.input.placing.transform().is_some();
        let named = self.input.columns.given().is_some();
        !self.output.ascii
            && !moved
            && !named
            && self.input.lengths.factor().is_none_or(|factor| factor == 1.0)
    }
}

fn rules(args: &Args) -> anyhow::Result<Rules> {
    let mut rules = Rules {
        keep: args.keep.clone(),
        remove: args.remove.clone(),
        condition: args.condition.clone(),
        distinct: args.distinct,
        outliers: args.outliers,
        grazing: args.grazing,
        seen_from: args.seen_from.clone(),
        ground: args.ground,
        scattered: args.scattered,
        largest: args.largest,
        restore: args.restore.clone(),
        mark: args.mark,
        ..Rules::default()
    };
    if let Some(file) = &args.regions {
        let text = stream::whole::text(file).with_context(|| format!("{}: cannot read", file.display()))?;
        let folder = file.parent().unwrap_or(Path::new(""));
        cloud::crop::add_regions(&mut rules, &text, folder).with_context(|| file.display().to_string())?;
    }
    rules.outer.shapes.extend(args.outer.iter().cloned());
    rules.outer.tolerance = args.tolerance.unwrap_or(rules.outer.tolerance);
    if rules.outer.shapes.is_empty() && (args.check || args.tolerance.is_some()) {
        let option = if args.check { "--check" } else { "--tolerance" };
        return Err(cli::usage(format!(
            "{option}: no outer shape is given: add --outer SHAPE, or --regions FILE.toml with action = \
             \"outer\""
        )));
    }
    Ok(rules)
}

fn outer_shape(text: &str) -> Result<Shape, String> {
    match mesh::shape(text) {
        Ok(shape) if shape.outside => {
            Err("an outer shape encloses the equipment: remove the ! before it".to_owned())
        }
        Ok(shape) => Ok(shape),
        Err(why) => Err(why.to_string()),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    geom::number::not_negative(text).map_err(|_| "give a length in metres, 0 or more".into())
}

fn positive(text: &str) -> Result<f64, String> {
    geom::number::positive(text).map_err(|_| "give a length above 0 in metres".into())
}

fn grazing(text: &str) -> Result<f64, String> {
    let degrees = geom::number::positive(text).ok().filter(|d| *d < 90.0);
    degrees.ok_or_else(|| "give an angle above 0 and below 90 degrees, such as 75".into())
}
