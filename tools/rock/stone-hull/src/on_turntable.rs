//! Views of a stone on a turntable; it is laid back where it was turned over.

use crate::args::Args;
use crate::views::{Adjusted, Found, Parted, silhouettes};
use crate::words;
use anyhow::Context;
use photos::adjusted::{Turned, adjust};
use photos::{Alignment, HullError, Turntable, View, align};
use std::path::Path;

/// Hulls of two places that overlap by less than this are doubtful.
const OVERLAP: f64 = 0.85;

/// Photographs of one side of the stone.
type Side = Parted<Turned>;
/// The same, by name, before some are held out.
type Named = Vec<(String, Turned)>;

pub fn read(args: &Args, names: &[String], file: &Path) -> anyhow::Result<Found> {
    let (table, [first, second]) = sides(args, names, file)?;
    if first.is_empty() {
        anyhow::bail!(
            "{}: every [[ring]] is turned_over: leave it out where the stone lay as at first",
            file.display()
        );
    }
    let first = Parted::new(args, first)?;
    let second = if second.is_empty() { None } else { Some(Parted::new(args, second)?) };
    let adjusted = args.adjust.then(|| adjusted(&table, &first, second.as_ref())).transpose()?;
    let last = adjusted.as_ref().map_or(&table, |a| &a.table);
    let views = |side: Side| side.map(|turned| turned.on(&table, last).view(last));
    let first = views(first);
    let (mut names, mut carve): (Vec<String>, Vec<View>) = first.carve.into_iter().unzip();
    let (mut held_out, turned_from) = (first.held_out, carve.len());
    let Some(second) = second.map(views) else {
        cli::warn(
            "the stone lay on one side only, which no photograph sees, and that costs some 2 % of its volume: turn it over and photograph it again (turned_over = true)",
        );
        return Ok(Found { names, views: carve, turned_from, held_out, aligned: None, adjusted });
    };
    let (second_names, second_carve): (Vec<String>, Vec<View>) = second.carve.into_iter().unzip();
    let found = align(&carve, &second_carve).context("the stone turned over")?;
    doubt(&found);
    carve.extend(found.place.views(&second_carve));
    names.extend(second_names);
    let (held_names, held_views): (Vec<String>, Vec<View>) = second.held_out.into_iter().unzip();
    held_out.extend(held_names.into_iter().zip(found.place.views(&held_views)));
    let aligned = Some([found.overlap, found.residual]);
    Ok(Found { names, views: carve, turned_from, held_out, aligned, adjusted })
}

/// The turntable, and the photographs of both sides of the stone that have a mask.
fn sides(args: &Args, names: &[String], file: &Path) -> anyhow::Result<(Turntable, [Named; 2])> {
    let text = stream::whole::text(file).with_context(|| format!("{}: cannot read it", file.display()))?;
    let table = Turntable::parse(&text).with_context(|| file.display().to_string())?;
    let places = table.places(names).with_context(|| file.display().to_string())?;
    let used: Vec<String> = places.iter().map(|p| names[p.photograph].clone()).collect();
    if used.len() < names.len() {
        let other = names.iter().find(|n| !used.contains(n)).map_or("", String::as_str);
        cli::warn(&format!("{} photographs are in no [[ring]], such as {other}", names.len() - used.len()));
    }
    for ring in 0..table.ring.len() {
        let of_ring: Vec<&str> =
            places.iter().zip(&used).filter(|(p, _)| p.ring == ring).map(|(_, name)| name.as_str()).collect();
        if let Some([before, after]) = gap(&of_ring) {
            cli::warn(&format!(
                "the numbers of the photographs jump from {before} to {after}: is one missing? each counts as one step of the table"
            ));
        }
    }
    let mut sides = [Vec::new(), Vec::new()];
    for ((place, name), silhouette) in places.iter().zip(&used).zip(silhouettes(args, &used)?) {
        let Some((field, size)) = silhouette else { continue };
        let side = usize::from(table.ring[place.ring].turned_over);
        sides[side].push((name.clone(), Turned { place: *place, field: field.into(), size }));
    }
    Ok((table, sides))
}

/// The first two photographs of a ring whose numbers are farther apart than those of the others.
fn gap<'a>(names: &[&'a str]) -> Option<[&'a str; 2]> {
    let number = |name: &str| {
        let stem = Path::new(name).file_stem()?.to_str()?;
        let digits = stem.len() - stem.bytes().rev().take_while(u8::is_ascii_digit).count();
        stem[digits..].parse::<u64>().ok()
    };
    let numbers: Vec<u64> = names.iter().map(|name| number(name)).collect::<Option<_>>()?;
    let steps: Vec<u64> = numbers.windows(2).map(|w| w[1].saturating_sub(w[0])).collect();
    let least = *steps.iter().min()?;
    let jump = steps.iter().position(|step| *step > least)?;
    Some([names[jump], names[jump + 1]])
}

/// The turntable by --adjust: with the camera from the first side, and the angles from each.
fn adjusted(table: &Turntable, first: &Side, second: Option<&Side>) -> anyhow::Result<Adjusted> {
    let of = |from: Adjusted, side: &Side, camera: bool| -> Result<Adjusted, HullError> {
        let carve: Vec<Turned> = side.carve.iter().map(|(_, turned)| turned.on(table, &from.table)).collect();
        let (table, done) = adjust(&from.table, &carve, camera)?;
        let words = from.words + &words::adjusted(&from.table, &table, &done);
        Ok(Adjusted { table, words })
    };
    let start = Adjusted { table: table.clone(), words: String::new() };
    let next = of(start, first, true).context("--adjust")?;
    match second {
        None => Ok(next),
        Some(second) => of(next, second, false).context("--adjust: the stone turned over"),
    }
}

/// Warns of two places that do not fit.
fn doubt(found: &Alignment) {
    if found.overlap < OVERLAP {
        cli::warn(&format!(
            "the hulls of both places of the stone overlap by {} % only: check turned_over, and that it is the same stone",
            words::percent(found.overlap)
        ));
    }
    if found.other < 1.5 * found.residual {
        cli::warn(
            "the stone fits in two orientations almost equally well: check the result, or photograph it on a third side",
        );
    }
}
