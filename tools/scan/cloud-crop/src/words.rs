//! The report of a crop, in words.

use anyhow::Context;
use cli::Report;
use cloud::crop::filter::Filter;
use cloud::crop::outer::OutsidePart;
use cloud::crop::{Cropped, Rules};
use geom::Shown;
use std::io::Write;

/// Parts that are reported one by one.
const TOLD: usize = 8;

/// What looks like a mistake.
pub fn warn(counts: &Cropped, rules: &Rules) {
    if counts.not_finite > 0 {
        let dropped = geom::counted(counts.not_finite, "point");
        cli::warn(&format!("dropped {dropped} without finite coordinates"));
    }
    for region in counts.regions.iter().filter(|region| region.points == 0) {
        cli::warn(&format!(
            "region '{}' contains no point: compare its coordinates with those of the cloud",
            region.name
        ));
    }
    if let Some(crowd) = &counts.crowd {
        let [x, y, z] = crowd.place;
        cli::warn(&format!(
            "{} points lie in one place, ({x}, {y}, {z}) m; rules count each place once. Remove them with --remove \
             sphere:{x},{y},{z},0.001, or leave one of each place with --distinct 0",
            crowd.points
        ));
    }
    counts.idle.iter().for_each(|why| cli::warn(why));
    if !rules.restore.is_empty() && counts.restored == 0 {
        cli::warn(
            "--restore: no point in the shapes was removed by a rule or a mark: compare their coordinates with those of the cloud",
        );
    }
    if counts.points_out == 0 && counts.points_in > 0 {
        let by_shapes = counts.points_in == counts.not_finite + counts.outside_shapes + counts.beyond_outer;
        let cure = if by_shapes {
            "compare the coordinates of the shapes with those of the cloud"
        } else {
            "the rules remove too much"
        };
        cli::warn(&format!("no point is left: {cure}"));
    }
}

/// Everything, of a crop that wrote so many points.
pub fn report(counts: &Cropped, rules: &Rules, written: usize) -> Report {
    Report::new(summary(counts, rules))
        .with_all(counts)
        .with("tolerance", rules.outer.tolerance)
        .with("points_written", written)
        .with("where", rules.condition.as_ref().map(Filter::text))
        .with("distinct_rule", rules.distinct)
        .with("outliers_rule", rules.outliers)
        .with("grazing_angle", rules.grazing)
        .with("ground_rule", rules.ground)
        .with("scattered_rule", rules.scattered)
}

/// One line.
fn summary(counts: &Cropped, rules: &Rules) -> String {
    let verb = if rules.mark { "stay; the others are marked" } else { "kept" };
    let mut kept = format!("{} of {} points {verb}", counts.points_out, counts.points_in);
    let told = [
        (counts.marked_before > 0, counts.marked_before, "marked before"),
        (rules.condition.is_some(), counts.unfulfilled, "by their properties"),
        (rules.distinct.is_some(), counts.repeated, "repeated"),
        (rules.outliers.is_some(), counts.outliers, "outliers"),
        (rules.grazing.is_some(), counts.grazing, "grazing"),
        (rules.ground.is_some(), counts.ground, "ground"),
        (rules.scattered.is_some(), counts.scattered, "scattered"),
        (rules.largest.is_some(), counts.smaller_parts, "in smaller parts"),
        (!rules.restore.is_empty(), counts.restored, "restored"),
    ];
    for (k, (_, count, what)) in told.iter().filter(|(given, _, _)| *given).enumerate() {
        kept += &format!("{} {count} {what}", if k == 0 { ":" } else { "," });
    }
    match &counts.beyond {
        Some(beyond) if counts.beyond_outer > 0 => {
            let (parts, stray) = (beyond.parts.len(), beyond.stray);
            let plural = if parts == 1 { "" } else { "s" };
            format!(
                "{kept}; beyond the outer shape: {} points, {parts} part{plural} and {stray} stray points",
                counts.beyond_outer
            )
        }
        Some(_) => format!("{kept}; nothing is beyond the outer shape"),
        None => kept,
    }
}

/// The parts that were removed, each in a line.
pub fn parts(counts: &Cropped) {
    let Some(beyond) = counts.beyond.as_ref().filter(|_| !cli::quiet()) else { return };
    for (number, part) in (1..).zip(beyond.parts.iter().take(TOLD)) {
        cli::say(&format!("cloud-crop: part {number}: {}", told(part)));
    }
    if beyond.parts.len() > TOLD {
        cli::say(&format!("cloud-crop: and {} smaller parts, see --report", beyond.parts.len() - TOLD));
    }
}

fn told(part: &OutsidePart) -> String {
    let place = |p: [f64; 3]| p.map(|c| Shown(c).to_string()).join(",");
    let (low, high) = (place(part.low), place(part.high));
    format!(
        "{} points up to {} m beyond the outer shape, in box:{low},{high}",
        part.points,
        Shown(part.beyond)
    )
}

/// The answer of `--check`: a table of the parts, and exit code 3 when there is one.
pub fn checked(counts: &Cropped, report: Report) -> anyhow::Result<Report> {
    let parts = counts.beyond.as_ref().map_or(&[][..], |beyond| &beyond.parts);
    let mut table = String::from("part,points,x0,y0,z0,x1,y1,z1,beyond\n");
    for (number, part) in (1..).zip(parts) {
        let corners = part.low.into_iter().chain(part.high).map(|c| c.to_string());
        let corners = corners.collect::<Vec<String>>().join(",");
        table += &format!("{number},{},{corners},{}\n", part.points, part.beyond);
    }
    std::io::stdout().lock().write_all(table.as_bytes()).context("stdout")?;
    match parts {
        [] => Ok(report),
        [first, ..] => {
            let plural =
                if parts.len() == 1 { "1 part is".to_owned() } else { format!("{} parts are", parts.len()) };
            let reason = format!("{plural} beyond the outer shape; the largest: {}", told(first));
            Err(cli::Stopped::error(reason, None, report))
        }
    }
}
