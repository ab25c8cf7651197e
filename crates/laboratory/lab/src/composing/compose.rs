//! Scenes put together: the text of a sample, changed keys, and what a test adds.

use std::fmt::Write;
use toml_edit::{DocumentMut, Item, Table, value};

/// A scene that grows: the sample first, then what a recipe adds.
#[derive(Debug, Clone)]
pub(crate) struct Composition {
    document: DocumentMut,
    added: String,
}

impl Composition {
    pub(crate) fn new(document: DocumentMut) -> Composition {
        Composition { document, added: String::new() }
    }

    /// Sets a key of a table, such as `time`; an entry of a list is `fill.0`.
    pub(crate) fn set(&mut self, table: &str, key: &str, to: impl Into<toml_edit::Value>) {
        let table = match table.strip_suffix(".0") {
            None => self.document.entry(table).or_insert_with(|| Item::Table(Table::new())).as_table_mut(),
            Some(list) => {
                let list = self.document.get_mut(list).and_then(Item::as_array_of_tables_mut);
                list.and_then(|list| list.get_mut(0))
            }
        };
        if let Some(table) = table {
            table.insert(key, value(to));
        }
    }

    /// Removes a whole section.
    pub(crate) fn remove(&mut self, section: &str) {
        self.document.remove(section);
    }

    /// Gives a whole section another name.
    pub(crate) fn rename(&mut self, section: &str, name: &str) {
        if let Some(item) = self.document.remove(section) {
            self.document.insert(name, item);
        }
    }

    /// The entries of a list of tables.
    pub(crate) fn entries(&mut self, list: &str) -> impl Iterator<Item = &mut Table> {
        let list = self.document.get_mut(list).and_then(Item::as_array_of_tables_mut);
        list.into_iter().flat_map(|list| list.iter_mut())
    }

    /// Adds text at the end.
    pub(crate) fn add(&mut self, text: &str) {
        let _ = write!(self.added, "\n{text}");
    }

    /// The text of the scene.
    pub(crate) fn text(&self) -> String {
        format!("{}\n{}", self.document.to_string().trim_end(), self.added)
    }
}

/// A number as text that reads back as it is.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_composition_keeps_the_sample_and_adds_to_it() {
        let sample: DocumentMut =
            "# sand\n[time]\nsafety = 0.3\n[[fill]]\nmaterial = \"sand\"\n".parse().unwrap();
        let mut scene = Composition::new(sample);
        scene.set("time", "until", 2.0);
        scene.set("fill.0", "count", 5);
        scene.add("[[wall]]\nname = \"floor\"\n");
        let text = scene.text();
        assert_eq!(
            text,
            "# sand\n[time]\nsafety = 0.3\nuntil = 2.0\n[[fill]]\nmaterial = \"sand\"\ncount = 5\n\n[[wall]]\nname = \"floor\"\n"
        );
        scene.remove("fill");
        assert!(!scene.text().contains("fill") && scene.text().contains("until"));
    }
}
