//! A file of particles (CSV, PLY, a run) as a scene takes it, with the checks of the engine.
#![no_main]
use std::path::Path;

const SCENE: &str = "[time]\nuntil = 1\ndt = 1e-5\n[[material]]\nname = \"a\"\ndensity = 2500\nyoung = 1e7\npoisson = 0.25\n\
    [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n";

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let path = grainpipe_fuzz::file("particles", &grainpipe_fuzz::without_crcs(data));
    let toml = format!("{SCENE}[[particles]]\nmaterial = \"a\"\nsource = \"{}\"\n", path.display());
    let scene = scene::Scene::new("s.toml", toml, &[], Path::new("")).expect("the scene is sound");
    if let Ok(plan) = scene.plan(Vec::new()) {
        let _ = run::ready(&scene, &plan, None);
    }
});
