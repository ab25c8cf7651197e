//! Text as XYZ or PTS.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    if !matches!(cloud::formats::name_of(data), Some("LAS/LAZ" | "E57" | "PCD")) {
        let _ = cloud::from_bytes(data.to_vec()).map(|cloud| cloud.finite());
    }
});
