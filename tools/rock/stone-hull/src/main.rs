//! Carves the visual hull of a stone from the masks of its photographs.

mod args;
mod held_out;
mod on_turntable;
mod poses;
mod refined;
mod tags;
mod views;
mod words;

use anyhow::Context;
use args::Args;
use cli::Report;
use std::process::ExitCode;
use stones::{ShapeMeasures, Stone};
use stream::ply::Encoding;

fn main() -> ExitCode {
    cli::run("stone-hull", stone_hull)
}

fn stone_hull(args: Args) -> anyhow::Result<Report> {
    let names = views::names(&args.photographs)?;
    let found = views::read(&args, &names)?;
    let tags = args.tag_size.map(|size| tags::measured(&args, &found, size)).transpose()?;
    let (mut mesh, samples) = photos::hull(&found.views, args.cells).context("the silhouettes")?;
    let carved = mesh.clone();
    let refinement = if args.refine {
        let (finer, refinement) = refined::refined(&args, &found, &mesh)?;
        mesh = finer;
        Some(refinement)
    } else {
        None
    };
    let held_out = held_out::compared(&found, &mesh);
    let closed = Stone::new(&mesh, true).context("the hull")?;
    let length = ShapeMeasures::of(&closed).sides[0];
    let factor = tags.map_or(args.length.map_or(1.0, |wanted| wanted / length), |tags| tags.factor);
    let agreement = words::check(&found, &carved, args.cells, factor);
    mesh.scale(factor);
    let mut out = args.output.open()?;
    let says = [words::comment(args.refine)];
    mesh::write_ply(&mut out, &mesh, &says, Encoding::BinaryLittleEndian)?;
    out.commit()?;
    words::scale(&args, length);
    let mut summary = words::summary(&mesh, &agreement, &found, refinement.as_ref());
    summary += &held_out::words(&held_out);
    summary += &tags.as_ref().map_or(String::new(), tags::words);
    summary += found.adjusted.as_ref().map_or("", |a| &a.words);
    Ok(Report::new(summary)
        .with("photographs", &found.names)
        .with("upper_bound", !args.refine)
        .with("refinement", refinement)
        .with("volume", mesh.volume())
        .with("length", length * factor)
        .with("tags", tags)
        .with("faces", mesh.faces.len())
        .with("cells", args.cells)
        .with("step", samples.step * factor)
        .with("turned_over", found.aligned)
        .with("agreement", agreement.iter().map(|a| a.union).collect::<Vec<_>>())
        .with("held_out", held_out)
        .with("adjusted", found.adjusted.map(|a| a.table)))
}
