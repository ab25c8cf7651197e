//! From text to keys, with errors that name the place and the nearest known key.

use super::Text;
use super::missing::missing;
use crate::error::{Place, Result, SceneError, nearest};
use crate::keys::{SceneKeys, TABLES};
use serde_path_to_error::{Path, Segment};
use toml::de::Error;

/// Keys of later versions, and what to do until then.
const NOT_YET: &[(&str, &str)] = &[
    ("temperature", "leave it out"),
    ("wear", "leave it out"),
    ("roughness", "give it to wallgen --roughness"),
];

/// Keys as other programs and textbooks call them, and keys of a table inside of this one: what a scene has instead.
const INSTEAD: &[(&str, &str, &str)] = &[
    ("rolling_friction", "rolling_resistance", "rolling_resistance"),
    ("twisting_friction", "twisting_resistance", "twisting_resistance"),
    ("friction", "sliding_friction", "sliding_friction"),
    ("poisson_ratio", "poisson", "poisson"),
    ("radius", "diameter", "diameter"),
    ("rpm", "rotate", "rotate = { about, through, rpm }"),
    ("about", "rotate", "rotate = { about, through, rpm }"),
    ("through", "rotate", "rotate = { about, through, rpm }"),
    ("amplitude", "vibrate", "vibrate = { amplitude, frequency }"),
    ("frequency", "vibrate", "vibrate = { amplitude, frequency }"),
];

/// Reads a scene.
///
/// # Errors
/// Text that is not TOML, an unknown key, a value of the wrong type.
pub(crate) fn parse(text: &Text) -> Result<SceneKeys> {
    if text.toml.lines().all(|line| line.trim().is_empty() || line.trim_start().starts_with('#')) {
        let message =
            "there is nothing in it: a scene has at least [time], a [[material]] and grains".to_owned();
        return Err(SceneError::Syntax { place: text.at(None), message });
    }
    let here = |table: &str, e: &Error| refused((text, text.at(e.span().map(|s| s.start))), table, e);
    let keys = toml::Deserializer::parse(&text.toml).map_err(|e| here("", &e))?;
    serde_path_to_error::deserialize(keys).map_err(|e| here(&dotted(e.path()), e.inner()))
}

/// Reads a scene that a program has made from another ([`Text::made_into`]).
///
/// # Errors
/// As for [`parse`], at their places in the other.
pub(crate) fn parse_made(text: &Text) -> Result<SceneKeys> {
    let there = |table: &str, e: &Error| {
        let key = unknown(e.message().trim()).map_or(String::new(), |(key, _)| format!(".{key}"));
        refused((text, text.place(&format!("{table}{key}"))), table, e)
    };
    let keys = toml::Deserializer::parse(&text.toml).map_err(|e| there("", &e))?;
    serde_path_to_error::deserialize(keys).map_err(|e| there(&dotted(e.path()), e.inner()))
}

/// The error of a scene at a place for an error of the parser in the table at a dotted path.
fn refused((text, place): (&Text, Place), table: &str, error: &Error) -> SceneError {
    let (start, message) = (error.span().map(|s| s.start), error.message().trim());
    if let Some(key) = message.strip_prefix("missing field `").and_then(|rest| rest.strip_suffix('`')) {
        return SceneError::Syntax { place, message: missing(table, key) };
    }
    let word = error.span().and_then(|s| text.toml.get(s)).unwrap_or_default().trim();
    if let Some(message) = written_once(message, word, text.line(start)) {
        return SceneError::Syntax { place, message };
    }
    match unknown(message) {
        Some((key, rest)) => unknown_key(place, key, rest),
        None => {
            let hint = variant_hint(message).map_or(String::new(), |h| format!("; did you mean '{h}'?"));
            let tables = format!("tables: write each below a line [[{table}]]");
            SceneError::Syntax {
                place,
                message: format!("{}{hint}", plain(message).replace(TABLES, &tables)),
            }
        }
    }
}

/// The key that the parser does not know, and those that it does.
fn unknown(message: &str) -> Option<(&str, &str)> {
    let rest = message.strip_prefix("unknown field `")?;
    // The last such words are the parser's own: a key may hold any text.
    rest.rsplit_once("`, expected ").or(rest.rsplit_once("`, there are "))
}

/// The path of a table as `--set` writes it.
fn dotted(path: &Path) -> String {
    let segment = |s: &Segment| match s {
        Segment::Seq { index } => Some(index.to_string()),
        Segment::Map { key } => Some(key.clone()),
        _ => None,
    };
    path.iter().filter_map(segment).collect::<Vec<_>>().join(".")
}

/// Keys and tables that are there twice, and lists of tables that are written as a table; `word` is the text at the error.
fn written_once(message: &str, word: &str, line: &str) -> Option<String> {
    if message.starts_with("duplicate key") {
        return Some(format!("'{word}' is there twice: leave one of them out"));
    }
    let list = message.starts_with(&format!("invalid type: map, expected {TABLES}"));
    let head = line.trim().strip_prefix('[').filter(|head| list && !head.starts_with('['))?;
    let name = head.split(']').next().unwrap_or_default().trim();
    Some(format!("[{name}] is one of a list: write it as [[{name}]]"))
}

fn unknown_key(place: Place, key: &str, expected: &str) -> SceneError {
    if let Some((key, instead)) = NOT_YET.iter().find(|(k, _)| *k == key) {
        return SceneError::NotYet { place, key: (*key).to_owned(), instead };
    }
    let known: Vec<&str> = quoted(expected).collect();
    let instead = INSTEAD.iter().find(|(other, own, _)| *other == key && known.contains(own));
    let hint = match instead.map(|i| i.2).or_else(|| nearest(key, known.iter().copied())) {
        Some(near) => format!("; did you mean '{near}'?"),
        None if known.is_empty() => "; this table has no keys".to_owned(),
        None => format!("; known here: {}", known.join(", ")),
    };
    SceneError::UnknownKey { place, key: key.to_owned(), hint }
}

/// Characters of a message that are shown, before and after what is left out.
const SHOWN: [usize; 2] = [200, 160];

/// A message without the middle of a very long value in it.
fn bounded(message: &str) -> String {
    let count = message.chars().count();
    if count <= 2 * (SHOWN[0] + SHOWN[1]) {
        return message.to_owned();
    }
    let (head, tail) = (message.chars().take(SHOWN[0]), message.chars().skip(count - SHOWN[1]));
    head.chain(['…']).chain(tail).collect()
}

/// The parser's message in the terms of a scene.
fn plain(message: &str) -> String {
    bounded(&rounded(message))
        .replace('`', "'")
        .replace("invalid length ", "wrong number of values: ")
        .replace("an array of length ", "a list of ")
        .replace("invalid type: map,", "invalid type: table,")
        .replace("invalid type: sequence,", "invalid type: list,")
        .replace("invalid type: ", "wrong kind of value: ")
        .replace("floating point", "number")
}

/// The message with a number of many digits, as the parser writes 1e99, in its short form.
fn rounded(message: &str) -> String {
    let number = message.split('`').nth(1).filter(|word| word.len() > 24);
    match number.and_then(|digits| Some((digits, digits.parse::<f64>().ok()?))) {
        Some((digits, number)) => message.replacen(digits, &format!("{number:e}"), 1),
        None => message.to_owned(),
    }
}

/// The nearest of the words that serde expected.
fn variant_hint(message: &str) -> Option<&str> {
    let (wrong, rest) = message.strip_prefix("unknown variant `")?.split_once('`')?;
    nearest(wrong, quoted(rest))
}

/// The words between back quotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(toml: &str) -> String {
        parse(&Text::new("s.toml", toml.to_owned())).unwrap_err().to_string()
    }

    #[test]
    fn a_hint_names_what_the_key_can_only_mean() {
        let motion = |key: &str| {
            refused(&format!("[time]\nuntil = 1\n[[wall]]\nmaterial = \"m\"\n[wall.motion]\n{key} = 5"))
        };
        assert!(
            motion("rpm").contains("did you mean 'rotate = { about, through, rpm }'?"),
            "{}",
            motion("rpm")
        );
        assert!(motion("frequency").contains("'vibrate = { amplitude, frequency }'"));
        let contact = |key: &str| {
            refused(&format!("[[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 1\n{key} = 0.1"))
        };
        assert!(contact("rolling_friction").contains("did you mean 'rolling_resistance'?"));
        assert!(contact("friction").contains("did you mean 'sliding_friction'?"));
        // Two of its three letters are others: no hint is better than a wrong one.
        let message = refused("[time]\nend = 1");
        assert!(
            message.contains("known here: until, until_unbalanced, until_kinetic, dt, safety"),
            "{message}"
        );
    }

    #[test]
    fn a_list_of_known_keys_is_never_empty() {
        let message = refused("\"a`b\" = 1");
        assert!(message.contains("unknown key 'a`b'; known here: gravity, first_id"), "{message}");
        let message = refused("\"\" = 1");
        assert!(message.contains("known here: gravity"), "{message}");
    }

    #[test]
    fn unknown_keys_name_place_and_nearest() {
        let message = refused("[time]\nuntil = 1\nsaftey = 0.1\n");
        assert_eq!(message, "s.toml:3:1: unknown key 'saftey'; did you mean 'safety'?");
        let message = refused(
            "[time]\nuntil = 1\n[[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 1\nslidingfriction = 1",
        );
        assert!(message.contains("s.toml:6:1") && message.contains("'sliding_friction'"), "{message}");
        assert!(refused("[time]\nzzzzzzzzzzzz = 1").contains("known here: until, until_unbalanced"));
    }

    #[test]
    fn wrong_types_name_the_place() {
        let message = refused("[time]\nuntil = \"long\"");
        assert!(message.starts_with("s.toml:2:9: ") && message.contains("expected a number"), "{message}");
        assert!(refused("[time]\ndt = \"fast\"").contains("\"auto\" or a number"));
        let message = refused("first_id = 1e99");
        assert!(
            message.contains("invalid value: number '1e99', expected a whole number from 0"),
            "{message}"
        );
        let message = refused("[time]\n[[contact]]\nbetween=[\"*\",\"*\"]\nrestitution=1\nlaw=\"herz\"");
        assert!(message.contains("did you mean 'hertz'?"), "{message}");
        assert!(refused("[time\n").starts_with("s.toml:1:"));
    }

    #[test]
    fn everyday_mistakes_name_the_cure() {
        assert_eq!(
            refused("# all\n\n"),
            "s.toml: there is nothing in it: a scene has at least [time], a [[material]] and grains"
        );
        let contact = "between = [\"*\", \"*\"]\nrestitution = 1\n";
        let message = refused(&format!("[time]\nuntil = 1\n[contact]\n{contact}"));
        assert!(
            message.starts_with("s.toml:3:1: ") && message.ends_with("write it as [[contact]]"),
            "{message}"
        );
        assert!(
            refused("time = 3").ends_with("integer '3', expected a table, such as { until = 1 }"),
            "{}",
            refused("time = 3")
        );
        let message = refused(&format!("[[contact]]\n{contact}[[contact]]\nbetween = [\"*\", \"*\"]\n"));
        let wanted = "s.toml:4:1: contact.1: 'restitution' is missing: add it, such as restitution = 0.5";
        assert_eq!(message, wanted);
        let message = refused("[[wall]]\nmotion = { rotate = { about = [0,0,1], rpm = 1 } }\n");
        assert!(
            message.contains("wall.0.motion.rotate: 'through' is missing") && message.contains("(m)"),
            "{message}"
        );
        let message = refused("[time]\nuntil = 1\nuntil = 2\n");
        assert!(message.starts_with("s.toml:3:1: 'until' is there twice"), "{message}");
    }

    #[test]
    fn later_features_are_refused_by_name() {
        let message = refused("[time]\n[temperature]\nstart = 1");
        assert!(message.contains("not available yet: 'temperature'"), "{message}");
    }
}
