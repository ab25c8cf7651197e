//! Options that would change nothing are refused, with the reason and the cure.

use super::files::inputs;
use grainpipe_tests::tools::line;

/// A command line, and the option that its message begins with.
const REFUSED: &[(&str, &str)] = &[
    (
        "bluenoise-sample flat.xyz --spacing 0.02 --no-measures",
        "--no-measures: changes nothing without --report",
    ),
    (
        "bluenoise-sample flat.xyz --spacing 0.02 --no-measures --plot p.svg --report r.json",
        "--no-measures: --plot",
    ),
    (
        "bluenoise-sample flat.xyz --spacing 0.02 --method grid --seed 3",
        "--seed: --method grid leaves nothing to chance: leave it out",
    ),
    (
        "cloud-fill flat.xyz --fill grid --seed 3",
        "--seed: --fill grid leaves nothing to chance: leave it out",
    ),
    (
        "bluenoise-sample flat.xyz --spacing 0.02 --method grid --distance surface",
        "--distance surface: --method grid measures in space: leave it out",
    ),
    (
        "cloud-fill flat.xyz --method volumetric --ball 0.1",
        "--ball: --method volumetric rolls no ball: leave it out",
    ),
    (
        "wallgen flat.xyz --radius 0.01 --material steel --smallest-particle 0.02 --largest-particle 0.01",
        "--smallest-particle 0.02 m: is larger than --largest-particle 0.01 m",
    ),
    (
        "cost-curve s.toml --vary safety=0.2,0.4 --measure bed-height --norm max",
        "--norm: the bed height of a run is one number: leave it out",
    ),
    ("cloud-crop flat.xyz --mark", "flat.xyz: --mark: no rule is given, and the cloud has no marks"),
    (
        "cloud-crop flat.xyz --restore box:0,0,0,1,1,1",
        "flat.xyz: --restore: nothing is removed that could be restored",
    ),
    ("cloud-crop flat.xyz --grazing 75", "flat.xyz: --grazing: the cloud states no viewpoint"),
    ("dem-view flat.xyz -o v.html --fps 10", "--fps changes nothing in .html: it is for .gif, .mp4:"),
    ("dem-view flat.xyz -o v.html --size 96x64", "--size changes nothing in .html"),
    ("dem-view flat.xyz -o v.html --cut", "--cut changes nothing in .html"),
    ("dem-view flat.xyz -o v.html --wall-opacity 0.5", "--wall-opacity changes nothing in .html"),
    ("dem-view flat.xyz -o v.html --from 0", "--from changes nothing in .html"),
    ("dem-view flat.xyz -o v.png --fps 25", "--fps changes nothing in .png"),
    ("dem-view flat.xyz -o v.png --every 0.1", "--every changes nothing in .png"),
    ("dem-view flat.xyz -o v.png --title A", "--title changes nothing in .png: it is for .html:"),
    ("dem-view flat.xyz -o v.png --max-mb 60", "--max-mb changes nothing in .png"),
    ("dem-view flat.xyz -o v.png --components", "--components changes nothing in .png"),
    ("dem-view flat.xyz -o v.png --pick", "--pick changes nothing in .png"),
    ("dem-view flat.xyz -o v.gif --time 1", "--time changes nothing in .gif"),
    ("dem-view flat.xyz -o v.vtp --camera top", "--camera changes nothing in .vtp"),
    ("dem-view flat.xyz -o v.vtp --map turbo", "--map changes nothing in .vtp"),
    ("dem-view flat.xyz -o v.vtp --colour z", "--colour changes nothing in .vtp"),
    ("dem-view tetra.ply -o v.png --colour z", "--colour: meshes have no field to colour by"),
    ("dem-view run.mcap -o v.png --only id=0 --vectors velocity", "--only: chooses grains"),
    ("dem-view flat.xyz -o v.png --only z=0,1", "--only: no input has grains"),
    ("dem-view flat.xyz -o v.html --colour rgb --range 0,1", "--range: rgb are colours, not a scale"),
    ("dem-view flat.xyz -o v.png --colour material --range 0,1", "--range: material has kinds, not a scale"),
    (
        "wallgen --from-mesh tetra.ply --radius 0.03 --roughness 0.003 --columns x,y,z -o w.mcap",
        "--columns: --from-mesh alone reads no cloud",
    ),
    (
        "stone-clump tetra.ply --measures --transform quarter.txt",
        "--transform: measures of shape are the same in any position",
    ),
    ("dem-run s.toml --check -o s.mcap", "-o s.mcap: --check writes nothing: leave it out"),
    (
        "dem-measure run.mcap --fragments --all",
        "--all: --fragments lists the pieces of one frame: choose it with --time or --until",
    ),
    ("dem-measure run.mcap --fragments --from 0", "--from: --fragments lists the pieces of one frame"),
    (
        "stone-pack grains.csv library --content 0.2 --stone-density 2600 --soil-density 2600 --material stone -o s.ply",
        "--material: changes nothing without --scene, --rigid or --report",
    ),
    (
        "lab-test uniaxial stone.toml --seed 3",
        "--seed: uniaxial with these grains leaves nothing to chance: leave it out",
    ),
    (
        "lab-test triaxial-periodic soil.toml --set gravity=[0,0,0] --grains 200 --print-scene --seed 3",
        "--seed: the scene of the test leaves nothing to chance: leave it out",
    ),
    ("stone-clump tetra.ply --spheres 3 --name x -o c.csv", "--name: -o c.csv has the spheres alone"),
    ("dem-run s.toml --materials", "--materials has no effect: no [[material]] leaves out a number"),
    ("dem-run s.toml --check --device local", "--device: --check runs nothing: leave it out"),
    ("dem-lammps spheres.toml --check --progress", "--progress: --check runs nothing: leave it out"),
    ("dem-lammps spheres.toml --check --dir kept", "--dir: --check runs nothing: leave it out"),
    ("dem-lammps spheres.toml --mpirun mpirun", "--mpirun: one rank needs no launcher"),
    ("dem-run s.toml --check --progress", "--progress: --check runs nothing: leave it out"),
    ("dem-run s.toml --explain --check", "--check: --explain checks the scene as well: leave it out"),
    ("dem-view flat.xyz -o v.pvd --range 0,1", "--range changes nothing in .pvd"),
    // An option that needs another one is accepted without it by clap where that one would be refused.
    (
        "cloud-crop scan.xyz --outer box:-1,-1,-1,1,1,1 --check --seen-from 0,0,2",
        "'--check' cannot be used with '--seen-from",
    ),
    (
        "stone-hull photographs --masks photographs --turntable turntable.toml --poses-size 64x48 -o hull.ply",
        "'--turntable <FILE.toml>' cannot be used with '--poses-size",
    ),
    (
        "stone-hull photographs --masks photographs --poses poses.txt --adjust -o hull.ply",
        "cannot be used with '--adjust'",
    ),
    ("calibrate recipe.toml --moisture dry", "cannot be used with '--moisture"),
    ("calibrate recipe.toml --material sand", "cannot be used with '--material"),
    ("calibrate recipe.toml --size 2mm", "cannot be used with '--size"),
    ("calibrate recipe.toml --repose-deg 33", "cannot be used with '--repose-deg"),
    (
        "stone-hull photographs --masks drawn --poses poses.txt --hold-out 2 -o h.ply",
        "--hold-out: 2 is more than the 1 photographs that have a mask: give a smaller number",
    ),
    (
        "stage-replay up.mcap --copies 1 --copy-delay 0.01 -o i.mcap",
        "--copy-delay: one copy is the record itself: give --copies 2 or more",
    ),
    (
        "stage-replay up.mcap --repeat 1 --period 0.1 -o i.mcap",
        "--period: the record is replayed once: give --repeat 2 or more",
    ),
    (
        "stone-library pebble.ply -o rocks --seed 3",
        "--seed: a library without --variants leaves nothing to chance",
    ),
];

/// What cannot be known before the picture is drawn is a warning.
#[test]
fn an_option_that_leaves_a_picture_as_it_is_prints_a_warning() {
    let folder = inputs();
    let command = "dem-view flat.xyz --size 240x180 -o v.png --cut --map turbo";
    let done = line(folder.path(), command);
    assert!(
        done.code == 0 && done.stderr.contains("--cut changes nothing in this picture"),
        "{}",
        done.stderr
    );
    assert!(!done.stderr.contains("--map"), "a cloud is coloured by height: {}", done.stderr);
}

/// The same with films, once no picture has changed.
#[test]
fn an_option_that_leaves_a_film_as_it_is_prints_a_warning() {
    let folder = inputs();
    grainpipe_tests::tools::succeed(
        folder.path(),
        "dem-run",
        &["s.toml", "--until", "0.006", "-o", "run.mcap"],
    );
    let command = "dem-view run.mcap --size 240x180 -o v.gif --cut --map turbo";
    let done = line(folder.path(), command);
    let warned = done.stderr.contains("--cut changes nothing in this film");
    assert!(done.code == 0 && warned, "{}", done.stderr);
    assert!(!done.stderr.contains("--map"), "grains are coloured by speed: {}", done.stderr);
}

#[test]
fn a_picture_of_hardly_more_than_text_prints_a_warning() {
    let folder = inputs();
    for (size, small) in [("96x64", true), ("320x180", false)] {
        let done = line(folder.path(), &format!("dem-view flat.xyz --size {size} -o v.png"));
        let warned = done
            .stderr
            .contains("pixels large in a picture of 96 x 64, beside its text: give a larger --size");
        assert!(done.code == 0 && warned == small, "{size}: {}", done.stderr);
    }
}

#[test]
fn a_check_of_a_resumed_run_reads_its_checkpoint() {
    let folder = inputs();
    let run = |words: &str| line(folder.path(), &format!("dem-run s.toml {words}"));
    assert_eq!(run("--until 0.002 -o run.mcap").code, 0);
    let fits = run("--until 0.004 --resume run.mcap --check");
    assert!(fits.code == 0 && fits.stderr.contains("; it resumes at 0.0019"), "{}", fits.stderr);
    let over = run("--until 0.001 --resume run.mcap --check");
    assert!(over.code == 1 && over.stderr.contains("give a later --until"), "{}", over.stderr);
    let other = run("--set contact.0.restitution=0.3 --until 0.004 --resume run.mcap --check");
    assert!(other.code == 1 && other.stderr.contains("the saved run differs"), "{}", other.stderr);
}

#[test]
fn options_that_change_nothing_are_refused() {
    let folder = inputs();
    let wrong = |(command, message): &&(&str, &str)| {
        let done = line(folder.path(), command);
        (done.code != 2 || !done.stderr.contains(message))
            .then(|| format!("{command}: {}: {}", done.code, done.stderr))
    };
    let wrong: Vec<String> = REFUSED.iter().filter_map(|case| wrong(&case)).collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), REFUSED.len(), wrong.join("\n"));
}
