//! Columns of contacts, by slot of the neighbour lists: their history, and the wrenches of this instant.
//!
//! Which contact has which slot follows from Model and State ([`crate::neighbours`]); these columns do not.

use laws::contact::{LEDGER, STIFFNESS, WrenchSlices, WrenchSlicesMut, WrenchSums};
use laws::simd::{Aligned, Layout};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Column of the ledger with what sliding dissipated in a step.
pub(crate) const SLIDING: usize = 2;

/// Columns of contacts, one row a slot, and their sums by particle.
#[derive(Debug, Clone, Default)]
pub struct ContactColumns {
    /// How numbers lie in them.
    pub layout: Layout,
    /// Contact history.
    pub history: Aligned,
    /// Sliding work of each contact since it was recorded [J]; empty without the ledger.
    pub work: Vec<f64>,
    /// ∂F_n/∂δ of each contact in the last step, at which its springs were booked [N/m]; empty without the ledger.
    pub stiffness: Vec<f64>,
    /// 1 for each contact with a wall that touched in the last step; empty where walls have no sums.
    pub touched: Vec<u8>,
    /// Energies of each contact in the last step, [`LEDGER`] numbers a slot [J]; empty without the ledger.
    pub ledger: Aligned,
    /// Wrench of each contact, where it is kept.
    pub wrenches: WrenchColumns,
    /// Whether it is.
    pub keeps: bool,
    /// Sums of the wrenches on each particle.
    pub sums: WrenchColumns,
}

/// Wrenches in two columns.
#[derive(Debug, Clone, Default)]
pub struct WrenchColumns {
    /// Forces, and the moments of tangential forces where anything rotates.
    pub forces: Aligned,
    /// Torques besides those; empty where no effect makes any.
    pub torques: Aligned,
}

impl WrenchColumns {
    /// `rows` zeros, with or without torques.
    pub fn zeros(layout: Layout, rows: usize, torques: bool) -> WrenchColumns {
        let torques = if torques { rows * layout.torque() } else { 0 };
        WrenchColumns { forces: Aligned::zeros(rows * layout.force()), torques: Aligned::zeros(torques) }
    }

    /// Sets them to `rows` zeros, with torques where `other` has some.
    fn clear(&mut self, layout: Layout, rows: usize, other: &WrenchColumns) {
        let torques = if other.torques.is_empty() { 0 } else { rows };
        self.forces.clear(rows * layout.force());
        self.torques.clear(torques * layout.torque());
    }

    /// Sets them to these, or to none.
    pub fn set(&mut self, wrenches: Option<WrenchSlices>) {
        let WrenchSlices { forces, torques } = wrenches.unwrap_or_default();
        for (own, from) in [(&mut self.forces, forces), (&mut self.torques, torques)] {
            own.clear(from.len());
            own.copy_from_slice(from);
        }
    }

    /// Borrowed.
    pub fn slices(&self) -> WrenchSlices<'_> {
        WrenchSlices { forces: &self.forces, torques: &self.torques }
    }

    /// Borrowed, to be written.
    pub fn slices_mut(&mut self) -> WrenchSlicesMut<'_> {
        WrenchSlicesMut { forces: &mut self.forces, torques: &mut self.torques }
    }
}

impl ContactColumns {
    /// Adds columns of zeros for what is computed in each step: whether there are torques, whether a ledger is kept.
    pub fn allocate(&mut self, slots: usize, particles: usize, torques: bool, ledger: bool) {
        let slots = if ledger { slots } else { 0 };
        self.sums = WrenchColumns::zeros(self.layout, particles, torques);
        (self.wrenches, self.keeps) = Default::default();
        self.ledger = Aligned::zeros(slots * LEDGER);
        self.work.resize(slots, 0.0);
        self.stiffness.resize(slots, 0.0);
        self.know_stiffness();
    }

    /// Frees all but history, work, stiffness and what touched walls.
    pub fn release(&mut self) {
        (self.sums, self.ledger) = Default::default();
        (self.wrenches, self.keeps) = Default::default();
    }

    /// Whether the wrench of each contact is kept from now on. Where it was not, all begin at 0: blocks in which nothing touches are not
    /// computed.
    pub fn keep_wrenches(&mut self, keep: bool, slots: usize) {
        if keep && !self.keeps {
            self.wrenches.clear(self.layout, slots, &self.sums);
        }
        self.keeps = keep;
    }

    /// Sum of the forces on particle number `k` [N].
    pub fn force_on(&self, k: usize) -> geom::Vec3 {
        self.layout.force_at(&self.sums.forces, k)
    }

    /// Sums of the wrenches on all particles.
    pub fn sums(&self) -> WrenchSums<'_> {
        WrenchSums { first: 0, layout: self.layout, sums: self.sums.slices() }
    }

    /// Force on the first particle of the contact in `slot` [N], where each is kept.
    pub fn force(&self, slot: usize) -> geom::Vec3 {
        self.layout.force_at(&self.wrenches.forces, slot)
    }

    /// Elastic energy of all contacts [J]; 0 without the ledger.
    pub fn elastic(&self) -> f64 {
        self.ledger.chunks_exact(LEDGER).map(|row| row[0]).sum()
    }

    /// Adds the sliding work of one step, and keeps the stiffness; the ledger has been computed.
    pub fn add_work(&mut self) {
        let sliding = self.ledger.chunks_exact(LEDGER).map(|row| row[SLIDING]);
        self.work.iter_mut().zip(sliding).for_each(|(work, step)| *work += step);
        let stiffness = self.ledger.chunks_exact(LEDGER).map(|row| row[STIFFNESS]);
        self.stiffness.iter_mut().zip(stiffness).for_each(|(own, step)| *own = step);
    }

    /// Gives rows of the ledger that are new the stiffness at which springs were booked.
    pub fn know_stiffness(&mut self) {
        let rows = self.ledger.chunks_exact_mut(LEDGER);
        rows.zip(&self.stiffness).for_each(|(row, own)| row[STIFFNESS] = *own);
    }
}

/// The columns that a checkpoint holds: those that cannot be computed again from the rest of State.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SavedColumns<'a> {
    /// Contact history.
    pub history: Cow<'a, [f64]>,
    work: Cow<'a, [f64]>,
    stiffness: Cow<'a, [f64]>,
    touched: Cow<'a, [u8]>,
    /// Forces, torques and ledger of each contact, when they are those of this step and kept.
    wrenches: [Cow<'a, [f64]>; 3],
    /// Sums of forces and torques by particle, when they are those of this step and each contact's are not kept.
    sums: [Cow<'a, [f64]>; 2],
}

impl SavedColumns<'_> {
    /// The columns of an instant. `known`: forces of this instant are; `sleep`: wrenches between sleepers, which are those of the step in
    /// which they fell asleep, last.
    pub fn of(columns: &ContactColumns, known: bool, sleep: bool) -> SavedColumns<'_> {
        let ContactColumns { history, work, stiffness, touched, ledger, wrenches, keeps, sums, .. } = columns;
        let none = &[][..];
        let wrenches = match (known || sleep, keeps) {
            (true, true) => [&wrenches.forces[..], &wrenches.torques, ledger],
            (true, false) => [none, none, ledger],
            (false, _) => [none; 3],
        };
        let sums = if known && !keeps { [&sums.forces[..], &sums.torques] } else { [none; 2] };
        SavedColumns {
            history: Cow::Borrowed(history),
            work: Cow::Borrowed(work),
            stiffness: Cow::Borrowed(stiffness),
            touched: Cow::Borrowed(touched),
            wrenches: wrenches.map(Cow::Borrowed),
            sums: sums.map(Cow::Borrowed),
        }
    }

    /// A copy that outlives the simulation.
    pub fn into_owned(self) -> SavedColumns<'static> {
        fn own(column: Cow<[f64]>) -> Cow<'static, [f64]> {
            Cow::Owned(column.into_owned())
        }
        SavedColumns {
            history: own(self.history),
            work: own(self.work),
            stiffness: own(self.stiffness),
            touched: Cow::Owned(self.touched.into_owned()),
            wrenches: self.wrenches.map(own),
            sums: self.sums.map(own),
        }
    }

    /// Whether there are wrenches of single contacts.
    pub fn has_wrenches(&self) -> bool {
        !self.wrenches[0].is_empty()
    }

    /// Whether there are sums.
    pub fn has_sums(&self) -> bool {
        self.sums.iter().any(|column| !column.is_empty())
    }

    /// Puts history, work, stiffness and what touched walls into columns of newly made lists; false where they have another number of contacts.
    pub fn restore_history(&self, columns: &mut ContactColumns) -> bool {
        if self.work.len() == columns.work.len() {
            columns.work.copy_from_slice(&self.work);
        }
        if self.stiffness.len() == columns.stiffness.len() {
            columns.stiffness.copy_from_slice(&self.stiffness);
            columns.know_stiffness();
        }
        if self.touched.len() == columns.touched.len() {
            columns.touched.copy_from_slice(&self.touched);
        }
        copy(&self.history, &mut columns.history)
    }

    /// Puts wrenches and ledger of each contact, or sums by particle, into their columns; false where these have other lengths.
    pub fn restore_wrenches(&self, columns: &mut ContactColumns) -> bool {
        let ContactColumns { wrenches, ledger, keeps, sums, .. } = columns;
        let target = if *keeps { wrenches } else { sums };
        let [forces, torques, saved_ledger] = &self.wrenches;
        let [forces, torques] = if *keeps { [forces, torques] } else { [&self.sums[0], &self.sums[1]] };
        copy(forces, &mut target.forces) && copy(torques, &mut target.torques) && copy(saved_ledger, ledger)
    }
}

/// Copies a whole column; false where the lengths differ.
fn copy(from: &[f64], to: &mut [f64]) -> bool {
    let fits = from.len() == to.len();
    if fits {
        to.copy_from_slice(from);
    }
    fits
}
