//! Outputs that are there already, in folders and with modes of all kinds, as a user without rights: what is protected stays, and a failure leaves nothing.

use super::Findings;
use super::case::{Outcome, Verdict, bounded, write};
use super::options::{Call, calls};
use super::signals::held;
use rayon::prelude::*;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};

/// A user without rights, where the test has them.
const UNPRIVILEGED: &str = "if [ \"$(id -u)\" = 0 ]; then exec setpriv --reuid=65534 --regid=65534 --clear-groups \"$0\" \"$@\"; fi;";

/// What is done before a call, and what must come of it.
struct Mode {
    name: &'static str,
    /// Prepares the folder; gives the words of the shell before the call.
    prepare: fn(&Path, &Path) -> &'static str,
    /// Whether the call must fail.
    refused: bool,
}

/// Nothing that is read may be read.
const INPUTS: &str = "inputs of another user";

const MODES: [Mode; 8] = [
    Mode { name: "a write-protected output", prepare: protected, refused: true },
    Mode { name: "an output that is a folder with files", prepare: occupied, refused: true },
    Mode { name: "a folder that is not there", prepare: no_folder, refused: true },
    Mode { name: "a folder of another user", prepare: foreign, refused: true },
    Mode { name: INPUTS, prepare: unreadable, refused: true },
    Mode { name: "umask 077", prepare: |_, _| "umask 077;", refused: false },
    Mode { name: "umask 777", prepare: |_, _| "umask 777;", refused: false },
    Mode { name: "a link to nothing", prepare: dangling, refused: false },
];

fn protected(folder: &Path, output: &Path) -> &'static str {
    fs::write(output, "of the user").expect("written");
    fs::set_permissions(output, fs::Permissions::from_mode(0o444)).expect("set");
    fs::set_permissions(folder, fs::Permissions::from_mode(0o777)).expect("set");
    UNPRIVILEGED
}

fn occupied(_: &Path, output: &Path) -> &'static str {
    fs::create_dir(output).expect("made");
    fs::write(output.join("thesis.txt"), "of the user").expect("written");
    ""
}

fn no_folder(_: &Path, _: &Path) -> &'static str {
    "set -- \"${@//out/missing\\/out}\";"
}

fn foreign(folder: &Path, _: &Path) -> &'static str {
    fs::set_permissions(folder, fs::Permissions::from_mode(0o555)).expect("set");
    for name in ["stdout", "stderr"] {
        fs::write(folder.join(name), "").expect("written");
    }
    UNPRIVILEGED
}

fn unreadable(folder: &Path, _: &Path) -> &'static str {
    for name in held(folder).keys() {
        fs::set_permissions(folder.join(name), fs::Permissions::from_mode(0o000)).expect("set");
    }
    fs::set_permissions(folder, fs::Permissions::from_mode(0o777)).expect("set");
    UNPRIVILEGED
}

fn dangling(folder: &Path, output: &Path) -> &'static str {
    symlink(folder.join("there"), output).expect("linked");
    ""
}

/// The output that a call names.
fn output(call: &Call) -> Option<PathBuf> {
    let at = call.args.iter().position(|word| word == "-o")?;
    call.args.get(at + 1).map(PathBuf::from)
}

/// Each call that names an output, with each mode.
pub fn run(one_in: usize, found: &mut Findings) {
    let calls: Vec<Call> = calls().into_iter().filter(|call| output(call).is_some()).collect();
    let all: Vec<(&Call, &Mode)> =
        calls.iter().flat_map(|call| MODES.iter().map(move |mode| (call, mode))).collect();
    let verdicts = all.into_par_iter().step_by(one_in).map(|(call, mode)| one(call, mode)).collect();
    found.all("users and modes", verdicts);
}

fn one(call: &Call, mode: &Mode) -> (String, Verdict) {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &call.files);
    let to = output(call).expect("an output");
    // Tools that write a folder may write into one that is there.
    let is_folder = to.extension().is_none();
    let before = (mode.prepare)(folder.path(), &folder.path().join(&to));
    let inputs = held(folder.path());
    // What makes up its data reads nothing.
    let reads = call.files.iter().any(|(name, _)| call.args.iter().any(|arg| arg.contains(name.as_str())));
    let (status, stderr) = bounded(folder.path(), before, None, call.tool, &call.args);
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).expect("set");
    let after = held(folder.path());
    let kept = inputs.iter().all(|(name, bytes)| after.get(name) == Some(bytes));
    let hidden = after.keys().any(|name| name.rsplit('/').next().is_some_and(|n| n.starts_with('.')));
    let made = after.keys().any(|name| !inputs.contains_key(name) && !name.ends_with(".part"));
    let outcome = match status.and_then(|s| s.code()) {
        None => Outcome::Killed,
        Some(_) if stderr.contains("panicked at") => Outcome::Panicked,
        Some(_) if !kept || hidden => Outcome::LeftOutput,
        Some(0) if mode.refused && !is_folder && (reads || mode.name != INPUTS) => Outcome::Silent,
        Some(0) => Outcome::Accepted,
        Some(1..=3) if stderr.trim().is_empty() => Outcome::Mute,
        Some(1 | 2) if made && !is_folder => Outcome::LeftOutput,
        Some(1..=3) => Outcome::Refused,
        Some(_) => Outcome::Panicked,
    };
    (format!("{} {}   # {}", call.tool, call.args.join(" "), mode.name), Verdict::new(outcome, &stderr))
}
