//! The parts of the page that programs write.

use crate::plant::scenes;
use crate::shell::line;
use std::path::Path;

/// Puts a text between the marks of a part (pipelines/stages/section.sh); it stays in the folder as NAME.md, too.
///
/// # Errors
/// A page that cannot be read or written, or lacks the marks.
pub fn put(folder: &Path, page: &Path, name: &str, text: &str) -> Result<(), String> {
    let told = |path: &Path| {
        let path = path.to_owned();
        move |why: std::io::Error| format!("{}: {why}", path.display())
    };
    let file = folder.join(format!("{name}.md"));
    std::fs::write(&file, text.trim()).map_err(told(&file))?;
    let [page, file] = [page, &file].map(|path| path.canonicalize().map_err(told(path)));
    line(&scenes(), &format!("./section.sh '{}' {name} < '{}'", page?.display(), file?.display())).map(|_| ())
}

/// A table in Markdown.
pub fn table(columns: &[&str], rows: &[Vec<String>]) -> String {
    let mut text = format!("\n| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()));
    rows.iter().for_each(|row| text += &format!("| {} |\n", row.join(" | ")));
    text
}
