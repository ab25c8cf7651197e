//! The HTML page.

use crate::{args::Args, counts, diagrams::Diagrams, inputs};
use anyhow::Context;
use cli::{Output, Report};
use record::Ending;
use std::collections::BTreeMap;
use view::{Page, PageContent, PageOptions};

/// Writes the page of everything given.
pub fn html(args: &Args, output: &Output) -> anyhow::Result<Report> {
    let names: Vec<String> = args.inputs.iter().map(inputs::short_name).collect();
    if args.pick && names.len() != 1 {
        return Err(cli::usage(format!(
            "--pick: {} inputs: give the one cloud that cloud-crop will read",
            names.len()
        )));
    }
    let mut page = Page::new(PageOptions {
        title: args.title.clone().unwrap_or_else(|| names.join(" + ")),
        colour: args.colour.clone(),
        map: args.map(),
        range: args.range,
        camera: args.camera(),
        time: args.time,
        most_bytes: (args.max_mb() * 1e6) as usize,
        components: args.components,
        dark: args.dark,
        hidden: args.hidden(),
        walls: args.walls(),
        pick: if args.pick { names.first().cloned() } else { None },
    });
    let (mut measured, mut endings) = (Diagrams::default(), BTreeMap::<String, Ending>::new());
    let seen = inputs::read_watched(args, &mut page, &mut |run, event| {
        measured.take(run, event);
        endings.entry(run.to_owned()).or_default().take(event);
    })?;
    for (run, words) in endings.iter().filter_map(|(run, ending)| Some((run, ending.words()?))) {
        page.note(if names.len() > 1 { format!("{run}: {words}") } else { words });
    }
    measured.warn();
    page.diagrams(measured.finish());
    page.check()?;
    let mut out = output.open_text()?;
    let bytes = page.write_checked(&mut out).with_context(|| output.name())?;
    out.commit()?;
    let kept = page.kept();
    warn_of_what_is_left_out(args, &kept);
    let frames = match kept.given {
        0 => String::new(),
        given => format!(", {} of {given} frames", kept.kept),
    };
    let packing = match kept.position_error {
        0.0 => String::new(),
        error => format!(", positions to {}", length(error)),
    };
    let errors: serde_json::Map<String, serde_json::Value> =
        kept.field_errors.iter().map(|(name, error)| (name.clone(), (*error).into())).collect();
    let grains = page.grains();
    let size = format!("{:.1} MB{frames}{packing}", bytes as f64 / 1e6);
    Ok(Report::new(format!("{}: {size}{}", output.name(), counts::words(grains)))
        .with_all(&counts::fields(grains))
        .with("bytes", bytes)
        .with("frames_given", kept.given)
        .with("frames_kept", kept.kept)
        .with("one_frame_of", kept.stride)
        .with("one_point_of", kept.one_point_of)
        .with("vectors", if kept.lengths_only { "lengths" } else { "components" })
        .with("position_error_m", kept.position_error)
        .with("radius_error_m", kept.radius_error)
        .with("field_errors", errors)
        .with("layers", seen))
}

fn warn_of_what_is_left_out(args: &Args, kept: &PageContent) {
    let limit = format!("to keep it below {} MB; --max-mb changes that", args.max_mb());
    if kept.stride > 1 {
        let (of, given, stride) = (kept.kept, kept.given, kept.stride);
        cli::warn(&format!(
            "{of} of {given} frames are in the page (one of {stride}, and the last), {limit}"
        ));
    }
    if kept.lengths_only {
        cli::warn(&format!("components of vectors are not in the page, only their lengths, {limit}"));
    }
    if kept.one_point_of > 1 {
        let one_of = kept.one_point_of;
        cli::warn(&format!(
            "one point of {one_of} is in the page, {limit}; its options hold for the whole cloud"
        ));
    }
}

/// A small length [m], to read.
fn length(metres: f64) -> String {
    let units = [("m", 1.0), ("mm", 1e3), ("µm", 1e6), ("nm", 1e9)];
    let (unit, factor) = units.into_iter().find(|(_, f)| metres * f >= 1.0).unwrap_or(units[3]);
    format!("{:.2} {unit}", metres * factor)
}
