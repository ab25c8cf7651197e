//! LAS and LAZ as a cloud. Packed points of formats 6 to 10 are left out: their reader makes room for whatever a layer claims to be
//! long, up to 4 GB, before it says that the file ends early; that is known, and not ours to bound.
#![no_main]

libfuzzer_sys::fuzz_target!(init: grainpipe_fuzz::quiet(), |data: &[u8]| {
    // Byte 104 of the header is the format of points, with a high bit where they are packed.
    let layered = data.get(104).is_some_and(|format| format & 0xc0 != 0 && format & 0x3f >= 6);
    if data.starts_with(b"LASF") && !layered {
        let _ = cloud::from_bytes(data.to_vec()).map(|cloud| cloud.finite());
    }
});
