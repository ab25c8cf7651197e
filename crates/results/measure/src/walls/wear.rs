//! Where walls are loaded and worn: force and sliding work by wall sphere, or by cell of space.
//!
//! Sliding work W = Σ |F_t · slip| is what Archard's law (1953, J. Appl. Phys. 24, DOI 10.1063/1.1721448) turns into a
//! worn volume, k W / (μ H). A contact belongs to the wall sphere whose surface is nearest to its point, wherever the
//! sphere is at that time, or to the cube of space it lies in. A sphere is listed where the file of its wall has it, so that the map of a wall that moves,
//! or was put elsewhere, is one of its body; the area of a cube is taken as the square of its side,
//! which is that of a flat wall along a face of it.

use crate::definition::{ArgumentKind, AskError, Asked, Frames, Measure};
use crate::geometry::cells::cell_of;
use crate::observer::{NO_CONTACTS, Observer};
use crate::sheet::{Chart, Head, Panel, Row, Summary};
use crate::wall_force::WallContactFilter;
use crate::{Contact, MeasureError, Run, RunMessage};
use geom::{Grid, Vec3};
use std::collections::BTreeMap;

/// Most squares of a map along an axis.
const MOST_SQUARES: f64 = 240.0;

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
    near: Option<NearSpheres>,
    /// Wall spheres as their files have them, and their radii there [m].
    home: Vec<(Vec3, f64)>,
    frames: u64,
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
            near: None,
            home: Vec::new(),
            frames: 0,
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

    fn add(&mut self, run: &Run, contact: &Contact) -> Result<(), MeasureError> {
        let borne = match self.cell {
            Some(cell) => {
                let key = cell_of(&contact.point, cell)?;
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
        ])
    }

    fn observe(&mut self, run: &Run, message: RunMessage, _: &mut Vec<Row>) -> Result<(), MeasureError> {
        if self.home.is_empty() {
            self.home = run.spheres_of_files();
        }
        let RunMessage::Contacts(contacts) = message else { return Ok(()) };
        self.contact_frames += 1;
        if self.cell.is_none() && run.spheres.position.is_empty() {
            let cure = "give --cell M for a map by cells of space";
            return Err(MeasureError::Channel { topic: record::topic::WALLS, what: "wall spheres", cure });
        }
        self.frames += 1;
        let own: Vec<Contact> = self.what.of(run, &contacts)?.copied().collect();
        own.iter().try_for_each(|contact| self.add(run, contact))?;
        for b in self.by_sphere.values_mut().chain(self.by_cell.values_mut()) {
            b.largest = b.largest.max(b.now);
            b.now = 0.0;
        }
        Ok(())
    }

    fn end(&mut self, _: &Run, rows: &mut Vec<Row>) -> Result<Summary, MeasureError> {
        if self.contact_frames == 0 {
            return Err(NO_CONTACTS);
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
        let work: f64 = rows.iter().map(|r| r[7]).sum();
        Ok(Summary::default()
            .with("places", "1", rows.len() as f64)
            .with("sliding_work", "J", work)
            .with("largest_work", "J", rows.iter().map(|r| r[7]).fold(0.0, f64::max))
            .with("frames", "1", self.frames as f64)
            .with("contacts_elsewhere", "1", self.elsewhere as f64))
    }

    /// A map over the two axes along which the wall reaches farthest: sums of cubes of space behind each other, means of
    /// the wall spheres in squares that hold two or so.
    fn chart(&self, rows: &[Row]) -> Chart {
        let of = |k: usize| rows.iter().map(move |r| r[k]);
        let least = |k: usize| of(k).fold(f64::INFINITY, f64::min);
        let reach = |k: usize| of(k).fold(f64::NEG_INFINITY, f64::max) - least(k);
        let mut axes = [0, 1, 2];
        axes.sort_by(|a, b| reach(*b).total_cmp(&reach(*a)));
        let axes = [axes[0].min(axes[1]), axes[0].max(axes[1])];
        let mut chart = Chart::new("Wear of walls");
        let Some(first) = rows.first() else { return chart };
        let margin = 0.5 * self.cell.unwrap_or(2.0 * first[3]);
        let wide = axes.map(|k| reach(k) + 2.0 * margin);
        let fine = wide[0].max(wide[1]) / MOST_SQUARES;
        let step = self.cell.unwrap_or((2.0 * wide[0] * wide[1] / rows.len() as f64).sqrt()).max(fine);
        let low = axes.map(|k| least(k) - margin);
        let count = wide.map(|w| (libm::ceil(w / step - 1e-6) as usize).max(1));
        let range = [low[0], low[1], low[0] + count[0] as f64 * step, low[1] + count[1] as f64 * step];
        let [x, y] = axes.map(|k| format!("{} [m]", ["x", "y", "z"][k]));
        let per = if self.cell.is_some() { "" } else { " of a wall sphere" };
        for (value, column) in [("sliding work", 7), ("mean normal force", 5)] {
            let mut cells = vec![vec![(0.0, 0.0); count[0]]; count[1]];
            for row in rows {
                let [i, j] = [0, 1].map(|k| (((row[axes[k]] - low[k]) / step) as usize).min(count[k] - 1));
                let (sum, rows) = &mut cells[j][i];
                (*sum, *rows) = (*sum + row[column], *rows + 1.0);
            }
            let mean = |(sum, rows): (f64, f64)| match self.cell {
                Some(_) if rows > 0.0 => sum,
                _ => sum / rows,
            };
            let cells = cells.into_iter().map(|row| row.into_iter().map(mean).collect()).collect();
            let value = format!("{value}{per} [{}]", if column == 7 { "J" } else { "N" });
            chart.panels.push(Panel::Map { x: x.clone(), y: y.clone(), value, range, cells });
        }
        chart
    }
}

impl Measure for Wear {
    const NAME: &'static str = "wear";
    const HELP: &'static str =
        "Map of force and sliding work on walls in SHAPE: by wall sphere, or by --cell";
    const ARGUMENT: ArgumentKind = ArgumentKind::Shape;
    const FRAMES: Frames = Frames::OverTime;
    const OPTIONS: &'static [&'static str] = &["cell", "wall"];

    fn observer(asked: &Asked) -> Result<Box<dyn Observer>, AskError> {
        Ok(Box::new(Wear::new(WallContactFilter::asked_for(asked)?, asked.cell)?))
    }
}
