//! Findings in plain words, as a table, and as CSV.

use crate::fit::next::Next;
use crate::recipe::shown;
use crate::report::explained::COLUMNS;
use crate::report::fitness::StepFit;
use crate::report::judge::{Finding, Judged, Pair};
use crate::session::duration;
use geom::Shown;
use std::fmt::Write as _;

/// That nothing fits, and what is nearest: of the last step, which all findings lead to.
pub fn headline(judged: &Judged) -> Option<String> {
    let s = judged.steps.last().filter(|s| !s.fits)?;
    let trials = geom::counted(s.trials, "trial");
    let all = if s.simulated.is_some() { format!("{trials} and the best point") } else { trials };
    let nearest = s.nearest.as_ref().map_or(String::new(), |n| {
        let which = n.trial.map_or("the best point".to_owned(), |number| format!("trial {number}"));
        let values: Vec<String> =
            n.parameters.iter().map(|(name, v, unit)| format!("{name} = {}", amount(*v, unit))).collect();
        format!("; the nearest is {which} ({}): square of misfit {}", values.join(", "), square(n.misfit))
    });
    Some(format!(
        "nothing fits: of {all}, none reproduces the data{nearest}, and {} at most is scatter",
        square(s.most)
    ))
}

/// A share in percent.
fn percent(share: f64) -> String {
    amount((100.0 * share).round(), "")
}

/// A square of a misfit.
fn square(value: f64) -> String {
    amount(value, "")
}

/// The table of parameters: CSV; that nothing fits is a line before it.
pub fn csv(judged: &Judged) -> String {
    let mut text = headline(judged).map_or(String::new(), |line| format!("# {line}\n"));
    text += &COLUMNS.map(|c| c.name).join(",");
    text += "\n";
    for f in &judged.findings {
        let s = judged.steps.iter().find(|s| s.step == f.step);
        let misfit = |of: &dyn Fn(&StepFit) -> Option<f64>| {
            s.and_then(of).map_or(String::new(), |v| Shown(v).to_string())
        };
        let cells = [f.value, f.low, f.high, f.best, f.prior[0], f.prior[1]].map(shown).join(",");
        let (name, unit, step) = (&f.parameter, &f.unit, crate::session::cell(&f.step));
        let _ = writeln!(
            text,
            "{name},{unit},{cells},{:.4},{:.4},{},{step},{},{},{},{}",
            f.width,
            f.influence,
            f.determined,
            misfit(&|s| Some(s.misfit)),
            misfit(&|s| s.simulated),
            misfit(&|s| Some(s.free)),
            s.is_some_and(|s| s.fits)
        );
    }
    text
}

fn amount(value: f64, unit: &str) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if unit.is_empty() { Shown(rounded).to_string() } else { format!("{} {unit}", Shown(rounded)) }
}

fn sentence(f: &Finding, interval: f64) -> String {
    let content = Shown(100.0 * interval);
    let range = format!("{} to {}", amount(f.low, &f.unit), amount(f.high, &f.unit));
    if f.determined {
        return format!("{}: {} ({content} %: {range})", f.parameter, amount(f.value, &f.unit));
    }
    format!(
        "{}: the data do not determine it: {content} % from {range}, as before the tests; total sensitivity {:.3}",
        f.parameter, f.influence
    )
}

fn traded(pair: &Pair) -> String {
    let [a, b] = &pair.parameters;
    let [one, other] = pair.ends.map(|e| e.map(|v| amount(v, "")));
    format!(
        "the data do not separate {a} and {b} (rank correlation {:.2}): by the emulator {a} = {} with {b} = {} fits as well as {a} = {} with {b} = {}",
        pair.correlation, one[0], one[1], other[0], other[1]
    )
}

/// What was promised of the best point, and what a run shows.
fn misfits(s: &StepFit) -> String {
    let run = match (s.simulated, &s.no_result) {
        (Some(simulated), _) => format!("{} simulated", square(simulated)),
        (None, Some(_)) => "no result of its run".to_owned(),
        (None, None) => "not simulated".to_owned(),
    };
    format!(
        "step '{}': square of misfit of the best point: {} predicted, {run}; {} expected of the true parameters, {} at most",
        s.step,
        square(s.misfit),
        square(s.free),
        square(s.most)
    )
}

/// A run of the best point that is not what was predicted, and too few trials to predict it.
fn doubts(s: &StepFit) -> Vec<String> {
    let mut lines = Vec::new();
    let instead = s.best_is_trial.zip(s.nearest.as_ref()).map_or(String::new(), |(number, n)| {
        format!("; trial {number} is nearer ({}) and stands as best", square(n.misfit))
    });
    if let Some(why) = &s.no_result {
        lines.push(format!("step '{}': the best point has no result: {why}{instead}", s.step));
    }
    if let Some(simulated) = s.simulated.filter(|_| s.surprise) {
        lines.push(format!(
            "step '{}': the best point is not what the emulator says: square of misfit {} predicted, {} simulated{instead}: give more trials",
            s.step,
            square(s.misfit),
            square(simulated)
        ));
    }
    if s.too_few() {
        let start = if s.is_short() { " (10 a parameter are a start)" } else { "" };
        lines.push(format!(
            "step '{}': too few trials: a trial that is left out is missed by {} % of what all trials spread, and where the parameters may lie the emulator deviates \
             {} times as much as the data: intervals are those of the emulator; {} for {}: give more{start}",
            s.step,
            percent(s.unseen),
            amount(s.doubt, ""),
            geom::counted(s.trials, "trial"),
            geom::counted(s.parameters, "parameter")
        ));
    }
    lines
}

/// Sentences for people: each parameter, each pair, the fit, the cost.
pub fn sentences(judged: &Judged) -> Vec<String> {
    let mut lines: Vec<String> = judged.findings.iter().map(|f| sentence(f, judged.interval)).collect();
    lines.extend(judged.pairs.iter().map(traded));
    for s in judged.steps.iter().filter(|s| s.early) {
        lines.push(format!(
            "step '{}' ended after {} trials: more would change less than the scatter of the data",
            s.step, s.trials
        ));
    }
    lines.extend(judged.steps.iter().map(misfits));
    let [done, stopped, failed, abandoned] = judged.trials;
    let others = [(stopped, "stopped by guards"), (failed, "failed"), (abandoned, "abandoned")];
    let others: String = others.iter().filter(|o| o.0 > 0).map(|o| format!(", {} {}", o.0, o.1)).collect();
    lines.push(format!(
        "{done} trials done{others}; {} of processor and waiting time in runs",
        duration(judged.seconds)
    ));
    lines
}

/// Warnings: what makes the intervals doubtful.
pub fn warnings(judged: &Judged) -> Vec<String> {
    let mut lines = Vec::new();
    if let (count, Some(first)) = &judged.cut {
        lines.push(format!(
            "{} measured on runs that were stopped, such as: {first}: join the programs of the command by && so that such trials count as stopped",
            geom::counted_as(*count, "trial", ["is", "are"])
        ));
    }
    lines.extend(judged.steps.iter().flat_map(doubts));
    for s in judged.steps.iter().filter(|s| s.widened > 1.0) {
        let at_bound = judged.findings.iter().filter(|f| f.step == s.step && f.at_bound);
        let at_bound: Vec<String> =
            at_bound.map(|f| format!("{} = {}", f.parameter, amount(f.best, &f.unit))).collect();
        let cure = if s.too_few() {
            "give more trials before you change bounds".to_owned()
        } else if at_bound.is_empty() {
            "a discrepancy in [[test]] says what the model cannot reproduce".to_owned()
        } else {
            format!("the best fit is at the end of the bounds ({}): widen them", at_bound.join(", "))
        };
        let none = if s.fits { "the emulator finds no parameters that" } else { "no parameters" };
        lines.push(format!(
            "step '{}': {none} reproduce the data within their deviations (square of misfit {}, expected {}): the intervals take the deviations {} times as wide; {cure}",
            s.step,
            square(s.misfit),
            square(s.free),
            amount(s.widened, "")
        ));
    }
    for s in judged.steps.iter().filter(|s| s.held_by_priors) {
        lines.push(format!(
            "step '{}': the priors hold the parameters away from values that fit the data (square of misfit {}, expected {}): widen the priors that you are not sure of",
            s.step,
            square(s.misfit),
            square(s.free)
        ));
    }
    for s in judged.unmixed() {
        lines.push(format!("step '{}': the chains have not mixed (ratio {:.2}): the posterior may have several peaks: look at the samples", s.step, s.chains));
    }
    let sure = |f: &&Finding| !judged.steps.iter().any(|s| s.step == f.step && s.too_few());
    for f in judged.findings.iter().filter(|f| f.determined).filter(sure) {
        // Of bounds alone the interval of the prior ends before them: what is pressed against a bound lies beyond it.
        let near = 0.02 * (f.prior[1] - f.prior[0]);
        if f.low <= f.prior[0] + near || f.high >= f.prior[1] - near {
            lines.push(format!("{}: its interval reaches the end of its prior: the data may want values beyond: widen its bounds", f.parameter));
        }
    }
    lines
}

/// The table of parameters: Markdown.
pub fn markdown(judged: &Judged) -> String {
    let content = Shown(100.0 * judged.interval);
    let mut text = format!(
        "| parameter | value | {content} % interval | before | total sensitivity |\n|---|---|---|---|---|\n"
    );
    for f in &judged.findings {
        let range = |a: f64, b: f64| format!("{} to {}", amount(a, ""), amount(b, &f.unit));
        let value = if f.determined { amount(f.value, &f.unit) } else { "not determined".to_owned() };
        let _ = writeln!(
            text,
            "| {} | {value} | {} | {} | {:.2} |",
            f.parameter,
            range(f.low, f.high),
            range(f.prior[0], f.prior[1]),
            f.influence
        );
    }
    let list: String =
        judged.pairs.iter().map(traded).chain(warnings(judged)).map(|l| format!("- {l}\n")).collect();
    let text = headline(judged).map_or(String::new(), |line| format!("**{line}**\n\n")) + &text;
    let text = format!("{text}\n{}", fits(judged));
    if list.is_empty() { text } else { format!("{text}\n{list}") }
}

/// The table of steps: what was predicted of the best point, and what its run shows.
fn fits(judged: &Judged) -> String {
    let mut text = "| step | trials | square of misfit, predicted | simulated | expected of the true parameters | at most | left out, missed by |\n\
        |---|---|---|---|---|---|---|\n"
        .to_owned();
    for s in &judged.steps {
        let simulated = s.simulated.map_or_else(|| "–".to_owned(), square);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {simulated} | {} | {} | {} % |",
            s.step,
            s.trials,
            square(s.misfit),
            square(s.free),
            square(s.most),
            percent(s.unseen)
        );
    }
    text
}

/// Tests by what they would tell: CSV.
pub fn design_csv(next: &[Next]) -> String {
    let Some(first) = next.first() else { return "test,again,gain\n".to_owned() };
    let mut text = format!("test,again,gain,{}\n", first.parameters.join(","));
    for n in next {
        let ratios: Vec<String> = n.ratios.iter().map(|r| format!("{r:.3}")).collect();
        let _ = writeln!(
            text,
            "{},{},{:.3},{}",
            crate::session::cell(&n.test),
            n.again,
            n.gain,
            ratios.join(",")
        );
    }
    text
}

/// The most telling test in a sentence.
pub fn design_sentence(next: &[Next]) -> Option<String> {
    let n = next.first()?;
    let what = if n.again {
        format!("one more specimen of test '{}'", n.test)
    } else {
        format!("test '{}'", n.test)
    };
    let most = n.parameters.iter().zip(&n.ratios).min_by(|a, b| a.1.total_cmp(b.1))?;
    if n.gain < 0.02 {
        return Some(
            "no test of the recipe would tell much more: every interval would stay as it is".to_owned(),
        );
    }
    Some(format!(
        "the most telling next test: {what}: the interval of {} would become {:.2} times as wide",
        most.0, most.1
    ))
}
