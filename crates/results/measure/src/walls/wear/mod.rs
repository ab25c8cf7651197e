//! Where walls are loaded and worn: force and sliding work by wall sphere and triangle, or by cell of space.
//!
//! Sliding work W = Σ |F_t · slip| is what Archard's law (1953, J. Appl. Phys. 24, DOI 10.1063/1.1721448) turns into a
//! worn volume, k W / (μ H). A run that adds up over every step what grains do to spheres and triangles says to which they do it (`part_load`); of a run
//! that has contacts alone, a contact belongs to the wall sphere whose surface is nearest to its point, wherever the
//! sphere is at that time, or to the cube of space it lies in, at t = 0 if its wall moves. A part is listed where the file of its wall has it, so that the
//! map of a wall that moves, or was put elsewhere, is one of its body; the area of a cube is taken as the square of its side,
//! which is that of a flat wall along a face of it.

mod map;
mod part_load;

use self::part_load::PartLoads;
use crate::definition::{ArgumentKind, AskError, Asked, Frames, Measure};
use crate::geometry::cells::cell_of;
use crate::observer::{NO_CONTACTS, Observer};
use crate::sheet::{Chart, Head, Row, Summary};
use crate::walls::filter::WallContactFilter;
use crate::{Contact, MeasureError, PartWear, Partner, Run, RunMessage};
use geom::{Grid, Vec3};
use std::collections::BTreeMap;

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

/// Where the numbers come from.
const OF_EVERY_STEP: &str = "sums over every step (/wall_wear)";

/// The load on a part of the wall.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct WallLoad {
    /// Σ over frames of the normal force [N].
    normal: f64,
    /// Normal force of this frame so far, and the largest of all frames [N].
    now: f64,
    largest: f64,
    /// Sliding work [J].
    work: f64,
    contacts: u64,
}

/// Wall spheres by position.
struct NearSpheres {
    /// Messages of wall spheres that had been read.
    seen: u64,
    grid: Grid,
    /// Distance from a contact up to which spheres count [m].
    reach: f64,
}

/// Measures wear by position.
pub struct Wear {
    what: WallContactFilter,
    /// Side of the cubes [m]; `None`: by wall sphere.
    cell: Option<f64>,
    by_sphere: BTreeMap<usize, WallLoad>,
    by_cell: BTreeMap<[i64; 3], WallLoad>,
    /// Sums over every step; `None` while the run has shown none.
    parts: Option<PartLoads>,
    near: Option<NearSpheres>,
    /// Wall spheres as their files have them, and their radii there [m].
    home: Vec<(Vec3, f64)>,
    frames: u64,
    /// Messages of sums of parts.
    part_frames: u64,
    contact_frames: u64,
    elsewhere: u64,
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
        Ok(Wear {
            what,
            cell,
            by_sphere: BTreeMap::new(),
            by_cell: BTreeMap::new(),
            parts: None,
            near: None,
            home: Vec::new(),
            frames: 0,
            part_frames: 0,
            contact_frames: 0,
            elsewhere: 0,
        })
    }

    /// The wall sphere whose surface is nearest to a point; `None` when none is near.
    fn sphere(&mut self, run: &Run, point: &Vec3) -> Option<usize> {
        let spheres = &run.spheres;
        if self.near.as_ref().is_none_or(|near| near.seen != run.spheres_seen) {
            let largest = spheres.radius.iter().copied().fold(0.0, f64::max);
            let grid = Grid::new(&spheres.position, (2.0 * largest).max(f64::MIN_POSITIVE));
            self.near = Some(NearSpheres { seen: run.spheres_seen, grid, reach: 1.5 * largest });
        }
        let NearSpheres { grid, reach, .. } = self.near.as_ref()?;
        let gap = |k: &u32| {
            let k = *k as usize;
            (spheres.position[k] - point).norm() - spheres.radius[k]
        };
        let near = grid.within(&spheres.position, *point, *reach);
        near.min_by(|a, b| gap(a).total_cmp(&gap(b))).map(|k| k as usize)
    }

    fn add(&mut self, run: &Run, time: f64, contact: &Contact) -> Result<(), MeasureError> {
        let borne = match self.cell {
            Some(cell) => {
                let point = match contact.partner {
                    Partner::Wall(wall) => run.home(wall, time, &contact.point),
                    Partner::Grain(_) => contact.point,
                };
                let key = cell_of(&point, cell)?;
                self.by_cell.entry(key).or_default()
            }
            None => match self.sphere(run, &contact.point) {
                Some(sphere) => self.by_sphere.entry(sphere).or_default(),
                None => {
                    self.elsewhere += 1;
                    return Ok(());
                }
            },
        };
        let normal = contact.force.dot(&contact.normal).abs();
        borne.normal += normal;
        borne.now += normal;
        borne.work += contact.work;
        borne.contacts += u64::from(contact.acts());
        Ok(())
    }

    fn row(&self, position: Vec3, size: f64, area: f64, b: &WallLoad) -> Row {
        let frames = self.frames as f64;
        let mean = b.normal / frames;
        vec![
            position.x,
            position.y,
            position.z,
            size,
            b.contacts as f64,
            mean,
            b.largest,
            b.work,
            b.work / area,
            mean / area,
            f64::NAN,
            f64::NAN,
        ]
    }
}

impl Observer for Wear {
    fn heads(&self) -> Vec<Head> {
        let size = if self.cell.is_some() { "side" } else { "radius" };
        Head::list(&[
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
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, _: &mut Vec<Row>) -> Result<(), MeasureError> {
        if self.home.is_empty() {
            self.home = run.spheres_of_files();
        }
        let contacts = match message {
            RunMessage::Contacts(contacts) => contacts,
            RunMessage::WallWear(wear) if self.cell.is_none() => {
                let wall = self.what.index(run)?;
                let wanted = |row: &PartWear| self.what.takes(run, wall, row.part.0, &row.position);
                self.parts.get_or_insert_default().add(&wear, wanted);
                self.part_frames += 1;
                return Ok(());
            }
            _ => return Ok(()),
        };
        // Of one frame, contacts come first; where sums follow them they are not needed.
        if self.parts.is_some() {
            return Ok(());
        }
        self.contact_frames += 1;
        if self.cell.is_none() && run.spheres.position.is_empty() {
            return Ok(());
        }
        self.frames += 1;
        let own: Vec<Contact> = self.what.of(run, &contacts)?.copied().collect();
        own.iter().try_for_each(|contact| self.add(run, contacts.time, contact))?;
        for b in self.by_sphere.values_mut().chain(self.by_cell.values_mut()) {
            b.largest = b.largest.max(b.now);
            b.now = 0.0;
        }
        Ok(())
    }

    fn end(&mut self, run: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if let Some(parts) = &self.parts {
            let wall = self.what.index(run)?;
            rows.extend(parts.rows(run, &self.home, |own| wall.is_none_or(|wall| wall == own)));
            return Ok(totals(rows).with("frames", "1", self.part_frames as f64).note(OF_EVERY_STEP));
        }
        match (self.contact_frames, self.frames) {
            (0, _) if self.cell.is_some() => return Err(NO_CONTACTS),
            (0, _) => return Err(NO_WEAR),
            (_, 0) => return Err(NO_SPHERES),
            _ => {}
        }
        let side = self.cell.unwrap_or(f64::NAN);
        let centre = |key: &[i64; 3]| Vec3::from(key.map(|k| (k as f64 + 0.5) * side));
        rows.extend(self.by_cell.iter().map(|(key, b)| self.row(centre(key), side, side * side, b)));
        let spheres = if self.cell.is_none() { &self.home[..] } else { &[] };
        for (k, (position, radius)) in spheres.iter().enumerate() {
            let load = self.by_sphere.get(&k).copied().unwrap_or_default();
            // What a sphere stands for of a wall is not known here.
            rows.push(self.row(*position, *radius, f64::NAN, &load));
        }
        Ok(totals(rows).with("frames", "1", self.frames as f64).with(
            "contacts_elsewhere",
            "1",
            self.elsewhere as f64,
        ))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        map::chart(self.cell, rows)
    }
}

/// What all rows have together.
fn totals(rows: &[Row]) -> Summary {
    let work = || rows.iter().map(|r| r[7]);
    Summary::default().with("places", "1", rows.len() as f64).with("sliding_work", "J", work().sum()).with(
        "largest_work",
        "J",
        work().fold(0.0, f64::max),
    )
}

impl Measure for Wear {
    const NAME: &'static str = "wear";
    const HELP: &'static str =
        "Map of force and sliding work on walls in SHAPE: by wall sphere and triangle, or by --cell";
    const ARGUMENT: ArgumentKind = ArgumentKind::Shape;
    const FRAMES: Frames = Frames::OverTime;
    const OPTIONS: &'static [&'static str] = &["cell", "wall"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(Wear::new(WallContactFilter::asked_for(asked)?, asked.cell)?))
    }
}
