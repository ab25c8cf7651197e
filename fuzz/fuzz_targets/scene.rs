//! A scene: its first line is a change as by --set, the rest its text; read, checked, and cut in two stages.
#![no_main]
use geom::{Plane, Vec3};
use stages::split::{Cut, Stage, split};
use std::path::Path;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    if grainpipe_fuzz::names_a_device(text) {
        return;
    }
    let (set, toml) = text.split_once('\n').unwrap_or(("", text));
    let changes = [set.to_owned()];
    let changes = if set.is_empty() { &[][..] } else { &changes[..] };
    let Ok(scene) = scene::Scene::new("s.toml", toml.to_owned(), changes, Path::new("/nowhere")) else { return };
    // Also "auto" lengths; fills are not placed: a fill of a million grains takes its time, which is no fault.
    for keep in [Stage::Upstream, Stage::Downstream] {
        let plane = Plane { point: Vec3::zeros(), normal: -Vec3::z() };
        let cut = Cut { plane, keep, length: None, motion: Default::default(), test: Default::default(), folder: "/nowhere".into() };
        let _ = split(&scene, &cut);
    }
});
