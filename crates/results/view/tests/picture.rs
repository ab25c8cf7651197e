//! Pictures of scenes whose every pixel can be worked out by hand.

#[path = "picture/extras.rs"]
mod extras;

use geom::{Plane, Vec3, mesh::TriMesh};
use std::time::Instant;
use stream::{Table, Values};
use view::{
    DrawnTable, Image, Motion, PictureOptions, Role, SurfaceShape, Survey, ViewError, WallSurface, picture,
};

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
    let part = |&(role, table): &(Role, &'a Table)| DrawnTable {
        role,
        name: "test".into(),
        table,
        kinds: vec![],
        clumps: vec![],
    };
    let parts: Vec<DrawnTable> = parts.iter().map(part).collect();
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

/// The pixel column of a ray of this slope, x over distance: 8.5 heights of the smallest capitals at the right are the
/// colour bar's.
fn column(slope: f64) -> f64 {
    0.5 * (600.0 - 8.5 * 7.0) + slope * 200.0 / 0.2679
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

/// A sheet 2 m wide and high, 2 m right of the middle, in the plane y = `y`.
fn sheet(y: f64, motion: Motion) -> WallSurface {
    let corner = |x: f64, z: f64| Vec3::new(x, y, z);
    let vertices = vec![corner(1.0, -1.0), corner(3.0, -1.0), corner(3.0, 1.0), corner(1.0, 1.0)];
    let mesh = TriMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3]]).expect("whole");
    WallSurface { name: "sheet".into(), shape: SurfaceShape::Mesh(mesh), motion }
}

/// The same eye as [`seen`], at a time.
fn seen_with(surfaces: &[WallSurface], grain: &Table, time: f64, cut: bool) -> Image {
    let part =
        DrawnTable { role: Role::Grains, name: "test".into(), table: grain, kinds: vec![], clumps: vec![] };
    let options = PictureOptions {
        width: 600,
        height: 400,
        camera: "0,-10,0,0,0,0".parse().expect("a place"),
        colour: Some("load".into()),
        range: Some([0.0, 1.0]),
        time: Some(time),
        cut,
        ..PictureOptions::default()
    };
    picture::draw(&[part], surfaces, &options).expect("drawn")
}

#[test]
fn a_mesh_is_drawn_from_its_left_edge_to_its_right_and_lets_grains_be_seen() {
    let grain = table(&[[2.0, 3.0, 0.0, 0.1]], &[1.0]);
    let image = seen_with(&[sheet(0.0, Motion::default())], &grain, 0.0, false);
    let [left, right] = [column(0.1), column(0.3)];
    assert!(is_paper(&image, left - 2.5) && !is_paper(&image, left + 2.5));
    assert!(is_paper(&image, right + 2.5) && !is_paper(&image, right - 2.5));
    let behind = image.pixel(column(2.0 / 13.0) as u32, 196);
    let alone = seen_with(&[], &grain, 0.0, false).pixel(column(2.0 / 13.0) as u32, 196);
    assert!(behind != alone && behind[0] > behind[2] + 30, "still yellow: {behind:?}, {alone:?}");
    let before = table(&[[2.0, -3.0, 0.0, 0.1]], &[1.0]);
    let at = column(2.0 / 7.0) as u32;
    let unchanged = seen_with(&[sheet(0.0, Motion::default())], &before, 0.0, false).pixel(at, 196);
    assert_eq!(unchanged, seen_with(&[], &before, 0.0, false).pixel(at, 196));
}

#[test]
fn a_mesh_that_moves_is_where_its_motion_takes_it() {
    let grain = table(&[[0.0, 0.0, -1.5, 0.1]], &[1.0]);
    let motion = Motion { velocity: Vec3::new(-2.0, 0.0, 0.0), ..Motion::default() };
    let [home, later] = [0.0, 2.0].map(|t| seen_with(&[sheet(0.0, motion.clone())], &grain, t, false));
    let [right, left] = [column(0.2), column(-0.2)];
    assert!(!is_paper(&home, right) && is_paper(&home, left));
    assert!(is_paper(&later, right) && !is_paper(&later, left));
}

#[test]
fn the_cut_leaves_out_what_is_nearer_than_the_middle() {
    let grain = table(&[[0.0, 0.0, 0.0, 0.1]], &[1.0]);
    for (y, stays) in [(-1.0, false), (1.0, true)] {
        let image = seen_with(&[sheet(y, Motion::default())], &grain, 0.0, true);
        assert_eq!(!is_paper(&image, column(2.0 / (10.0 + y))), stays, "y = {y}");
    }
}

#[test]
fn a_floor_is_drawn_below_the_grains_and_not_above() {
    let plane = Plane::new(Vec3::new(0.0, 0.0, -0.5), Vec3::z()).expect("a direction");
    let floor =
        WallSurface { name: "floor".into(), shape: SurfaceShape::Plane(plane), motion: Motion::default() };
    let grain = table(&[[0.0, 0.0, 0.0, 0.5]], &[1.0]);
    let part =
        DrawnTable { role: Role::Grains, name: "test".into(), table: &grain, kinds: vec![], clumps: vec![] };
    let options = PictureOptions { width: 600, height: 400, ..PictureOptions::default() };
    let image = picture::draw(&[part], &[floor], &options).expect("drawn");
    let tinted = |rows: std::ops::Range<u32>| {
        let all = rows.flat_map(|y| (150..400).map(move |x| (x, y)));
        all.filter(
            |&(x, y)| matches!(image.pixel(x, y), [r, g, b, _] if r > 200 && r < 250 && g >= r && b >= g),
        )
        .count()
    };
    assert!(tinted(250..400) > 500 && tinted(0..100) < 20, "{} {}", tinted(250..400), tinted(0..100));
}

/// The lamp is over the left shoulder: the shadow of a grain lies right of where it touches the floor.
#[test]
fn a_grain_casts_a_shadow_on_the_floor_and_on_wall_spheres() {
    let plane = Plane::new(Vec3::new(0.0, 0.0, -0.1), Vec3::z()).expect("a direction");
    let floor =
        WallSurface { name: "floor".into(), shape: SurfaceShape::Plane(plane), motion: Motion::default() };
    let grid =
        |z: f64| (0..400).map(move |n| [0.1 * f64::from(n % 20 - 10), 0.1 * f64::from(n / 20 - 10), z, 0.1]);
    let walls: Vec<[f64; 4]> = grid(-0.2).collect();
    let walls = table(&walls, &vec![0.0; walls.len()]);
    let draw = |grain: [f64; 4], floor: &[WallSurface], walls: Option<&Table>| {
        let grain = table(&[grain, [0.9, 0.9, 0.0, 0.1], [-0.9, -0.9, 0.0, 0.1]], &[1.0; 3]);
        let mut parts = vec![DrawnTable {
            role: Role::Grains,
            name: "test".into(),
            table: &grain,
            kinds: vec![],
            clumps: vec![],
        }];
        parts.extend(walls.map(|table| DrawnTable {
            role: Role::Walls,
            name: "walls".into(),
            table,
            kinds: vec![],
            clumps: vec![],
        }));
        let options = PictureOptions {
            width: 600,
            height: 400,
            camera: "0,-3,3,0,0,0".parse().expect("a place"),
            ..PictureOptions::default()
        };
        picture::draw(&parts, floor, &options).expect("drawn")
    };
    let beside = [column(0.11 / 4.2) as u32, 206];
    for (floor, walls) in [(vec![floor], None), (vec![], Some(&walls))] {
        let light = |grain| u32::from(draw(grain, &floor, walls).pixel(beside[0], beside[1])[1]);
        let (near, away) = (light([0.0, 0.0, 0.0, 0.1]), light([0.5, 0.8, 0.0, 0.1]));
        assert!(near + 12 < away, "{near} where there is a shadow, {away} where there is none");
    }
}

/// In a film nothing moves but what moves: the eye stays where it is.
#[test]
fn moments_of_a_film_are_seen_by_the_same_eye_in_the_same_colours() {
    let walls = table(&[[-2.0, 0.0, 0.0, 0.2]], &[0.0]);
    let moments = [[0.0, 0.0, 4.0, 0.2], [3.0, 0.0, 0.0, 0.2]].map(|grain| table(&[grain], &[grain[2]]));
    let part = |role, table| DrawnTable { role, name: "test".into(), table, kinds: vec![], clumps: vec![] };
    let options = PictureOptions {
        width: 600,
        height: 400,
        colour: Some("load".into()),
        camera: "front".parse().expect("known"),
        ..PictureOptions::default()
    };
    let mut survey = Survey::default();
    for grains in &moments {
        survey
            .add(&[part(Role::Grains, grains), part(Role::Walls, &walls)], &[], &options)
            .expect("taken in");
    }
    let images = moments.each_ref().map(|grains| {
        let parts = [part(Role::Grains, grains), part(Role::Walls, &walls)];
        picture::draw_surveyed(&parts, &[], &survey, &options).expect("drawn")
    });
    let yellow = |p: [u8; 4]| p[0] > 180 && p[1] > 150 && p[2] < 120;
    let high = (0..100).flat_map(|y| (100..500).map(move |x| (x, y)));
    assert!(
        high.clone().any(|(x, y)| yellow(images[0].pixel(x, y))),
        "the eye sees what comes later or was before"
    );
    let left = (60..400).flat_map(|y| (0..200).map(move |x| (x, y)));
    let rests = left.into_iter().all(|(x, y)| images[0].pixel(x, y) == images[1].pixel(x, y));
    assert!(images[0] != images[1] && rests, "the wall at the left is where it was");
}

/// The grains fill most of the height of the picture although one has flown far away.
#[test]
fn a_stray_does_not_shrink_the_picture() {
    let mut spheres: Vec<[f64; 4]> = (0..1000)
        .map(|i| [f64::from(i % 10) * 0.1, f64::from(i / 10 % 10) * 0.1, f64::from(i / 100) * 0.1, 0.05])
        .collect();
    spheres.push([1e3, 0.0, 0.0, 0.05]);
    let table = table(&spheres, &vec![0.5; spheres.len()]);
    let part =
        DrawnTable { role: Role::Grains, name: "heap".into(), table: &table, kinds: vec![], clumps: vec![] };
    let options = PictureOptions {
        width: 600,
        height: 400,
        camera: "front".parse().expect("known"),
        ..PictureOptions::default()
    };
    let image = picture::draw(&[part], &[], &options).expect("drawn");
    let inked = (0..400).filter(|y| (200..400).any(|x| image.pixel(x, *y) != [255; 4])).count();
    assert!((330..396).contains(&inked), "{inked} of 400 rows");
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

/// Calls `draw` with a heap and how it is to be seen, on so many threads.
fn of_heap<T: Send>(
    count: usize,
    threads: usize,
    draw: impl FnOnce(&[DrawnTable], &PictureOptions) -> Result<T, ViewError> + Send,
) -> T {
    let heap = heap(count);
    let part =
        DrawnTable { role: Role::Grains, name: "heap".into(), table: &heap, kinds: vec![], clumps: vec![] };
    let options =
        PictureOptions { colour: Some("load".into()), time: Some(0.5), ..PictureOptions::default() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| draw(&[part], &options)).expect("drawn")
}

fn draw_heap(count: usize, threads: usize) -> Image {
    of_heap(count, threads, |parts, options| picture::draw(parts, &[], options))
}

/// The file of the heap.
fn heap_as_file(count: usize, threads: usize) -> Vec<u8> {
    let mut file = Vec::new();
    of_heap(count, threads, |parts, options| picture::png(parts, &[], options)?.write(&mut file));
    file
}

#[test]
fn same_bits_on_any_number_of_threads() {
    let image = draw_heap(20_000, 1);
    assert_eq!(image, draw_heap(20_000, 3));
    let file = heap_as_file(20_000, 1);
    assert!(file == heap_as_file(20_000, 2));
    let mut decoder = png::Decoder::new(std::io::Cursor::new(file)).read_info().expect("a PNG");
    let mut rgb = vec![0; decoder.output_buffer_size().expect("bounded")];
    decoder.next_frame(&mut rgb).expect("whole");
    assert!(rgb.chunks_exact(3).eq(image.rgba.chunks_exact(4).map(|p| &p[..3])), "what was drawn");
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
    let part =
        DrawnTable { role: Role::Grains, name: "run".into(), table: &table, kinds: vec![], clumps: vec![] };
    let options = PictureOptions { colour: Some("warmth".into()), ..PictureOptions::default() };
    let message =
        picture::draw(std::slice::from_ref(&part), &[], &options).expect_err("no such field").to_string();
    assert!(message.contains("'warmth'") && message.contains("load"), "{message}");
    let small = PictureOptions { width: 3, ..PictureOptions::default() };
    assert!(picture::draw(&[part], &[], &small).expect_err("too small").to_string().contains("3 x 1080"));
    assert!(picture::draw(&[], &[], &options).expect_err("nothing").to_string().contains("nothing to show"));
}
