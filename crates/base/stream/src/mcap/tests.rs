mod damaged;
mod in_order;

use super::*;
use crate::{Line, NumberType, Rows, Table, Values};
use std::{
    cell::RefCell,
    collections::BTreeMap,
    io::{self, Read, Write},
    rc::Rc,
    sync::mpsc,
};

fn table(rows: usize) -> Table {
    let mut table = Table::default();
    let column = |k: f64| Values::F64((0..rows).map(|r| k / (r as f64 + 0.3)).collect());
    for (name, k) in [("x", 1.0), ("y", -2.0), ("z", 1e-300), ("radius", 0.004)] {
        table.push(name, column(k)).unwrap();
    }
    table.push("id", Values::U32((0..rows as u32).map(|r| u32::MAX - r).collect())).unwrap();
    table.push("material", Values::U16(vec![7; rows])).unwrap();
    table.push("f", Values::F32(vec![f32::MIN_POSITIVE; rows])).unwrap();
    table.push("i", Values::I8(vec![-5; rows])).unwrap();
    table
}

fn provenance() -> Provenance {
    Provenance {
        tool: "wallgen".into(),
        version: "0.1.0".into(),
        arguments: vec!["--roughness=0.001".into(), "a \"b\"".into()],
        inputs: vec![("cloud".into(), "ab".repeat(32))],
    }
}

fn one(key: &str, value: &str) -> BTreeMap<String, String> {
    BTreeMap::from([(key.to_owned(), value.to_owned())])
}

fn begin<W: Write>(out: W, how: impl Into<StreamOptions<W>>) -> Writer<W> {
    let mut writer = Writer::compressed(out, &provenance(), how).unwrap();
    writer.metadata("materials", one("0", r#"{"name":"steel"}"#)).unwrap();
    for frame in 0..3 {
        writer.points("/particles", frame * 20_000_000, "world", table(40)).unwrap();
        writer.bytes("/energy", "json", frame * 20_000_000, b"{\"kinetic\":1}").unwrap();
        writer.flush_chunk().unwrap();
    }
    writer
}

fn stream(how: Compression) -> Vec<u8> {
    begin(Vec::new(), how).finish().unwrap()
}

fn read(bytes: &[u8]) -> Result<Vec<Event>, McapError> {
    Reader::new(bytes).collect()
}

/// One byte a call, as a slow pipe may give them.
struct Slow<'a>(&'a [u8]);
impl Read for Slow<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = buffer.len().min(1).min(self.0.len());
        buffer[..n].copy_from_slice(&self.0[..n]);
        self.0 = &self.0[n..];
        Ok(n)
    }
}

#[test]
fn everything_comes_back_in_order() {
    for how in [Compression::None, Compression::Zstd] {
        let bytes = stream(how);
        let events = read(&bytes).unwrap();
        assert_eq!(events.len(), 8);
        let Event::Metadata { name, map } = &events[0] else { panic!("{events:?}") };
        assert_eq!((name.as_str(), Provenance::from_map(map)), (PROVENANCE, provenance()));
        assert!(matches!(&events[1], Event::Metadata { name, .. } if name == "materials"));
        for frame in 0..3u64 {
            let points =
                Event::Points { topic: "/particles".into(), time_ns: frame * 20_000_000, table: table(40) };
            assert_eq!(events[2 + 2 * frame as usize], points);
            assert!(matches!(&events[3 + 2 * frame as usize], Event::Bytes { topic, data, .. }
                if topic == "/energy" && data == b"{\"kinetic\":1}"));
        }
        assert_eq!(Reader::new(Slow(&bytes)).collect::<Result<Vec<_>, _>>().unwrap(), events);
    }
}

/// Packed by lz4, as other programs do, and damaged.
#[test]
fn lz4_chunks_are_read_and_checked() {
    let options = ::mcap::WriteOptions::new().compression(Some(::mcap::Compression::Lz4));
    let mut other = options.create(io::Cursor::new(Vec::new())).unwrap();
    let channel = other.add_channel(0, "/log", "json", &BTreeMap::new()).unwrap();
    let header =
        ::mcap::records::MessageHeader { channel_id: channel, sequence: 0, log_time: 5, publish_time: 5 };
    other.write_to_known_channel(&header, &[b'7'; 3000]).unwrap();
    let end = ::mcap::records::Metadata { name: END_OF_STREAM.into(), metadata: BTreeMap::new() };
    other.write_metadata(&end).unwrap();
    other.finish().unwrap();
    let good = other.into_inner().into_inner();
    assert!(matches!(&read(&good).unwrap()[..], [Event::Bytes { data, .. }] if data.len() == 3000));
    for at in 8..good.len() {
        let mut bad = good.clone();
        bad[at] ^= 0x20;
        let _ = read(&bad); // the header's text is protected by the CRC of the data, all else too: no panic
    }
}

/// A file, and all that it was while it was written.
#[derive(Clone, Default)]
struct SharedFile(Rc<RefCell<Written>>);

/// The file, and what it was after each write.
type Written = (io::Cursor<Vec<u8>>, Vec<Vec<u8>>);

impl SharedFile {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        io::Seek::seek(&mut self.0.borrow_mut().0, to)
    }
}

impl Write for SharedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let (file, states) = &mut *self.0.borrow_mut();
        let written = file.write(bytes);
        states.push(file.get_ref().clone());
        written
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A file is written in place, with the bytes that a pipe gets. Whatever is there of it when its writer is killed is read as a stream that was cut.
#[test]
fn a_file_is_written_in_place_with_the_bytes_of_a_pipe() {
    for compression in [Compression::None, Compression::Zstd] {
        let file = SharedFile::default();
        begin(file.clone(), StreamOptions { compression, seeks: Some(SharedFile::seek) }).finish().unwrap();
        let (file, states) = &*file.0.borrow();
        let all = read(&stream(compression)).unwrap();
        assert_eq!(file.get_ref(), &stream(compression));
        let mut most = 0;
        for state in &states[..states.len() - 1] {
            let mut events: Vec<_> = Reader::new(&state[..]).collect();
            let last = events.pop().unwrap();
            assert!(matches!(last, Err(McapError::Truncated { .. })), "{compression:?}: {last:?}");
            let whole: Vec<Event> = events.into_iter().map(Result::unwrap).collect();
            assert!(all.starts_with(&whole) && whole.len() >= most);
            most = whole.len();
        }
        assert_eq!(most, all.len());
    }
}

/// What is written goes to a file at once: a chunk is not held beside its message.
#[test]
fn nothing_is_held_of_what_goes_to_a_file() {
    let file = SharedFile::default();
    let how =
        StreamOptions { compression: Compression::None, seeks: Some(SharedFile::seek as SeekFn<SharedFile>) };
    let mut writer = begin(file.clone(), how);
    let before = file.0.borrow().0.get_ref().len();
    writer.bytes("/energy", "json", 60_000_000, &[b' '; 500_000]).unwrap();
    assert!(file.0.borrow().0.get_ref().len() >= before + 500_000);
}

/// Rows that are not held in memory, as the same table.
#[test]
fn rows_are_written_as_their_table_is() {
    struct Own;
    impl Rows for Own {
        fn fields(&self) -> Vec<(&str, NumberType)> {
            vec![
                ("x", NumberType::F64),
                ("id", NumberType::U32),
                ("r", NumberType::F32),
                ("m", NumberType::U16),
            ]
        }
        fn count(&self) -> usize {
            5000
        }
        fn put(&self, n: usize, row: &mut Line) {
            row.put(n as f64 / 3.0);
            row.put(n as u32);
            row.put(n as f32);
            row.put(n as u16);
        }
    }
    let all = 0..5000;
    let mut table = Table::default();
    table.push("x", Values::F64(all.clone().map(|n| f64::from(n) / 3.0).collect())).unwrap();
    table.push("id", Values::U32(all.clone().map(|n| n as u32).collect())).unwrap();
    table.push("r", Values::F32(all.clone().map(|n| n as f32).collect())).unwrap();
    table.push("m", Values::U16(all.map(|n| n as u16).collect())).unwrap();
    let with = |write: &dyn Fn(&mut Writer<Vec<u8>>)| {
        let mut writer = Writer::new(Vec::new(), &provenance()).unwrap();
        write(&mut writer);
        writer.finish().unwrap()
    };
    let rows = with(&|w| w.rows("/particles", 7, "world", &Own).unwrap());
    assert_eq!(rows, with(&|w| w.points("/particles", 7, "world", &table).unwrap()));
}

/// Hazard 4: viewers refuse files without a summary.
#[test]
fn a_finished_stream_has_chunks_and_a_summary() {
    let bytes = stream(Compression::Zstd);
    let summary = ::mcap::Summary::read(&bytes).unwrap().expect("a summary");
    assert_eq!((summary.chunk_indexes.len(), summary.stats.unwrap().message_count), (3, 6));
    let channel = summary.channels.values().find(|c| c.topic == "/particles").unwrap();
    let schema = channel.schema.as_ref().unwrap();
    assert_eq!(
        (schema.name.as_str(), channel.message_encoding.as_str()),
        ("foxglove.PointCloud", "protobuf")
    );
}

/// Hazard 5: the header names the crate's version by default.
#[test]
fn the_same_input_gives_the_same_bytes_free_of_versions_and_clocks() {
    assert_eq!(stream(Compression::Zstd), stream(Compression::Zstd));
    let text = String::from_utf8_lossy(&stream(Compression::None)).into_owned();
    assert!(text.contains("grainpipe") && !text.contains("mcap-rust"));
}

/// A reader at the other end of a pipe sees a message when its chunk was flushed, not at the end.
#[test]
fn a_stream_is_read_while_it_is_written() {
    let (read_end, write_end) = io::pipe().unwrap();
    let (seen, see) = mpsc::channel();
    let reader = std::thread::spawn(move || {
        for event in Reader::new(read_end) {
            if let Event::Points { time_ns, .. } = event.unwrap() {
                seen.send(time_ns).unwrap();
            }
        }
    });
    let mut writer = Writer::new(write_end, &provenance()).unwrap();
    for time in 0..5 {
        writer.points("/particles", time, "world", table(3)).unwrap();
        assert!(see.try_recv().is_err(), "nothing before the flush");
        writer.flush_chunk().unwrap();
        assert_eq!(see.recv_timeout(std::time::Duration::from_secs(20)).unwrap(), time);
    }
    writer.finish().unwrap();
    reader.join().unwrap();
}

#[test]
fn the_digest_depends_on_content_only() {
    let digest = |bytes: &[u8]| {
        let mut reader = Reader::hashed(bytes);
        reader.by_ref().for_each(|e| drop(e.unwrap()));
        reader.digest()
    };
    let plain = digest(&stream(Compression::None));
    assert_eq!((plain.len(), &plain), (64, &digest(&stream(Compression::Zstd))));
    let with = |data: &[u8]| {
        let mut writer = begin(Vec::new(), Compression::None);
        writer.bytes("/energy", "json", 50_000_000, data).unwrap();
        digest(&writer.finish().unwrap())
    };
    assert!(with(b"{}") != plain && with(b"{}") != with(b"[]"));
    assert_eq!(Reader::new(&b""[..]).digest(), "");
}

/// The message written by hand around the packed rows is what prost makes of the same fields.
#[test]
fn a_message_is_a_protobuf_point_cloud() {
    use prost::Message;
    let mut message = Vec::new();
    points::encode(&table(5), 1_500_000_000, "world", &mut message).unwrap();
    let cloud = point_cloud::PointCloud::decode(&message[..]).unwrap();
    assert_eq!(cloud.encode_to_vec(), message);
    assert_eq!((cloud.point_stride, cloud.data.len(), cloud.fields.len()), (43, 215, 8));
    assert_eq!(cloud.timestamp.map(|t| (t.seconds, t.nanos)), Some((1, 500_000_000)));
    assert_eq!(points::decode(message).unwrap(), table(5));
}

#[test]
fn tables_without_rows_or_columns_travel() {
    for empty in [Table::default(), table(0)] {
        let mut message = Vec::new();
        points::encode(&empty, 0, "", &mut message).unwrap();
        assert_eq!(points::decode(message).unwrap(), empty);
    }
}

/// An output that fails for good must be seen as what it is: a closed pipe ends a tool quietly.
#[test]
fn a_closed_pipe_is_told_as_an_io_error() {
    let (read_end, write_end) = io::pipe().unwrap();
    drop(read_end);
    let error = Writer::new(write_end, &provenance()).err().unwrap();
    assert!(matches!(error, McapError::Io(e) if e.kind() == io::ErrorKind::BrokenPipe));
}

/// MCAP allows any order in a file; what reads a stream as it comes would take another frame for the last one.
#[test]
fn messages_out_of_order_of_time_are_refused() {
    let written = |times: [u64; 3]| {
        let mut writer = Writer::compressed(Vec::new(), &provenance(), Compression::None).unwrap();
        for time in times {
            writer.points("/particles", time, "world", table(2)).unwrap();
            // Other topics have times of their own.
            writer.bytes("/log", "json", 7, b"{}").unwrap();
        }
        writer.finish().unwrap()
    };
    assert!(read(&written([1_000_000_000, 3_000_000_000, 3_000_000_000])).is_ok());
    let told = read(&written([1_000_000_000, 3_000_000_000, 2_500_000_000])).unwrap_err().to_string();
    assert!(told.contains("'/particles': a message of 2.5 s follows one of 3 s"), "{told}");
}
