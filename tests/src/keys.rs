//! The keys of scenes, as the tables of docs/reference/scene.md list them. A test compares the page with what the code knows.

/// A row of the page: where the key stands (`wall.motion`), its name, its type, and its unit.
#[derive(Debug, Clone)]
pub struct Documented {
    /// The table that it stands in; "" for the top level.
    pub table: String,
    /// Its name; `sliding_friction.static` for a key of an inline table.
    pub key: String,
    /// Type, as the page has it.
    pub kind: String,
    /// Unit; "" or "–" for none.
    pub unit: String,
}

impl Documented {
    /// Table and name with a dot between them.
    pub fn path(&self) -> String {
        format!("{}.{}", self.table, self.key).trim_start_matches('.').to_owned()
    }
}

/// The path of the table that a heading, or the first cell of a table, names.
fn named(text: &str) -> Option<String> {
    match text {
        "Top level" => Some(String::new()),
        "Contacts" => Some("contact".to_owned()),
        "Bonds" => Some("bond".to_owned()),
        "`strain.x`" => Some("domain.strain.x".to_owned()),
        "`motion`" | "`servo`" | "`spring`" => Some(format!("wall.{}", text.trim_matches('`'))),
        _ => text.strip_prefix("`[").map(|name| name.trim_matches(['[', ']', '`']).to_owned()),
    }
}

/// The rows of the tables of keys.
///
/// # Panics
/// When the page cannot be read.
pub fn documented() -> Vec<Documented> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/reference/scene.md");
    let text = std::fs::read_to_string(path).expect("the page");
    let (mut heading, mut table, mut head, mut rows) = (None, None, Vec::new(), Vec::new());
    for row in text.lines() {
        if let Some(title) = row.strip_prefix("## ") {
            heading = named(title);
        }
        // An empty cell has one blank on the page.
        let row = &row.replace("| |", "|  |");
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        match cells[0] {
            _ if !row.starts_with("| ") => table = table.filter(|_| row.starts_with('|')),
            "key" => table = heading.clone(),
            first if first.starts_with("key of ") => table = named(&first["key of ".len()..]),
            key => {
                let Some(table) = table.clone() else { continue };
                let cell = |column: &str| {
                    let at = head.iter().position(|name: &String| name == column);
                    at.and_then(|at| cells.get(at)).copied().unwrap_or_default().to_owned()
                };
                // The table of contacts has "values" for the type.
                let kind = if head.iter().any(|name| name == "type") { cell("type") } else { cell("values") };
                rows.push(Documented {
                    table,
                    key: key.trim_matches('`').to_owned(),
                    kind,
                    unit: cell("unit"),
                });
                continue;
            }
        }
        if row.starts_with("| ") {
            head = cells.iter().map(|cell| (*cell).to_owned()).collect();
        }
    }
    rows
}
