//! Files of other programs, whose messages may be in any order.

use super::*;
use crate::mcap::in_order;
use ::mcap::{WriteOptions, records::MessageHeader};
use std::io::Cursor;

/// Topic, time [ns] and text of each message, in the order in which they stand in a file.
const MESSAGES: [(&str, u64, &str); 8] = [
    ("/a", 30, "a3"),
    ("/b", 20, "b2"),
    ("/a", 10, "a1"),
    ("/a", 20, "a2"),
    ("/b", 40, "b4"),
    ("/b", 10, "b1"),
    ("/a", 30, "a3 again"),
    ("/b", 40, "b4 again"),
];

/// A file of another program: two messages a chunk.
fn file(options: WriteOptions, messages: &[(&str, u64, &str)]) -> Vec<u8> {
    written(options, messages, false)
}

/// The same with the record that ends the stream in front of the messages.
fn end_first(options: WriteOptions, messages: &[(&str, u64, &str)]) -> Vec<u8> {
    written(options, messages, true)
}

fn written(options: WriteOptions, messages: &[(&str, u64, &str)], is_end_first: bool) -> Vec<u8> {
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    let note = |name: &str, key: &str, value: &str| ::mcap::records::Metadata {
        name: name.to_owned(),
        metadata: one(key, value),
    };
    writer.write_metadata(&note("scene", "toml", "gravity = 1")).unwrap();
    let end = note(END_OF_STREAM, "messages", &messages.len().to_string());
    if is_end_first {
        writer.write_metadata(&end).unwrap();
    }
    for (k, (topic, log_time, text)) in (0u32..).zip(messages) {
        let schema_id = writer.add_schema("any", "jsonschema", b"{}").unwrap();
        let channel_id = writer.add_channel(schema_id, topic, "json", &BTreeMap::new()).unwrap();
        let header = MessageHeader { channel_id, sequence: k, log_time: *log_time, publish_time: *log_time };
        writer.write_to_known_channel(&header, text.as_bytes()).unwrap();
        if k % 2 == 1 {
            writer.flush().unwrap();
        }
    }
    if !is_end_first {
        writer.write_metadata(&end).unwrap();
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

/// Writers: with an index, without one, packed, without chunks, without a summary.
fn ways() -> [WriteOptions; 6] {
    let new = || WriteOptions::new().chunk_size(None).compression(None);
    [
        new(),
        new().compression(Some(::mcap::Compression::Zstd)),
        new().emit_message_indexes(false),
        new().use_chunks(false),
        new().emit_summary_records(false).emit_summary_offsets(false),
        new().repeat_channels(false).repeat_schemas(false).emit_message_indexes(false),
    ]
}

/// The same file with all that stands between its header and its end in one chunk without an index, as a program may write it.
fn in_one_chunk(bytes: &[u8]) -> Vec<u8> {
    let mut rest = &bytes[8..bytes.len() - 8];
    let (mut head, mut records) = (Vec::new(), Vec::new());
    while let Ok((opcode, body)) = crate::mcap::chunk::next_record(&mut rest) {
        let record = [&[opcode][..], &(body.len() as u64).to_le_bytes(), body].concat();
        match opcode {
            ::mcap::records::op::HEADER => head = record,
            ::mcap::records::op::DATA_END => break,
            _ => records.extend(record),
        }
    }
    let size = (records.len() as u64).to_le_bytes();
    let body = [&[0; 16][..], &size, &[0; 8], &size, &records].concat();
    let chunk = [&[::mcap::records::op::CHUNK][..], &(body.len() as u64).to_le_bytes(), &body].concat();
    let empty =
        |op: u8, length: usize| [&[op][..], &(length as u64).to_le_bytes(), &vec![0; length]].concat();
    [::mcap::MAGIC, &head, &chunk, &empty(0x0f, 4), &empty(0x02, 20), ::mcap::MAGIC].concat()
}

fn texts(from: impl Read) -> Result<Vec<(String, u64, String)>, McapError> {
    let events = Reader::new(from).collect::<Result<Vec<_>, _>>()?;
    let text = |event| match event {
        Event::Bytes { topic, time_ns, data } => {
            Some((topic, time_ns, String::from_utf8_lossy(&data).into_owned()))
        }
        Event::Metadata { name, .. } => Some((name, 0, String::new())),
        Event::Points { .. } => None,
    };
    Ok(events.into_iter().filter_map(text).collect())
}

#[test]
fn messages_of_a_file_come_in_the_order_of_time() {
    let mut sorted = MESSAGES;
    sorted.sort_by_key(|(_, time_ns, _)| *time_ns);
    let expected = sorted.iter().map(|(topic, time, text)| ((*topic).to_owned(), *time, (*text).to_owned()));
    let expected: Vec<_> = std::iter::once(("scene".to_owned(), 0, String::new())).chain(expected).collect();
    let mut files: Vec<Vec<u8>> = ways().into_iter().map(|options| file(options, &MESSAGES)).collect();
    files.push(in_one_chunk(&files[3]));
    for (k, bytes) in files.iter().enumerate() {
        let refused = texts(&bytes[..]).unwrap_err();
        assert!(matches!(refused, McapError::Order { .. }), "{k}: from a pipe: {refused}");
        assert_eq!(texts(in_order(Cursor::new(bytes)).unwrap()).unwrap(), expected, "{k}");
        let mut one_by_one = in_order(Cursor::new(bytes)).unwrap();
        let mut all = Vec::new();
        one_by_one.read_to_end(&mut all).unwrap();
        assert_eq!(texts(Slow(&all)).unwrap(), expected, "{k}");
    }
}

/// A file of a program that writes all metadata first, or before the chunk that is open: what ends the stream comes last.
#[test]
fn what_ends_a_stream_may_stand_in_front_of_its_messages() {
    let mut sorted = MESSAGES;
    sorted.sort_by_key(|(_, time_ns, _)| *time_ns);
    let wanted = texts(&file(WriteOptions::new(), &sorted)[..]).unwrap();
    for (k, options) in ways().into_iter().enumerate() {
        let bytes = end_first(options, &sorted);
        assert!(texts(&bytes[..]).is_err(), "{k}: from a pipe it cannot be known");
        assert_eq!(texts(in_order(Cursor::new(&bytes)).unwrap()).unwrap(), wanted, "{k}");
    }
}

/// Other bytes than MCAP, files in order and files without an end are read byte for byte.
#[test]
fn other_files_are_read_as_they_are() {
    let mut sorted = MESSAGES;
    sorted.sort_by_key(|(_, time_ns, _)| *time_ns);
    let mut files: Vec<Vec<u8>> = ways().into_iter().map(|options| file(options, &sorted)).collect();
    // Two channels may be apart in time: each of them is in order.
    files.push(file(WriteOptions::new(), &[("/a", 5, "a"), ("/b", 3, "b"), ("/a", 6, "a")]));
    files.push(stream(Compression::Zstd));
    let whole = file(WriteOptions::new(), &MESSAGES);
    files.extend([whole[..whole.len() - 1].to_vec(), whole[..100].to_vec(), b"ply\n".to_vec(), Vec::new()]);
    for (k, bytes) in files.iter().enumerate() {
        let mut read = Vec::new();
        in_order(Cursor::new(bytes)).unwrap().read_to_end(&mut read).unwrap();
        assert!(read == *bytes, "{k}");
    }
}

/// Whatever byte is changed: the messages, an error, or other bytes of a text; never a panic, or messages that go back in time.
#[test]
fn damaged_files_do_no_harm() {
    let length = |bytes: &[u8]| texts(in_order(Cursor::new(bytes)).unwrap()).map(|all| all.len());
    for options in ways() {
        let whole = file(options, &MESSAGES);
        for at in 0..whole.len() {
            for flip in [0x01, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] ^= flip;
                let _ = length(&bytes);
            }
            // Lengths and places as large as a number can be.
            for wide in [[0xff; 8], [0xf7, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff]] {
                let mut bytes = whole.clone();
                let end = (at + wide.len()).min(bytes.len());
                bytes[at..end].copy_from_slice(&wide[..end - at]);
                let _ = length(&bytes);
            }
            let _ = length(&whole[..at]);
        }
    }
}
