//! Other content, and changed bytes.

use super::e57::e57_bytes;
use super::las::las_bytes;
use super::refused;
use cloud::from_bytes;

#[test]
fn other_content_is_refused_by_name() {
    for (bytes, part) in [
        (&b""[..], "nothing to read"),
        (b"\x1f\x8b\x08\0\0\0", "gunzip"),
        (b"\x89MCAP0\r\n", "MCAP"),
        (b"PK\x03\x04....", "zip"),
        (b"\0\0\0\0\0\0", "\\x00"),
        (b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float a\nend_header\n1\n", "no element has"),
        (b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n", "no 'y'"),
        (b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n", "PLY"),
    ] {
        let message = refused(bytes);
        assert!(message.contains(part), "{part}: {message}");
    }
}

/// Whatever a byte is changed to, the reader comes back, with a cloud or with an error.
#[test]
fn flipped_bytes_never_end_the_program() {
    let ply = b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
                property float z\nend_header\n123412341234123412341234";
    let text = b"2\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n";
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    for whole in [las_bytes(false), las_bytes(true), e57_bytes(), ply.to_vec(), text.to_vec()] {
        for _ in 0..400 {
            let mut bytes = whole.clone();
            // Headers are short: half of the changes go there.
            let reach = if next() % 2 == 0 { bytes.len().min(400) } else { bytes.len() };
            let at = next() % reach;
            bytes[at] ^= 1 << (next() % 8);
            let _ = from_bytes(bytes);
        }
    }
}
