//! Writes a PLY; binary rows of one width are packed in bulk.

use super::{Element, Encoding, ListColumn, NumberType, Ply, PlyError};
use crate::{
    Values,
    number_type::of_kind,
    rows::{self, Fill, Number},
    table::each,
};
use std::io::Write;

/// Bytes packed before they are written.
const BATCH: usize = 1 << 20;

/// Writes a whole PLY stream, with LF line ends.
///
/// # Errors
/// A write that fails; names with blanks; lists that do not fit their element or the type of their count.
pub fn write(out: &mut impl Write, ply: &Ply, encoding: Encoding) -> Result<(), PlyError> {
    for element in &ply.elements {
        check(element)?;
    }
    out.write_all(header(ply, encoding).as_bytes())?;
    for element in &ply.elements {
        match encoding {
            Encoding::Ascii => text(out, element)?,
            Encoding::BinaryLittleEndian => binary::<false>(out, element)?,
            Encoding::BinaryBigEndian => binary::<true>(out, element)?,
        }
    }
    out.flush()?;
    Ok(())
}

/// A property in the order of the file.
enum Property<'a> {
    Number(&'a str, &'a Values),
    List(&'a ListColumn),
}

fn properties(element: &Element) -> Vec<Property<'_>> {
    let columns = element.table.columns();
    let mut all = Vec::new();
    for place in 0..=columns.len() {
        let here = |l: &&ListColumn| l.position.min(columns.len()) == place;
        all.extend(element.lists.iter().filter(here).map(Property::List));
        all.extend(columns.get(place).map(|c| Property::Number(&c.name, &c.values)));
    }
    all
}

fn check(element: &Element) -> Result<(), PlyError> {
    let names = element.table.columns().iter().map(|c| &c.name).chain(element.lists.iter().map(|l| &l.name));
    for name in names.chain([&element.name]) {
        if name.is_empty() || !name.bytes().all(|b| b.is_ascii_graphic()) {
            return Err(PlyError::Name { element: element.name.clone(), name: name.clone() });
        }
    }
    if element.table.columns().is_empty() && element.lists.is_empty() && element.table.rows() > 0 {
        return Err(PlyError::Empty { element: element.name.clone(), rows: element.table.rows() as u64 });
    }
    for list in &element.lists {
        let wrong =
            |what| Err(PlyError::List { element: element.name.clone(), property: list.name.clone(), what });
        if list.ends.len() != element.table.rows() {
            return wrong("it has another number of rows than its element");
        }
        if !list.ends.is_sorted() || list.ends.last().copied().unwrap_or(0) != list.values.len() {
            return wrong("the ends of its rows do not fit its values");
        }
        let longest = (0..list.ends.len()).map(|row| list.row(row).len()).max().unwrap_or(0);
        let most =
            if list.count_kind.is_integer() { (1u64 << (8 * list.count_kind.size() - 1)) - 1 } else { 0 };
        let unsigned = list.count_kind.word().starts_with('u');
        if longest as u64 > if unsigned { 2 * most + 1 } else { most } {
            return wrong("a row is longer than the type of its count can hold");
        }
    }
    Ok(())
}

/// Writes a binary, little-endian PLY of one element without lists, its columns from wherever they are kept.
///
/// # Errors
/// A write that fails; names with blanks.
pub fn write_columns(
    out: &mut impl Write,
    comments: &[String],
    (element, rows): (&str, usize),
    columns: &[(&str, &dyn Fill)],
) -> Result<(), PlyError> {
    let properties: Vec<(&str, NumberType)> =
        columns.iter().map(|(name, column)| (*name, column.kind())).collect();
    out.write_all(head(comments, (element, rows as u64), &properties)?.as_bytes())?;
    let columns: Vec<&dyn Fill> = columns.iter().map(|(_, column)| *column).collect();
    let stride = columns.iter().map(|c| c.kind().size()).sum::<usize>().max(1);
    in_batches(out, rows, stride, |first, buffer| rows::pack_from(&columns, first, buffer))?;
    Ok(out.flush()?)
}

/// Writes a binary, little-endian PLY of one element without lists, from its rows.
///
/// # Errors
/// A write that fails; names with blanks.
pub fn write_rows(
    out: &mut impl Write,
    comments: &[String],
    (element, rows): (&str, &[u8]),
    properties: &[(&str, NumberType)],
) -> Result<(), PlyError> {
    let stride = properties.iter().map(|(_, kind)| kind.size()).sum::<usize>().max(1);
    out.write_all(head(comments, (element, (rows.len() / stride) as u64), properties)?.as_bytes())?;
    out.write_all(rows)?;
    Ok(out.flush()?)
}

/// The header of a binary, little-endian PLY of one element without lists.
fn head(
    comments: &[String],
    (element, rows): (&str, u64),
    properties: &[(&str, NumberType)],
) -> Result<String, PlyError> {
    let wrong = |name: &&str| name.is_empty() || !name.bytes().all(|b| b.is_ascii_graphic());
    if let Some(name) = properties.iter().map(|(name, _)| *name).chain([element]).find(wrong) {
        return Err(PlyError::Name { element: element.to_owned(), name: name.to_owned() });
    }
    if properties.is_empty() && rows > 0 {
        return Err(PlyError::Empty { element: element.to_owned(), rows });
    }
    let mut text = first_lines(Encoding::BinaryLittleEndian, comments, &[]);
    text += &format!("element {element} {rows}\n");
    for (name, kind) in properties {
        text += &format!("property {} {name}\n", kind.word());
    }
    Ok(text + "end_header\n")
}

fn first_lines(encoding: Encoding, comments: &[String], obj_info: &[String]) -> String {
    let format = match encoding {
        Encoding::Ascii => "ascii",
        Encoding::BinaryLittleEndian => "binary_little_endian",
        Encoding::BinaryBigEndian => "binary_big_endian",
    };
    let mut text = format!("ply\nformat {format} 1.0\n");
    // A line break inside a comment would end it; it becomes a second comment.
    for (word, lines) in [("comment", comments), ("obj_info", obj_info)] {
        for line in lines.iter().flat_map(|line| line.split(['\n', '\r'])) {
            text += &format!("{word} {line}\n");
        }
    }
    text
}

fn header(ply: &Ply, encoding: Encoding) -> String {
    let mut text = first_lines(encoding, &ply.comments, &ply.obj_info);
    for element in &ply.elements {
        text += &format!("element {} {}\n", element.name, element.table.rows());
        for property in properties(element) {
            text += &match property {
                Property::Number(name, values) => format!("property {} {name}\n", values.kind().word()),
                Property::List(l) => {
                    format!("property list {} {} {}\n", l.count_kind.word(), l.values.kind().word(), l.name)
                }
            };
        }
    }
    text + "end_header\n"
}

fn binary<const BIG: bool>(out: &mut impl Write, element: &Element) -> Result<(), PlyError> {
    if !element.lists.is_empty() {
        return lists::<BIG>(out, element);
    }
    let columns: Vec<&Values> = element.table.columns().iter().map(|c| &c.values).collect();
    let stride = rows::stride(&columns).max(1);
    in_batches(out, element.table.rows(), stride, |first, buffer| rows::pack::<BIG>(&columns, first, buffer))
}

/// Writes `rows` rows of `stride` bytes, some at a time; `pack` fills a buffer with those from a first one on.
fn in_batches(
    out: &mut impl Write,
    rows: usize,
    stride: usize,
    pack: impl Fn(usize, &mut [u8]),
) -> Result<(), PlyError> {
    let batch = (BATCH / stride).max(1);
    let mut buffer = vec![0; batch.min(rows) * stride];
    for first in (0..rows).step_by(batch) {
        let buffer = &mut buffer[..batch.min(rows - first) * stride];
        pack(first, buffer);
        out.write_all(buffer)?;
    }
    Ok(())
}

fn lists<const BIG: bool>(out: &mut impl Write, element: &Element) -> Result<(), PlyError> {
    let properties = properties(element);
    let mut buffer = Vec::with_capacity(BATCH);
    for row in 0..element.table.rows() {
        for property in &properties {
            match property {
                Property::Number(_, values) => each!(values, v => v[row].append::<BIG>(&mut buffer)),
                Property::List(list) => {
                    let range = list.row(row);
                    #[allow(clippy::unnecessary_cast)]
                    {
                        of_kind!(list.count_kind, T, _V => (range.len() as T).append::<BIG>(&mut buffer));
                    }
                    each!(&list.values, v => v[range].iter().for_each(|x| x.append::<BIG>(&mut buffer)));
                }
            }
        }
        if buffer.len() > BATCH - 4096 {
            out.write_all(&buffer)?;
            buffer.clear();
        }
    }
    out.write_all(&buffer)?;
    Ok(())
}

fn text(out: &mut impl Write, element: &Element) -> Result<(), PlyError> {
    let properties = properties(element);
    let mut line = String::new();
    for row in 0..element.table.rows() {
        line.clear();
        for property in &properties {
            match property {
                Property::Number(_, values) => put(&mut line, values, row),
                Property::List(list) => {
                    let range = list.row(row);
                    line += &format!("{} ", range.len());
                    range.for_each(|item| put(&mut line, &list.values, item));
                }
            }
        }
        line.pop();
        line.push('\n');
        out.write_all(line.as_bytes())?;
    }
    Ok(())
}

/// Appends a number in the shortest text that gives it back, and a blank.
fn put(line: &mut String, values: &Values, row: usize) {
    use std::fmt::Write;
    let size = values.get(row).abs();
    let scientific = size != 0.0 && !(1e-5..1e16).contains(&size) && size.is_finite();
    // Writing to a String cannot fail.
    let _ = each!(values, v => if scientific { write!(line, "{:e} ", v[row]) } else { write!(line, "{} ", v[row]) });
}
