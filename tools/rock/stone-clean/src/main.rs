//! Makes a closed, oriented manifold of any mesh or cloud of a stone.

mod input;
mod nine;
mod words;

use anyhow::Context;
use clap::Parser;
use cli::Report;
use std::process::ExitCode;
use stones::{CleanSettings, clean_cloud, clean_mesh};
use stream::ply::Encoding;

const EXAMPLES: &str = "A mesh that is closed stays as it is; anything else gets a new surface. The summary and --report say what changed.\n\nExamples:\n\
    \x20 stone-clean stone.ply --faces 5000 -o clean.ply\n\
    \x20 stone-clean stone.stl --units mm --cells 100 -o small.ply";

/// Close, orient and thin out the mesh of a stone, or make a mesh of its cloud
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Mesh (PLY, STL, OBJ) or cloud (PLY, LAS, LAZ, E57, PCD, XYZ, PTS), detected by content; - for stdin
    #[arg(value_name = "MESH|CLOUD", default_value = "-", hide_default_value = true)]
    input: cli::Source,
    #[command(flatten)]
    lengths: cli::Lengths,
    #[command(flatten)]
    columns: cloud_cli::Columns,
    #[command(flatten)]
    placing: cli::Placing,
    /// Faces of the result, at most [default: as many as come]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(4..=2_000_000))]
    faces: Option<u32>,
    /// Rebuild the surface with this number of cells along the longest side [default: only if needed, with 200, or 60 and more where the mesh is coarse; for a cloud by its spacing]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=500))]
    cells: Option<u32>,
    #[command(flatten)]
    output: cli::Output,
}

fn main() -> ExitCode {
    cli::run("stone-clean", stone_clean)
}

fn stone_clean(args: Args) -> anyhow::Result<Report> {
    if args.output.path().is_some() && !args.output.has_extension("ply") {
        return Err(cli::usage(format!("-o {}: use a name that ends in .ply", args.output.name())));
    }
    let settings =
        CleanSettings { faces: args.faces.map(|f| f as usize), cells: args.cells.map(|c| c as usize) };
    let read = input::read(&args.input.read_all()?, &args).with_context(|| args.input.to_string())?;
    let points = match &read {
        input::Read::Mesh(mesh) => &mesh.vertices,
        input::Read::Cloud { points, .. } => points,
    };
    let (lo, hi) = geom::grid::bounds(points);
    if args.lengths.factor().is_none() && !args.placing.scales() && (hi - lo).max() > stones::LONGEST {
        return Err(stones::StoneError::Long((hi - lo).max())).with_context(|| args.input.to_string());
    }
    let cleaned = match &read {
        input::Read::Mesh(mesh) => clean_mesh(mesh, &settings),
        input::Read::Cloud { points, normals } => clean_cloud(points, normals.as_deref(), &settings),
    };
    let (stone, changes) = cleaned.with_context(|| args.input.to_string())?;
    let mut out = args.output.open()?;
    mesh::write_ply(&mut out, &stone.mesh, &[], Encoding::BinaryLittleEndian)?;
    out.commit()?;
    words::warn(&args.input, &changes, &settings);
    let report = Report::new(words::summary(&changes)).with("settings", settings).with_all(&changes);
    Ok(args.placing.report(report))
}
