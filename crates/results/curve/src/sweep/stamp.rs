//! What a point is made from, as a hash: a point that is made from the same is not run again.

use super::script::SweepRun;
use crate::study::CurveError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Value;

/// Hashes of files, each read once.
#[derive(Default)]
pub(super) struct Hashes(BTreeMap<PathBuf, String>);

impl Hashes {
    /// SHA-256 of a file.
    fn of(&mut self, path: &Path) -> Result<String, CurveError> {
        if let Some(known) = self.0.get(path) {
            return Ok(known.clone());
        }
        let bytes = stream::whole::file(path)
            .map_err(CurveError::io(format!("{}: cannot read it", path.display())))?;
        let hash = stream::sha256(&bytes);
        self.0.insert(path.to_owned(), hash.clone());
        Ok(hash)
    }

    /// Hashes of those of some words that are files in one of the folders.
    fn of_words<'a>(
        &mut self,
        words: impl Iterator<Item = &'a str>,
        folders: &[&Path],
    ) -> Result<String, CurveError> {
        let mut all = String::new();
        for word in words {
            let paths = folders.iter().map(|folder| folder.join(word));
            if let Some(path) = paths.into_iter().find(|path| path.is_file()) {
                all += &self.of(&path)?;
            }
        }
        Ok(all)
    }
}

/// SHA-256 of everything that a point is made from: the scene with its changes, the files that it and the lines name, the
/// programs, the line before.
pub(super) fn stamp(
    job: &SweepRun,
    text: &str,
    tools: &Path,
    hashes: &mut Hashes,
) -> Result<String, CurveError> {
    let words = words(&table(&job.scene, text)?);
    let named = words.iter().map(String::as_str);
    let folder = Path::new(&job.scene).parent().unwrap_or(Path::new("")).to_owned();
    let program = tools.join("dem-run");
    let missing = || format!("{}: not found: install dem-run beside cost-curve", program.display());
    let program = hashes.of(&program).map_err(|_| CurveError::Failed(missing()))?;
    let mut all = vec![program, stream::sha256(text.as_bytes()), hashes.of_words(named, &[&folder])?];
    for input in &job.inputs {
        all.push(hashes.of(Path::new(input))?);
    }
    let line = job.each.clone().unwrap_or_default();
    let named = stream::words(&line);
    all.push(hashes.of_words(named.iter().map(String::as_str), &[Path::new(""), tools])?);
    all.extend([line, job.threads.clone()]);
    Ok(stream::sha256(all.join("\n").as_bytes()))
}

/// Every text in a scene, of a shape the files that it names.
fn words(value: &Value) -> Vec<String> {
    match value {
        Value::String(text) => match geom::shape::files_of(text) {
            files if files.is_empty() => vec![text.clone()],
            files => files.into_iter().map(str::to_owned).collect(),
        },
        Value::Array(list) => list.iter().flat_map(words).collect(),
        // A shape may be `{ mesh = "FILE" }`.
        Value::Table(table) => table
            .iter()
            .flat_map(|(key, value)| match value {
                Value::String(text) if matches!(key.as_str(), "mesh" | "prism") => {
                    words(&Value::String(format!("{key}:{text}")))
                }
                value => words(value),
            })
            .collect(),
        _ => Vec::new(),
    }
}

pub(super) fn table(file: &str, text: &str) -> Result<Value, CurveError> {
    text.parse().map(Value::Table).map_err(|e: toml::de::Error| CurveError::Failed(format!("{file}: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_by_keys_and_by_shapes() {
        let scene = "[[wall]]\nmesh = \"a.ply\"\n[[fill]]\nshape = \"mesh:b.ply,units=mm\"\n[domain]\noutside = [\"!prism:c.csv\"]\n";
        let mut words = words(&Value::Table(scene.parse().unwrap()));
        words.sort();
        assert_eq!(words, ["a.ply", "b.ply", "c.csv"]);
    }
}
