//! Triangles of walls in the memory of a device, which do not change, and the memory that a step takes for them.

use crate::device::DeviceError;
use crate::device::tables::Table;
use crate::device::work::{RunningSums, Work};
use crate::model::Model;
use geom::Vec3;
use gpu::tables::{Address, DeviceMesh};
use laws::contact::seams::{Member, Nearest};

/// Their tables.
#[derive(Default)]
pub struct Meshes {
    /// Whether any wall is of triangles.
    pub any: bool,
    of_walls: Table,
    columns: Vec<[Table; 6]>,
    starts: Table,
    sums: RunningSums,
    nearest: Table,
    members: Table,
}

impl Meshes {
    /// Sends them.
    pub fn send(&mut self, work: &mut Work, model: &Model) -> Result<(), DeviceError> {
        self.any = model.walls.iter().any(|wall| wall.triangles().is_some());
        if !self.any {
            return Ok(());
        }
        self.columns.resize_with(model.walls.len(), Default::default);
        let mut all = vec![DeviceMesh::default(); model.walls.len()];
        for (number, (wall, columns)) in model.walls.iter().zip(&mut self.columns).enumerate() {
            let Some(triangles) = wall.triangles() else { continue };
            let [corners, doubled, nodes, order, boxes, surface] = columns;
            let (tree, with) = (triangles.boxes.tree(), wall.surface_of(number));
            let is_doubled: Vec<u8> = triangles.doubled.iter().map(|&d| u8::from(d)).collect();
            let device = &mut *work.device;
            all[number] = DeviceMesh {
                corners: corners.write::<[Vec3; 3]>(device, &triangles.corners)?,
                doubled: if is_doubled.is_empty() {
                    Address::default()
                } else {
                    doubled.write(device, &is_doubled)?
                },
                nodes: nodes.write::<[Vec3; 2]>(device, tree.nodes)?,
                order: order.write(device, tree.order)?,
                boxes: boxes.write::<[Vec3; 2]>(device, tree.boxes)?,
                surface: surface.write(device, &with)?,
                node_count: tree.nodes.len() as u32,
                parts: wall.parts(),
                surface_count: with.len() as u32,
                pad: 0,
                fastest: wall.fastest(),
                reach: wall.reach(),
            };
        }
        work.t.meshes = self.of_walls.write(work.device, &all)?;
        Ok(())
    }

    /// Makes room for what a step finds of the triangles that are listed.
    pub fn make_room(&mut self, work: &mut Work) -> Result<(), DeviceError> {
        if !self.any {
            return Ok(());
        }
        let count = work.count();
        work.t.triangle_starts = self.starts.room::<u32>(work.device, count + 1)?;
        work.launch("triangles_of", count + 1, 0)?;
        self.sums.make(work, work.t.triangle_starts, count + 1)?;
        // The last is the number of all.
        let (mut all, last) = ([0; 4], (count * size_of::<u32>()) as u64);
        work.device.read(Address(work.t.triangle_starts.0 + last), &mut all)?;
        work.t.triangle_count = u32::from_ne_bytes(all);
        let listed = work.t.triangle_count as usize;
        work.t.nearest = self.nearest.room::<[u8; size_of::<Nearest>()]>(work.device, listed)?;
        work.t.members = self.members.room::<[u8; size_of::<Member>()]>(work.device, listed)?;
        Ok(())
    }
}
