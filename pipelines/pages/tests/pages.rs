//! The pages of all tools: every option stands in the man page and in the completions of each shell.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

const PAGES: &str = env!("CARGO_BIN_EXE_grainpipe-pages");

/// The tools, built beside the program of the pages.
fn tools() -> Vec<PathBuf> {
    let beside = Path::new(PAGES).parent().expect("a folder");
    let below = |folder: &Path| {
        let entries =
            std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        entries.filter(|path| path.is_dir()).collect::<Vec<PathBuf>>()
    };
    let rooms = below(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tools")));
    let folders = rooms.iter().flat_map(|room| below(room));
    let tools: Vec<PathBuf> = folders.map(|path| beside.join(path.file_name().expect("a name"))).collect();
    for tool in &tools {
        assert!(tool.exists(), "{} is missing: build the tools first, cargo build --bins", tool.display());
    }
    tools
}

/// The long options of a tool's help, aliases too.
fn options(tool: &Path) -> BTreeSet<String> {
    let done = Command::new(tool).arg("--help").env("COLUMNS", "100000").output().expect("it starts");
    let help = String::from_utf8(done.stdout).expect("text");
    let (list, _) = help.split_once("Examples:").expect("examples");
    let starts = |line: &&str| line.trim_start().starts_with('-') || line.contains("[alias: --");
    let words = list
        .lines()
        .filter(starts)
        .flat_map(|line| line.trim().splitn(3, ' ').take(2).chain(line.split("[alias: ").skip(1)));
    let names = words.filter_map(|word| word.strip_prefix("--"));
    names
        .map(|name| {
            name.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').next().unwrap_or_default().to_owned()
        })
        .collect()
}

#[test]
fn every_option_is_in_the_man_page_and_in_each_shells_completions() {
    let folder = std::env::temp_dir().join(format!("grainpipe-pages-{}", std::process::id()));
    let done = Command::new(PAGES).arg(&folder).args(tools()).output().expect("it starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let read =
        |name: &str| std::fs::read_to_string(folder.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    for tool in tools() {
        let name = tool.file_name().expect("a name").to_string_lossy().into_owned();
        let man = read(&format!("man/man1/{name}.1")).replace("\\-", "-");
        assert!(man.contains(".TH ") && man.contains("Examples:"), "{man}");
        let bash = format!("bash-completion/completions/{name}");
        let shells = [
            bash.clone(),
            format!("zsh/site-functions/_{name}"),
            format!("fish/vendor_completions.d/{name}.fish"),
        ];
        let options = options(&tool);
        assert!(options.len() > 5, "{name}: {options:?}");
        for option in options {
            assert!(man.contains(&format!("--{option}")), "{name}.1 lacks --{option}");
            for shell in &shells {
                let text = read(shell);
                let forms = [format!("--{option}"), format!("-l {option}")];
                assert!(forms.iter().any(|form| text.contains(form)), "{shell} lacks --{option}");
            }
        }
        let parsed = Command::new("bash").arg("-n").arg(folder.join(bash)).status().expect("bash starts");
        assert!(parsed.success(), "{name}");
    }
    std::fs::remove_dir_all(&folder).expect("it was there");
}
