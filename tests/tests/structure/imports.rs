//! Which file of a package uses which: by the paths that its code names, followed through re-exports.

use grainpipe_tests::tree::sources;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Names from the root of a package: of a module, or of what stands in one.
type Name = Vec<String>;

/// The files of a package, by the names of their modules.
pub struct Package {
    files: BTreeMap<Name, File>,
}

struct File {
    code: String,
    /// What its `pub use` hand on: the name here, and the path that it stands for; none where that is of another package.
    handed_on: Vec<(String, Option<Name>)>,
}

impl Package {
    /// Reads the sources of a package, without its tests.
    pub fn read(source: &Path) -> Package {
        let mut files = BTreeMap::new();
        for path in sources(source) {
            let inside = path.strip_prefix(source).expect("below").with_extension("");
            let mut name: Name = inside.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            if name.iter().any(|part| part == "tests") {
                continue;
            }
            if name.last().is_some_and(|last| last == "mod" || name == ["lib"] || name == ["main"]) {
                name.pop();
            }
            let code = code_of(&fs::read_to_string(&path).expect("text"));
            files.insert(name, File { code, handed_on: Vec::new() });
        }
        let mut package = Package { files };
        let names: Vec<Name> = package.files.keys().cloned().collect();
        for name in names {
            let mut handed_on = Vec::new();
            for path in paths(&package.files[&name].code).into_iter().filter(|path| path.is_handed_on) {
                let to = package.absolute(&name, &path.words);
                handed_on.push((path.called, to));
            }
            package.files.get_mut(&name).expect("it is there").handed_on = handed_on;
        }
        package
    }

    /// A path that code in the module `from` names, from the root; none of other packages and of what is no module.
    fn absolute(&self, from: &Name, words: &[String]) -> Option<Name> {
        let (mut base, mut rest): (Name, &[String]) = match words.first()?.as_str() {
            "crate" => (Vec::new(), &words[1..]),
            "self" => (from.clone(), &words[1..]),
            "super" => (from.clone(), words),
            child => {
                let module = [from.as_slice(), &[child.to_owned()]].concat();
                self.files.contains_key(&module).then_some((from.clone(), words))?
            }
        };
        while rest.first().is_some_and(|word| word == "super") {
            base.pop()?;
            rest = &rest[1..];
        }
        Some([base.as_slice(), rest].concat())
    }

    /// The module in whose file the thing of a name stands.
    fn home(&self, name: &[String], depth: usize) -> Option<Name> {
        let module =
            (0..=name.len()).rev().map(|n| &name[..n]).find(|part| self.files.contains_key(*part))?;
        let Some(item) = name.get(module.len()) else { return Some(module.to_vec()) };
        let is_it = |(called, _): &&(String, Option<Name>)| called == item;
        match self.files[module].handed_on.iter().find(is_it) {
            Some((_, to)) if depth < 8 => self.home(to.as_deref()?, depth + 1),
            _ => Some(module.to_vec()),
        }
    }

    /// What each file uses of the others: their names, and what it calls what it takes from each.
    fn uses(&self) -> BTreeMap<Name, BTreeMap<Name, BTreeSet<String>>> {
        let of = |(name, file): (&Name, &File)| {
            let mut used: BTreeMap<Name, BTreeSet<String>> = BTreeMap::new();
            for path in paths(&file.code).into_iter().filter(|path| !path.is_handed_on) {
                let home = self.absolute(name, &path.words).and_then(|to| self.home(&to, 0));
                if let Some(home) = home.filter(|home| home != name) {
                    used.entry(home).or_default().insert(path.called);
                }
            }
            (name.clone(), used)
        };
        self.files.iter().map(of).collect()
    }

    /// What ties the files of a ring, a line each.
    pub fn ties(&self, ring: &[Name]) -> Vec<String> {
        let uses = self.uses();
        let of = |from: &Name| {
            let used = uses[from].iter().filter(|(to, _)| ring.contains(to));
            let line = |(to, what): (&Name, &BTreeSet<String>)| {
                let what = what.iter().cloned().collect::<Vec<_>>().join(", ");
                format!("    {} -> {}: {what}", from.join("/"), to.join("/"))
            };
            used.map(line).collect::<Vec<_>>()
        };
        ring.iter().flat_map(of).collect()
    }

    /// Files that use each other in a ring, each ring once.
    pub fn circles(&self) -> Vec<Vec<Name>> {
        let uses = self.uses();
        let reach = |from: &Name| {
            let (mut found, mut open) = (BTreeSet::new(), vec![from.clone()]);
            while let Some(name) = open.pop() {
                for next in uses.get(&name).into_iter().flat_map(BTreeMap::keys) {
                    if found.insert(next.clone()) {
                        open.push(next.clone());
                    }
                }
            }
            found
        };
        let reached: BTreeMap<&Name, BTreeSet<Name>> = uses.keys().map(|name| (name, reach(name))).collect();
        let mut rings = BTreeSet::new();
        for (name, of_name) in &reached {
            let ring: Vec<Name> = of_name
                .iter()
                .filter(|other| reached.get(other).is_some_and(|of| of.contains(*name)))
                .cloned()
                .collect();
            if ring.len() > 1 {
                rings.insert(ring);
            }
        }
        rings.into_iter().collect()
    }
}

/// A path in code.
struct Named {
    words: Name,
    /// What the file calls it.
    called: String,
    /// Whether a `pub use` names it.
    is_handed_on: bool,
}

/// Code without comments, texts and what is for tests.
fn code_of(text: &str) -> String {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    // The visibility of an item is not a use.
    let text = lines.collect::<Vec<_>>().join("\n").replace("pub(in crate::", "pub(in ");
    // Every second piece between quotes is a text; escaped quotes do not name paths.
    text.split('"').step_by(2).collect::<Vec<_>>().join("\"\"")
}

/// All paths of more than one word.
fn paths(code: &str) -> Vec<Named> {
    let mut found = Vec::new();
    let bytes = code.as_bytes();
    let is_word = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
    let mut at = 0;
    while at < bytes.len() {
        let starts = is_word(bytes[at]) && !bytes[at].is_ascii_digit();
        if !starts {
            at += 1;
            continue;
        }
        let end = (at..bytes.len()).find(|&k| !is_word(bytes[k])).unwrap_or(bytes.len());
        let follows = at >= 2 && &bytes[at - 2..at] == b"::";
        if !follows && code[end..].starts_with("::") {
            let statement = code[..at].rsplit([';', '}']).next().unwrap_or_default().trim_start();
            let is_handed_on = statement.starts_with("pub") && statement.trim_end().ends_with("use");
            at += tree(&code[at..], &[], is_handed_on, &mut found);
        } else {
            at = end;
        }
    }
    found
}

/// Adds the paths of a tree of names after `before`; how many bytes it takes.
fn tree(code: &str, before: &[String], is_handed_on: bool, found: &mut Vec<Named>) -> usize {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let (mut words, mut at) = (before.to_vec(), 0);
    loop {
        let rest = &code[at..];
        if rest.starts_with('{') {
            at += 1;
            loop {
                at += code[at..].len() - code[at..].trim_start_matches([' ', '\n', ',']).len();
                if at >= code.len() || code[at..].starts_with('}') {
                    return (at + 1).min(code.len());
                }
                let taken = tree(&code[at..], &words, is_handed_on, found);
                at += taken.max(1);
            }
        }
        let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        if end == 0 {
            // A star or a generic argument ends the path.
            at += usize::from(rest.starts_with('*'));
            break;
        }
        words.push(rest[..end].to_owned());
        at += end;
        if !code[at..].starts_with("::") {
            break;
        }
        at += 2;
    }
    let mut called = words.last().cloned().unwrap_or_default();
    if let Some(rest) = code[at..].strip_prefix(" as ") {
        let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        called = rest[..end].to_owned();
        at += 4 + end;
    }
    if called == "self" {
        words.pop();
        called = words.last().cloned().unwrap_or_default();
    }
    found.push(Named { words, called, is_handed_on });
    at
}
