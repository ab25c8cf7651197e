//! Files of poses.

use anyhow::Context;
use photos::poses::{Pose, colmap, matrix, table};
use std::path::Path;

/// Reads a table, COLMAP's folder, or a folder with one matrix for each photograph (NAME.txt or NAME_P.txt).
pub fn read(path: &Path) -> anyhow::Result<Vec<Pose>> {
    let text =
        |path: &Path| stream::whole::text(path).with_context(|| format!("cannot read {}", path.display()));
    if !path.is_dir() {
        return Ok(table(&text(path)?)?);
    }
    let (cameras, images) = (path.join("cameras.txt"), path.join("images.txt"));
    if cameras.is_file() && images.is_file() {
        return Ok(colmap(&text(&cameras)?, &text(&images)?)?);
    }
    let mut poses = Vec::new();
    for entry in std::fs::read_dir(path)? {
        let file = entry?.path();
        if file.extension().is_some_and(|e| e == "txt") {
            let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let name = stem.strip_suffix("_P").unwrap_or(&stem);
            poses.push(matrix(name, &text(&file)?).with_context(|| file.display().to_string())?);
        }
    }
    poses.sort_by(|a, b| a.name.cmp(&b.name));
    if poses.is_empty() {
        anyhow::bail!(
            "has neither cameras.txt and images.txt nor NAME.txt with a matrix for each photograph"
        );
    }
    Ok(poses)
}
