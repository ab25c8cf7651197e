//! Names of materials, walls and clumps, and how they are written into texts of other languages: one function for each language.

use std::fmt::Write as _;

/// A name as it is given on a command line.
///
/// # Errors
/// Control characters, in words.
pub fn name(text: &str) -> Result<String, String> {
    match forbidden(text) {
        None => Ok(text.to_owned()),
        Some(c) => Err(format!("has {}: {CURE}", in_words(c))),
    }
}

/// What to do about a character that no name may have.
pub const CURE: &str = "write the name without line breaks and control characters";

/// The first character that no name may have: names go into scripts and tables line by line.
pub fn forbidden(text: &str) -> Option<char> {
    text.chars().find(|c| c.is_control() || matches!(c, '\u{2028}' | '\u{2029}'))
}

/// Such a character, for messages.
pub fn in_words(c: char) -> String {
    format!("the control character U+{:04X}", u32::from(c))
}

/// A text as a string of TOML, with its quotes.
pub fn toml(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out += &format!("\\u{:04X}", u32::from(c)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A text for a comment of a LAMMPS script. A line that ends in `&` goes on in the next one, and so do three quotes until the next three, also in
/// comments; `$` begins a variable.
pub fn lammps_comment(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        let harmful = matches!(c, '&' | '"' | '\'' | '$') || forbidden(&c.to_string()).is_some();
        // Writing to a string cannot fail.
        let _ = if harmful { write!(out, "\\u{{{:x}}}", u32::from(c)) } else { out.write_char(c) };
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOSTILE: [&str; 12] = [
        "plain",
        "Ångström – 粒子",
        "5\" block",
        "a\\",
        "a'b",
        "a\"\"\"b",
        "clay &",
        "x\nshell touch PWNED\n#",
        "tab\tand\rreturn",
        "bell\u{7}\u{1b}[31m\u{7f}\u{85}",
        "$(shell)${x}",
        "line\u{2028}separator",
    ];

    #[test]
    fn a_name_is_one_line_without_control_characters() {
        let refused: Vec<usize> = (0..HOSTILE.len()).filter(|k| name(HOSTILE[*k]).is_err()).collect();
        assert_eq!(refused, [7, 8, 9, 11]);
        let message = name(HOSTILE[7]).unwrap_err();
        assert_eq!(message, format!("has the control character U+000A: {CURE}"));
    }

    #[test]
    fn toml_gives_a_text_back() {
        for text in HOSTILE {
            let document: toml_edit::DocumentMut =
                format!("name = {}\nnext = 1\n", super::toml(text)).parse().unwrap();
            assert_eq!(document["name"].as_str(), Some(text));
            assert_eq!(document["next"].as_integer(), Some(1));
        }
    }

    #[test]
    fn a_comment_of_lammps_ends_with_its_line() {
        for text in HOSTILE {
            let comment = lammps_comment(text);
            assert!(!comment.contains(['&', '"', '\'', '$', '\n', '\r', '\u{2028}', '\u{7}']), "{comment}");
        }
        assert_eq!(lammps_comment("clay &–clay &"), "clay \\u{26}–clay \\u{26}");
        assert_eq!(lammps_comment("Ångström – 粒子"), "Ångström – 粒子");
    }
}
