//! The book in `docs/`: every page is in its table of contents, and every link leads to a file and a heading that exist.

use grainpipe_tests::tree::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Folders whose pages and sources are looked at.
const FOLDERS: [&str; 9] =
    [".github", "bench", "crates", "docs", "examples", "pipelines", "sample-data", "tests", "tools"];

/// Files below a folder, without what is built, downloaded or written by runs.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && !["target", "out", "build"].contains(&name) {
            files(&path, found);
        } else if path.is_file() {
            found.push(path);
        }
    }
}

/// All files of the repository that have one of these endings.
fn with_endings(endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    FOLDERS.iter().for_each(|folder| files(&root().join(folder), &mut found));
    let top = fs::read_dir(root()).expect("the repository").map(|entry| entry.expect("an entry").path());
    found.extend(top.filter(|path| path.is_file()));
    let fits = |path: &PathBuf| endings.iter().any(|ending| path.to_string_lossy().ends_with(ending));
    found.retain(fits);
    found.sort();
    found
}

/// Pages; the changelog tells of pages that were.
fn pages() -> Vec<PathBuf> {
    let mut pages = with_endings(&[".md"]);
    pages.retain(|path| !path.ends_with("CHANGELOG.md"));
    pages
}

/// The lines of a page outside its blocks of code.
fn prose(text: &str) -> Vec<&str> {
    let mut inside = false;
    let mut outside = |line: &&str| {
        let fence = line.trim_start().starts_with("```");
        inside ^= fence;
        !inside && !fence
    };
    text.lines().filter(|line| outside(line)).collect()
}

/// The targets of the links of a page.
fn links(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for line in prose(text) {
        // Code between backticks links nothing.
        let plain: String = line.split('`').step_by(2).collect();
        let targets = plain.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        found.extend(
            targets
                .filter(|target| !target.contains("://") && !target.starts_with("mailto:"))
                .map(str::to_owned),
        );
    }
    found
}

/// A heading without the targets of its links.
fn without_targets(heading: &str) -> String {
    let mut parts = heading.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once(')').map_or(part, |(_, rest)| rest))
}

/// The anchors of a page's headings, as mdBook and the usual hosts make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut times: BTreeMap<String, usize> = BTreeMap::new();
    let mut anchor = |heading: &str| {
        let words = without_targets(heading).trim().to_lowercase();
        let kept = words.chars().filter(|c| c.is_whitespace() || c.is_alphanumeric() || "-_".contains(*c));
        let name: String = kept.map(|c| if c.is_whitespace() { '-' } else { c }).collect();
        let before = times.entry(name.clone()).or_default();
        *before += 1;
        if *before == 1 { name } else { format!("{name}-{}", *before - 1) }
    };
    let headings = prose(text).into_iter().filter(|line| line.starts_with('#'));
    headings.map(|line| anchor(line.trim_start_matches('#'))).collect()
}

/// A path without `.` and `..`.
fn normal(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(out.pop()),
            Component::CurDir => {}
            part => out.push(part),
        }
    }
    out
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|why| panic!("{}: {why}", path.display()))
}

#[test]
fn every_page_is_in_the_table_of_contents_once() {
    let docs = root().join("docs");
    let listed: Vec<PathBuf> =
        links(&read(&docs.join("SUMMARY.md"))).iter().map(|link| docs.join(link)).collect();
    let once: BTreeSet<PathBuf> = listed.iter().cloned().collect();
    assert_eq!(listed.len(), once.len(), "a page is listed twice");
    let mut there: BTreeSet<PathBuf> = pages().into_iter().filter(|page| page.starts_with(&docs)).collect();
    there.remove(&docs.join("SUMMARY.md"));
    assert!(there.len() > 30, "{there:#?}");
    let differ: Vec<&PathBuf> = there.symmetric_difference(&once).collect();
    assert!(differ.is_empty(), "in docs/SUMMARY.md or in docs, not in both: {differ:#?}");
}

#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for page in pages() {
        let text = read(&page);
        for link in links(&text) {
            seen += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { page.clone() } else { normal(&page.with_file_name(file)) };
            let found = target.exists() && (anchor.is_empty() || anchors(&read(&target)).contains(anchor));
            if !found {
                wrong.push(format!("{}: ({link})", page.strip_prefix(root()).unwrap_or(&page).display()));
            }
        }
    }
    assert!(seen > 300, "{seen} links");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Messages, help texts, comments and rules of make name pages as `docs/….md`.
#[test]
fn every_page_that_a_source_names_exists() {
    let (mut wrong, mut seen) = (Vec::new(), 0);
    for source in with_endings(&[".rs", ".sh", ".toml", ".mk", "Makefile", ".py"]) {
        let text = read(&source);
        // `$docs/…` is a variable of a script.
        let starts = text.match_indices("docs/").filter(|(at, _)| !text[..*at].ends_with('$'));
        for (at, start) in starts {
            let rest = &text[at + start.len()..];
            let ends = |c: char| !c.is_ascii_alphanumeric() && !"-_/.".contains(c);
            let name = rest.split(ends).next().unwrap_or_default();
            let Some((page, _)) = name.split_once(".md") else { continue };
            seen += 1;
            if !page.is_empty() && !root().join(format!("docs/{page}.md")).exists() {
                wrong.push(format!(
                    "{}: docs/{page}.md",
                    source.strip_prefix(root()).unwrap_or(&source).display()
                ));
            }
        }
    }
    assert!(seen > 50, "{seen} names");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A picture that no page shows is left over, or its page has lost it.
#[test]
fn every_picture_is_on_a_page() {
    let shown: BTreeSet<PathBuf> = pages()
        .iter()
        .flat_map(|page| links(&read(page)).into_iter().map(|link| normal(&page.with_file_name(link))))
        .collect();
    let mut pictures = with_endings(&[".png", ".svg", ".gif"]);
    pictures.retain(|path| path.starts_with(root().join("docs")));
    assert!(pictures.len() > 50, "{}", pictures.len());
    let unseen: Vec<&PathBuf> = pictures.iter().filter(|path| !shown.contains(*path)).collect();
    assert!(unseen.is_empty(), "{unseen:#?}");
}
