//! Prints the table of docs/theory/time-step.md on clumps: the true limit of stability over the bound, for blocky and plate-like clumps.
//!
//! Members lie on a lattice in a periodic box, under their own pressure, and are joined to equal clumps, so that every wave of the box is
//! among the motions. The limit is found by bisection in the engine, as in the tests of the time step.

#[allow(dead_code)]
#[path = "../../../../tests/tests/time_step/trial.rs"]
mod trial;

use dem::Setup;
use dem::setup::{Body, ClumpShape, Clumps};
use geom::{Moments, Vec3};
use grainpipe_tests::setups::{HOOKE, empty, with_friction};
use nalgebra::UnitQuaternion;
use std::f64::consts::SQRT_2;
use trial::{ALL, Trial};

/// Radius of a member [m], and overlap of neighbours over it [–]: so small that no layer buckles under its pressure within a trial.
const R: f64 = 0.01;
const OVERLAP: f64 = 1e-7;

/// A clump, and how copies of it fill space.
struct Stacked {
    name: &'static str,
    /// Its members, in distances of neighbours from the first.
    members: Vec<[f64; 3]>,
    /// Clumps of one cell of the lattice, and its edges, in distances of neighbours.
    places: Vec<[f64; 3]>,
    edges: [f64; 3],
}

/// A block of members on a cubic lattice.
fn block(name: &'static str, count: [u32; 3]) -> Stacked {
    let [nx, ny, nz] = count;
    let at = |k: u32| [k % nx, k / nx % ny, k / nx / ny].map(f64::from);
    let members = (0..nx * ny * nz).map(at).collect();
    Stacked { name, members, places: vec![[0.0; 3]], edges: count.map(f64::from) }
}

/// The four corners of a cell of the face-centred cubic lattice.
fn tetrahedra() -> Stacked {
    let half = 0.5 * SQRT_2;
    let members = vec![[0.0; 3], [half, half, 0.0], [half, 0.0, half], [0.0, half, half]];
    let name = "tetrahedron, close-packed";
    Stacked { name, members, places: vec![[0.0; 3]], edges: [SQRT_2; 3] }
}

/// Two neighbours of the face-centred cubic lattice, in one direction.
fn dumbbells() -> Stacked {
    let half = 0.5 * SQRT_2;
    let members = vec![[0.0; 3], [half, half, 0.0]];
    let places = vec![[0.0; 3], [half, 0.0, half]];
    Stacked { name: "two spheres, close-packed", members, places, edges: [SQRT_2; 3] }
}

impl Stacked {
    fn setup(&self, e: f64, friction: Option<f64>) -> Setup {
        let near = R * (2.0 - OVERLAP);
        let of = |place: &[f64; 3]| Vec3::from(*place) * near;
        let middle: Vec3 = self.members.iter().map(of).sum::<Vec3>() / self.members.len() as f64;
        let spheres: Vec<(Vec3, f64)> = self.members.iter().map(|m| (of(m) - middle, R)).collect();
        let reach = spheres.iter().map(|s| s.0.norm() + R).fold(0.0, f64::max);
        // A box is to be five times as long as the largest radius about a centre of mass; even numbers hold waves of alternating layers.
        let cells = self.edges.map(|edge| 2 * (2.6 * reach / (edge * near)).ceil().max(1.0) as u32);
        let mut setup = empty(HOOKE, e);
        setup.guards.overlap = OVERLAP * 1.01;
        setup.periodic = std::array::from_fn(|a| Some((0.0, f64::from(cells[a]) * self.edges[a] * near)));
        let mut placed = Vec::new();
        for k in 0..cells.iter().product() {
            let cell = [k % cells[0], k / cells[0] % cells[1], k / cells[0] / cells[1]];
            for place in &self.places {
                let at: [f64; 3] =
                    std::array::from_fn(|a| f64::from(cell[a]) * self.edges[a] + place[a] + 0.25);
                placed.push(Body {
                    id: (placed.len() * spheres.len()) as u32,
                    shape: 0,
                    scale: 1.0,
                    position: of(&at) + middle,
                    orientation: UnitQuaternion::identity(),
                    velocity: Vec3::zeros(),
                    spin: Vec3::zeros(),
                });
            }
        }
        let shape = ClumpShape::new("clump", 0, &spheres, &Moments::of_sum(&spheres));
        setup.clumps = Clumps { shapes: vec![shape], placed, entries: vec![] };
        match friction {
            Some(friction) => with_friction(setup, friction),
            None => setup,
        }
    }
}

fn main() {
    let shapes = [
        dumbbells(),
        tetrahedra(),
        block("cube of 2 × 2 × 2", [2, 2, 2]),
        block("rod of 4", [4, 1, 1]),
        block("plate of 2 × 2", [2, 2, 1]),
        block("plate of 3 × 3", [3, 3, 1]),
    ];
    let cases = [(1.0, None), (0.3, None), (1.0, Some(1.0)), (0.3, Some(1.0))];
    println!(
        "| clump | members | e = 1 | e = 0.3 | friction, e = 1 | friction, e = 0.3 |\n|---|---|---|---|---|---|"
    );
    shapes.iter().for_each(|shape| println!("{}", row(shape, &cases)));
}

fn row(shape: &Stacked, cases: &[(f64, Option<f64>)]) -> String {
    let limit = |&(e, friction): &(f64, Option<f64>)| {
        let trial = Trial { name: shape.name, setup: shape.setup(e, friction), ways: ALL };
        format!("{:.2}", trial.limit().1)
    };
    let limits: Vec<String> = cases.iter().map(limit).collect();
    format!("| {} | {} | {} |", shape.name, shape.members.len(), limits.join(" | "))
}
