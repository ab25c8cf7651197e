//! Regions of cloud-crop and of wallgen, and prisms.
#![no_main]
use geom::Vec3;
use std::path::Path;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let _ = geom::prism::Prism::from_json(text).map(|p| p.contains(&Vec3::zeros()));
    if grainpipe_fuzz::names_a_device(text) {
        return;
    }
    let mut rules = cloud::crop::Rules::default();
    let _ = cloud::crop::add_regions(&mut rules, text, Path::new("/nowhere"));
    let material = record::MaterialRecord { name: "steel".to_owned(), ..Default::default() };
    let none = |_: &str| Err("no meshes here".to_owned());
    let _ = wall::Regions::parse(text, material, Vec3::zeros(), &none, &|_| Ok(text.to_owned()));
});
