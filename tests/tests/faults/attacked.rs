//! The attack in short, with another seed than the page's.

use crate::attack::{
    Findings, caches, files, kills, limits, modes, names, options, remedies, scenes, signals, silent,
};

/// One case in this many of those that are not drawn.
const ONE_IN: usize = 12;

#[test]
fn no_attack_ends_in_a_panic_without_bound_or_with_output_that_only_looks_whole() {
    let mut found = Findings::default();
    found.run(files::cases(20, 500));
    found.run(scenes::cases().into_iter().step_by(ONE_IN + 1).collect());
    found.run(options::cases().into_iter().step_by(ONE_IN + 1).collect());
    found.run(limits::cases().into_iter().step_by(ONE_IN + 1).collect());
    kills::run(20, 4, &mut found);
    assert!(found.count() > 700, "only {} cases", found.count());
    assert!(found.bad.is_empty(), "{}\n{}", found.table(), found.list());
}

#[test]
fn no_name_signal_mode_change_or_remedy_is_bad() {
    let mut found = Findings::default();
    names::run(ONE_IN, &mut found);
    signals::run(20, 2, &mut found);
    modes::run(ONE_IN, &mut found);
    remedies::run(20 * ONE_IN, &mut found);
    caches::run(20, 2, &mut found);
    assert!(found.count() > 150, "only {} cases", found.count());
    assert!(found.bad.is_empty(), "{}\n{}", found.table(), found.list());
}

/// One further option in so many: a full run takes as long as all other attacks.
const FURTHER: usize = 29;

#[test]
fn no_further_option_or_key_is_silent() {
    let mut found = Findings::default();
    silent::find(None, FURTHER, &[], &mut found);
    assert!(found.count() > 50, "only {} cases", found.count());
    assert!(found.bad.is_empty(), "{}\n{}", found.table(), found.list());
}
