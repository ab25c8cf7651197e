//! Errors of a setup.

use super::{Advice, WALL, floor, out_of_range, pair, states_a_fact};
use crate::advice::explain_setup_error;
use dem::setup::{Clusters, Precision};
use dem::simd::Width;
use dem::*;

fn errors_of_contacts_and_numbers() -> Vec<Advice<SetupError>> {
    let [a, b] = pair();
    vec![
        (SetupError::NoContact { a, b }, &["'glass' and 'steel'", "[[contact]]"]),
        (out_of_range(Subject::TimeStep, "dt", "dt > 0"), &["time.dt: -1.5 m is outside dt > 0"]),
        (SetupError::NoWidth(Width::Avx512), &["Avx512", "Width::available()"]),
        (
            SetupError::PrecisionWithout {
                precision: Precision::Mixed,
                effects: vec!["twisting_resistance"],
                between: pair(),
            },
            &["precision: \"mixed\"", "twisting_resistance (glass–steel)", "leave the key out"],
        ),
    ]
}

fn errors_of_time_steps() -> Vec<Advice<SetupError>> {
    let cause = Box::new(StepCause {
        drag: Some(CriticalDrag { radius: 0.002, relaxation_time: 1e-4 }),
        ..StepCause::default()
    });
    let motion = Box::new(StepCause {
        motion: Some(RepeatedMotion { wall: floor(), period: 2.5 }),
        ..StepCause::default()
    });
    vec![
        (SetupError::StepTooLarge { dt: 0.25, critical: 0.125, cause }, &["time.dt: 2.5000e-1 s", "[drag]"]),
        (
            SetupError::StepAbovePeriod { dt: 0.25, most: 0.125, cause: motion },
            &["time.dt: 2.5000e-1 s", WALL],
        ),
        (SetupError::NoStep, &["time.dt", "give dt in seconds"]),
        (
            SetupError::WallTooFast { wall: floor(), speed: 9.0, dt: 0.5, share: 2.0, limit: 0.25 },
            &[WALL, "9.0000e0 m/s", "200.0 %", "shorten dt"],
        ),
        (
            SetupError::WallSlowerThanSleep { wall: floor(), speed: 1e-3, sleep: 1e-3, most: 5e-4 },
            &["sleep.speed", WALL, "at most 5.0000e-4 m/s"],
        ),
    ]
}

fn errors_of_positions_and_periods() -> Vec<Advice<SetupError>> {
    vec![
        (SetupError::DuplicateId(7), &["particle id 7", "give each particle its own"]),
        (
            SetupError::BehindPlane { id: 7, depth: 0.5, wall: floor() },
            &["particle 7", WALL, "normal points to"],
        ),
        (
            SetupError::TooFar {
                quantity: Box::new(Subject::Particle(7).quantity("position")),
                far: 1e9,
                radius: 1e-3,
            },
            &["particle 7: position", "1.0000e9 m", "shift the scene"],
        ),
        (SetupError::RotatingPlane(floor()), &[WALL, "rotate.about"]),
        (
            SetupError::PeriodTooSmall { axis: 'x', period: 0.01, least: 0.02 },
            &["domain", "along x", "2.0000e-2 m"],
        ),
        (
            SetupError::PeriodBelowSkin { axis: 'x', period: 0.01, skin: 0.02, most: 0.005 },
            &["neighbours.skin: 2.0000e-2 m", "at most 5.0000e-3 m"],
        ),
    ]
}

fn errors_of_inlets_and_outlets() -> Vec<Advice<SetupError>> {
    vec![
        (
            SetupError::DuplicateEntryId { id: 7, time: 0.5 },
            &["inlet: particle id 7, due at 0.5 s", "first_id"],
        ),
        (
            SetupError::EntryLate { id: 7, time: 0.5, now: 0.75 },
            &["inlet: particle 7", "0.5 s", "time order"],
        ),
        (
            SetupError::EntryBehindPlane { id: 7, depth: 0.5, wall: floor() },
            &["inlet: particle 7", WALL, "move"],
        ),
        (SetupError::ZoneTooShort { length: 0.01, diameter: 0.02 }, &["1.0000e-2 m", "at least 2.4000e-2 m"]),
        (
            SetupError::ZoneShorterThanBond { length: 0.01, longest: 0.02 },
            &["zone of 1.0000e-2 m", "2.4000e-2 m", "[[bond]]"],
        ),
        (SetupError::ClumpOutlet("block".to_owned()), &["outlet", "'block'", "[[outlet]]"]),
    ]
}

fn errors_of_bonds_sleep_and_resumes() -> Vec<Advice<SetupError>> {
    vec![
        (SetupError::DragAndSleep, &["drag", "[sleep]", "leave out one of them"]),
        (
            SetupError::LocalDampingWith("particles that sleep"),
            &["local_damping", "sleep", "leave out one of them"],
        ),
        (SetupError::ClumpSleep("block".to_owned()), &["sleep", "'block'", "leave out [sleep]"]),
        (SetupError::BondsAndSleep, &["bond", "[sleep]", "leave out one of them"]),
        (SetupError::BondOfZeroLength { ids: [7, 8] }, &["bond: particles 7 and 8", "move one"]),
        (
            SetupError::BondJoinsNothing { between: pair(), gap: 1e-3, clusters: Clusters::Same },
            &["bond glass–steel", "1.0000e-3 m", "larger gap"],
        ),
        (
            SetupError::OtherState(StateMismatch::Step { asked: 0.5, saved: 0.25 }),
            &["resume", "0.5 s, saved 0.25 s", "scene of the saved run"],
        ),
        (SetupError::StrainedWith("walls"), &["domain.strain", "no walls", "leave out one of them"]),
        (
            SetupError::StrainedOpen { axis: 'y' },
            &["domain.strain: y is not periodic", "set domain.periodic"],
        ),
    ]
}

/// One of each.
fn setup_errors() -> Vec<Advice<SetupError>> {
    [
        errors_of_contacts_and_numbers(),
        errors_of_time_steps(),
        errors_of_positions_and_periods(),
        errors_of_inlets_and_outlets(),
        errors_of_bonds_sleep_and_resumes(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Its number among [`setup_errors`]: a new variant does not compile until it has one.
fn setup_error_number(error: &SetupError) -> usize {
    match error {
        SetupError::NoContact { .. } => 0,
        SetupError::OutOfRange(_) => 1,
        SetupError::NoWidth(_) => 2,
        SetupError::PrecisionWithout { .. } => 3,
        SetupError::StepTooLarge { .. } => 4,
        SetupError::StepAbovePeriod { .. } => 5,
        SetupError::NoStep => 6,
        SetupError::WallTooFast { .. } => 7,
        SetupError::WallSlowerThanSleep { .. } => 8,
        SetupError::DuplicateId(_) => 9,
        SetupError::BehindPlane { .. } => 10,
        SetupError::TooFar { .. } => 11,
        SetupError::RotatingPlane(_) => 12,
        SetupError::PeriodTooSmall { .. } => 13,
        SetupError::PeriodBelowSkin { .. } => 14,
        SetupError::DuplicateEntryId { .. } => 15,
        SetupError::EntryLate { .. } => 16,
        SetupError::EntryBehindPlane { .. } => 17,
        SetupError::ZoneTooShort { .. } => 18,
        SetupError::ZoneShorterThanBond { .. } => 19,
        SetupError::ClumpOutlet(_) => 20,
        SetupError::DragAndSleep => 21,
        SetupError::LocalDampingWith(_) => 22,
        SetupError::ClumpSleep(_) => 23,
        SetupError::BondsAndSleep => 24,
        SetupError::BondOfZeroLength { .. } => 25,
        SetupError::BondJoinsNothing { .. } => 26,
        SetupError::OtherState(_) => 27,
        SetupError::BeltLeavesPlane(_) => 30,
        SetupError::StrainedWith(_) => 28,
        SetupError::StrainedOpen { .. } => 29,
    }
}

#[test]
fn every_setup_error_states_a_fact_and_the_scene_adds_key_and_remedy() {
    for (n, (error, words)) in setup_errors().iter().enumerate() {
        assert_eq!(setup_error_number(error), n);
        states_a_fact(&error.to_string());
        let text = explain_setup_error(error);
        words.iter().for_each(|word| assert!(text.contains(word), "'{word}' not in: {text}"));
    }
}
