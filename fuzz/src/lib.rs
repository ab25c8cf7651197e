//! What the fuzz targets share: inputs repaired so that they reach behind checksums, and a folder in memory for parsers of files.

use sha2::{Digest, Sha256};
use std::path::PathBuf;

/// A panic that a reader catches and turns into an error is no finding; one that leaves the target still is, by `libfuzzer-sys`.
pub fn quiet() {
    std::panic::set_hook(Box::new(|_| {}));
}

/// Puts zeros, which mean "not taken", for the CRCs of an MCAP stream: a flipped byte then reaches the parsers behind them.
pub fn without_crcs(data: &[u8]) -> Vec<u8> {
    let mut bytes = data.to_vec();
    let mut at = 8;
    while let Some(head) = bytes.get(at..).and_then(|rest| rest.get(..9)) {
        let mut length = [0; 8];
        length.copy_from_slice(&head[1..]);
        let (opcode, length) = (head[0], usize::try_from(u64::from_le_bytes(length)).unwrap_or(usize::MAX));
        // Offsets of a CRC in the content of a chunk, of the end of data, and of the footer.
        let crc = match opcode {
            0x06 => Some(24),
            0x0f => Some(0),
            0x02 => Some(16),
            _ => None,
        };
        if let Some(crc) = crc.and_then(|crc| bytes.get_mut(at + 9 + crc..at + 13 + crc)) {
            crc.fill(0);
        }
        let Some(next) = (at + 9).checked_add(length) else { break };
        at = next;
    }
    bytes
}

/// A checkpoint with `body`, under a head that is right for it.
pub fn state_of(body: &[u8]) -> Vec<u8> {
    let mut bytes = b"GRNSTATE".to_vec();
    bytes.extend(stream::state::VERSION.to_le_bytes());
    bytes.extend((body.len() as u64).to_le_bytes());
    bytes.extend(Sha256::digest(body));
    bytes.extend(body);
    bytes
}

/// Writes a file in memory, for parsers that are given a path.
pub fn file(name: &str, data: &[u8]) -> PathBuf {
    let folder = ["/dev/shm", "/tmp"].into_iter().find(|f| std::path::Path::new(f).is_dir()).unwrap_or(".");
    let path = PathBuf::from(folder).join(format!("grainpipe-fuzz-{}-{name}", std::process::id()));
    std::fs::write(&path, data).expect("a file in memory can be written");
    path
}

/// Whether a text names what blocks or never ends when it is opened: devices are the user's own choice.
pub fn names_a_device(text: &str) -> bool {
    ["/dev", "/proc", "/sys", "fd/"].iter().any(|part| text.contains(part))
}
