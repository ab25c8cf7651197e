//! Scans from a known viewpoint: what was looked through stays open, shadows and blind spots are filled.

mod random;

use cloud::Cloud;
use cloud::fill::{Filled, HoleReport, Settings};
use geom::Vec3;
use random::Random;
use stream::Table;

/// A plate at x = 3 m with a window of 0.3 m around the x axis and a dark spot that gives no echo, in front of a wall at x = 6 m; a disc at
/// x = 4.5 m throws a shadow on the wall.
fn scan(eye: Vec3) -> Cloud {
    let mut random = Random(11);
    let mut points = Vec::new();
    for _ in 0..90_000 {
        let (y, z) = (1.2 * random.next() - 0.6, 1.2 * random.next() - 0.6);
        let hit = |x: f64| Vec3::new(x, y * x, z * x);
        let (plate, disc) = (hit(3.0), hit(4.5));
        let in_plate = plate.y.abs() < 1.0 && plate.z.abs() < 1.0 && plate.yz().norm() > 0.3;
        if in_plate && (plate.yz() - WINDOW_TO_SPOT).norm() < 0.2 {
            continue;
        }
        let hit = match () {
            () if in_plate => plate,
            () if (disc.yz() - DISC).norm() < 0.3 => disc,
            () => hit(6.0),
        };
        points.push(eye + hit * (1.0 + 0.0005 * random.normal()));
    }
    Cloud { attributes: Table::with_rows(points.len()), points, ..Cloud::default() }
}

const WINDOW_TO_SPOT: nalgebra::Vector2<f64> = nalgebra::Vector2::new(0.0, 0.65);
const DISC: nalgebra::Vector2<f64> = nalgebra::Vector2::new(2.1, 0.0);

fn fill(cloud: Cloud, seen_from: &[Vec3]) -> Filled {
    let settings = Settings { seen_from: seen_from.to_vec(), max_hole: Some(1.5), ..Settings::default() };
    cloud::fill(cloud, &settings).unwrap()
}

/// The hole around a place [m].
fn at(filled: &Filled, place: Vec3) -> &HoleReport {
    let near = |h: &&HoleReport| (Vec3::from(h.centre) - place).norm() < 0.2;
    filled.report.holes.iter().find(near).unwrap_or_else(|| panic!("{place}: {:?}", filled.report.holes))
}

#[test]
fn a_window_that_was_looked_through_stays_open_and_a_shadow_and_a_dark_spot_are_filled() {
    let eye = Vec3::new(-1.0, 2.0, 0.5);
    let [window, spot, shadow] =
        [Vec3::new(3.0, 0.0, 0.0), Vec3::new(3.0, 0.0, 0.65), Vec3::new(6.0, 2.8, 0.0)].map(|p| eye + p);
    let blind = fill(scan(eye), &[]);
    for place in [window, spot, shadow] {
        assert!(at(&blind, place).added > 50 && at(&blind, place).sight.is_none());
    }
    let seen = fill(scan(eye), &[eye]);
    assert_eq!(seen.report.viewpoints, 1);
    let sight = |place| (at(&seen, place).added, at(&seen, place).sight.unwrap());
    let (added, of_window) = sight(window);
    assert!(of_window.free > 300 && added * 20 < of_window.free, "{added}, {of_window:?}");
    let (added, of_spot) = sight(spot);
    assert!(of_spot.free == 0 && of_spot.unseen == added && added == at(&blind, spot).added, "{of_spot:?}");
    let (added, of_shadow) = sight(shadow);
    assert!(of_shadow.free == 0 && of_shadow.shadow * 10 > 9 * added && added > 50, "{of_shadow:?}");
    // A cloud that states its viewpoint needs no option, in millimetres neither; another viewpoint sees nothing of the window.
    let mut stated = scan(eye);
    stated.add_viewpoint(&eye);
    assert_eq!(fill(stated.clone(), &[]).cloud.points, seen.cloud.points);
    stated.scale(0.001);
    let eyes: Vec<Vec3> = stated.viewpoints().collect();
    assert!(eyes.len() == 1 && (eyes[0] * 1000.0 - eye).norm() < 1e-9, "{eyes:?}");
}

#[test]
fn any_number_of_threads_sees_the_same() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fill(scan(Vec3::zeros()), &[Vec3::zeros(), Vec3::new(0.0, 0.0, 1.0)]).cloud.points)
    };
    assert_eq!(run(1), run(3));
}
