//! Holes: blind spots of the scanner inside the outline of the surface.
//!
//! ```text
//! scale     c = 2 s, s = 1/√density around (`neighbours/spacing`): a disc of c² has four points; wider where the noise is.
//!           With a threshold D [1/m²] for the whole cloud, c = 1/√D
//! 1. the surface ends where the cells of a level (`surface/levels`) around a position leave a gap of 100° and more (`surface/sheet`)
//! 2. ends are linked to loops when they are near and look the same way: across a hole or a narrow strip they do not;
//!    what is linked wider than a hole may be is looked at in overlapping boxes, each of which a hole fits in (`surface/loops`)
//! 3. each loop's surroundings are laid flat: plane, and the quadratic over it (`flat/frame`)
//! 4. there, cells whose window of (2.5 c)² holds at most a quarter of what the density demands are open; open cells that are not
//!    joined to the outside, but by a strait, are a hole (`flat/enclosed`) if the surface around is dense enough for its scale (`flat/surroundings`)
//! ```
//!
//! Step 4 decides, so that the rim of the surface and false ends of step 1 do not count as holes. A hole found at two scales counts once.

use super::flat::surroundings::Surroundings;
use super::flat::thinned::Thinned;
use super::hole::{Hole, Search, Threshold};
use super::report::{FoundHoles, RegionReport, ScaleReport};
use super::surface::levels::{Level, scales};
use super::surface::loops::{ends_of, loops};
use super::surface::sheet::End;
use geom::{Shape, Vec3};
use rayon::prelude::*;

/// The holes of a cloud of finite points.
pub(crate) fn find(points: &[Vec3], search: &Search) -> FoundHoles {
    let mut found = FoundHoles::default();
    let mut ends = vec![Vec::new(); search.regions.len()];
    let mut look = |level: Level| {
        found.scales.push(ScaleReport::of(&level, search));
        for (shape, ends) in search.regions.iter().zip(&mut ends) {
            ends.extend(ends_of(&level, shape).iter().map(|end| level.sheet.positions[end.index as usize]));
        }
        found.holes.extend(of_level(&level, search));
    };
    match search.threshold {
        Threshold::Below(below) => look(Level::whole(points, below.sqrt().recip())),
        Threshold::Local(field) => {
            scales(field).values().for_each(|&cell| look(Level::suited(points, field, cell)));
            found.holes = once(found.holes, Vec::new());
        }
    }
    let of = |(shape, ends): (&Shape, Vec<Vec3>)| RegionReport::of(shape, points, &ends, &found, search);
    found.regions = search.regions.iter().zip(ends).map(of).collect();
    found
}

/// The holes of one scale.
fn of_level(level: &Level, search: &Search) -> Vec<Hole> {
    if !search.regions.is_empty() {
        let inside = search.regions.iter().map(|shape| (ends_of(level, shape), Some(shape)));
        return once(look(level, inside.collect(), search), Vec::new());
    }
    let (narrow, wide) = loops(level, search.widest);
    let whole = |loops: Vec<Vec<End>>| loops.into_iter().map(|ends| (ends, None)).collect();
    let found = look(level, whole(narrow), search);
    // A box of many holes lies far from the surface: each hole found there is examined again in a separate patch.
    let seen = look_over(level, wide, search);
    let seen =
        seen.iter().filter(|hole| !found.iter().any(|known| known.overlaps(hole) || hole.overlaps(known)));
    let near: Vec<Vec<End>> = seen.map(|hole| hole.ends(&level.sheet, &level.ends)).collect();
    let again = look(level, whole(near), search);
    once(found, again)
}

/// The holes among groups of ends in boxes, by a few points of each cell, and without their surroundings.
fn look_over(level: &Level, boxes: Vec<Vec<End>>, search: &Search) -> Vec<Hole> {
    if boxes.is_empty() {
        return Vec::new();
    }
    let thinned = Thinned::new(&level.points, &level.sheet);
    let holes = |ends| {
        Surroundings::new(level, ends, None, search).map(|patch| patch.holes_of(&thinned, level, search))
    };
    let found: Vec<Option<Vec<Hole>>> = boxes.into_par_iter().map(holes).collect();
    found.into_iter().flatten().flatten().collect()
}

/// The holes among groups of ends, each in its shape where there is one.
fn look(level: &Level, groups: Vec<(Vec<End>, Option<&Shape>)>, search: &Search) -> Vec<Hole> {
    let patch = |(ends, shape)| Surroundings::new(level, ends, shape, search);
    let patches: Vec<Surroundings> = groups.into_iter().filter_map(patch).collect();
    let sheet = &level.sheet;
    let near = |p: &Surroundings| sheet.cells.grid.within(&sheet.positions, p.frame.origin, p.radius * 1.5);
    let holes = |patch: &Surroundings| {
        let rows = near(patch).flat_map(|cell| sheet.rows(cell).iter().copied());
        patch.holes(level, rows, search)
    };
    let found: Vec<Vec<Hole>> = patches.par_iter().map(holes).collect();
    found.into_iter().flatten().collect()
}

/// Each hole once: two patches may both see it, the smaller one better; and then those of `others` that are not among them.
fn once(mut holes: Vec<Hole>, mut others: Vec<Hole>) -> Vec<Hole> {
    holes.sort_by(|a, b| a.raster.half.total_cmp(&b.raster.half));
    others.sort_by(|a, b| a.raster.half.total_cmp(&b.raster.half));
    let mut kept: Vec<Hole> = Vec::new();
    for hole in holes.into_iter().chain(others) {
        if !kept.iter().any(|other| other.overlaps(&hole)) {
            kept.push(hole);
        }
    }
    kept
}
