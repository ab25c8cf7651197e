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
    ("dem-view flat.xyz -o v.pvd --range 0,1", "--range changes nothing in .pvd"),
];

/// What cannot be known before the picture is drawn is a warning.
#[test]
fn an_option_that_leaves_a_picture_as_it_is_prints_a_warning() {
    let folder = inputs();
    let command = "dem-view flat.xyz --size 96x64 -o v.png --cut --map turbo";
    let done = line(folder.path(), command);
    assert!(
        done.code == 0 && done.stderr.contains("--cut changes nothing in this picture"),
        "{}",
        done.stderr
    );
    assert!(!done.stderr.contains("--map"), "a cloud is coloured by height: {}", done.stderr);
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
