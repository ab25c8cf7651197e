use super::*;
use crate::grading;
use crate::stone::tests::ball;
use geom::mesh::cuboid;

/// Grains of 1 g on a lattice 10 mm apart in a box of 0.2 m: 1000 kg/m³ in bulk.
fn soil() -> Soil {
    let at = |k: u32| f64::from(k) * 0.01 + 0.005;
    let centres = (0..8000).map(|k| Vec3::new(at(k % 20), at(k / 20 % 20), at(k / 400))).collect();
    Soil { centres, masses: vec![1e-3; 8000] }
}

fn settings() -> PackSettings {
    PackSettings {
        content: 0.3,
        tolerance: 0.01,
        density: 2000.0,
        bounds: [Vec3::zeros(), Vec3::repeat(0.2)],
        tries: 10_000,
        rounds: 0,
        least_grains: 2,
        seed: 3,
    }
}

fn library() -> Library {
    let block = cuboid(Vec3::zeros(), Vec3::new(0.05, 0.04, 0.03));
    Library::new(vec![("rock_1_1".into(), block), ("rock_2_1".into(), ball(0.015, 2))], false).unwrap()
}

const GRADING: &str = "from,to,share\n0.03,0.05,0.6\n0.02,0.03,0.4\n";

fn packed(settings: &PackSettings) -> Packing {
    let library = library();
    pack(&library, &grading::read(GRADING, &library).unwrap(), &soil(), settings, |_| {}).unwrap()
}

/// Masses, grains and places of a packing that has reached its content.
fn check(found: &Packing, settings: &PackSettings) {
    let (library, soil) = (library(), soil());
    assert!((found.content / settings.content - 1.0).abs() <= settings.tolerance, "{}", found.content);
    for class in &found.classes {
        assert!((class.share / class.share_wanted - 1.0).abs() < 0.02 && class.missed.is_none(), "{class:?}");
    }
    // Masses as a count of grains gives them.
    let left = found.clusters.iter().filter(|c| **c == 0).count() as f64 * 1e-3;
    let volume: f64 = found.placed.iter().map(|p| p.volume(&library.stones[p.stone])).sum();
    assert!((found.mass - left - 2000.0 * volume).abs() < 1e-9);
    // Each grain inside a stone is of its cluster, and of none otherwise.
    for (grain, p) in soil.centres.iter().enumerate() {
        let holds = |(_, s): &(usize, &PlacedStone)| s.contains(&library.stones[s.stone], p);
        let inside: Vec<u32> =
            found.placed.iter().enumerate().filter(holds).map(|(k, _)| k as u32 + 1).collect();
        assert_eq!(inside, [found.clusters[grain]].into_iter().filter(|c| *c > 0).collect::<Vec<_>>());
    }
    // All in the box, none over another.
    for (k, a) in found.placed.iter().enumerate() {
        assert!((0..3).all(|c| a.bounds[0][c] >= -1e-12 && a.bounds[1][c] <= 0.2 + 1e-12));
        let of = |p: &PlacedStone| p.stone;
        let over = |b: &PlacedStone| a.overlaps(&library.stones[of(a)], b, &library.stones[of(b)]);
        assert!(!found.placed[..k].iter().any(over), "{k}");
        let sieve = library.stones[a.stone].shape.sieve_size * a.scale;
        let range = [(0.03, 0.05), (0.02, 0.03)][a.class];
        assert!(sieve >= range.0 * (1.0 - 1e-9) && sieve <= range.1 * (1.0 + 1e-9), "{sieve} {range:?}");
    }
}

#[test]
fn content_and_shares_are_reached_and_no_grain_is_in_two_stones() {
    let found = packed(&settings());
    check(&found, &settings());
    assert!(found.classes.iter().all(|class| class.crowded == 0));
}

#[test]
fn room_is_made_where_random_places_are_all_taken() {
    let full = PackSettings { content: 0.55, tries: 2000, ..settings() };
    let without = packed(&full);
    assert!(without.content < 0.5, "{}", without.content);
    let crowded = PackSettings { rounds: 200, ..full };
    let found = packed(&crowded);
    check(&found, &crowded);
    assert!(found.classes.iter().map(|class| class.crowded).sum::<usize>() > 10, "{:?}", found.classes);
    // No room for as much as the box holds.
    let most = packed(&PackSettings { content: 0.9, rounds: 5, ..full });
    let words = most.classes.iter().find_map(|class| class.missed.clone()).expect("not reached");
    assert!(words.contains("no room could be made") && most.content < 0.9, "{words}");
}

#[test]
fn the_same_seed_gives_the_same_stones_and_another_seed_others() {
    let places = |seed| {
        packed(&PackSettings { seed, ..settings() }).placed.iter().map(|p| p.centre).collect::<Vec<_>>()
    };
    let first = places(1);
    assert_eq!(first, places(1));
    assert_ne!(first, places(2));
}

#[test]
fn a_content_that_cannot_be_reached_is_reported_with_its_cause() {
    let full = packed(&PackSettings { content: 0.9, tries: 500, ..settings() });
    let words = full.classes[0].missed.clone().expect("not reached");
    assert!(words.contains("overlapped an earlier stone"), "{words}");
    assert!(full.classes[0].tries == 500 && full.classes[0].excess < -0.01);
    // Stones at their own size, of which one is a tenth of what is wanted.
    let library = library();
    let classes = grading::whole(&library);
    let few = PackSettings { content: 0.02, tolerance: 1e-3, tries: 300, ..settings() };
    let found = pack(&library, &classes, &soil(), &few, |_| {}).unwrap();
    assert!(found.classes[0].missed.as_ref().is_some_and(|w| w.contains("too heavy")), "{:?}", found.classes);
    let grains = PackSettings { least_grains: 500, tries: 300, ..settings() };
    let found = pack(&library, &classes, &soil(), &grains, |_| {}).unwrap();
    assert!(
        found.classes[0].missed.as_ref().is_some_and(|w| w.contains("too few grains")),
        "{:?}",
        found.classes
    );
    let small = PackSettings { bounds: [Vec3::zeros(), Vec3::repeat(0.02)], ..settings() };
    let refused = pack(&library, &classes, &soil(), &small, |_| {}).unwrap_err().to_string();
    assert!(refused.contains("no stone fits into the box"), "{refused}");
    let beside = PackSettings { bounds: [Vec3::repeat(1.0), Vec3::repeat(2.0)], ..settings() };
    assert_eq!(pack(&library, &classes, &soil(), &beside, |_| {}).unwrap_err(), PackError::NoSoil);
}
