//! Tiles of the lists, with what is computed for them: what a thread works on.

use crate::model::{Model, With};
use crate::neighbours::{Segment, Slots, TileSlice};
use crate::state::SleepMap;
use crate::walls::Nearby;
use crate::walls::remembered::HistorySlots;
use geom::Vec3;
use geom::motion::Pose;
use laws::contact::patch::PATCH;
use laws::contact::wrenches::{rows, rows_mut};
use laws::contact::{Batch, LEDGER, Pairs, StepInputs, Sums};
use laws::simd::BLOCK;
use laws::space::cell::Cell;
use std::ops::Range;

/// What all tiles read.
#[derive(Clone, Copy)]
pub struct TileInputs<'a> {
    /// The lists.
    pub lists: &'a Slots,
    pub model: &'a Model,
    /// Where walls are now.
    pub poses: &'a [Pose],
    /// The periodic cell now.
    pub cell: Cell,
    /// Its lengths [m]; 0 along open axes.
    pub lengths: Vec3,
    /// What all contacts share.
    pub step: StepInputs<'a>,
    /// Whether contact points and patches are those of this instant.
    pub pointed: bool,
    /// Which particles sleep, where the scene asks for it.
    pub sleepers: Option<SleepMap<'a>>,
}

impl Segment {
    /// Whether the second particle of each contact is in its tile.
    fn both(&self) -> bool {
        self.with == With::Particles && !self.later
    }

    /// Whether its wrenches arrive at other tiles.
    fn keeps(&self) -> bool {
        self.later || self.with == With::Images
    }
}

impl TileSlice<'_> {
    /// Contact points and forces of segment `k` of this slice, added to the `sums` of its tile; true when an overlap passes the limit.
    pub fn compute(&mut self, k: usize, inputs: &TileInputs, sums: &mut Sums) -> bool {
        let s = &self.segments[k];
        self.find_contact_points(s, inputs);
        self.compute_slots(s, s.slots.clone(), inputs, sums)
    }

    /// Adds the wrenches of some slots of a segment that were computed before.
    pub fn add_kept(&mut self, s: &Segment, slots: Range<usize>, inputs: &TileInputs, sums: &mut Sums) {
        let (first, n) = (slots.start - self.from.slot, slots.len());
        let Slots { i, partner, .. } = inputs.lists;
        let pairs = Pairs { i: &i[slots.clone()], j: &partner[slots.clone()], both: s.both() };
        let wrenches = self.each.as_ref().rows(first, n, self.layout);
        sums.accumulate_kept(pairs, wrenches);
        if s.keeps() {
            let kept = s.kept - self.from.kept + slots.start - s.slots.start;
            self.kept.rows_mut(kept, n, self.layout).copy_from(wrenches);
        }
    }

    /// Contacts that are passed over dissipate nothing.
    pub fn clear_ledger(&mut self, slots: Range<usize>) {
        let first = slots.start - self.from.slot;
        for row in rows_mut(self.ledger, first * LEDGER, slots.len() * LEDGER).chunks_exact_mut(LEDGER) {
            row[1..].fill(0.0);
        }
    }

    /// Forces of some slots of a segment, whose contact points are known; true when an overlap passes the limit.
    pub fn compute_slots(
        &mut self,
        s: &Segment,
        slots: Range<usize>,
        inputs: &TileInputs,
        sums: &mut Sums,
    ) -> bool {
        let (composition, lists) = (&inputs.model.kinds[s.kind].composition, &inputs.lists);
        let (first, n) = (slots.start - self.from.slot, slots.len());
        let words = self.layout.history(composition.columns());
        let within = slots.start - s.slots.start;
        let (row, history) =
            (s.rows - self.from.row + within, s.history - self.from.history + within * words);
        let (partners, j) = match s.with {
            With::Particles => ((inputs.step.rows, inputs.step.spins), &lists.partner[slots.clone()]),
            _ => ((&self.rows[row..row + n], rows(self.spins, row, n)), &lists.count[..n]),
        };
        let patch = if s.patches {
            let from = s.patch - self.from.patch + within * PATCH;
            &self.patch[from..from + n * PATCH]
        } else {
            &[]
        };
        let each = match s.with {
            With::Wall(_) if !self.walls.forces.is_empty() => self.walls.rows_mut(row, n, self.layout),
            _ => self.each.rows_mut(first, n, self.layout),
        };
        let (kept, kept_n) = if s.keeps() { (s.kept - self.from.kept + within, n) } else { (0, 0) };
        let batch = Batch {
            partners,
            i: &lists.i[slots],
            j,
            history: &mut self.history[history..history + n * words],
            active: &mut self.active[first / BLOCK..(first + n) / BLOCK],
            sums: sums.by_ref(),
            both: s.both(),
            kept: self.kept.rows_mut(kept, kept_n, self.layout),
            patch,
            each,
            ledger: rows_mut(self.ledger, first * LEDGER, n * LEDGER),
        };
        composition.run(inputs.model.width, inputs.step, batch)
    }

    /// Finds the contact points of images and walls as they are now.
    pub fn find_contact_points(&mut self, s: &Segment, inputs: &TileInputs) {
        if inputs.pointed {
            return;
        }
        match s.with {
            With::Images => self.shift_images(s, inputs),
            With::Wall(w) if inputs.lists.new || inputs.model.walls[w].refreshes() => {
                self.touch_wall(s, w, inputs);
            }
            With::Wall(_) | With::Particles => {}
        }
        self.find_patches(s, inputs);
    }

    /// Copies rows and spins of particles to their images, shifted.
    fn shift_images(&mut self, s: &Segment, inputs: &TileInputs) {
        let (first, slots) = (s.rows - self.from.row, s.contacts());
        let (Slots { partner, image, .. }, cell) = (inputs.lists, &inputs.cell);
        for (k, (&j, image)) in partner[slots.clone()].iter().zip(&image[slots]).enumerate() {
            let mut row = inputs.step.rows[j as usize];
            let shift = cell.shift(image);
            for a in 0..3 {
                row[a] += shift[a];
            }
            if cell.moves() {
                let drift = cell.drift(image);
                for a in 0..3 {
                    row[4 + a] += drift[a];
                }
            }
            self.rows[first + k] = row;
            if let Some(spin) = self.spins.get_mut(first + k) {
                *spin = inputs.step.spins[j as usize];
            }
        }
    }

    /// Contact points of a wall, particle by particle.
    fn touch_wall(&mut self, s: &Segment, wall: usize, inputs: &TileInputs) {
        let (first, layout) = (s.rows - self.from.row, self.layout);
        let (i, partner) = (&inputs.lists.i[s.contacts()], &inputs.lists.partner[s.contacts()]);
        let columns = inputs.model.kinds[s.kind].composition.columns();
        let history = s.history - self.from.history;
        let history = &mut self.history[history..history + s.slots.len() * layout.history(columns)];
        let active = (s.slots.start - self.from.slot) / BLOCK;
        let active = &mut self.active[active..active + s.slots.len() / BLOCK];
        let ledger = rows_mut(self.ledger, (s.slots.start - self.from.slot) * LEDGER, s.slots.len() * LEDGER);
        let mut slots = HistorySlots { history, active, layout, first: 0, columns, ledger };
        let pose = inputs.model.walls[wall].pose(&inputs.poses[wall]);
        let (mut from, mut nearby) = (0, Nearby::default());
        while from < s.len {
            let to = from + i[from..].iter().take_while(|&&k| k == i[from]).count();
            let row = &inputs.step.rows[i[from] as usize];
            let rows = &mut self.rows[first + from..first + to];
            let spins = rows_mut(self.spins, first + from, to - from);
            inputs.model.walls[wall].contact_points(
                (&inputs.model.walls, wall),
                (&pose, &inputs.lengths),
                row,
                &partner[from..to],
                (rows, spins),
                (slots.from(from), &mut nearby),
            );
            from = to;
        }
    }
}
