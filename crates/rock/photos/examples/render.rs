//! Photographs of a mesh on a turntable, with their true masks: a trial of `stone-mask` and `stone-hull` whose answer is known.
//!
//! ```sh
//! cargo run --release -p grainpipe-photos --example render -- STONE.ply DIR [WIDTH [STEP_DEG]]
//! ```
//!
//! Four turns: tilts of 0° and 35°, the stone as it is and turned over. Writes `DIR/photographs/*.jpg`, `DIR/truth/*.png` and `DIR/turntable.toml`.

use geom::Vec3;
use geom::mesh::TriMesh;
use nalgebra::UnitQuaternion;
use photos::photograph::png;
use photos::rendered::{Studio, jpeg};
use photos::turntable::{Place, Turntable};
use std::error::Error;
use std::fs;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let (Some(stone), Some(folder)) = (words.next(), words.next()) else {
        return Err("give STONE.ply DIR [WIDTH [STEP_DEG]]".into());
    };
    let width: usize = words.next().map_or(Ok(960), |w| w.parse())?;
    let step: f64 = words.next().map_or(Ok(10.0), |w| w.parse())?;
    let (folder, mut mesh) = (Path::new(&folder), mesh::load(&stone)?);
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    mesh.vertices.iter_mut().for_each(|v| *v -= (lo + hi) / 2.0);
    let diagonal = (hi - lo).norm();
    let height = 3 * width / 4;
    let text = turntable(width, 3.2 * diagonal, step);
    fs::create_dir_all(folder.join("photographs"))?;
    fs::create_dir_all(folder.join("truth"))?;
    fs::write(folder.join("turntable.toml"), &text)?;
    let table = Turntable::parse(&text)?;
    let over = UnitQuaternion::from_scaled_axis(Vec3::new(2.9, 0.7, 0.3));
    let turned = TriMesh { vertices: mesh.vertices.iter().map(|v| over * v).collect(), ..mesh.clone() };
    let studio = Studio::new(width, height, diagonal / 40.0);
    for (ring, r) in table.ring.iter().enumerate() {
        let stone = if r.turned_over { &turned } else { &mesh };
        for k in 0..(360.0 / step).round() as usize {
            let place = Place { photograph: k, ring, angle_deg: k as f64 * step };
            let seed = (1000 * ring + k) as u64;
            let (photograph, truth) =
                Studio { seed, ..studio }.photograph(stone, &table.camera(&place, width, height));
            let name = r.photographs.replace('*', &format!("{k:03}"));
            fs::write(folder.join("photographs").join(&name), jpeg(&photograph, 92)?)?;
            let mask = Path::new(&name).with_extension("png");
            fs::write(folder.join("truth").join(mask), png(width, height, &truth.coverage)?)?;
        }
    }
    Ok(())
}

/// The file of the turntable.
fn turntable(width: usize, distance: f64, step: f64) -> String {
    let focal = 2.1 * width as f64;
    let rings = [("up-00", 0, false), ("up-35", 35, false), ("over-00", 0, true), ("over-35", 35, true)];
    let ring = |(name, tilt, over): (&str, i32, bool)| {
        format!(
            "\n[[ring]]\nphotographs = \"{name}-*.jpg\"\ntilt_deg = {tilt}\nstep_deg = {step}\nturned_over = {over}\n"
        )
    };
    format!("[camera]\nfocal_px = {focal}\ndistance = {distance}\n{}", rings.map(ring).concat())
}
