//! What a contact keeps from step to step, as named fields in records.

use super::{ContactLaw, DESCRIPTIONS, Description, Field, Kind, active};
use alloc::vec::Vec;
use core::ops::Range;
use nalgebra::UnitQuaternion;
use primitives::Vec3;
use serde::{Deserialize, Serialize};

/// Numbers of all fields that there are, each once.
pub const RECORDED: usize = {
    let (mut sum, mut d) = (0, 0);
    while d < DESCRIPTIONS.len() {
        let mut f = 0;
        while f < DESCRIPTIONS[d].history.len() {
            if is_first(d, f) {
                sum += DESCRIPTIONS[d].history[f].kind.columns();
            }
            f += 1;
        }
        d += 1;
    }
    sum
};

/// Whether no earlier effect has a field of this name.
const fn is_first(d: usize, f: usize) -> bool {
    let (name, mut e) = (DESCRIPTIONS[d].history[f].name.as_bytes(), 0);
    while e < d {
        let mut g = 0;
        while g < DESCRIPTIONS[e].history.len() {
            if is_same(DESCRIPTIONS[e].history[g].name.as_bytes(), name) {
                return false;
            }
            g += 1;
        }
        e += 1;
    }
    true
}

const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut k = 0;
    while k < a.len() && k < b.len() && a[k] == b[k] {
        k += 1;
    }
    k == a.len() && k == b.len()
}

/// History of one contact by name, as its first particle sees it; 0 where no effect keeps it. Stages record it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ContactHistory([f64; RECORDED]);

impl ContactHistory {
    /// Every field that some effect keeps, with its columns in a record: those of resistances first, as records have them.
    pub fn fields() -> Vec<(&'static Field, Range<usize>)> {
        let normal = |d: &&&Description| d.normal.is_some();
        let all = DESCRIPTIONS.iter().filter(|d| !normal(d)).chain(DESCRIPTIONS.iter().filter(normal));
        let mut found: Vec<(&Field, Range<usize>)> = Vec::new();
        for field in all.flat_map(|d| d.history) {
            if found.iter().all(|(known, _)| known.name != field.name) {
                let from = found.last().map_or(0, |(_, columns)| columns.end);
                found.push((field, from..from + field.kind.columns()));
            }
        }
        found
    }

    /// Where each field of a contact law lies: its columns in the lists, and in a record.
    pub fn ranges(law: &ContactLaw) -> Vec<(Range<usize>, Range<usize>)> {
        let (all, mut from) = (ContactHistory::fields(), 0);
        let mut range = |field: &Field| {
            let listed = from..from + field.kind.columns();
            from = listed.end;
            let recorded = all.iter().find(|(known, _)| known.name == field.name);
            (listed, recorded.map_or(0..0, |(_, columns)| columns.clone()))
        };
        active(law).flat_map(|d| d.history).map(&mut range).collect()
    }

    /// The numbers of a field; empty where there is none of this name.
    pub fn get(&self, name: &str) -> &[f64] {
        let fields = ContactHistory::fields();
        fields.iter().find(|(field, _)| field.name == name).map_or(&[], |(_, at)| &self.0[at.clone()])
    }

    /// All numbers, in the order of [`ContactHistory::fields`].
    pub fn numbers(&self) -> &[f64; RECORDED] {
        &self.0
    }

    /// The same, mutable.
    pub fn numbers_mut(&mut self) -> &mut [f64; RECORDED] {
        &mut self.0
    }

    /// Whether it is nothing.
    pub fn is_zero(&self) -> bool {
        self.0 == [0.0; RECORDED]
    }

    /// Seen from a frame that is turned.
    pub fn seen(&self, turn: &UnitQuaternion<f64>) -> ContactHistory {
        let mut seen = *self;
        for (_, at) in ContactHistory::fields().into_iter().filter(|(field, _)| field.kind == Kind::Vector) {
            let turned = turn * Vec3::from_column_slice(&self.0[at.clone()]);
            seen.0[at].copy_from_slice(turned.as_slice());
        }
        seen
    }
}
