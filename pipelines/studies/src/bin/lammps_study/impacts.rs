//! Five single contacts: the largest difference of any velocity or surface speed over that of the impact.

use grainpipe_tests::engines::{
    FLOOR, Impact, R, SLOW, falls, hertz_time, linear_time, mass, meet, radius, reduced,
};
use std::fmt::Write;

/// What both agree to [–].
const TO: f64 = 1e-6;

/// The table, and whether all agree.
pub fn table() -> (String, bool) {
    let hooke = "law = \"hooke\"\nstiffness = 1e4\nrestitution = 0.7";
    let hertz = "law = \"hertz\"\nrestitution = 0.7";
    let jkr = "law = \"jkr\"\nwork_of_adhesion = 1\nrestitution = 0.8";
    let rubs = "law = \"hooke\"\nstiffness = 1e8\nrestitution = 1\nsliding_friction = 0.3";
    let mindlin = "law = \"hertz\"\nrestitution = 1\nsliding_friction = 0.3";
    let head_on = meet(1.0, 0.0, [0.0; 3]);
    let oblique = meet(SLOW, 0.4 * SLOW, [0.0; 3]);
    let slow = |young, impact| Impact { speed: SLOW, young, ..impact };
    let cases = [
        ("two grains, Hooke, e = 0.7", Impact::new(hooke, &head_on, 1.1 * linear_time(reduced(), 1e4))),
        (
            "a grain on a plane, Hertz, e = 0.7",
            Impact {
                wall: FLOOR,
                ..Impact::new(hertz, &falls(1.0, 0.0), 1.1 * hertz_time(mass(R), R, 1e7, 1.0))
            },
        ),
        (
            "two grains, JKR, e = 0.8, until LAMMPS parts them",
            Impact::new(jkr, &head_on, 0.95 * hertz_time(reduced(), radius(), 1e7, 1.0)),
        ),
        (
            "two grains, oblique, Hooke, μ = 0.3, δ/r = 1e-7",
            slow(1e7, Impact::new(rubs, &oblique, 1.02 * linear_time(reduced(), 1e8))),
        ),
        (
            "a grain on a plane, oblique, Mindlin, μ = 0.3, δ/r = 1e-7",
            slow(
                1e14,
                Impact {
                    wall: FLOOR,
                    ..Impact::new(
                        mindlin,
                        &falls(SLOW, 0.6 * SLOW),
                        1.02 * hertz_time(mass(R), R, 1e14, SLOW),
                    )
                },
            ),
        ),
    ];
    let mut text = "| one contact, a million steps | largest difference |\n|---|---|\n".to_owned();
    let mut agree = true;
    for (name, impact) in cases {
        let worst = impact.difference();
        agree &= worst < TO;
        let _ = writeln!(text, "| {name} | {worst:.1e} |");
    }
    (text, agree)
}
