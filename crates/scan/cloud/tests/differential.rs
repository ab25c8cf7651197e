//! Files of every format and quirk, read here and by other programs: a file of each kind, of what `make -C pipelines differential` writes by thousands.
//!
//! The other programs are in the virtual environment that GRAINPIPE_PEERS names, in the one of `make -C pipelines differential`, or in that of python3. Kinds of files
//! that a program writes which is not there are passed over and counted as skipped.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Kinds of files, so many of each.
const FILES: &str = "800";

/// The Python that has the other programs.
fn python(root: &Path) -> PathBuf {
    let folders =
        [env::var_os("GRAINPIPE_PEERS").map(PathBuf::from), Some(root.join("pipelines/build/differential"))];
    let found = folders.into_iter().flatten().map(|folder| folder.join("bin/python")).find(|p| p.exists());
    found.unwrap_or_else(|| PathBuf::from("python3"))
}

/// Says that the test did nothing, also to `pipelines/test.sh`, which counts it as skipped.
fn skip(what: &str) {
    eprintln!("skipped: {what}");
    if let Some(list) = env::var_os("GRAINPIPE_SKIPS") {
        let before = fs::read_to_string(&list).unwrap_or_default();
        fs::write(list, format!("{before}skipped: {what}\n"))
            .expect("the list of skipped tests can be written");
    }
}

#[test]
fn every_kind_of_file_is_read_as_other_programs_read_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    // Examples are built beside the tests.
    let own = env::current_exe().expect("a path");
    let reader = own.ancestors().nth(2).expect("a folder").join("examples/read_files");
    if !reader.exists() {
        return skip("the example read_files of cloud was not built");
    }
    let folder = env::temp_dir().join(format!("grainpipe-differential-{}", std::process::id()));
    let done = Command::new(python(&root))
        .arg(root.join("pipelines/differential/attack.py"))
        .args([Path::new("--reader"), &reader, Path::new("--keep"), &folder])
        .args(["--files", FILES, "--seed", "7", "--peer-rounds", "1", "--with-those-there"])
        .output();
    let Ok(done) = done else { return skip("python3 not found") };
    let words = String::from_utf8_lossy(&done.stdout).into_owned();
    let errors = String::from_utf8_lossy(&done.stderr).into_owned();
    if done.status.code() == Some(3) {
        return skip(&format!("other programs' readers not found ({})", words.trim()));
    }
    assert!(done.status.success(), "{words}\n{errors}");
    if let Some(few) = words.lines().find(|line| line.starts_with("passed over")) {
        skip(few);
    }
    fs::remove_dir_all(folder).expect("it can be removed");
}
