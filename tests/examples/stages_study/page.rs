//! The parts of the page that programs write: each stands between `<!-- begin NAME -->` and `<!-- end NAME -->`.

use std::path::Path;

/// Puts a text between the marks of a part.
///
/// # Errors
/// A page that cannot be read or written, or lacks the marks.
pub fn put(page: &Path, name: &str, text: &str) -> Result<(), String> {
    let told = |why: std::io::Error| format!("{}: {why}", page.display());
    let old = std::fs::read_to_string(page).map_err(told)?;
    let [begin, end] = ["begin", "end"].map(|word| format!("<!-- {word} {name} -->"));
    let (Some(from), Some(to)) = (old.find(&begin), old.find(&end)) else {
        return Err(format!(
            "{}: has no '{begin}' … '{end}': put them where the part belongs",
            page.display()
        ));
    };
    let new = format!("{}\n{}\n{}", &old[..from + begin.len()], text.trim_end(), &old[to..]);
    std::fs::write(page, new).map_err(told)
}

/// A table in Markdown.
pub fn table(columns: &[&str], rows: &[Vec<String>]) -> String {
    let mut text = format!("\n| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()));
    rows.iter().for_each(|row| text += &format!("| {} |\n", row.join(" | ")));
    text
}
