//! A stage upstream that was stopped and resumed: its record is in several files.

use super::{last_of, passages, plant};
use grainpipe_tests::tools::{line, tool};

/// All files together are replayed to the bytes of the uninterrupted run, also by a run that was killed.
#[test]
fn the_files_of_a_resumed_run_are_one_record() {
    let folder = plant();
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o whole.mcap \
         && dem-run up.toml --until 0.1 -o one.mcap && dem-run up.toml --until 0.12 --resume one.mcap -o two.mcap \
         && dem-run up.toml --resume two.mcap -o three.mcap && stage-replay one.mcap two.mcap three.mcap -o parts.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let of = |name: &str| passages(&folder.path().join(name));
    let (whole, parts) = (of("whole.mcap"), of("parts.mcap"));
    assert!(of("one.mcap").len() > 3 && of("three.mcap").len() > 3, "something passes in each");
    let seen = |rows: &[stages::outlet::crossing::CrossingRow]| -> Vec<_> {
        rows.iter()
            .map(|r| (r.time.to_bits(), r.particle.id, r.particle.position, r.particle.velocity))
            .collect()
    };
    assert_eq!(seen(&whole), seen(&parts));
    assert!(
        last_of(&folder.path().join("parts.mcap"), "/touches")
            == last_of(&folder.path().join("whole.mcap"), "/touches")
    );

    // A run that went on after it was saved: what it recorded since is in the next file again.
    let done = line(
        folder.path(),
        "dem-run up.toml --resume one.mcap -o rest.mcap && dem-run up.toml --until 0.13 -o long.mcap \
         && stage-replay long.mcap rest.mcap -o again.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(seen(&of("again.mcap")), seen(&whole), "what both files contain counts once");
}

#[test]
fn a_part_of_a_record_is_not_taken_for_all_of_it() {
    let folder = plant();
    let done = line(
        folder.path(),
        "dem-run up.toml --until 0.1 -o one.mcap && dem-run up.toml --until 0.12 --resume one.mcap -o two.mcap \
         && dem-run up.toml --resume two.mcap -o three.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    for (arguments, wanted) in [
        (&["two.mcap"][..], "two.mcap: begins at 0.1000"),
        (&["two.mcap", "--from", "0.05"], "where it resumes another run"),
        (&["one.mcap", "three.mcap"], "one.mcap: ends at 0.1000"),
        (&["one.mcap", "three.mcap", "two.mcap"], "three.mcap, which is given before it"),
    ] {
        let done = tool(folder.path(), "stage-replay", &[arguments, &["-o", "x.mcap"]].concat());
        assert!(done.code == 1 && done.stderr.contains(wanted), "{arguments:?}: {}", done.stderr);
        assert!(!folder.path().join("x.mcap").exists());
    }
    let early = tool(
        folder.path(),
        "stage-replay",
        &["one.mcap", "three.mcap", "--until", "0.09", "-o", "early.mcap"],
    );
    assert_eq!(early.code, 0, "what was asked for is in the first: {}", early.stderr);
    let alone = tool(folder.path(), "stage-replay", &["two.mcap", "--from", "0.1", "-o", "part.mcap"]);
    assert_eq!(alone.code, 0, "{}", alone.stderr);
}

/// A resumed downstream stage takes the inlet that it had, from the start: with another one, grains would be lost.
#[test]
fn a_resumed_run_refuses_another_inlet() {
    let folder = plant();
    let done = line(
        folder.path(),
        "dem-run up.toml --until 0.1 -o one.mcap && dem-run up.toml --resume one.mcap -o two.mcap \
         && stage-replay one.mcap two.mcap -o in.mcap && stage-replay one.mcap two.mcap --keep-times -o late.mcap && dem-run down.toml in.mcap --until 0.1 -o first.mcap \
         && dem-run down.toml in.mcap --resume first.mcap -o second.mcap \
         && stage-replay two.mcap --from 0.1 -o rest.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let whole = passages(&folder.path().join("in.mcap"));
    let given = whole.iter().filter(|p| p.time < 0.1).count();
    assert!(given > 3);
    for inlet in ["late.mcap", "rest.mcap"] {
        let lost =
            tool(folder.path(), "dem-run", &["down.toml", inlet, "--resume", "first.mcap", "-o", "x.mcap"]);
        let wanted = "give the same inlet as then, from its beginning";
        assert!(lost.code == 1 && lost.stderr.contains(wanted), "{inlet}: {}", lost.stderr);
        assert!(!folder.path().join("x.mcap").exists());
    }
}
