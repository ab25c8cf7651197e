//! Bonds, cracks, arrows, size classes; what keeps text, ground and dark paper apart.

use super::{column, seen, table};
use geom::{Plane, Vec3};
use stream::{Table, Values};
use view::{Arrows, DrawnTable, Image, Motion, PictureOptions, Role, SurfaceShape, WallSurface, picture};

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
        let part =
            |role, table| DrawnTable { role, name: "test".into(), table, kinds: vec![], clumps: vec![] };
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
        let part = DrawnTable {
            role: Role::Grains,
            name: "test".into(),
            table: &grains,
            kinds: vec![],
            clumps: vec![],
        };
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

/// Everything stands out from dark paper: text, the darkest grains, a floor and its grid.
#[test]
fn on_dark_paper_nothing_is_lost() {
    let plane = Plane::new(Vec3::new(0.0, 0.0, -0.5), Vec3::z()).expect("a direction");
    let floor =
        [WallSurface { name: "floor".into(), shape: SurfaceShape::Plane(plane), motion: Motion::default() }];
    // The lowest colour of the map, nearly as dark as the paper.
    let grain = table(&[[0.0, 0.0, 0.0, 0.5]], &[0.0]);
    let draw = |dark: bool, surfaces: &[WallSurface]| {
        let part = DrawnTable {
            role: Role::Grains,
            name: "test".into(),
            table: &grain,
            kinds: vec![],
            clumps: vec![],
        };
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
