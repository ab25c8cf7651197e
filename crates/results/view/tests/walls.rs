//! Walls coloured by what was done to them: which part has which colour, at which time, wherever the wall has moved to.

use geom::{Motion, Vec3, mesh::TriMesh};
use record::{SurfaceShape, WallRecord, WallsEnd};
use stream::mcap::{Provenance, Reader, Writer};
use stream::{Table, Values};
use view::{
    Extras, Hidden, Image, LayerHead, Moment, Page, PageOptions, PictureOptions, Role, Show, ViewError,
    WallScale, WearField, picture, show_run,
};

/// A turn by a half in a second about z, through the origin.
fn turning() -> Motion {
    Motion { turn: Vec3::z() * std::f64::consts::PI, ..Motion::default() }
}

/// Two squares of 1 m², at x < 0 and at x > 0; the second face of the file has no area.
fn tiles() -> TriMesh {
    let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let square = |x: f64| [at(x, -0.5), at(x + 1.0, -0.5), at(x + 1.0, 0.5), at(x, 0.5)];
    let vertices = [square(-1.1), square(0.1)].concat();
    TriMesh { vertices, faces: vec![[0, 1, 2], [0, 0, 1], [0, 2, 3], [4, 5, 6], [4, 6, 7]] }
}

/// What was done to parts in an interval of half a second.
fn wear(rows: &[(u32, f64)]) -> Table {
    let mut table = Table::with_rows(rows.len());
    let number = |value: f64| Values::F64(vec![value; rows.len()]);
    for (name, values) in [
        ("x", number(0.0)),
        ("y", number(0.0)),
        ("z", number(0.0)),
        ("wall", Values::U32(vec![0; rows.len()])),
        ("part", Values::U32(rows.iter().map(|(part, _)| *part).collect())),
        ("interval", number(0.5)),
        ("normal_impulse", number(1.0)),
        ("largest_normal", number(2.0)),
        ("work", Values::F64(rows.iter().map(|(_, work)| *work).collect())),
        ("impacts", Values::U32(vec![1; rows.len()])),
        ("impact_normal", number(0.0)),
        ("impact_tangential", number(0.0)),
    ] {
        table.push(name, values).expect("fits");
    }
    table
}

fn grain(z: f64) -> Table {
    let mut table = Table::default();
    for (name, value) in
        [("x", 0.0), ("y", 0.0), ("z", z), ("radius", 0.02), ("vx", 0.0), ("vy", 0.0), ("vz", 1.0)]
    {
        table.push(name, Values::F64(vec![value])).expect("fits");
    }
    table
}

/// A run of a second in which the right tile is worn at first, and the left one later and more.
fn run(motion: &Motion, worn: bool) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    let surface = Some(SurfaceShape::Mesh(tiles()));
    let wall = WallRecord { name: "tiles".to_owned(), motion: motion.clone(), surface };
    let text = serde_json::json!([wall.to_json(0, 0, None)]).to_string();
    writer.bytes("/surfaces", "json", 0, text.as_bytes()).expect("written");
    let frames = [(0, vec![]), (500, vec![(3, 5.0), (4, 5.0)]), (1000, vec![(0, 10.0), (2, 10.0)])];
    for (ms, rows) in frames {
        writer.points("/particles", ms * 1_000_000, "world", grain(0.5)).expect("written");
        if worn {
            writer.points("/wall_wear", ms * 1_000_000, "world", wear(&rows)).expect("written");
        }
    }
    writer.finish().expect("finished")
}

const SLIDING: Extras = Extras {
    bonds: false,
    broken: false,
    arrows: None,
    history: false,
    chains: false,
    wear: Some(WearField::SlidingWork),
};

/// The picture from above at a time, without the grain, whose scale ends at 20 J/m².
fn seen(file: &[u8], time: f64) -> Image {
    let mut moment = Moment::at(Some(time));
    show_run(Reader::new(file), "run.mcap", SLIDING, &mut moment).expect("a run");
    moment.settle().expect("as many values as parts");
    assert_eq!(moment.time(), Some(time));
    let options = PictureOptions {
        width: 640,
        height: 360,
        camera: "top".parse().expect("known"),
        time: moment.time(),
        hidden: Hidden(vec!["grains".to_owned()]),
        walls: Some(WallScale { field: WearField::SlidingWork, range: Some([0.0, 20.0]), log: false }),
        surface_values: moment.surface_values(),
        ..PictureOptions::default()
    };
    picture::draw(&moment.parts(), moment.surfaces(), &options).expect("drawn")
}

/// How red the middles of the left and of the right tile are: red less blue.
fn reds(image: &Image) -> [i32; 2] {
    // The tiles fill the picture but for the place of the bar.
    let red = |x: u32| {
        let [r, _, b, _] = image.pixel(x, image.height / 2 + 12);
        i32::from(r) - i32::from(b)
    };
    [red(160), red(420)]
}

#[test]
fn a_part_has_the_colour_of_what_was_done_to_it_so_far() {
    let file = run(&Motion::default(), true);
    let [none, first, both] = [0.0, 0.5, 1.0].map(|time| reds(&seen(&file, time)));
    assert!(none.iter().all(|red| red.abs() < 30), "nothing was done: {none:?}");
    assert!(first[0].abs() < 30 && first[1] > 80, "half of the scale at the right: {first:?}");
    assert!(both[1] == first[1] && both[0] != both[1], "the left one later, and more: {both:?}");
}

#[test]
fn the_map_turns_with_the_wall() {
    let file = run(&turning(), true);
    let [half, whole] = [0.5, 1.0].map(|time| seen(&file, time));
    let [left, right] = reds(&whole);
    let [still_left, still_right] = reds(&seen(&run(&Motion::default(), true), 1.0));
    assert_eq!([left, right], [still_right, still_left], "half a turn swaps the tiles");
    assert!(half.rgba != whole.rgba);
}

#[test]
fn a_page_holds_the_values_of_the_faces_of_the_file() {
    let walls = Some(WallScale { field: WearField::SlidingWork, range: None, log: false });
    let mut page = Page::new(PageOptions { walls, ..PageOptions::default() });
    show_run(Reader::new(&run(&turning(), true)[..]), "run.mcap", SLIDING, &mut page).expect("a run");
    let html = page.html().expect("a page");
    let header =
        html.split_once("id=\"header\">").expect("a header").1.split_once("</script>").expect("its end").0;
    let header: serde_json::Value = serde_json::from_str(header).expect("JSON");
    assert_eq!(header["walls"]["name"], "sliding work");
    assert_eq!(
        (&header["walls"]["unit"], &header["walls"]["shown"]),
        (&"J/m²".into(), &serde_json::json!([0.0, 20.0]))
    );
    let track = header["surfaces"][0]["wear"].as_array().expect("a track");
    let most: Vec<f64> = track.iter().map(|state| state[1][2].as_f64().expect("a number")).collect();
    // At t = 0 before and with the first message.
    assert_eq!(most, [0.0, 0.0, 10.0, 20.0]);
    assert!(header["surfaces"][0]["parts"].is_u64(), "a face without area is not drawn");
}

#[test]
fn a_run_without_wear_names_the_key_that_records_it() {
    let file = run(&Motion::default(), false);
    let refused =
        show_run(Reader::new(&file[..]), "run.mcap", SLIDING, &mut Moment::at(None)).expect_err("refused");
    let text = refused.to_string();
    assert!(matches!(refused, ViewError::NoSuch { .. }) && text.contains("output.wear = true"), "{text}");
}

#[test]
fn the_camera_looks_at_the_walls_and_not_at_what_has_fallen_past_them() {
    let subject = |end: Option<WallsEnd>| {
        let mut moment = Moment::at(None);
        end.into_iter().for_each(|end| moment.walls_end(end));
        moment.surface(view::WallSurface {
            name: "tiles".to_owned(),
            shape: SurfaceShape::Mesh(tiles()),
            motion: Motion::default(),
        });
        let grains = moment.layer(LayerHead::new(Role::Grains, "grains"));
        let mut table = Table::default();
        for (name, value) in [("x", 0.0), ("y", 0.0), ("radius", 0.02)] {
            table.push(name, Values::F64(vec![value; 200])).expect("fits");
        }
        let z = (0..200).map(|k| if k < 100 { 0.02 } else { -0.5 * f64::from(k) });
        table.push("z", Values::F64(z.collect())).expect("fits");
        moment.push(grains, 0.0, table).expect("taken");
        let options = PictureOptions {
            width: 320,
            height: 180,
            colour: Some("z".to_owned()),
            walls_end: moment.walls_end,
            ..PictureOptions::default()
        };
        picture::draw(&moment.parts(), moment.surfaces(), &options).expect("drawn").outside
    };
    assert_eq!(subject(None), [0, 200]);
    let end = WallsEnd { down: -Vec3::z(), depth: 0.5 };
    let [outside, all] = subject(Some(end));
    assert!(outside > 90 && all == 200, "{outside} of {all} are outside");
}
