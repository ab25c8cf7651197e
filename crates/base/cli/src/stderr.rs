//! The one way to stderr: what comes from files and arguments is escaped, so that a name cannot steer the terminal.

use std::{borrow::Cow, fmt::Write as _, io::Write as _};

/// Prints one line, escaped. In one write: the tools of a pipe print at the same time, and stderr is not buffered.
pub fn say(line: &str) {
    write(&escaped(line));
}

/// Prints a text of several lines, each escaped.
pub(crate) fn say_lines(text: &str) {
    let lines: Vec<Cow<'_, str>> = text.lines().map(escaped).collect();
    write(&lines.join("\n"));
}

fn write(text: &str) {
    let _ = std::io::stderr().write_all(format!("{text}\n").as_bytes());
}

/// A text with its control characters, and those that are invisible or turn the direction of writing, as `\u{1b}`: they could colour a
/// message, hide a part of it, or change what the terminal does next.
pub fn escaped(text: &str) -> Cow<'_, str> {
    if !text.chars().any(steers) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        // Writing to a string cannot fail.
        let _ = if steers(c) { write!(safe, "{}", c.escape_default()) } else { safe.write_char(c) };
    }
    Cow::Owned(safe)
}

fn steers(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_escaped_and_the_rest_stays() {
        assert!(matches!(escaped("Ångström – 粒子, µ = 0.5"), Cow::Borrowed(_)));
        let text = "a\u{1b}[31mb\u{7}c\nd\te\u{202e}f\u{9b}g\u{200b}h\u{e0041}";
        let safe = "a\\u{1b}[31mb\\u{7}c\\nd\\te\\u{202e}f\\u{9b}g\\u{200b}h\\u{e0041}";
        assert_eq!(escaped(text), safe);
    }
}
