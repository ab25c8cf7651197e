//! PCD 0.7 (text, binary, compressed), by the `pcd-rs` crate.

use super::error::ReadError;
use super::foreign;
use crate::points::Cloud;
use geom::Vec3;
use pcd_rs::{DynReader, Field, ValueKind, metas::FieldDef};
use stream::{Table, Values};

pub(super) fn matches(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(4096)];
    let is_comment = |line: &&[u8]| line.starts_with(b"#") || line.trim_ascii().is_empty();
    let first = head.split(|&byte| byte == b'\n').find(|line| !is_comment(line)).unwrap_or_default();
    let holds = |word: &[u8]| head.windows(word.len()).any(|part| part == word);
    head.starts_with(b"# .PCD") || (first.starts_with(b"VERSION") && (holds(b"FIELDS") || holds(b"COLUMNS")))
}

pub(super) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    foreign::guarded("PCD", move || decode(&bytes))
}

fn broken(what: impl ToString, point: Option<u64>) -> ReadError {
    ReadError::Broken { format: "PCD", what: what.to_string(), point }
}

/// LZF makes at most 264 bytes of 3.
const LARGEST_RATIO: u64 = 88;

/// The kind of the data, and what stands behind the header, whose last line is that of the word DATA.
fn data(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let mut rest = bytes;
    while let Some(end) = rest.iter().position(|&byte| byte == b'\n') {
        let line = rest[..end].split(|&byte| byte == b'#').next().unwrap_or_default();
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        rest = &rest[end + 1..];
        if words.next().is_some_and(|word| word.eq_ignore_ascii_case(b"DATA")) {
            return words.next().map(|kind| (kind, rest));
        }
    }
    None
}

/// Refuses a file that holds more points than its header promises.
fn no_more(bytes: &[u8], promised: u64, size: u64) -> Result<(), ReadError> {
    let there = match data(bytes) {
        Some((b"ascii", rest)) => {
            rest.split(|&byte| byte == b'\n').filter(|line| !line.trim_ascii().is_empty()).count() as u64
        }
        Some((b"binary", rest)) => rest.len() as u64 / size.max(1),
        _ => promised,
    };
    if there > promised {
        let what = format!(
            "the header promises {promised} points, and there are {there}: correct POINTS, WIDTH and HEIGHT, or export it again"
        );
        return Err(broken(what, None));
    }
    Ok(())
}

/// Refuses packed data that are shorter than they claim, or claim to hold more than they can.
fn unpackable(bytes: &[u8]) -> Result<(), ReadError> {
    let Some((b"binary_compressed", data)) = data(bytes) else { return Ok(()) };
    let Some((sizes, data)) = data.split_first_chunk::<8>() else { return Ok(()) };
    let [packed, whole] =
        [[0, 1, 2, 3], [4, 5, 6, 7]].map(|at| u64::from(u32::from_le_bytes(at.map(|k| sizes[k]))));
    if packed > data.len() as u64 {
        return Err(broken(format!("{packed} bytes promised, {} there: it is cut off", data.len()), None));
    }
    if whole > LARGEST_RATIO * packed {
        return Err(broken(format!("{packed} packed bytes cannot hold {whole}"), None));
    }
    Ok(())
}

fn decode(bytes: &[u8]) -> Result<Cloud, ReadError> {
    unpackable(bytes)?;
    let reader = DynReader::from_bytes(bytes).map_err(|e| broken(e, None))?;
    let all = &reader.meta().field_defs.fields;
    let values = all.iter().map(|f| f.count).fold(0, u64::saturating_add);
    let size =
        all.iter().map(|f| f.count.saturating_mul(f.kind.byte_size() as u64)).fold(0, u64::saturating_add);
    // The reader passes over bytes that only fill a point up.
    let fields: Vec<FieldDef> = all.iter().filter(|f| !f.is_padding()).cloned().collect();
    let axis = |name: &str| fields.iter().position(|f| f.name == name && f.count == 1);
    let (Some(x), Some(y), Some(z)) = (axis("x"), axis("y"), axis("z")) else {
        let names: Vec<&str> = fields.iter().map(|f| f.name.as_str()).collect();
        return Err(broken(format!("no fields x, y, z; there are: {}", names.join(" ")), None));
    };
    let viewpoint = &reader.meta().viewpoint;
    let eye = Some(Vec3::new(viewpoint.tx, viewpoint.ty, viewpoint.tz));
    let promised = reader.meta().num_points;
    if values > bytes.len() as u64 {
        return Err(broken(
            format!("{values} values per point are promised in a file of {} bytes", bytes.len()),
            None,
        ));
    }
    let mut points = Vec::new();
    let mut columns: Vec<Vec<Values>> =
        fields.iter().map(|f| (0..f.count).map(|_| empty(f.kind)).collect()).collect();
    for record in reader {
        let record = record.map_err(|e| broken(e, Some(points.len() as u64)))?.0;
        points.push(Vec3::from([x, y, z].map(|a| number(&record[a], 0))));
        for (column, field) in columns.iter_mut().zip(&record) {
            column.iter_mut().enumerate().for_each(|(i, values)| push(values, field, i));
        }
    }
    if (points.len() as u64) < promised {
        return Err(broken(
            format!("{promised} points promised, {} there: it is cut off", points.len()),
            None,
        ));
    }
    no_more(bytes, promised, size)?;
    let mut attributes = Table::with_rows(points.len());
    for (f, (field, column)) in fields.iter().zip(columns).enumerate() {
        if [x, y, z].contains(&f) {
            continue;
        }
        for (name, values) in named(&field.name, column) {
            attributes.push(&name, values).map_err(|source| ReadError::Table { format: "PCD", source })?;
        }
    }
    let double = [x, y, z].iter().any(|&a| fields[a].kind != ValueKind::F32);
    let position_column = [x, y, z].into_iter().min().unwrap_or(0).min(attributes.columns().len());
    let mut cloud = Cloud { points, attributes, double, position_column, ..Cloud::default() };
    // Zero is what writers state that know of no viewpoint.
    if let Some(eye) = eye.filter(|eye| eye.iter().all(|c| c.is_finite()) && eye.norm() > 0.0) {
        cloud.add_viewpoint(&eye);
    }
    Ok(cloud)
}

/// A field with several values becomes `name_0`, `name_1`…; packed `rgb` becomes red, green, blue, and `rgba` alpha, too.
fn named(name: &str, mut column: Vec<Values>) -> Vec<(String, Values)> {
    if column.len() == 1 && (name == "rgb" || name == "rgba") {
        let packed: Option<Vec<u32>> = match &column[0] {
            Values::F32(v) => Some(v.iter().map(|c| c.to_bits()).collect()),
            Values::U32(v) => Some(v.clone()),
            _ => None,
        };
        if let Some(packed) = packed {
            let part = |shift: u32| Values::U8(packed.iter().map(|&c| (c >> shift) as u8).collect());
            let mut parts =
                vec![("red".into(), part(16)), ("green".into(), part(8)), ("blue".into(), part(0))];
            // The same 0 or 255 everywhere is what fills the fourth byte.
            let alpha = |c: &u32| c >> 24;
            let fills = |c: &u32| [0, 255].contains(&alpha(c)) && alpha(c) == alpha(&packed[0]);
            if name == "rgba" && !packed.iter().all(fills) {
                parts.push(("alpha".into(), part(24)));
            }
            return parts;
        }
    }
    if column.len() == 1 {
        return column.pop().map(|values| (name.to_owned(), values)).into_iter().collect();
    }
    column.into_iter().enumerate().map(|(i, values)| (format!("{name}_{i}"), values)).collect()
}

fn empty(kind: ValueKind) -> Values {
    match kind {
        ValueKind::I8 => Values::I8(Vec::new()),
        ValueKind::U8 => Values::U8(Vec::new()),
        ValueKind::I16 => Values::I16(Vec::new()),
        ValueKind::U16 => Values::U16(Vec::new()),
        ValueKind::I32 => Values::I32(Vec::new()),
        ValueKind::U32 => Values::U32(Vec::new()),
        ValueKind::F32 => Values::F32(Vec::new()),
        // Columns have no 64-bit integers; `double` is exact up to 2⁵³.
        ValueKind::F64 | ValueKind::I64 | ValueKind::U64 => Values::F64(Vec::new()),
    }
}

fn push(values: &mut Values, field: &Field, i: usize) {
    match (values, field) {
        (Values::I8(to), Field::I8(from)) => to.push(from[i]),
        (Values::U8(to), Field::U8(from)) => to.push(from[i]),
        (Values::I16(to), Field::I16(from)) => to.push(from[i]),
        (Values::U16(to), Field::U16(from)) => to.push(from[i]),
        (Values::I32(to), Field::I32(from)) => to.push(from[i]),
        (Values::U32(to), Field::U32(from)) => to.push(from[i]),
        (Values::F32(to), Field::F32(from)) => to.push(from[i]),
        (Values::F64(to), from) => to.push(number(from, i)),
        _ => {}
    }
}

fn number(field: &Field, i: usize) -> f64 {
    match field {
        Field::I8(v) => v[i].into(),
        Field::I16(v) => v[i].into(),
        Field::I32(v) => v[i].into(),
        Field::I64(v) => v[i] as f64,
        Field::U8(v) => v[i].into(),
        Field::U16(v) => v[i].into(),
        Field::U32(v) => v[i].into(),
        Field::U64(v) => v[i] as f64,
        Field::F32(v) => v[i].into(),
        Field::F64(v) => v[i],
    }
}
