//! Clumps in the page: without creases, with the faces of a polyhedron; and the key that reaches strays.

use super::chromium::{self, Chromium};
use super::columns;
use record::ClumpRecord;
use std::path::PathBuf;
use stream::{Table, Values};
use tempfile::TempDir;
use view::{Page, PageOptions, Role};

/// Spheres x, y, z, r of one clump, or of grains.
fn table(spheres: &[[f64; 4]], clump: bool) -> Table {
    let axis = |k: usize| Values::F64(spheres.iter().map(|s| s[k]).collect());
    let ids: Vec<u32> = (0..spheres.len() as u32).collect();
    let body = if clump { vec![0; spheres.len()] } else { ids.clone() };
    let all = [("x", axis(0)), ("y", axis(1)), ("z", axis(2)), ("radius", axis(3))];
    let names = [("id", Values::U32(ids)), ("body", Values::U32(body))];
    columns(&all.into_iter().chain(names).collect::<Vec<_>>())
}

/// A page of them, seen along y.
fn page(spheres: &[[f64; 4]], clump: bool, shapes: &[ClumpRecord]) -> (TempDir, PathBuf) {
    let camera = "front".parse().expect("a view");
    let mut page = Page::new(PageOptions { camera, ..PageOptions::default() });
    let layer = page.layer(Role::Grains, "some");
    page.clumps(layer, shapes);
    page.push(layer, 0.0, &table(spheres, clump)).expect("a whole table");
    chromium::written("some.html", &page)
}

/// Colours along a line at the height of z = 0, from x = −1 to 1 in 200 steps.
const LINE: &str = "(() => { redraw(2, false); const p = new Uint8Array(4), out = []; for (let k = 0; k <= 200; k++) { \
    const s = seenAt(minus3([-1 + 0.01 * k, 0, 0], middle)); \
    gl.readPixels(Math.round(s.x), canvas.height - Math.round(s.y), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); out.push(p[0] + p[1] + p[2]); } return out; })()";

/// The largest step between neighbours of the line.
fn crease(browser: &mut Chromium) -> f64 {
    let line: Vec<f64> = browser
        .value(LINE)
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(serde_json::Value::as_f64)
        .collect();
    line.windows(2).map(|pair| (pair[0] - pair[1]).abs()).fold(0.0, f64::max)
}

#[test]
fn the_spheres_of_a_clump_have_no_creases_in_the_page() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let row = [[-1.0, 0.0, 0.0, 1.2], [0.0, 0.0, 0.0, 1.2], [1.0, 0.0, 0.0, 1.2]];
    let mut browser = Chromium::start(&program, &[]);
    let [clump, grains] = [true, false].map(|clump| {
        let (_folder, file) = page(&row, clump, &[]);
        browser.show(&file);
        browser.assert_calm();
        crease(&mut browser)
    });
    assert!(grains > 20.0 && clump < 0.5 * grains, "steps of {clump} in a clump, {grains} between grains");
}

#[test]
fn a_polyhedron_has_faces_that_can_be_picked() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let corner = |k: i32| [0, 1, 2].map(|n| if k >> n & 1 == 1 { 1.0 } else { -1.0 });
    let cube: Vec<[f64; 4]> = (0..8).map(corner).map(|[x, y, z]| [x, y, z, 0.1]).collect();
    let shape = ClumpRecord {
        centre: [0.0; 3],
        inertia: [1.0; 3],
        axes: None,
        material: 0,
        name: "cube".into(),
        scales: None,
        spheres: cube.clone(),
        volume: 8.0,
    };
    let mut browser = Chromium::start(&program, &[]);
    let found = [vec![], vec![shape]].map(|shapes| {
        let (_folder, file) = page(&cube, true, &shapes);
        browser.show(&file);
        let middle = browser.value(LINE)[100].as_f64().expect("a number");
        let before = "(() => { const s = seenAt(minus3([0, 0, 0], middle)); const ray = rayAt(s.x, s.y); \
            const hit = findAt(s.x, s.y); return hit ? -ray.from[1] - hit.depth * ray.along[1] - middle[1] : -1; })()";
        let before = browser.number(before);
        browser.assert_calm();
        (middle, before)
    });
    assert!(found[0].0 > 700.0 && found[0].1 == -1.0, "nothing between the corners: {found:?}");
    // The face is a radius before the corners.
    assert!(found[1].0 < 700.0 && (found[1].1 - 1.1).abs() < 0.01, "a face: {found:?}");
}

#[test]
fn fitting_once_more_reaches_strays() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let at = |i: u32| [i % 10, i / 10 % 10, i / 100].map(|k| f64::from(k) * 0.1);
    let mut spheres: Vec<[f64; 4]> = (0..1000).map(at).map(|[x, y, z]| [x, y, z, 0.05]).collect();
    spheres.push([0.0, 0.5, -40.0, 0.05]);
    let mut browser = Chromium::start(&program, &[]);
    let (_folder, file) = page(&spheres, false, &[]);
    browser.show(&file);
    let seen = "(() => { showCounts(); const s = seenAt(minus3([0, 0.5, -40], middle)); \
        return [s.y > 0 && s.y < innerHeight, byId('drawn').textContent]; })()";
    let words = "some grains are far from all others: F shows them";
    assert_eq!(browser.value(seen), serde_json::json!([false, words]));
    browser.value("fitView()");
    assert_eq!(browser.value(seen), serde_json::json!([true, ""]));
    browser.value("fitView()");
    assert_eq!(browser.value(seen), serde_json::json!([false, words]));
    browser.assert_calm();
}
