//! A field of a layer of the page.

use crate::appearance::scale::Range;

/// A field of a layer.
pub(crate) struct Field {
    pub name: String,
    pub whole: bool,
    /// Smallest and largest value in all frames.
    pub all: Range,
    /// What 98 % of the values lie in, frame by frame.
    pub most: Range,
}
