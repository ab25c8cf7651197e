//! Lists made by a device: what it is sent, and in which order its functions ([`gpu::lists`]) run.

use crate::device::DeviceError;
use crate::device::contacts::Contacts;
use crate::device::kinds::Fixed;
use crate::device::sorter::Sorter;
use crate::device::tables::Table;
use crate::device::work::Work;
use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::neighbours::poses::{around, pose_listed, shift_into_box};
use crate::neighbours::rebuild::{margins, wall_margin};
use crate::space::search::tile;
use crate::state::State;
use gpu::tables::Address;
use gpu::tables::lists::DeviceWall;
use laws::simd::Row4;
use laws::space::images::Periods;

/// Everything that lists are made with, and what they are.
#[derive(Default)]
pub struct Lister {
    pub fixed: Fixed,
    pub sorter: Sorter,
    pub contacts: Contacts,
    shifts: Table,
    walls: Table,
}

/// Why lists are made.
#[derive(Debug, Clone, Copy)]
pub enum Why<'a> {
    /// The device has been sent particles as they are, with their homes.
    Sent,
    /// Lists no longer hold; so far had walls been counted back before.
    Due(&'a [Periods]),
}

impl Lister {
    /// Makes all lists of particles whose columns the device has.
    pub fn list(
        &mut self,
        work: &mut Work,
        (model, state, lists): (&Model, &State, &NeighbourLists),
        why: Why,
    ) -> Result<(), DeviceError> {
        let count = work.count();
        let cell = model.cell();
        work.t.tile = tile(count) as u32;
        work.t.lists.tile_count = count.div_ceil(work.t.tile as usize) as u32;
        work.t.lists.margins = margins(model, state);
        let (low, high) =
            (cell.range.map(|r| r.map_or(0.0, |r| r.0)), cell.range.map(|r| r.map_or(0.0, |r| r.1)));
        (work.t.lists.periodic, work.t.lists.wraps_any) =
            ([low, high], u32::from(cell.range.iter().any(Option::is_some)));
        let images = cell.half_of_images();
        let shifts: Vec<Row4> = images.iter().map(|image| Row4::of(cell.shift(image))).collect();
        work.t.lists.shifts = self.shifts.write(work.device, &shifts)?;
        work.t.lists.images = images.len() as u32;
        self.sorter.sort(work, matches!(why, Why::Due(_)))?;
        self.send_walls(work, (model, state, lists), why)?;
        self.contacts.count(work, model, &self.fixed)?;
        self.contacts.make(work, model, &mut self.fixed)?;
        if let Why::Due(_) = why {
            work.launch("carry", work.t.slot_count as usize, 0)?;
        }
        work.launch("points", work.t.slot_count as usize, 0)
    }

    /// Sends walls as they are listed.
    fn send_walls(
        &mut self,
        work: &mut Work,
        (model, state, lists): (&Model, &State, &NeighbourLists),
        why: Why,
    ) -> Result<(), DeviceError> {
        let wall = |(w, [spheres, keys]): (usize, &[Address; 2])| {
            let body = &model.walls[w];
            let pose = shift_into_box(model, lists, w, pose_listed(model, state, w));
            let grid = body.sorted_spheres().map(|(_, grid)| *grid.lattice());
            let was = if let Why::Due(was) = why { was.get(w) } else { None };
            let back =
                was.zip(lists.wall_periods.get(w)).map(|(was, now)| [0, 1, 2].map(|a| was[a] - now[a]));
            let [x, y, z] = back.unwrap_or_default();
            DeviceWall {
                pose,
                around: around(model, w, &pose),
                margin: wall_margin(model, state, w),
                largest: body.largest(),
                lattice: grid.unwrap_or_default(),
                spheres: *spheres,
                keys: *keys,
                parts: body.parts(),
                pad: 0,
                back: [x, y, z, 0],
            }
        };
        let walls: Vec<DeviceWall> = self.fixed.walls.iter().enumerate().map(wall).collect();
        work.t.walls = walls.len() as u32;
        work.t.lists.walls = self.walls.write(work.device, &walls)?;
        Ok(())
    }
}
