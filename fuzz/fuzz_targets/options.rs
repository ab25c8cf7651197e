//! Options of a command line: shapes and planes.
#![no_main]
use geom::{Plane, Shape, Vec3};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    if grainpipe_fuzz::names_a_device(text) {
        return;
    }
    let place = Vec3::new(0.1, -0.2, 0.3);
    let _ = text.parse::<Shape>().map(|shape| shape.contains(&place));
    let _ = text.parse::<Plane>().map(|plane| plane.project(&place));
});
