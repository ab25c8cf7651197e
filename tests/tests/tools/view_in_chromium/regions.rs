//! The page on which an operator draws regions: `cloud-crop` drops exactly what the page has marked.

use super::chromium::{self, Chromium};
use grainpipe_tests::tools::{line, succeed, tool};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;
use stream::{Table, Values};

const POINTS: usize = 20_000;

/// Height of a twentieth of the points [m], on which the lower end of a box will be typed.
const LEVEL: f64 = 8.25;

/// A cloud far from the origin, all of its places in 8-byte numbers; every tenth on a grid that drawn corners fall on.
fn cloud(folder: &Path) {
    let mut state = 1u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let offset = [1200.0, -340.0, 7.0];
    let mut places = Vec::new();
    for n in 0..POINTS {
        let place = [4.0 * random(), 3.0 * random(), 2.0 * random()];
        let at = |k: usize| if n % 10 == 0 { (place[k] * 1e4_f64).round() / 1e4 } else { place[k] };
        let mut place = [0, 1, 2].map(|k| offset[k] + at(k));
        if n % 20 == 0 {
            place[2] = LEVEL;
        }
        places.push(place);
    }
    let mut attributes = Table::default();
    attributes.push("number", Values::U32((0..POINTS as u32).collect())).expect("as many");
    let cloud = cloud::Cloud {
        points: places.iter().map(|p| geom::Vec3::from(*p)).collect(),
        attributes,
        double: true,
        ..cloud::Cloud::default()
    };
    let mut file = std::fs::File::create(folder.join("a scan.ply")).expect("created");
    cloud::write_ply(&mut file, &cloud, stream::ply::Encoding::BinaryLittleEndian).expect("written");
}

/// The page of the cloud, opened.
fn drawing(program: &Path, folder: &Path) -> Chromium {
    cloud(folder);
    opened(program, folder)
}

/// The page of what is there.
fn opened(program: &Path, folder: &Path) -> Chromium {
    succeed(folder, "dem-view", &["a scan.ply", "--pick", "-o", "pick.html"]);
    let mut browser = Chromium::start(program, &[]);
    browser.window(1000, 700, false);
    let downloads = json!({"behavior": "allow", "downloadPath": folder});
    browser.call("Page.setDownloadBehavior", downloads);
    browser.show(&folder.join("pick.html"));
    browser
}

/// Runs `cloud-crop` with the page's options; the points that are gone must be those that the page marked.
fn drops_what_is_marked(browser: &mut Chromium, folder: &Path) -> usize {
    let options = browser.text("byId('options').value");
    let done = line(folder, &format!("cloud-crop 'a scan.ply' {options} -o out.ply"));
    assert_eq!(done.code, 0, "{options}: {}", done.stderr);
    let left = cloud::read(std::fs::File::open(folder.join("out.ply")).expect("written")).expect("a cloud");
    let left: BTreeSet<u32> =
        left.attributes.get("number").expect("kept").to_f64().into_iter().map(|n| n as u32).collect();
    let marked = browser.value("grainpipe.regions.dropped");
    let marked: BTreeSet<u32> =
        marked.as_array().expect("a list").iter().filter_map(Value::as_u64).map(|n| n as u32).collect();
    let gone: BTreeSet<u32> = (0..POINTS as u32).filter(|n| !left.contains(n)).collect();
    assert!(!gone.is_empty() && !left.is_empty(), "{options}: nothing to tell apart");
    assert_eq!(gone, marked, "{options}");
    let told = browser.text("byId('sum').textContent").replace('\u{202f}', "");
    assert!(told.starts_with(&format!("{} of {POINTS} points", gone.len())), "{told}");
    gone.len()
}

/// Saves the files by the button, as an operator does, and waits until they are there.
fn save(browser: &mut Chromium, folder: &Path, files: &[&str]) {
    browser.value("byId('files').click()");
    for file in files {
        for _ in 0..200 {
            if folder.join(file).exists() {
                break;
            }
            browser.value("1");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        assert!(folder.join(file).exists(), "{file} was not saved");
    }
}

#[test]
fn cloud_crop_drops_exactly_what_the_page_marks() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = drawing(&program, folder.path());
    // A box from the top, narrowed along the view.
    browser.value("[...byId('sides').children].find((b) => b.textContent === 'top').click()");
    browser.value("byId('box').click()");
    browser.drag([520.0, 300.0], [640.0, 420.0]);
    let all = drops_what_is_marked(&mut browser, folder.path());
    browser.value(
        "(() => { const i = document.querySelector('.depth input'); i.value = '8.25'; i.onchange(); })()",
    );
    let part = drops_what_is_marked(&mut browser, folder.path());
    assert!(part < all, "{part} of {all}");
    // A polygon with a notch from the right, closed at its first corner.
    browser.value(
        "byId('polygon').click(); [...byId('sides').children].find((b) => b.textContent === 'right').click()",
    );
    let corners =
        [[480.0, 260.0], [700.0, 270.0], [690.0, 430.0], [610.0, 330.0], [500.0, 440.0], [481.0, 261.0]];
    for corner in corners {
        browser.click(corner);
    }
    assert_eq!(browser.value("regions.list.length"), json!(2));
    save(&mut browser, folder.path(), &["a scan-region-1.json"]);
    let both = drops_what_is_marked(&mut browser, folder.path());
    assert!(both > part, "{both} with the polygon, {part} without");
    // To keep one and to remove the other.
    browser.value("(() => { const s = document.querySelectorAll('#regions select')[1]; s.value = 'keep'; s.onchange(); })()");
    assert!(drops_what_is_marked(&mut browser, folder.path()) > both);
    browser.assert_calm();
}

/// What a rule has marked is red from the start; what is drawn over it comes back.
#[test]
fn marks_are_shown_and_restored() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    cloud(folder);
    let largest = ["a scan.ply", "--largest", "0.1", "--mark", "-o", "marked.ply", "--report", "marked.json"];
    succeed(folder, "cloud-crop", &largest);
    std::fs::rename(folder.join("marked.ply"), folder.join("a scan.ply")).expect("renamed");
    let mut browser = opened(&program, folder);
    let before = drops_what_is_marked(&mut browser, folder);
    assert_eq!(browser.value("byId('command').hidden"), json!(true));
    browser.value("[...byId('sides').children].find((b) => b.textContent === 'top').click()");
    browser.value("byId('box').click()");
    browser.drag([520.0, 300.0], [640.0, 420.0]);
    assert!(browser.text("byId('options').value").starts_with("--restore box:"));
    let less = drops_what_is_marked(&mut browser, folder);
    assert!(less < before, "{less} of {before}");
    // To remove all in the box instead: more goes than was marked.
    browser.value("(() => { const s = document.querySelector('#regions select'); s.value = 'remove'; s.onchange(); })()");
    assert!(drops_what_is_marked(&mut browser, folder) > before);
    browser.assert_calm();
}

/// Corners are taken back, and a drawing without area is none.
#[test]
fn a_drawing_can_be_taken_back() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let folder = tempfile::tempdir().expect("a folder");
    let mut browser = drawing(&program, folder.path());
    browser.key("p");
    assert_eq!(browser.value("[camera.flat, regions.drawing.tool]"), json!([true, "polygon"]));
    for corner in [[500.0, 300.0], [600.0, 300.0], [600.0, 400.0]] {
        browser.click(corner);
    }
    browser.key("Backspace");
    browser.key("Enter");
    assert!(browser.text("byId('hint').textContent").contains("no area"));
    assert_eq!(browser.value("regions.list.length"), json!(0));
    let yaw = browser.number("camera.yaw");
    browser.key("ArrowLeft");
    assert_eq!(browser.number("camera.yaw"), yaw, "the view rests while one draws");
    browser.key("Escape");
    assert_eq!(browser.value("regions.drawing"), Value::Null);
    browser.key("ArrowLeft");
    assert_ne!(browser.number("camera.yaw"), yaw);
    assert_eq!(browser.value("byId('command').hidden"), json!(true));
    browser.assert_calm();
}

/// Faces of a PLY are triangles on the page; with --pick its vertices are a cloud.
#[test]
fn a_mesh_is_drawn_as_triangles_and_a_run_has_no_regions() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                element face 4\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    std::fs::write(folder.path().join("stone.ply"), mesh).expect("written");
    succeed(folder.path(), "dem-view", &["stone.ply", "-o", "stone.html", "--report", "stone.json"]);
    let report = std::fs::read_to_string(folder.path().join("stone.json")).expect("written");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["layers"][0]["triangles"], json!(4));
    succeed(folder.path(), "dem-view", &["stone.ply", "-o", "pick.html", "--pick"]);
    std::fs::write(folder.path().join("run.mcap"), b"\x89MCAP0\r\n").expect("written");
    let refused = tool(folder.path(), "dem-view", &["run.mcap", "--pick", "-o", "x.html"]);
    assert!(refused.code == 1 && refused.stderr.contains("--pick needs a cloud"), "{}", refused.stderr);
    let refused = tool(folder.path(), "dem-view", &["stone.ply", "stone.ply", "--pick", "-o", "x.html"]);
    assert!(refused.code == 2 && refused.stderr.contains("one cloud"), "{}", refused.stderr);
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let mut browser = Chromium::start(&program, &[]);
    browser.window(800, 600, false);
    browser.show(&folder.path().join("stone.html"));
    assert_eq!(browser.value("[run.layers.length, run.surfaces.length]"), json!([0, 1]));
    let pixels = browser.value("grainpipe.pixels()");
    let share = |of: &str| pixels[of].as_f64().expect("a number");
    assert!(share("covered") > 0.1 * share("width") * share("height"), "{pixels}");
    let seen = browser.value("(({x, y}) => [x, y])(seenAt(minus3([0.33, 0.33, 0.34], middle)))");
    browser.click([0, 1].map(|k| seen[k].as_f64().expect("a number")));
    assert!(browser.text("byId('card').innerText").contains("stone.ply"));
    let place = browser.value("grainpipe.picked.place");
    let on = [0, 1, 2].map(|k| place[k].as_f64().expect("a number"));
    let off =
        [on[0], on[1], on[2], 1.0 - on.iter().sum::<f64>()].map(f64::abs).into_iter().fold(1.0, f64::min);
    assert!(off < 1e-6, "{place} is not on the stone");
    browser.assert_calm();
}
