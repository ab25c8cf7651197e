//! PCD (text, binary, packed) as a cloud.
#![no_main]

libfuzzer_sys::fuzz_target!(init: grainpipe_fuzz::quiet(), |data: &[u8]| {
    if cloud::formats::name_of(data) == Some("PCD") {
        let _ = cloud::from_bytes(data.to_vec()).map(|cloud| cloud.finite());
    }
});
