//! Extra bytes of LAS points: columns that a record of the header describes, behind the fields of the point format.
//!
//! ```text
//! record "LASF_Spec" 4: a description of 192 bytes for each column, in the order of the bytes
//!   2 type    3 options (8: scale, 16: offset)    4..36 name    112..136 scale    136..160 offset         a number, or three, 8 bytes each
//! ```
//!
//! Types from 11 on are two or three numbers. ASPRS, LAS 1.4 R15 (2019), table 24; those with several numbers as in R13.

use las::Header;
use stream::{MOST_COLUMNS, Values};

/// Bytes of a description.
const DESCRIPTION: usize = 192;
/// Types of one number.
const TYPES: u8 = 10;

/// A column of extra bytes.
pub(crate) struct ExtraColumn {
    /// As the file names it; letters that PLY cannot hold are `_`.
    pub(crate) name: String,
    /// 1 to 10: u8, i8, u16, i16, u32, i32, u64, i64, f32, f64.
    kind: u8,
    /// First byte in a record.
    at: usize,
    /// Factor on the stored number and what is added then, if the file has one of them.
    linear: Option<[f64; 2]>,
}

/// The columns that a file describes, and how many extra bytes of a point nothing describes.
pub(crate) fn columns(header: &Header) -> (Vec<ExtraColumn>, usize) {
    let format = header.point_format();
    let end = usize::from(format.len());
    let mut at = end - usize::from(format.extra_bytes).min(end);
    let is_description = |vlr: &&las::Vlr| vlr.user_id == "LASF_Spec" && vlr.record_id == 4;
    let data = header.all_vlrs().find(is_description).map_or(&[][..], |vlr| &vlr.data);
    let (mut columns, mut unknown) = (Vec::new(), 0);
    for description in data.chunks_exact(DESCRIPTION) {
        let (kind, options) = (description[2], description[3]);
        // Type 0 is bytes without a meaning, as many as the options say.
        let (kind, count) = match kind {
            1..=30 => ((kind - 1) % TYPES + 1, usize::from((kind - 1) / TYPES) + 1),
            _ => (1, usize::from(options)),
        };
        let has_meaning = (1..=30).contains(&description[2]);
        let size = count * size_of_kind(kind);
        if at + size > end {
            break;
        }
        if has_meaning && columns.len() + count <= MOST_COLUMNS {
            columns.extend((0..count).map(|k| column(description, (kind, k, count), at)));
        } else {
            unknown += size;
        }
        at += size;
    }
    (columns, unknown + end - at)
}

/// Column `k` of `count`, whose bytes begin at `at` with the first of them.
fn column(description: &[u8], (kind, k, count): (u8, usize, usize), at: usize) -> ExtraColumn {
    let name = description[4..36].split(|&byte| byte == 0).next().unwrap_or_default().trim_ascii();
    let letter = |&byte: &u8| if byte.is_ascii_graphic() { char::from(byte) } else { '_' };
    let mut name: String = name.iter().map(letter).collect();
    if name.is_empty() {
        name.push_str("extra");
    }
    if count > 1 {
        name += &format!("_{k}");
    }
    let number = |from: usize| read::<8>(&description[from + 8 * k..]).map_or(0.0, f64::from_le_bytes);
    let (scaled, shifted) = (description[3] & 8 != 0, description[3] & 16 != 0);
    let scale = if scaled { number(112) } else { 1.0 };
    let offset = if shifted { number(136) } else { 0.0 };
    let linear = (scaled || shifted).then_some([scale, offset]);
    ExtraColumn { name, kind, at: at + k * size_of_kind(kind), linear }
}

/// Bytes of a number.
fn size_of_kind(kind: u8) -> usize {
    match kind {
        1 | 2 => 1,
        3 | 4 => 2,
        5 | 6 | 9 => 4,
        _ => 8,
    }
}

fn read<const N: usize>(bytes: &[u8]) -> Option<[u8; N]> {
    bytes.first_chunk::<N>().copied()
}

impl ExtraColumn {
    /// Its numbers in whole records of `length` bytes: in their own type, or as 8-byte numbers if they are scaled or whole numbers of 8 bytes. Those of 2
    /// bytes come as 4, which every reader of PLY takes.
    pub(crate) fn values(&self, records: &[u8], length: usize) -> Values {
        let at = self.at;
        let bytes =
            records.chunks_exact(length.max(1)).map(move |record| record.get(at..).unwrap_or_default());
        macro_rules! numbers {
            ($t:ty, $into:ty) => {
                bytes.map(|b| read(b).map_or(<$t>::default(), <$t>::from_le_bytes) as $into).collect()
            };
        }
        let values = match self.kind {
            1 => Values::U8(numbers!(u8, u8)),
            2 => Values::I8(numbers!(i8, i8)),
            3 => Values::U32(numbers!(u16, u32)),
            4 => Values::I32(numbers!(i16, i32)),
            5 => Values::U32(numbers!(u32, u32)),
            6 => Values::I32(numbers!(i32, i32)),
            7 => Values::F64(numbers!(u64, f64)),
            8 => Values::F64(numbers!(i64, f64)),
            9 => Values::F32(numbers!(f32, f32)),
            _ => Values::F64(numbers!(f64, f64)),
        };
        match self.linear {
            Some([scale, offset]) => Values::F64(values.iter().map(|v| v * scale + offset).collect()),
            None => values,
        }
    }
}
