//! What contacts with a mesh remember, as [`laws::contact::seams`] hands it from one triangle to the next.

use laws::contact::seams::{Memory, Nearest, hand_over};
use laws::contact::{LEDGER, STIFFNESS};
use laws::simd::{BLOCK, Layout};

/// Contact history of some slots of one segment.
pub struct HistorySlots<'a> {
    /// Of the whole segment, by block and column.
    pub history: &'a mut [f64],
    /// Whether each block of it may hold any.
    pub active: &'a mut [bool],
    /// How it is kept.
    pub layout: Layout,
    /// First of the slots.
    pub first: usize,
    /// Numbers of each contact.
    pub columns: usize,
    /// Rows of the energy ledger of the whole segment; empty without it.
    pub ledger: &'a mut [f64],
}

impl HistorySlots<'_> {
    /// The same from slot `by` on.
    pub fn from(&mut self, by: usize) -> HistorySlots<'_> {
        let HistorySlots { history, active, layout, first, columns, ledger } = self;
        HistorySlots { history, active, layout: *layout, first: *first + by, columns: *columns, ledger }
    }

    fn at(&self, k: usize, column: usize) -> usize {
        self.layout.history_at(0, self.first + k, column, self.columns)
    }

    fn stiffness(&self, k: usize) -> usize {
        (self.first + k) * LEDGER + STIFFNESS
    }

    fn remembers(&self, k: usize) -> bool {
        (0..self.columns).any(|c| self.layout.get(self.history, self.at(k, c)) != 0.0)
    }

    fn is_booked(&self, k: usize) -> bool {
        self.ledger[self.stiffness(k)] != 0.0
    }

    fn move_history(&mut self, from: usize, to: usize) {
        for c in 0..self.columns {
            let (a, b) = (self.at(from, c), self.at(to, c));
            let x = self.layout.get(self.history, a);
            self.layout.put(self.history, b, x);
            self.layout.put(self.history, a, 0.0);
        }
        // Or a block in which nothing touches is passed over, by as many contacts as are computed at once.
        self.active[(self.first + to) / BLOCK] = true;
    }

    fn move_stiffness(&mut self, from: usize, to: usize) {
        let (a, b) = (self.stiffness(from), self.stiffness(to));
        self.ledger[b] = std::mem::take(&mut self.ledger[a]);
    }

    /// Moves the history of points that no longer count to neighbours without history, and the stiffness at which the ledger booked
    /// them to neighbours without one. Each by itself: what moves is the same with the ledger and without.
    pub fn take_over(&mut self, near: &[Nearest], radius: f64) {
        if self.columns > 0 {
            hand_over(near, radius, &mut Histories(self.from(0)));
        }
        if !self.ledger.is_empty() {
            hand_over(near, radius, &mut Stiffnesses(self.from(0)));
        }
    }
}

/// Their histories.
struct Histories<'a>(HistorySlots<'a>);

impl Memory for Histories<'_> {
    fn holds(&self, k: usize) -> bool {
        self.0.remembers(k)
    }

    fn give(&mut self, from: usize, to: usize) {
        self.0.move_history(from, to);
    }
}

/// The stiffnesses at which the ledger booked them.
struct Stiffnesses<'a>(HistorySlots<'a>);

impl Memory for Stiffnesses<'_> {
    fn holds(&self, k: usize) -> bool {
        self.0.is_booked(k)
    }

    fn give(&mut self, from: usize, to: usize) {
        self.0.move_stiffness(from, to);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    /// A block that was skipped is computed again once one of its contacts takes a history.
    #[test]
    fn a_block_that_takes_history_is_active() {
        let triangle = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let layout = Layout::default();
        let (mut history, mut active) = (vec![0.0; 2 * BLOCK], [true, false]);
        let at = |k: usize| layout.history_at(0, k, 0, 1);
        layout.put(&mut history, at(7), 3.0);
        // The grain's triangles are the last of one block and the first of the next.
        let mut near = [Nearest::of(triangle, Vec3::new(0.2, 0.2, 1.0)); 2];
        near[1].counts = true;
        let mut ledger = vec![0.0; 2 * BLOCK * LEDGER];
        ledger[7 * LEDGER + STIFFNESS] = 5.0;
        let (history_of, active_of, ledger_of) = (&mut history[..], &mut active[..], &mut ledger[..]);
        let mut slots = HistorySlots {
            history: history_of,
            active: active_of,
            layout,
            first: 0,
            columns: 1,
            ledger: ledger_of,
        };
        slots.from(7).take_over(&near, 1.0);
        assert_eq!((layout.get(&history, at(7)), layout.get(&history, at(8))), (0.0, 3.0));
        assert_eq!(active, [true, true]);
        assert_eq!((ledger[7 * LEDGER + STIFFNESS], ledger[8 * LEDGER + STIFFNESS]), (0.0, 5.0));
    }
}
