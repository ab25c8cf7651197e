//! Where `--wear` says that a wall of spheres is worn.

use super::{column, measure};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::succeed;
use tempfile::TempDir;

/// A tray of wall spheres in the coordinates of its file, put elsewhere, that shakes and turns under grains.
fn shaken(place: &str) -> TempDir {
    let scene = format!(
        r#"gravity = [0, 0, -9.81]
[time]
until = 0.2
[output]
every = 0.01
contacts = true
[[material]]
name = "ore"
density = 2500
young = 1e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.4
[[fill]]
material = "ore"
shape = "box:1.96,1.96,0.014,2.04,2.04,0.03"
diameter = 0.01
count = 12
[[wall]]
name = "tray"
source = "walls.mcap"
material = "ore"
{place}
motion = [
    {{ rotate = {{ about = [1, 1, 0], through = [2, 2, 0], rpm = 10 }} }},
    {{ vibrate = {{ amplitude = [0.002, 0, 0], frequency = 11 }} }},
]
"#
    );
    let points = (0..400).map(|k| format!("{} {} 0\n", 0.01 * f64::from(k % 20), 0.01 * f64::from(k / 20)));
    let folder = folder(&[("s.toml", scene), ("flat.xyz", points.collect())]);
    let walls = ["flat.xyz", "--roughness", "0.001", "--facing", "0,0,1"];
    succeed(folder.path(), "wallgen", &[&walls[..], &["-o", "walls.mcap"]].concat());
    succeed(folder.path(), "wallgen", &[&walls[..], &["--ascii", "-o", "walls.ply"]].concat());
    succeed(folder.path(), "dem-run", &["s.toml", "--threads", "1", "-o", "run.mcap"]);
    folder
}

/// The centres and radii of the walls file [m].
fn of_file(folder: &TempDir) -> Vec<[f64; 4]> {
    let text = std::fs::read_to_string(folder.path().join("walls.ply")).unwrap();
    let (head, rows) = text.split_once("end_header\n").unwrap();
    let names: Vec<&str> =
        head.lines().filter(|l| l.starts_with("property")).filter_map(|l| l.split(' ').next_back()).collect();
    let at = ["x", "y", "z", "radius"].map(|name| names.iter().position(|n| *n == name).unwrap());
    let row = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').map(|n| n.parse().unwrap()).collect();
        at.map(|k| numbers[k])
    };
    rows.lines().map(row).collect()
}

#[test]
fn a_worn_sphere_is_where_its_file_has_it_wherever_the_scene_puts_and_moves_it() {
    let places = [
        // The corners of the file lie at 1.9 and 2.1 m.
        "place = { translate = [1.905, 1.905, 0] }",
        "place = [{ rotate = { about = [0, 0, 1], angle = \"90 deg\" } }, { translate = [2.095, 1.905, 0] }]",
        "scale = 2\nplace = { translate = [1.81, 1.81, 0] }",
    ];
    for place in places {
        let folder = shaken(place);
        let file = of_file(&folder);
        for more in [&[][..], &["--from", "0.1"]] {
            let worn = measure(&folder, &[&["--wear", "all"], more].concat());
            let columns = ["x", "y", "z", "radius", "sliding_work"].map(|name| column(&worn, name));
            assert_eq!(columns[0].len(), file.len());
            for (k, sphere) in file.iter().enumerate() {
                let found = [0, 1, 2, 3].map(|c| columns[c][k]);
                let apart = (0..4).map(|c| (found[c] - sphere[c]).abs()).fold(0.0, f64::max);
                // Times of messages are rounded to nanoseconds.
                assert!(apart < 1e-8, "{place} {more:?}, sphere {k}: {found:?}, in the file {sphere:?}");
            }
            assert!(columns[4].iter().sum::<f64>() > 0.0, "{place} {more:?}");
        }
        // As many spheres of the next wall are worn as of this one.
        let table = measure(&folder, &["--wear", "all", "-o", "wear.csv"]);
        assert!(table.stdout.is_empty());
        let rough = "roughness = 0.0005\n[wear]\nrun = \"wear.csv\"\ntable = \"table.csv\"\nmeasured = \"sliding_work\"\nfrom = [0, 0, 0]\nalong = [1, 0, 0]\n";
        std::fs::write(folder.path().join("rough.toml"), rough).unwrap();
        std::fs::write(folder.path().join("table.csv"), "w,0\n0,0.0005\n1e-12,0.001\n").unwrap();
        let made = [
            "flat.xyz",
            "--roughness",
            "rough.toml",
            "--facing",
            "0,0,1",
            "--report",
            "made.json",
            "-o",
            "next.mcap",
        ];
        let said = succeed(folder.path(), "wallgen", &made);
        assert!(!said.stderr.contains("farther"), "{place}: {}", said.stderr);
    }
}
