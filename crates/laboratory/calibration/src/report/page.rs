//! The page of a calibration: one HTML file without outside parts.

use crate::recipe::{Recipe, shown};
use crate::report::explained;
use crate::report::judge::Judged;
use crate::words;
use std::fmt::Write as _;

const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;max-width:1120px;margin:2em auto;padding:0 1em;color:#222}\
    table{border-collapse:collapse;margin:1em 0}td,th{border-bottom:1px solid #ccc;padding:.25em .8em;text-align:left}\
    code{background:#f2f2f2;padding:0 .2em;overflow-wrap:anywhere}svg{max-width:100%;height:auto}.warn{color:#a33}";

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The page; `picture` is SVG.
pub fn html(recipe: &Recipe, judged: &Judged, picture: &str) -> String {
    let title = format!("Calibration: {}", escaped(&recipe.name));
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>{title}</title><style>{STYLE}</style><h1>{title}</h1>"
    );
    if let Some(line) = words::headline(judged) {
        let _ = write!(page, "<p class=\"warn\"><strong>{}</strong></p>", escaped(&line));
    }
    page += &tables(judged);
    page += "<ul>";
    for warning in words::warnings(judged) {
        let _ = write!(page, "<li class=\"warn\">{}</li>", escaped(&warning));
    }
    for line in words::sentences(judged).iter().skip(judged.findings.len()) {
        let _ = write!(page, "<li>{}</li>", escaped(line));
    }
    page += "</ul>";
    // The head of an SVG file has no place inside a page.
    page += picture.find("<svg").map_or("", |k| &picture[k..]);
    page += "<h2>Tests</h2><table><tr><th>test</th><th>data</th><th>deviation from</th><th>command</th></tr>";
    for test in &recipe.tests {
        let (points, origin) =
            test.target.as_ref().map_or((0, "–".to_owned()), |t| (t.points.len(), t.origin.clone()));
        let _ = write!(
            page,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td><code>{}</code></td></tr>",
            escaped(&test.name),
            geom::counted(points, "point"),
            escaped(&origin),
            escaped(&test.command)
        );
    }
    page += "</table><h2>Priors</h2><table><tr><th>parameter</th><th>bounds</th><th>source</th></tr>";
    for p in &recipe.parameters {
        let source = p.source.as_deref().unwrap_or("the recipe");
        let _ = write!(
            page,
            "<tr><td>{}</td><td>{} to {}{}</td><td>{}</td></tr>",
            escaped(&p.name),
            shown(p.low),
            shown(p.high),
            escaped(&p.unit_suffix()),
            escaped(source)
        );
    }
    page += "</table><h2>Columns</h2><p>Columns of the table that <code>-o</code> writes; those above are the same.</p><table><tr><th>column</th><th>meaning</th></tr>";
    for (name, means) in explained::columns() {
        let _ = write!(page, "<tr><td><code>{name}</code></td><td>{}</td></tr>", escaped(means));
    }
    page + "</table></html>\n"
}

/// The tables of the Markdown.
fn tables(judged: &Judged) -> String {
    let markdown = words::markdown(judged);
    let mut page = String::new();
    for lines in markdown.split("\n\n").filter(|block| block.starts_with('|')) {
        page += "<table>";
        for (k, line) in lines.lines().enumerate().filter(|(k, _)| *k != 1) {
            let cells = line.trim_matches('|').split('|').map(str::trim);
            let tag = if k == 0 { "th" } else { "td" };
            let row: String = cells.map(|c| format!("<{tag}>{}</{tag}>", escaped(c))).collect();
            let _ = write!(page, "<tr>{row}</tr>");
        }
        page += "</table>";
    }
    page
}
