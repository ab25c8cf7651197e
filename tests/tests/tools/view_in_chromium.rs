//! The HTML page, opened from a file in a real browser: it draws, it plays, and it uses no network.

mod chromium;
mod clumps;
mod extras;
mod hands_on;
mod outlines;
mod regions;

use chromium::Chromium;
use serde_json::json;
use std::path::PathBuf;
use stream::{Table, Values};
use tempfile::TempDir;
use view::{Motion, Page, PageOptions, Role, SurfaceShape, WallSurface};

const GRAINS: usize = 1500;
const WALLS: usize = 400;
const FRAMES: usize = 12;

fn columns(columns: &[(&str, Values)]) -> Table {
    let mut table = Table::default();
    for (name, values) in columns {
        table.push(name, values.clone()).expect("columns of one length");
    }
    table
}

/// Grains in a block that falls by `fall` [m].
fn grains(fall: f64) -> Table {
    let along =
        |step: usize, count: usize| (0..GRAINS).map(move |i| ((i / step) % count) as f64 * 0.01).collect();
    let z: Vec<f64> = (0..GRAINS).map(|i| (i / 100) as f64 * 0.01 - fall).collect();
    let speed: Vec<f64> = (0..GRAINS).map(|i| i as f64 / GRAINS as f64).collect();
    columns(&[
        ("x", Values::F64(along(1, 10))),
        ("y", Values::F64(along(10, 10))),
        ("z", Values::F64(z)),
        ("radius", Values::F64((0..GRAINS).map(|i| 0.004 + 0.001 * (i % 2) as f64).collect())),
        ("vx", Values::F64(vec![0.0; GRAINS])),
        ("vy", Values::F64(vec![0.0; GRAINS])),
        ("vz", Values::F64(speed)),
        ("id", Values::U32((0..GRAINS as u32).collect())),
        ("material", Values::U16((0..GRAINS).map(|i| (i % 3) as u16).collect())),
    ])
}

fn floor() -> Table {
    let place = |i: usize, step: usize| ((i / step) % 20) as f64 * 0.01 - 0.05;
    columns(&[
        ("x", Values::F64((0..WALLS).map(|i| place(i, 1)).collect())),
        ("y", Values::F64((0..WALLS).map(|i| place(i, 20)).collect())),
        ("z", Values::F64(vec![-0.2; WALLS])),
        ("radius", Values::F64(vec![0.006; WALLS])),
    ])
}

/// A page of a falling block over a floor, in a separate folder.
fn page() -> (TempDir, PathBuf) {
    let mut page = Page::new(PageOptions { title: "A block <falls>".into(), ..PageOptions::default() });
    let run = page.layer(Role::Grains, "run.mcap");
    page.kinds(run, vec!["sinter".into(), "coke".into(), "ore".into()]);
    for frame in 0..FRAMES {
        let time = frame as f64 * 0.01;
        page.push(run, time, &grains(1.2 * time)).expect("a whole table");
    }
    let walls = page.layer(Role::Walls, "walls.mcap");
    page.push(walls, 0.0, &floor()).expect("a whole table");
    chromium::written("a run.html", &page)
}

#[test]
fn the_page_draws_plays_and_asks_for_nothing() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page();
    let mut browser = Chromium::start(&program, &[]);
    browser.show(&file);
    plays(&mut browser);
    draws(&mut browser);
    settings(&mut browser);
    assert!(browser.problems().is_empty(), "{:?}", browser.problems());
    let requests = browser.requests();
    assert!(requests.len() == 1 && requests[0].starts_with("file://"), "{requests:?}");
}

/// It plays by itself, and stops when told.
fn plays(browser: &mut Chromium) {
    assert_eq!(browser.value("grainpipe.frames"), json!(FRAMES));
    assert_eq!(browser.value("grainpipe.playing"), json!(true));
    browser.value("window.first = grainpipe.frame");
    browser.wait_for("grainpipe.frame !== first");
    browser.value("document.getElementById('play').click()");
    assert_eq!(browser.value("grainpipe.playing"), json!(false));
}

/// The pixels on the canvas are those of the frame shown.
fn draws(browser: &mut Chromium) {
    let mut seen = |frame: usize| browser.value(&format!("grainpipe.show({frame}); grainpipe.pixels()"));
    let (first, last, again) = (seen(0), seen(FRAMES - 1), seen(0));
    let pixels = first["width"].as_f64().expect("a number") * first["height"].as_f64().expect("a number");
    let share = first["covered"].as_f64().expect("a number") / pixels;
    assert!((0.03..0.9).contains(&share), "grains and floor cover {share} of the picture");
    assert_ne!(first["sum"], last["sum"], "frames look the same");
    assert_eq!(first, again, "the same frame looks different");
    assert_eq!(browser.value("grainpipe.drawn"), json!(GRAINS + WALLS));
    assert_eq!(browser.value("grainpipe.glError"), json!(0));
}

/// Colour, walls and title do what they say.
fn settings(browser: &mut Chromium) {
    assert_eq!(browser.value("document.title"), json!("A block <falls>"));
    assert_eq!(browser.value("grainpipe.field"), json!("speed"));
    let before = browser.value("grainpipe.pixels().sum");
    browser.value("grainpipe.colour('material')");
    assert_ne!(browser.value("grainpipe.pixels().sum"), before, "another colour looks the same");
    let legend = browser.value("document.getElementById('legend').textContent");
    assert_eq!(legend, json!("materialsintercokeore"));
    browser.value("dispatchEvent(new KeyboardEvent('keydown', { key: 'w' }))");
    browser.value("grainpipe.pixels()");
    assert_eq!(browser.value("grainpipe.drawn"), json!(GRAINS));
}

/// A paddle that turns about z, shifts and shakes, in the JSON of a run.
fn motion() -> serde_json::Value {
    json!({"velocity": [0.05, 0.0, -0.1], "turn": [0.0, 3.0, 25.0], "through": [0.05, 0.05, 0.0],
           "amplitude": [0.0, 0.01, 0.0], "frequency": 7.0, "from": 0.01, "until": 0.06})
}

/// The page of the block, with a floor, and a paddle of mesh and one of wall spheres that move.
fn page_with_surfaces() -> (TempDir, PathBuf) {
    let mut page = Page::new(PageOptions { time: Some(0.0), ..PageOptions::default() });
    let run = page.layer(Role::Grains, "run.mcap");
    for frame in 0..FRAMES {
        page.push(run, frame as f64 * 0.01, &grains(0.0)).expect("a whole table");
    }
    let motion: Motion = serde_json::from_value(motion()).expect("whole");
    let mesh = json!({"mesh": {"vertices": [[-0.1, 0.05, 0.0], [0.2, 0.05, 0.0], [0.05, 0.05, 0.4]], "faces": [[0, 1, 2]]}});
    let plane = json!({"plane": {"point": [0, 0, -0.02], "normal": [0, 0, 1]}});
    for (name, shape, motion) in [("paddle", mesh, motion.clone()), ("floor", plane, Motion::default())] {
        let shape = SurfaceShape::read(&shape).expect("whole").expect("a surface");
        page.surface(WallSurface { name: name.into(), shape, motion });
    }
    let walls = page.layer(Role::Walls, "paddle");
    page.moves(walls, motion);
    page.push(walls, 0.0, &floor()).expect("a whole table");
    chromium::written("surfaces.html", &page)
}

/// Grains rest, so that all that changes in the picture is the wall.
#[test]
fn planes_and_meshes_are_drawn_move_hide_and_ask_for_nothing() {
    let Some(mut browser) = Chromium::showing(page_with_surfaces) else { return };
    let hidden = |browser: &mut Chromium, index: usize, frame: usize| {
        let boxes = "document.querySelectorAll('#layers input')";
        browser.value(&format!(
            "{boxes}.forEach((b, i) => {{ if (b.checked !== (i === 0 || i === {index})) b.click() }})"
        ));
        browser.value(&format!("grainpipe.show({frame}); grainpipe.pixels()"))["sum"].clone()
    };
    let bare = hidden(&mut browser, 0, 0);
    // Wall spheres, mesh, floor: each is seen, and only what moves changes.
    for (index, moves) in [(1, true), (2, true), (3, false)] {
        let [first, last] = [0, FRAMES - 1].map(|frame| hidden(&mut browser, index, frame));
        assert_ne!(first, bare, "layer {index} is not seen");
        assert_eq!(first != last, moves, "layer {index}");
    }
    browser.value("document.querySelectorAll('#layers input').forEach((b) => { if (!b.checked) b.click() })");
    browser.value("dispatchEvent(new KeyboardEvent('keydown', { key: 'w' })); grainpipe.show(0)");
    assert_eq!(browser.value("grainpipe.pixels().sum"), bare, "W hides all walls");
    assert_eq!(browser.value("grainpipe.glError"), json!(0));
    assert!(browser.problems().is_empty(), "{:?}", browser.problems());
    assert_eq!(browser.requests().len(), 1, "{:?}", browser.requests());
}

/// The page takes a wall to where engine and picture have it, which share one formula.
#[test]
fn a_wall_is_shown_where_the_engine_has_it() {
    let motion_of_wall: Motion = serde_json::from_value(motion()).expect("whole");
    let (time, home) = (0.07, geom::Vec3::new(0.31, -0.2, 0.13));
    let place = motion_of_wall.pose(time).position(&home);
    let Some(mut browser) = Chromium::showing(page_with_surfaces) else { return };
    let in_page = browser.value(&format!(
        "(() => {{ const p = poseOf({}, [0, 0, 0], {time}); return [0, 1, 2].map((k) => dot3([p.turn[k], p.turn[3 + k], \
         p.turn[6 + k]], [{}, {}, {}]) + p.shift[k] + middle[k]); }})()",
        motion(), home.x, home.y, home.z
    ));
    for k in 0..3 {
        assert!((in_page[k].as_f64().expect("a number") - place[k]).abs() < 1e-12, "{in_page} {place}");
    }
}

#[test]
fn without_webgl_the_page_says_so() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page();
    let mut browser = Chromium::start(&program, &["--disable-3d-apis"]);
    browser.open(&file);
    browser.wait_for("window.grainpipe?.ready === false");
    let message = browser.value("document.getElementById('missing').innerText");
    assert!(message.as_str().is_some_and(|m| m.contains("WebGL 2")), "{message}");
}

/// What the first test trusts: a request is seen when there is one.
#[test]
fn the_watch_sees_a_request() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let mut browser = Chromium::start(&program, &[]);
    browser.value("void (new Image().src = 'http://127.0.0.1:9/seen')");
    browser.wait_for("document.readyState === 'complete'");
    for _ in 0..100 {
        if browser.requests().iter().any(|url| url.ends_with("/seen")) {
            return;
        }
        browser.value("1");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    panic!("the request was not seen: {:?}", browser.requests());
}
