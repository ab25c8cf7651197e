//! Blocks of a text dump, one for each time that LAMMPS writes it, while LAMMPS runs.
//!
//! ```text
//! ITEM: TIMESTEP / step / ITEM: NUMBER OF … / n / ITEM: BOX BOUNDS … / three lines / ITEM: ATOMS or ENTRIES, columns / n lines
//! ```

use std::collections::VecDeque;
use std::io::{self, BufRead, Read};

/// Longest line [B].
const LONGEST: u64 = 1 << 20;

/// A block of rows, such as a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    pub step: u64,
    columns: usize,
    values: Vec<f64>,
}

impl Block {
    /// Its rows, each of as many numbers as the dump has columns.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.columns)
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.values.len() / self.columns
    }
}

/// Parts of a dump: what LAMMPS wrote after its first start, after its second …
pub type Parts<'a> = Vec<Box<dyn BufRead + Send + 'a>>;

/// Reads a dump in parts: a part ends where the first block of the next one has begun again.
pub struct Dump<'a> {
    parts: VecDeque<Part<'a>>,
}

/// A part, and its first block, if that was looked at already.
struct Part<'a> {
    reader: Reader<Box<dyn BufRead + Send + 'a>>,
    ahead: Option<Result<Block, Ended>>,
}

impl Part<'_> {
    fn next_block(&mut self) -> Result<Block, Ended> {
        self.ahead.take().unwrap_or_else(|| self.reader.next_block())
    }

    fn first(&mut self) -> &Result<Block, Ended> {
        self.ahead.get_or_insert_with(|| self.reader.next_block())
    }
}

impl<'a> Dump<'a> {
    /// Reads from parts, which have these columns.
    pub fn new(parts: Parts<'a>, columns: &str) -> Dump<'a> {
        let part = |input| Part { reader: Reader::new(input, columns), ahead: None };
        Dump { parts: parts.into_iter().map(part).collect() }
    }

    /// The next block.
    ///
    /// # Errors
    /// The end, or what is wrong.
    pub fn next_block(&mut self) -> Result<Block, Ended> {
        loop {
            // A start that came to no block has nothing to say, unless it is the last one.
            while self.parts.len() > 2
                && self.parts.get_mut(1).is_some_and(|p| matches!(p.first(), Err(Ended::Over | Ended::Torn)))
            {
                self.parts.remove(1);
            }
            let until = match self.parts.get_mut(1).map(Part::first) {
                Some(Ok(block)) => block.step,
                _ => u64::MAX,
            };
            let only = self.parts.len() == 1;
            let Some(part) = self.parts.front_mut() else { return Err(Ended::Over) };
            match part.next_block() {
                Ok(block) if block.step < until => return Ok(block),
                Err(ended) if only || matches!(ended, Ended::Wrong(_)) => return Err(ended),
                _ => drop(self.parts.pop_front()),
            }
        }
    }
}

/// Reads the blocks of one part.
struct Reader<R> {
    input: R,
    line: String,
    columns: String,
}

/// Why there is no next block.
#[derive(Debug)]
pub enum Ended {
    /// The dump is over between two blocks.
    Over,
    /// It ends inside a block.
    Torn,
    Wrong(String),
}

impl<R: BufRead> Reader<R> {
    fn new(input: R, columns: &str) -> Reader<R> {
        Reader { input, line: String::new(), columns: columns.to_owned() }
    }

    /// The next line; `None` at the end, also where a line has no end.
    fn line(&mut self) -> io::Result<Option<&str>> {
        self.line.clear();
        if self.input.by_ref().take(LONGEST).read_line(&mut self.line)? as u64 == LONGEST {
            return Err(io::Error::other("a line of more than a mebibyte"));
        }
        Ok(self.line.strip_suffix('\n'))
    }

    fn needed(&mut self) -> Result<&str, Ended> {
        match self.line() {
            Err(error) => Err(Ended::Wrong(error.to_string())),
            Ok(None) => Err(Ended::Torn),
            Ok(Some(_)) => Ok(self.line.trim_end()),
        }
    }

    fn number(&mut self, what: &str) -> Result<u64, Ended> {
        let line = self.needed()?;
        line.trim().parse().map_err(|_| Ended::Wrong(format!("{what}: not a whole number: '{line}'")))
    }

    fn next_block(&mut self) -> Result<Block, Ended> {
        let (mut step, mut count) = (0, 0);
        let mut begun = false;
        loop {
            let whole =
                self.line().map(|line| line.is_some()).map_err(|error| Ended::Wrong(error.to_string()))?;
            if !whole {
                let between = !begun && self.line.is_empty();
                return Err(if between { Ended::Over } else { Ended::Torn });
            }
            let line = self.line.trim_end();
            begun = true;
            if line.starts_with("ITEM: TIMESTEP") {
                step = self.number("step")?;
            } else if line.starts_with("ITEM: NUMBER OF ") {
                count = self.number("number of rows")?;
            } else if line.starts_with("ITEM: BOX BOUNDS") {
                for _ in 0..3 {
                    self.needed()?;
                }
            } else if let Some(columns) =
                ["ITEM: ATOMS ", "ITEM: ENTRIES "].iter().find_map(|head| line.strip_prefix(head))
            {
                if columns != self.columns {
                    return Err(Ended::Wrong(format!("its columns are '{columns}', not '{}'", self.columns)));
                }
                return self.rows(step, count);
            } else {
                return Err(Ended::Wrong(format!("unexpected line '{line}'")));
            }
        }
    }

    fn rows(&mut self, step: u64, count: u64) -> Result<Block, Ended> {
        let columns = self.columns.split_ascii_whitespace().count();
        let mut values = Vec::with_capacity((count as usize).min(1 << 22) * columns);
        for row in 1..=count as usize {
            let line = self.needed()?;
            let before = values.len();
            for word in line.split_ascii_whitespace() {
                match word.parse::<f64>() {
                    // More numbers than columns are wrong, too, and no reason to read on.
                    Ok(value) if values.len() <= before + columns => values.push(value),
                    _ => break,
                }
            }
            if values.len() != before + columns || line.split_ascii_whitespace().count() != columns {
                return Err(Ended::Wrong(format!(
                    "step {step}: row {row} has not {columns} numbers: '{line}'"
                )));
            }
        }
        Ok(Block { step, columns, values })
    }
}

/// What a dump has of the step of a frame, if there is one.
///
/// # Errors
/// A dump that ends, or is wrong.
pub fn block(dump: &mut Option<Dump>, step: u64) -> Result<Option<Block>, Ended> {
    match dump.as_mut().map(Dump::next_block) {
        None => Ok(None),
        Some(Ok(block)) if block.step == step => Ok(Some(block)),
        Some(Ok(block)) => Err(Ended::Wrong(format!(
            "contacts or bonds of step {} follow the frame of step {step}",
            block.step
        ))),
        // The frame is there, and what belongs to it is not.
        Some(Err(Ended::Over)) => Err(Ended::Torn),
        Some(Err(ended)) => Err(ended),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::COLUMNS;

    const ONE: &str = "ITEM: TIMESTEP\n20\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp mm\n0 1\n0 1\n0 1\n\
        ITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\n3 0.5 0.5 1e-3 0 0 -1 0 0 2 \n";

    #[test]
    fn frames_are_read_one_after_the_other() {
        let text = [ONE, ONE].concat();
        let mut frames = Reader::new(text.as_bytes(), COLUMNS);
        for _ in 0..2 {
            let frame = frames.next_block().unwrap();
            assert_eq!(frame.step, 20);
            let rows: Vec<&[f64]> = frame.rows().collect();
            assert_eq!(rows, [[3.0, 0.5, 0.5, 1e-3, 0.0, 0.0, -1.0, 0.0, 0.0, 2.0]]);
        }
        assert!(matches!(frames.next_block(), Err(Ended::Over)));
    }

    #[test]
    fn a_dump_that_ends_anywhere_inside_a_frame_is_broken() {
        for end in 1..ONE.len() {
            let mut frames = Reader::new(&ONE.as_bytes()[..end], COLUMNS);
            assert!(matches!(frames.next_block(), Err(Ended::Torn)), "{end}");
        }
    }

    #[test]
    fn a_part_ends_where_the_next_one_goes_on() {
        let at = |step: u64| ONE.replacen("20", &step.to_string(), 1);
        let steps = |parts: &[String]| {
            let parts: Parts =
                parts.iter().map(|p| Box::new(p.as_bytes()) as Box<dyn BufRead + Send>).collect();
            let mut frames = Dump::new(parts, COLUMNS);
            let mut steps = Vec::new();
            loop {
                match frames.next_block() {
                    Ok(frame) => steps.push(frame.step),
                    Err(ended) => return (steps, ended),
                }
            }
        };
        let torn = &ONE[..40];
        let first = at(0) + &at(10) + &at(20) + torn;
        // The second start went on from step 10, the third came to no frame, the fourth went on from step 30.
        let second = at(20) + &at(30) + &at(40);
        let fourth = at(40) + &at(50);
        let (found, ended) = steps(&[first.clone(), second.clone(), String::new(), fourth]);
        assert!(found == [0, 10, 20, 30, 40, 50] && matches!(ended, Ended::Over), "{found:?}");
        let (found, ended) = steps(&[first.clone(), second, torn.to_owned()]);
        assert!(found == [0, 10, 20, 30, 40] && matches!(ended, Ended::Torn), "{found:?}");
        let (found, ended) = steps(&[first, "nonsense\n".to_owned(), at(30)]);
        assert!(found == [0, 10, 20] && matches!(ended, Ended::Wrong(_)), "{found:?}");
    }
}
