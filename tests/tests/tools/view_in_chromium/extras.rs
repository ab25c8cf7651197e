//! Bonds, cracks, arrows, size classes and diagrams in the page.

use super::chromium::{self, Chromium};
use super::{FRAMES, GRAINS, columns, grains};
use geom::Plane;
use serde_json::json;
use std::path::PathBuf;
use stream::{Table, Values};
use tempfile::TempDir;
use view::{Arrows, Diagram, DiagramCurve, Motion, Page, PageOptions, Role, SurfaceShape, WallSurface};

/// A rod from each of some grains along x.
fn rods(count: usize, length: f64, broken: Option<f64>) -> Table {
    let block = grains(0.0);
    let rows: Vec<u32> = (0..count as u32).collect();
    let some = block.select(&rows);
    let column = |name: &str| Values::F64(some.get(name).expect("there").to_f64());
    let mut all = vec![
        ("x", column("x")),
        ("y", column("y")),
        ("z", column("z")),
        ("radius", column("radius")),
        ("dx", Values::F64(vec![length; count])),
        ("dy", Values::F64(vec![0.0; count])),
        ("dz", Values::F64(vec![0.01; count])),
    ];
    all.extend(broken.map(|b| ("broken", Values::U8(vec![b as u8; count]))));
    columns(&all)
}

/// The block at rest, with bonds of which half break at the end, arrows, a floor below and two diagrams.
fn page(time: f64) -> (TempDir, PathBuf) {
    let mut page = Page::new(PageOptions { time: Some(time), ..PageOptions::default() });
    let run = page.layer(Role::Grains, "grains (run.mcap)");
    let bonds = page.layer(Role::Bonds, "bonds (run.mcap)");
    let arrows = page.layer(Role::Arrows(Arrows::Velocity), "velocity (run.mcap)");
    for frame in 0..FRAMES {
        let time = frame as f64 * 0.01;
        page.push(run, time, &grains(0.0)).expect("a whole table");
        let broken = if frame + 1 == FRAMES { 1.0 } else { 0.0 };
        page.push(bonds, time, &rods(700, 0.005, Some(broken))).expect("a whole table");
        page.push(arrows, time, &rods(40, 2.0, None)).expect("a whole table");
    }
    let plane = Plane::new([0.0, 0.0, -0.1].into(), [0.0, 0.0, 1.0].into()).expect("a direction");
    page.surface(WallSurface {
        name: "floor".into(),
        shape: SurfaceShape::Plane(plane),
        motion: Motion::default(),
    });
    let points = |factor: f64| (0..FRAMES).map(|k| [0.01 * k as f64, factor * k as f64]).collect();
    let curve = |name: &str, factor| DiagramCurve { name: name.into(), points: points(factor) };
    page.diagrams(vec![
        Diagram { label: "kinetic energy [J]".into(), curves: vec![curve("", 2.0)] },
        Diagram { label: "force on walls [N]".into(), curves: vec![curve("lid", 1.0), curve("floor", -3.0)] },
    ]);
    chromium::written("extras.html", &page)
}

fn sum(browser: &mut Chromium) -> serde_json::Value {
    browser.value("grainpipe.pixels().sum")
}

#[test]
fn bonds_arrows_and_sizes_are_drawn_and_can_be_hidden() {
    let Some(mut browser) = Chromium::showing(|| page(0.0)) else { return };
    let all = sum(&mut browser);
    let mut without = Vec::new();
    for name in ["bonds", "velocity"] {
        let box_ = format!(
            "[...document.querySelectorAll('#layers label')].find((l) => l.textContent.startsWith('{name}')).querySelector('input')"
        );
        browser.value(&format!("{box_}.click()"));
        without.push(sum(&mut browser));
        browser.value(&format!("{box_}.click()"));
        assert_eq!(sum(&mut browser), all, "{name} again");
    }
    assert!(without.iter().all(|s| *s != all) && without[0] != without[1], "{without:?} {all}");
    // Whole bonds, then cracks; grains stay where they are.
    let count = "document.getElementById('count').textContent";
    assert!(
        browser
            .value(count)
            .as_str()
            .is_some_and(|t| t.contains("700 bonds, 0 broken") && t.contains("50 %"))
    );
    browser.value(&format!("grainpipe.show({})", FRAMES - 1));
    assert_ne!(sum(&mut browser), all, "cracks look like bonds");
    assert!(browser.value(count).as_str().is_some_and(|t| t.contains("0 bonds, 700 broken")));
    let legend = "document.getElementById('legend').textContent";
    assert!(browser.value(legend).as_str().is_some_and(|t| t.contains("bondcrack")));
    let arrow = browser.value("document.getElementById('arrow').textContent");
    assert_eq!(arrow, json!("velocity 2 m/s"));
    // Two sizes, by turns.
    browser.value("grainpipe.colour('size')");
    assert!(browser.value(legend).as_str().is_some_and(|t| t.starts_with("size8 mm10 mm")));
    let by_size = sum(&mut browser);
    browser.value("grainpipe.colour('speed')");
    assert_ne!(sum(&mut browser), by_size);
    assert_eq!(browser.value("grainpipe.drawn"), json!(GRAINS), "rods are no spheres");
    assert_eq!(browser.value("grainpipe.glError"), json!(0));
    assert!(browser.problems().is_empty(), "{:?}", browser.problems());
}

#[test]
fn diagrams_follow_the_frame_and_choose_it() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page(0.0);
    let mut browser = Chromium::start(&program, &["--window-size=1280,900"]);
    browser.show(&file);
    let values =
        "[...document.querySelectorAll('#plots p')].map((p) => p.textContent.replace(/\\s+/g, ' ').trim())";
    browser.value("grainpipe.show(3); grainpipe.pixels(); redraw(1, false)");
    assert_eq!(browser.value(values), json!(["6", "lid 3 floor −9"]));
    browser.value("grainpipe.show(11); redraw(1, false)");
    assert_eq!(browser.value(values), json!(["22", "lid 11 floor −33"]));
    // A press in the middle of the first one shows the middle.
    browser.value(
        "(() => { const s = document.querySelector('#plots svg'); const a = s.getBoundingClientRect(); \
         s.setPointerCapture = () => {}; s.dispatchEvent(new PointerEvent('pointerdown', { clientX: a.left + \
         a.width * (44 + 104) / 258, clientY: a.top + 5, pointerId: 1 })); })()",
    );
    assert_eq!(browser.value("grainpipe.frame"), json!(5));
    // What is seen is beside them, and G hides them.
    let leftmost = "Math.min(...run.layers[0].outline.map((p) => seenAt(minus3(p, middle)).x))";
    let edge = "document.getElementById('plots').getBoundingClientRect().right";
    assert_eq!(browser.value(&format!("{leftmost} > {edge}")), json!(true));
    browser.value("dispatchEvent(new KeyboardEvent('keydown', { key: 'g' }))");
    assert_eq!(browser.value("document.getElementById('plots').hidden"), json!(true));
    assert!(browser.problems().is_empty(), "{:?}", browser.problems());
}

/// A floor goes on for ever: it does not decide how near the eye stands.
#[test]
fn a_floor_does_not_push_the_grains_into_a_corner() {
    let Some(program) = chromium::find() else { return grainpipe_tests::skip("chromium") };
    let (_folder, file) = page(0.0);
    let mut browser = Chromium::start(&program, &["--window-size=700,500"]);
    browser.show(&file);
    let share = browser.value(
        "(() => { const y = run.layers[0].outline.map((p) => seenAt(minus3(p, middle)).y); \
         return (Math.max(...y) - Math.min(...y)) / innerHeight; })()",
    );
    assert!(share.as_f64().is_some_and(|share| share > 0.7), "{share} of the window's height");
}

/// A frame is written at the end of a step, a little late: the one meant by a time is the nearest.
#[test]
fn the_frame_nearest_to_the_time_asked_for_is_shown_first() {
    let Some(mut browser) = Chromium::showing(|| page(0.0299)) else { return };
    assert_eq!(browser.value("[grainpipe.frame, grainpipe.playing]"), json!([3, false]));
}
