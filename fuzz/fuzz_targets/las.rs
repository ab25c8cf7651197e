//! LAS and LAZ as a cloud. A packed file may hold a thousand points in a byte, and garbage does: of the files that promise very many points
//! only one in sixty-four is unpacked, by a number of all its bytes: what is made of one is not one of them again, and the others have their turn.
#![no_main]

/// Points that are unpacked in no time.
const FEW: u64 = 2_000;

/// A number that any other byte changes.
fn number_of(data: &[u8]) -> u64 {
    data.iter().fold(0, |number: u64, &byte| (number ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)) >> 32
}

libfuzzer_sys::fuzz_target!(init: grainpipe_fuzz::quiet(), |data: &[u8]| {
    let number = |at: usize, size: usize| {
        data.get(at..at + size).map_or(0, |bytes| bytes.iter().rev().fold(0, |n, &byte| (n << 8) | u64::from(byte)))
    };
    // The count of old files, and that of version 1.4.
    let promised = number(107, 4).max(if number(25, 1) >= 4 { number(247, 8) } else { 0 });
    let long = promised > FEW && promised / 1000 <= data.len() as u64;
    if data.starts_with(b"LASF") && (!long || number_of(data) % 64 == 0) {
        let _ = cloud::from_bytes(data.to_vec()).map(|cloud| cloud.finite());
    }
});
