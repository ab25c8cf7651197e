//! Clumps as the bodies they are: in pictures, in counts, in pages, and for the camera.

use record::ClumpRecord;
use stream::{Table, Values};
use view::{DrawnTable, GrainCount, Image, Page, PageOptions, PictureOptions, Role, picture};

/// Spheres x, y, z, r with a field `load`, and the clump of each where `body` is given.
fn table(spheres: &[[f64; 4]], load: &[f64], body: Option<&[u32]>) -> Table {
    let mut table = Table::default();
    for (k, name) in ["x", "y", "z", "radius"].into_iter().enumerate() {
        table.push(name, Values::F64(spheres.iter().map(|s| s[k]).collect())).expect("fits");
    }
    table.push("load", Values::F64(load.to_vec())).expect("fits");
    table.push("id", Values::U32((0..spheres.len() as u32).collect())).expect("fits");
    if let Some(body) = body {
        table.push("body", Values::U32(body.to_vec())).expect("fits");
    }
    table
}

/// Seen from 10 m in front, looking at 0.
fn seen(table: &Table, clumps: Vec<ClumpRecord>) -> Image {
    let part = DrawnTable { role: Role::Grains, name: "test".into(), table, kinds: vec![], clumps };
    let options = PictureOptions {
        width: 600,
        height: 400,
        camera: "0,-10,0,0,0,0".parse().expect("a place"),
        colour: Some("load".into()),
        range: Some([0.0, 1.0]),
        ..PictureOptions::default()
    };
    picture::draw(&[part], &[], &options).expect("drawn")
}

/// Three spheres in a row that overlap by half, as one clump or as three grains.
fn row(body: Option<&[u32]>) -> Image {
    let spheres = [[-0.8, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0], [0.8, 0.0, 0.0, 1.0]];
    seen(&table(&spheres, &[0.5; 3], body), Vec::new())
}

/// The largest step of brightness between neighbours in the middle of the row, where two spheres meet twice.
fn crease(image: &Image) -> u16 {
    let bright = |x: u32| image.pixel(x, 196)[..3].iter().map(|c| u16::from(*c)).sum::<u16>();
    (200..340).map(|x| bright(x).abs_diff(bright(x + 1))).max().unwrap_or(0)
}

#[test]
fn the_spheres_of_a_clump_have_no_creases_between_them() {
    let (clump, grains) = (crease(&row(Some(&[0, 0, 0]))), crease(&row(None)));
    assert!(grains > 30, "a crease between grains: {grains}");
    assert!(clump < 12, "none in a clump: {clump}, {grains} between grains");
}

#[test]
fn grains_of_one_sphere_are_drawn_as_before_beside_clumps_or_not() {
    assert!(row(Some(&[0, 1, 2])) == row(None), "a body of one sphere is a grain");
}

#[test]
fn a_clump_has_the_colour_of_its_mean() {
    let spheres = [[-0.8, 0.0, 0.0, 1.0], [0.8, 0.0, 0.0, 1.0]];
    let ends = |body| {
        let image = seen(&table(&spheres, &[0.0, 1.0], body), Vec::new());
        [150, 390].map(|x| image.pixel(x, 196))
    };
    let yellow = |p: [u8; 4]| p[1] > p[2] && p[0] > p[2];
    let green = |p: [u8; 4]| p[1] > p[0] && p[1] > p[2];
    let [left, right] = ends(None);
    assert!(!yellow(left) && yellow(right), "{left:?} {right:?}");
    let [left, right] = ends(Some(&[0, 0]));
    assert!(green(left) && green(right), "{left:?} {right:?}");
}

/// A cube with small spheres at its corners, as a run records it.
fn cube(volume: f64) -> (Table, ClumpRecord) {
    let corner = |k: i32| [0, 1, 2].map(|n| if k >> n & 1 == 1 { 1.0 } else { -1.0 });
    let spheres: Vec<[f64; 4]> = (0..8).map(corner).map(|[x, y, z]| [x, y, z, 0.1]).collect();
    // Half the size, at the same place.
    let drawn: Vec<[f64; 4]> = spheres.iter().map(|s| s.map(|v| 0.5 * v)).collect();
    let record = ClumpRecord {
        centre: [0.0; 3],
        inertia: [1.0; 3],
        axes: None,
        material: 0,
        name: "cube".into(),
        scales: None,
        spheres,
        volume,
    };
    (table(&drawn, &[0.5; 8], Some(&[0; 8])), record)
}

#[test]
fn a_polyhedron_is_drawn_with_its_faces() {
    let paper = |image: &Image| image.pixel(270, 196) == [255; 4];
    let (drawn, record) = cube(8.0);
    assert!(paper(&seen(&drawn, Vec::new())), "nothing is known of faces");
    assert!(!paper(&seen(&drawn, vec![record.clone()])));
    let (_, hollow) = cube(3.0);
    assert!(paper(&seen(&drawn, vec![hollow])), "a hull of another volume is not the mesh");
    let larger = ClumpRecord { spheres: record.spheres[..7].to_vec(), ..record };
    assert!(paper(&seen(&drawn, vec![larger])), "another shape");
}

/// The page has the mesh of the shape, and says where a clump has it.
#[test]
fn a_page_has_the_mesh_of_a_polyhedron() {
    let (drawn, record) = cube(8.0);
    let solids = |record| {
        let mut page = Page::new(PageOptions::default());
        let layer = page.layer(Role::Grains, "run");
        page.clumps(layer, &[record]);
        page.push(layer, 0.0, &drawn).expect("whole");
        let layer = header(&page)["layers"][0].clone();
        let shape = layer["solids"][0].clone();
        // Two triangles of each of 6 sides, and two in each of two steps of 18 edges.
        let corners = shape["corners"].as_u64().map(|n| n as usize);
        (
            corners,
            layer["frames"][0]["solids"].is_number(),
            page.html().expect("written").contains("solid-vert"),
        )
    };
    assert_eq!(solids(record), (Some(3 * (12 + 4 * 18)), true, true));
    assert_eq!(solids(cube(3.0).1), (None, false, false));
}

/// What a page knows.
fn header(page: &Page) -> serde_json::Value {
    let html = page.html().expect("written");
    let header = html.split("id=\"header\">").nth(1).and_then(|s| s.split("</script>").next());
    serde_json::from_str(header.expect("there")).expect("JSON")
}

/// Clumps of four spheres without order, and grains between them.
fn heap() -> Table {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let (mut spheres, mut body) = (Vec::new(), Vec::new());
    for k in 0..500u32 {
        let middle = [next(), next(), next()];
        for n in 0..if k % 5 == 0 { 1 } else { 4 } {
            let [x, y, z] = middle.map(|m| m + 0.02 * next());
            body.push(spheres.len() as u32 - n);
            spheres.push([x, y, z, 0.02 + 0.004 * next()]);
        }
    }
    table(&spheres, &vec![0.5; body.len()], Some(&body))
}

#[test]
fn clumps_are_the_same_bits_on_any_number_of_threads() {
    let draw = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let heap = heap();
        let (cube, record) = cube(8.0);
        pool.install(|| [seen(&heap, Vec::new()), seen(&cube, vec![record.clone()])])
    };
    let once = draw(1);
    assert!(once == draw(2) && once == draw(3));
}

/// Also of columns that a film keeps.
#[test]
fn a_clump_counts_as_one() {
    let count = GrainCount::of(&heap());
    assert_eq!(count.to_string(), "400 clumps of 1 600 spheres, 100 spheres");
    assert_eq!(GrainCount::of(&picture::needed(heap(), Some("load"))), count);
    let mut page = Page::new(PageOptions::default());
    let layer = page.layer(Role::Grains, "run");
    page.push(layer, 0.0, &heap()).expect("whole");
    assert_eq!(page.grains(), count);
    let html = page.html().expect("written");
    assert!(html.contains("\"clumps\":400") && html.contains("\"members\":1600"));
}

/// 1000 grains in a cube, and some that fell 1 km.
fn fallen(count: u32, body: bool) -> Table {
    let at = |i: u32| [i % 10, i / 10 % 10, i / 100].map(|k| f64::from(k) * 0.1);
    let mut spheres: Vec<[f64; 4]> = (0..1000).map(at).map(|[x, y, z]| [x, y, z, 0.05]).collect();
    spheres.extend((0..count).map(|k| [f64::from(k) * 0.01, 0.5, -1e3, 0.05]));
    let load = vec![0.5; spheres.len()];
    let bodies: Vec<u32> = (0..1000 + count).map(|id| id.min(1000)).collect();
    table(&spheres, &load, body.then_some(&bodies))
}

/// A picture as a camera that the program places sees it, or one from a given place.
fn framed(table: &Table, camera: &str) -> (usize, [usize; 2]) {
    let part = DrawnTable { role: Role::Grains, name: "heap".into(), table, kinds: vec![], clumps: vec![] };
    let camera = camera.parse().expect("known");
    let options = PictureOptions { width: 600, height: 400, camera, ..PictureOptions::default() };
    let image = picture::draw(&[part], &[], &options).expect("drawn");
    let inked = (0..400).filter(|y| (200..400).any(|x| image.pixel(x, *y) != [255; 4])).count();
    (inked, image.outside)
}

/// The 30 spheres of the clump that fell are 3 % of all spheres, and one grain of 1001.
#[test]
fn a_clump_that_fell_off_does_not_shrink_the_picture_and_is_counted() {
    let (inked, outside) = framed(&fallen(30, true), "front");
    assert!((300..396).contains(&inked), "{inked} of 400 rows");
    assert_eq!(outside, [1, 1001]);
    assert_eq!(framed(&fallen(3, false), "front").1, [3, 1003]);
    assert_eq!(framed(&fallen(0, false), "front").1, [0, 1000]);
    assert_eq!(framed(&fallen(3, false), "0,-3,0").1, [0, 1003], "the place of the camera was chosen");
}

/// The page knows where strays are, so that a key shows them; it has nothing of it where there is none.
#[test]
fn a_page_reaches_strays() {
    let strays = |count| {
        let mut page = Page::new(PageOptions::default());
        let layer = page.layer(Role::Grains, "run");
        page.push(layer, 0.0, &fallen(count, false)).expect("whole");
        let header = header(&page);
        let lowest = |places: &serde_json::Value| {
            let all = places.as_array().expect("places").iter().filter_map(|p| p[2].as_f64());
            all.fold(f64::INFINITY, f64::min)
        };
        [lowest(&header["layers"][0]["outline"]), lowest(&header["layers"][0]["strays"])]
    };
    let [outline, with_strays] = strays(3);
    assert!(outline > -0.1 && with_strays < -1e3, "{outline} {with_strays}");
    assert_eq!(strays(0)[1], f64::INFINITY);
}
