//! Streams whose watermarks or times are wrong: refused with both times, so that no grain is lost.

use super::plant;
use grainpipe_tests::tools::{line, tool};
use record::{Watermark, topic};
use std::fs::File;
use std::path::Path;
use stream::mcap::{Event, Provenance, Reader, Writer};

/// Writes a stream again, with other watermarks: `until` is called with the number of each and its time [s].
fn with_watermarks(from: &Path, to: &Path, until: impl Fn(usize, f64) -> f64) {
    let mut writer = Writer::new(File::create(to).unwrap(), &Provenance::default()).unwrap();
    let mut count = 0;
    for event in Reader::new(File::open(from).unwrap()) {
        match event.unwrap() {
            Event::Metadata { name, .. } if name == "provenance" => {}
            Event::Metadata { name, map } => writer.metadata(&name, map).unwrap(),
            Event::Points { topic, time_ns, table } => {
                writer.points(&topic, time_ns, "world", table).unwrap();
            }
            Event::Bytes { topic, time_ns, data } if topic == topic::WATERMARK => {
                let until = until(count, Watermark::read("test", &data).unwrap().until);
                writer.bytes(&topic, "json", time_ns, &Watermark { until }.to_json()).unwrap();
                count += 1;
            }
            Event::Bytes { topic, time_ns, data } => writer.bytes(&topic, "json", time_ns, &data).unwrap(),
        }
    }
    assert!(count > 10, "{count} watermarks");
    writer.finish().unwrap();
}

/// A stream that says "nothing more before t" and then brings grains before t: the run would end without them.
#[test]
fn a_watermark_that_is_too_late_is_refused() {
    let folder = plant();
    let made = line(folder.path(), "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap");
    assert_eq!(made.code, 0, "{}", made.stderr);
    let path = |name: &str| folder.path().join(name);
    let expect = |what: &str, command: &str, wanted: &[&str]| {
        let done = line(folder.path(), command);
        assert_eq!(done.code, 1, "{what}: {}", done.stderr);
        for wanted in wanted {
            assert!(done.stderr.contains(wanted), "{what}: {wanted}: {}", done.stderr);
        }
    };
    with_watermarks(&path("in.mcap"), &path("once.mcap"), |n, t| if n == 0 { 100.0 } else { t });
    with_watermarks(&path("in.mcap"), &path("milli.mcap"), |_, t| 1000.0 * t);
    with_watermarks(&path("in.mcap"), &path("back.mcap"), |n, t| if n == 9 { 0.5 * t } else { t });
    let run = |name: &str| format!("dem-run down.toml {name} -o {name}.out");
    expect("once", &run("once.mcap"), &["once.mcap: ", "100 s", "particle "]);
    expect("once, piped", "cat once.mcap | dem-run down.toml - -o x.mcap", &["stdin: ", "100 s"]);
    expect("milliseconds", &run("milli.mcap"), &["particle ", "after a watermark of "]);
    expect("back", &run("back.mcap"), &["a watermark of ", " follows one of "]);
    // A check reads a file as the run would.
    for (name, wanted) in
        [("once", "100 s"), ("milli", "after a watermark of "), ("back", " follows one of ")]
    {
        expect(name, &format!("dem-run down.toml {name}.mcap --check"), &[wanted]);
    }
    assert_eq!(line(folder.path(), "dem-run down.toml in.mcap --check").code, 0);
    // A run is read by the same rule.
    with_watermarks(&path("up.mcap"), &path("late.mcap"), |_, t| t + 0.1);
    expect("a run", "stage-replay late.mcap -o x.mcap", &["late.mcap: particle ", "after a watermark of "]);
}

/// A run that ends before its inlet does needs nothing of the rest, whole or not.
#[test]
fn a_stream_that_is_cut_off_after_the_end_of_the_run_is_enough() {
    let folder = plant();
    let made = line(folder.path(), "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap");
    assert_eq!(made.code, 0, "{}", made.stderr);
    let bytes = std::fs::read(folder.path().join("in.mcap")).unwrap();
    std::fs::write(folder.path().join("cut.mcap"), &bytes[..bytes.len() * 9 / 10]).unwrap();
    let words = ["down.toml", "cut.mcap", "--until", "0.02"];
    for more in [&["-o", "x.mcap"][..], &["--check"]] {
        let done = tool(folder.path(), "dem-run", &[&words[..], more].concat());
        assert_eq!(done.code, 0, "{more:?}: {}", done.stderr);
    }
    assert_eq!(tool(folder.path(), "dem-run", &["down.toml", "cut.mcap", "--check"]).code, 1);
}
