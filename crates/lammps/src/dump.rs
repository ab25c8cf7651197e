//! Frames of a text dump, one after the other, while LAMMPS writes them.
//!
//! ```text
//! ITEM: TIMESTEP / step / ITEM: NUMBER OF ATOMS / n / ITEM: BOX BOUNDS … / three lines / ITEM: ATOMS id x y z … / n lines
//! ```

use crate::deck::COLUMNS;
use std::collections::VecDeque;
use std::io::{self, BufRead};

/// Numbers of an atom after its id.
pub const NUMBERS: usize = 9;

/// A frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Step.
    pub step: u64,
    /// Number of an atom, and its position [m], velocity [m/s] and angular velocity [rad/s].
    pub atoms: Vec<(u64, [f64; NUMBERS])>,
}

/// Parts of a dump: what LAMMPS wrote after its first start, after its second …
pub type Parts<'a> = Vec<Box<dyn BufRead + Send + 'a>>;

/// Reads frames of a dump in parts: a part ends where the first frame of the next one has begun again.
pub struct Frames<'a> {
    parts: VecDeque<Part<'a>>,
}

/// A part, and its first frame, if that was looked at already.
struct Part<'a> {
    reader: Reader<Box<dyn BufRead + Send + 'a>>,
    ahead: Option<Result<Frame, Ended>>,
}

impl Part<'_> {
    fn next_frame(&mut self) -> Result<Frame, Ended> {
        self.ahead.take().unwrap_or_else(|| self.reader.next_frame())
    }

    fn first(&mut self) -> &Result<Frame, Ended> {
        self.ahead.get_or_insert_with(|| self.reader.next_frame())
    }
}

impl<'a> Frames<'a> {
    /// Reads from parts.
    pub fn new(parts: Parts<'a>) -> Frames<'a> {
        let part = |input| Part { reader: Reader::new(input), ahead: None };
        Frames { parts: parts.into_iter().map(part).collect() }
    }

    /// The next frame.
    ///
    /// # Errors
    /// The end, or what is wrong.
    pub fn next_frame(&mut self) -> Result<Frame, Ended> {
        loop {
            // A start that came to no frame has nothing to say, unless it is the last one.
            while self.parts.len() > 2
                && self.parts.get_mut(1).is_some_and(|p| matches!(p.first(), Err(Ended::Over | Ended::Torn)))
            {
                self.parts.remove(1);
            }
            let until = match self.parts.get_mut(1).map(Part::first) {
                Some(Ok(frame)) => frame.step,
                _ => u64::MAX,
            };
            let only = self.parts.len() == 1;
            let Some(part) = self.parts.front_mut() else { return Err(Ended::Over) };
            match part.next_frame() {
                Ok(frame) if frame.step < until => return Ok(frame),
                Err(ended) if only || matches!(ended, Ended::Wrong(_)) => return Err(ended),
                _ => drop(self.parts.pop_front()),
            }
        }
    }
}

/// Reads the frames of one part.
struct Reader<R> {
    input: R,
    line: String,
}

/// Why there is no next frame.
#[derive(Debug)]
pub enum Ended {
    /// The dump is over between two frames.
    Over,
    /// It ends inside a frame.
    Torn,
    /// It is wrong.
    Wrong(String),
}

impl<R: BufRead> Reader<R> {
    fn new(input: R) -> Reader<R> {
        Reader { input, line: String::new() }
    }

    /// The next line; `None` at the end, also where a line has no end.
    fn line(&mut self) -> io::Result<Option<&str>> {
        self.line.clear();
        self.input.read_line(&mut self.line)?;
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

    fn next_frame(&mut self) -> Result<Frame, Ended> {
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
            } else if line.starts_with("ITEM: NUMBER OF ATOMS") {
                count = self.number("number of atoms")?;
            } else if line.starts_with("ITEM: BOX BOUNDS") {
                for _ in 0..3 {
                    self.needed()?;
                }
            } else if let Some(columns) = line.strip_prefix("ITEM: ATOMS ") {
                if columns != COLUMNS {
                    return Err(Ended::Wrong(format!("its columns are '{columns}', not '{COLUMNS}'")));
                }
                return self.atoms(step, count);
            } else {
                return Err(Ended::Wrong(format!("unexpected line '{line}'")));
            }
        }
    }

    fn atoms(&mut self, step: u64, count: u64) -> Result<Frame, Ended> {
        let mut atoms = Vec::with_capacity(count.min(1 << 24) as usize);
        for _ in 0..count {
            let line = self.needed()?;
            let atom =
                row(line).ok_or_else(|| Ended::Wrong(format!("step {step}: not an atom: '{line}'")))?;
            atoms.push(atom);
        }
        Ok(Frame { step, atoms })
    }
}

/// An atom of a line.
fn row(line: &str) -> Option<(u64, [f64; NUMBERS])> {
    let mut words = line.split_ascii_whitespace();
    let number = words.next()?.parse().ok()?;
    let mut values = [0.0; NUMBERS];
    for value in &mut values {
        *value = words.next()?.parse().ok()?;
    }
    words.next().is_none().then_some((number, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: &str = "ITEM: TIMESTEP\n20\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp mm\n0 1\n0 1\n0 1\n\
        ITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\n3 0.5 0.5 1e-3 0 0 -1 0 0 2 \n";

    #[test]
    fn frames_are_read_one_after_the_other() {
        let text = [ONE, ONE].concat();
        let mut frames = Reader::new(text.as_bytes());
        for _ in 0..2 {
            let frame = frames.next_frame().unwrap();
            assert_eq!(frame.step, 20);
            assert_eq!(frame.atoms, [(3, [0.5, 0.5, 1e-3, 0.0, 0.0, -1.0, 0.0, 0.0, 2.0])]);
        }
        assert!(matches!(frames.next_frame(), Err(Ended::Over)));
    }

    #[test]
    fn a_dump_that_ends_anywhere_inside_a_frame_is_broken() {
        for end in 1..ONE.len() {
            let mut frames = Reader::new(&ONE.as_bytes()[..end]);
            assert!(matches!(frames.next_frame(), Err(Ended::Torn)), "{end}");
        }
    }

    #[test]
    fn a_part_ends_where_the_next_one_goes_on() {
        let at = |step: u64| ONE.replacen("20", &step.to_string(), 1);
        let steps = |parts: &[String]| {
            let parts: Parts =
                parts.iter().map(|p| Box::new(p.as_bytes()) as Box<dyn BufRead + Send>).collect();
            let mut frames = Frames::new(parts);
            let mut steps = Vec::new();
            loop {
                match frames.next_frame() {
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
