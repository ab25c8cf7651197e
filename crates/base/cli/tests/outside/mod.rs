//! What a tool meets outside of itself: limits of memory, and a record of what it reads.

use crate::{names, tool};
use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};

/// A tool that asks for more than it may have.
pub fn too_little_memory_is_one_line(folder: &Path) {
    let me = std::env::current_exe().unwrap();
    let line = format!("ulimit -v 1000000; exec '{}' hoard --threads 1 -o out.bin", me.display());
    let mut shell = Command::new("bash");
    shell.args(["-c", &line]).env(tool::SWITCH, "1").current_dir(folder).stdin(Stdio::null());
    let done = shell.output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{said}");
    assert!(
        said.starts_with("cloud-test: out of memory: 64 MiB more") && said.lines().count() == 1,
        "{said}"
    );
    assert_eq!(names(folder), Vec::<String>::new());
}

/// Files of arguments and of stdin, and not those of the trial itself.
pub fn what_a_tool_reads_is_noted(folder: &Path) {
    fs::write(folder.join("a b.xyz"), crate::CLOUD).unwrap();
    let me = std::env::current_exe().unwrap();
    let noted = |line: &str| {
        let line = line.replace("TOOL", &format!("'{}' copy -q", me.display()));
        fs::create_dir_all(folder.join("trial")).unwrap();
        let record = folder.join("trial/reads");
        let _ = fs::remove_file(&record);
        let mut shell = Command::new("bash");
        shell.args(["-c", &line]).env(tool::SWITCH, "1").env("GRAINPIPE_READS", &record);
        shell.current_dir(folder).stdin(Stdio::null());
        let done = shell.output().unwrap();
        assert!(done.status.success(), "{line}: {}", String::from_utf8_lossy(&done.stderr));
        fs::read_to_string(&record).unwrap_or_default()
    };
    for line in
        ["TOOL 'a b.xyz' -o b.ply", "TOOL < 'a b.xyz' > b.ply", "cat 'a b.xyz' | TOOL 'a b.xyz' -o b.ply"]
    {
        let record = noted(line);
        assert!(
            record.contains("a b.xyz\",\"sha256\":\"") && record.lines().count() == 1,
            "{line}: {record}"
        );
        assert!(!record.contains("b.ply"), "{line}: {record}");
    }
    assert_eq!(noted("cat 'a b.xyz' | TOOL -o b.ply"), "", "cat tells nothing");
    // What the trial itself makes is no input of it.
    assert_eq!(noted("cp 'a b.xyz' trial/own.xyz; TOOL trial/own.xyz -o b.ply"), "");
}

/// As many as `--threads` starts, at most.
pub fn threads_of_a_variable(folder: &Path) {
    fs::write(folder.join("in.xyz"), crate::CLOUD).unwrap();
    let most = 64.max(4 * std::thread::available_parallelism().unwrap().get());
    let mut tool = Command::new(std::env::current_exe().unwrap());
    tool.args(["copy", "in.xyz", "-o", "out.ply"]).env(tool::SWITCH, "1").env("RAYON_NUM_THREADS", "100000");
    let done = tool.current_dir(folder).output().unwrap();
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(said.contains(&format!("RAYON_NUM_THREADS 100000: {most} threads are used")), "{said}");
}

/// A name that is no text, and the longest names.
pub fn names_of_all_bytes_and_lengths(folder: &Path) {
    let bytes = |text: &[u8]| OsStr::from_bytes(text).to_owned();
    let long = |letter: char, end: &str| {
        bytes(format!("{}{end}", letter.to_string().repeat(255 - end.len())).as_bytes())
    };
    let names = [
        [bytes(b"in\xff.xyz"), bytes(b"out\xff.ply")],
        [long('a', ".xyz"), long('b', ".ply")],
        // Letters of two bytes are not cut in the middle.
        [
            bytes(format!("i{}.xyz", "\u{fc}".repeat(125)).as_bytes()),
            bytes(format!("o{}.ply", "\u{fc}".repeat(125)).as_bytes()),
        ],
    ];
    for [from, to] in names {
        fs::write(folder.join(&from), crate::CLOUD).unwrap();
        let mut tool = Command::new(std::env::current_exe().unwrap());
        tool.arg("copy").arg(&from).arg("-o").arg(&to).env(tool::SWITCH, "1").current_dir(folder);
        let done = tool.output().unwrap();
        assert!(done.status.success(), "{from:?}: {}", String::from_utf8_lossy(&done.stderr));
        assert!(fs::metadata(folder.join(&to)).is_ok_and(|file| file.len() > 0), "{to:?}");
    }
    let left = fs::read_dir(folder).unwrap().count();
    assert_eq!(left, 6, "no part is left");
}

/// What fails because the same signal has ended it is no failure: the signal ends the tool, however late its listener comes.
pub fn a_signal_comes_before_what_it_breaks(folder: &Path) {
    for _ in 0..50 {
        let mut tool = Command::new(std::env::current_exe().unwrap());
        tool.args(["helper", "-o", "out.bin"]).env(tool::SWITCH, "1").current_dir(folder);
        let done = tool.output().unwrap();
        let (signal, words) = (done.status.signal(), String::from_utf8_lossy(&done.stderr));
        assert_eq!((signal, words.trim(), fs::read_dir(folder).unwrap().count()), (Some(15), "", 0));
    }
}
