//! A field of a layer of the page.

use crate::appearance::{field, scale::Range};
use stream::Table;

/// A field of a layer.
pub(crate) struct Field {
    pub name: String,
    pub whole: bool,
    /// Smallest and largest value in all frames.
    pub all: Range,
    /// What 98 % of the values lie in, frame by frame.
    pub most: Range,
}

/// The fields of a first table: all, or of vectors only the lengths; and the one `asked` for.
pub(super) fn new_fields(table: &Table, components: bool, sized: bool, asked: Option<&str>) -> Vec<Field> {
    let mut names = field::names(table, components);
    names.retain(|n| n != "radius" || sized);
    let place = |name: &str| ["x", "y", "z"].contains(&name);
    if let Some(asked) = asked.map(field::canonical).filter(|a| table.get(a).is_some() && !place(a)) {
        names.retain(|n| n != asked);
        names.push(asked.to_owned());
    }
    let field = |name: String| Field {
        whole: field::is_whole(table, &name),
        name,
        all: Range::EMPTY,
        most: Range::EMPTY,
    };
    names.into_iter().map(field).collect()
}
