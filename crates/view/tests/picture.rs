//! Pictures of scenes whose every pixel can be worked out by hand.

use geom::{Plane, Vec3, mesh::TriMesh};
use std::time::Instant;
use stream::{Table, Values};
use view::{
    Arrows, DrawnTable, Image, Motion, PictureOptions, Role, SurfaceShape, Survey, WallSurface, picture,
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
    let part =
        |&(role, table): &(Role, &'a Table)| DrawnTable { role, name: "test".into(), table, kinds: vec![] };
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

/// The pixel column that a direction `x` over `distance` falls on: 8.5 heights of the smallest capitals at the right are the
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
    let part = DrawnTable { role: Role::Grains, name: "test".into(), table: grain, kinds: vec![] };
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
    let part = DrawnTable { role: Role::Grains, name: "test".into(), table: &grain, kinds: vec![] };
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
        let mut parts =
            vec![DrawnTable { role: Role::Grains, name: "test".into(), table: &grain, kinds: vec![] }];
        parts.extend(walls.map(|table| DrawnTable {
            role: Role::Walls,
            name: "walls".into(),
            table,
            kinds: vec![],
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
    let part = |role, table| DrawnTable { role, name: "test".into(), table, kinds: vec![] };
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
    let part = DrawnTable { role: Role::Grains, name: "heap".into(), table: &table, kinds: vec![] };
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

fn draw_heap(count: usize, threads: usize) -> Image {
    let heap = heap(count);
    let part = DrawnTable { role: Role::Grains, name: "heap".into(), table: &heap, kinds: vec![] };
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
    let part = DrawnTable { role: Role::Grains, name: "run".into(), table: &table, kinds: vec![] };
    let options = PictureOptions { colour: Some("warmth".into()), ..PictureOptions::default() };
    let message =
        picture::draw(std::slice::from_ref(&part), &[], &options).expect_err("no such field").to_string();
    assert!(message.contains("'warmth'") && message.contains("load"), "{message}");
    let small = PictureOptions { width: 3, ..PictureOptions::default() };
    assert!(picture::draw(&[part], &[], &small).expect_err("too small").to_string().contains("3 x 1080"));
    assert!(picture::draw(&[], &[], &options).expect_err("nothing").to_string().contains("nothing to show"));
}

/// A table with more columns.
fn with(mut table: Table, columns: &[(&str, Vec<f64>)]) -> Table {
    for (name, values) in columns {
        table.replace(name, Values::F64(values.clone())).expect("fits");
    }
    table
}

/// Two grains beside each other that a bond joins, and below them two whose bond has broken; seen from 10 m in front.
#[test]
fn bonds_are_beams_between_grains_and_cracks_are_discs_across_them() {
    let at = |x: f64, z: f64| [x, 0.0, z, 0.5];
    let grains = table(&[at(-0.6, 1.0), at(0.6, 1.0), at(0.0, 0.0), at(0.0, -1.2)], &[0.0; 4]);
    let bonds = |crack: f64| {
        let half = [("dx", vec![0.6, 0.0]), ("dy", vec![0.0; 2]), ("dz", vec![0.0, -0.6])];
        with(with(table(&[at(0.0, 1.0), at(0.0, -0.6)], &[0.0; 2]), &half), &[("broken", vec![0.0, crack])])
    };
    let draw = |crack: Option<f64>| {
        let bonds = crack.map(bonds);
        let mut parts = vec![(Role::Grains, &grains)];
        parts.extend(bonds.iter().map(|b| (Role::Bonds, b)));
        seen(&parts, "load")
    };
    let row = |z: f64| (0.49 * 400.0 - z / 10.0 * 200.0 / 0.2679) as u32;
    let [between, across] = [[column(0.0) as u32, row(1.0)], [column(0.03) as u32, row(-0.6)]];
    let plain = draw(None);
    // Without bonds the grains are whole: these places see them, or nothing.
    assert_eq!(plain.pixel(between[0], between[1]), [255; 4], "0.2 m of nothing");
    let broken = draw(Some(1.0));
    let [r, g, b, _] = broken.pixel(between[0], between[1]);
    assert!(r.abs_diff(g) < 40 && g.abs_diff(b) < 40 && r < 200, "a grey beam: {r} {g} {b}");
    let [r, g, b, _] = broken.pixel(across[0], across[1]);
    assert!(r > g + 50 && r > b + 50, "a red disc: {r} {g} {b}");
    let opened = draw(Some(2.0));
    assert_eq!(opened.pixel(across[0], across[1]), [255; 4], "a wide crack is not drawn");
    // Grains are drawn at half their size: the upper edge of the left one is nearer to its middle.
    let edge = [column(-0.06) as u32, row(1.4)];
    assert!(plain.pixel(edge[0], edge[1]) != [255; 4] && broken.pixel(edge[0], edge[1]) == [255; 4]);
}

#[test]
fn an_arrow_points_where_its_vector_does_and_the_legend_has_its_length() {
    let grain = [0.0, 0.0, 0.0, 0.2];
    let vector =
        |x: f64| with(table(&[grain], &[0.0]), &[("dx", vec![x]), ("dy", vec![0.0]), ("dz", vec![0.0])]);
    let [right, left] = [3.0, -3.0].map(|x| {
        let arrow = vector(x);
        seen(&[(Role::Grains, &table(&[grain], &[1.0])), (Role::Arrows(Arrows::Velocity), &arrow)], "load")
    });
    // Five radii long: 1 m.
    let inked = |image: &Image, x: f64| (190..203).any(|y| image.pixel(column(x / 10.0) as u32, y)[1] < 120);
    assert!(inked(&right, 0.5) && inked(&right, 0.9) && !inked(&right, 1.1) && !inked(&right, -0.5));
    assert!(inked(&left, -0.5) && inked(&left, -0.9) && !inked(&left, 0.5));
    // 2 m/s of 3 are two thirds of a metre: 49.8 pixels.
    let legend = |image: &Image| {
        let dark = |x: u32, y: u32| image.pixel(x, y)[0] < 140;
        (320..370).map(|y| (0..200).filter(|x| dark(*x, y)).count()).max().unwrap_or(0)
    };
    let long = legend(&right) as f64;
    assert!((long - 200.0 / 0.2679 / 10.0 * 2.0 / 3.0).abs() < 6.0, "{long}");
}

#[test]
fn sizes_are_coloured_by_class() {
    let spheres = [[-1.0, 0.0, 0.0, 0.3], [0.0, 0.0, 0.0, 0.4], [1.0, 0.0, 0.0, 0.5]];
    let image = seen(&[(Role::Grains, &table(&spheres, &[0.0; 3]))], "size");
    let [small, middle, large] = [-0.1, 0.0, 0.1].map(|x| image.pixel(column(x) as u32, 196));
    assert!(small[2] > small[1] + 20 && small[0] > small[1] + 20, "violet: {small:?}");
    assert!(middle[1] > middle[0] + 60, "green: {middle:?}");
    assert!(large[0] > 180 && large[1] > 170 && large[2] < 120, "yellow: {large:?}");
}

/// Ground is behind everything: neither its face nor its grid shows through the wall spheres that stand before it.
#[test]
fn a_plane_does_not_show_through_wall_spheres() {
    let grain = table(&[[0.0, 0.0, 2.0, 0.1]], &[1.0]);
    let wall: Vec<[f64; 4]> = (-20..=20)
        .flat_map(|i| (-20..=20).map(move |k| [0.05 * f64::from(i), 0.0, 0.05 * f64::from(k), 0.05]))
        .collect();
    let wall = table(&wall, &vec![0.0; wall.len()]);
    let plane = Plane::new(Vec3::new(0.0, 1.0, 0.0), -Vec3::y()).expect("a direction");
    let back =
        WallSurface { name: "back".into(), shape: SurfaceShape::Plane(plane), motion: Motion::default() };
    let draw = |surfaces: &[WallSurface]| {
        let part = |role, table| DrawnTable { role, name: "test".into(), table, kinds: vec![] };
        let options = PictureOptions {
            width: 600,
            height: 400,
            camera: "0,-10,0,0,0,0".parse().expect("a place"),
            ..PictureOptions::default()
        };
        picture::draw(&[part(Role::Grains, &grain), part(Role::Walls, &wall)], surfaces, &options)
            .expect("drawn")
    };
    let (with, without) = (draw(&[back]), draw(&[]));
    let same = |x: u32, y: u32| with.pixel(x, y) == without.pixel(x, y);
    let [left, right] = [column(-0.09) as u32, column(0.09) as u32];
    assert!((left..right).all(|x| (140..250).all(|y| same(x, y))), "the plane shows through the wall");
    assert!((10..left - 20).any(|x| !same(x, 196)), "beside the wall it is seen");
}

/// However the grains lie, they leave the text free.
#[test]
fn text_is_never_over_grains() {
    for (wide, high) in [(4.0, 1.0), (1.0, 1.0), (2.0, 1.3), (1.0, 3.0)] {
        let spheres: Vec<[f64; 4]> = (0..2500)
            .map(|n| {
                [f64::from(n % 50) / 50.0 * wide, 0.0, f64::from(n / 50) / 50.0 * high, 0.03 * wide.max(high)]
            })
            .collect();
        let grains = table(&spheres, &vec![1.0; spheres.len()]);
        let part = DrawnTable { role: Role::Grains, name: "test".into(), table: &grains, kinds: vec![] };
        let options = PictureOptions {
            width: 640,
            height: 360,
            camera: "front".parse().expect("known"),
            colour: Some("load".into()),
            range: Some([0.0, 1.0]),
            time: Some(0.5),
            ..PictureOptions::default()
        };
        let image = picture::draw(&[part], &[], &options).expect("drawn");
        let grain = |x: u32, y: u32| {
            let [r, _, b, _] = image.pixel(x, y);
            u16::from(r) > u16::from(b) + 40
        };
        let head = (0..100).flat_map(|x| (0..40).map(move |y| (x, y)));
        let foot = (0..120).flat_map(|x| (325..360).map(move |y| (x, y)));
        let under = head.chain(foot).filter(|(x, y)| grain(*x, *y)).count();
        assert_eq!(under, 0, "{wide} x {high}");
        let all = (0..640).flat_map(|x| (0..360).map(move |y| (x, y))).filter(|(x, y)| grain(*x, *y)).count();
        assert!(all > 20_000, "{wide} x {high}: they are large all the same: {all}");
    }
}

/// On dark paper everything can be told from it: text, the darkest grains, a floor and its grid.
#[test]
fn on_dark_paper_nothing_is_lost() {
    let plane = Plane::new(Vec3::new(0.0, 0.0, -0.5), Vec3::z()).expect("a direction");
    let floor =
        [WallSurface { name: "floor".into(), shape: SurfaceShape::Plane(plane), motion: Motion::default() }];
    // The lowest colour of the map, nearly as dark as the paper.
    let grain = table(&[[0.0, 0.0, 0.0, 0.5]], &[0.0]);
    let draw = |dark: bool, surfaces: &[WallSurface]| {
        let part = DrawnTable { role: Role::Grains, name: "test".into(), table: &grain, kinds: vec![] };
        let options = PictureOptions {
            width: 600,
            height: 400,
            camera: "0,-10,3,0,0,0".parse().expect("a place"),
            colour: Some("load".into()),
            range: Some([0.0, 1.0]),
            time: Some(0.25),
            dark,
            ..PictureOptions::default()
        };
        picture::draw(&[part], surfaces, &options).expect("drawn")
    };
    let image = draw(true, &floor);
    let light = |x: u32, y: u32| image.pixel(x, y)[..3].iter().map(|c| u32::from(*c)).sum::<u32>() / 3;
    let paper = light(300, 5);
    assert!(paper < 30, "{paper}");
    let all = |columns: std::ops::Range<u32>, rows: std::ops::Range<u32>| {
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
    };
    assert!(all(10..150, 5..40).any(|(x, y)| light(x, y) > 200), "text");
    let outline = (0..600).filter(|x| light(*x, 196) > paper + 40).count();
    assert!(outline > 6, "the rim of the grain: {outline} pixels");
    let middle = column(0.0) as u32;
    let darkest = (164..228).map(|y| light(middle, y)).min().unwrap_or(0);
    assert!(darkest > paper + 25, "no part of the grain is as the paper: {darkest}");
    let bare = draw(true, &[]);
    assert!(
        all(100..500, 210..380).filter(|(x, y)| bare.pixel(*x, *y) != image.pixel(*x, *y)).count() > 1000
    );
    // On light paper nothing has changed.
    assert_eq!(draw(false, &floor).pixel(300, 5), [255; 4]);
}
