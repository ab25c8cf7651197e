//! A rotation, a shift and a factor on all lengths, as a matrix of 4 × 4 numbers.
//!
//! ```text
//! | s R  t |     x ↦ s R x + t      row by row: CloudCompare's matrices, `matrix` of PDAL's filters.transformation
//! | 0 0 0 1|     n ↦ R n            directions keep their length
//! ```
//!
//! Positions are multiplied by the numbers as they stand; R is what is nearest to them (the polar factor), so that directions keep their length where digits are few.

use crate::{LARGEST, Vec3};
use nalgebra::Matrix3;
use thiserror::Error;

/// Numbers of a matrix.
const COUNT: usize = 16;
/// How far the axes may be from perpendicular and of one length [–]: digits are few.
const ROUNDED: f64 = 1e-3;
/// A factor nearer to 1 comes from few digits.
const SAME_SIZE: f64 = 1e-4;

/// A rotation, a shift and a factor on all lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform {
    /// s R.
    matrix: Matrix3<f64>,
    /// t [m].
    shift: Vec3,
    /// R.
    turn: Matrix3<f64>,
    /// How far `matrix` is from a rotation times a factor [–].
    off: f64,
}

/// Why a text is not such a matrix.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)]
pub enum TransformError {
    #[error("{found} numbers where a matrix has 16: give 4 rows of 4, the last one 0 0 0 1")]
    Count { found: usize },
    #[error("number {number} (row {}, column {}) is '{text}': give finite numbers up to {LARGEST:e}", place(*.number)[0], place(*.number)[1])]
    Number { number: usize, text: String },
    #[error("the shift stands in the last row ({}): this matrix goes column by column; exchange rows and columns", row(.0))]
    ByColumns([f64; 4]),
    #[error("the last row is {}: it must be 0 0 0 1, because geometry is turned and shifted without perspective", row(.0))]
    LastRow([f64; 4]),
    #[error(
        "the matrix mirrors (its determinant is {0:.6}): mirror the file in the program it comes from, or change the sign of one axis there"
    )]
    Mirror(f64),
    #[error(
        "the matrix distorts: its axes are {:.6}, {:.6} and {:.6} long, and {off:.6} from perpendicular; give a rotation, with more digits if it was rounded",
        sides[0], sides[1], sides[2]
    )]
    Distorts { sides: [f64; 3], off: f64 },
    #[error("the matrix multiplies lengths by {0:e}: check its numbers")]
    Size(f64),
}

fn place(number: usize) -> [usize; 2] {
    [(number - 1) / 4 + 1, (number - 1) % 4 + 1]
}

fn row(row: &[f64; 4]) -> String {
    row.map(|v| v.to_string()).join(" ")
}

/// The words between what separates numbers: blanks, line ends, commas, semicolons and square brackets. A line that begins with # or // is a remark.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let is_remark = |line: &&str| line.trim_start().starts_with('#') || line.trim_start().starts_with("//");
    let lines = text.lines().filter(move |line| !is_remark(line));
    let parts = |line| str::split(line, |c: char| c.is_whitespace() || ",;[]".contains(c));
    lines.flat_map(parts).filter(|word| !word.is_empty())
}

impl Transform {
    /// Whether a text consists of numbers, as the matrix of a command line does and the name of a file does not.
    pub fn is_numbers(text: &str) -> bool {
        let mut found = 0;
        words(text).all(|word| {
            found += 1;
            word.parse::<f64>().is_ok()
        }) && found > 1
    }

    /// Reads 16 numbers, row by row.
    ///
    /// # Errors
    /// Other numbers, a matrix that mirrors, distorts or has a perspective.
    pub fn parse(text: &str) -> Result<Transform, TransformError> {
        let mut numbers = Vec::with_capacity(COUNT);
        for (number, word) in (1..).zip(words(text.trim_start_matches('\u{feff}'))) {
            match word.parse::<f64>() {
                Ok(value) if value.abs() <= LARGEST => numbers.push(value),
                _ if number > COUNT => numbers.push(0.0),
                _ => return Err(TransformError::Number { number, text: word.chars().take(40).collect() }),
            }
        }
        let found = numbers.len();
        let numbers: [f64; COUNT] = numbers.try_into().map_err(|_| TransformError::Count { found })?;
        Transform::of_rows(&numbers)
    }

    /// Of 16 finite numbers, row by row.
    ///
    /// # Errors
    /// A matrix that mirrors, distorts or has a perspective.
    pub fn of_rows(n: &[f64; COUNT]) -> Result<Transform, TransformError> {
        let last = [n[12], n[13], n[14], n[15]];
        if last != [0.0, 0.0, 0.0, 1.0] {
            let by_columns = [n[3], n[7], n[11], n[15]] == [0.0, 0.0, 0.0, 1.0];
            return Err(if by_columns {
                TransformError::ByColumns(last)
            } else {
                TransformError::LastRow(last)
            });
        }
        let matrix = Matrix3::new(n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10]);
        let sides = [0, 1, 2].map(|k| matrix.column(k).norm());
        let size = libm::cbrt(sides[0] * sides[1] * sides[2]);
        if !(1.0 / LARGEST..=LARGEST).contains(&size) {
            return Err(TransformError::Size(size));
        }
        let even = matrix / size;
        let off = (even.transpose() * even - Matrix3::identity()).amax();
        // Not "off > ROUNDED": it may be NaN.
        if !(off <= ROUNDED) {
            return Err(TransformError::Distorts { sides, off });
        }
        let determinant = even.determinant();
        if determinant < 0.0 {
            return Err(TransformError::Mirror(matrix.determinant()));
        }
        Ok(Transform { matrix, shift: Vec3::new(n[3], n[7], n[11]), turn: nearest_rotation(even), off })
    }

    /// The 16 numbers, row by row.
    pub fn rows(&self) -> [f64; COUNT] {
        let (m, t) = (&self.matrix, &self.shift);
        let row = |k: usize| [m[(k, 0)], m[(k, 1)], m[(k, 2)], t[k]];
        let mut all = [0.0; COUNT];
        (0..3).for_each(|k| all[4 * k..4 * k + 4].copy_from_slice(&row(k)));
        all[15] = 1.0;
        all
    }

    /// Factor on all lengths [–]; `None` where lengths stay, up to the rounding of the numbers.
    pub fn factor(&self) -> Option<f64> {
        let size = libm::cbrt(self.matrix.determinant());
        ((size - 1.0).abs() > SAME_SIZE).then_some(size)
    }

    /// How far the numbers are from those of a rotation times a factor [–]: a point so many meters from the origin may be so much of them off.
    pub fn rounding(&self) -> f64 {
        self.off
    }

    /// Where a point is [m].
    pub fn point(&self, at: &Vec3) -> Vec3 {
        self.matrix * at + self.shift
    }

    /// What takes points back to where they were.
    pub fn inverse(&self) -> Transform {
        // A rotation times a factor always has one.
        let matrix = self.matrix.try_inverse().unwrap_or_else(Matrix3::identity);
        Transform { matrix, shift: -(matrix * self.shift), turn: self.turn.transpose(), off: self.off }
    }

    /// How a direction is turned; its length stays.
    pub fn direction(&self, along: &Vec3) -> Vec3 {
        self.turn * along
    }
}

/// The polar factor: the mean of a matrix and its inverse transposed, until it stays (Higham 1986, doi:10.1137/0907079).
fn nearest_rotation(matrix: Matrix3<f64>) -> Matrix3<f64> {
    let mut turn = matrix;
    // It converges quadratically from what is nearly a rotation: 1e-3, 1e-6, 1e-12.
    for _ in 0..5 {
        let Some(inverse) = turn.try_inverse() else { return turn };
        turn = (turn + inverse.transpose()) * 0.5;
    }
    turn
}

#[cfg(test)]
mod tests;
