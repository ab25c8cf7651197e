//! Pages that say what the code says: tables and texts that the code prints.

use grainpipe_tests::tools::succeed;
use grainpipe_tests::tree::{packages, root};
use scene::keys::sections;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::{env, fs};

/// Compares the part of a page behind the line `<!-- printed from OF -->` with what is wanted there; GRAINPIPE_WRITE_DOCS=1 writes it.
fn compare(page: &str, of: &str, wanted: &str) {
    let path = root().join(page);
    let marks = [format!("<!-- printed from {of} -->\n"), "<!-- until here -->\n".to_owned()];
    let text = fs::read_to_string(&path).expect("the page is there");
    let (before, rest) = text.split_once(&marks[0]).expect("the first mark");
    let (printed, after) = rest.split_once(&marks[1]).expect("the second mark");
    if env::var_os("GRAINPIPE_WRITE_DOCS").is_some() {
        fs::write(&path, [before, &marks[0], wanted, &marks[1], after].concat())
            .expect("the page can be written");
    } else {
        assert!(printed == wanted, "{page} is behind: run this test with GRAINPIPE_WRITE_DOCS=1\n{wanted}");
    }
}

/// docs/reference/scene.md has every key as the code declares it, and the effects of contacts as the engine describes them.
#[test]
fn the_page_on_scenes_has_every_effect_and_key() {
    let page = "docs/reference/scene.md";
    compare(page, "the effects' descriptions", &dem::effects::table());
    for section in sections() {
        let of = if section.path.is_empty() { "the top level" } else { &section.path };
        compare(page, &format!("the keys of {of}"), &section.markdown());
    }
    compare(page, "the smallest accuracies", &scene::plan::smallest_accuracies());
    compare(page, "the sizes of numbers", &scene::keys::sizes());
}

/// Files of the engine whose heads hold the laws of contacts, and what the laws are called.
const LAWS: [(&str, &str); 12] = [
    ("hooke", "Hooke"),
    ("hooke_direct", "Hooke with a modulus or a dashpot"),
    ("hertz", "Hertz"),
    ("damping", "Damping ratio"),
    ("jkr", "JKR"),
    ("walton_braun", "Walton and Braun"),
    ("cohesion", "Cohesion"),
    ("sliding_friction", "Sliding friction"),
    ("weakening", "Weakening friction"),
    ("rolling_resistance", "Rolling resistance"),
    ("constant_rolling", "Constant rolling resistance"),
    ("twisting_resistance", "Twisting resistance"),
];

/// docs/theory/contact-laws.md has the equations, sources and deviations that stand at the head of each law.
#[test]
fn the_page_on_contact_laws_has_the_head_of_each() {
    let mut page = String::new();
    for (name, title) in LAWS {
        let file = root().join(format!("crates/engine/laws/src/effects/{name}.rs"));
        let text = fs::read_to_string(file).expect("a law");
        let head = text.lines().map_while(|line| line.strip_prefix("//!"));
        write!(page, "\n## {title}\n\n").expect("text");
        for line in head {
            // Links to items of the code are plain names here.
            let line = line.strip_prefix(' ').unwrap_or(line).replace("[`", "`").replace("`]", "`");
            writeln!(page, "{}", line.replace("super::", "").replace("crate::", "")).expect("text");
        }
    }
    compare("docs/theory/contact-laws.md", "the heads of the laws", &(page + "\n"));
}

/// A number of the table of materials, a large one with its power of ten.
fn number(value: &toml::Value) -> String {
    match value {
        toml::Value::Float(x) if x.abs() >= 1e5 => format!("{x:e}"),
        other => other.to_string(),
    }
}

/// docs/reference/materials.md has the table of materials, with a source for each range.
#[test]
fn the_page_on_materials_has_the_table() {
    let text = fs::read_to_string(root().join("crates/plant/scene/src/materials.toml")).expect("the table");
    let table: toml::Table = text.parse().expect("TOML");
    let list = |value: &toml::Value| value.as_array().cloned().unwrap_or_default();
    let text =
        |value: Option<&toml::Value>| value.and_then(toml::Value::as_str).unwrap_or_default().to_owned();
    let mut page = String::new();
    for material in list(&table["material"]) {
        write!(page, "\n## {}\n\n", text(material.get("name"))).expect("text");
        let others: Vec<String> =
            material.get("also").map(list).unwrap_or_default().iter().map(|o| text(Some(o))).collect();
        if !others.is_empty() {
            write!(page, "Also: {}.\n\n", others.join(", ")).expect("text");
        }
        page += "| key | from | to | source | note |\n|---|---|---|---|---|\n";
        for (key, entry) in material.as_table().expect("a table").iter().filter(|(_, entry)| entry.is_table())
        {
            let range: Vec<String> = list(&entry["range"]).iter().map(number).collect();
            let (source, note) = (text(entry.get("source")), text(entry.get("note")));
            writeln!(page, "| `{key}` | {} | {source} | {note} |", range.join(" | ")).expect("text");
        }
    }
    page += "\n## Sources\n\n| name | source |\n|---|---|\n";
    for (name, source) in table["source"].as_table().expect("sources") {
        writeln!(page, "| {name} | {} |", text(Some(source))).expect("text");
    }
    compare("docs/reference/materials.md", "the table of materials", &(page + "\n"));
}

/// One row of the table of options.
fn row(argument: &Value) -> String {
    let word = |key: &str| argument[key].as_str().unwrap_or_default().to_owned();
    let words = |key: &str| {
        let all = argument[key].as_array().into_iter().flatten().filter_map(Value::as_str);
        all.map(str::to_owned).collect::<Vec<_>>()
    };
    let value = words("value_names").join(" ");
    let name = match (word("short"), word("long")) {
        (_, long) if long.is_empty() => format!("`{value}`"),
        (short, long) if short.is_empty() => format!("`--{long}`"),
        (short, long) => format!("`-{short}`, `--{long}`"),
    };
    let value = if word("long").is_empty() || argument["takes_value"] != true {
        String::new()
    } else {
        format!("`{value}`")
    };
    let plain =
        |text: String| text.replace('|', "\\|").replace('<', "&lt;").replace('*', "\\*").replace('\n', " ");
    let names =
        argument["values"].as_array().into_iter().flatten().filter_map(|value| value["name"].as_str());
    let values: Vec<&str> = names.collect();
    let values = if values.is_empty() { String::new() } else { format!(": {}", values.join(", ")) };
    let defaults = words("defaults").join(" ");
    format!(
        "| {name} | {} | {} | {}{} |\n",
        plain(value),
        plain(defaults),
        plain(word("help")),
        plain(values)
    )
}

/// docs/reference/options.md has every option of every tool as the tools describe them.
#[test]
fn the_page_on_options_has_every_option() {
    let mut tools: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in packages("tools") {
        let name = package.rsplit('/').next().expect("a name");
        let done = succeed(&root(), name, &["--describe-arguments"]);
        let described: Value = serde_json::from_slice(&done.stdout).expect("JSON");
        let rows = described["arguments"].as_array().expect("arguments").iter().map(row).collect();
        let about = described["about"].as_str().unwrap_or_default().to_owned();
        tools.insert(format!("\n## {name}\n\n{about}.\n"), rows);
    }
    let head = "\n| option | value | default | meaning |\n|---|---|---|---|\n";
    let first = tools.values().next().expect("a tool").clone();
    let of_all: Vec<String> =
        first.into_iter().filter(|row| tools.values().all(|rows| rows.contains(row))).collect();
    let mut page = format!("\n## Options of every tool\n{head}{}", of_all.concat());
    for (title, rows) in &tools {
        let own: String = rows.iter().filter(|row| !of_all.contains(row)).map(String::as_str).collect();
        page += &format!("{title}{head}{own}");
    }
    compare("docs/reference/options.md", "the tools' descriptions", &(page + "\n"));
}
