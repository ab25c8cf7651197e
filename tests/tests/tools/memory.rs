//! What takes memory with the size of its input is made in parts.

use grainpipe_tests::tools::{line, program};
use std::fs;
use tempfile::tempdir;

/// Address space [kB]: several times what a small picture takes, and a third of the samples of a whole large one.
const ROOM: u32 = 400_000;

#[test]
fn a_picture_takes_memory_for_some_of_its_rows_only() {
    let folder = tempdir().expect("a folder");
    let points: String = (0..900).map(|k| format!("{} {} 0.1\n", k % 30, k / 30)).collect();
    fs::write(folder.path().join("p.xyz"), points).expect("written");
    let tool = program("dem-view");
    let call =
        format!("ulimit -v {ROOM}; exec {} p.xyz --size 4096x4096 --threads 1 -q -o p.png", tool.display());
    let done =
        std::process::Command::new("sh").args(["-c", &call]).current_dir(&folder).output().expect("run");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let large = fs::read(folder.path().join("p.png")).expect("a picture");
    let done = line(folder.path(), "dem-view p.xyz --size 4096x4096 --threads 2 -q -o q.png");
    assert!(done.code == 0 && fs::read(folder.path().join("q.png")).expect("a picture") == large);
}
