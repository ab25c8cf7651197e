//! Exact state (checkpoints): `bincode` behind magic, version, length and hash.
//!
//! ```text
//! 8 bytes  "GRNSTATE"
//! 4 bytes  version, little endian
//! 8 bytes  length of the body [B], little endian
//! 32 bytes SHA-256 of the body
//! body     bincode 2, standard configuration with fixed-width integers
//! ```
//!
//! Floats are written by their bits, so that a resumed run continues exactly as the one that was stopped.
//! This file is the only one that knows bincode.

use bincode::config::{self, Config};
use serde::{Serialize, de::DeserializeOwned};
use sha2::{Digest, Sha256};
use std::io::Write;
use thiserror::Error;

const MAGIC: &[u8; 8] = b"GRNSTATE";
/// Layout of the body. Raised whenever a field of what is written comes, goes or changes: `tests/tests/tools/layout.rs` holds each
/// layout to its number.
pub const VERSION: u32 = 19;
const HEAD: usize = 8 + 4 + 8 + 32;
/// No state is larger [B].
const LIMIT: usize = 1 << 38;

/// What is wrong with a state.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum StateError {
    #[error("state: not a state: GRNSTATE is missing at its start")]
    Magic,
    #[error(
        "state: its layout has version {found}, this program reads version {VERSION}: use the program that wrote it"
    )]
    Version { found: u32 },
    #[error("state: {found} bytes where {expected} were written: it is cut off or something was added")]
    Length { found: u64, expected: u64 },
    #[error("state: its SHA-256 does not match: bytes were changed")]
    Hash,
    #[error("state: its content is not what this program expects")]
    Decode(#[source] Box<bincode::error::DecodeError>),
    #[error("state: cannot be written")]
    Write(#[source] std::io::Error),
    #[error("state: cannot be encoded")]
    Encode(#[source] Box<bincode::error::EncodeError>),
}

fn layout<const MOST: usize>() -> impl Config {
    config::standard().with_fixed_int_encoding().with_limit::<MOST>()
}

/// Decodes a body. Its own size bounds what a length in it may claim; a limit is a constant, so that a few sizes must do.
fn decode_body<T: DeserializeOwned>(body: &[u8]) -> Result<(T, usize), bincode::error::DecodeError> {
    match body.len() {
        0..0x10_0000 => bincode::serde::decode_from_slice(body, layout::<0x20_0000>()),
        0x10_0000..0x400_0000 => bincode::serde::decode_from_slice(body, layout::<0x800_0000>()),
        0x400_0000..0x1_0000_0000 => bincode::serde::decode_from_slice(body, layout::<0x2_0000_0000>()),
        _ => bincode::serde::decode_from_slice(body, layout::<LIMIT>()),
    }
}

/// Encodes a state.
///
/// # Errors
/// A value that has no fixed layout (a map of unknown length).
pub fn encode(state: &impl Serialize) -> Result<Vec<u8>, StateError> {
    let mut bytes = Vec::new();
    encode_to(state, &mut bytes)?;
    Ok(bytes)
}

/// Encodes a state into `out`, without ever holding the whole: once to count and to hash, once to write.
///
/// # Errors
/// As for [`encode`], or what `out` says.
pub fn encode_to(state: &impl Serialize, out: &mut impl Write) -> Result<(), StateError> {
    let wrong = |e| StateError::Encode(Box::new(e));
    let mut sum = Sum { hash: Sha256::new(), length: 0 };
    bincode::serde::encode_into_std_write(state, &mut sum, layout::<LIMIT>()).map_err(wrong)?;
    let mut head = [0; HEAD];
    head[..8].copy_from_slice(MAGIC);
    head[8..12].copy_from_slice(&VERSION.to_le_bytes());
    head[12..20].copy_from_slice(&sum.length.to_le_bytes());
    head[20..].copy_from_slice(&sum.hash.finalize());
    out.write_all(&head).map_err(StateError::Write)?;
    bincode::serde::encode_into_std_write(state, out, layout::<LIMIT>()).map_err(wrong)?;
    Ok(())
}

/// Counts and hashes what is written to it.
struct Sum {
    hash: Sha256,
    length: u64,
}

impl Write for Sum {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.hash.update(bytes);
        self.length += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Decodes a state, after checking that it is whole.
///
/// # Errors
/// Another version; bytes missing, added or changed; another type.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, StateError> {
    if !bytes.starts_with(MAGIC) {
        return Err(StateError::Magic);
    }
    let cut = StateError::Length { found: bytes.len() as u64, expected: HEAD as u64 };
    let (head, body) = bytes.split_at_checked(HEAD).ok_or(cut)?;
    let found = u32::from_le_bytes([head[8], head[9], head[10], head[11]]);
    if found != VERSION {
        return Err(StateError::Version { found });
    }
    let expected = head[12..20].iter().rev().fold(0u64, |n, &b| (n << 8) | u64::from(b));
    if expected != body.len() as u64 {
        return Err(StateError::Length { found: body.len() as u64, expected });
    }
    if Sha256::digest(body).as_slice() != &head[20..] {
        return Err(StateError::Hash);
    }
    let wrong = |e| StateError::Decode(Box::new(e));
    let (state, read) = decode_body(body).map_err(wrong)?;
    if read != body.len() {
        return Err(StateError::Length { found: body.len() as u64, expected: read as u64 });
    }
    Ok(state)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    type State = (Vec<f64>, BTreeMap<u32, [f64; 3]>, Option<u16>);

    fn state() -> State {
        (vec![f64::NAN, -0.0, 5e-324, 1.0 / 3.0], BTreeMap::from([(7, [1.0, 2.0, 3.0])]), Some(9))
    }

    #[test]
    fn every_bit_comes_back() {
        let (floats, map, option) = decode::<State>(&encode(&state()).unwrap()).unwrap();
        let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&floats), bits(&state().0));
        assert_eq!((map, option), (state().1, state().2));
    }

    #[test]
    fn no_changed_cut_or_lengthened_state_is_read() {
        let good = encode(&state()).unwrap();
        for at in 0..good.len() {
            let mut bad = good.clone();
            bad[at] ^= 0x10;
            assert!(decode::<State>(&bad).is_err(), "byte {at}");
            assert!(decode::<State>(&good[..at]).is_err(), "cut at {at}");
        }
        assert!(matches!(decode::<State>(&[&good[..], b"x"].concat()), Err(StateError::Length { .. })));
        assert!(matches!(decode::<State>(b"PLY"), Err(StateError::Magic)));
    }

    #[test]
    fn another_type_is_refused_and_takes_no_memory() {
        let bytes = encode(&u64::MAX).unwrap();
        assert!(matches!(decode::<Vec<f64>>(&bytes), Err(StateError::Decode(_))));
        assert!(decode::<State>(&encode(&1u8).unwrap()).is_err());
    }
}
