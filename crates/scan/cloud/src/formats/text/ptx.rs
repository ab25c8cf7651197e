//! PTX of Leica: grids of a scanner as text, one after the other, each in its pose.
//!
//! ```text
//! columns                 whole numbers
//! rows
//! x y z                   where the scanner stood
//! three lines of x y z    its axes
//! four lines of 4         pose, for rows: (x y z 1) ← (x y z 1) M, so that the last line is the shift
//! x y z intensity r g b   columns × rows points, column by column, colours if there are any; 0 0 0 is no echo
//! ```

use crate::formats::error::ReadError;
use crate::formats::narrowed::narrowed;
use crate::points::Cloud;
use crate::points::ReadWarning;
use geom::Vec3;
use stream::{Table, Values};

/// Lines in front of the points.
const HEAD: usize = 10;
/// Characters of a point at least, with its line end.
const SHORTEST: usize = 8;
/// How far a pose may be from a rotation: it was rounded.
const ROUNDED: f64 = 1e-3;

/// Two lines of one whole number each, and one of three numbers.
pub(crate) fn matches(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    let mut lines = Lines::new(head);
    let mut next = || lines.next().map(|(_, line)| line).unwrap_or_default();
    let (columns, rows, place) = (next(), next(), next());
    [columns, rows].iter().all(|line| line.parse::<u32>().is_ok()) && numbers::<3>(place).is_some()
}

pub(crate) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    let mut lines = Lines::new(&bytes);
    let mut grids = Grids::default();
    while let Some((number, line)) = lines.next() {
        grids.scan(number, line, &mut lines)?;
    }
    grids.into_cloud()
}

fn error(line: usize, what: impl Into<String>, text: &str) -> ReadError {
    ReadError::Text { line, what: format!("PTX: {}", what.into()), text: text.chars().take(80).collect() }
}

/// Lines that are not blank, with their numbers.
struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    fn new(bytes: &'a [u8]) -> Lines<'a> {
        Lines { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 0 }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a str);

    fn next(&mut self) -> Option<(usize, &'a str)> {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&byte| byte == b'\n').unwrap_or(self.rest.len());
            let (line, rest) = self.rest.split_at(end);
            self.rest = rest.get(1..).unwrap_or_default();
            self.number += 1;
            let line = std::str::from_utf8(line).unwrap_or("(no text)").trim();
            if !line.is_empty() {
                return Some((self.number, line));
            }
        }
        None
    }
}

fn numbers<const N: usize>(line: &str) -> Option<[f64; N]> {
    let mut words = line.split_ascii_whitespace();
    let mut found = [0.0; N];
    for number in &mut found {
        *number = words.next()?.parse().ok()?;
    }
    words.next().is_none().then_some(found)
}

/// The points of all scans.
#[derive(Default)]
struct Grids {
    points: Vec<Vec3>,
    intensity: Vec<f64>,
    /// NaN in a scan without colours.
    color: [Vec<f32>; 3],
    row: Vec<i32>,
    column: Vec<i32>,
    scan: Vec<u32>,
    /// Where the scanners stood [m], as far as the scans state it; as many as scans.
    viewpoints: Vec<Option<Vec3>>,
    warnings: Vec<ReadWarning>,
    has_color: bool,
}

impl Grids {
    /// Reads the scan whose first line is given.
    fn scan<'a>(&mut self, number: usize, first: &'a str, lines: &mut Lines<'a>) -> Result<(), ReadError> {
        let scan = self.viewpoints.len();
        let mut head = Vec::with_capacity(HEAD);
        head.push((number, first));
        head.extend(lines.by_ref().take(HEAD - 1));
        let &[columns, rows, place, _, _, _, ref matrix @ ..] = &head[..] else {
            return Err(error(
                number,
                format!("scan {scan}: the file ends in its head: it is cut off"),
                first,
            ));
        };
        let whole = |(number, line): (usize, &str)| {
            let count = line.parse::<u32>().ok();
            count.ok_or_else(|| error(number, "a number of columns or rows is expected", line))
        };
        let (columns, rows) = (whole(columns)?, whole(rows)?);
        let eye = numbers::<3>(place.1).ok_or_else(|| error(place.0, "x y z is expected", place.1))?;
        let pose = pose(scan, matrix, number)?;
        let count = columns as usize * rows as usize;
        if count > lines.rest.len() / (SHORTEST - 1) + 1 {
            let what = format!(
                "scan {scan}: {columns} × {rows} points are promised, and there are fewer: it is cut off"
            );
            return Err(error(number, what, first));
        }
        let mut width = 0;
        for k in 0..count {
            let Some((number, line)) = lines.next() else {
                let what =
                    format!("scan {scan}: {count} points are promised, and {k} are there: it is cut off");
                return Err(error(lines.number, what, "end of file"));
            };
            let found = self.point(number, line, &pose)?;
            if width != 0 && found != width {
                let what = format!("{found} numbers where the first point of the scan has {width}");
                return Err(error(number, what, line));
            }
            width = found;
            self.row.push((k % rows as usize) as i32);
            self.column.push((k / rows as usize) as i32);
        }
        self.scan.resize(self.points.len(), scan as u32);
        let eye = self.viewpoint(scan, Vec3::from(eye), pose[3], columns.min(rows) > 1);
        self.viewpoints.push(eye);
        Ok(())
    }

    /// Where the scanner stood [m]: as the third line says, or where the pose moves the origin of the scan if that line is zero. Nothing but zeros is
    /// a place if the scan is a grid; one row or column is how scans that were merged are written.
    fn viewpoint(&mut self, scan: usize, place: Vec3, shift: Vec3, is_grid: bool) -> Option<Vec3> {
        let is_zero = |p: &Vec3| p.norm() == 0.0;
        if !is_zero(&place) && !is_zero(&shift) && (place - shift).norm() > ROUNDED {
            let [a, b] = [place, shift].map(|p| format!("{} {} {}", p.x, p.y, p.z));
            let what = format!(
                "PTX: scan {scan}: its third line says that the scanner stood at {a} m, and its pose at {b} m: the third line counts; \
                 --seen-from gives another place"
            );
            self.warnings.push(ReadWarning::LeftOut(what));
        }
        let eye = if is_zero(&place) { shift } else { place };
        (is_grid || !is_zero(&eye)).then_some(eye)
    }

    /// Adds a point, and says how many numbers it has.
    fn point(&mut self, number: usize, line: &str, pose: &[Vec3; 4]) -> Result<usize, ReadError> {
        let with_color = numbers::<7>(line);
        let (width, [x, y, z, tone], color) = match (with_color, numbers::<4>(line)) {
            (Some([x, y, z, tone, red, green, blue]), _) => (7, [x, y, z, tone], [red, green, blue]),
            (None, Some(point)) => (4, point, [f64::NAN; 3]),
            _ => return Err(error(number, "x y z intensity, or with red green blue, is expected", line)),
        };
        if width == 7 && !color.iter().all(|c| (0.0..=255.0).contains(c) && c.fract() == 0.0) {
            return Err(error(number, "colours are whole numbers from 0 to 255", line));
        }
        let is_echo = [x, y, z] != [0.0; 3];
        let placed = pose[0] * x + pose[1] * y + pose[2] * z + pose[3];
        self.points.push(if is_echo { placed } else { Vec3::repeat(f64::NAN) });
        self.intensity.push(tone);
        self.has_color |= width == 7;
        for (column, value) in self.color.iter_mut().zip(color) {
            column.push(value as f32);
        }
        Ok(width)
    }

    fn into_cloud(self) -> Result<Cloud, ReadError> {
        let mut attributes = Table::with_rows(self.points.len());
        let mut push = |name: &str, values: Values| {
            attributes.push(name, values).map_err(|source| ReadError::Table { format: "PTX", source })
        };
        push("intensity", Values::F64(self.intensity))?;
        if self.has_color {
            for (name, column) in ["red", "green", "blue"].into_iter().zip(self.color) {
                push(name, narrowed(column))?;
            }
        }
        push("row", Values::I32(self.row))?;
        push("column", Values::I32(self.column))?;
        if self.viewpoints.len() > 1 {
            push("scan", Values::U32(self.scan))?;
        }
        let warnings = self.warnings;
        let mut cloud = Cloud { points: self.points, attributes, double: true, warnings, ..Cloud::default() };
        self.viewpoints.iter().flatten().for_each(|eye| cloud.add_viewpoint(eye));
        Ok(cloud)
    }
}

/// The rows of a pose: where the axes point, and the shift [m].
fn pose(scan: usize, lines: &[(usize, &str)], head: usize) -> Result<[Vec3; 4], ReadError> {
    let mut rows = [Vec3::zeros(); 4];
    if lines.len() != rows.len() {
        return Err(error(head, format!("scan {scan}: the file ends in its head: it is cut off"), ""));
    }
    for (k, (row, &(number, line))) in rows.iter_mut().zip(lines).enumerate() {
        let last = if k == 3 { 1.0 } else { 0.0 };
        let Some([x, y, z, w]) = numbers::<4>(line).filter(|row| row.iter().all(|v| v.is_finite())) else {
            return Err(error(number, "a row of the pose has four numbers", line));
        };
        if (w - last).abs() > ROUNDED {
            return Err(error(number, format!("a row of the pose ends in {last}"), line));
        }
        *row = Vec3::new(x, y, z);
    }
    let turn = nalgebra::Matrix3::from_columns(&[rows[0], rows[1], rows[2]]);
    let off = (turn.transpose() * turn - nalgebra::Matrix3::identity()).amax();
    if !(off <= ROUNDED && turn.determinant() > 0.0) {
        let what = format!("scan {scan}: its pose is no rotation and would scale or mirror the scan");
        return Err(error(lines[0].0, what, lines[0].1));
    }
    Ok(rows)
}
