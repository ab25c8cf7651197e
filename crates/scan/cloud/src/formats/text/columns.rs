//! Columns of text: the names that a line gives them, and which of them are coordinates.

use super::names::{for_ply, length_units, without_unit};
use super::words::{Separator, pieces, separator, split};
use crate::points::LengthUnit;

/// Names of the axes, in lower case, without a unit; later ones count where none of the earlier ones is there.
const AXES: [[&[&str]; 3]; 3] = [
    [&["x"], &["y"], &["z"]],
    [
        &["easting", "east", "points:0", "x_coordinate", "x coordinate", "coord_x"],
        &["northing", "north", "points:1", "y_coordinate", "y coordinate", "coord_y"],
        &[
            "height",
            "elevation",
            "elev",
            "altitude",
            "up",
            "points:2",
            "z_coordinate",
            "z coordinate",
            "coord_z",
        ],
    ],
    // Letters, which stand for something else elsewhere: only together.
    [&["e"], &["n"], &["h", "u"]],
];
/// Which of these names are letters.
const LETTERS: usize = 2;
/// A line of names.
pub(crate) struct Header {
    pub(crate) text: String,
    /// Its number in the file, from 1.
    pub(crate) line: usize,
    /// Whether it stands behind a mark of a comment, and may be one.
    pub(crate) is_comment: bool,
    /// Whether it may be a sentence: its words are names if there are as many as columns.
    is_loose: bool,
    splits: Vec<Split>,
}

/// How one line of names can be read.
struct Split {
    separator: Separator,
    names: Vec<String>,
    /// Which columns are x, y and z, or why that is not clear.
    axes: Result<[usize; 3], String>,
}

/// Names of columns.
pub(crate) struct Named {
    /// As PLY can hold them; empty for a column without a name.
    pub(crate) names: Vec<String>,
    /// Which columns are x, y and z.
    pub(crate) axes: [usize; 3],
    /// Whether tabs separate them.
    pub(crate) by_tabs: bool,
    /// The units of length that the names of x, y and z give.
    pub(crate) length: Option<[LengthUnit; 3]>,
}

impl Header {
    /// A line that names x, y and z, as other programs do or, if given, by these names.
    pub(crate) fn new(
        text: &str,
        line: usize,
        is_comment: bool,
        chosen: Option<&[String; 3]>,
    ) -> Option<Header> {
        let strict = [';', ',', '\t'].into_iter().filter(|&s| text.contains(s)).map(Some);
        // "Columns: x y z"
        let label = text.split_once(": ").filter(|_| is_comment).map(|(_, names)| names);
        let splits = strict.chain([None]).filter_map(|separator| {
            let bare = label.filter(|_| separator.is_none()).unwrap_or(text);
            let names = split(bare, separator);
            let axes = match chosen {
                Some(chosen) => Ok(named(&names, chosen)?),
                None => axes(&names).transpose()?,
            };
            Some(Split { separator, names, axes })
        });
        let splits: Vec<Split> = splits.collect();
        // A sentence may hold these words anywhere.
        let is_sentence = |s: &Split| s.separator.is_none() && (label.is_some() || s.axes != Ok([0, 1, 2]));
        let is_loose = is_comment && chosen.is_none() && splits.iter().all(is_sentence);
        (!splits.is_empty()).then(|| Header { text: text.to_owned(), line, is_comment, is_loose, splits })
    }

    /// Whether its words, if they are names after all, put x, y and z elsewhere than first.
    pub(crate) fn is_in_doubt(&self) -> bool {
        self.is_loose && self.splits.iter().any(|split| split.axes != Ok([0, 1, 2]))
    }

    /// How many words it has, if blanks separate them.
    pub(crate) fn words(&self) -> usize {
        self.splits.last().map_or(0, |split| split.names.len())
    }

    /// The names of the columns of a first line of numbers: split as that line is, if it can be; none if it is a comment after all.
    ///
    /// # Errors
    /// Another number of names than of columns.
    pub(crate) fn columns(&self, row: &str) -> Result<Option<Named>, String> {
        let splits = &self.splits;
        let by_tabs = splits.iter().any(|s| s.separator == Some('\t'));
        let mut separator = separator(row, by_tabs);
        let same = splits.iter().position(|s| separator.is_some() && s.separator == separator).unwrap_or(0);
        // Several tabs that align columns are one separator.
        if separator == Some('\t') && pieces(row, separator).count() != splits[same].names.len() {
            separator = None;
        }
        let Split { names, axes, .. } = &splits[same];
        let count = pieces(row, separator).count();
        // One more separator at the end of each line, or of this one, separates nothing.
        let is_open = separator.is_some_and(|s| row.trim_end_matches([' ', '\r']).ends_with(s));
        let nameless = names.last().is_some_and(String::is_empty) && (is_open || names.len() > count);
        let wanted = names.len() - usize::from(nameless);
        let found = count - usize::from(is_open && wanted + 1 == count);
        if wanted == found {
            let names: Vec<String> = names.iter().take(wanted).cloned().collect();
            let axes = axes.clone()?;
            once(&names, &axes)?;
            let length = length_units(&axes.map(|axis| names[axis].as_str()));
            return Ok(Some(Named {
                names: for_ply(&names),
                axes,
                by_tabs: separator == Some('\t'),
                length,
            }));
        }
        if self.is_loose || self.is_comment && found == 3 {
            return Ok(None);
        }
        Err(format!(
            "{wanted} names ({}) for the {found} columns of the first point: name every column, with the separator \
             that the numbers have, or remove the line of names",
            names.join(" | ")
        ))
    }
}

/// Which names are x, y and z; those with something behind the letter only at the beginning of the line.
///
/// # Errors
/// Two names for one axis.
pub(crate) fn axes(names: &[String]) -> Result<Option<[usize; 3]>, String> {
    let plain: Vec<String> = names.iter().map(|n| without_unit(n).to_ascii_lowercase()).collect();
    let rank = |axis: usize| {
        let is_there = |rank: &usize| plain.iter().any(|name| AXES[*rank][axis].contains(&name.as_str()));
        (0..AXES.len()).find(is_there)
    };
    if let [Some(x), Some(y), Some(z)] = [rank(0), rank(1), rank(2)]
        && (x == LETTERS) == (y == LETTERS)
    {
        let [x, y, z] = [x, y, z].map(|rank| AXES[rank]);
        return Ok(Some([one(&plain, x[0])?, one(&plain, y[1])?, one(&plain, z[2])?]));
    }
    let begins = |name: &String, axis: &str| {
        let rest = name.to_ascii_lowercase().strip_prefix(axis).map(str::to_owned);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['_', '[']))
    };
    let first = names
        .get(..3)
        .is_some_and(|three| three.iter().zip(["x", "y", "z"]).all(|(name, axis)| begins(name, axis)));
    Ok(first.then_some([0, 1, 2]))
}

/// Where the one of `names` that stands in `of` is; the same name again is another column.
fn one(names: &[String], of: &[&str]) -> Result<usize, String> {
    let mut found = (0..names.len()).filter(|&k| of.contains(&names[k].as_str()));
    let first = found.next().unwrap_or(0);
    match found.find(|&k| names[k] != names[first]) {
        Some(other) => Err(format!(
            "both '{}' and '{}' may be a coordinate: say which with --columns x=NAME,y=NAME,z=NAME",
            names[first], names[other]
        )),
        None => Ok(first),
    }
}

/// Where the names are that a user chose for x, y and z.
fn named(names: &[String], chosen: &[String; 3]) -> Option<[usize; 3]> {
    let at = |wanted: &String| {
        let is_it = |name: &String| {
            name.eq_ignore_ascii_case(wanted) || without_unit(name).eq_ignore_ascii_case(wanted)
        };
        names.iter().position(|name| name == wanted).or_else(|| names.iter().position(is_it))
    };
    let [x, y, z] = [at(&chosen[0])?, at(&chosen[1])?, at(&chosen[2])?];
    (x != y && y != z && z != x).then_some([x, y, z])
}

/// Refuses a coordinate whose name is that of another column, too.
fn once(names: &[String], axes: &[usize; 3]) -> Result<(), String> {
    let again = |axis: usize| {
        let mut others = (0..names.len()).filter(|&k| k != axis && !names[axis].is_empty());
        others.find(|&k| names[k].eq_ignore_ascii_case(&names[axis])).map(|other| (axis, other))
    };
    match axes.iter().find_map(|&axis| again(axis)) {
        Some((axis, other)) => Err(format!(
            "columns {} and {} are both named '{}': name all columns with --columns, - for one that is left out",
            axis.min(other) + 1,
            axis.max(other) + 1,
            names[axis]
        )),
        None => Ok(()),
    }
}
