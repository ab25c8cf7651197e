//! The frames of a layer, thinned evenly when they become too many; the last one always stays.

use super::pack::Packed;
use std::collections::HashSet;
use std::sync::Arc;

/// Frames in order of time, each with its number as given.
#[derive(Default)]
pub(crate) struct Timeline {
    frames: Vec<(usize, Packed)>,
    given: usize,
    bytes: usize,
}

impl Timeline {
    /// Whether nothing came yet.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// How many are kept.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// The frame given last.
    pub fn last(&self) -> Option<&Packed> {
        self.frames.last().map(|(_, packed)| packed)
    }

    /// The frames kept.
    pub fn iter(&self) -> impl Iterator<Item = &Packed> {
        self.frames.iter().map(|(_, packed)| packed)
    }

    /// Bytes of all frames, each shared column once.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Adds a frame; the one before it goes when it was only kept for being the last.
    pub fn push(&mut self, packed: Packed, stride: usize) {
        if self.frames.last().is_some_and(|(number, _)| number % stride != 0) {
            self.frames.pop();
            self.count();
        }
        let before: HashSet<_> =
            self.last().map(|l| l.blobs().map(Arc::as_ptr).collect()).unwrap_or_default();
        let new = packed.blobs().filter(|b| !before.contains(&Arc::as_ptr(b)));
        self.bytes += new.map(|b| b.len()).sum::<usize>();
        self.frames.push((self.given, packed));
        self.given += 1;
    }

    /// Keeps one frame of `stride`, and the last.
    pub fn thin(&mut self, stride: usize) {
        let last = self.given.saturating_sub(1);
        self.frames.retain(|(number, _)| number % stride == 0 || *number == last);
        self.count();
    }

    /// Leaves out the fields that do not stay.
    pub fn keep_fields(&mut self, stays: &[bool]) {
        for (_, packed) in &mut self.frames {
            let mut stays = stays.iter();
            packed.fields.retain(|_| stays.next().copied().unwrap_or(true));
        }
        self.count();
    }

    fn count(&mut self) {
        let all = self.frames.iter().flat_map(|(_, packed)| packed.blobs());
        let mut seen = HashSet::new();
        self.bytes = all.filter(|b| seen.insert(Arc::as_ptr(b))).map(|b| b.len()).sum();
    }
}
