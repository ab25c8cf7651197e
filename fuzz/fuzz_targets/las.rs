//! LAS and LAZ as a cloud.
#![no_main]

libfuzzer_sys::fuzz_target!(init: grainpipe_fuzz::quiet(), |data: &[u8]| {
    if data.starts_with(b"LASF") {
        let _ = cloud::from_bytes(data.to_vec()).map(|cloud| cloud.finite());
    }
});
