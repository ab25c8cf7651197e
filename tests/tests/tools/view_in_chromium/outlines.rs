//! What is drawn where: every pixel of two spheres that intersect, against the closed answer.

use super::chromium::{self, Chromium};
use std::path::PathBuf;
use stream::{Table, Values};
use tempfile::TempDir;
use view::{Camera, Page, PageOptions, Role};

/// Centres and radii [m] of materials 0 and 1, seen along y.
const SPHERES: [([f64; 3], f64); 2] = [([0.0, 0.0, 0.0], 1.0), ([0.8, -0.3, 0.2], 0.7)];

fn page() -> (TempDir, PathBuf) {
    let camera: Camera = "front".parse().expect("a view");
    let mut page =
        Page::new(PageOptions { colour: Some("material".into()), camera, ..PageOptions::default() });
    let layer = page.layer(Role::Grains, "two");
    let mut table = Table::default();
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        table.push(name, Values::F64(SPHERES.map(|(c, _)| c[k]).to_vec())).expect("two rows");
    }
    table.push("radius", Values::F64(SPHERES.map(|(_, r)| r).to_vec())).expect("two rows");
    table.push("material", Values::U16(vec![0, 1])).expect("two rows");
    page.push(layer, 0.0, &table).expect("a whole table");
    chromium::written("two.html", &page)
}

/// How far along a ray from `eye` sphere `n` is met; nothing when it is missed. And by how much of its radius it is
/// met or missed.
fn met(n: usize, eye: [f64; 3], along: [f64; 3]) -> (Option<f64>, f64) {
    let (centre, radius) = SPHERES[n];
    let to = [0, 1, 2].map(|k| centre[k] - eye[k]);
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let depth = dot(to, along);
    let aside = dot(to, to) - depth * depth;
    let inside = radius * radius - aside;
    ((inside >= 0.0).then(|| depth - inside.max(0.0).sqrt()), (aside.max(0.0).sqrt() - radius).abs() / radius)
}

/// Which material a ray meets first; nothing where the answer is too close to call for a pixel.
fn first(eye: [f64; 3], along: [f64; 3]) -> Option<&'static str> {
    let [(a, near_a), (b, near_b)] = [met(0, eye, along), met(1, eye, along)];
    if near_a < 0.03 || near_b < 0.03 {
        return None;
    }
    match (a, b) {
        (None, None) => Some("paper"),
        (Some(_), None) => Some("0"),
        (None, Some(_)) => Some("1"),
        (Some(a), Some(b)) if (a - b).abs() < 0.03 => None,
        (Some(a), Some(b)) => Some(if a < b { "0" } else { "1" }),
    }
}

/// The page's answer: which colour is on the picture at a grid of pixels, with the ray of each.
const LOOK: &str = r#"(() => {
  redraw(1, false);
  const [w, h] = [canvas.width, canvas.height];
  const data = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, data);
  const seen = [];
  for (let y = 4; y < h - 60; y += 7) for (let x = 4; x < w; x += 7) {
    const [r, g, b] = data.slice(4 * ((h - 1 - y) * w + x));
    const { from, along } = rayAt(x + 0.5, y + 0.5);
    const colour = Math.max(r, g, b) - Math.min(r, g, b) < 30 ? "paper" : b > r ? "0" : "1";
    seen.push([colour, from.map((c, k) => c + middle[k]), along]);
  }
  return seen;
})()"#;

fn agrees(browser: &mut Chromium, what: &str) {
    let seen = browser.value(LOOK);
    let mut counts = std::collections::BTreeMap::<String, usize>::new();
    for pixel in seen.as_array().expect("a list") {
        let vector = |part: usize| [0, 1, 2].map(|k| pixel[part][k].as_f64().expect("a number"));
        let Some(expected) = first(vector(1), vector(2)) else { continue };
        assert_eq!(pixel[0], expected, "{what}: {pixel}");
        *counts.entry(expected.to_owned()).or_default() += 1;
    }
    assert!(
        counts.get("0").is_some_and(|n| *n > 40) && counts.get("1").is_some_and(|n| *n > 40),
        "{what}: {counts:?}"
    );
}

#[test]
fn spheres_that_intersect_are_drawn_as_geometry_has_it() {
    let Some(mut browser) = Chromium::showing(page) else { return };
    assert!(browser.value("painter.most").as_f64().is_some_and(|most| most >= 64.0));
    agrees(&mut browser, "from the front");
    // Small ones, which are points, and such as reach out of the window.
    browser.value("painter.most = 1; changed()");
    agrees(&mut browser, "as triangles");
    browser.value("painter.most = 4096; changed()");
    if browser.number("gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1]") >= 512.0 {
        agrees(&mut browser, "as points");
    }
    browser.value("painter.most = 256; camera.flat = true; changed()");
    agrees(&mut browser, "in parallel projection");
    browser.value("camera.flat = false; camera.target = [1.4, 0.1, 0.3]; camera.distance = 4; camera.turn(0.3, 0.2); changed()");
    agrees(&mut browser, "half outside of the window");
    browser.assert_calm();
}

/// Cut through, a sphere shows a flat face where the plane is.
#[test]
fn a_sliced_sphere_has_a_flat_face() {
    let Some(mut browser) = Chromium::showing(page) else { return };
    browser.value("camera.flat = true; state.cutAxis = 1; state.cutSide = -1; state.cutAt = 0.5; showCut(); redraw(1, false)");
    let depth = "(() => { const s = cutOf(); return s.most * s.normal[1] + middle[1]; })()";
    let plane = browser.number(depth);
    let picked = browser.value("findAt(...(({x, y}) => [x, y])(seenAt(minus3([-0.5, 0, 0], middle))))");
    let front = browser.number("dot3(camera.eye(), camera.axes()[2]) + middle[1]");
    let met = front + picked["depth"].as_f64().expect("a number");
    assert!((met - plane).abs() < 1e-6, "picked on the face: {met} and {plane}");
    // Colours of a face do not change across it, those of a ball do.
    let shades = "(() => { redraw(1, false); const out = new Set(); const p = new Uint8Array(4); for (const x of [-0.6, -0.5, -0.4, -0.3]) { \
        const s = seenAt(minus3([x, 0, 0], middle)); gl.readPixels(Math.round(s.x), canvas.height - Math.round(s.y), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); \
        out.add(p.join()); } return out.size; })()";
    assert!(browser.number(shades) < 1.5, "a face of one shade");
    browser.value("state.cutAxis = -1; showCut()");
    assert!(browser.number(shades) > 2.5, "a ball of many");
    browser.assert_calm();
}

/// Many spheres become points by themselves, and the page says so.
#[test]
fn the_level_of_detail_is_chosen_and_told() {
    let Some(mut browser) = Chromium::showing(page) else { return };
    let chosen = |browser: &mut Chromium, count: &str, moving: bool| {
        browser.value(&format!("window.counted ??= painter.total; painter.total = () => {count}; [painter.asDots({moving}, 0), painter.total = counted][0]"))
            == serde_json::json!(true)
    };
    assert!(!chosen(&mut browser, "200000", true), "200 000 are spheres while they move");
    assert!(
        chosen(&mut browser, "1000000", true) && !chosen(&mut browser, "1000000", false),
        "a million are points while they move"
    );
    assert!(chosen(&mut browser, "3000000", false));
    assert_eq!(browser.text("byId('drawn').textContent"), "");
    browser.value(
        "byId('detail').value = 'points'; byId('detail').dispatchEvent(new Event('change')); redraw(1, true)",
    );
    assert_eq!(browser.text("byId('drawn').textContent"), "drawn as points");
    browser.assert_calm();
}
