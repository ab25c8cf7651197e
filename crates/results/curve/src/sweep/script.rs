//! The script that makes a point: an ordinary dem-run, and the line that makes its input.
//!
//! The last line of the script writes `made`: the stamp of the point and the exit code. A script that was killed leaves
//! none, and is run again. Where several run the same script, one makes the point, and the others wait for it and find it done: the system
//! ends the lock of a process that is killed (`flock`; a machine without it has no lock).

use super::grid::Setting;
use crate::study::Work;
use std::path::{Path, PathBuf};
use stream::quoted;
use stream::reads::{RECORD, VARIABLE};

#[derive(Debug, Clone)]
pub struct SweepRun {
    /// Index of its setting.
    pub setting: usize,
    /// Which seed or phase of the step, from 0.
    pub repeat: u64,
    /// Share by which its step is shorter than that of the setting.
    pub shorten: f64,
    pub folder: PathBuf,
    /// SHA-256 of scene, inputs, programs and options.
    pub stamp: String,
    /// Its name, for people.
    pub name: String,
    /// The scene's file.
    pub scene: String,
    /// Walls and inlets.
    pub inputs: Vec<String>,
    /// Overrides of the scene.
    pub sets: Vec<String>,
    /// `--threads`.
    pub threads: String,
    /// The shell line that makes one more input.
    pub each: Option<String>,
}

/// Writes the time [s]: with its fraction where bash is 5 or newer.
const NOTE_TIME: &str = "echo \"${EPOCHREALTIME-$(date +%s)}\"";

/// Argument of a script that should not wait, and its exit code where another process makes the point.
pub const NOW: &str = "--now";
/// See [`NOW`].
pub const BUSY: i32 = 75;

/// Replaces {KEY} by its value; {seed} is the number of the repeat.
pub fn fill(text: &str, setting: &Setting, repeat: u64) -> String {
    let with = |text: String, (key, value): &(String, String)| text.replace(&format!("{{{key}}}"), value);
    setting.iter().fold(text.replace("{seed}", &repeat.to_string()), with)
}

/// The first {…} that nothing fills.
pub fn unfilled(text: &str) -> Option<&str> {
    let start = text.find('{')?;
    let end = start + text[start..].find('}')?;
    let word =
        |name: &str| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "._*".contains(c));
    // ${…} and { …; } belong to the shell.
    let own = word(&text[start + 1..end]) && !text[..start].ends_with('$');
    if own { Some(&text[start..=end]) } else { unfilled(&text[end..]) }
}

impl SweepRun {
    /// A file in its folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn path(&self, name: &str) -> String {
        quoted(&self.file(name).display().to_string())
    }

    /// The line of dem-run.
    pub fn dem_run(&self) -> String {
        self.dem_run_with(&self.path("input"))
    }

    /// The line with another text for the input of this point.
    fn dem_run_with(&self, input: &str) -> String {
        let mut words = vec!["dem-run".to_owned(), quoted(&self.scene)];
        words.extend(self.inputs.iter().map(|i| quoted(i)));
        words.extend(self.each.iter().map(|_| input.to_owned()));
        words.extend(self.sets.iter().map(|set| format!("--set {}", quoted(set))));
        words.push(format!("--threads {}", quoted(&self.threads)));
        words.push(format!("-q -o {} --report {}", self.path("run.mcap"), self.path("report.json")));
        words.join(" ")
    }

    /// The whole script; `tools` is the folder of the programs.
    pub fn script(&self, tools: &Path, here: &Path, work: Work, counter: Option<Counter>) -> String {
        let old = ["made", "run.mcap", "report.json", "input", "instructions", "cpu", RECORD]
            .map(|f| self.path(f))
            .join(" ");
        // Absolute: the line before may change the folder.
        let reads = quoted(&here.join(self.file(RECORD)).display().to_string());
        let (tools, here) = (quoted(&tools.display().to_string()), quoted(&here.display().to_string()));
        let done = quoted(&format!("{} 0", self.stamp));
        let counted = match work {
            Work::Instructions => format!(" && [ -e {} ]", self.path("instructions")),
            _ => String::new(),
        };
        let mut lines = vec![
            "#!/usr/bin/env bash".to_owned(),
            format!("# cost-curve: {}", self.name),
            "set -o pipefail".to_owned(),
            format!("cd {here} && PATH={tools}:\"$PATH\" && export PATH || exit 1"),
            format!("export {VARIABLE}={reads}"),
            format!("exec 9>> {}", self.path("lock")),
            "if command -v flock > /dev/null; then".to_owned(),
            format!("  if [ \"${{1-}}\" = {NOW} ]; then flock -n 9 || exit {BUSY}; else flock 9; fi"),
            "fi".to_owned(),
            format!("[ \"$(cat {} 2> /dev/null)\" = {done} ]{counted} && exit", self.path("made")),
            format!("rm -f {old}; {NOTE_TIME} > {}", self.path("begun")),
        ];
        let made = |code: &str| format!("echo {} {code} > {}", self.stamp, self.path("made"));
        if let Some(each) = &self.each {
            let (input, words) = (self.path("input"), self.path("words"));
            lines.push(format!("{{ {each}\n}} > {input} 2> {words} || {{ {}; exit 1; }}", made("each")));
            // A line that prints nothing gives no input.
            lines.push(format!("own=({input}); [ -s {input} ] || own=()"));
        }
        lines.push(format!("{NOTE_TIME} > {}", self.path("prepared")));
        let counted = match (work, counter) {
            (Work::Instructions, Some(counter)) => counter.around(&self.path("instructions")),
            _ => String::new(),
        };
        let line = self.dem_run_with("\"${own[@]}\"");
        lines.push("TIMEFORMAT='%U %S'".to_owned());
        lines.push(format!("{{ time {counted}{line} 2> {}; }} 2> {}", self.path("words"), self.path("cpu")));
        lines.push("code=$?".to_owned());
        lines.push(format!("[ $code -ge 128 ] || {}", made("$code")));
        lines.join("\n") + "\n"
    }
}

/// A program that counts instructions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Counter {
    /// The counters of the processor.
    Perf,
    /// A simulator, 50 times slower.
    Valgrind,
}

impl Counter {
    fn around(self, file: &str) -> String {
        match self {
            Counter::Perf => format!("perf stat -x, -e instructions:u -o {file} -- "),
            Counter::Valgrind => {
                format!("valgrind --tool=callgrind --callgrind-out-file=/dev/null --log-file={file} -- ")
            }
        }
    }

    /// The count in its output.
    pub fn read(self, text: &str) -> Option<f64> {
        match self {
            Counter::Perf => {
                text.lines().find(|l| l.contains("instructions"))?.split(',').next()?.parse().ok()
            }
            Counter::Valgrind => {
                let line = text.lines().find(|l| l.contains("Collected :"))?;
                line.rsplit(' ').next()?.parse().ok()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_are_filled_and_what_is_left_is_found() {
        let setting = vec![("spacing".to_owned(), "0.01".to_owned())];
        let line = fill("a --spacing {spacing} --seed {seed} ${HOME} {zeta}", &setting, 2);
        assert_eq!(line, "a --spacing 0.01 --seed 2 ${HOME} {zeta}");
        assert_eq!(unfilled(&line), Some("{zeta}"));
        assert_eq!(unfilled("awk '{print $1}' ${x} { a; }"), None);
        assert_eq!((quoted("a=[0,1]"), quoted("it's")), ("'a=[0,1]'".to_owned(), "'it'\\''s'".to_owned()));
    }

    /// Three processes run the script of one point, with a dem-run that notes each start: one makes it, and one that does not want to wait ends with [`BUSY`].
    #[test]
    fn a_point_that_several_processes_want_is_made_once() {
        let folder = std::env::temp_dir().join(format!("curve-script.{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let (tool, log) = (folder.join("dem-run"), folder.join("log"));
        std::fs::write(&tool, format!("#!/bin/sh\necho run >> {}; sleep 0.5\n", log.display())).unwrap();
        let status = std::process::Command::new("chmod").arg("+x").arg(&tool).status();
        assert!(status.unwrap().success());
        let job = SweepRun {
            setting: 0,
            repeat: 0,
            shorten: 0.0,
            folder: folder.clone(),
            stamp: "0a1b".to_owned(),
            name: "a point".to_owned(),
            scene: "s.toml".to_owned(),
            inputs: Vec::new(),
            sets: Vec::new(),
            threads: "1".to_owned(),
            each: None,
        };
        let script = folder.join("run.sh");
        std::fs::write(&script, job.script(&folder, &folder, Work::Steps, None)).unwrap();
        let start = || std::process::Command::new("bash").arg(&script).spawn().unwrap();
        let runs = || std::fs::read_to_string(&log).unwrap().lines().count();
        let together: Vec<_> = (0..3).map(|_| start()).collect();
        for mut process in together {
            assert!(process.wait().unwrap().success());
        }
        let locks = std::process::Command::new("flock").arg("--version").output().is_ok();
        assert!(!locks || runs() == 1, "{} runs", runs());
        assert_eq!(std::fs::read_to_string(job.file("made")).unwrap(), "0a1b 0\n");
        // What was made stays; another stamp is another point.
        let before = runs();
        assert!(start().wait().unwrap().success() && runs() == before);
        let other = SweepRun { stamp: "2c3d".to_owned(), ..job };
        std::fs::write(&script, other.script(&folder, &folder, Work::Steps, None)).unwrap();
        let mut first = start();
        std::thread::sleep(std::time::Duration::from_millis(250));
        let now = std::process::Command::new("bash").arg(&script).arg(NOW).status().unwrap();
        assert!(first.wait().unwrap().success() && (!locks || now.code() == Some(BUSY)), "{now:?}");
        assert!(!locks || runs() == before + 1);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn counts_are_read() {
        let perf = "# started\n\n123456,,instructions:u,1000,100.00,,\n";
        assert_eq!(Counter::Perf.read(perf), Some(123456.0));
        assert_eq!(Counter::Perf.read("<not supported>,,instructions:u"), None);
        assert_eq!(Counter::Valgrind.read("==1== Collected : 789\n"), Some(789.0));
    }
}
