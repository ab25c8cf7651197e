//! What an engineer does to the page of a run, with mouse, keys and fingers: it answers with the run's own numbers.

use super::chromium::{self, Chromium};
use serde_json::{Value, json};
use std::path::PathBuf;
use stream::{Table, Values};
use tempfile::TempDir;
use view::{Page, PageOptions, Role};

/// Grains along x, y and z.
const SIDES: [usize; 3] = [10, 8, 12];
/// Distance of neighbours [m].
const STEP: f64 = 0.02;
/// Frames, and the time between them [s].
const FRAMES: usize = 6;
const GAP: f64 = 0.1;

/// A grain as the run has it.
#[derive(Clone, Copy)]
struct Grain {
    id: u32,
    place: [f64; 3],
    velocity: [f64; 3],
    radius: f64,
}

/// All grains at a time [s]: a block that slides along x, the higher the faster; ids beyond 16 bits.
fn grains(time: f64) -> Vec<Grain> {
    let count = SIDES.iter().product::<usize>();
    let grain = |n: usize| {
        let cell = [n % SIDES[0], n / SIDES[0] % SIDES[1], n / SIDES[0] / SIDES[1]].map(|c| c as f64);
        let velocity = [0.05 * (1.0 + cell[2]), 0.001 * n as f64, 0.0];
        let place = [0, 1, 2].map(|k| STEP * cell[k] + velocity[k] * time);
        Grain { id: 70_001 * n as u32 + 5, place, velocity, radius: 0.008 + 1e-6 * n as f64 }
    };
    (0..count).map(grain).collect()
}

/// The frame's rows in an order of their own, and in the last frame without grain 0.
fn table(frame: usize) -> Table {
    let mut rows = grains(frame as f64 * GAP);
    if frame + 1 == FRAMES {
        rows.remove(0);
    }
    let half = rows.len() * frame / FRAMES;
    rows.rotate_left(half);
    let mut table = Table::default();
    let mut push = |name: &str, values: Values| table.push(name, values).expect("as many rows");
    for (k, [place, velocity]) in [["x", "vx"], ["y", "vy"], ["z", "vz"]].into_iter().enumerate() {
        push(place, Values::F64(rows.iter().map(|g| g.place[k]).collect()));
        push(velocity, Values::F64(rows.iter().map(|g| g.velocity[k]).collect()));
    }
    push("radius", Values::F64(rows.iter().map(|g| g.radius).collect()));
    push("id", Values::U32(rows.iter().map(|g| g.id).collect()));
    table
}

fn page() -> (TempDir, PathBuf) {
    let mut page = Page::new(PageOptions { time: Some(0.0), ..PageOptions::default() });
    let run = page.layer(Role::Grains, "grains (block.mcap)");
    for frame in 0..FRAMES {
        page.push(run, frame as f64 * GAP, &table(frame)).expect("a whole table");
    }
    chromium::written("block.html", &page)
}

/// Where a place is seen in the window [pixel].
fn pixel(browser: &mut Chromium, place: [f64; 3]) -> [f64; 2] {
    let [x, y, z] = place;
    let seen = browser.value(&format!(
        "(() => {{ const s = seenAt(minus3([{x}, {y}, {z}], middle)); return [s.x, s.y]; }})()"
    ));
    [0, 1].map(|k| seen[k].as_f64().expect("a number"))
}

/// The value of a field of what is picked.
fn field(picked: &Value, name: &str) -> f64 {
    let fields = picked["values"].as_array().expect("a list");
    let found = fields.iter().find(|f| f["name"] == name).unwrap_or_else(|| panic!("no {name} in {picked}"));
    found["value"].as_f64().expect("a number")
}

/// Picks a grain by the mouse and compares all that the page says of it with the run.
fn picks(browser: &mut Chromium, grain: Grain) {
    let at = pixel(browser, grain.place);
    browser.click(at);
    let picked = browser.value("grainpipe.picked");
    assert_eq!(picked["id"], json!(grain.id), "another grain than was clicked: {picked}");
    agrees(browser, &picked, grain);
}

fn agrees(browser: &mut Chromium, picked: &Value, grain: Grain) {
    let bound = browser.number("run.positionError") * (1.0 + 1e-9);
    let speed = grain.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
    let expected =
        [("vx", grain.velocity[0]), ("vy", grain.velocity[1]), ("speed", speed), ("radius", grain.radius)];
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        assert!((field(picked, name) - grain.place[k]).abs() <= bound, "{name}: {picked}");
    }
    for (name, value) in expected {
        let bound = browser.number(&format!(
            "errorOf(frameAt(run.layers[0], clock[state.frame]).fields[fieldOf(run.layers[0], '{name}')])"
        ));
        assert!((field(picked, name) - value).abs() <= bound + 1e-12, "{name}: {value} +- {bound}: {picked}");
    }
}

/// The grain nearest to the eye: the corner of the block that the first view looks at.
fn corner(time: f64) -> Grain {
    let n = (SIDES[2] - 1) * SIDES[0] * SIDES[1] + SIDES[0] - 1;
    grains(time)[n]
}

#[test]
fn a_click_reads_back_the_grain_and_the_camera_follows_it() {
    let Some(mut browser) = Chromium::showing(page) else { return };
    picks(&mut browser, corner(0.0));
    assert!(browser.text("byId('card').innerText").contains(&format!("Grain {}", corner(0.0).id)));
    // Not followed, it moves in the window; followed, it stays where it is seen.
    let before = pixel(&mut browser, corner(0.0).place);
    browser.value("grainpipe.show(3)");
    let moved = pixel(&mut browser, corner(3.0 * GAP).place);
    assert!((moved[0] - before[0]).hypot(moved[1] - before[1]) > 20.0, "{before:?} {moved:?}");
    let later = browser.value("grainpipe.picked");
    agrees(&mut browser, &later, corner(3.0 * GAP));
    browser.value("grainpipe.show(0)");
    browser.key("l");
    browser.value("grainpipe.show(3)");
    let kept = pixel(&mut browser, corner(3.0 * GAP).place);
    assert!((kept[0] - before[0]).hypot(kept[1] - before[1]) < 0.5, "{before:?} {kept:?}");
    browser.key("Escape");
    assert_eq!(browser.value("grainpipe.picked"), Value::Null);
    browser.assert_calm();
}

#[test]
fn a_grain_that_has_left_is_told_and_found_again() {
    let Some(mut browser) = Chromium::showing(page) else { return };
    browser.value("grainpipe.look('bottom')");
    browser.value("grainpipe.look('left')");
    browser.value("camera.look([-1, -1, -1]); fitView()");
    picks(&mut browser, grains(0.0)[0]);
    browser.value(&format!("grainpipe.show({})", FRAMES - 1));
    browser.value("grainpipe.pixels()");
    assert_eq!(browser.value("grainpipe.picked.values"), Value::Null);
    assert!(browser.text("byId('card').innerText").contains("Not in this frame"));
    browser.value("grainpipe.show(2)");
    let picked = browser.value("grainpipe.picked");
    agrees(&mut browser, &picked, grains(2.0 * GAP)[0]);
    browser.assert_calm();
}

/// What the slice takes away is neither drawn nor picked.
#[test]
fn a_slice_shows_and_picks_what_was_inside() {
    let Some(mut browser) = Chromium::showing(page) else { return };
    browser.value("grainpipe.look('front')");
    let whole = browser.value("grainpipe.pixels().sum");
    let at = pixel(&mut browser, grains(0.0)[5].place);
    browser.click(at);
    assert!(field(&browser.value("grainpipe.picked"), "y") < 0.5 * STEP);
    browser.key("Escape");
    browser.key("y");
    assert_ne!(browser.value("grainpipe.pixels().sum"), whole, "the slice changes nothing");
    let plane = browser.number("cutOf().most / cutOf().normal[1] + middle[1]");
    let middle = 0.5 * STEP * (SIDES[1] - 1) as f64;
    assert!((plane - middle).abs() < 0.6 * STEP, "through the middle of the grains: {plane}");
    browser.click(at);
    let inside = field(&browser.value("grainpipe.picked"), "y");
    assert!((inside - plane).abs() < STEP + 0.008, "{inside} at a slice at {plane}");
    browser.key("y");
    assert_eq!(browser.value("state.cutAxis"), json!(-1));
    browser.assert_calm();
}

/// The head, the legend and the player never stand before the drawing, or outside of the window.
#[test]
fn everything_has_its_place_on_a_screen_and_on_a_phone() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page();
    let mut browser = Chromium::start(&program, &[]);
    for (width, height, phone) in [(1280, 800, false), (480, 360, false), (390, 844, true), (844, 390, true)]
    {
        browser.window(width, height, phone);
        browser.show(&file);
        let of = |id: &str, side: &str| format!("byId('{id}').getBoundingClientRect().{side}");
        for id in ["head", "tools", "legend", "player", "ruler", "gnomon"] {
            let inside = format!(
                "{} >= 0 && {} >= 0 && {} <= innerWidth && {} <= innerHeight",
                of(id, "left"),
                of(id, "top"),
                of(id, "right"),
                of(id, "bottom")
            );
            assert_eq!(browser.value(&inside), json!(true), "{id} leaves a window of {width} x {height}");
        }
        let seen = "run.layers[0].outline.map((p) => seenAt(minus3(p, middle)))";
        let end = |of: &str, axis: &str| format!("Math.{of}(...{seen}.map((s) => s.{axis}))");
        let [top, left] = ["y", "x"].map(|axis| browser.number(&end("min", axis)));
        let bottom = browser.number(&end("max", "y"));
        let [below, beside] = ["bottom", "right"].map(|side| browser.number(&of("head", side)));
        assert!(top > below || left > beside, "the head covers the drawing at {width} x {height}");
        assert!(bottom < browser.number(&of("player", "top")), "the player covers it at {width} x {height}");
    }
    browser.assert_calm();
}

#[test]
fn fingers_turn_zoom_and_pick() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page();
    let mut browser = Chromium::start(&program, &[]);
    browser.window(390, 844, true);
    browser.show(&file);
    let at = pixel(&mut browser, corner(0.0).place);
    browser.touch(&[&[at]]);
    assert_eq!(browser.value("grainpipe.picked?.id"), json!(corner(0.0).id));
    let yaw = browser.number("camera.yaw");
    browser.touch(&[&[[200.0, 400.0]], &[[220.0, 400.0]], &[[260.0, 400.0]]]);
    assert!((browser.number("camera.yaw") - yaw).abs() > 0.1, "one finger turns");
    let far = browser.number("camera.distance");
    browser.touch(&[&[[180.0, 400.0], [220.0, 400.0]], &[[140.0, 400.0], [260.0, 400.0]]]);
    assert!(browser.number("camera.distance") < 0.6 * far, "two fingers apart come nearer");
    browser.assert_calm();
}

#[test]
fn light_and_dark_follow_the_system_until_told_otherwise() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page();
    let mut browser = Chromium::start(&program, &[]);
    for (scheme, dark) in [("light", false), ("dark", true)] {
        let features = json!({"features": [{"name": "prefers-color-scheme", "value": scheme}]});
        browser.call("Emulation.setEmulatedMedia", features);
        browser.show(&file);
        assert_eq!(browser.number("paper()[0]") < 0.5, dark, "{scheme}");
        browser.key("t");
        assert_eq!(browser.number("paper()[0]") > 0.5, dark, "T turns {scheme} round");
    }
    browser.assert_calm();
}

/// The list of keys opens by `?` and names every key that does something.
#[test]
fn the_keys_are_listed() {
    let Some(mut browser) = Chromium::showing(page) else { return };
    browser.key("?");
    assert_eq!(browser.value("byId('help').open"), json!(true));
    let listed = browser.text("byId('keys').innerText");
    let keys = browser.value("KEYS.filter(([name]) => name).map(([name]) => name)");
    for key in keys.as_array().expect("a list").iter().filter_map(Value::as_str) {
        assert!(listed.contains(key), "{key} is not in the list");
    }
    browser.value("byId('help').close()");
    browser.key("c");
    assert_ne!(browser.text("grainpipe.field"), "speed", "C colours by the next field");
    browser.assert_calm();
}

/// Size, frames and the cost of packing stand in the page.
#[test]
fn the_page_says_how_large_and_how_exact_it_is() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page();
    let mut browser = Chromium::start(&program, &[]);
    browser.show(&file);
    let size = std::fs::metadata(&file).expect("a file").len() as f64;
    let said = browser.number("run.bytes");
    assert!((said / size - 1.0).abs() < 0.01, "{said} of {size} bytes");
    let note = browser.text("byId('note').textContent");
    for part in
        [" kB; limit 60 MB", "All 6 frames", "Positions and radii are within", "whole numbers are exact"]
    {
        assert!(note.contains(part), "'{part}' is missing: {note}");
    }
}
