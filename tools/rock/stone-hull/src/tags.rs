//! Tags beside the stone, which give the scale.

use crate::args::Args;
use crate::views::{Found, resized};
use crate::words::percent;
use anyhow::Context;
use apriltag::{Detector, Family, Image};
use photos::tags::{Sighting, TagScale, scale};
use photos::{Photograph, View};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Photographs in memory at a time, at most.
const AT_ONCE: usize = 8;
/// Wrong bits of a tag that are corrected.
const CORRECTED: usize = 1;
/// Pixels of a side that a photograph must have to show a tag.
const SMALLEST: usize = 32;
/// Sides of tags that scatter more are doubtful [–].
const SCATTER: f64 = 0.02;
/// Corners that photographs see farther apart are doubtful, in sides of the tag.
const MISS: f64 = 0.03;
/// More sightings than these are not left out without a word [–].
const LEFT_OUT: f64 = 0.2;
/// A turntable whose lengths are wrong by more is one in other units.
const PLAUSIBLE: f64 = 3.0;

/// The scale at which the tags have their size.
pub fn measured(args: &Args, found: &Found, size: f64) -> anyhow::Result<TagScale> {
    let progress = cli::Progress::new("tags", found.names.len() as u64);
    let all: Vec<(usize, &String)> = found.names.iter().enumerate().collect();
    let mut sightings = Vec::new();
    for some in all.chunks(AT_ONCE) {
        let seen: Vec<anyhow::Result<Vec<Sighting>>> = some
            .par_iter()
            .map(|(k, name)| {
                let place = usize::from(*k >= found.turned_from);
                let seen = on_photograph(args, name, place, &found.views[*k]);
                progress.add(1);
                seen
            })
            .collect();
        for seen in seen {
            sightings.extend(seen?);
        }
    }
    let done = scale(&sightings, size).context("--tag-size")?;
    if done.deviation > SCATTER {
        cli::warn(&format!(
            "--tag-size: sides of the tags differ by {} % (standard deviation): are all of one size and flat, and the poses right?",
            percent(done.deviation)
        ));
    }
    if done.miss > MISS || done.left_out > LEFT_OUT {
        cli::warn(&format!(
            "--tag-size: photographs see the corners of tags {} % of a side apart, and {} % of these sightings were left out: did a tag move, or is one \
             number there twice? otherwise check the poses",
            percent(done.miss),
            percent(done.left_out)
        ));
    }
    if args.turntable.is_some() && !(1.0 / PLAUSIBLE..PLAUSIBLE).contains(&done.factor) {
        cli::warn(&format!(
            "--tag-size: lengths become {} times those that camera.distance gives: are both in metres?",
            geom::Shown(done.factor)
        ));
    }
    Ok(done)
}

/// The tags of a photograph.
fn on_photograph(args: &Args, name: &str, place: usize, view: &View) -> anyhow::Result<Vec<Sighting>> {
    let path = args.photographs.join(name);
    let bytes = stream::whole::file(&path).with_context(|| format!("{}: cannot open it", path.display()))?;
    let photograph = Photograph::read(&bytes).with_context(|| path.display().to_string())?;
    let (width, height) = (photograph.width, photograph.height);
    // The camera is that of the mask, which may be smaller.
    let frame = view.field.frame().map(|side| side as usize);
    let camera = resized(&view.camera, frame, [width, height]).with_context(|| name.to_owned())?;
    if width.min(height) < SMALLEST {
        return Ok(Vec::new());
    }
    let mut image = Image::zeros_with_stride(width, height, width)?;
    // Linear light: an edge of stored values is displaced to its dark side.
    let light = photograph.light.iter().map(|l| (255.0 * l).round() as u8);
    image.as_slice_mut().iter_mut().zip(light).for_each(|(to, light)| *to = light);
    let family = Family::tag_36h11();
    let mut detector = Detector::builder().add_family_bits(family, CORRECTED).build()?;
    let mut seen: BTreeMap<usize, [[f64; 2]; 4]> = BTreeMap::new();
    for tag in detector.detect(&image) {
        // Whole numbers are corners of pixels there, and middles here.
        let corners = tag.corners().map(|corner| corner.map(|x| x - 0.5));
        if seen.insert(tag.id(), corners).is_some() {
            anyhow::bail!(
                "{}: tag {} is there twice: print tags of different numbers",
                path.display(),
                tag.id()
            );
        }
    }
    let sighting = |(id, corners)| Sighting { tag: (place, id as u32), corners, camera };
    Ok(seen.into_iter().map(sighting).collect())
}

/// What the summary says of it.
pub fn words(scale: &TagScale) -> String {
    format!(
        "; {} tags, seen {} times, make it {} times as large (their sides differ by {} %)",
        scale.tags,
        scale.sightings,
        geom::Shown(scale.factor),
        percent(scale.deviation)
    )
}
