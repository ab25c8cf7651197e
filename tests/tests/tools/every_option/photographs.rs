//! Small photographs of a block on a turntable, where they were taken from, and a mask that was drawn.

use geom::Vec3;
use geom::mesh::{TriMesh, cuboid};
use photos::rendered::{Studio, Tag};
use photos::turntable::{Place, Turntable};
use photos::{Camera, photograph};
use std::fs;
use std::path::Path;

/// Photographs of a ring, and their size.
const COUNT: usize = 6;
const SIZE: [usize; 2] = [64, 48];

const TABLE: &str = "[camera]\nfocal_px = 120\ndistance = 0.3\n\
                     [[ring]]\nphotographs = \"0*.png\"\ntilt_deg = 25\nstep_deg = 60\n\
                     [[ring]]\nphotographs = \"1*.png\"\ntilt_deg = 25\nstep_deg = 60\nturned_over = true\n";

/// `photographs/01.png` to `06.png` and, of the block turned over, `11.png` to `16.png`; `drawn/01.png`, `turntable.toml`, `poses.txt`, `matrices/01.txt`; `pebble.ply`.
pub fn write(folder: &Path) {
    let block = cuboid(Vec3::new(-0.02, -0.03, -0.015), Vec3::new(0.02, 0.03, 0.015));
    let over = |v: &Vec3| Vec3::new(0.9 * v.x + 0.19f64.sqrt() * v.y, 0.19f64.sqrt() * v.x - 0.9 * v.y, -v.z);
    let turned = TriMesh { vertices: block.vertices.iter().map(over).collect(), ..block.clone() };
    let studio = Studio::new(SIZE[0], SIZE[1], 0.004);
    for name in ["photographs", "drawn", "matrices"] {
        fs::create_dir(folder.join(name)).expect("made");
    }
    fs::write(folder.join("turntable.toml"), TABLE).expect("written");
    let table = Turntable::parse(TABLE).expect("a turntable");
    let mut poses = String::new();
    for (ring, stone) in [&block, &turned].into_iter().enumerate() {
        for k in 0..COUNT {
            let place = Place { photograph: k, ring, angle_deg: 60.0 * k as f64 };
            let camera = table.camera(&place, SIZE[0], SIZE[1]);
            let (photograph, mask) = studio.photograph(stone, &camera);
            let name = format!("{ring}{}.png", k + 1);
            let png = |values: &[u8]| photograph::png(SIZE[0], SIZE[1], values).expect("a picture");
            fs::write(folder.join("photographs").join(&name), png(&photograph.encoded())).expect("written");
            if ring == 0 {
                let row = row(&name, &camera);
                let matrix = row.split_once(' ').expect("a name").1.to_owned();
                fs::write(folder.join("matrices").join(&name).with_extension("txt"), matrix)
                    .expect("written");
                poses += &row;
            }
            if ring == 0 && k == 0 {
                fs::write(folder.join("drawn").join(&name), png(&mask.coverage)).expect("written");
            }
        }
    }
    fs::write(folder.join("poses.txt"), poses).expect("written");
    tagged(folder, &block, &table);
    fs::write(folder.join("pebble.ply"), pebble()).expect("written");
}

/// Larger ones with a tag of 20 mm beside the block: `tagged/01.png` to `06.png`, `tagged-masks`, `tagged.txt`.
fn tagged(folder: &Path, block: &TriMesh, table: &Turntable) {
    let [w, h] = SIZE.map(|size| 6 * size);
    let tag = Tag { at: Vec3::new(0.045, 0.0, -0.0151), size: 0.02 };
    for name in ["tagged", "tagged-masks"] {
        fs::create_dir(folder.join(name)).expect("made");
    }
    let mut poses = String::new();
    for k in 0..COUNT {
        let place = Place { photograph: k, ring: 0, angle_deg: 60.0 * k as f64 };
        let camera = table.camera(&place, SIZE[0], SIZE[1]).resized(6.0);
        let (mut photograph, mask) = Studio::new(w, h, 0.004).photograph(block, &camera);
        tag.draw(&mut photograph, &mask, &camera);
        let name = format!("0{}.png", k + 1);
        let png = |values: &[u8]| photograph::png(w, h, values).expect("a picture");
        fs::write(folder.join("tagged").join(&name), png(&photograph.encoded())).expect("written");
        fs::write(folder.join("tagged-masks").join(&name), png(&mask.coverage)).expect("written");
        poses += &row(&name, &camera);
    }
    fs::write(folder.join("tagged.txt"), poses).expect("written");
}

/// A line of a table of poses: the matrix K (R | t).
fn row(name: &str, camera: &Camera) -> String {
    let [fx, fy, _] = camera.focal;
    let line = |k: usize| {
        let r = camera.rotation.row(k);
        [r[0], r[1], r[2], camera.translation[k]]
    };
    let (x, y, z) = (line(0), line(1), line(2));
    let first = (0..4).map(|k| fx * x[k] + camera.centre[0] * z[k]);
    let second = (0..4).map(|k| fy * y[k] + camera.centre[1] * z[k]);
    let all: Vec<String> = first.chain(second).chain(z).map(|v| v.to_string()).collect();
    format!("{name} {}\n", all.join(" "))
}

/// An ellipsoid of 128 faces.
fn pebble() -> String {
    let sides: Vec<[Vec3; 3]> = (0..8)
        .map(|k| {
            let [x, y, z] = [0, 1, 2].map(|a| if k >> a & 1 == 0 { 1.0 } else { -1.0 });
            let (a, b, c) = (Vec3::new(x, 0.0, 0.0), Vec3::new(0.0, y, 0.0), Vec3::new(0.0, 0.0, z));
            if x * y * z > 0.0 { [a, b, c] } else { [a, c, b] }
        })
        .collect();
    let halved = |faces: Vec<[Vec3; 3]>| -> Vec<[Vec3; 3]> {
        let four = |[a, b, c]: [Vec3; 3]| {
            let [d, e, f] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0].map(|p| p.normalize());
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        };
        faces.into_iter().flat_map(four).collect()
    };
    let faces = halved(halved(sides));
    let corner = |p: &Vec3| format!("{} {} {}\n", 0.03 * p.x, 0.025 * p.y, 0.02 * p.z);
    let vertices: String = faces.iter().flatten().map(corner).collect();
    let lists: String =
        (0..faces.len()).map(|k| format!("3 {} {} {}\n", 3 * k, 3 * k + 1, 3 * k + 2)).collect();
    let head = "property float x\nproperty float y\nproperty float z";
    format!(
        "ply\nformat ascii 1.0\nelement vertex {}\n{head}\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n{vertices}{lists}",
        3 * faces.len(),
        faces.len()
    )
}
