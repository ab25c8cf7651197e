//! Turntables with wrong numbers, from rendered silhouettes.

use crate::support::{SIZE, stone};
use photos::adjusted::{Turned, adjust};
use photos::rendered::silhouette;
use photos::turntable::Turntable;
use photos::{Field, View, hull};

/// Two rings of 16 photographs.
fn table(focal: f64, centre: [f64; 2], tilts: [f64; 2], start: f64) -> Turntable {
    let [x, y] = centre;
    let ring = |name: &str, tilt: f64, start: f64| {
        format!(
            "[[ring]]\nphotographs = \"{name}-*\"\ntilt_deg = {tilt}\nstep_deg = 22.5\nstart_deg = {start}\n"
        )
    };
    let rings = ring("a", tilts[0], 0.0) + &ring("b", tilts[1], start);
    let text = format!("[camera]\nfocal_px = {focal}\ndistance = 0.7\ncentre_px = [{x}, {y}]\n{rings}");
    Turntable::parse(&text).unwrap()
}

/// Angles are wrong by 0.5°, and the axis by 3 pixels: both are found, and the hull is right again.
#[test]
fn angles_and_the_axis_are_found_from_silhouettes() {
    let mesh = stone();
    let truth = table(700.0, [159.5, 119.5], [5.0, 35.0], 0.0);
    let names: Vec<String> =
        ["a", "b"].iter().flat_map(|r| (0..16).map(move |k| format!("{r}-{k:02}"))).collect();
    let wrong = table(700.0, [162.5, 119.5], [5.5, 34.5], 0.5);
    let places = wrong.places(&names).unwrap();
    let all: Vec<Turned> = truth
        .places(&names)
        .unwrap()
        .iter()
        .zip(&places)
        .map(|(place, wrong)| {
            let mask = silhouette(&mesh, &truth.camera(place, SIZE[0], SIZE[1]), SIZE[0], SIZE[1]);
            Turned { place: *wrong, field: Field::new(&mask, 1000).unwrap().into(), size: SIZE }
        })
        .collect();
    let volume = |table: &Turntable, all: &[Turned]| {
        let views: Vec<View> = all.iter().map(|t| t.view(table)).collect();
        hull(&views, 60).unwrap().0.volume() / mesh.volume()
    };
    let before = volume(&wrong, &all);
    let (found, done) = adjust(&wrong, &all, true).unwrap();
    let all: Vec<Turned> = all.iter().map(|t| t.on(&wrong, &found)).collect();
    let after = volume(&found, &all);
    let [x, _] = found.camera.centre_px.unwrap();
    println!("{done:?} volume {before} {after} {found:?}");
    assert!((x - 159.5).abs() < 0.5, "the axis is at {x}");
    let lean = found.ring[1].tilt_deg - found.ring[0].tilt_deg;
    assert!((lean - 30.0).abs() < 0.2, "tilts differ by {lean}°");
    assert!(found.ring[1].start_deg.abs() < 0.15, "the second ring starts at {}°", found.ring[1].start_deg);
    assert!(found.ring.iter().all(|r| (r.step_deg - 22.5).abs() < 0.02));
    assert!(before < 1.0 && after > before + 0.02 && (1.0..1.13).contains(&after), "{before} {after}");
}
