//! Streams that were cut, changed or never finished.

use super::*;

/// Hazard 1: the mcap crate ends a file on drop, so that a failed tool leaves one that looks whole.
#[test]
fn a_stream_that_was_not_finished_is_refused() {
    for how in [Compression::None, Compression::Zstd] {
        let mut bytes = Vec::new();
        drop(begin(&mut bytes, how));
        assert!(matches!(read(&bytes), Err(McapError::Truncated { messages: 6, .. })));
        assert!(!bytes.ends_with(::mcap::MAGIC));
        assert_eq!(Reader::new(&bytes[..]).filter(Result::is_ok).count(), 8, "earlier data are readable");
    }
    // A foreign program's file, whole by its own summary, but without the record.
    let mut other = ::mcap::Writer::new(io::Cursor::new(Vec::new())).unwrap();
    other.finish().unwrap();
    let bytes = other.into_inner().into_inner();
    assert!(matches!(read(&bytes), Err(McapError::Truncated { messages: 0, .. })));
}

/// Hazard 2: with default options a flipped byte in a packed chunk is read without an error.
#[test]
fn no_flipped_byte_is_read_as_good() {
    for how in [Compression::None, Compression::Zstd] {
        let good = stream(how);
        for at in 0..good.len() {
            for mask in [0x01, 0x80] {
                let mut bad = good.clone();
                bad[at] ^= mask;
                assert!(read(&bad).is_err(), "{how:?}: byte {at} of {}", good.len());
            }
        }
    }
}

/// What a chunk holds is given out only after its CRC was checked.
#[test]
fn nothing_of_a_damaged_chunk_is_given_out() {
    let mut bytes = stream(Compression::None);
    let last = bytes.windows(7).position(|w| w == b"kinetic").unwrap();
    bytes[last] ^= 1;
    let events: Vec<_> = Reader::new(&bytes[..]).collect();
    assert!(
        matches!(&events[2], Err(McapError::Malformed { what, .. }) if what.contains("CRC")),
        "{events:?}"
    );
    assert_eq!(events.len(), 3, "ends after the first error");
}

/// Hazard 3: of `cat a.mcap b.mcap` only the first is read, silently.
#[test]
fn bytes_after_the_end_are_refused() {
    let twice = [stream(Compression::None), stream(Compression::None)].concat();
    assert!(matches!(read(&twice), Err(McapError::Trailing { .. })));
    assert!(matches!(
        read(&[&stream(Compression::Zstd)[..], b"\n"].concat()),
        Err(McapError::Trailing { .. })
    ));
}

#[test]
fn a_cut_stream_is_refused_and_gives_what_came_before() {
    let good = stream(Compression::Zstd);
    for end in 0..good.len() {
        let events: Vec<_> = Reader::new(&good[..end]).collect();
        assert!(events.last().is_some_and(Result::is_err), "cut at {end}");
    }
    assert!(matches!(read(b""), Err(McapError::Empty)));
    assert!(matches!(read(b"ply\nformat ascii 1.0\n"), Err(McapError::Magic)));
}

#[test]
fn point_clouds_that_contradict_themselves_are_refused() {
    use crate::mcap::point_cloud::{PackedElementField, PointCloud};
    use prost::Message;
    let refused = |stride, offset, kind, bytes: usize, expected: &str| {
        let field = PackedElementField { name: "x".into(), offset, r#type: kind };
        let data = vec![0; bytes].into();
        let cloud = PointCloud { point_stride: stride, fields: vec![field], data, ..Default::default() };
        let message = points::decode(cloud.encode_to_vec()).unwrap_err();
        assert!(message.contains(expected), "{message}");
    };
    refused(0, 0, 8, 8, "point_stride is 0");
    refused(8, 0, 8, 9, "not a whole number of rows");
    refused(8, 1, 8, 8, "reaches over the end");
    refused(8, u32::MAX, 8, 8, "reaches over the end");
    refused(8, 0, 99, 8, "unknown type");
}
