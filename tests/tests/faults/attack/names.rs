//! Names of materials, walls and files that mean something to a shell, to LAMMPS, TOML, CSV, HTML and a terminal, in every program that writes them.

use super::Findings;
use super::case::{Outcome, Verdict, bounded, judge, write};
use crate::samples;
use rayon::prelude::*;
use std::fs;
use std::path::Path;

/// What a name would do where it is not quoted: make a file of this name, or show this text as markup.
const CANARY: &str = "canary";

/// Hostile names.
fn names() -> Vec<String> {
    let mut all: Vec<String> = [
        "$(touch canary)",
        "`touch canary`",
        "; touch canary;",
        "&& touch canary",
        "| touch canary",
        "> canary",
        "\"; touch canary; \"",
        "'; touch canary; '",
        "a\nshell touch canary\n",
        "a &",
        "a\\",
        "#",
        "a # b",
        "${canary}",
        "$canary",
        "%canary%",
        "{canary}",
        "a\"b",
        "a'b",
        "\"\"\"",
        "'''",
        "a\"\nname = \"canary",
        "]\n[canary]\na = 1",
        "a,b",
        "a;b",
        "a\tb",
        "a\r\nb",
        "=canary()",
        "@canary",
        "+canary",
        "-canary",
        "--canary",
        "-",
        "<script>canary</script>",
        "</script><script>canary",
        "&lt;canary",
        "]]>",
        "<!--",
        "-->",
        "\"><canary",
        "a\u{1b}[31mred",
        "a\u{202e}b",
        "\u{feff}a",
        "../canary",
        "/canary",
        ".",
        "..",
        "a/b",
        "",
        " ",
        " a ",
        "*",
        "?",
        "~",
        "!",
        "ü",
        "名",
        "\u{1f600}",
        "a\u{0}b",
        "NaN",
        "1e308",
        "true",
        "null",
        "0",
        "\u{7f}",
        "print \"canary\"",
        "include canary",
        "variable a string canary",
        "$(canary)",
        "${a}${b}",
        "\\n",
        "\\u0000",
        "a\u{b}b",
        "a\u{c}b",
        "a\u{85}b",
        "a\u{2028}b",
    ]
    .map(str::to_owned)
    .into();
    all.extend(["a".repeat(300), "ü".repeat(200), "\"".repeat(50), "$(".repeat(40), "\\".repeat(31)]);
    all
}

/// A name as TOML has it, with every character escaped that may be.
fn toml(name: &str) -> String {
    let one = |c: char| match c {
        'a'..='z' | 'A'..='Z' | '0'..='9' | ' ' => c.to_string(),
        c if (c as u32) < 0x1_0000 => format!("\\u{:04X}", c as u32),
        c => format!("\\U{:08X}", c as u32),
    };
    format!("\"{}\"", name.chars().map(one).collect::<String>())
}

/// What writes names: a call, and whether what it wrote is as it should be.
struct Writer {
    tool: &'static str,
    /// Arguments for a name.
    args: fn(&str) -> Vec<String>,
    sound: fn(&Path, &str) -> bool,
}

fn words(call: &str) -> Vec<String> {
    call.split(' ').map(str::to_owned).collect()
}

const WRITERS: [Writer; 12] = [
    Writer { tool: "dem-lammps", args: |_| words("named.toml --nearest --write-deck deck"), sound: deck },
    Writer { tool: "dem-run", args: |_| words("named.toml -o out.mcap"), sound: |_, _| true },
    Writer { tool: "dem-run", args: |_| words("named.toml --explain"), sound: |_, _| true },
    Writer {
        tool: "dem-run",
        args: |name| vec!["named.toml".into(), "-o".into(), format!("{name}.mcap")],
        sound: |_, _| true,
    },
    Writer {
        tool: "dem-run",
        args: |name| vec![format!("{name}.toml"), "-o".into(), "out.mcap".into()],
        sound: |_, _| true,
    },
    Writer {
        tool: "dem-view",
        args: |name| vec!["run.mcap".into(), "--title".into(), name.into(), "-o".into(), "out.html".into()],
        sound: page,
    },
    Writer { tool: "dem-view", args: |_| words("named.toml -o out.html"), sound: page },
    Writer {
        tool: "stone-clump",
        args: |name| {
            [&words("pebble.ply --spheres 2 --name")[..], &[name.to_owned()], &words("-o out.toml")].concat()
        },
        sound: clump,
    },
    Writer {
        tool: "wallgen",
        args: |name| {
            [&words("ascii.ply --roughness 0.001 --material")[..], &[name.to_owned()], &words("-o out.mcap")]
                .concat()
        },
        sound: |_, _| true,
    },
    Writer {
        tool: "stage-split",
        args: |_| words("named.toml --at 0,0,0.03,0,0,-1 --keep upstream -o out.toml"),
        sound: |folder, _| readable(folder),
    },
    Writer {
        tool: "dem-measure",
        args: |name| [&words("run.mcap --segregation --kind")[..], &[name.to_owned()]].concat(),
        sound: |_, _| true,
    },
    Writer {
        tool: "bluenoise-sample",
        args: |name| {
            vec![
                "ascii.ply".into(),
                "--spacing".into(),
                "0.01".into(),
                "--plot".into(),
                format!("{name}.svg"),
                "-o".into(),
                "out.ply".into(),
            ]
        },
        sound: |_, _| true,
    },
];

/// A deck: no line of it is a command that a name holds.
fn deck(folder: &Path, _: &str) -> bool {
    let files = fs::read_dir(folder.join("deck")).into_iter().flatten().flatten();
    files.filter_map(|file| fs::read_to_string(file.path()).ok()).all(|text| {
        let begins = |line: &str| {
            ["shell", "include", "print \"canary", "variable a string canary"]
                .iter()
                .any(|c| line.trim_start().starts_with(c))
        };
        !text.lines().any(begins)
    })
}

/// A page: no markup of a name.
fn page(folder: &Path, _: &str) -> bool {
    let page = fs::read_to_string(folder.join("out.html")).unwrap_or_default();
    !page.contains("<script>canary") && !page.contains("\"><canary")
}

/// A table of a clump: TOML, with the name.
fn clump(folder: &Path, name: &str) -> bool {
    let text = fs::read_to_string(folder.join("out.toml")).unwrap_or_default();
    let table: Option<toml::Table> = text.parse().ok();
    table.is_some_and(|table| table["clump"][0]["name"].as_str() == Some(name))
}

/// A scene: TOML.
fn readable(folder: &Path) -> bool {
    fs::read_to_string(folder.join("out.toml")).is_ok_and(|text| text.parse::<toml::Table>().is_ok())
}

/// Names × writers, one in so many.
pub fn run(one_in: usize, found: &mut Findings) {
    let (names, files) = (names(), super::options::calls());
    let shared =
        files.iter().find(|call| call.tool == "dem-run").map(|call| call.files.clone()).unwrap_or_default();
    let pebble = files
        .iter()
        .find(|call| call.tool == "stone-clump")
        .map(|call| call.files.clone())
        .unwrap_or_default();
    let shared: Vec<(String, Vec<u8>)> =
        shared.into_iter().chain(pebble.into_iter().filter(|f| f.0 == "pebble.ply")).collect();
    let all: Vec<(&String, &Writer)> =
        names.iter().flat_map(|name| WRITERS.iter().map(move |w| (name, w))).collect();
    let verdicts =
        all.into_par_iter().step_by(one_in).map(|(name, writer)| one(name, writer, &shared)).collect();
    found.all("names", verdicts);
}

fn one(name: &str, writer: &Writer, shared: &[(String, Vec<u8>)]) -> (String, Verdict) {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), shared);
    let scene = samples::scene();
    let (scene, _) = scene.split_once("[[outlet]]").unwrap_or((&scene, ""));
    let named = scene.replace("\"sinter\"", &toml(name)).replacen(
        "[[wall]]",
        &format!("[[wall]]\nname = {}", toml(name)),
        1,
    );
    fs::write(folder.path().join("named.toml"), named).expect("written");
    let args = (writer.args)(name);
    // No name of a file or argument holds zero.
    if args.iter().any(|word| word.contains('\0')) {
        return (
            format!("{} {name:?}", writer.tool),
            Verdict { outcome: Outcome::Refused, message: String::new() },
        );
    }
    let (status, stderr) = bounded(folder.path(), "", None, writer.tool, &args);
    let code = status.and_then(|s| s.code());
    let outcome = match judge(status, &stderr, folder.path()) {
        _ if folder.path().join(CANARY).exists() => Outcome::Unquoted,
        Outcome::Accepted if code == Some(0) && !(writer.sound)(folder.path(), name) => Outcome::Unquoted,
        other => other,
    };
    (format!("{} {:?}   # name {name:?}", writer.tool, args.join(" ")), Verdict::new(outcome, &stderr))
}
