//! Pictures of scenes whose every pixel can be worked out by hand.

use std::time::Instant;
use stream::{Table, Values};
use view::{Image, Part, PictureOptions, Role, picture};

/// Spheres x, y, z, r with a field `load`.
fn table(spheres: &[[f64; 4]], load: &[f64]) -> Table {
    let mut table = Table::default();
    for (k, name) in ["x", "y", "z", "radius"].into_iter().enumerate() {
        table.push(name, Values::F64(spheres.iter().map(|s| s[k]).collect())).expect("fits");
    }
    table.push("load", Values::F64(load.to_vec())).expect("fits");
    table
}

/// Seen from 10 m in front, looking at 0; 400 pixels high at 10 m are 5.358 m.
fn seen<'a>(parts: &[(Role, &'a Table)], colour: &str) -> Image {
    let part = |&(role, table): &(Role, &'a Table)| Part { role, name: "test".into(), table, kinds: vec![] };
    let parts: Vec<Part> = parts.iter().map(part).collect();
    let options = PictureOptions {
        width: 600,
        height: 400,
        camera: "0,-10,0,0,0,0".parse().expect("a place"),
        colour: Some(colour.to_owned()),
        range: Some([0.0, 1.0]),
        ..PictureOptions::default()
    };
    picture::draw(&parts, &[], &options).expect("drawn")
}

/// The pixel column that a direction `x` over `distance` falls on: 9 % at the right are the colour bar's.
fn column(slope: f64) -> f64 {
    0.5 * 0.91 * 600.0 + slope * 200.0 / 0.2679
}

fn is_paper(image: &Image, x: f64) -> bool {
    image.pixel(x as u32, 196) == [255; 4]
}

#[test]
fn a_sphere_has_its_outline_where_its_tangents_are() {
    let image = seen(&[(Role::Grains, &table(&[[1.0, 0.0, 0.0, 0.5]], &[0.5]))], "load");
    let (towards, half) = ((1.0f64 / 10.0).atan(), (0.5 / 101f64.sqrt()).asin());
    let [left, right] = [column((towards - half).tan()), column((towards + half).tan())];
    assert!(is_paper(&image, left - 1.5) && !is_paper(&image, left + 1.5), "left {left}");
    assert!(is_paper(&image, right + 1.5) && !is_paper(&image, right - 1.5), "right {right}");
}

#[test]
fn the_nearer_sphere_hides_the_farther() {
    // Low load is violet, high load yellow; the order in the table must not matter.
    let near = [0.0, -2.0, 0.0, 0.5];
    let far = [0.0, 2.0, 0.0, 0.5];
    for (spheres, load) in [([near, far], [1.0, 0.0]), ([far, near], [0.0, 1.0])] {
        let image = seen(&[(Role::Grains, &table(&spheres, &load))], "load");
        let [red, green, blue, _] = image.pixel(column(0.0) as u32, 196);
        assert!(red > 150 && green > 150 && blue < 120, "{red} {green} {blue}");
    }
}

#[test]
fn a_wall_in_front_lets_grains_be_seen_and_one_behind_does_not_change_them() {
    let grain = table(&[[0.0, 0.0, 0.0, 0.5]], &[1.0]);
    let middle = |image: &Image| image.pixel(column(0.0) as u32, 196);
    let alone = middle(&seen(&[(Role::Grains, &grain)], "load"));
    let behind = table(&[[0.0, 3.0, 0.0, 1.0]], &[0.0]);
    assert_eq!(middle(&seen(&[(Role::Grains, &grain), (Role::Walls, &behind)], "load")), alone);
    let before = table(&[[0.0, -3.0, 0.0, 1.0]], &[0.0]);
    let veiled = middle(&seen(&[(Role::Grains, &grain), (Role::Walls, &before)], "load"));
    assert!(veiled != alone && veiled[0] > veiled[2], "still yellow: {veiled:?}");
}

/// A heap of spheres without order, always the same.
fn heap(count: usize) -> Table {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let spheres: Vec<[f64; 4]> =
        (0..count).map(|_| [next(), next(), next(), 0.008 + 0.004 * next()]).collect();
    let load: Vec<f64> = (0..count).map(|_| next()).collect();
    table(&spheres, &load)
}

fn draw_heap(count: usize, threads: usize) -> Image {
    let heap = heap(count);
    let part = Part { role: Role::Grains, name: "heap".into(), table: &heap, kinds: vec![] };
    let options =
        PictureOptions { colour: Some("load".into()), time: Some(0.5), ..PictureOptions::default() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| picture::draw(&[part], &[], &options)).expect("drawn")
}

#[test]
fn same_bits_on_any_number_of_threads() {
    let image = draw_heap(20_000, 1);
    assert_eq!(image, draw_heap(20_000, 3));
    assert_eq!(image.png().expect("encoded"), draw_heap(20_000, 2).png().expect("encoded"));
}

/// The limit is 1 s in release; the bound here is wide, for busy machines and the test profile.
#[test]
fn a_hundred_thousand_spheres_at_full_size_take_seconds_at_most() {
    let start = Instant::now();
    let image = draw_heap(100_000, 2);
    println!("100 000 spheres, 1920 x 1080: {:.2} s", start.elapsed().as_secs_f64());
    assert!(image.rgba.len() == 1920 * 1080 * 4 && start.elapsed().as_secs_f64() < 10.0);
}

#[test]
fn what_cannot_be_drawn_is_named() {
    let table = table(&[[0.0, 0.0, 0.0, 1.0]], &[0.0]);
    let part = Part { role: Role::Grains, name: "run".into(), table: &table, kinds: vec![] };
    let options = PictureOptions { colour: Some("warmth".into()), ..PictureOptions::default() };
    let message =
        picture::draw(std::slice::from_ref(&part), &[], &options).expect_err("no such field").to_string();
    assert!(message.contains("'warmth'") && message.contains("load"), "{message}");
    let small = PictureOptions { width: 3, ..PictureOptions::default() };
    assert!(picture::draw(&[part], &small).expect_err("too small").to_string().contains("3 x 1080"));
    assert!(picture::draw(&[], &[], &options).expect_err("nothing").to_string().contains("nothing to show"));
}
