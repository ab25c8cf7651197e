//! Blanks of a command: `{friction}`, `{seed}`, `{here}`.

/// Digits of a value in a command.
const DIGITS: usize = 8;

/// A value with the digits that a command gets.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// A value as text.
pub fn shown(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e7).contains(&size) { format!("{value:e}") } else { value.to_string() }
}

/// A text with its blanks filled: name and value of each.
pub fn filled(text: &str, values: &[(&str, String)]) -> String {
    let with = |text: String, (name, value): &(&str, String)| text.replace(&format!("{{{name}}}"), value);
    values.iter().fold(text.to_owned(), with)
}

/// Whether a name can be a blank.
pub(super) fn is_word(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "._-".contains(c))
}

/// The names of the blanks of a command; `${NAME}` and `{ …; }` belong to the shell.
pub(super) fn names(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut from = 0;
    while let Some(start) = text[from..].find('{').map(|k| k + from) {
        let Some(end) = text[start..].find('}').map(|k| k + start) else { break };
        let name = &text[start + 1..end];
        let own = is_word(name) && !text[..start].ends_with('$');
        names.extend(own.then_some(name));
        from = if own { end + 1 } else { start + 1 };
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_are_told_from_the_shell() {
        assert_eq!(names("run {a} ${HOME} awk '{print $1}' {b_2} { c; } {x,y}"), ["a", "b_2"]);
        let values = [("a", "1".to_owned()), ("seed", "7".to_owned())];
        assert_eq!(filled("m {a} --seed {seed} ${a}", &values[..]), "m 1 --seed 7 $1");
    }

    #[test]
    fn values_are_short_and_read_back() {
        for value in [0.1 + 0.2, 1.0 / 3.0, 1e-7 / 3.0, 2.5e11, -0.25] {
            let text = shown(rounded(value));
            assert_eq!(text.parse::<f64>().unwrap(), rounded(value), "{text}");
            assert!(text.len() <= 14, "{text}");
        }
        assert_eq!(shown(rounded(0.1 + 0.2)), "0.3");
    }
}
