//! Classes of size with their shares of the stones' mass.
//!
//! ```text
//! from,to,share      sieve sizes [m]: each stone of the library, scaled to a random sieve size of the class (even in its logarithm)
//! class,share        the stones rock_N_H of class N, at their own size
//! ```

use crate::library::Library;
use geom::Shown;
use serde::Serialize;
use thiserror::Error;

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Class {
    /// Number in reports and in the column `class`: from 1.
    pub number: u32,
    /// Share of the mass of all stones [–].
    pub share: f64,
    /// Range of sieve sizes [m] that stones are scaled to; `None`: stones at their own size.
    pub sieves: Option<(f64, f64)>,
    /// Stones of the library, by index.
    pub stones: Vec<usize>,
}

impl Class {
    /// Whether a stone may belong to both.
    fn shares_sizes_with(&self, other: &Class) -> bool {
        match (self.sieves, other.sieves) {
            (Some((low, high)), Some((from, to))) => low < to && from < high || (low, high) == (from, to),
            _ => self.number == other.number,
        }
    }
}

/// Why text is not a grading, or does not fit a library.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GradingError {
    #[error("line {line}: '{text}': {why}")]
    Line { line: usize, text: String, why: &'static str },
    #[error(
        "the first line is '{0}': write from,to,share (sieve sizes in m) or class,share (classes N of rock_N_H)"
    )]
    Head(String),
    #[error("there is no class: give a line for each")]
    Empty,
    #[error("the shares add up to {}: they must add up to 1 or to 100", Shown(*.0))]
    Sum(f64),
    #[error("class {class}: the library has no stone rock_{class}_…: take the class out, or add stones")]
    NoStone { class: u32 },
}

/// One class of all stones at their own size.
pub fn whole(library: &Library) -> Vec<Class> {
    vec![Class { number: 1, share: 1.0, sieves: None, stones: (0..library.stones.len()).collect() }]
}

/// Reads a grading (CSV).
///
/// # Errors
/// Another first line, numbers that are missing, not finite or of the wrong sign; shares that do not add up to 1 or 100; a class without stones.
pub fn read(text: &str, library: &Library) -> Result<Vec<Class>, GradingError> {
    let mut lines =
        (1..).zip(text.lines()).filter(|(_, l)| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
    let (_, head) = lines.next().ok_or(GradingError::Empty)?;
    let names: Vec<&str> = head.split(',').map(str::trim).collect();
    let by_sieve = match names[..] {
        ["from", "to", "share"] => true,
        ["class", "share"] => false,
        _ => return Err(GradingError::Head(head.to_owned())),
    };
    let mut classes = Vec::new();
    for (line, text) in lines {
        let wrong = |why| GradingError::Line { line, text: text.to_owned(), why };
        let cells: Result<Vec<f64>, _> = text.split(',').map(geom::number::not_negative).collect();
        let cells = cells.map_err(|_| wrong("give numbers of 0 or more, separated by commas"))?;
        let share = *cells.last().ok_or(wrong("is empty"))?;
        if cells.len() != names.len() || share <= 0.0 {
            return Err(wrong("give as many numbers as names, and a share above 0"));
        }
        let class = match by_sieve {
            true if !(cells[0] > 0.0 && cells[1] >= cells[0]) => {
                return Err(wrong("sieve sizes must be above 0 and ascend"));
            }
            true => Class {
                number: classes.len() as u32 + 1,
                share,
                sieves: Some((cells[0], cells[1])),
                stones: (0..library.stones.len()).collect(),
            },
            false => {
                let number = cells[0] as u32;
                if f64::from(number) != cells[0] || number == 0 {
                    return Err(wrong("a class is a whole number of 1 or more"));
                }
                let of = |k: &usize| library.stones[*k].class == Some(number);
                let stones: Vec<usize> = (0..library.stones.len()).filter(of).collect();
                if stones.is_empty() {
                    return Err(GradingError::NoStone { class: number });
                }
                Class { number, share, sieves: None, stones }
            }
        };
        if classes.iter().any(|other| class.shares_sizes_with(other)) {
            return Err(wrong("overlaps a class above: each size belongs to one class"));
        }
        classes.push(class);
    }
    let sum: f64 = classes.iter().map(|c| c.share).sum();
    if classes.is_empty() {
        return Err(GradingError::Empty);
    }
    if ![1.0, 100.0].iter().any(|whole| (sum / whole - 1.0).abs() < 1e-6) {
        return Err(GradingError::Sum(sum));
    }
    classes.iter_mut().for_each(|c| c.share /= sum);
    Ok(classes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;
    use geom::mesh::cuboid;

    fn library() -> Library {
        let stone = |name: &str, side: f64| (name.to_owned(), cuboid(Vec3::zeros(), Vec3::repeat(side)));
        Library::new(vec![stone("rock_2_1", 0.02), stone("rock_1_1", 0.01), stone("rock_2_2", 0.03)], false)
            .unwrap()
    }

    #[test]
    fn both_forms_are_read() {
        let library = library();
        let classes = read("class,share\n1,25\n2,75\n", &library).unwrap();
        assert_eq!((classes[0].share, classes[1].share), (0.25, 0.75));
        assert_eq!((&classes[0].stones[..], &classes[1].stones[..]), (&[0][..], &[1, 2][..]));
        let classes = read("# sieves\nfrom,to,share\n0.01,0.02,0.4\n0.02,0.04,0.6\n", &library).unwrap();
        assert_eq!(classes[1].sieves, Some((0.02, 0.04)));
        assert_eq!(classes[1].stones.len(), 3);
    }

    #[test]
    fn a_wrong_grading_is_refused_with_its_line() {
        let library = library();
        for (text, part) in [
            ("", "no class"),
            ("size,share\n1,1\n", "from,to,share"),
            ("class,share\n1,0.5\n2,0.4\n", "add up to 0.9"),
            ("class,share\n7,1\n", "rock_7_"),
            ("class,share\n1.5,1\n", "line 2: '1.5,1': a class is a whole number"),
            ("from,to,share\n0.02,0.01,1\n", "ascend"),
            ("from,to,share\n0.01,0.02\n", "as many numbers"),
            ("from,to,share\n0.01,nan,1\n", "give numbers"),
            ("from,to,share\n0.01,0.012,0.5\n0.011,0.015,0.5\n", "0.011,0.015,0.5': overlaps a class above"),
            ("class,share\n1,0.5\n1,0.5\n", "overlaps a class above"),
            ("class,share\n1,-1\n", "give numbers"),
        ] {
            let words = read(text, &library).unwrap_err().to_string();
            assert!(words.contains(part), "{text}: {words}");
        }
    }
}
