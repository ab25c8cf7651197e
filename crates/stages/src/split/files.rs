//! Files that a scene names, as seen from the folder of another one.

use super::cutting::Cutting;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, value};

impl Cutting<'_> {
    /// Files of the scene, as seen from the folder of the new one.
    pub fn rebase(&self, document: &mut DocumentMut) {
        for (table, keys) in [
            ("wall", &["source", "mesh"][..]),
            ("clump", &["mesh"]),
            ("particles", &["source"]),
            ("inlet", &["source"]),
            ("fill", &["sizes"]),
            ("insert", &["sizes"]),
        ] {
            let tables = document.get_mut(table).and_then(Item::as_array_of_tables_mut);
            for entry in tables.into_iter().flat_map(|tables| tables.iter_mut()) {
                for key in keys {
                    let Some(mut item) = entry.get_mut(key) else { continue };
                    // Sizes may be a table with the name of a file.
                    if item.is_table_like() {
                        let Some(inner) = item.get_mut("file") else { continue };
                        item = inner;
                    }
                    let Some(file) = item.as_str() else { continue };
                    *item = value(relative(&self.scene.folder.join(file), &self.cut.folder));
                }
            }
        }
    }
}

/// A file as seen from a folder; as it is when the way is not known.
fn relative(file: &Path, folder: &Path) -> String {
    // An empty path is the folder that the tool was started in.
    let here = |p: &Path| match p.as_os_str().is_empty() {
        true => std::env::current_dir(),
        false => std::path::absolute(p),
    };
    let (Ok(to), Ok(from)) = (here(file), here(folder)) else { return file.display().to_string() };
    let (to, from) = (clean(&to), clean(&from));
    let common = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let mut way = PathBuf::new();
    from[common..].iter().for_each(|_| way.push(".."));
    to[common..].iter().for_each(|part| way.push(part));
    way.display().to_string()
}

/// The parts of an absolute path, without `.` and `..`.
fn clean(path: &Path) -> Vec<std::ffi::OsString> {
    let mut parts = Vec::new();
    for part in path.components() {
        match part {
            std::path::Component::ParentDir => drop(parts.pop()),
            std::path::Component::Normal(name) => parts.push(name.to_owned()),
            _ => {}
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_seen_from_the_new_folder() {
        assert_eq!(relative(Path::new("/a/b/../c/w.mcap"), Path::new("/a/out")), "../c/w.mcap");
        assert_eq!(relative(Path::new("w.mcap"), Path::new("")), "w.mcap");
        assert_eq!(relative(Path::new("w.mcap"), Path::new("out")), "../w.mcap");
    }
}
