//! Samples for laboratory tests that take seconds.

/// Sand of soft grains, as a sample of lab-test.
pub const SAND: &str = r#"
gravity = [0, 0, -9.81]
[[material]]
name = "sand"
density = 2650
young = 1e6
poisson = 0.25
[[contact]]
between = ["sand", "sand"]
law = "hertz"
restitution = 0.3
sliding_friction = 0.5
rolling_resistance = 0.1
[[fill]]
material = "sand"
diameter = "5 mm"
"#;

/// Grains held together by bonds that break, in stone.csv, as a sample of lab-test.
pub const ROCK: &str = r#"
[[material]]
name = "rock"
density = 2650
young = 1e7
poisson = 0.25
[[contact]]
between = ["rock", "rock"]
law = "hooke"
stiffness = 1e5
restitution = 0.2
sliding_friction = 0.5
[[bond]]
between = ["rock", "rock"]
kind = "parallel"
gap = 1e-6
modulus = 1e8
stiffness_ratio = 2.5
tensile_strength = 2e5
shear_strength = 2e5
damping = 0.05
[[particles]]
source = "stone.csv"
material = "rock"
cluster = 1
"#;

/// A cube of 27 touching grains: the rows of stone.csv.
pub fn cube() -> String {
    let at = |k: usize| 0.001 * k as f64;
    let row = |k: usize| format!("{},{},{},0.0005\n", at(k % 3), at(k / 3 % 3), at(k / 9));
    ["x,y,z,radius\n".to_owned()].into_iter().chain((0..27).map(row)).collect()
}
