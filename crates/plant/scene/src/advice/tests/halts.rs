//! What stops a run.

use super::{Advice, WALL, floor, states_a_fact};
use crate::advice::{Remedy, explain_halt, stop_cause};
use dem::*;
use record::{Guard, StopCause};

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
            &["GPU 0", "the device has failed", "without --device"],
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
        (
            Halt::FreeInWall { time, id, by: insert, wall: "bin".to_owned(), position, overlap: 0.1 },
            &["particle 7", "insert 0", "inside wall 'bin'", "insert.0.shape smaller"],
        ),
        (
            Halt::NoRoom { time, id, by: insert, partner: 9, position },
            &["insert 0 has no room for particle 7", "particle 9", "insert.0.when_blocked = \"wait\""],
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
        Halt::FreeInWall { .. } => 17,
        Halt::NoRoom { .. } => 18,
    }
}

#[test]
fn every_halt_states_a_fact_and_the_scene_adds_key_and_remedy() {
    for (n, (halt, words)) in halts().iter().enumerate() {
        assert_eq!(halt_number(halt), n);
        states_a_fact(&halt.to_string());
        let text = explain_halt(halt);
        words.iter().for_each(|word| assert!(text.contains(word), "'{word}' not in: {text}"));
        assert!(text.contains("t = 5.000000e-1 s"), "{text}");
    }
}

/// A guard that a key widens is named by that key.
#[test]
fn the_guard_of_a_halt_is_the_one_that_its_remedies_name() {
    for (halt, _) in halts() {
        let remedies = Remedy::of(&halt);
        for (remedy, guard) in [
            (Remedy::RaiseOverlap, Guard::Overlap),
            (Remedy::RaiseMotion, Guard::Motion),
            (Remedy::RaiseEnergy, Guard::Energy),
            (Remedy::AllowReturned, Guard::Zones),
        ] {
            let is_this = stop_cause(&halt) == StopCause::Guard { guard };
            assert_eq!(is_this, remedies.contains(&remedy), "{halt}");
        }
        let is_device = matches!(halt, Halt::Device { .. });
        assert_eq!(stop_cause(&halt) == StopCause::Device, is_device, "{halt}");
    }
}

/// Every stop has a remedy, and no two remedies have the same sentence.
#[test]
fn every_halt_has_remedies_and_each_of_these_its_own_sentence() {
    for (halt, _) in halts() {
        assert!(!Remedy::of(&halt).is_empty(), "{halt}");
    }
    let mut texts: Vec<String> = Remedy::ALL.iter().map(|remedy| remedy.text(3, " (E)")).collect();
    texts.sort_unstable();
    texts.dedup();
    assert_eq!(texts.len(), Remedy::ALL.len());
    let insert = [Remedy::InsertShape, Remedy::InsertUntil, Remedy::InsertRate];
    assert!(insert.iter().all(|remedy| remedy.text(3, "").contains("insert.3.")));
    assert!(texts.iter().all(|text| !text.contains(['{', '}'])), "{texts:?}");
}
