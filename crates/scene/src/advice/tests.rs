//! Every error of the engine: its own text states a fact; the scene's adds the key and the remedy.

use super::{Remedy, explain_halt, explain_setup_error};
use dem::setup::{Clusters, Precision};
use dem::simd::Width;
use dem::*;

const WALL: &str = "wall 'floor'";

fn pair() -> [String; 2] {
    ["glass".to_owned(), "steel".to_owned()]
}

fn floor() -> String {
    "floor".to_owned()
}

fn out_of_range(of: Subject, name: &'static str, allowed: impl Into<Allowed>) -> SetupError {
    let quantity = of.quantity(name);
    SetupError::OutOfRange(Box::new(OutOfRange { quantity, value: -1.5, unit: "m", allowed: allowed.into() }))
}

/// An error and words that the scene's message must have.
type Advice<E> = (E, &'static [&'static str]);

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

fn halts() -> Vec<Advice<Halt>> {
    let (time, id, inlet, share, limit) = (0.5, 7, 1, 0.5, 0.25);
    let position = geom::Vec3::new(1.0, 2.0, 3.0);
    let (by, insert) = (Entrance::Inlet(1), Entrance::Insert(0));
    let wall = || Partner::Wall(floor());
    let stiffer =
        Stiffer { speed: 3.0, key: "young", of: "glass".to_owned(), value: 2e7, most: 5e7, unit: "Pa" };
    let stiffer = Some(Box::new(stiffer));
    vec![
        (
            Halt::Overlap { time, id, partner: wall(), position, overlap: 0.1, share, limit, stiffer },
            &[
                "particle 7",
                WALL,
                "50.0 %",
                "(young of glass ≥ 2.00e7 Pa for an approach at 3.000e0 m/s, 5.00e7 Pa for the hardest impact of grains near it)",
            ],
        ),
        (
            Halt::InletOverlap { time, id, by, partner: wall(), position, overlap: 0.1, share, limit },
            &["particle 7", "inlet 1", "--ahead", "raise guards.overlap"],
        ),
        (Halt::Motion { time, id, position, motion: 0.1, share, limit }, &["particle 7", "guards.motion"]),
        (Halt::NotANumber { time, id, position }, &["particle 7", "shorten time.dt"]),
        (Halt::WallNotANumber { time, wall: floor(), push: 8.0 }, &[WALL, "8e0 N", "shorten time.dt"]),
        (
            Halt::WallPastAll { time, wall: floor(), shift: 0.5 },
            &[WALL, "5.0000e-1 m", "wall.servo.direction"],
        ),
        (
            Halt::WallTooFast { time, wall: floor(), speed: 9.0, limit: 1.0 },
            &[WALL, "9.0000e0 m/s", "wall.spring.speed_limit"],
        ),
        (
            Halt::WallTooLight { time, wall: floor(), mass: 0.1, contacts: 3, least: 0.2 },
            &[WALL, "3 contacts", "2.0000e-1 kg", "wall.spring.mass"],
        ),
        (Halt::NotKept { time }, &["not recorded", "record_wrenches"]),
        (Halt::CameBack { time, id, inlet, position, behind: 0.1 }, &["particle 7", "guards.zones"]),
        (
            Halt::TooFast { time, id, by, speed: 9.0, dt: 0.1, share, limit },
            &["9.0000e0 m/s", "guards.motion"],
        ),
        (Halt::Energy { time, made: 1.0, of: 2.0, limit }, &["50.00 %", "guards.energy"]),
        (
            Halt::BondsTooStiff {
                time,
                dt: 0.1,
                critical: 0.01,
                particle: BondedParticle { id, material: "rock".to_owned(), radius: 0.1 },
            },
            &["particle 7 (rock", "1.0000e-2 s", "smaller time.safety"],
        ),
        (
            Halt::Bonds { time, error: Box::new(SetupError::BondOfZeroLength { ids: [7, 8] }) },
            &["particles 7 and 8", "move one"],
        ),
        (
            Halt::CellTooSmall { time, axis: 'x', length: 0.04, least: 0.05 },
            &["4.0000e-2 m long along x", "5.0000e-2 m", "larger domain"],
        ),
        (
            Halt::Device { time, what: "GPU 0: out of memory".to_owned() },
            &["GPU 0", super::DEVICE_FAILED, "without --device"],
        ),
        (
            Halt::InletOverlap {
                time,
                id,
                by: insert,
                partner: wall(),
                position,
                overlap: 0.1,
                share,
                limit,
            },
            &["particle 7", "insert 0", "insert.0.rate", "raise guards.overlap"],
        ),
    ]
}

fn halt_number(halt: &Halt) -> usize {
    match halt {
        Halt::Overlap { .. } => 0,
        Halt::InletOverlap { by: Entrance::Inlet(_), .. } => 1,
        Halt::InletOverlap { by: Entrance::Insert(_), .. } => 16,
        Halt::Motion { .. } => 2,
        Halt::NotANumber { .. } => 3,
        Halt::WallNotANumber { .. } => 4,
        Halt::WallPastAll { .. } => 5,
        Halt::WallTooFast { .. } => 6,
        Halt::WallTooLight { .. } => 7,
        Halt::NotKept { .. } => 8,
        Halt::CameBack { .. } => 9,
        Halt::TooFast { .. } => 10,
        Halt::Energy { .. } => 11,
        Halt::BondsTooStiff { .. } => 12,
        Halt::Bonds { .. } => 13,
        Halt::CellTooSmall { .. } => 14,
        Halt::Device { .. } => 15,
    }
}

/// The engine knows no file of the user: no table, no dotted key, no option, no remedy.
fn states_a_fact(text: &str) {
    for word in
        ["[[", "[sleep", "[drag", "time.", "guards.", "neighbours.", "dt =", "--", "shorten", "give ", "use "]
    {
        assert!(!text.contains(word), "'{word}' in: {text}");
    }
}

#[test]
fn every_error_states_a_fact_and_the_scene_adds_key_and_remedy() {
    for (n, (error, words)) in setup_errors().iter().enumerate() {
        assert_eq!(setup_error_number(error), n);
        states_a_fact(&error.to_string());
        let text = explain_setup_error(error);
        words.iter().for_each(|word| assert!(text.contains(word), "'{word}' not in: {text}"));
    }
    for (n, (halt, words)) in halts().iter().enumerate() {
        assert_eq!(halt_number(halt), n);
        states_a_fact(&halt.to_string());
        let text = explain_halt(halt);
        words.iter().for_each(|word| assert!(text.contains(word), "'{word}' not in: {text}"));
        assert!(text.contains("t = 5.000000e-1 s"), "{text}");
    }
}

/// Numbers outside their range: their keys as scenes have them.
#[test]
fn numbers_outside_their_range_have_the_keys_of_scenes() {
    let cases = [
        (Subject::Setup, "gravity", "gravity: -1.5 m"),
        (Subject::Guards, "overlap", "guards.overlap: -1.5 m"),
        (Subject::NeighbourLists, "skin", "neighbours.skin: "),
        (Subject::Drag, "viscosity", "drag.viscosity: "),
        (Subject::Sleep, "speed", "sleep.speed: "),
        (Subject::Sleep, "gravity", "gravity, with [sleep]: "),
        (Subject::Precision(Precision::Mixed), "radius", "precision \"mixed\": radius: "),
        (Subject::Material("glass".to_owned()), "young", "material 'glass': young: "),
        (Subject::Contact(Some(pair())), "restitution", "contact glass–steel: restitution: "),
        (Subject::Bond(None), "between", "bond: between: "),
        (Subject::Particle(7), "radius", "particle 7: radius: "),
        (Subject::PeriodicEnd("low"), "x", "domain low: x: "),
        (Subject::Entry(7), "radius", "inlet: radius of particle 7: "),
        (Subject::Entry(7), "inlet", "inlet of particle 7: "),
        (Subject::EntryClump(7), "shape", "inlet: clump 7: "),
        (Subject::Path(7), "time", "inlet: path of particle 7: time: "),
        (Subject::Wall(floor()), "speed", "wall 'floor': speed: "),
    ];
    for (of, name, key) in cases {
        let text = explain_setup_error(&out_of_range(of, name, "numbers above 0"));
        assert!(text.starts_with(key) && text.contains("is outside numbers above 0"), "{text}");
    }
    let text =
        explain_setup_error(&out_of_range(Subject::Wall(floor()), "material", Allowed::IndexOf("materials")));
    assert!(text.ends_with("the scene's materials"), "{text}");
}

/// Every remedy is listed once.
#[test]
fn all_remedies_are_listed() {
    let numbers: Vec<usize> = Remedy::ALL.iter().map(|remedy| *remedy as usize).collect();
    assert_eq!(numbers, (0..=Remedy::MoveOne as usize).collect::<Vec<_>>());
    for (halt, _) in halts() {
        assert!(!Remedy::of(&halt).is_empty(), "{halt}");
    }
}
