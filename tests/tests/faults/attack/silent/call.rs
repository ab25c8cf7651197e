//! A call of a tool, taken apart.

use super::super::options::flags;
use std::collections::BTreeMap;
use std::fmt::{Display, Formatter};

/// A call of a tool: what it reads, and its options.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Call {
    /// The tool.
    pub tool: String,
    /// What is no option.
    pub reads: Vec<String>,
    /// Options with their values.
    pub options: Vec<(String, Option<String>)>,
}

impl Display for Call {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.tool, self.words().join(" "))
    }
}

/// Options of each tool that take a value.
pub struct Grammar(BTreeMap<String, Vec<String>>);

impl Grammar {
    /// Of some tools, from their help.
    pub fn of(tools: impl IntoIterator<Item = String>) -> Grammar {
        let valued = |tool: &String| {
            let named = flags(tool).into_iter().filter(|f| f.takes_value).map(|f| f.name);
            named.chain(["-o", "--output", "--report", "--threads", "--color"].map(str::to_owned)).collect()
        };
        Grammar(tools.into_iter().map(|tool| (tool.clone(), valued(&tool))).collect())
    }

    /// A command line, taken apart.
    pub fn parse(&self, line: &str) -> Call {
        let mut words = split(line).into_iter();
        let tool = words.next().unwrap_or_default();
        let valued = self.0.get(&tool).map_or(&[][..], Vec::as_slice);
        let mut call = Call { tool, reads: Vec::new(), options: Vec::new() };
        while let Some(word) = words.next() {
            match (word.starts_with('-') && word.len() > 1, valued.contains(&word)) {
                (true, true) => call.options.push((word, words.next())),
                (true, false) => call.options.push((word, None)),
                _ => call.reads.push(word),
            }
        }
        call
    }
}

impl Call {
    /// Its arguments.
    pub fn words(&self) -> Vec<String> {
        let options = self.options.iter().flat_map(|(name, value)| [Some(name.clone()), value.clone()]);
        self.reads.iter().cloned().chain(options.flatten()).collect()
    }

    /// The same with one more option.
    pub fn with(&self, name: &str, value: Option<&str>) -> Call {
        let mut more = self.clone();
        more.options.push((name.to_owned(), value.map(str::to_owned)));
        more
    }

    /// Whether it has an option.
    pub fn has(&self, name: &str) -> bool {
        self.options.iter().any(|o| o.0 == name)
    }

    /// The value of an option.
    pub fn value(&self, name: &str) -> Option<&str> {
        self.options.iter().find(|o| o.0 == name).and_then(|o| o.1.as_deref())
    }
}

/// Words of a line; single quotes hold words together.
fn split(line: &str) -> Vec<String> {
    let (mut words, mut quoted, mut word) = (Vec::new(), false, String::new());
    for c in line.chars().chain([' ']) {
        match c {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.extend((!word.is_empty()).then(|| std::mem::take(&mut word))),
            c => word.push(c),
        }
    }
    words
}
