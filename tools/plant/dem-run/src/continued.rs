//! The command that continues a stopped run, as it can be typed.

use cli::Output;
use dem::{Entrance, Halt};
use std::path::{Path, PathBuf};
use stream::quoted;

/// With it the new output holds the whole run, so that one file can be measured and drawn.
const WHOLE: &str = "--whole";

/// The call of this program again, from its checkpoint in `file`: the same options, a new output.
pub fn command(file: &Path, more: &[String]) -> String {
    let mut words = vec!["dem-run".to_owned()];
    let given = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    words.extend(without_keys(kept(given), more));
    words.extend_from_slice(more);
    if !words.iter().any(|word| word == WHOLE) {
        words.push(WHOLE.to_owned());
    }
    words.extend(["--resume".to_owned(), file.display().to_string()]);
    words.extend(["-o".to_owned(), next(file).display().to_string()]);
    words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" ")
}

/// [`command`], with what else it needs.
pub fn sentence(file: &Path, more: &[String]) -> String {
    let stdin = std::env::args_os().any(|word| word == "-");
    let stdin = if stdin { " (with the same input on stdin)" } else { "" };
    format!("continue{stdin} with: {}", command(file, more))
}

/// The file that a run writes: that of `-o`, or the one that stdout was sent to.
pub fn file(output: &Output) -> Option<PathBuf> {
    let stdout = || std::fs::read_link("/proc/self/fd/1").ok().filter(|path| path.is_file());
    output.path().map(Path::to_owned).or_else(stdout)
}

/// Largest share that a guard of overlap or motion may have [–].
const WIDEST: f64 = 1.0;
/// How much wider than what was found a guard is made, so that the run does not stop again at once [–].
const ROOM: f64 = 1.2;

/// A limit that is twice as wide, and wider than what was found [–]: two digits, rounded up.
fn above(limit: f64, found: f64) -> f64 {
    let wide = (2.0 * limit).max(ROOM * found);
    let unit = 10f64.powf(wide.log10().floor() - 1.0);
    format!("{:.1e}", (wide / unit).ceil() * unit).parse().unwrap_or(wide)
}

/// What makes a guard that has tripped wider, as options; none where no width that is allowed would do.
pub fn wider(halt: &Halt) -> Vec<String> {
    let share = |name: &str, share: f64, limit: f64| {
        let wide = above(limit, share).min(WIDEST);
        (wide > share && wide > limit).then(|| format!("guards.{name}={wide}"))
    };
    let set = match halt {
        Halt::Overlap { share: found, limit, .. } | Halt::InletOverlap { share: found, limit, .. } => {
            share("overlap", *found, *limit)
        }
        Halt::Motion { share: found, limit, .. } | Halt::TooFast { share: found, limit, .. } => {
            share("motion", *found, *limit)
        }
        Halt::CameBack { .. } => Some("guards.zones=false".to_owned()),
        Halt::NoRoom { by: Entrance::Insert(k), .. } => Some(format!("insert.{k}.when_blocked=wait")),
        Halt::Energy { made, of, limit, .. } if *of > 0.0 => {
            Some(format!("guards.energy={}", above(*limit, made / of))).filter(|_| made.is_finite())
        }
        _ => None,
    };
    set.map_or(Vec::new(), |set| vec!["--set".to_owned(), set])
}

/// The words of a command line without its output and without what it resumed.
fn kept(words: impl IntoIterator<Item = String>) -> Vec<String> {
    let (mut kept, mut words) = (Vec::new(), words.into_iter());
    while let Some(word) = words.next() {
        let cluster = word.strip_prefix('-').filter(|rest| !rest.starts_with('-')).unwrap_or_default();
        if let Some((before, value)) = cluster.split_once('o') {
            if !before.is_empty() {
                kept.push(format!("-{before}"));
            }
            if value.is_empty() {
                words.next();
            }
        } else if ["--output", "--resume"].contains(&&*word) {
            words.next();
        } else if !word.starts_with("--output=") && !word.starts_with("--resume=") {
            kept.push(word);
        }
    }
    kept
}

/// The words without the `--set` of keys that `more` sets again.
fn without_keys(words: Vec<String>, more: &[String]) -> Vec<String> {
    let key = |word: &str| word.split('=').next().unwrap_or_default().to_owned();
    let again = |word: &str| word.contains('=') && more.iter().any(|set| key(set) == key(word));
    let mut left: Vec<String> = Vec::new();
    for word in words {
        if left.last().is_some_and(|last| last == "--set") && again(&word) {
            left.pop();
        } else if !word.strip_prefix("--set=").is_some_and(again) {
            left.push(word);
        }
    }
    left
}

/// A name for the rest of a run that no file has: `run.2.mcap` after `run.mcap`, `run.mcap.part` or `run.1.mcap`.
fn next(file: &Path) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let name = name.strip_suffix(".part").unwrap_or(&name);
    let number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let name = name.rsplit_once('.').filter(|(_, end)| number(end)).map_or(name, |(stem, _)| stem);
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, "mcap"));
    let stem = stem.rsplit_once('.').filter(|(_, end)| number(end)).map_or(stem, |(stem, _)| stem);
    let named = |k: u32| file.with_file_name(format!("{stem}.{k}.{ending}"));
    let free = |path: &PathBuf| !path.exists() && cli::parts_of(path).is_empty();
    (2..1000).map(named).find(free).unwrap_or_else(|| named(1000))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Vec<String> {
        line.split(' ').map(str::to_owned).collect()
    }

    #[test]
    fn the_output_and_what_was_resumed_are_left_out() {
        for (line, left) in [
            (
                "s.toml w.mcap --set a.0.b=1 -o run.mcap --threads 2",
                "s.toml w.mcap --set a.0.b=1 --threads 2",
            ),
            ("s.toml -orun.mcap -q", "s.toml -q"),
            ("s.toml -qo run.mcap", "s.toml -q"),
            ("--output=run.mcap s.toml - --resume x.mcap --output y", "s.toml -"),
        ] {
            assert_eq!(kept(words(line)), words(left));
        }
    }

    /// A guard is made wide enough for what was found, or nothing is proposed.
    #[test]
    fn a_wider_guard_is_wider_than_what_was_found() {
        let motion = |share, limit| {
            let position = geom::Vec3::zeros();
            wider(&Halt::Motion { time: 1.0, id: 1, position, motion: 0.1, share, limit }).concat()
        };
        assert_eq!(motion(0.26, 0.25), "--setguards.motion=0.5");
        assert_eq!(motion(0.6, 0.25), "--setguards.motion=0.72");
        assert_eq!(motion(0.9, 0.25), "--setguards.motion=1");
        assert_eq!(motion(1.54, 0.25), "");
        assert_eq!(motion(f64::NAN, 0.25), "");
        let energy = |made, of| wider(&Halt::Energy { time: 1.0, made, of, limit: 0.02 }).concat();
        assert_eq!(
            (energy(0.3, 1.0), energy(0.3, 0.0)),
            ("--setguards.energy=0.36".to_owned(), String::new())
        );
    }

    #[test]
    fn a_key_that_is_set_again_is_left_out() {
        let line = words("s.toml --set guards.overlap=0.1 --set guards.motion=0.1 --set=guards.overlap=0.2");
        assert_eq!(
            without_keys(line, &words("--set guards.overlap=0.4")),
            words("s.toml --set guards.motion=0.1")
        );
    }

    #[test]
    fn the_rest_of_a_run_has_the_next_free_name() {
        for (name, then) in [
            ("a/run.mcap", "a/run.2.mcap"),
            ("run.mcap.part", "run.2.mcap"),
            ("run.mcap.2.part", "run.2.mcap"),
            ("run.2.mcap", "run.2.mcap"),
            ("run", "run.2.mcap"),
        ] {
            assert_eq!(next(Path::new(name)), Path::new(then), "{name}");
        }
    }

    #[test]
    fn a_shell_reads_words_back() {
        assert_eq!(quoted("a/b-1.mcap"), "a/b-1.mcap");
        assert_eq!(quoted("my plant's.toml"), r"'my plant'\''s.toml'");
        assert_eq!(quoted("contact.*.x=[1, 2]"), "'contact.*.x=[1, 2]'");
    }
}
