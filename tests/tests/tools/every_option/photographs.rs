//! Small photographs of a block on a turntable, and a mask that was drawn.

use geom::Vec3;
use geom::mesh::cuboid;
use photos::rendered::Studio;
use photos::{Camera, photograph};
use std::fs;
use std::path::Path;

/// Photographs of a ring.
const COUNT: u32 = 6;

/// `photographs/01.png` and so on, `drawn/01.png`.
pub fn write(folder: &Path) {
    let block = cuboid(Vec3::new(-0.02, -0.03, -0.015), Vec3::new(0.02, 0.03, 0.015));
    let studio = Studio::new(64, 48, 0.004);
    for name in ["photographs", "drawn"] {
        fs::create_dir(folder.join(name)).expect("made");
    }
    for k in 0..COUNT {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(COUNT);
        let eye = Vec3::new(angle.cos(), angle.sin(), 0.4) * 0.3;
        let camera = Camera::looking(eye, Vec3::zeros(), Vec3::z(), 120.0, [31.5, 23.5]);
        let (photograph, mask) = studio.photograph(&block, &camera);
        let name = format!("{:02}.png", k + 1);
        let png = |values: &[u8]| photograph::png(64, 48, values).expect("a picture");
        fs::write(folder.join("photographs").join(&name), png(&photograph.encoded())).expect("written");
        if k == 0 {
            fs::write(folder.join("drawn").join(&name), png(&mask.coverage)).expect("written");
        }
    }
}
