//! Damage by structure: words and lines of a text, fields and records of a binary file, with checksums that are right again.

use super::values;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Changes bytes of a format, and says how.
pub fn mutate(name: &str, bytes: &[u8], rng: &mut Pcg64Mcg) -> (Vec<u8>, String) {
    // The head of a PLY or PCD is text, whatever follows.
    let head = head(bytes);
    let is_text = head == bytes.len() || head > 0 && rng.random_bool(0.6);
    let (mut new, change) = match is_text {
        true => text(bytes, head, rng),
        false if name.ends_with(".mcap") && rng.random_bool(0.3) => records(bytes, rng),
        false => binary(bytes, head, rng),
    };
    match name.rsplit('.').next() {
        Some("mcap") => zero_crcs(&mut new),
        Some("e57") => seal_pages(&mut new),
        Some("png") => seal_chunks(&mut new),
        _ => {}
    }
    (new, format!("{name}: {change}"))
}

/// Bytes that are text: all of them, the head of a PLY or PCD, or none.
fn head(bytes: &[u8]) -> usize {
    let end = |mark: &[u8]| bytes.windows(mark.len()).position(|w| w == mark).map(|at| at + mark.len());
    let marked = match bytes {
        [b'p', b'l', b'y', ..] => end(b"end_header\n"),
        [b'#', b' ', b'.', b'P', ..] => end(b"\nDATA ").map(|at| at + 20),
        _ => None,
    };
    match std::str::from_utf8(bytes) {
        Ok(_) => bytes.len(),
        Err(_) => marked.unwrap_or(0).min(bytes.len()),
    }
}

/// One word or line of the first `head` bytes is replaced, doubled, dropped or swapped.
fn text(bytes: &[u8], head: usize, rng: &mut Pcg64Mcg) -> (Vec<u8>, String) {
    let whole = String::from_utf8_lossy(&bytes[..head]).into_owned();
    let mut lines: Vec<String> = whole.split('\n').map(str::to_owned).collect();
    let k = rng.random_range(0..lines.len());
    let change = match rng.random_range(0..8) {
        0 => {
            let line = lines.remove(k);
            format!("without line {line:?}")
        }
        1 => {
            lines.insert(k, lines[k].clone());
            format!("line {:?} twice", lines[k])
        }
        2 => {
            let other = rng.random_range(0..lines.len());
            lines.swap(k, other);
            format!("lines {k} and {other} swapped")
        }
        _ => {
            let words = words(&lines[k]);
            if words.is_empty() {
                lines[k] = values::WORD[rng.random_range(0..values::WORD.len())].to_owned();
                format!("line {k} is {:?}", lines[k])
            } else {
                let word = words[rng.random_range(0..words.len())].clone();
                let new = values::WORD[rng.random_range(0..values::WORD.len())];
                let change = format!("{:?} in {:?} is {new:?}", &lines[k][word.clone()], lines[k]);
                lines[k].replace_range(word, new);
                change
            }
        }
    };
    let mut new = lines.join("\n").into_bytes();
    new.extend(&bytes[head..]);
    (new, change)
}

/// Runs of letters, digits, dots and signs.
fn words(line: &str) -> Vec<std::ops::Range<usize>> {
    let (mut found, mut from) = (Vec::new(), None);
    for (k, c) in line.char_indices().chain([(line.len(), ' ')]) {
        match (c.is_alphanumeric() || "._-+".contains(c), from) {
            (true, None) => from = Some(k),
            (false, Some(start)) => {
                found.push(start..k);
                from = None;
            }
            _ => {}
        }
    }
    found
}

/// One number behind `head` is replaced, or the file ends early or goes on.
fn binary(bytes: &[u8], head: usize, rng: &mut Pcg64Mcg) -> (Vec<u8>, String) {
    let mut new = bytes.to_vec();
    if head >= bytes.len() {
        return (new, "nothing".to_owned());
    }
    // Half of all hits go to the first 600 bytes, where headers are.
    let last = if rng.random_bool(0.5) { bytes.len().min(head + 600) } else { bytes.len() };
    let at = rng.random_range(head..last);
    match rng.random_range(0..12) {
        0 => {
            new.truncate(at);
            (new, format!("cut off at {at}"))
        }
        1 => {
            new.extend_from_slice(&bytes[at..]);
            (new, format!("bytes from {at} on twice"))
        }
        _ => {
            let all = values::bytes();
            let value = &all[rng.random_range(0..all.len())];
            let end = (at + value.len()).min(new.len());
            new[at..end].copy_from_slice(&value[..end - at]);
            (new, format!("{value:02x?} at {at}"))
        }
    }
}

/// One record of an MCAP is dropped, doubled, or swapped with the next one.
fn records(bytes: &[u8], rng: &mut Pcg64Mcg) -> (Vec<u8>, String) {
    let mut found = Vec::new();
    let mut at = 8;
    while let Some(length) = bytes.get(at + 1..at + 9) {
        let length = u64::from_le_bytes(length.try_into().expect("8 bytes")) as usize;
        let end = at + 9 + length;
        if end > bytes.len() {
            break;
        }
        found.push(at..end);
        at = end;
    }
    let k = rng.random_range(0..found.len());
    let what = rng.random_range(0..3);
    let mut new = bytes[..8].to_vec();
    for (n, record) in found.iter().enumerate() {
        let other = found.get(n + 1).filter(|_| what == 2 && n == k).unwrap_or(record);
        let other = if what == 2 && n == k + 1 { &found[k] } else { other };
        let times = match (n == k, what) {
            (true, 0) => 0,
            (true, 1) => 2,
            _ => 1,
        };
        (0..times).for_each(|_| new.extend(&bytes[other.clone()]));
    }
    new.extend(&bytes[at..]);
    (
        new,
        format!(
            "record {k} (opcode {:#04x}) {}",
            bytes[found[k].start],
            ["dropped", "twice", "behind the next"][what]
        ),
    )
}

/// Puts zeros, which mean "not taken", for the CRCs of an MCAP stream.
fn zero_crcs(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(head) = bytes.get(at..at + 9) {
        let length = u64::from_le_bytes(head[1..9].try_into().expect("8 bytes"));
        let crc = match head[0] {
            0x06 => Some(24),
            0x0f => Some(0),
            0x02 => Some(16),
            _ => None,
        };
        if let Some(crc) = crc.and_then(|crc| bytes.get_mut(at + 9 + crc..at + 13 + crc)) {
            crc.fill(0);
        }
        let next = usize::try_from(length).ok().and_then(|l| (at + 9).checked_add(l));
        let Some(next) = next else { return };
        at = next;
    }
}

/// Makes the CRC of each page of an E57 right: CRC-32C of 1020 bytes, big-endian.
fn seal_pages(bytes: &mut [u8]) {
    for page in bytes.chunks_exact_mut(1024) {
        let sum = crc(&page[..1020], 0x82f6_3b78);
        page[1020..].copy_from_slice(&sum.to_be_bytes());
    }
}

/// Makes the CRC of each chunk of a PNG right: CRC-32 of its type and data, big-endian.
fn seal_chunks(bytes: &mut [u8]) {
    let mut at = 8;
    while let Some(head) = bytes.get(at..at + 4) {
        let length = u32::from_be_bytes(head.try_into().expect("4 bytes")) as usize;
        let end = at + 8 + length;
        if bytes.len() < end + 4 {
            return;
        }
        let sum = crc(&bytes[at + 4..end], 0xedb8_8320);
        bytes[end..end + 4].copy_from_slice(&sum.to_be_bytes());
        at = end + 4;
    }
}

fn crc(bytes: &[u8], polynomial: u32) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        (0..8).for_each(|_| crc = (crc >> 1) ^ (polynomial * (crc & 1)));
    }
    !crc
}
