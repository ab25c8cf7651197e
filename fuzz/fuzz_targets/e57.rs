//! E57 as a cloud.
#![no_main]

libfuzzer_sys::fuzz_target!(init: grainpipe_fuzz::quiet(), |data: &[u8]| {
    if data.starts_with(b"ASTM-E57") {
        let _ = cloud::from_bytes(data.to_vec()).map(|cloud| cloud.finite());
    }
});
