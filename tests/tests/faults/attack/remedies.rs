//! What messages say to do is done: each key and each option with letters wrong, and the name that the message proposes instead.

use super::Findings;
use super::case::{Outcome, Verdict, bounded, write};
use super::options::{Call, calls, flags};
use super::scenes;
use rayon::prelude::*;

/// Words that are typed in place of a word: a letter less, two exchanged, one twice, a hyphen for an underscore.
fn misspelt(word: &str) -> Vec<String> {
    let letters: Vec<char> = word.chars().collect();
    let mut all = Vec::new();
    for k in 0..letters.len() {
        let less: String = letters.iter().enumerate().filter(|(n, _)| *n != k).map(|(_, c)| c).collect();
        let twice: String =
            letters.iter().enumerate().flat_map(|(n, c)| vec![*c; 1 + usize::from(n == k)]).collect();
        all.extend([less, twice]);
        if k + 1 < letters.len() {
            let mut other = letters.clone();
            other.swap(k, k + 1);
            all.push(other.into_iter().collect());
        }
    }
    all.push(word.replace('_', "-"));
    all.sort();
    all.dedup();
    all.retain(|other| other != word && !other.is_empty() && !other.starts_with('-') && !other.contains('.'));
    all
}

/// What stands between two texts.
fn between<'a>(text: &'a str, before: &str, after: char) -> Option<&'a str> {
    text.split_once(before)?.1.split(after).next()
}

/// Calls with a wrong word, what proposes the right one, and the call with that word; one in so many.
pub fn run(one_in: usize, found: &mut Findings) {
    let scene = scenes::file();
    let keys = scenes::keys();
    let wrong = keys.iter().flat_map(|key| {
        let (table, word) = key.rsplit_once('.').map_or(("", key.as_str()), |(table, word)| (table, word));
        let path =
            move |word: &str| if table.is_empty() { word.to_owned() } else { format!("{table}.{word}") };
        misspelt(word).into_iter().map(move |other| (path(word), path(&other), table.to_owned()))
    });
    let wrong: Vec<(String, String, String)> =
        wrong.filter(|w| !keys.contains(&w.1)).step_by(one_in).collect();
    let verdicts = wrong.into_par_iter().map(|(_, other, table)| key(&scene, &other, &table)).collect();
    found.all("printed remedies: keys", verdicts);
    let calls = calls();
    let mut wrong: Vec<(&Call, String)> = Vec::new();
    let mut seen = Vec::new();
    for call in &calls {
        if seen.contains(&call.tool) {
            continue;
        }
        seen.push(call.tool);
        let known: Vec<String> = flags(call.tool).into_iter().map(|flag| flag.name).collect();
        let own = known.iter().flat_map(|name| misspelt(name.trim_start_matches('-')));
        let others = own.map(|word| format!("--{word}")).filter(|other| !known.contains(other));
        wrong.extend(others.map(|other| (call, other)));
    }
    let verdicts = wrong.into_par_iter().step_by(one_in).map(|(call, other)| option(call, &other)).collect();
    found.all("printed remedies: options", verdicts);
}

fn key(scene: &(String, Vec<u8>), other: &str, table: &str) -> (String, Verdict) {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), std::slice::from_ref(scene));
    let set = |key: &str| {
        let args = [&scene.0, "--check", "--set", &format!("{key}=1")].map(str::to_owned);
        bounded(folder.path(), "", None, "dem-run", &args)
    };
    let (status, said) = set(other);
    let name = format!("dem-run {} --check --set {other}=1", scene.0);
    let outcome = match (status.and_then(|s| s.code()), between(&said, "did you mean '", '\'')) {
        (Some(0), _) => Outcome::Silent,
        (Some(1 | 2), None) if said.trim().is_empty() => Outcome::Mute,
        (Some(1 | 2), None) => Outcome::Refused,
        (Some(1 | 2), Some(word)) => {
            let whole = if table.is_empty() { word.to_owned() } else { format!("{table}.{word}") };
            // It may be a key of the table, or name its table itself.
            let fits = |key: &str| !set(key).1.contains("unknown key");
            if fits(&whole) || fits(word) { Outcome::Accepted } else { Outcome::NoRemedy }
        }
        _ => Outcome::Panicked,
    };
    (name, Verdict::new(outcome, &said))
}

fn option(call: &Call, other: &str) -> (String, Verdict) {
    let folder = tempfile::tempdir().expect("a folder");
    let said = |option: &str| bounded(folder.path(), "", None, call.tool, &[option.to_owned()]);
    let (status, first) = said(other);
    let outcome = match (status.and_then(|s| s.code()), between(&first, "a similar argument exists: '", '\''))
    {
        (Some(1 | 2), None) if first.trim().is_empty() => Outcome::Mute,
        (Some(1 | 2), None) => Outcome::Refused,
        (Some(1 | 2), Some(word)) if !said(word).1.contains(&format!("unexpected argument '{word}'")) => {
            Outcome::Accepted
        }
        (Some(1 | 2), Some(_)) => Outcome::NoRemedy,
        (Some(0), _) => Outcome::Silent,
        _ => Outcome::Panicked,
    };
    (format!("{} {other}", call.tool), Verdict::new(outcome, &first))
}
