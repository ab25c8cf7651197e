//! The load of wall spheres and of cells of space, from the contacts of frames.

use super::parts::Borne;
use crate::geometry::cells::cell_of;
use crate::walls::filter::WallContactFilter;
use crate::{Contact, Contacts, MeasureError, Partner, Run};
use geom::{Grid, Vec3};
use std::collections::BTreeMap;

/// The load on a sphere or a cell.
#[derive(Debug, Clone, Copy, Default)]
struct ContactLoad {
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

/// The loads of all contacts.
#[derive(Default)]
pub(super) struct ContactLoads {
    by_sphere: BTreeMap<usize, ContactLoad>,
    by_cell: BTreeMap<[i64; 3], ContactLoad>,
    near: Option<NearSpheres>,
    /// Frames with contacts, and those of them that count.
    pub seen: u64,
    pub frames: u64,
    /// Contacts that no sphere is near to.
    pub elsewhere: u64,
    /// Times of the first and the last frame [s].
    span: Option<(f64, f64)>,
}

impl ContactLoads {
    /// Takes in a frame, by cubes of side `cell` [m] or by wall sphere; of the first one after `from` [s], the work was done before.
    pub fn add(
        &mut self,
        run: &Run,
        what: &WallContactFilter,
        cell: Option<f64>,
        from: f64,
        contacts: &Contacts,
    ) -> Result<(), MeasureError> {
        self.seen += 1;
        if cell.is_none() && run.spheres.position.is_empty() {
            return Ok(());
        }
        let works = self.span.is_some() || !from.is_finite();
        self.span = Some((self.span.map_or(contacts.time, |(first, _)| first), contacts.time));
        self.frames += 1;
        for contact in what.of(run, contacts)? {
            let contact = if works { *contact } else { Contact { work: 0.0, ..*contact } };
            self.take(run, cell, contacts.time, &contact)?;
        }
        for load in self.by_sphere.values_mut().chain(self.by_cell.values_mut()) {
            load.largest = load.largest.max(load.now);
            load.now = 0.0;
        }
        Ok(())
    }

    /// Time between the first and the last frame [s].
    pub fn length(&self) -> f64 {
        self.span.map_or(0.0, |(first, last)| last - first)
    }

    pub fn cells(&self) -> impl Iterator<Item = (&[i64; 3], Borne)> {
        self.by_cell.iter().map(|(key, load)| (key, self.borne(load)))
    }

    /// Of a wall sphere, by its row.
    pub fn of_sphere(&self, row: usize) -> Borne {
        self.borne(&self.by_sphere.get(&row).copied().unwrap_or_default())
    }

    fn borne(&self, load: &ContactLoad) -> Borne {
        Borne {
            contacts: load.contacts as f64,
            mean: load.normal / self.frames as f64,
            largest: load.largest,
            work: load.work,
            impacts: f64::NAN,
            impact_energy: [f64::NAN; 2],
        }
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

    fn take(
        &mut self,
        run: &Run,
        cell: Option<f64>,
        time: f64,
        contact: &Contact,
    ) -> Result<(), MeasureError> {
        let load = match cell {
            Some(cell) => {
                let point = match contact.partner {
                    Partner::Wall(wall) => run.home(wall, time, &contact.point),
                    Partner::Grain(_) => contact.point,
                };
                self.by_cell.entry(cell_of(&point, cell)?).or_default()
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
        load.normal += normal;
        load.now += normal;
        load.work += contact.work;
        load.contacts += u64::from(contact.acts());
        Ok(())
    }
}
