//! The page, its tables and its pictures.

use crate::picture::{Panel, draw};
use std::path::{Path, PathBuf};

const HEAD: &str = r#"# Walls of spheres

What spacing, roughness and sampling do to wall friction, rebound, flow and leaks. Nearly all walls here are flat: whether the centres or the surfaces of their spheres are on the points
([wall-input.md](../reference/wall-input.md#which-side-is-the-flow)) moves them as a whole and changes no number.

```sh
make -C pipelines walls-study      # runs every simulation of this page and writes the page
```

The tables are also in `pipelines/out/walls/`. The tests `tests/tests/sphere_walls` are short versions of the studies, with limits.

| symbol | meaning |
|---|---|
| P | spacing: one wall sphere for each P² of surface |
| ζ | roughness |
| R | radius of the wall spheres, by equation (1) |
| d = 2r | diameter of the smallest grain |
| ± | 95 % interval of the mean |

## What to choose

"#;

/// What is written when all is known.
pub struct Page {
    folder: PathBuf,
    file: PathBuf,
    advice: Vec<String>,
    text: String,
}

impl Page {
    /// An empty page.
    pub fn new(folder: &Path, file: &Path) -> Page {
        Page { folder: folder.to_owned(), file: file.to_owned(), advice: Vec::new(), text: String::new() }
    }

    /// A line of the advice at the top.
    pub fn advise(&mut self, line: String) {
        self.advice.push(line);
    }

    /// A heading.
    pub fn head(&mut self, title: &str) {
        self.text += &format!("\n## {title}\n");
    }

    /// A paragraph.
    pub fn say(&mut self, words: &str) {
        self.text += &format!("\n{words}\n");
    }

    /// A table, on the page and as NAME.csv.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn table(&mut self, name: &str, columns: &[&str], rows: &[Vec<String>]) -> Result<(), String> {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let head: Vec<String> = columns.iter().map(|c| (*c).to_owned()).collect();
        self.text += &format!("\n{}|{}\n", line(&head), "---|".repeat(columns.len()));
        rows.iter().for_each(|row| self.text += &line(row));
        self.csv(name, columns, rows)
    }

    /// A table as NAME.csv only.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn csv(&self, name: &str, columns: &[&str], rows: &[Vec<String>]) -> Result<(), String> {
        let quoted = |cell: &str| if cell.contains(',') { format!("\"{cell}\"") } else { cell.to_owned() };
        let mut csv = columns.iter().map(|c| quoted(c)).collect::<Vec<String>>().join(",") + "\n";
        for row in rows {
            csv += &(row.iter().map(|c| quoted(c)).collect::<Vec<String>>().join(",") + "\n");
        }
        save(&self.folder.join(format!("{name}.csv")), csv.as_bytes())
    }

    /// A picture of panels beside the page, `columns` side by side; as PNG in the folder, too.
    ///
    /// # Errors
    /// What cannot be drawn or written.
    pub fn picture(
        &mut self,
        name: &str,
        says: &str,
        columns: usize,
        panels: &[Panel],
    ) -> Result<(), String> {
        let svg = format!("walls-{name}.svg");
        save(&self.file.with_file_name(&svg), &draw(&svg, columns, panels)?)?;
        let png = format!("{name}.png");
        save(&self.folder.join(&png), &draw(&png, columns, panels)?)?;
        self.text += &format!("\n![{says}]({svg})\n");
        Ok(())
    }

    /// Writes it.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self) -> Result<(), String> {
        let mut out = String::from(HEAD);
        for line in &self.advice {
            out += &format!("- {line}\n");
        }
        save(&self.file, (out + &self.text).as_bytes())
    }
}

fn save(file: &Path, bytes: &[u8]) -> Result<(), String> {
    std::fs::write(file, bytes).map_err(|why| format!("{}: {why}", file.display()))
}
