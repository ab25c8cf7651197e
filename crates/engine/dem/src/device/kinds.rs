//! What does not change in a run, as a device knows it: kinds of contact, and the spheres of walls.

use crate::device::DeviceError;
use crate::device::meshes::Meshes;
use crate::device::tables::Table;
use crate::device::work::Work;
use crate::model::{Kind, Model, With};
use gpu::compositions::{NAMES, number};
use gpu::tables::{
    Address, DeviceKind, DeviceTables, IMAGES, MESH, MOVED_SPHERES, PARTICLES, PLANE, SPHERES,
};
use laws::simd::Row4;

/// Classes of pairs of particles: the second is of the same tile or of a later one, and they touch or do not.
const PAIR_CLASSES: u32 = 4;

/// Number of the composition of a kind of contact, and the numbers of its effects; none where a device does not have its precision.
pub fn numbers_of(kind: &Kind) -> Option<(usize, Vec<f64>)> {
    let (of, numbers) = kind.composition.ported()?;
    Some((number(of)?, numbers))
}

/// Its tables.
#[derive(Default)]
pub struct Fixed {
    /// Kinds of contact.
    pub kinds: Vec<DeviceKind>,
    /// Spheres of each wall and keys of their cells; none of other walls.
    pub walls: Vec<[Address; 2]>,
    numbers: Table,
    of_kinds: Table,
    pairs: Table,
    images: Table,
    spheres: Vec<[Table; 2]>,
    /// Triangles of walls.
    pub meshes: Meshes,
    sent: bool,
}

impl Fixed {
    /// Sends them once.
    pub fn send(&mut self, work: &mut Work, model: &Model) -> Result<(), DeviceError> {
        if self.sent {
            return Ok(());
        }
        self.meshes.send(work, model)?;
        let Work { device, t } = work;
        let numbers = self.find_kinds(t, model);
        t.kinds = self.of_kinds.write(*device, &self.kinds)?;
        t.numbers = self.numbers.write(*device, &numbers)?;
        t.lists.pair_kinds = self.pairs.write(*device, &self.table_of(model, PARTICLES))?;
        t.lists.image_kinds = self.images.write(*device, &self.table_of(model, IMAGES))?;
        t.lists.kind_count = self.kinds.len() as u32;
        t.lists.materials = model.setup.materials.len() as u32;
        self.spheres.resize_with(model.walls.len(), Default::default);
        self.walls.clear();
        for (wall, [spheres, keys]) in model.walls.iter().zip(&mut self.spheres) {
            let Some((sorted, grid)) = wall.sorted_spheres() else {
                self.walls.push(Default::default());
                continue;
            };
            let rows: Vec<Row4> = sorted.map(|(c, r)| Row4([c.x, c.y, c.z, r])).collect();
            let key = |row: &Row4| grid.lattice().key(grid.cell_of(&row.vector()));
            let found: Vec<u64> = rows.iter().map(key).collect();
            self.walls.push([spheres.write(*device, &rows)?, keys.write(*device, &found)?]);
        }
        self.sent = true;
        Ok(())
    }

    /// Whether any contact with wall spheres lasts beyond touching.
    pub fn lasts(&self) -> bool {
        self.kinds.iter().any(|kind| kind.gap > 0.0)
    }

    /// Finds the kinds of contact and their classes, and the numbers of their effects.
    fn find_kinds(&mut self, t: &mut DeviceTables, model: &Model) -> Vec<f64> {
        let (mut classes, mut of_images, mut all) = (0, 0, Vec::new());
        self.kinds.clear();
        for kind in &model.kinds {
            // One that no device has is computed by no function.
            let (composition, numbers) = numbers_of(kind).unwrap_or((NAMES.len(), Vec::new()));
            let patch = kind.patch.filter(|p| p.shared);
            let columns = kind.composition.columns();
            let mut new = DeviceKind {
                composition: composition as u32,
                with: PARTICLES,
                numbers: all.len() as u32,
                between: [u32::from(kind.between.0), u32::from(kind.between.1)],
                class: classes,
                columns: columns as u32,
                patch: patch.map_or(0, |p| 1 + u32::from(p.hertz)),
                gap: patch.map_or(0.0, |p| p.gap),
                flips: (0..columns).map(|c| u32::from(kind.composition.flips(c)) << c).sum(),
                ..DeviceKind::default()
            };
            match kind.with {
                With::Particles => classes += PAIR_CLASSES,
                With::Images => (new.with, new.class, of_images) = (IMAGES, of_images, of_images + 1),
                With::Wall(w) => {
                    new.wall = w as u32;
                    new.with = if model.walls[w].drives() { MOVED_SPHERES } else { SPHERES };
                    if model.walls[w].triangles().is_some() {
                        new.with = MESH;
                    }
                    if let Some(plane) = model.walls[w].plane() {
                        (new.with, new.plane) = (PLANE, [plane.point.into(), plane.normal.into()]);
                    }
                    classes += 1;
                }
            }
            self.kinds.push(new);
            all.extend(numbers);
        }
        (t.lists.classes, t.lists.image_classes) = (classes, of_images);
        all
    }

    /// Which kind two materials belong to.
    fn table_of(&self, model: &Model, with: u32) -> Vec<u32> {
        let materials = model.setup.materials.len();
        let mut table = vec![0; materials * materials];
        for (number, kind) in (0..).zip(&self.kinds).filter(|(_, kind)| kind.with == with) {
            let [a, b] = kind.between.map(|material| material as usize);
            (table[a * materials + b], table[b * materials + a]) = (number, number);
        }
        table
    }
}
