//! PLY: every element of it, as a cloud, and as a mesh.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let _ = stream::ply::parse(data);
    if data.starts_with(b"ply") {
        let _ = cloud::from_bytes(data.to_vec()).map(|cloud| cloud.finite());
        let _ = cloud::read_mesh(&mut &data[..]);
    }
});
