//! One impact, and any scene, on `dem-run` and on `dem-lammps`.

use crate::recorded::{column, frames};
use crate::scenes::folder;
use crate::tools::succeed;
use std::f64::consts::PI;
use std::path::Path;
use stream::Table;

/// Runs the scene `s.toml` of a folder on both engines, ours with forces sampled at instants and each contact by itself.
///
/// # Panics
/// When one of them fails.
pub fn both(folder: &Path, more: &[&str]) -> [Vec<Table>; 2] {
    both_with(folder, "lmp", more)
}

/// As [`both`], with the LAMMPS of this name.
///
/// # Panics
/// When one of them fails.
pub fn both_with(folder: &Path, lmp: &str, more: &[&str]) -> [Vec<Table>; 2] {
    let given =
        [&["s.toml", "-q", "--set", "time.contacts=sampled", "--set", "time.patch=plain"], more].concat();
    succeed(folder, "dem-run", &[&given[..], &["-o", "ours.mcap"]].concat());
    succeed(folder, "dem-lammps", &[&given[..], &["--lmp", lmp, "-o", "theirs.mcap"]].concat());
    ["ours.mcap", "theirs.mcap"].map(|name| frames(&folder.join(name)))
}

/// Radius of the grain [m].
pub const R: f64 = 0.005;
/// Radius of the other one [m].
pub const S: f64 = 0.003;
/// Steps of an impact.
pub const STEPS: f64 = 1e6;
/// Speed of slow impacts [m/s].
pub const SLOW: f64 = 1e-3;

/// Mass of a grain [kg].
pub fn mass(radius: f64) -> f64 {
    2500.0 * 4.0 / 3.0 * PI * radius.powi(3)
}

/// m* of both [kg].
pub fn reduced() -> f64 {
    mass(R) * mass(S) / (mass(R) + mass(S))
}

/// One impact.
pub struct Impact {
    /// Young's modulus [Pa].
    pub young: f64,
    /// Lines of the contact.
    pub law: String,
    /// Rows of x, y, z, radius, vx, vy, vz, wx, wy, wz.
    pub grains: Vec<[f64; 10]>,
    /// Lines of the wall.
    pub wall: &'static str,
    /// Duration [s].
    pub time: f64,
    /// What differences of velocity are compared with [m/s].
    pub speed: f64,
}

/// A floor at z = 0.
pub const FLOOR: &str = "[[wall]]\nname = \"floor\"\nplane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"\n";

impl Impact {
    /// One at 1 m/s, without a wall.
    pub fn new(law: impl Into<String>, grains: &[[f64; 10]], time: f64) -> Impact {
        Impact { young: 1e7, law: law.into(), grains: grains.to_vec(), wall: "", time, speed: 1.0 }
    }

    /// Largest difference of any velocity or surface speed over that of the impact.
    ///
    /// # Panics
    /// When one of the tools fails.
    pub fn difference(&self) -> f64 {
        let Impact { young, law, grains, wall, time, speed } = self;
        let rows: String = grains
            .iter()
            .zip(0..)
            .map(|(row, id)| format!("{id},{}\n", row.map(|value| format!("{value:?}")).join(",")))
            .collect();
        let step = time / STEPS;
        let every = time / 50.0;
        let scene = format!(
            "[time]\nuntil = {time:?}\ndt = {step:?}\n[output]\nevery = {every:?}\n[[material]]\nname = \"glass\"\n\
             density = 2500\nyoung = {young:?}\npoisson = 0.25\n[[contact]]\nbetween = [\"*\", \"*\"]\n{law}\n\
             [[particles]]\nsource = \"grains.csv\"\nmaterial = \"glass\"\n{wall}"
        );
        let head = "id,x,y,z,radius,vx,vy,vz,wx,wy,wz\n";
        let folder = folder(&[("s.toml", scene), ("grains.csv", [head, &rows].concat())]);
        let [ours, theirs] = both(folder.path(), &[]);
        assert_eq!(ours.len(), theirs.len());
        assert!(ours.len() >= 50);
        let radii: Vec<f64> = grains.iter().map(|row| row[3]).collect();
        let mut worst = 0.0f64;
        for (a, b) in ours.iter().zip(&theirs) {
            for name in ["vx", "vy", "vz", "wx", "wy", "wz"] {
                for ((p, q), r) in column(a, name).into_iter().zip(column(b, name)).zip(&radii) {
                    let arm = if name.starts_with('w') { *r } else { 1.0 };
                    worst = worst.max((p - q).abs() * arm / speed);
                }
            }
        }
        println!("{law:?}: {worst:.2e}");
        worst
    }

    /// That it is below a bound.
    ///
    /// # Panics
    /// When it is not.
    pub fn agrees(&self, to: f64) {
        let worst = self.difference();
        assert!(worst < to, "{}: {worst:.2e}", self.law);
    }
}

/// Two grains that meet head-on, with what else moves them.
pub fn meet(v: f64, along: f64, spin: [f64; 3]) -> [[f64; 10]; 2] {
    let [wx, wy, wz] = spin;
    [
        [0.0, 0.0, 0.0, R, v / 2.0, along, 0.0, wx, wy, wz],
        [R + S, 0.0, 0.0, S, -v / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ]
}

/// Two grains pressed together, which part from rest.
pub fn pressed(overlap: f64, along: f64, spin: [f64; 3]) -> [[f64; 10]; 2] {
    let mut pair = meet(0.0, along, spin);
    pair[1][0] -= overlap;
    pair
}

/// A grain that falls on a floor.
pub fn falls(v: f64, along: f64) -> [[f64; 10]; 1] {
    [[0.0, 0.0, R, R, along, 0.0, -v, 0.0, 0.0, 0.0]]
}

/// Duration of a linear impact [s].
pub fn linear_time(mass: f64, stiffness: f64) -> f64 {
    PI * (mass / stiffness).sqrt()
}

/// Duration of a Hertzian impact [s].
pub fn hertz_time(mass: f64, radius: f64, young: f64, speed: f64) -> f64 {
    let modulus = young / (2.0 * (1.0 - 0.0625));
    2.87 * (mass * mass / (radius * modulus * modulus * speed)).powf(0.2)
}

/// R* of both [m].
pub fn radius() -> f64 {
    R * S / (R + S)
}
