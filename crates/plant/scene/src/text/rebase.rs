//! Files that a scene names, as seen from another folder.

use geom::shape::with_files;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, TableLike, Value, value};

/// Keys that name a file, by list of tables.
const KEYS: [(&str, &[&str]); 7] = [
    ("wall", &["source", "mesh"]),
    ("clump", &["mesh"]),
    ("particles", &["source"]),
    ("inlet", &["source"]),
    ("fill", &["sizes", "shape"]),
    ("insert", &["sizes", "shape"]),
    ("remove", &["shape"]),
];

/// Shapes that are files.
const SHAPES: [&str; 2] = ["mesh", "prism"];

/// Makes the files that a scene in the folder `from` names right for a scene in the folder `to`.
pub fn rebase(document: &mut DocumentMut, from: &Path, to: &Path) {
    for (table, keys) in KEYS {
        let tables = document.get_mut(table).and_then(Item::as_array_of_tables_mut);
        for entry in tables.into_iter().flat_map(|tables| tables.iter_mut()) {
            for key in keys {
                let Some((item, kind)) = entry.get_mut(key).and_then(|item| file_of(item, key)) else {
                    continue;
                };
                let text = item.as_str().unwrap_or_default();
                *item = value(match kind {
                    Named::File => relative(&from.join(text), to),
                    Named::Shape(head) => {
                        let shape = format!("{head}{text}");
                        with_files(&shape, |file| relative(&from.join(file), to))[head.len()..].to_owned()
                    }
                });
            }
        }
    }
    // Through tables: an item that is asked for a key that it lacks makes one.
    let domain = document.get_mut("domain").and_then(Item::as_table_like_mut);
    if let Some(source) = domain.and_then(|domain| domain.get_mut("source")) {
        *source = value(relative(&from.join(source.as_str().unwrap_or_default()), to));
    }
    paths(document.as_item_mut(), from, to);
}

/// Moves `path.source` wherever it stands: in motions, servos and strains.
fn paths(item: &mut Item, from: &Path, to: &Path) {
    if let Some(tables) = item.as_array_of_tables_mut() {
        tables.iter_mut().for_each(|table| in_table(table, from, to));
    } else if let Some(list) = item.as_array_mut() {
        let inline = list.iter_mut().filter_map(Value::as_inline_table_mut);
        inline.for_each(|table| in_table(table, from, to));
    } else if let Some(table) = item.as_table_like_mut() {
        in_table(table, from, to);
    }
}

fn in_table(table: &mut dyn TableLike, from: &Path, to: &Path) {
    for (key, item) in table.iter_mut() {
        let source = item.as_table_like_mut().and_then(|table| table.get_mut("source"));
        match source.filter(|source| key == "path" && source.is_str()) {
            Some(source) => *source = value(relative(&from.join(source.as_str().unwrap_or_default()), to)),
            None => paths(item, from, to),
        }
    }
}

/// What a text of a scene is.
enum Named {
    /// The name of a file.
    File,
    /// A shape, and what of it stands in a key.
    Shape(String),
}

/// The text that names a file: a text itself, `file` in a table of sizes, a shape as `mesh:FILE` or `{ mesh = FILE }`.
fn file_of<'a>(item: &'a mut Item, key: &str) -> Option<(&'a mut Item, Named)> {
    if item.is_table_like() {
        let inner =
            ["file"].into_iter().chain(SHAPES).find(|name| item.get(name).is_some_and(Item::is_str))?;
        let named = if inner == "file" { Named::File } else { Named::Shape(format!("{inner}:")) };
        return item.get_mut(inner).map(|inner| (inner, named));
    }
    item.as_str()?;
    Some((item, if key == "shape" { Named::Shape(String::new()) } else { Named::File }))
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
    fn files_of_all_kinds_are_seen_from_the_new_folder() {
        let text = "[[fill]]\nshape = \"mesh:a.ply,units=mm,transform=m.txt\"\nsizes = { file = \"s.csv\" }\n[[fill]]\nshape = { mesh = \"c.ply,transform=m.txt\" }\n[[fill]]\nshape = \"box:0,0,0,1,1,1\"\n[[clump]]\nmesh = \"b.ply\"\n";
        let mut document: DocumentMut = text.parse().unwrap();
        rebase(&mut document, Path::new("/lab"), Path::new("/lab/run"));
        let now = text
            .replace("a.ply", "../a.ply")
            .replace("s.csv", "../s.csv")
            .replace("b.ply", "../b.ply")
            .replace("c.ply", "../c.ply")
            .replace("m.txt", "../m.txt");
        assert_eq!(document.to_string(), now);
    }

    #[test]
    fn paths_over_time_are_seen_from_the_new_folder() {
        let mut other: DocumentMut = "[domain]\nperiodic = [\"x\"]\n[[wall]]\nmotion = {}\n".parse().unwrap();
        rebase(&mut other, Path::new("/lab"), Path::new("/lab/run"));
        assert_eq!(other.to_string(), "[domain]\nperiodic = [\"x\"]\n[[wall]]\nmotion = {}\n");
        let text = "[domain]\nsource = \"d.mcap\"\n[domain.strain]\nx = { path = { source = \"s.csv\" } }\n[[wall]]\nservo = { path = { source = \"l.csv\" } }\n\
                    [[wall]]\nmotion = [{ path = { source = \"a.csv\" } }, { translate = [0, 0, 1] }]\n[wall.servo.path]\nsource = \"b.csv\"\n";
        let mut document: DocumentMut = text.parse().unwrap();
        rebase(&mut document, Path::new("/lab"), Path::new("/lab/run"));
        let now = ["d.mcap", "s.csv", "l.csv", "a.csv", "b.csv"]
            .iter()
            .fold(text.to_owned(), |text, file| text.replace(file, &format!("../{file}")));
        assert_eq!(document.to_string(), now);
    }

    #[test]
    fn files_are_seen_from_the_new_folder() {
        assert_eq!(relative(Path::new("/a/b/../c/w.mcap"), Path::new("/a/out")), "../c/w.mcap");
        assert_eq!(relative(Path::new("w.mcap"), Path::new("")), "w.mcap");
        assert_eq!(relative(Path::new("w.mcap"), Path::new("out")), "../w.mcap");
    }
}
