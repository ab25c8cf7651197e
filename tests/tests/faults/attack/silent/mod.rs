//! Silent options and keys: what is added to a call that works must change the output, print a warning, or be refused with a reason.
//!
//! Each case is a call that works and one more option ([`options`]) or key of a scene, in all values that the examples give it.
//! It is silent if some value is accepted and none of them changes anything.

mod answer;
mod call;

pub mod keys;
pub mod options;

use super::Findings;
use super::case::{Outcome, Verdict};
use answer::{Answer, Shop};
use call::Call;
use rayon::prelude::*;

/// A call that works, and calls with one thing more.
struct Trial {
    group: &'static str,
    /// What is added, as the page of findings names it.
    added: String,
    base: Call,
    more: Vec<Call>,
}

/// A part of the cases: `options` or `keys`; both without a name. `only`: these tools, or these options, also where they may change nothing.
pub fn find(part: Option<&str>, one_in: usize, only: &[&str], found: &mut Findings) {
    if part != Some("keys") {
        options::find(one_in, only, found);
    }
    if part != Some("options") {
        keys::find(one_in, found);
    }
}

/// Runs calls that work and what is added to them. A call that does nothing, or whose output holds times, cannot show anything and is left out.
fn run(shop: &Shop, trials: Vec<Trial>, found: &mut Findings) {
    let mut bases: Vec<Call> = trials.iter().map(|t| t.base.clone()).collect();
    bases.dedup();
    let answers: Vec<Option<Answer>> = bases.par_iter().map(|base| stable(shop, base)).collect();
    let base_of = |call: &Call| bases.iter().position(|b| b == call).and_then(|k| answers[k].as_ref());
    let judged = |trial: &Trial| base_of(&trial.base).and_then(|base| judge(shop, trial, base));
    let verdicts: Vec<Option<(String, Verdict)>> = trials.par_iter().map(judged).collect();
    for (trial, verdict) in trials.iter().zip(verdicts) {
        if let Some((name, verdict)) = verdict {
            found.add(trial.group, name, verdict);
        }
    }
}

/// What a call answers, if it does the same again. None also of one that fails: it reads a file that a later example has replaced.
fn stable(shop: &Shop, call: &Call) -> Option<Answer> {
    let first = shop.answer(call);
    if first.code != 0 || NOTHING_DONE.iter().any(|words| first.told.contains(words)) {
        return None;
    }
    let again = shop.answer(call);
    (first.output == again.output && first.told == again.told).then_some(first)
}

/// What `cloud-fill` says of a cloud without holes, and `stone-pack` where no stone finds room.
const NOTHING_DONE: [&str; 2] = ["0 points added in 0 holes", "stone-pack: 0 stones"];

fn judge(shop: &Shop, trial: &Trial, base: &Answer) -> Option<(String, Verdict)> {
    let answers: Vec<(&Call, Answer)> = trial.more.iter().map(|call| (call, shop.answer(call))).collect();
    let silent = |a: &Answer| a.code == 0 && a.output == base.output && a.told == base.told;
    let refused = |a: &Answer| a.code != 0;
    let acts = answers.iter().any(|(_, a)| !silent(a) && !refused(a));
    let found = answers.iter().find(|(_, a)| silent(a) && !acts);
    let outcome = match (found, answers.iter().any(|(_, a)| refused(a))) {
        (Some(_), _) => Outcome::Silent,
        (None, true) if !acts => Outcome::Refused,
        _ => Outcome::Accepted,
    };
    let (call, answer) = found.or(answers.first())?;
    let message = answer.told.lines().next().unwrap_or_default().to_owned();
    Some((format!("{}: {call}", trial.added), Verdict { outcome, message }))
}
