//! What a cut finds in a scene, and removes from it.

use toml_edit::{DocumentMut, Item, Table};

/// What the cut finds in a scene.
#[derive(Default)]
pub(super) struct Found {
    /// Entries that are left out, each with its place in the text.
    pub gone: Vec<(Option<isize>, String)>,
    /// Whether grains start, or come in, upstream of the plane.
    pub upstream: bool,
}

impl Found {
    /// Entries that are left out, in the order of the scene.
    pub fn names(mut self) -> Vec<String> {
        self.gone.sort_by_key(|(place, _)| *place);
        self.gone.into_iter().map(|(_, name)| name).collect()
    }
}

/// Removes an entry of a list of tables.
pub(super) fn remove(document: &mut DocumentMut, key: &str, index: usize, name: String, found: &mut Found) {
    if let Some(tables) = document.get_mut(key).and_then(Item::as_array_of_tables_mut) {
        let place = tables.get(index).and_then(Table::position);
        tables.remove(index);
        found.gone.push((place, name));
        if tables.is_empty() {
            document.remove(key);
        }
    }
}
