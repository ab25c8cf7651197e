//! Words of command lines that are kept as text.

/// A word that a shell reads back as it is.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "_-./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_back() {
        let words = ["a=[0,1]", "it's", "", "x/y-1.mcap"].map(quoted);
        assert_eq!(words, ["'a=[0,1]'", "'it'\\''s'", "''", "x/y-1.mcap"]);
    }
}
