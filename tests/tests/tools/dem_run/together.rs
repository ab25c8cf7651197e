//! Two materials poured through one small box: what has no room waits, with the same bits on any number of threads and after a resume, and what a `[[remove]]`
//! takes out is counted.

use super::*;

const POURED: &str = "gravity = [0, 0, -9.81]\n[time]\nuntil = 0.3\n[output]\nevery = 0.05\ncheckpoint = 0.1\n[[material]]\nname = \"a\"\ndensity = 2500\n\
    young = 2e6\npoisson = 0.3\n[[material]]\nname = \"b\"\ndensity = 1500\nyoung = 2e6\npoisson = 0.3\n[[contact]]\nbetween = [\"*\", \"*\"]\n\
    restitution = 0.5\nsliding_friction = 0.4\n[[wall]]\nplane = \"0,0,-0.1,0,0,1\"\nmaterial = \"a\"\n[[insert]]\nmaterial = \"a\"\n\
    shape = \"box:0,0,0,0.015,0.015,0.012\"\ndiameter = 0.01\nvelocity = [0, 0, -0.5]\nrate_count = 7\n[[insert]]\nmaterial = \"b\"\n\
    shape = \"box:0.004,0,0,0.019,0.015,0.012\"\ndiameter = 0.01\nvelocity = [0, 0, -0.5]\nrate_count = 7\nwhen_blocked = \"wait\"\n";

const REMOVE: &str = "[[remove]]\nshape = \"cylinder:0.01,0.0075,-0.1,0.01,0.0075,-0.05,0.03\"\n";

#[test]
fn what_shares_a_place_waits_with_the_same_bits() {
    let folder = with(&format!("{POURED}{REMOVE}"));
    let run = |words: &[&str]| succeed(folder.path(), "dem-run", words);
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let done = run(&["s.toml", "--threads", "1", "-o", "one.mcap"]);
    assert!(
        done.stderr.contains("insert.1: ") && done.stderr.contains("found no room when due"),
        "{}",
        done.stderr
    );
    assert!(
        done.stderr.contains("remove.0 took out ") && !done.stderr.contains("took out 0 "),
        "{}",
        done.stderr
    );
    run(&["s.toml", "--threads", "3", "-o", "three.mcap"]);
    assert!(read("one.mcap") == read("three.mcap"));
    run(&["s.toml", "--until", "0.12", "-o", "part.mcap"]);
    run(&["s.toml", "--resume", "part.mcap", "-o", "rest.mcap"]);
    let (once, rest) = (frames(&folder.path().join("one.mcap")), frames(&folder.path().join("rest.mcap")));
    assert!(rest.len() > 2 && once.ends_with(&rest), "{} {}", once.len(), rest.len());
}

#[test]
fn what_has_no_end_takes_nothing_out() {
    let scene = format!("{POURED}[[remove]]\nshape = \"halfspace:0,0,-1,0,0,1\"\n");
    let done = tool(with(&scene).path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    for part in ["s.toml:", "remove.0.shape", "has no end", "[[outlet]]"] {
        assert!(done.code == 1 && done.stderr.contains(part), "{part}: {}", done.stderr);
    }
}
