//! The parts of the page that programs write.

use crate::plant::scenes;
use crate::shell::line;
use std::path::Path;

/// What stamps a part: the scene, how long it is run, and the files that it names (pipelines/stages/stamp.sh).
pub const SMALL: &str = "small.toml 0.1 small-hopper.ply small-chute.ply small-box.ply";
/// The same, of the mouths.
pub const MOUTH: &str = "mouth.toml 0.3 mouth-cone.obj mouth-slot.obj";

/// Puts a text between the marks of a part (pipelines/stages/section.sh), after the stamp of its scene; it stays in the folder as NAME.md, too.
///
/// # Errors
/// A page that cannot be read or written, or lacks the marks; a scene that fails.
pub fn put(folder: &Path, page: &Path, (name, scene): (&str, &str), text: &str) -> Result<(), String> {
    let stamp = line(&scenes(), &format!("./stamp.sh {scene}"))?;
    let text = format!("{}\n{}", String::from_utf8_lossy(&stamp), text.trim());
    let told = |path: &Path| {
        let path = path.to_owned();
        move |why: std::io::Error| format!("{}: {why}", path.display())
    };
    let file = folder.join(format!("{name}.md"));
    std::fs::write(&file, text).map_err(told(&file))?;
    let [page, file] = [page, &file].map(|path| path.canonicalize().map_err(told(path)));
    line(&scenes(), &format!("./section.sh '{}' {name} < '{}'", page?.display(), file?.display())).map(|_| ())
}

/// A difference and its interval in one unit; bold where the interval does not include zero.
pub fn difference(mean: f64, interval: f64, unit: &str) -> String {
    let text = format!("{mean:+.1} ± {interval:.1}{unit}");
    if mean.abs() > interval { format!("**{text}**") } else { text }
}

/// A table in Markdown.
pub fn table(columns: &[&str], rows: &[Vec<String>]) -> String {
    let mut text = format!("\n| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()));
    rows.iter().for_each(|row| text += &format!("| {} |\n", row.join(" | ")));
    text
}
