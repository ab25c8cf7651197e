//! Where walls are loaded and worn: force and sliding work by wall sphere and triangle, or by cell of space.
//!
//! Sliding work W = Σ |F_t · slip| is what Archard's law turns into a worn depth (`life`). A run that adds up over every step what grains
//! do to spheres and triangles says to which they do it (`parts`); of a run
//! that has contacts alone, a contact belongs to the wall sphere whose surface is nearest to its point, wherever the
//! sphere is at that time, or to the cube of space it lies in, at t = 0 if its wall moves. A part is listed where the file of its wall has it, so that the
//! map of a wall that moves, or was put elsewhere, is one of its body; the area of a cube is taken as the square of its side,
//! which is that of a flat wall along a face of it.

mod life;
mod map;
mod of_contacts;
mod parts;

use self::life::WearLife;
use self::of_contacts::ContactLoads;
use self::parts::{SphereParts, WornPart};
use crate::definition::{ArgumentKind, AskError, Asked, Frames, Measure};
use crate::observer::{NO_CONTACTS, Observer};
use crate::run::SLACK;
use crate::sheet::{Chart, Geometry, Head, Row, Summary};
use crate::walls::filter::WallContactFilter;
use crate::{MeasureError, Run, RunMessage};
use geom::{Shown, Vec3};
use wear::{PartLoads, PartWear, WallWear};

/// A run without contacts and without sums of parts.
const NO_WEAR: MeasureError = MeasureError::Channel {
    topic: record::topic::WALL_WEAR,
    what: "wear of walls",
    cure: "set [output] wear = true, or contacts = true and give --cell M",
};

/// A run of contacts whose walls have no spheres.
const NO_SPHERES: MeasureError = MeasureError::Channel {
    topic: record::topic::WALLS,
    what: "wall spheres",
    cure: "set [output] wear = true for triangles, or give --cell M for a map by cells of space",
};

/// Measures wear by position.
pub struct Wear {
    what: WallContactFilter,
    /// Side of the cubes [m]; `None`: by wall sphere.
    cell: Option<f64>,
    life: Option<WearLife>,
    /// Time from which on sums count [s].
    from: f64,
    contacts: ContactLoads,
    /// Sums over every step; `None` while the run has shown none.
    sums: Option<PartLoads>,
    /// Begin of the first interval that counts, and end of the last [s].
    span: Option<(f64, f64)>,
    /// Messages of sums of parts that count.
    frames: u64,
    spheres: Option<SphereParts>,
    /// What was listed last, with its rows.
    listed: (Vec<WornPart>, Vec<Row>),
}

impl Wear {
    /// Of these contacts; by cubes of side `cell` [m], or by wall sphere.
    ///
    /// # Errors
    /// A cell not above zero.
    pub fn new(what: WallContactFilter, cell: Option<f64>) -> Result<Wear, MeasureError> {
        if let Some(value) = cell.filter(|c| !(*c > 0.0 && c.is_finite())) {
            return Err(MeasureError::Setting {
                what: "cell",
                value,
                unit: "m",
                cure: "give a length above 0",
            });
        }
        let (contacts, listed) = (ContactLoads::default(), Default::default());
        let (life, from) = (None, f64::NEG_INFINITY);
        Ok(Wear {
            what,
            cell,
            life,
            from,
            contacts,
            sums: None,
            span: None,
            frames: 0,
            spheres: None,
            listed,
        })
    }

    /// Takes the sums of an interval; those of one that begins before what is looked at are left out.
    fn add_sums(&mut self, run: &Run, wear: &WallWear) -> Result<(), MeasureError> {
        let wall = self.what.index(run)?;
        let sums = self.sums.get_or_insert_default();
        let before = self.span.map_or(wear.time, |(_, until)| until);
        let begin = if wear.interval > 0.0 { wear.time - wear.interval } else { before };
        if begin < self.from - 0.5 * run.step - SLACK {
            return Ok(());
        }
        sums.add(wear, |row: &PartWear| self.what.takes(run, wall, row.part.0, &row.position));
        self.span = Some((self.span.map_or(begin, |(first, _)| first), wear.time));
        self.frames += 1;
        Ok(())
    }

    /// Rows of spheres and triangles with sums over every step.
    fn end_of_sums(
        &mut self,
        run: &Run,
        sums: &PartLoads,
        rows: &mut Vec<Row>,
    ) -> Result<Summary, MeasureError> {
        let wall = self.what.index(run)?;
        let wanted = |own: u64| wall.is_none_or(|wall| wall == own);
        let (from, until) = self.span.unwrap_or_default();
        if sums.length() <= 0.0 && self.from.is_finite() {
            let wanted = format!("that begins its interval at {} s or later", Shown(self.from));
            return Err(MeasureError::NoFrame { wanted, first: 0.0, last: until });
        }
        let spheres = self.spheres.take().unwrap_or_else(|| SphereParts::of(run));
        let parts = parts::of_sums(run, &spheres, sums, wanted);
        let life = self.life.as_ref();
        rows.extend(parts.iter().map(|part| part.row(run, life, sums.length())));
        let over = format!("sums over every step (/wall_wear) from {} to {} s", Shown(from), Shown(until));
        let summary = self.totals(run, rows, &parts, sums.length());
        self.listed = (parts, rows.clone());
        let summary = summary.with("frames", "1", self.frames as f64).note(over);
        Ok(self.planes(run, wanted).into_iter().fold(summary, Summary::note))
    }

    /// Why walls that are planes have no rows.
    fn planes(&self, run: &Run, wanted: impl Fn(u64) -> bool) -> Option<String> {
        let is_plane = |k: &usize| wanted(*k as u64) && run.is_plane(*k);
        let planes: Vec<&str> =
            (0..run.walls.len()).filter(is_plane).map(|k| run.walls[k].as_str()).collect();
        let first = planes.first()?;
        let (are, no_row) =
            if planes.len() == 1 { ("is a plane", "it has") } else { ("are planes", "they have") };
        Some(format!(
            "{} {are}, without parts: {no_row} no row. --wall-force all --wall {first} tells the sums of one, --cell M its map ([output] contacts = true)",
            planes.join(", ")
        ))
    }

    /// What all rows have together, and how deep they are worn after a time of this length [s].
    fn totals(&self, run: &Run, rows: &[Row], parts: &[WornPart], length: f64) -> Summary {
        let column = |k: usize| rows.iter().map(move |row| row[k]).filter(|value| value.is_finite());
        let known = |sum: f64| if rows.is_empty() { f64::NAN } else { sum };
        let summary = Summary::default().with("places", "1", rows.len() as f64).with(
            "sliding_work",
            "J",
            known(column(7).sum()),
        );
        let summary = match &self.life {
            Some(life) => self.lasting(run, summary, rows, parts).note(life.words(length)),
            None => summary,
        };
        summary.with("largest_work", "J", known(column(7).fold(0.0, f64::max)))
    }

    /// Adds the largest depth and rate, and the shortest life, and says where they are.
    fn lasting(&self, run: &Run, summary: Summary, rows: &[Row], parts: &[WornPart]) -> Summary {
        let depth = |row: &Row| row[12];
        let deepest = (0..rows.len())
            .filter(|k| depth(&rows[*k]).is_finite())
            .max_by(|a, b| depth(&rows[*a]).total_cmp(&depth(&rows[*b])));
        let of = |column: usize| deepest.map_or(f64::NAN, |k| rows[k][column]);
        let summary = summary.with("largest_depth", "mm", of(12)).with("largest_rate", "mm/1000 h", of(13));
        let lasts = deepest.and_then(|k| rows[k].get(14).copied());
        let summary = lasts.into_iter().fold(summary, |sum, life| sum.with("shortest_life", "h", life));
        let without = rows.iter().filter(|row| !depth(row).is_finite()).count();
        let summary = if without > 0 {
            let parts = geom::counted(without, "row");
            summary
                .note(format!("{parts} without a depth: no --wear-coefficient for the material of the wall"))
        } else {
            summary
        };
        let Some(k) = deepest.filter(|k| depth(&rows[*k]) > 0.0) else { return summary };
        let part = parts.get(k).map_or_else(String::new, |part| {
            let wall = run.walls.get(part.wall()).map_or("", String::as_str);
            format!(", part {} of '{wall}'", part.part_number())
        });
        let [x, y, z] = [0, 1, 2].map(|axis| Shown(rows[k][axis]));
        summary.note(format!("deepest at {x}, {y}, {z} m{part}"))
    }
}

impl Observer for Wear {
    fn heads(&self) -> Vec<Head> {
        let size = if self.cell.is_some() { "side" } else { "radius" };
        let mut heads = Head::list(&[
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            (size, "m"),
            ("contacts", "1"),
            ("mean_normal", "N"),
            ("largest_normal", "N"),
            ("sliding_work", "J"),
            ("work_per_area", "J/m²"),
            ("pressure", "Pa"),
            ("impacts", "1"),
            ("impact_energy", "J"),
        ]);
        heads.extend(self.life.iter().flat_map(WearLife::heads));
        heads
    }

    fn observe(&mut self, run: &Run, message: RunMessage, _: &mut Vec<Row>) -> Result<(), MeasureError> {
        // A wall that a servo moves is taken where it is in the first frame that is measured.
        if self.cell.is_none() && self.spheres.is_none() && !run.spheres.position.is_empty() {
            self.spheres = Some(SphereParts::of(run));
        }
        match message {
            RunMessage::WallWear(wear) if self.cell.is_none() => self.add_sums(run, &wear),
            // Of one frame, contacts come first; where sums follow them they are not needed.
            RunMessage::Contacts(contacts) if self.sums.is_none() => {
                self.contacts.add(run, &self.what, self.cell, self.from, &contacts)
            }
            _ => Ok(()),
        }
    }

    fn end(&mut self, run: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        self.life.as_ref().map_or(Ok(()), |life| life.check(run))?;
        if let Some(sums) = self.sums.take() {
            return self.end_of_sums(run, &sums, rows);
        }
        match (self.contacts.seen, self.contacts.frames) {
            (0, _) if self.cell.is_some() => return Err(NO_CONTACTS),
            (0, _) => return Err(NO_WEAR),
            (_, 0) => return Err(NO_SPHERES),
            _ => {}
        }
        let (length, life) = (self.contacts.length(), self.life.as_ref());
        let mut parts = Vec::new();
        match self.cell {
            Some(side) => {
                let (area, one) = (side * side, life.and_then(|life| life.of(run, None)));
                for (key, borne) in self.contacts.cells() {
                    let centre = Vec3::from(key.map(|k| (k as f64 + 0.5) * side));
                    let worn = life.map(|life| life.worn(one, borne.work / area, length));
                    let worn = &worn.unwrap_or_default()[..life.map_or(0, WearLife::columns)];
                    let first = [centre.x, centre.y, centre.z, side];
                    rows.push([&first[..], &borne.columns(area), worn].concat());
                }
            }
            None => {
                let spheres = self.spheres.take().unwrap_or_else(|| SphereParts::of(run));
                parts = (0..spheres.wall.len())
                    .map(|row| spheres.part(row, self.contacts.of_sphere(row)))
                    .collect();
                rows.extend(parts.iter().map(|part| part.row(run, life, length)));
            }
        }
        let summary = self.totals(run, rows, &parts, length);
        self.listed = (parts, rows.clone());
        Ok(summary.with("frames", "1", self.contacts.frames as f64).with(
            "contacts_elsewhere",
            "1",
            self.contacts.elsewhere as f64,
        ))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        map::chart(self.cell, rows)
    }

    fn geometry(&self) -> Result<Geometry, &'static str> {
        let (parts, rows) = &self.listed;
        match (self.cell, parts.is_empty()) {
            (Some(_), _) => Err(
                "cells of space have no geometry: leave --cell out (walls need [output] wear = true), or name the output .csv",
            ),
            (None, true) => {
                Err("no wall has spheres or triangles: give a mesh or wall spheres, or --cell M and a .csv")
            }
            (None, false) => Ok(parts::geometry(parts, rows, &self.heads())),
        }
    }
}

impl Measure for Wear {
    const NAME: &'static str = "wear";
    const HELP: &'static str =
        "Map of force and sliding work on walls in SHAPE: by wall sphere and triangle, or by --cell";
    const ARGUMENT: ArgumentKind = ArgumentKind::Shape;
    const FRAMES: Frames = Frames::OverTime;
    const OPTIONS: &'static [&'static str] = &["cell", "wall", "wear-coefficient", "thickness"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        let wear = Wear::new(WallContactFilter::asked_for(asked)?, asked.cell)?;
        Ok(Box::new(Wear { life: WearLife::asked_for(asked)?, from: asked.between.0, ..wear }))
    }
}
