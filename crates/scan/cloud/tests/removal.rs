//! Rules of removal on a scan whose every point has a label.

mod random;
mod scanner;

use cloud::Cloud;
use cloud::crop::{CropError, MARK, Reason, Rules, crop, marks};
use geom::{Shape, Vec3};
use random::Random;
use scanner::{EYE, Label, scan};
use stream::{Table, Values};

fn of_points(points: Vec<Vec3>) -> Cloud {
    Cloud { attributes: Table::with_rows(points.len()), points, ..Cloud::default() }
}

/// What rules remove: share of the points with each label.
fn removed(points: &[Vec3], labels: &[Label], rules: &Rules) -> impl Fn(Label) -> f64 {
    let cloud = Cloud {
        points: points.to_vec(),
        attributes: stream::Table::with_rows(points.len()),
        ..Cloud::default()
    };
    let (marked, counts) = crop(&cloud, &Rules { mark: true, ..rules.clone() }).unwrap();
    let marks = marks(&marked).unwrap();
    assert_eq!(marks.iter().filter(|m| **m == 0).count(), counts.points_out);
    let pairs: Vec<(Label, u8)> = labels.iter().copied().zip(marks.iter().copied()).collect();
    move |label| {
        let of = || pairs.iter().filter(|(l, _)| *l == label);
        of().filter(|(_, mark)| *mark != 0).count() as f64 / of().count() as f64
    }
}

const ALL: [Label; 6] = [Label::Floor, Label::Box, Label::Post, Label::Wall, Label::Bush, Label::Mixed];

#[test]
fn each_rule_removes_what_it_is_for() {
    let (points, labels) = scan();
    let of = |rules: Rules| {
        let shares = ALL.map(removed(&points, &labels, &rules));
        println!("{ALL:?} of {}: {shares:.4?}", points.len());
        shares
    };
    let [floor, solid @ .., bush, _] =
        of(Rules { ground: Some("1.5,0.05".parse().unwrap()), ..Rules::default() });
    assert!(floor > 0.99 && solid.iter().all(|s| *s < 0.05) && bush < 0.01);
    let [floor, solid @ .., _, mixed] =
        of(Rules { grazing: Some(75.0), seen_from: vec![EYE], ..Rules::default() });
    assert!(mixed > 0.99 && floor < 0.001 && solid.iter().all(|s| *s < 0.005));
    let [floor, solid @ .., bush, _] =
        of(Rules { scattered: Some("0.1,0.1".parse().unwrap()), ..Rules::default() });
    assert!(bush > 0.95 && floor < 0.01 && solid.iter().all(|s| *s < 0.02));
}

/// A point that one of two scanners sees well stays, and points of the other scan behind a surface make no mixed pixels of it.
#[test]
fn merged_scans_keep_what_one_scanner_sees() {
    let mut random = Random(3);
    let mut on = |x: f64| -> Vec<Vec3> {
        (0..20_000).map(|_| Vec3::new(x, 2.0 * random.next() - 1.0, 2.0 * random.next() - 1.0)).collect()
    };
    // Two walls, each seen from its side alone; and from the edge both are grazing.
    let points = [on(2.0), on(2.5)].concat();
    let cloud = of_points(points);
    let left = |eyes: &[[f64; 3]]| {
        let seen_from = eyes.iter().map(|e| Vec3::from(*e)).collect();
        crop(&cloud, &Rules { grazing: Some(75.0), seen_from, ..Rules::default() }).unwrap().1.points_out
    };
    assert_eq!(left(&[[0.0, 0.0, 0.0], [4.5, 0.0, 0.0]]), 40_000);
    let edgewise = left(&[[2.0, 40.0, 0.0]]);
    assert!(edgewise < 10_000, "{edgewise}");
    // Both walls are in one another for the second scanner, as if it looked through the first: hardly a point has too few of its own wall around.
    assert!(left(&[[2.0, 40.0, 0.0], [0.0, 0.0, 0.0]]) > 39_900);
}

/// Of two merged scans, what mixes an edge goes, though the other scanner sees nothing strange there.
#[test]
fn merged_scans_lose_their_mixed_pixels() {
    let mut random = Random(8);
    let eyes = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.0, 2.5, 0.0)];
    let (mut points, mut mixed) = (Vec::new(), Vec::new());
    for eye in eyes {
        // A panel at x = 2 in front of a wall at x = 5, by beams 4 mrad apart; a beam within 2 mrad of the panel's edge mixes both.
        for k in 0..150 * 150 {
            let turn = -eye.y / 2.0;
            let to = Vec3::new(1.0, turn + 0.004 * f64::from(k % 150 - 75), 0.004 * f64::from(k / 150 - 75));
            let at = eye + to * (2.0 - eye.x);
            let off = (at.y - 0.1).abs().max(at.z.abs()) - 0.2;
            let range = match off {
                off if off.abs() < 0.004 => 2.3 + 2.4 * random.next(),
                off if off < 0.0 => 2.0,
                _ => 5.0,
            };
            mixed.push(range > 2.0 && range < 5.0);
            points.push(eye + to * (range + 0.001 * random.normal()));
        }
    }
    let cloud = of_points(points);
    let rules = Rules { grazing: Some(75.0), seen_from: eyes.to_vec(), mark: true, ..Rules::default() };
    let found = marks(&crop(&cloud, &rules).unwrap().0).unwrap();
    let share = |of: bool| {
        let some = || mixed.iter().zip(&found).filter(|(m, _)| **m == of);
        some().filter(|(_, mark)| **mark != 0).count() as f64 / some().count() as f64
    };
    assert!(share(true) > 0.8 && share(false) < 0.002, "{} {}", share(true), share(false));
}

/// A floor with a thing on it, and strays 1 m below.
fn on_floor(thing: [f64; 5], strays: usize) -> Vec<Vec3> {
    let mut random = Random(5);
    let [x, y, length, width, height] = thing;
    let mut on = |x: f64, y: f64, w: f64, d: f64, z: f64| {
        Vec3::new(x + w * random.next(), y + d * random.next(), z + 0.005 * random.normal())
    };
    let mut points: Vec<Vec3> = (0..3000).map(|_| on(x, y, length, width, height)).collect();
    let free = |p: &Vec3| p.x < x || p.x > x + length || p.y < y || p.y > y + width;
    points.extend((0..40_000).map(|_| on(0.0, 0.0, 10.0, 10.0, 0.0)).filter(|p| free(p)).collect::<Vec<_>>());
    points.extend((0..strays).map(|_| on(0.0, 0.0, 10.0, 10.0, -1.0)).collect::<Vec<_>>());
    points
}

/// Things up to WIDTH wide stay whole wherever they stand, in a corner and at an edge too; so do wide low ones, whatever noise lies below.
#[test]
fn ground_keeps_what_stands_on_it() {
    for (thing, strays, rule) in [
        ([4.0, 4.0, 2.0, 2.0, 1.0], 0, "2,0.05"),
        ([3.37, 5.21, 2.0, 2.0, 1.0], 0, "2,0.05"),
        ([0.0, 0.0, 2.0, 2.0, 1.0], 0, "2,0.05"),
        ([8.0, 3.0, 2.0, 2.0, 1.0], 0, "2,0.05"),
        ([1.0, 1.0, 8.0, 8.0, 0.5], 0, "8,0.05"),
        ([3.0, 3.0, 4.0, 4.0, 0.2], 0, "5,0.05"),
        ([4.0, 4.0, 2.0, 2.0, 1.0], 30, "3,0.05"),
    ] {
        let points = on_floor(thing, strays);
        let above = cloud::crop::ground::above(&points, &rule.parse().unwrap()).unwrap().rows;
        let whole = above.iter().filter(|r| **r < 3000).count();
        let floor = above.len() - whole - strays;
        assert!(
            whole == 3000 && floor < 40,
            "{thing:?} {strays} {rule}: {whole} of 3000, {floor} of the floor"
        );
    }
}

/// Ground rises by up to its slope.
#[test]
fn ground_follows_slopes() {
    let mut random = Random(5);
    let mut points: Vec<Vec3> = (0..40_000)
        .map(|_| {
            let (x, y) = (10.0 * random.next(), 10.0 * random.next());
            Vec3::new(x, y, 0.25 * x + 0.1 * (2.0 * y).sin() + 0.005 * random.normal())
        })
        .collect();
    let on_ground = points.len();
    let mut thing = || Vec3::new(4.0 + random.next(), 5.0 + random.next(), 3.0 + 0.3 * random.next());
    points.extend((0..4000).map(|_| thing()).collect::<Vec<_>>());
    let equipment = points.len();
    points.extend([Vec3::new(7.0, 2.0, -4.0), Vec3::new(2.0, 2.0, 60.0)]);
    let above = |rule: &str| cloud::crop::ground::above(&points, &rule.parse().unwrap());
    let rows = above("2,0.05").unwrap().rows;
    assert_eq!(rows.iter().filter(|r| (on_ground..equipment).contains(&(**r as usize))).count(), 4000);
    assert!(rows.contains(&(equipment as u32)) && rows.contains(&(equipment as u32 + 1)));
    let lost = rows.iter().filter(|r| (**r as usize) < on_ground).count();
    assert!(lost < 400, "{lost}");
    // A ridge stands on the ground if that is less steep.
    let ridge = |p: &Vec3| Vec3::new(p.x, p.y, -0.5 * (p.x - 5.0).abs());
    let ridge: Vec<Vec3> = points[..on_ground].iter().map(ridge).collect();
    let of_ridge =
        |rule: &str| cloud::crop::ground::above(&ridge, &rule.parse().unwrap()).unwrap().rows.len();
    let [gentle, steep] = ["4,0.02,0.01", "4,0.02,0.5"].map(of_ridge);
    assert!(steep < 400 && gentle > 4_000, "{steep} {gentle}");
    let refused = above("0.1,0.05").unwrap_err().to_string();
    assert!(refused.contains("fewer than 3 cells"), "{refused}");
}

/// A rule that cannot judge says so: far points that would widen its cells, too few points, a radius below the spacing.
#[test]
fn rules_that_cannot_judge_say_so() {
    let mut points = on_floor([4.0, 4.0, 2.0, 2.0, 1.0], 0);
    let scattered = |text: &str| Rules { scattered: Some(text.parse().unwrap()), ..Rules::default() };
    let idle = |cloud: &Cloud, rules: &Rules| crop(cloud, rules).unwrap().1.idle;
    let cloud = of_points(points.clone());
    assert!(idle(&cloud, &scattered("0.3,0.1")).is_empty());
    assert!(idle(&cloud, &scattered("1e-4,0.1"))[0].contains("several spacings"));
    let few = of_points(points[..12].to_vec());
    let all = Rules {
        grazing: Some(75.0),
        seen_from: vec![EYE],
        ground: Some("2,0.05".parse().unwrap()),
        ..Rules::default()
    };
    assert_eq!(idle(&few, &all).len(), 2);
    points.push(Vec3::repeat(9e8));
    let refused = crop(&of_points(points), &scattered("0.3,0.1")).unwrap_err().to_string();
    assert!(refused.contains("the cloud spans 9e8 m") || refused.contains("spans 900000000 m"), "{refused}");
    for text in ["5e-324,0.1", "0.1", "0.1,0.4", "-1,0.1"] {
        assert!(text.parse::<cloud::crop::scatter::Scattered>().is_err(), "{text}");
    }
}

/// Marks say why; a later crop applies them, and restores or removes what shapes ask for.
#[test]
fn marks_are_applied_and_restored() {
    let mut points: Vec<Vec3> =
        (0..900).map(|i| Vec3::new(f64::from(i % 30), f64::from(i / 30), 0.0)).collect();
    points.extend([Vec3::new(5.0, 5.0, 40.0), Vec3::new(25.0, 5.0, 40.0), Vec3::new(f64::NAN, 0.0, 0.0)]);
    let cloud = of_points(points);
    let shapes = |text: &str| vec![text.parse::<Shape>().unwrap()];
    let first = Rules {
        remove: shapes("sphere:0,0,0,0.5"),
        outliers: Some("4,12".parse().unwrap()),
        mark: true,
        ..Rules::default()
    };
    let (marked, counts) = crop(&cloud, &first).unwrap();
    assert_eq!(
        (counts.outside_shapes, counts.outliers, counts.points_out, marked.points.len()),
        (1, 2, 899, 902)
    );
    let wanted = [(0, Reason::Shape), (900, Reason::Outlier), (901, Reason::Outlier)];
    for (row, reason) in wanted {
        assert_eq!(marks(&marked).unwrap()[row], reason as u8);
    }
    let (applied, counts) = crop(&marked, &Rules::default()).unwrap();
    assert_eq!((applied.points.len(), counts.marked_before), (899, 3));
    assert!(applied.attributes.get(MARK).is_none());
    assert_eq!(applied, crop(&cloud, &Rules { mark: false, ..first.clone() }).unwrap().0);
    // One stray point and the corner come back; a shape to remove wins.
    let again = Rules { restore: shapes("box:-1,-1,-1,10,10,50"), ..Rules::default() };
    let (_, counts) = crop(&marked, &again).unwrap();
    assert_eq!((counts.restored, counts.points_out), (2, 901));
    let both = Rules { remove: shapes("sphere:5,5,40,1"), ..again.clone() };
    assert_eq!(crop(&marked, &both).unwrap().1.restored, 1);
    // Marked again, reasons stay.
    let (twice, _) =
        crop(&marked, &Rules { mark: true, remove: shapes("sphere:9,9,0,0.5"), ..Rules::default() }).unwrap();
    assert_eq!(
        (marks(&twice).unwrap()[900], marks(&twice).unwrap()[279]),
        (Reason::Outlier as u8, Reason::Shape as u8)
    );
    assert_eq!(crop(&cloud, &again), Err(CropError::NothingToRestore));
    let no_eye = Rules { grazing: Some(75.0), ..Rules::default() };
    assert_eq!(crop(&cloud, &no_eye), Err(CropError::NoViewpoint));
    let nothing = Rules { mark: true, ..Rules::default() };
    assert_eq!(crop(&cloud, &nothing), Err(CropError::NothingToMark));
    // Marks stay marks when another tool has changed their type; what has other values is none.
    let with = |value: f32| {
        let mut other = cloud.clone();
        other.attributes.push(MARK, Values::F32(vec![value; 903])).unwrap();
        other
    };
    assert_eq!(crop(&with(5.0), &Rules::default()).unwrap().1.points_out, 0);
    let other = with(20.0);
    let (kept, counts) = crop(&other, &Rules::default()).unwrap();
    assert_eq!((counts.points_out, kept.attributes.get(MARK).is_some()), (902, true));
    assert_eq!(crop(&other, &first), Err(CropError::OtherMarks));
}
