//! Tiles of the lists, with what is computed for them: what a thread works on.

use crate::kernel::sums::Sums;
use crate::kernel::{Batch, LEDGER, StepInputs};
use crate::model::kind::{Kind, With};
use crate::neighbours::contacts::Segment;
use crate::neighbours::slices::{Lists, TileSlice, part, part_mut, some};
use crate::simd::{BLOCK, Width};
use crate::state::sleepers::SleepMap;
use crate::walls::WallBody;
use crate::walls::motion::Pose;
use crate::walls::seams::HistorySlots;
use geom::Vec3;
use std::ops::Range;

/// What a contact needs besides the lists.
#[derive(Clone, Copy)]
pub struct ContactInputs<'a> {
    pub kinds: &'a [Kind],
    pub walls: &'a [WallBody],
    pub poses: &'a [Pose],
    /// Length of the box along periodic axes, 0 along others [m].
    pub period: Vec3,
    pub width: Width,
    pub common: StepInputs<'a>,
    /// Which particles sleep, where the scene asks for it.
    pub known: Option<SleepMap<'a>>,
}

/// What a contact needs besides its own.
pub type TileInputs<'a> = (&'a Lists<'a>, &'a ContactInputs<'a>);

impl TileSlice<'_> {
    /// Contact points and loads of segment `k` of this part, added to the `sums` of its tile; true when an overlap passes the limit.
    pub fn compute(&mut self, k: usize, (lists, inputs): TileInputs, sums: &mut Sums) -> bool {
        let s = &self.segments[k];
        self.refresh(s, lists, inputs);
        self.compute_slots(s, s.places.clone(), (lists, inputs), sums)
    }

    /// Adds loads that were computed before: those of contacts `places` of a segment.
    pub fn recall(
        &mut self,
        s: &Segment,
        places: Range<usize>,
        (lists, inputs): TileInputs,
        sums: &mut Sums,
    ) {
        let both = inputs.kinds[s.kind].with == With::Particles && !s.later;
        let (first, n) = (places.start - self.from.place, places.len());
        let pairs = (&lists.i[places.clone()], &lists.partner[places.clone()]);
        let (load, torque) = (self.form.load(), self.form.torque());
        let loads = part(self.each.0, first * load, n * load);
        let torques = part(self.each.1, first * torque, n * torque);
        sums.take_again(pairs, both, (loads, torques));
        if s.later || inputs.kinds[s.kind].with == With::Images {
            let kept = s.kept - self.from.kept + places.start - s.places.start;
            self.kept.0[kept * load..][..loads.len()].copy_from_slice(loads);
            part_mut(self.kept.1, kept * torque, n * torque).copy_from_slice(torques);
        }
    }

    /// What is passed over loses no energy.
    pub fn clear_ledger(&mut self, places: Range<usize>) {
        let first = places.start - self.from.place;
        for row in part_mut(self.ledger, first * LEDGER, places.len() * LEDGER).chunks_exact_mut(LEDGER) {
            row[1..].fill(0.0);
        }
    }

    /// Loads of contacts `places` of a segment, whose contact points are found.
    pub fn compute_slots(
        &mut self,
        s: &Segment,
        places: Range<usize>,
        (lists, inputs): TileInputs,
        sums: &mut Sums,
    ) -> bool {
        let kind = &inputs.kinds[s.kind];
        let (first, n) = (places.start - self.from.place, places.len());
        let words = self.form.memory(kind.kernel.columns());
        let within = places.start - s.places.start;
        let (row, memory) = (s.rows - self.from.row + within, s.memory - self.from.memory + within * words);
        let (partners, j) = match kind.with {
            With::Particles => ((inputs.common.rows, inputs.common.spins), &lists.partner[places.clone()]),
            _ => ((&self.rows[row..row + n], part(self.spins, row, n)), &lists.count[..n]),
        };
        let keeps = s.later || kind.with == With::Images;
        let (kept, kept_n) = if keeps { (s.kept - self.from.kept + within, n) } else { (0, 0) };
        let task = Batch {
            partners,
            i: &lists.i[places],
            j,
            memory: &mut self.memory[memory..memory + n * words],
            active: &mut self.active[first / BLOCK..(first + n) / BLOCK],
            sums: sums.by_ref(),
            both: kind.with == With::Particles && !s.later,
            kept: some(&mut self.kept, kept, kept_n, self.form),
            each: some(&mut self.each, first, n, self.form),
            ledger: part_mut(self.ledger, first * LEDGER, n * LEDGER),
        };
        kind.kernel.run(inputs.width, inputs.common, task)
    }

    /// Finds the contact points of images and walls as they are now.
    pub fn refresh(&mut self, s: &Segment, lists: &Lists, inputs: &ContactInputs) {
        let kind = &inputs.kinds[s.kind];
        let first = s.rows - self.from.row;
        let (i, partner) = (&lists.i[s.contacts()], &lists.partner[s.contacts()]);
        match kind.with {
            With::Particles => {}
            With::Images => {
                for (k, (&j, shift)) in partner.iter().zip(&lists.shift[s.contacts()]).enumerate() {
                    let mut row = inputs.common.rows[j as usize];
                    for a in 0..3 {
                        row[a] += shift[a];
                    }
                    self.rows[first + k] = row;
                    if let Some(spin) = self.spins.get_mut(first + k) {
                        *spin = inputs.common.spins[j as usize];
                    }
                }
            }
            With::Wall(w) if lists.new || inputs.walls[w].refreshes() => {
                let (form, columns) = (self.form, kind.kernel.columns());
                let memory = s.memory - self.from.memory;
                let memory = &mut self.memory[memory..memory + s.places.len() * form.memory(columns)];
                let active = (s.places.start - self.from.place) / BLOCK;
                let active = &mut self.active[active..active + s.places.len() / BLOCK];
                let mut slots = HistorySlots { memory, active, form, first: 0, columns };
                let mut from = 0;
                while from < s.len {
                    let to = from + i[from..].iter().take_while(|&&k| k == i[from]).count();
                    let row = &inputs.common.rows[i[from] as usize];
                    let rows = &mut self.rows[first + from..first + to];
                    let spins = part_mut(self.spins, first + from, to - from);
                    let pose = (&inputs.poses[w], &inputs.period);
                    inputs.walls[w].contact_points(
                        pose,
                        row,
                        &partner[from..to],
                        (rows, spins),
                        slots.from(from),
                    );
                    from = to;
                }
            }
            With::Wall(_) => {}
        }
    }
}
