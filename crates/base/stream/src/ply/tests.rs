use super::*;
use proptest::prelude::*;

const ALL: [Encoding; 3] = [Encoding::Ascii, Encoding::BinaryLittleEndian, Encoding::BinaryBigEndian];

fn bytes(ply: &Ply, encoding: Encoding) -> Vec<u8> {
    let mut out = Vec::new();
    write(&mut out, ply, encoding).unwrap();
    out
}

/// Numbers by their bits; text keeps no payload of a NaN, and any NaN equals any other here.
fn bits(values: &Values) -> Vec<u64> {
    values.to_f64().into_iter().map(|x| if x.is_nan() { 1 } else { x.to_bits() }).collect()
}

fn assert_same(a: &Ply, b: &Ply) {
    assert_eq!((&a.comments, &a.obj_info, a.elements.len()), (&b.comments, &b.obj_info, b.elements.len()));
    for (a, b) in a.elements.iter().zip(&b.elements) {
        assert_eq!((&a.name, a.table.rows(), a.lists.len()), (&b.name, b.table.rows(), b.lists.len()));
        let columns = |e: &Element| {
            let of = |c: &crate::Column| (c.name.clone(), c.values.kind(), bits(&c.values));
            e.table.columns().iter().map(of).collect::<Vec<_>>()
        };
        assert_eq!(columns(a), columns(b));
        for (a, b) in a.lists.iter().zip(&b.lists) {
            assert_eq!((&a.name, a.position, a.count_kind), (&b.name, b.position, b.count_kind));
            assert_eq!(
                (&a.ends, a.values.kind(), bits(&a.values)),
                (&b.ends, b.values.kind(), bits(&b.values))
            );
        }
    }
}

/// A mesh with every kind of number, and lists in front of, between and behind numbers.
fn mesh() -> Ply {
    let mut table = Table::default();
    table.push("x", Values::F64(vec![f64::MIN_POSITIVE, -0.0, f64::NAN, 1.0 / 3.0])).unwrap();
    table.push("y", Values::F32(vec![f32::INFINITY, f32::MIN, 1e-45, 16_777_216.0])).unwrap();
    table.push("red", Values::U8(vec![0, 1, 254, 255])).unwrap();
    table.push("a", Values::I8(vec![-128, -1, 0, 127])).unwrap();
    table.push("b", Values::I16(vec![i16::MIN, -1, 0, i16::MAX])).unwrap();
    table.push("c", Values::U16(vec![0, 1, 2, u16::MAX])).unwrap();
    table.push("d", Values::I32(vec![i32::MIN, -1, 0, i32::MAX])).unwrap();
    table.push("e", Values::U32(vec![0, 1, 2, u32::MAX])).unwrap();
    let mut faces = Table::default();
    faces.push("flags", Values::U8(vec![7, 8])).unwrap();
    let list = |name: &str, position, ends, values| ListColumn {
        name: name.into(),
        position,
        count_kind: NumberType::U8,
        ends,
        values,
    };
    let lists = vec![
        list("vertex_indices", 0, vec![3, 7], Values::I32(vec![0, 1, 2, 0, 1, 2, 3])),
        list("empty", 1, vec![0, 0], Values::U8(vec![])),
        list("texcoord", 1, vec![0, 2], Values::F32(vec![0.5, 0.25])),
    ];
    Ply {
        comments: vec!["made by hand".into(), "".into()],
        obj_info: vec!["num_cols 512".into()],
        elements: vec![
            Element { name: "vertex".into(), table, lists: vec![] },
            Element { name: "face".into(), table: faces, lists },
            Element { name: "edge".into(), table: Table::with_rows(0), lists: vec![] },
        ],
    }
}

#[test]
fn everything_comes_back_in_every_encoding() {
    for encoding in ALL {
        assert_same(&parse(&bytes(&mesh(), encoding)).unwrap(), &mesh());
    }
}

#[test]
fn line_ends_of_unix_windows_and_old_macs_are_read() {
    let text = String::from_utf8(bytes(&mesh(), Encoding::Ascii)).unwrap();
    for ending in ["\r\n", "\r"] {
        assert_same(&parse(text.replace('\n', ending).as_bytes()).unwrap(), &mesh());
    }
    for encoding in &ALL[1..] {
        let whole = bytes(&mesh(), *encoding);
        let split = whole.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        let header = String::from_utf8(whole[..split].to_vec()).unwrap();
        for ending in ["\r\n", "\r"] {
            let other = [header.replace('\n', ending).as_bytes(), &whole[split..]].concat();
            assert_same(&parse(&other).unwrap(), &mesh());
        }
    }
}

/// Data may begin with a byte that looks like a line end.
#[test]
fn data_that_look_like_line_ends_are_data() {
    for ending in ["\n", "\r\n", "\r"] {
        let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\nend_header\n";
        let all = [header.replace('\n', ending).as_bytes(), b"\n\r\n"].concat();
        assert_eq!(parse(&all).unwrap().elements[0].table.get("x"), Some(&Values::U8(vec![10, 13, 10])));
    }
}

#[test]
fn old_and_new_names_of_types_and_odd_numbers_are_read() {
    let text = "ply\nformat ascii 1.0\nelement v 2\nproperty int8 a\nproperty float32 b\nproperty float64 c\n\
                property uint32 d\nend_header\n-7 nan -1.#IND 3.0\n\n  8\t-inf 1.#INF 4e2  \n\n";
    let ply = parse(text.as_bytes()).unwrap();
    let get = |name| ply.elements[0].table.get(name).unwrap();
    assert_eq!(get("a"), &Values::I8(vec![-7, 8]));
    assert_eq!(get("d"), &Values::U32(vec![3, 400]));
    assert!(get("b").get(0).is_nan() && get("c").get(0).is_nan());
    assert_eq!((get("b").get(1), get("c").get(1)), (f64::NEG_INFINITY, f64::INFINITY));
}

/// Each bad input, and what its message must say.
#[test]
fn messages_name_the_place() {
    let head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty uchar red\nend_header\n";
    let list = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vi\nend_header\n";
    let cases = [
        ("solid cube".to_owned(), "line 1"),
        ("".to_owned(), "line 1"),
        (
            "ply\nformat ascii 2.0\nend_header\n".to_owned(),
            "line 2: unknown format (known: ascii, binary_little_endian, binary_big_endian, 1.0): 'format ascii 2.0'",
        ),
        ("ply\nformat ascii 1.0\nelement vertex 2\n".to_owned(), "'end_header' is missing"),
        ("ply\nelement v 0\nend_header\n".to_owned(), "no 'format'"),
        (head.replace("float", "float128"), "line 4: unknown type"),
        (head.replace("vertex 2", "vertex -2"), "line 3"),
        (head.replace("red", "x"), "line 5: this name occurs twice"),
        (format!("{head}1 2\n"), "promises 2 rows, the data ends in row 1"),
        (
            format!("{head}1 2\n3 256\n"),
            "line 8: element 'vertex', row 1, property 'red': '256' is not a uchar",
        ),
        (format!("{head}1 2\n3\n"), "row 1, property 'red': 'nothing' is not a uchar"),
        (
            format!("{head}1 2\n3 4 5 6\n"),
            "line 8: element 'vertex', row 1 has 2 values too many, from '5' on",
        ),
        (format!("{head}1 2\n3 4\n5 6\n"), "4 bytes follow the last row"),
        (format!("{list}4294967295 1 2\n"), "row 0, property 'vi': 'nothing'"),
        (format!("{list}-1\n"), "'-1' is not a count"),
        ("ply\nformat ascii 1.0\nproperty float x\nend_header\n".to_owned(), "before any element"),
        ("ply\nformat ascii 1.0\nelement v 9\nend_header\n".to_owned(), "9 rows but no property"),
    ];
    for (text, expected) in cases {
        let message = parse(text.as_bytes()).unwrap_err().to_string();
        assert!(message.contains(expected), "{message:?} should say {expected:?}");
    }
}

#[test]
fn a_count_of_exabytes_takes_no_memory() {
    for (format, property) in [
        ("ascii", "float x"),
        ("binary_little_endian", "float x"),
        ("binary_big_endian", "list uint double x"),
    ] {
        let text = format!(
            "ply\nformat {format} 1.0\nelement v 18446744073709551615\nproperty {property}\nend_header\n"
        );
        assert!(matches!(parse(text.as_bytes()), Err(PlyError::Truncated { .. })), "{format}");
    }
    let text = "ply\nformat binary_little_endian 1.0\nelement v 1\nproperty list int double x\nend_header\n";
    let huge = [text.as_bytes(), &i32::MAX.to_le_bytes()].concat();
    assert!(matches!(parse(&huge), Err(PlyError::Truncated { .. })));
    let negative = [text.as_bytes(), &(-5i32).to_le_bytes()].concat();
    assert!(matches!(parse(&negative), Err(PlyError::Count { count, .. }) if count == -5.0));
}

#[test]
fn no_cut_data_are_read_and_no_byte_may_follow() {
    for encoding in ALL {
        let whole = bytes(&mesh(), encoding);
        // Text may lack its last line end, as many scripts write it; a cut inside the very last number cannot show.
        let last = if encoding == Encoding::Ascii { whole.len() - " 0.25\n".len() } else { whole.len() - 1 };
        for end in 0..=last {
            assert!(parse(&whole[..end]).is_err(), "{encoding:?} cut at {end}");
        }
        assert!(matches!(parse(&[&whole[..], b"1 "].concat()), Err(PlyError::Trailing { .. })));
    }
}

#[test]
fn a_table_that_cannot_be_written_is_refused() {
    let refused = |change: fn(&mut Ply)| {
        let mut ply = mesh();
        change(&mut ply);
        let mut out = Vec::new();
        let error = write(&mut out, &ply, Encoding::Ascii).unwrap_err();
        assert!(out.is_empty(), "{error}");
        error.to_string()
    };
    assert!(refused(|p| p.elements[0].name = "two words".into()).contains("two words"));
    assert!(refused(|p| p.elements[1].lists[0].ends = vec![3]).contains("another number of rows"));
    assert!(refused(|p| p.elements[1].lists[0].ends = vec![9, 7]).contains("do not fit"));
    let long = |p: &mut Ply| {
        p.elements[1].lists[0].ends = vec![0, 256];
        p.elements[1].lists[0].values = Values::U8(vec![0; 256]);
    };
    assert!(refused(long).contains("longer than"));
}

proptest! {
    #[test]
    fn any_table_comes_back(
        xs in prop::collection::vec(any::<f64>(), 0..40), f in any::<f32>(), i in any::<i32>(),
        lengths in prop::collection::vec(0usize..5, 40), which in 0usize..3,
    ) {
        let rows = xs.len();
        let mut table = Table::default();
        let floats = xs.iter().map(|&x| (x as f32) * f).collect();
        table.push("id", Values::I32((0..rows).map(|r| i.wrapping_mul(r as i32)).collect())).unwrap();
        table.push("f", Values::F32(floats)).unwrap();
        let ends: Vec<usize> = lengths[..rows].iter().scan(0, |n, l| { *n += l; Some(*n) }).collect();
        let items = (0..ends.last().copied().unwrap_or(0)).map(|n| n as u16).collect();
        let list = ListColumn { name: "l".into(), position: 1, count_kind: NumberType::I16, ends, values: Values::U16(items) };
        table.push("x", Values::F64(xs)).unwrap();
        let element = |name: &str, lists| Element { name: name.into(), table: table.clone(), lists };
        let elements = vec![element("a", vec![list]), element("b", vec![])];
        let ply = Ply { comments: vec![], obj_info: vec![], elements };
        assert_same(&parse(&bytes(&ply, ALL[which])).unwrap(), &ply);
    }

    #[test]
    fn flipped_bytes_never_panic(flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6), which in 0usize..3) {
        let mut bytes = bytes(&mesh(), ALL[which]);
        for (at, value) in flips {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let _ = parse(&bytes);
    }
}

/// Gives a few bytes at a time, as a pipe may.
struct Drops<'a>(&'a [u8]);

impl Read for Drops<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = buffer.len().min(997).min(self.0.len());
        buffer[..count].copy_from_slice(&self.0[..count]);
        self.0 = &self.0[count..];
        Ok(count)
    }
}

/// Columns of a plain file, read in blocks.
fn in_blocks(bytes: &[u8]) -> Result<Vec<Vec<f64>>, PlyError> {
    let Opened::Blocks(mut blocks) = Opened::new(Drops(bytes)).unwrap() else { panic!("a plain file") };
    let mut columns: Vec<Values> = blocks.properties.iter().map(|p| p.kind.empty()).collect();
    let places: Vec<usize> = blocks.properties.iter().map(|p| p.offset).collect();
    let stride = blocks.stride;
    while let Some(rows) = blocks.next_rows()? {
        assert!(!rows.is_empty() && rows.len().is_multiple_of(stride));
        columns.iter_mut().zip(&places).for_each(|(c, &place)| c.extend_from_rows(rows, stride, place));
    }
    Ok(columns.iter().map(Values::to_f64).collect())
}

#[test]
fn blocks_give_what_the_whole_file_gives_and_refuse_what_it_refuses() {
    let count = 50_000;
    let mut table = Table::default();
    table.push("x", Values::F32((0..count).map(|i| i as f32 / 7.0).collect())).unwrap();
    table.push("tone", Values::U8((0..count).map(|i| i as u8).collect())).unwrap();
    table.push("t", Values::F64((0..count).map(|i| f64::from(i) / 3.0).collect())).unwrap();
    let wanted: Vec<Vec<f64>> = table.columns().iter().map(|c| c.values.to_f64()).collect();
    let element = Element { name: "vertex".into(), table, lists: Vec::new() };
    let ply = Ply { comments: vec!["a scan".into()], elements: vec![element], ..Ply::default() };
    let whole = bytes(&ply, Encoding::BinaryLittleEndian);
    assert_eq!(in_blocks(&whole).unwrap(), wanted);
    let cut = &whole[..whole.len() - 5];
    let longer = [&whole[..], &[0; 3000]].concat();
    for wrong in [cut, &longer] {
        let said = in_blocks(wrong).unwrap_err().to_string();
        assert_eq!(said, parse(wrong).unwrap_err().to_string());
    }
    let columns = ply.elements[0].table.columns();
    let columns: Vec<(&str, &dyn crate::Fill)> =
        columns.iter().map(|c| (&*c.name, &c.values as &dyn crate::Fill)).collect();
    let mut written = Vec::new();
    write_columns(&mut written, &ply.comments, ("vertex", count as usize), &columns).unwrap();
    assert!(written == whole, "columns are written as tables are");
}

#[test]
fn whatever_is_no_plain_file_comes_back_as_it_was() {
    for encoding in ALL {
        let whole = bytes(&mesh(), encoding);
        let Opened::Other(mut begin, mut rest) = Opened::new(Drops(&whole)).unwrap() else { panic!("lists") };
        rest.read_to_end(&mut begin).unwrap();
        assert!(begin == whole);
    }
}
