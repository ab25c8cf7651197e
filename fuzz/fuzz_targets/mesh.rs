//! Files of meshes, as scenes and shapes take them.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let path = grainpipe_fuzz::file("mesh", data);
    let _ = scene::input::read_mesh(&path, 1.0).map(|mesh| (mesh.area(), geom::mesh::Inside::new(&mesh).is_ok()));
});
