//! Words of command lines that are kept as text.

/// A word that a shell reads back as it is.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "_-./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// A word of a line.
#[derive(Debug, Default, Clone)]
struct Word {
    /// Without its quotes.
    text: String,
    /// Whether the shell computes a part of it: a variable, or names that match.
    computed: bool,
    /// Whether a command begins with it.
    begins: bool,
}

/// Words of the shell that stand in front of a command.
const IN_FRONT: [&str; 8] = ["if", "then", "else", "do", "while", "until", "!", "{"];

/// The words of a line; those of a command within double quotes (`"$(cat file)"`) as well.
fn lexed(line: &str) -> Vec<Word> {
    let (mut words, mut inner) = (Vec::<Word>::new(), Vec::new());
    let (mut word, mut quote, mut open, mut begins) = (Word::default(), None, None, true);
    let mut end = |word: &mut Word, begins: &mut bool| {
        let mut done = std::mem::take(word);
        if !done.text.is_empty() {
            done.begins = *begins;
            *begins &= IN_FRONT.contains(&&*done.text) || is_assignment(&done.text);
            words.push(done);
        }
    };
    let mut letters = line.chars();
    while let Some(c) = letters.next() {
        match (quote, c) {
            (Some('"'), '"') => {
                let within = &word.text[open.unwrap_or(0)..];
                if within.contains("$(") || within.contains('`') {
                    inner.extend(lexed(within));
                }
                quote = None;
            }
            (Some(q), c) if c == q => quote = None,
            (Some('"') | None, '\\') => word.text.extend(letters.next()),
            (Some(q), c) => {
                word.computed |= q == '"' && c == '$';
                word.text.push(c);
            }
            (None, '\'' | '"') => (quote, open) = (Some(c), Some(word.text.len())),
            (None, '<' | '>') => end(&mut word, &mut begins),
            (None, c) if ";|&()`\n".contains(c) => {
                end(&mut word, &mut begins);
                begins = true;
            }
            (None, c) if c.is_whitespace() => end(&mut word, &mut begins),
            (None, c) => {
                word.computed |= "$*?[~".contains(c);
                word.text.push(c);
            }
        }
    }
    end(&mut word, &mut begins);
    words.extend(inner);
    words
}

/// Whether a word gives a variable its value (`f=2`).
fn is_assignment(word: &str) -> bool {
    let name = word.split_once('=').map_or("", |(name, _)| name);
    !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// What may be the name of a file in a line of a shell: its words without their quotes, and the text behind each `=` in them. What the shell would compute
/// (`$x`, `*.csv`) stays as it is written.
pub fn words(line: &str) -> Vec<String> {
    let mut words: Vec<String> = lexed(line).into_iter().map(|word| word.text).collect();
    let values =
        |word: &String| word.match_indices('=').map(|(at, _)| word[at + 1..].to_owned()).collect::<Vec<_>>();
    let behind: Vec<String> = words.iter().flat_map(values).filter(|value| !value.is_empty()).collect();
    words.extend(behind);
    words
}

/// Programs that read the files of their words and no others.
const FILTERS: [&str; 42] = [
    "[", "awk", "basename", "bc", "cat", "cd", "comm", "cp", "cut", "dirname", "echo", "exit", "expr",
    "export", "false", "grep", "gzip", "head", "join", "ln", "mawk", "mkdir", "mv", "nl", "paste", "printf",
    "read", "rm", "sed", "seq", "set", "sort", "tail", "tee", "test", "time", "touch", "tr", "true", "uniq",
    "wc", "zcat",
];

/// The first command of a line whose files cannot be known from the line: a program that may read files which the line does not name, or a file whose name the
/// shell computes. `known`: programs that note what they read ([`crate::reads`]).
pub fn reads_more(line: &str, known: impl Fn(&str) -> bool) -> Option<String> {
    let mut notes = true;
    for word in lexed(line) {
        if word.begins && !is_assignment(&word.text) && !IN_FRONT.contains(&&*word.text) {
            let is_word = ["for", "done", "fi", "}", "case", "esac", "elif"].contains(&&*word.text);
            notes = known(&word.text);
            if !notes && !is_word && !FILTERS.contains(&&*word.text) {
                return Some(word.text);
            }
        } else if !notes && word.computed && word.text.contains('/') && !word.text.contains(['(', '{', ' ']) {
            return Some(word.text);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_back() {
        let words = ["a=[0,1]", "it's", "", "x/y-1.mcap"].map(quoted);
        assert_eq!(words, ["'a=[0,1]'", "'it'\\''s'", "''", "x/y-1.mcap"]);
    }

    #[test]
    fn names_of_files_are_found_in_a_line() {
        let found = |line: &str, name: &str| words(line).iter().any(|word| word == name);
        for (line, name) in [
            ("f=$(cat '/my plant/factor.txt'); awk", "/my plant/factor.txt"),
            ("bluenoise-sample <scan.xyz --spacing 1|wallgen -q", "scan.xyz"),
            ("bluenoise-sample \"my scan.xyz\" > a", "my scan.xyz"),
            ("f=$(cat x); bluenoise-sample \"my scan.xyz\" > a", "my scan.xyz"),
            ("cat my\\ scan.xyz", "my scan.xyz"),
            ("lab-test --sample=/a/s.toml", "/a/s.toml"),
            ("echo \"a $(cat /a/b.txt)\"", "/a/b.txt"),
            ("x=`cat /a/b.txt`", "/a/b.txt"),
            ("cat '/it'\\''s/b.txt'", "/it's/b.txt"),
        ] {
            assert!(found(line, name), "{line}: {:?}", words(line));
        }
    }

    #[test]
    fn what_a_line_does_not_tell_is_named() {
        let own = |program: &str| program.starts_with("dem-");
        for (line, expected) in [
            (
                "dem-run s.toml -q -o r.mcap && dem-measure r.mcap -q | tail -1 | awk -F, '{ print $3/2 }'",
                None,
            ),
            ("f=$(cat /a/f.txt); awk -v f=$f 'BEGIN { print f }'", None),
            ("dem-run $HOME/s.toml", None),
            ("cat $HOME/f.txt", Some("$HOME/f.txt")),
            ("cat /a/*.csv", Some("/a/*.csv")),
            ("dem-run s.toml | python3 fit.py", Some("python3")),
            ("x=1 ./fit.sh", Some("./fit.sh")),
            ("for k in 1 2; do dem-run s.toml; done", None),
            ("if [ 1 = 1 ]; then dem-run s.toml; fi", None),
        ] {
            assert_eq!(reads_more(line, own).as_deref(), expected, "{line}");
        }
    }
}
