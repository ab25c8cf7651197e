//! Walls of spheres against the analytic plane and the closed answers: rebound, grazing impacts, hold, leaks, flow.

mod drift;
mod filling;
mod grazing;
mod heap;
mod holding;
mod passing;
mod patches;
mod rebound;

use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::sphere_walls;

/// A line of the part about walls of spheres.
const fn of_walls(holds: &'static str) -> Case {
    case("Walls of spheres", holds)
}
