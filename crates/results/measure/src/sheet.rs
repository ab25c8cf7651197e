//! Results: rows of numbers under named columns with units, a summary, and what to plot.

use geom::Vec3;

/// Name and unit of a column or of a result.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// Name, lower case, words joined by `_`.
    pub name: String,
    /// Unit; `–` for none.
    pub unit: &'static str,
}

impl Head {
    /// Heads from pairs of name and unit.
    pub fn list(pairs: &[(&str, &'static str)]) -> Vec<Head> {
        pairs.iter().map(|(name, unit)| Head { name: (*name).to_owned(), unit }).collect()
    }
}

/// One row: a number for each column; NaN where there is none.
pub type Row = Vec<f64>;

/// Triangles and spheres with numbers, for programs that show them in space.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Geometry {
    /// Names and units of the numbers.
    pub heads: Vec<Head>,
    /// Corners [m], and numbers.
    pub triangles: Vec<([Vec3; 3], Row)>,
    /// Centre and radius [m], and numbers.
    pub spheres: Vec<(Vec3, f64, Row)>,
}

/// Results in sum, by name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// Name and unit, value; NaN where there is none.
    pub values: Vec<(Head, f64)>,
    /// What the reader should know.
    pub notes: Vec<String>,
}

impl Summary {
    /// Adds a value.
    pub fn with(mut self, name: &str, unit: &'static str, value: f64) -> Summary {
        self.values.push((Head { name: name.to_owned(), unit }, value));
        self
    }

    /// Adds a remark.
    pub fn note(mut self, text: impl Into<String>) -> Summary {
        self.notes.push(text.into());
        self
    }

    /// The value of this name.
    pub fn get(&self, name: &str) -> Option<f64> {
        self.values.iter().find(|(head, _)| head.name == name).map(|(_, value)| *value)
    }
}

/// Most curves of a panel: there are no more colours.
pub(crate) const CURVES: usize = 8;

/// How a curve looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// Points joined.
    Line,
    /// Joined and dashed: a fit, a reference.
    Dashed,
    /// Points alone.
    Dots,
    /// Constant from a point's x to the next one's.
    Steps,
}

/// Points of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the legend; empty for none.
    pub name: String,
    /// x and y.
    pub points: Vec<[f64; 2]>,
    pub look: Look,
}

/// A part of a drawing.
#[derive(Debug, Clone, PartialEq)]
pub enum Panel {
    /// Curves over one axis.
    Curves {
        /// Label of x, with unit.
        x: String,
        /// Label of y, with unit.
        y: String,
        curves: Vec<Curve>,
    },
    /// Colours over a plane.
    Map {
        /// Label of x, with unit.
        x: String,
        /// Label of y, with unit.
        y: String,
        /// Label of the colour, with unit.
        value: String,
        /// Lowest x, y, highest x, y.
        range: [f64; 4],
        /// Values, rows from low y to high y; NaN where there is none.
        cells: Vec<Vec<f64>>,
    },
}

/// What to draw of a measurement.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Chart {
    pub title: String,
    /// Its parts, from top to bottom.
    pub panels: Vec<Panel>,
}

impl Chart {
    /// A chart without parts yet.
    pub fn new(title: impl Into<String>) -> Chart {
        Chart { title: title.into(), panels: Vec::new() }
    }

    /// Adds curves over one axis.
    pub fn curves(mut self, x: &str, y: &str, curves: Vec<Curve>) -> Chart {
        self.panels.push(Panel::Curves { x: x.to_owned(), y: y.to_owned(), curves });
        self
    }

    /// Adds columns of rows (name, index) as lines over column `x`.
    pub fn columns(self, x: (&str, usize), y: &str, columns: &[(&str, usize)], rows: &[Row]) -> Chart {
        let of = |(name, column): &(&str, usize)| Curve {
            name: (*name).to_owned(),
            points: rows.iter().map(|row| [row[x.1], row[*column]]).collect(),
            look: Look::Line,
        };
        self.curves(x.0, y, columns.iter().map(of).collect())
    }
}
