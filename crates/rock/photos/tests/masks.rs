//! Masks of rendered photographs against their truth.

use geom::Vec3;
use geom::mesh::TriMesh;
use photos::rendered::{Studio, jpeg};
use photos::{Camera, Mask, MaskSettings, MaskWarning, Photograph, Polarity, contour, find_mask};

/// The scanned quarry stone of the samples, about its middle.
fn stone() -> TriMesh {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../sample-data/stones/quarry.ply");
    let mut mesh = mesh::load(path).unwrap();
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    mesh.vertices.iter_mut().for_each(|v| *v -= (lo + hi) / 2.0);
    mesh
}

fn studio(mesh: &TriMesh) -> Studio {
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    Studio::new(400, 300, (hi - lo).norm() / 40.0)
}

fn camera(mesh: &TriMesh, azimuth: f64) -> Camera {
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    let distance = 3.0 * (hi - lo).norm();
    let eye = Vec3::new(azimuth.cos(), azimuth.sin(), 0.4) * distance;
    Camera::looking(eye, Vec3::zeros(), Vec3::z(), 700.0, [199.5, 149.5])
}

/// Mean and signed mean distance from the edge of one mask to that of another [px]; positive where the first is larger.
fn edge_error(found: &Mask, truth: &Mask) -> [f64; 2] {
    let (edge, true_edge) = (contour(found), contour(truth));
    assert!(edge.len() > 100, "{} pieces of edge", edge.len());
    let off = |s: &photos::Segment| {
        let p = s.middle();
        let d = true_edge.iter().map(|t| t.distance(p)).fold(f32::INFINITY, f32::min);
        let inside = truth.coverage[p[1].round() as usize * truth.width + p[0].round() as usize] > 127;
        f64::from(if inside { -d } else { d })
    };
    let all: Vec<f64> = edge.iter().map(off).collect();
    let n = all.len() as f64;
    [all.iter().map(|d| d.abs()).sum::<f64>() / n, all.iter().sum::<f64>() / n]
}

fn through_jpeg(photograph: &Photograph) -> Photograph {
    Photograph::read(&jpeg(photograph, 92).unwrap()).unwrap()
}

#[test]
fn the_edge_is_within_half_a_pixel_of_the_truth() {
    let mesh = stone();
    let white = studio(&mesh);
    let dark = Studio { paint: [0.12, 0.05], background: [0.5, 0.7], shadow: 0.25, ..white };
    let blurred = Studio { blur: 2.0, noise: 0.01, ..white };
    let sharp = Studio { blur: 0.0, noise: 0.0, ..white };
    for (name, studio) in [("white", white), ("dark", dark), ("blurred", blurred), ("sharp", sharp)] {
        for azimuth in [0.3, 2.0, 4.5] {
            let (photograph, truth) = studio.photograph(&mesh, &camera(&mesh, azimuth));
            let mask = find_mask(&through_jpeg(&photograph), &MaskSettings::default());
            let [mean, signed] = edge_error(&mask, &truth);
            println!("{name} {azimuth}: {mean:.3} {signed:.3} {:?}", mask.found);
            assert!(mean < 0.5 && signed.abs() < 0.3, "{name}, {azimuth}: {mean} {signed}");
            assert_eq!(mask.warnings(), [], "{name}");
            let wanted = if name == "dark" { Polarity::Dark } else { Polarity::Bright };
            assert_eq!(mask.found.unwrap().polarity, wanted);
        }
    }
}

#[test]
fn doubtful_photographs_are_named_with_a_cure() {
    let mesh = stone();
    let studio = studio(&mesh);
    let seen = camera(&mesh, 1.0);
    let warnings = |studio: &Studio, camera: &Camera, settings: MaskSettings| {
        find_mask(&through_jpeg(&studio.photograph(&mesh, camera).0), &settings).warnings()
    };
    let plain = MaskSettings::default();
    // Shifted over the frame.
    let off = Camera { centre: [40.0, 149.5], ..seen };
    assert!(matches!(warnings(&studio, &off, plain)[..], [MaskWarning::CutByFrame { pixels: 30.. }, ..]));
    // Out of focus.
    let blurred = Studio { blur: 4.0, ..studio };
    assert!(matches!(warnings(&blurred, &seen, plain)[..], [MaskWarning::Blurred { width: 8.0.., .. }]));
    // Nothing there.
    let away = Camera { centre: [4000.0, 149.5], ..seen };
    let nothing = Studio { background: [0.02; 2], shadow: 0.0, noise: 0.0, ..studio };
    assert_eq!(warnings(&nothing, &away, plain), [MaskWarning::Empty]);
    // Half of the background is as bright as the stone.
    let lit = Studio { background: [0.01, 0.7], ..studio };
    let found = warnings(&lit, &seen, plain);
    assert!(found.iter().any(|w| matches!(w, MaskWarning::Background { .. })), "{found:?}");
}
