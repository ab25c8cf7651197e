//! Points chosen by their properties: `classification != 7 && intensity > 20`.
//!
//! ```text
//! either   both { "||" both }
//! both     one { "&&" one }
//! one      "!" one | "(" either ")" | value ("==" | "!=" | "<" | "<=" | ">" | ">=") value
//! value    number | name of a property | x | y | z
//! ```
//!
//! A name with other characters than letters, digits, `_`, `.` and `:` stands in single quotes. NaN makes every comparison false, but `!=`.

use crate::points::Cloud;
use std::str::FromStr;
use stream::Values;
use thiserror::Error;

/// Why a condition cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FilterError {
    #[error("'{text}': {what} at character {at}: write it as in classification != 7 && intensity > 20")]
    Text { text: String, what: &'static str, at: usize },
    #[error("the cloud has no property '{name}': it has {known}")]
    Unknown { name: String, known: String },
}

/// A condition on the properties of a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Filter {
    text: String,
    whole: Condition,
}

#[derive(Debug, Clone, PartialEq)]
enum Condition {
    Any(Vec<Condition>),
    All(Vec<Condition>),
    Not(Box<Condition>),
    Compare(Operand, Comparison, Operand),
}

#[derive(Debug, Clone, PartialEq)]
enum Operand {
    Number(f64),
    Property(String),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Comparison {
    Equal,
    Other,
    Less,
    AtMost,
    More,
    AtLeast,
}

/// Comparisons, the longer ones first.
const COMPARISONS: [(&str, Comparison); 6] = [
    ("==", Comparison::Equal),
    ("!=", Comparison::Other),
    ("<=", Comparison::AtMost),
    (">=", Comparison::AtLeast),
    ("<", Comparison::Less),
    (">", Comparison::More),
];
/// Brackets and negations in one another.
const DEEPEST: usize = 100;

impl FromStr for Filter {
    type Err = FilterError;

    fn from_str(text: &str) -> Result<Filter, FilterError> {
        let mut parser = Parser { text, at: 0, depth: 0 };
        let whole = parser.either()?;
        parser.blanks();
        if parser.at < text.len() {
            return Err(parser.wrong("&&, || or the end is expected"));
        }
        Ok(Filter { text: text.to_owned(), whole })
    }
}

impl Filter {
    /// The text it was made of.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// For each point whether it fulfils the condition.
    ///
    /// # Errors
    /// A property that the cloud does not have.
    pub fn fulfilled(&self, cloud: &Cloud) -> Result<Vec<bool>, FilterError> {
        let compiled = self.whole.on(cloud)?;
        Ok((0..cloud.points.len()).map(|row| compiled.holds(cloud, row)).collect())
    }
}

/// A condition whose properties were found.
enum Compiled<'a> {
    Any(Vec<Compiled<'a>>),
    All(Vec<Compiled<'a>>),
    Not(Box<Compiled<'a>>),
    Compare(Source<'a>, Comparison, Source<'a>),
}

/// Where a value comes from.
enum Source<'a> {
    Number(f64),
    Axis(usize),
    Column(&'a Values),
}

impl Condition {
    fn on<'a>(&self, cloud: &'a Cloud) -> Result<Compiled<'a>, FilterError> {
        let each = |of: &[Condition]| of.iter().map(|c| c.on(cloud)).collect::<Result<Vec<_>, _>>();
        Ok(match self {
            Condition::Any(of) => Compiled::Any(each(of)?),
            Condition::All(of) => Compiled::All(each(of)?),
            Condition::Not(of) => Compiled::Not(Box::new(of.on(cloud)?)),
            Condition::Compare(a, how, b) => Compiled::Compare(a.on(cloud)?, *how, b.on(cloud)?),
        })
    }
}

impl Operand {
    fn on<'a>(&self, cloud: &'a Cloud) -> Result<Source<'a>, FilterError> {
        let name = match self {
            Operand::Number(number) => return Ok(Source::Number(*number)),
            Operand::Property(name) => name,
        };
        if let Some(axis) = ["x", "y", "z"].iter().position(|axis| axis == name) {
            return Ok(Source::Axis(axis));
        }
        cloud.attributes.get(name).map(Source::Column).ok_or_else(|| {
            let names =
                ["x", "y", "z"].into_iter().chain(cloud.attributes.columns().iter().map(|c| c.name.as_str()));
            FilterError::Unknown { name: name.clone(), known: names.collect::<Vec<_>>().join(", ") }
        })
    }
}

impl Compiled<'_> {
    fn holds(&self, cloud: &Cloud, row: usize) -> bool {
        match self {
            Compiled::Any(of) => of.iter().any(|c| c.holds(cloud, row)),
            Compiled::All(of) => of.iter().all(|c| c.holds(cloud, row)),
            Compiled::Not(of) => !of.holds(cloud, row),
            Compiled::Compare(a, how, b) => {
                let (a, b) = (a.value(cloud, row), b.value(cloud, row));
                match how {
                    Comparison::Equal => a == b,
                    Comparison::Other => a != b,
                    Comparison::Less => a < b,
                    Comparison::AtMost => a <= b,
                    Comparison::More => a > b,
                    Comparison::AtLeast => a >= b,
                }
            }
        }
    }
}

impl Source<'_> {
    fn value(&self, cloud: &Cloud, row: usize) -> f64 {
        match self {
            Source::Number(number) => *number,
            Source::Axis(axis) => cloud.points[row][*axis],
            Source::Column(values) => values.get(row),
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Parser<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn blanks(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
    }

    fn take(&mut self, token: &str) -> bool {
        self.blanks();
        let is_next = self.rest().starts_with(token);
        self.at += if is_next { token.len() } else { 0 };
        is_next
    }

    fn wrong(&self, what: &'static str) -> FilterError {
        let at = self.text.get(..self.at).map_or(0, |read| read.chars().count()) + 1;
        FilterError::Text { text: self.text.chars().take(200).collect(), what, at }
    }

    fn either(&mut self) -> Result<Condition, FilterError> {
        let mut of = vec![self.both()?];
        while self.take("||") {
            of.push(self.both()?);
        }
        Ok(if of.len() == 1 { of.remove(0) } else { Condition::Any(of) })
    }

    fn both(&mut self) -> Result<Condition, FilterError> {
        let mut of = vec![self.one()?];
        while self.take("&&") {
            of.push(self.one()?);
        }
        Ok(if of.len() == 1 { of.remove(0) } else { Condition::All(of) })
    }

    fn one(&mut self) -> Result<Condition, FilterError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.wrong("too many brackets"));
        }
        let found = if self.take("(") {
            let inner = self.either()?;
            if !self.take(")") {
                return Err(self.wrong("a closing bracket is expected"));
            }
            inner
        } else if self.take("!") {
            Condition::Not(Box::new(self.one()?))
        } else {
            let a = self.operand()?;
            let how = COMPARISONS.iter().find(|(sign, _)| self.take(sign));
            let Some((_, how)) = how else {
                return Err(self.wrong("==, !=, <, <=, > or >= is expected"));
            };
            Condition::Compare(a, *how, self.operand()?)
        };
        self.depth -= 1;
        Ok(found)
    }

    fn operand(&mut self) -> Result<Operand, FilterError> {
        if self.take("'") {
            let end = self.rest().find('\'').ok_or_else(|| self.wrong("a closing quote is expected"))?;
            let name = self.rest()[..end].to_owned();
            self.at += end + 1;
            return Ok(Operand::Property(name));
        }
        self.blanks();
        let is_word = |c: char| c.is_alphanumeric() || ['_', '.', ':'].contains(&c);
        // A sign, also that of an exponent, belongs to a number.
        let mut end = 0;
        let mut last = None;
        for (place, c) in self.rest().char_indices() {
            let begins_number = self.rest().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
            let is_sign =
                ['+', '-'].contains(&c) && (place == 0 || begins_number && matches!(last, Some('e' | 'E')));
            if !is_word(c) && !is_sign {
                break;
            }
            (end, last) = (place + c.len_utf8(), Some(c));
        }
        let word = self.rest()[..end].to_owned();
        let starts_as_number = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        let operand = match word.parse::<f64>() {
            Ok(number) if starts_as_number => Operand::Number(number),
            _ if word.is_empty() => return Err(self.wrong("a number or the name of a property is expected")),
            _ if starts_as_number => return Err(self.wrong("this is not a number")),
            _ => Operand::Property(word),
        };
        self.at += end;
        Ok(operand)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;
    use stream::Table;

    fn cloud() -> Cloud {
        let mut attributes = Table::with_rows(4);
        attributes.push("class", Values::U8(vec![2, 7, 2, 9])).unwrap();
        attributes.push("a b", Values::F64(vec![0.5, 1.0, f64::NAN, 2.0])).unwrap();
        Cloud {
            points: (0..4).map(|k| Vec3::new(f64::from(k), 0.0, -1.0)).collect(),
            attributes,
            ..Cloud::default()
        }
    }

    fn rows(text: &str) -> Vec<u32> {
        let fulfilled = text.parse::<Filter>().unwrap().fulfilled(&cloud()).unwrap();
        (0u32..).zip(fulfilled).filter(|(_, holds)| *holds).map(|(row, _)| row).collect()
    }

    #[test]
    fn conditions_choose_points() {
        assert_eq!(rows("class != 7 && x > 0"), [2, 3]);
        assert_eq!(rows("class==2||class==9"), [0, 2, 3]);
        assert_eq!(rows("x < 1 || x > 1 && class == 9"), [0, 3], "&& binds first");
        assert_eq!(rows("!(class == 2) && 1.5e+0 >= x"), [1]);
        assert_eq!(rows("'a b' <= 1"), [0, 1], "NaN is in no range");
        assert_eq!(rows("'a b' != 1"), [0, 2, 3]);
        assert_eq!(rows("z >= -1 && z<-0.5e0"), [0, 1, 2, 3]);
        assert_eq!(rows("x == class"), [2]);
    }

    #[test]
    fn wrong_conditions_name_their_place() {
        let told = |text: &str| text.parse::<Filter>().unwrap_err().to_string();
        for (text, part) in [
            ("", "a number or the name"),
            ("class", "== , !=".replace(" ,", ",").as_str()),
            ("class = 7", "is expected at character 7"),
            ("(class == 7", "a closing bracket"),
            ("class == 7 x > 1", "at character 12"),
            ("class > 7e", "this is not a number"),
            ("'a b > 1", "a closing quote"),
            (&"(".repeat(5000), "too many brackets"),
            (&"!".repeat(5000), "too many brackets"),
        ] {
            assert!(told(text).contains(part), "{text}: {}", told(text));
        }
        let unknown = "colour > 1".parse::<Filter>().unwrap().fulfilled(&cloud()).unwrap_err().to_string();
        assert!(unknown.contains("no property 'colour': it has x, y, z, class, a b"), "{unknown}");
    }
}
