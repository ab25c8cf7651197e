//! A device whose memory is damaged stops the run: no thread reads or writes beyond a table.

use super::meshes::drawn;
use super::{advance, every_composition, shaken, there, trough};
use crate::device::{Device, DeviceError, Local, functions};
use crate::{Halt, Setup};
use gpu::lists::WRITE;
use gpu::tables::{Address, DeviceTables};

/// A table of a device, and how many of its bytes are overwritten.
type Damage = fn(&DeviceTables) -> (Address, usize);

/// A device that overwrites a table before a function runs for the second time.
struct Damaged {
    local: Local,
    damage: Damage,
    before: &'static str,
    /// Only in this mode of a function that makes lists.
    mode: Option<u32>,
    calls: u32,
}

impl Device for Damaged {
    fn name(&self) -> String {
        self.local.name()
    }

    fn allocate(&mut self, bytes: usize) -> Result<Address, DeviceError> {
        self.local.allocate(bytes)
    }

    fn clear(&mut self, at: Address, bytes: usize) -> Result<(), DeviceError> {
        self.local.clear(at, bytes)
    }

    fn release(&mut self, at: Address) -> Result<(), DeviceError> {
        self.local.release(at)
    }

    fn write(&mut self, to: Address, bytes: &[u8]) -> Result<(), DeviceError> {
        self.local.write(to, bytes)
    }

    fn read(&mut self, from: Address, bytes: &mut [u8]) -> Result<(), DeviceError> {
        self.local.read(from, bytes)
    }

    fn launch(
        &mut self,
        function: usize,
        threads: usize,
        t: &DeviceTables,
        step: u32,
    ) -> Result<(), DeviceError> {
        if functions()[function] == self.before && self.mode.is_none_or(|mode| mode == step) {
            self.calls += 1;
            if self.calls == 2 {
                let (at, bytes) = (self.damage)(t);
                self.local.write(at, &vec![0x7f; bytes])?;
            }
        }
        self.local.launch(function, threads, t, step)
    }
}

fn words(count: u32) -> usize {
    4 * count as usize
}

#[test]
fn numbers_beyond_their_tables_stop_the_run() {
    let blocks = |t: &DeviceTables| (t.contacts.blocks, 3 * words(t.slot_count / laws::simd::BLOCK as u32));
    let cases: [(&str, &'static str, Option<u32>, Damage); 5] = [
        ("partners", "contacts_common_hertz_sliding_rolling", None, |t| {
            (t.contacts.partner, words(t.slot_count))
        }),
        ("blocks", "contacts_common_hertz_sliding_rolling", None, blocks),
        ("entries", "spheres", None, |t| (t.contacts.entries, 64)),
        ("slots of classes", "common_pairs", Some(WRITE), |t| (t.lists.class_slots, 64)),
        ("slots of classes of walls", "wall_parts", Some(WRITE), |t| (t.lists.class_slots, 64)),
    ];
    let of_meshes: [(&str, Damage); 3] = [
        ("starts of triangles", |t| (Address(t.triangle_starts.0 + 4), 4)),
        ("blocks", |t| (t.contacts.blocks, 3 * words(t.slot_count / laws::simd::BLOCK as u32))),
        ("entries", |t| (t.contacts.entries, words(t.slot_count))),
    ];
    for (what, damage) in of_meshes {
        let device = Damaged { local: Local::default(), damage, before: "triangles", mode: None, calls: 0 };
        let halt = advance(&mut there(drawn(1), device), 1200).expect_err(what);
        assert!(halt.to_string().contains("its memory is damaged"), "{what}: {halt}");
    }
    for (what, before, mode, damage) in cases {
        for make in [trough as fn(_) -> Setup, shaken] {
            let device = Damaged { local: Local::default(), damage, before, mode, calls: 0 };
            let mut sim = there(make(every_composition()[5]), device);
            let halt = advance(&mut sim, 1200).expect_err(what);
            let said = halt.to_string();
            assert!(
                matches!(halt, Halt::Device { .. }) && said.contains("its memory is damaged"),
                "{what}: {said}"
            );
        }
    }
}

/// Where the first point of each cell is said to lie beyond all points, fewer pairs are found, and nothing else is read.
#[test]
fn a_search_stays_among_the_points() {
    let device = Damaged {
        local: Local::default(),
        damage: |t| {
            (
                t.lists.cell_starts,
                if t.lists.cell_starts == Address::default() { 0 } else { words(t.lists.cells) },
            )
        },
        before: "common_pairs",
        mode: None,
        calls: 0,
    };
    let mut sim = there(trough(every_composition()[5]), device);
    // The lists of both passes differ, or are empty: the run stops or goes on, and no more.
    let _ = advance(&mut sim, 400);
}
