//! What the run of a scene with rigid clumps says of them, and what another scene takes from it.

use grainpipe_tests::recorded;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use record::{ClumpRecord, metadata};
use std::path::Path;
use tempfile::TempDir;

const SCENE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.01
[output]
every = 0.01
[[material]]
name = "stone"
density = 2500
young = 5e7
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
[[clump]]
name = "corner"
material = "stone"
mass = "sum"
spheres = [[0, 0, 0, 0.01], [0.012, 0, 0, 0.008], [0.001, 0.01, 0.004, 0.006]]
"#;

const ONE: &str = "[[body]]\nclump = \"corner\"\nposition = [0, 0, 0.1]\n";

fn ran() -> TempDir {
    let folder = folder(&[("s.toml", [SCENE, ONE].concat())]);
    succeed(folder.path(), "dem-run", &["s.toml", "-q", "-o", "run.mcap"]);
    folder
}

fn shape(run: &Path) -> ClumpRecord {
    let clumps = recorded::metadata(run, metadata::CLUMPS);
    ClumpRecord::from_map("run", &clumps).expect("sound").swap_remove(0)
}

/// Moments of inertia are about axes: with these a reader has the tensor, here the sum of the spheres.
#[test]
fn a_run_tells_the_axes_of_the_moments_of_inertia() {
    let folder = ran();
    let record = shape(&folder.path().join("run.mcap"));
    let [w, x, y, z] = record.axes.expect("axes");
    let axes = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix();
    let told = axes * Matrix3::from_diagonal(&Vector3::from(record.inertia)) * axes.transpose();
    let centre = Vector3::from(record.centre);
    let of = |[x, y, z, r]: [f64; 4]| {
        let (arm, volume) = (Vector3::new(x, y, z) - centre, 4.0 / 3.0 * std::f64::consts::PI * r.powi(3));
        (Matrix3::identity() * (0.4 * r * r + arm.norm_squared()) - arm * arm.transpose()) * volume
    };
    let expected: Matrix3<f64> = record.spheres.iter().map(|s| of(*s)).sum();
    let off = (told - expected).norm() / expected.norm();
    assert!(off < 1e-12, "{off}: {told} instead of {expected}");
    let diagonal = Matrix3::from_diagonal(&expected.diagonal());
    assert!(
        (expected - diagonal).norm() > 0.05 * expected.norm(),
        "the axes are not those of the coordinates"
    );
}

/// The rows of such a run are the spheres of its clumps: none of them is a clump by itself.
#[test]
fn a_run_with_clumps_is_no_list_of_places_for_clumps() {
    let folder = ran();
    let again = [SCENE, "[[particles]]\nsource = \"run.mcap\"\n"].concat();
    std::fs::write(folder.path().join("again.toml"), &again).expect("a folder");
    succeed(folder.path(), "dem-run", &["again.toml", "-q", "-o", "again.mcap"]);
    std::fs::write(folder.path().join("wrong.toml"), again + "clump = \"corner\"\n").expect("a folder");
    let done = tool(folder.path(), "dem-run", &["wrong.toml", "--check"]);
    assert_eq!(done.code, 1, "{}", done.stderr);
    let words = ["particles.0.clump", "run with clumps", "take it out"];
    assert!(words.iter().all(|word| done.stderr.contains(word)), "{}", done.stderr);
}
