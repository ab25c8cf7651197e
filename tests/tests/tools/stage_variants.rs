//! Variants of a downstream stage, from one record: a line of a shell for each, in a folder that several processes share.

use grainpipe_tests::scenes::{GLASS, Head, folder};
use grainpipe_tests::tools::{succeed, tool};
use std::fs;
use std::process::{Child, Command};

/// What both stages have.
const BOTH: Head = Head {
    time: "until = 0.12",
    output: "every = 0.01",
    contact: "law = \"hooke\"\nstiffness = 1e3\nrestitution = 0.3",
    ..GLASS
};

/// Nine grains that fall through a plane onto a floor.
#[test]
fn variants_of_a_stage_are_listed_and_made_once() {
    let row = |k: usize| format!("{},{},0.03,0.002,-0.3\n", 0.01 * (k % 3) as f64, 0.01 * (k / 3) as f64);
    let rows = (0..9).map(row).collect::<String>();
    let up = "[[particles]]\nsource = \"grains.csv\"\nmaterial = \"glass\"\n[[outlet]]\nplane = \"0,0,0.02,0,0,-1\"\nmotion = \"ballistic\"\n";
    let down = "[[inlet]]\nplane = \"0,0,0.02,0,0,-1\"\n[[wall]]\nname = \"floor\"\nplane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"\n";
    let folder = folder(&[
        ("up.toml", BOTH.toml() + up),
        ("down.toml", BOTH.toml() + down),
        ("grains.csv", format!("x,y,z,radius,vz\n{rows}")),
    ]);
    let path = folder.path();
    succeed(path, "dem-run", &["up.toml", "-q", "-o", "up.mcap"]);
    succeed(path, "stage-replay", &["up.mcap", "-q", "-o", "inlet.mcap"]);
    let words = [
        "down.toml",
        "inlet.mcap",
        "--vary",
        "contact.0.restitution=0.3,0.6",
        "--measure",
        "bed-height --ground 0",
    ];
    let words = [
        &words[..],
        &[
            "--reference",
            "contact.0.restitution=0.3",
            "--phases",
            "1",
            "--work",
            "steps",
            "--dir",
            "variants",
        ],
    ]
    .concat();
    let listed = tool(path, "cost-curve", &[&words[..], &["--print-commands"]].concat());
    let lines = String::from_utf8(listed.stdout.clone()).unwrap();
    assert_eq!((listed.code, lines.lines().count()), (0, 2), "{}", listed.stderr);
    fs::write(path.join("jobs.txt"), &lines).unwrap();
    // Two processes, each with the whole list.
    let start = || -> Child {
        let all = "xargs -d '\\n' -n 1 -P 2 bash -c < jobs.txt";
        Command::new("bash").args(["-c", all]).current_dir(path).spawn().unwrap()
    };
    let both = [start(), start()];
    assert!(both.into_iter().all(|mut child| child.wait().unwrap().success()));
    let done = tool(path, "cost-curve", &words);
    assert!(done.code == 0 && done.stderr.contains("2 runs, 2 of them made before"), "{}", done.stderr);
}
