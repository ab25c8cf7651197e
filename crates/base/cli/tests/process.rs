//! What a process does: exit codes, pipes, files that appear when whole. Starts itself as a tool.

mod outside;
mod tool;

use serde_json::Value;
use std::{
    fs,
    io::{Read, Write},
    os::unix::fs::FileTypeExt,
    path::Path,
    process::{Child, Command, ExitCode, Output, Stdio},
    time::{Duration, Instant},
};

/// Tests with their names.
macro_rules! named {
    ($($test:path);*) => { [$((stringify!($test), $test as fn(&Path))),*] };
}

fn main() -> ExitCode {
    if std::env::var_os(tool::SWITCH).is_some() {
        return tool::main();
    }
    let tests = named![
        a_file_appears_when_it_is_whole; a_failed_tool_leaves_the_old_file; a_panic_leaves_nothing;
        a_signal_leaves_nothing; outside::a_signal_comes_before_what_it_breaks;
        outside::too_little_memory_is_one_line; outside::threads_of_a_variable;
        outside::names_of_all_bytes_and_lengths; outside::what_a_tool_reads_is_noted; links_and_pipes_stay;
        a_dangling_link_stays; a_replaced_file_keeps_its_mode; a_protected_file_stays;
        a_size_limit_is_an_error; a_closed_pipe_is_no_failure; a_closed_stdout_is_a_failure;
        names_cannot_steer_the_terminal; too_many_threads_are_not_started; wrong_usage_is_exit_2;
        a_stop_is_exit_3; a_missing_input_is_named; the_report_says_what_was_done; quiet_is_quiet;
        pipes_and_files_give_the_same_bytes
    ];
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    for (name, test) in tests.iter().filter(|(name, _)| wanted.iter().all(|w| name.contains(w))) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        test(folder.path());
        println!("test {name} ... ok");
    }
    ExitCode::SUCCESS
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(arguments)
        .env(tool::SWITCH, "1")
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    start(folder, arguments).wait_with_output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

const CLOUD: &str = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
                     property uchar red\nend_header\n0 0 0 1\n1 0 0 2\n";

fn a_file_appears_when_it_is_whole(folder: &Path) {
    let out = run(folder, &["write", "-o", "out.bin"]);
    assert!(out.status.success(), "{}", text(&out.stderr));
    // While it was being written it stood hidden beside its final name.
    let during =
        text(&out.stderr).lines().find_map(|l| l.strip_prefix("during: ").map(str::to_owned)).unwrap();
    assert!(
        during.starts_with(".out.bin.") && during.ends_with(".part") && !during.contains(' '),
        "{during}"
    );
    assert_eq!(names(folder), ["out.bin"]);
    let created = folder.join("by-hand");
    fs::write(&created, "").unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions();
    assert_eq!(mode(&folder.join("out.bin")), mode(&created));
}

fn a_failed_tool_leaves_the_old_file(folder: &Path) {
    fs::write(folder.join("out.bin"), "old").unwrap();
    let out = run(folder, &["fail", "-o", "out.bin", "--report", "report.json"]);
    assert_eq!((out.status.code(), names(folder)), (Some(1), vec!["out.bin".to_owned()]));
    assert_eq!(fs::read(folder.join("out.bin")).unwrap(), b"old");
    assert_eq!(text(&out.stderr), "cloud-test: scan.ply: point 7: x is NaN: drop it\n");
}

fn a_panic_leaves_nothing(folder: &Path) {
    assert_eq!(run(folder, &["panic", "-o", "out.bin"]).status.code(), Some(101));
    assert_eq!(names(folder), [""; 0]);
}

fn a_signal_leaves_nothing(folder: &Path) {
    let mut child = start(folder, &["wait", "-o", "out.bin"]);
    // `wait` would close it, and the tool would end well before the signal arrives.
    let stdin = child.stdin.take();
    let deadline = Instant::now() + Duration::from_secs(20);
    while names(folder).is_empty() {
        assert!(Instant::now() < deadline, "the tool did not start");
        std::thread::sleep(Duration::from_millis(10));
    }
    let sent = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let status = child.wait().unwrap();
    drop(stdin);
    assert_eq!((status.code(), names(folder)), (None, vec![]));
}

fn links_and_pipes_stay(folder: &Path) {
    fs::write(folder.join("real"), "old").unwrap();
    std::os::unix::fs::symlink("real", folder.join("link")).unwrap();
    assert!(run(folder, &["write", "-o", "link"]).status.success());
    assert!(folder.join("link").is_symlink() && fs::read(folder.join("real")).unwrap().len() > 3);
    // A named pipe of our own stands for every device: a broken build must not replace a real one.
    let pipe = folder.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let received = fs::File::create(folder.join("received")).unwrap();
    let mut reader = Command::new("cat").arg(&pipe).stdout(received).spawn().unwrap();
    let written = run(folder, &["write", "-o", "pipe"]).status.success();
    let stayed = fs::metadata(&pipe).unwrap().file_type().is_fifo();
    if !(written && stayed) {
        reader.kill().unwrap();
    }
    reader.wait().unwrap();
    assert!(written && stayed, "written {written}, still a pipe {stayed}");
    assert_eq!(fs::read(folder.join("received")).unwrap(), fs::read(folder.join("real")).unwrap());
    let out = run(folder, &["write", "-o", "."]);
    assert!(text(&out.stderr).contains("is a folder"));
    let out = run(folder, &["write", "-o", "no/such/out.bin"]);
    assert!(out.status.code() == Some(1) && text(&out.stderr).contains("no/such/out.bin: cannot create it"));
}

fn a_closed_pipe_is_no_failure(folder: &Path) {
    let mut child = start(folder, &["flood"]);
    let mut first = [0; 10];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let out = child.wait_with_output().unwrap();
    assert_eq!((out.status.code(), text(&out.stderr)), (Some(0), String::new()));
}

/// Runs the tool as a shell starts it after a command.
fn in_shell(folder: &Path, before: &str, redirect: &str, arguments: &[&str]) -> Output {
    Command::new("sh")
        .args(["-c", &format!("{before} exec \"$0\" \"$@\" {redirect}")])
        .arg(std::env::current_exe().unwrap())
        .args(arguments)
        .env(tool::SWITCH, "1")
        .current_dir(folder)
        .output()
        .unwrap()
}

fn a_dangling_link_stays(folder: &Path) {
    std::os::unix::fs::symlink("gone", folder.join("link")).unwrap();
    let out = run(folder, &["write", "-o", "link"]);
    assert!(out.status.success(), "{}", text(&out.stderr));
    assert!(
        text(&out.stderr).contains("link is a link to ./gone, which does not exist"),
        "{}",
        text(&out.stderr)
    );
    assert!(folder.join("link").is_symlink() && fs::read(folder.join("gone")).unwrap().len() == 1_000_000);
    std::os::unix::fs::symlink("no/such/file", folder.join("lost")).unwrap();
    let out = run(folder, &["write", "-o", "lost"]);
    assert!(text(&out.stderr).contains("it is a link to ./no/such/file"), "{}", text(&out.stderr));
    std::os::unix::fs::symlink("circle", folder.join("circle")).unwrap();
    let out = run(folder, &["write", "-o", "circle"]);
    assert!(out.status.code() == Some(1) && text(&out.stderr).contains("circle"), "{}", text(&out.stderr));
}

fn a_protected_file_stays(folder: &Path) {
    use std::os::unix::{fs::PermissionsExt, process::CommandExt};
    let mode = |path: &Path, mode| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    let path = folder.join("out.bin");
    fs::write(&path, "precious").unwrap();
    mode(&path, 0o444);
    mode(folder, 0o777);
    // Root may write to everything: the tool runs as another user.
    let program = folder.join("tool");
    fs::copy(std::env::current_exe().unwrap(), &program).unwrap();
    mode(&program, 0o755);
    let mut tool = Command::new(&program);
    tool.args(["fail", "-o", "out.bin"]).env(tool::SWITCH, "1").current_dir(folder);
    if rustix::process::geteuid().is_root() {
        tool.uid(65_534);
    }
    let out = tool.output().unwrap();
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    let right = "cloud-test: out.bin: exists and is write-protected: remove the protection (chmod u+w), or choose another name";
    assert!(text(&out.stderr).starts_with(right), "{}", text(&out.stderr));
    assert_eq!(fs::read(&path).unwrap(), b"precious");
}

fn a_replaced_file_keeps_its_mode(folder: &Path) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
    let path = folder.join("out.bin");
    fs::write(&path, "old").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o604)).unwrap();
    // Only root can give a file away.
    let other = chown(&path, Some(12_345), Some(23_456)).is_ok();
    assert!(run(folder, &["write", "-o", "out.bin"]).status.success());
    let new = fs::metadata(&path).unwrap();
    assert_eq!((new.len(), new.mode() & 0o777), (1_000_000, 0o604));
    assert!(!other || (new.uid(), new.gid()) == (12_345, 23_456), "{} {}", new.uid(), new.gid());
}

fn a_size_limit_is_an_error(folder: &Path) {
    let out = in_shell(folder, "ulimit -f 100;", "", &["write", "-o", "out.bin"]);
    assert_eq!((out.status.code(), names(folder)), (Some(1), vec![]), "{}", text(&out.stderr));
    assert!(
        text(&out.stderr).contains("largest size that is allowed here (ulimit -f"),
        "{}",
        text(&out.stderr)
    );
    let out = in_shell(folder, "ulimit -f 100;", "> out.bin", &["write"]);
    assert!(out.status.code() == Some(1) && text(&out.stderr).contains("ulimit -f"), "{}", text(&out.stderr));
}

fn a_closed_stdout_is_a_failure(folder: &Path) {
    for arguments in [&["write"][..], &["--help"], &["--version"]] {
        let out = in_shell(folder, "", ">&-", arguments);
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(1) && said.starts_with("cloud-test: stdout is closed"), "{said}");
    }
    let out = in_shell(folder, "", ">&-", &["write", "-o", "out.bin"]);
    assert!(out.status.success() && names(folder) == ["out.bin"], "{}", text(&out.stderr));
    assert!(in_shell(folder, "", "> /dev/null", &["write"]).status.success());
    // What other programs give for nothing: /dev/null to read and write.
    assert!(in_shell(folder, "", "1<> /dev/null", &["write"]).status.success());
}

fn names_cannot_steer_the_terminal(folder: &Path) {
    // Of an argument that it does not know, clap itself leaves out what colours.
    let colour = "\\u{1b}[31m";
    for (argument, colour) in [("no\u{1b}[31mne\u{202e}\u{7}.ply", colour), ("--no\u{1b}[31m\u{202e}", "")] {
        let said = text(&run(folder, &["copy", argument]).stderr);
        assert!(said.contains(colour) && said.contains("\\u{202e}"), "{said:?}");
        assert!(said.chars().all(|c| c == '\n' || !c.is_control() && c != '\u{202e}'), "{said:?}");
    }
}

fn too_many_threads_are_not_started(folder: &Path) {
    fs::write(folder.join("in.ply"), CLOUD).unwrap();
    let out = run(folder, &["copy", "in.ply", "-o", "out.ply", "--report", "r.json", "--threads", "4096"]);
    let report: Value = serde_json::from_slice(&fs::read(folder.join("r.json")).unwrap()).unwrap();
    let cores = std::thread::available_parallelism().unwrap().get() as u64;
    let most = 64.max(4 * cores);
    assert!(most >= 4096 || report["threads"] == most, "{report}");
    let said = text(&out.stderr);
    assert!(most >= 4096 || said.contains(&format!("--threads 4096: {most} threads are used")), "{said}");
}

fn wrong_usage_is_exit_2(folder: &Path) {
    assert_eq!(run(folder, &["write", "--no-such-flag"]).status.code(), Some(2));
    assert_eq!(run(folder, &["write", "--threads", "0"]).status.code(), Some(2));
    let out = run(folder, &["usage"]);
    assert_eq!(
        (out.status.code(), text(&out.stderr)),
        (Some(2), "cloud-test: --spacing: 0 m: give more\n".into())
    );
    let out = run(folder, &["--version"]);
    assert_eq!((out.status.code(), text(&out.stdout).starts_with("cloud-test 0.")), (Some(0), true));
    let help = text(&run(folder, &["--help"]).stdout);
    assert!(help.starts_with("Tries every way to end"), "{help}");
    assert!(
        ["--quiet", "--threads", "--report", "--output", "--seed"].iter().all(|flag| help.contains(flag))
    );
}

fn a_stop_is_exit_3(folder: &Path) {
    let out = run(folder, &["stop", "-o", "out.bin", "--report", "report.json"]);
    assert_eq!(
        (out.status.code(), names(folder)),
        (Some(3), vec!["out.bin".to_owned(), "report.json".to_owned()])
    );
    assert!(text(&out.stderr).contains("cloud-test: particle 5: overlap"), "{}", text(&out.stderr));
}

fn a_missing_input_is_named(folder: &Path) {
    let out = run(folder, &["copy", "none.ply"]);
    assert_eq!(out.status.code(), Some(1));
    let said = text(&out.stderr);
    assert!(said.starts_with("cloud-test: none.ply: cannot open it (check the path"), "{said}");
    assert_eq!(said.lines().count(), 1);
    fs::write(folder.join("cut.ply"), &CLOUD[..CLOUD.len() - 4]).unwrap();
    let said = text(&run(folder, &["copy", "cut.ply", "-o", "out.ply"]).stderr);
    assert!(said.contains("cut.ply") && said.contains("row 1"), "{said}");
    assert_eq!(names(folder), ["cut.ply"]);
}

fn the_report_says_what_was_done(folder: &Path) {
    fs::write(folder.join("in.ply"), CLOUD).unwrap();
    let out = run(folder, &["copy", "in.ply", "-o", "out.ply", "--report", "r.json", "--threads", "2"]);
    assert_eq!(text(&out.stderr), "cloud-test: 2 points\n");
    let report: Value = serde_json::from_slice(&fs::read(folder.join("r.json")).unwrap()).unwrap();
    assert_eq!((&report["tool"], &report["points"]), (&"cloud-test".into(), &2.into()));
    assert_eq!(report["threads"], 2);
    assert_eq!(report["arguments"][0], "copy");
    assert!(
        report["seconds"].as_f64().unwrap() > 0.0 && report["peak_memory_bytes"].as_u64() > Some(100_000)
    );
}

fn quiet_is_quiet(folder: &Path) {
    fs::write(folder.join("in.ply"), CLOUD).unwrap();
    let out = run(folder, &["-q", "copy", "in.ply"]);
    assert!(out.status.success() && out.stderr.is_empty() && out.stdout.starts_with(b"ply\n"));
    assert!(!run(folder, &["-q", "fail"]).stderr.is_empty(), "errors are still told");
}

fn pipes_and_files_give_the_same_bytes(folder: &Path) {
    fs::write(folder.join("in.ply"), CLOUD).unwrap();
    let by_file = run(folder, &["copy", "in.ply", "--seed", "3", "-o", "out.ply"]);
    assert!(by_file.status.success(), "{}", text(&by_file.stderr));
    let mut child = start(folder, &["copy", "--seed=3"]);
    child.stdin.take().unwrap().write_all(CLOUD.as_bytes()).unwrap();
    let by_pipe = child.wait_with_output().unwrap();
    assert_eq!(fs::read(folder.join("out.ply")).unwrap(), by_pipe.stdout);
    let says = |arguments: &[&str]| text(&run(folder, &[&["arguments"], arguments].concat()).stdout);
    assert_eq!(
        says(&["in.ply", "--seed", "3", "-o", "out.ply", "-q"]),
        says(&["--seed=3", "--threads", "1", "-"])
    );
    assert_eq!(says(&["--seed=3"]).trim(), "[\"arguments\", \"--seed=3\"]");
}
