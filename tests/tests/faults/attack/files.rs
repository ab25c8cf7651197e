//! Damaged files of every format, given to every tool that reads them.

use super::case::Case;
use super::folders;
use super::mutate::mutate;
use crate::samples::{self, Sample};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Calls that read a file, as `FILE`.
const CLOUD: &[&str] = &[
    "cloud-crop FILE --keep box:-1,-1,-1,2,2,2 -o out.ply",
    "cloud-crop FILE --largest 1 -o out.ply",
    "cloud-crop FILE --outliers 3,1 -o out.ply",
    "cloud-fill FILE -o out.ply",
    "bluenoise-sample FILE --spacing 0.01 -o out.ply",
    "bluenoise-sample FILE --count 3 --method eliminate -o out.ply",
    "wallgen FILE --roughness 0.001 -o out.ply",
    "dem-view FILE -o out.png --size 64x64",
];
const MESH: &[&str] = &[
    "wallgen --from-mesh FILE --roughness 0.01 --radius 0.05 -o out.ply",
    "dem-run mesh.toml --set wall.0.mesh=\"FILE\" --check",
    "dem-view FILE -o out.png --size 64x64",
    "cloud-crop ascii.ply --keep mesh:FILE -o out.ply",
];
const RUN: &[&str] = &[
    "dem-measure FILE --energy",
    "dem-measure FILE --contacts",
    "dem-measure FILE --profile",
    "dem-measure FILE --flow 0,0,0.02,0,0,-1",
    "dem-measure FILE --repose",
    "dem-view FILE -o out.png --size 64x64",
    "dem-view FILE -o out.html",
    "stage-replay FILE -o out.mcap",
    "dem-run scene.toml --resume FILE --until 0.013 -o out.mcap",
];
const WALLS: &[&str] =
    &["dem-run walls.toml FILE --until 0.001 -o out.mcap", "dem-view FILE -o out.png --size 64x64"];
const INLET: &[&str] = &["dem-run inlet.toml FILE --until 0.01 -o out.mcap"];
const SCENE: &[&str] = &[
    "dem-run FILE --check",
    "dem-run FILE --until 0.001 -o out.mcap",
    "stage-split FILE --at 0,0,0.03,0,0,-1 --keep upstream -o out.toml",
];
const GRAINS: &[&str] = &["dem-run grains.toml --set particles.0.source=\"FILE\" --until 1e-4 -o out.mcap"];
const REGIONS: &[&str] = &["cloud-crop ascii.ply --regions FILE -o out.ply"];
const ROUGH: &[&str] = &["wallgen ascii.ply --roughness FILE -o out.ply"];
const PRISM: &[&str] = &["cloud-crop ascii.ply --keep prism:FILE -o out.ply"];

/// Samples of each format, and the calls that read them.
fn formats(examples: &[(String, Vec<u8>)]) -> Vec<(&'static str, Vec<Sample>, &'static [&'static str])> {
    let (mut clouds, meshes): (Vec<_>, Vec<_>) =
        samples::ply().into_iter().partition(|s| !s.0.contains("mesh"));
    let (mcap, texts) = (samples::mcap(), samples::texts());
    let of = |all: &[Sample], names: &[&str]| -> Vec<Sample> {
        all.iter().filter(|s| names.contains(&s.0)).cloned().collect()
    };
    let grains = [of(&texts, &["grains.csv"]), clouds.split_off(1), of(&mcap, &["run.mcap"])].concat();
    let mut meshes = meshes;
    meshes.push((
        "mesh.obj",
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n".to_vec(),
    ));
    meshes.push(("mesh.stl", stl()));
    let further = |names: &[&'static str]| folders::samples(examples, names);
    vec![
        ("stones", [meshes.clone(), further(&["pebble.ply"])].concat(), folders::MESH),
        ("libraries of stones", further(&["library/rock_1_1.ply", "grains.csv"]), folders::LIBRARY),
        ("photographs", further(&["photographs/01.png", "masks/02.png"]), folders::PHOTOGRAPHS),
        ("tables of stones", further(&["turntable.toml", "poses.txt", "grading.csv"]), folders::TABLES),
        ("recipes and curves", further(&["recipe.toml", "shear.csv"]), folders::RECIPES),
        ("laboratory samples", further(&["stone.toml", "stone.csv", "soil.toml"]), folders::LABORATORY),
        ("PLY clouds", samples::ply().into_iter().filter(|s| !s.0.contains("mesh")).collect(), CLOUD),
        ("LAS and LAZ", samples::las(), CLOUD),
        ("E57", samples::e57(), CLOUD),
        ("PCD", samples::pcd(), CLOUD),
        ("XYZ and PTS", samples::xyz(), CLOUD),
        ("meshes (PLY, STL, OBJ)", meshes, MESH),
        ("runs", of(&mcap, &["run.mcap", "bonded.mcap", "packed.mcap"]), RUN),
        ("walls", of(&mcap, &["walls.mcap"]), WALLS),
        ("inlets", of(&mcap, &["inlet.mcap"]), INLET),
        ("scenes", vec![("scene.toml", samples::scene().into_bytes())], SCENE),
        ("particle files", grains, GRAINS),
        ("regions", of(&texts, &["regions.toml"]), REGIONS),
        ("roughness tables", of(&texts, &["roughness.toml"]), ROUGH),
        ("prisms", of(&texts, &["prism.json"]), PRISM),
    ]
}

/// A tetrahedron as binary STL.
fn stl() -> Vec<u8> {
    let corners = [[0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut bytes = vec![b' '; 80];
    bytes.extend(4u32.to_le_bytes());
    for face in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        bytes.extend([0; 12]);
        face.iter().flat_map(|&k: &usize| corners[k]).for_each(|c| bytes.extend(c.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// Files that calls read besides the damaged one.
pub fn others() -> Vec<(String, Vec<u8>)> {
    let scene = samples::scene();
    let cut = |text: &str, from: &str, to: &str| -> String {
        let start = text.find(from).unwrap_or(text.len());
        let end =
            if to.is_empty() { text.len() } else { text[start..].find(to).map_or(text.len(), |k| start + k) };
        text[..start].to_owned() + &text[end..]
    };
    let no_outlet = cut(&scene, "[[outlet]]", "");
    let mesh = no_outlet.replace("plane = \"0,0,-1,0,0,1\"", "mesh = \"mesh.ply\"");
    let walls = no_outlet.replace("plane = \"0,0,-1,0,0,1\"\n", "");
    let no_fill = cut(&no_outlet, "[[fill]]", "[[wall]]");
    let grains = format!("{no_fill}[[particles]]\nsource = \"grains.csv\"\nmaterial = \"sinter\"\n");
    let inlet = format!("{no_fill}[[inlet]]\nplane = \"0,0,0.02,0,0,-1\"\n");
    let ascii = samples::ply().remove(0).1;
    let files = [
        ("ascii.ply", ascii),
        ("scene.toml", scene.into_bytes()),
        ("mesh.toml", mesh.into_bytes()),
        ("walls.toml", walls.into_bytes()),
        ("grains.toml", grains.into_bytes()),
        ("inlet.toml", inlet.into_bytes()),
    ];
    files.map(|(name, bytes)| (name.to_owned(), bytes)).into()
}

/// `count` cases, shared out among formats.
pub fn cases(seed: u64, count: usize) -> Vec<Case> {
    let (examples, others) = (folders::files(), others());
    let formats = formats(&examples);
    let one = |k: usize| {
        let mut rng = Pcg64Mcg::seed_from_u64(seed ^ (k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let (group, samples, calls) = &formats[k % formats.len()];
        let (name, bytes) = &samples[rng.random_range(0..samples.len())];
        let (damaged, change) = mutate(name, bytes, &mut rng);
        let call = calls[rng.random_range(0..calls.len())];
        // A call that does not name the file reads it under its name.
        let file =
            if call.contains("FILE") { format!("x-{}", name.replace('/', "-")) } else { (*name).to_owned() };
        let (tool, words) = call.split_once(' ').expect("a tool and its arguments");
        let args = words.split(' ').map(|word| word.replace("FILE", &file)).collect();
        let mut files = folders::of(&examples, tool);
        files = if files.is_empty() { others.clone() } else { files };
        files.push((file, damaged));
        Case { group, tool, args, files, change, memory: None }
    };
    (0..count).map(one).collect()
}
