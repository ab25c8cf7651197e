//! The page as text: whole in itself, small enough, and honest about what it left out.

use stream::{Table, Values};
use view::{Page, PageOptions, Role};

fn grains(count: usize, time: f64) -> Table {
    let mut table = Table::default();
    let wave = |f: f64| (0..count).map(|i| (f * i as f64 + time).sin()).collect::<Vec<f64>>();
    for (name, f) in [("x", 0.1), ("y", 0.3), ("z", 0.7), ("vx", 0.2), ("vy", 0.4), ("vz", 0.9)] {
        table.push(name, Values::F64(wave(f))).expect("fits");
    }
    table.push("radius", Values::F64(vec![0.01; count])).expect("fits");
    table.push("id", Values::U32((0..count as u32).collect())).expect("fits");
    table
}

fn page(frames: usize, options: PageOptions) -> Page {
    let mut page = Page::new(options);
    let layer = page.layer(Role::Grains, "run.mcap");
    for k in 0..frames {
        let time = k as f64 * 0.01;
        page.push(layer, time, &grains(1000, time)).expect("whole");
    }
    page
}

#[test]
fn the_page_asks_for_nothing_outside_itself() {
    let html = page(3, PageOptions::default()).html().expect("written");
    for word in ["http:", "https:", "src=", "@import", "url(", "fetch(", "import("] {
        assert!(!html.contains(word), "{word}");
    }
    assert!(html.contains("default-src 'none'"));
}

#[test]
fn a_title_cannot_break_out_of_the_page() {
    let title = "</script><script>alert(1)</script>".to_owned();
    let html = page(1, PageOptions { title, ..PageOptions::default() }).html().expect("written");
    assert!(!html.contains("<script>alert"));
}

#[test]
fn a_long_run_is_thinned_evenly_below_the_limit_and_keeps_its_end() {
    let page = page(100, PageOptions { most_bytes: 200_000, ..PageOptions::default() });
    let (kept, html) = (page.kept(), page.html().expect("written"));
    assert!(kept.given == 100 && kept.stride > 1 && kept.kept > 5 && kept.kept < 100, "{kept:?}");
    assert!(html.len() < 280_000, "{}", html.len());
    let header =
        html.split("id=\"header\">").nth(1).and_then(|s| s.split("</script>").next()).expect("there");
    let header: serde_json::Value = serde_json::from_str(header).expect("JSON");
    let times: Vec<f64> = header["layers"][0]["frames"]
        .as_array()
        .expect("frames")
        .iter()
        .filter_map(|f| f["time"].as_f64())
        .collect();
    assert_eq!((times[0], times[times.len() - 1]), (0.0, 0.99));
    let gaps: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).collect();
    assert!(gaps[..gaps.len() - 1].iter().all(|g| (g - gaps[0]).abs() < 1e-9), "{gaps:?}");
}

#[test]
fn same_page_each_time() {
    let write = || page(5, PageOptions::default()).html().expect("written");
    assert_eq!(write(), write());
}

#[test]
fn an_empty_page_and_an_unknown_colour_are_refused() {
    assert!(
        Page::new(PageOptions::default()).html().expect_err("empty").to_string().contains("nothing to show")
    );
    let options = PageOptions { colour: Some("warmth".into()), ..PageOptions::default() };
    let message = page(1, options).html().expect_err("unknown").to_string();
    assert!(message.contains("'warmth'") && message.contains("speed"), "{message}");
}

#[test]
fn frames_and_layers_without_grains_are_numbers_too() {
    let mut page = Page::new(PageOptions::default());
    let (run, none) = (page.layer(Role::Grains, "run.mcap"), page.layer(Role::Walls, "walls"));
    page.push(run, 0.0, &grains(0, 0.0)).expect("empty");
    page.push(run, 0.1, &grains(10, 0.1)).expect("whole");
    page.push(none, 0.0, &grains(0, 0.0)).expect("empty");
    let html = page.html().expect("written");
    let header =
        html.split("id=\"header\">").nth(1).and_then(|s| s.split("</script>").next()).expect("there");
    let header: serde_json::Value = serde_json::from_str(header).expect("JSON");
    let layers = header["layers"].as_array().expect("layers");
    assert_eq!(layers.len(), 1);
    let numbers =
        |v: &serde_json::Value| v.as_array().is_some_and(|a| a.iter().all(serde_json::Value::is_number));
    assert!(
        layers[0]["frames"]
            .as_array()
            .expect("frames")
            .iter()
            .all(|f| numbers(&f["lo"]) && numbers(&f["hi"]))
    );
    assert!(numbers(&header["lo"]) && numbers(&layers[0]["fields"][0]["shown"]));
}
