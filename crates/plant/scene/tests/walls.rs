//! `[[wall]]`: its motions, belts, solids and units, from the text of a scene to the setup of the engine.

use dem::setup::{Wall, WallShape};
use geom::Vec3;
use scene::Scene;
use std::path::PathBuf;

const REST: &str = r#"
[time]
until = 1
[[material]]
name = "steel"
density = 7800
young = 2e8
poisson = 0.3
[[contact]]
between = ["*", "*"]
restitution = 0.5
[[fill]]
material = "steel"
shape = "sphere:5,5,5,0.02"
diameter = 0.03
count = 1
[[wall]]
material = "steel"
"#;

/// A separate folder, which goes away with the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, files: &[(&str, &str)]) -> Folder {
        let path = std::env::temp_dir().join(format!("grainpipe-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        files.iter().for_each(|(file, text)| std::fs::write(path.join(file), text).unwrap());
        Folder(path)
    }

    fn walls(&self, keys: &str) -> Result<Vec<Wall>, String> {
        let scene =
            Scene::new("s.toml", format!("{REST}{keys}\n"), &[], &self.0).map_err(|e| e.to_string())?;
        Ok(scene.plan(Vec::new()).map_err(|e| e.to_string())?.setup.walls)
    }

    fn refused(&self, keys: &str, words: &[&str]) {
        let message = self.walls(keys).err().unwrap_or_else(|| panic!("not refused: {keys}"));
        words.iter().for_each(|word| assert!(message.contains(word), "'{word}' not in: {message}"));
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const PLANE: &str = "plane = \"0,0,0,0,0,1\"\n";
const TRIANGLE: &str = "v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n";

#[test]
fn a_gate_opens_and_closes() {
    let folder = Folder::new("gate", &[("gate.obj", TRIANGLE)]);
    let motion = "motion = [{ translate = [0.5, 0, 0], from = 2, until = 2.4 }, { translate = [-0.5, 0, 0], from = 5, until = 5.4 }]";
    let walls = folder.walls(&format!("mesh = \"gate.obj\"\nunits = \"mm\"\n{motion}")).unwrap();
    let at = |time: f64| walls[0].motion.pose(time).position(&Vec3::zeros()).x;
    for (time, x) in [(0.0, 0.0), (2.2, 0.1), (3.0, 0.2), (5.2, 0.1), (9.0, 0.0)] {
        assert!((at(time) - x).abs() < 1e-12, "{time} s: {} m", at(time));
    }
    let WallShape::Mesh(mesh) = &walls[0].shape else { panic!("no mesh") };
    assert!((mesh.vertices[1].x - 0.1).abs() < 1e-15, "{mesh:?}");
}

#[test]
fn swings_paths_and_ramps_are_read() {
    let folder = Folder::new("path", &[("path.csv", "t,x,angle\n0.5,7,0.1\n1.5,9,0.6\n")]);
    let swing =
        "swing = { about = [0, 0, 2], through = [0, 0, 0], amplitude = \"90 deg\", frequency = 0.25 }";
    let path = "path = { source = \"path.csv\", about = [0, 0, 3], through = [0, 0, 0] }";
    let walls = folder.walls(&format!("{PLANE}motion = [{{ {swing} }}, {{ {path}, from = 1 }}]")).unwrap();
    let place = |time: f64| walls[0].motion.pose(time).position(&Vec3::x());
    assert!((place(1.0) - Vec3::y()).norm() < 1e-12, "{}", place(1.0));
    // Back at 0 of the swing; the path has all of its 2 m and 0.5 rad.
    let end = place(4.0);
    assert!((end - Vec3::new(2.0 + 0.5_f64.cos(), 0.5_f64.sin(), 0.0)).norm() < 1e-12, "{end}");
    let ramp = folder.walls(&format!("{PLANE}motion = {{ translate = [1, 0, 0], ramp = 0.5 }}")).unwrap();
    let speed = |time: f64| ramp[0].motion.pose(time).velocity(&Vec3::zeros()).x;
    assert_eq!((speed(0.0), speed(0.25), speed(2.0)), (0.0, 0.5, 1.0));
}

#[test]
fn belts_rest_and_solids_are_meshes_or_spheres() {
    let folder = Folder::new("belt", &[]);
    let belt = folder.walls(&format!("{PLANE}surface_velocity = [\"1.2 m/s\", 0, 0]")).unwrap();
    assert_eq!((belt[0].surface.velocity, belt[0].moves()), (Vec3::new(1.2, 0.0, 0.0), false));
    let solid = "solid = \"cylinder:0,0,0,0,0,1,0.5\"\n";
    let turn = "surface_rotation = { about = [0, 0, 1], through = [0, 0, 0], rpm = 60 }";
    let table = folder.walls(&format!("{solid}{turn}")).unwrap();
    assert!((table[0].surface.turn.z - std::f64::consts::TAU).abs() < 1e-12);
    assert!(matches!(table[0].shape, WallShape::Mesh(_)));
    let ball = folder.walls("solid = { sphere = [0, 0, 0, \"5 cm\"] }").unwrap();
    assert!(matches!(&ball[0].shape, WallShape::Spheres(s) if *s == [(Vec3::zeros(), 0.05)]));
}

#[test]
fn what_cannot_be_says_where_and_what_to_do() {
    let files = [
        ("jump.csv", "t,x\n0,0\n1,1\n1,2\n"),
        ("still.csv", "t,x\n0,3\n1,3\n"),
        ("turn.csv", "t,angle\n0,0\n1,1\n"),
    ];
    let folder = Folder::new("wrong", &files);
    let refused = |keys: &str, words: &[&str]| folder.refused(&format!("{PLANE}{keys}"), words);
    refused(
        "motion = { rpm = 5 }",
        &["unknown key 'rpm'", "did you mean 'rotate = { about, through, rpm }'?"],
    );
    refused("motion = [{ translate = [1, 0, 0] }, { rpm = 5 }]", &["unknown key 'rpm'", "rotate = { about"]);
    refused("motion = []", &["wall.0.motion", "names no motion"]);
    refused("motion = [{ translate = [1, 0, 0] }, { from = 1 }]", &["wall.0.motion.1", "names no motion"]);
    refused(
        "motion = { translate = [1, 0, 0], from = 1, until = 2, ramp = 0.6 }",
        &["wall.0.motion.ramp = 0.6 s", "half"],
    );
    let turn = "rotate = { about = [0, 0, 1], through = [0, 0, 0], rpm = 1 }";
    refused(
        &format!("motion = [{{ translate = [1, 0, 0] }}, {{ {turn} }}]"),
        &["wall.0.motion.0.translate", "until"],
    );
    let swing = "swing = { about = [0, 0, 1], through = [0, 0, 0], amplitude = 1, frequency = 1 }";
    refused(&format!("motion = {{ {turn}, {swing} }}"), &["rotate and swing", "list of motions"]);
    refused("motion = { path = { source = \"jump.csv\" } }", &["jump.csv", "two positions at one time"]);
    // In a sweep one path may be that of rest: said, and accepted.
    assert!(folder.walls(&format!("{PLANE}motion = {{ path = {{ source = \"still.csv\" }} }}")).is_ok());
    refused("motion = { path = { source = \"turn.csv\" } }", &["turn.csv", "'angle'", "about, through"]);
    refused("surface_velocity = [0, 0, 0]", &["wall.0.surface_velocity", "moves nothing"]);
    refused("solid = \"box:0,0,0,1,1,1\"", &["plane and solid", "only one"]);
    folder.refused("solid = \"box:0,0,0,1,1,0\"", &["wall.0.solid", "thickness"]);
    folder.refused("solid = \"!box:0,0,0,1,1,1\"", &["take the ! out"]);
}

/// Turned by 90° about z through (1, 0, 0), then shifted: (x, y, z) ↦ (1 − y, x − 1, z + 2).
#[test]
fn walls_of_every_kind_are_put_in_their_place() {
    let folder = Folder::new("place", &[("gate.obj", TRIANGLE)]);
    let place = "place = { rotate = { about = [0, 0, 1], through = [1, 0, 0], angle = \"90 deg\" }, translate = [0, 0, 2] }\n";
    let right = |at: &Vec3| Vec3::new(1.0 - at.y, at.x - 1.0, at.z + 2.0);
    let kinds = [
        "plane = \"0.3,0.2,-9,0,1,1\"\n",
        "box = [0, 0, -1, 1, 9, 3]\nfaces = [\"x-\", \"y+\"]\n",
        "solid = \"box:0,0,0,1,2,3\"\n",
        "solid = \"sphere:0.1,0.2,0.3,0.5\"\n",
        "mesh = \"gate.obj\"\n",
    ];
    for kind in kinds {
        let (drawn, put) = (folder.walls(kind).unwrap(), folder.walls(&(kind.to_owned() + place)).unwrap());
        let two = format!(
            "{kind}place = [{{ rotate = {{ about = [0, 0, 1], angle = 1.5707963267948966 }} }}, {{ translate = [1, -1, 2] }}]"
        );
        let steps = folder.walls(&two).unwrap();
        assert_eq!(drawn.len(), put.len());
        for ((drawn, put), steps) in drawn.iter().zip(&put).zip(&steps) {
            for put in [put, steps] {
                match (&drawn.shape, &put.shape) {
                    (WallShape::Plane(a), WallShape::Plane(b)) => {
                        assert!((right(&a.point) - b.point).norm() < 1e-14, "{kind}");
                        let normal = right(&(a.point + a.normal)) - right(&a.point);
                        assert!((normal - b.normal).norm() < 1e-14, "{kind}");
                    }
                    (WallShape::Mesh(a), WallShape::Mesh(b)) => {
                        assert_eq!(a.faces, b.faces);
                        let far = a.vertices.iter().zip(&b.vertices).map(|(a, b)| (right(a) - b).norm());
                        assert!(far.fold(0.0, f64::max) < 1e-13, "{kind}");
                    }
                    (WallShape::Spheres(a), WallShape::Spheres(b)) => {
                        assert!((right(&a[0].0) - b[0].0).norm() < 1e-14 && a[0].1 == b[0].1, "{kind}");
                    }
                    _ => panic!("{kind}: another kind of wall"),
                }
            }
        }
    }
    let belt =
        folder.walls(&format!("plane = \"0,0,0,0,0,1\"\nsurface_velocity = [2, 0, 0]\n{place}")).unwrap();
    assert!((belt[0].surface.velocity - Vec3::new(0.0, 2.0, 0.0)).norm() < 1e-14);
    folder.refused(&format!("{PLANE}place = {{ }}"), &["wall.0.place", "puts nothing anywhere"]);
    folder.refused(
        &format!("{PLANE}place = {{ rotate = {{ about = [0, 0, 0], angle = 1 }} }}"),
        &["wall.0.place.rotate.about"],
    );
    folder.refused(&format!("{PLANE}place = {{ shift = [0, 0, 1] }}"), &["shift"]);
}
