//! A scene with the files that it names, in a form that can be changed key by key and row by row.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::io;
use std::path::Path;
use toml::{Table, Value};

/// A file beside a scene.
#[derive(Debug, Clone, PartialEq)]
pub enum File {
    /// A CSV file: names of columns, and rows.
    Rows(Vec<String>, Vec<Vec<f64>>),
    /// Triangles.
    Mesh(Vec<[f64; 3]>, Vec<[usize; 3]>),
}

impl File {
    fn text(&self) -> String {
        let line = |row: &[f64]| row.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>();
        match self {
            File::Rows(columns, rows) => {
                let rows = rows.iter().map(|row| line(row).join(","));
                std::iter::once(columns.join(","))
                    .chain(rows)
                    .fold(String::new(), |all, row| all + &row + "\n")
            }
            File::Mesh(vertices, triangles) => {
                let mut all = format!(
                    "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
                     element face {}\nproperty list uchar int vertex_indices\nend_header\n",
                    vertices.len(),
                    triangles.len()
                );
                vertices.iter().for_each(|v| all += &format!("{}\n", line(v).join(" ")));
                for [a, b, c] in triangles {
                    let _ = writeln!(all, "3 {a} {b} {c}");
                }
                all
            }
        }
    }

    fn parse(text: &str) -> Option<File> {
        if !text.starts_with("ply") {
            let mut lines = text.lines();
            let columns = lines.next()?.split(',').map(str::to_owned).collect();
            let row = |line: &str| line.split(',').map(|x| x.parse().ok()).collect();
            return Some(File::Rows(columns, lines.map(row).collect::<Option<_>>()?));
        }
        let (head, body) = text.split_once("end_header\n")?;
        let vertices: usize = head.lines().find_map(|l| l.strip_prefix("element vertex "))?.parse().ok()?;
        let numbers = |line: &str| line.split(' ').map(|x| x.parse().ok()).collect::<Option<Vec<f64>>>();
        let points = body.lines().take(vertices).map(|l| numbers(l)?.try_into().ok());
        let triangle =
            |l: &str| <[f64; 3]>::try_from(numbers(l)?.get(1..)?).ok().map(|t| t.map(|k| k as usize));
        let triangles = body.lines().skip(vertices).map(triangle);
        Some(File::Mesh(points.collect::<Option<_>>()?, triangles.collect::<Option<_>>()?))
    }

    /// The column of this name.
    pub fn column(&self, name: &str) -> Option<usize> {
        match self {
            File::Rows(columns, _) => columns.iter().position(|c| c == name),
            File::Mesh(..) => None,
        }
    }
}

/// A scene and its files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scene {
    /// Its keys.
    pub keys: Table,
    /// Its files, by name.
    pub files: BTreeMap<String, File>,
}

impl Scene {
    /// Writes `scene.toml` and the files.
    ///
    /// # Errors
    /// Of the disk.
    pub fn write(&self, folder: &Path, name: &str) -> io::Result<()> {
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join(name), self.keys.to_string())?;
        self.files.iter().try_for_each(|(name, file)| std::fs::write(folder.join(name), file.text()))
    }

    /// Reads what [`Scene::write`] wrote.
    ///
    /// # Errors
    /// Of the disk, and what is no such scene.
    pub fn read(folder: &Path, name: &str) -> io::Result<Scene> {
        let wrong = |e: String| io::Error::new(io::ErrorKind::InvalidData, e);
        let keys =
            toml::from_str(&std::fs::read_to_string(folder.join(name))?).map_err(|e| wrong(e.to_string()))?;
        let mut files = BTreeMap::new();
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let end = path.extension().unwrap_or_default();
            if end == "csv" || end == "ply" {
                let text = std::fs::read_to_string(&path)?;
                let file = File::parse(&text)
                    .ok_or_else(|| wrong(format!("{name} is none of this program's files")))?;
                files.insert(name, file);
            }
        }
        Ok(Scene { keys, files })
    }

    /// The entries of a list of tables.
    pub fn list(&self, name: &str) -> impl Iterator<Item = &Table> {
        self.keys.get(name).and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_table)
    }

    /// The same, to change them.
    pub fn list_mut(&mut self, name: &str) -> impl Iterator<Item = &mut Table> {
        let list = self.keys.get_mut(name).and_then(Value::as_array_mut).into_iter().flatten();
        list.filter_map(Value::as_table_mut)
    }

    /// Adds an entry to a list of tables.
    pub fn push(&mut self, name: &str, entry: Table) {
        let list = self.keys.entry(name).or_insert_with(|| Value::Array(Vec::new()));
        if let Some(list) = list.as_array_mut() {
            list.push(Value::Table(entry));
        }
    }

    /// The value at a dotted path of tables.
    pub fn get(&self, path: &str) -> Option<&Value> {
        let mut parts = path.split('.');
        let first = self.keys.get(parts.next()?);
        parts.fold(first, |at, part| at?.get(part))
    }

    /// A number at a dotted path.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.get(path).and_then(number)
    }

    /// Sets a value in a table of the top level, which is made where it is missing.
    pub fn set(&mut self, table: &str, key: &str, value: impl Into<Value>) {
        let table = self.keys.entry(table).or_insert_with(|| Value::Table(Table::new()));
        if let Some(table) = table.as_table_mut() {
            table.insert(key.to_owned(), value.into());
        }
    }

    /// Whether any contact law has this text as a key or value.
    pub fn has_in_contacts(&self, words: &[&str]) -> bool {
        let has = |table: &Table| {
            table.iter().any(|(key, value)| {
                words.contains(&key.as_str()) || value.as_str().is_some_and(|v| words.contains(&v))
            })
        };
        self.list("contact").any(has)
    }

    /// Whether one of these tables is there.
    pub fn has(&self, tables: &[&str]) -> bool {
        tables.iter().any(|name| self.keys.contains_key(*name))
    }
}

/// A number, written with or without a decimal point.
pub fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

/// A list of numbers.
pub fn numbers(value: &Value) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(number).collect()
}
