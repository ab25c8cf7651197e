//! What wedges: a grain between walls that close, an arch over a mouth that is too narrow, and what is pressed into it.

use crate::variants::{Variant, farthest, fastest, halt, run, simulation, variants};
use dem::Simulation;
use dem::setup::*;
use geom::{Plane, Vec3, mesh::TriMesh};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::scenes::{Head, folder};
use grainpipe_tests::setups::{grain, particles};
use grainpipe_tests::tools::{line, succeed, tool};

const WEDGED: Case = case(
    "Rest and extremes",
    "a grain between two closing walls: the run stops with the reason when the overlap exceeds its limit",
);
const ARCH: Case = case("Rest and extremes", "an arch over the mouth of a hopper stands");
const STILL: Case = case("Rest and extremes", "an arch over the mouth of a hopper comes to rest");
const MIXED: Case = case(
    "Rest and extremes",
    "an arch over the mouth of a hopper, in mixed precision: creeps by the rounding of its springs in single precision",
);
const PRESSED: Case =
    case("Rest and extremes", "a jam in a hopper under pressure: the run stops with the reason");
const EXIT: Case =
    case("Rest and extremes", "dem-run ends a jammed run with code 3, the reason and a readable file");

fn wall(name: &str, point: Vec3, normal: Vec3, velocity: Vec3) -> Wall {
    let shape = WallShape::Plane(Plane { point, normal });
    Wall { motion: Motion { velocity, ..Motion::still() }, ..Wall::new(name, 1, shape) }
}

#[test]
fn a_grain_between_closing_walls_stops_the_run() {
    for variant in variants() {
        let mut setup = variant.rough(0.5, 0.5);
        let way = Vec3::new(0.0, 0.0, 0.05);
        setup.walls = vec![
            wall("low", Vec3::new(0.0, 0.0, -0.0101), Vec3::z(), way),
            wall("high", Vec3::new(0.0, 0.0, 0.0101), -Vec3::z(), -way),
        ];
        setup.particles = vec![grain(7, Vec3::new(0.0, 0.0, 0.0))];
        let said = halt(&mut simulation(setup), 1_000_000).expect("stops");
        WEDGED.refused(
            &variant.name(),
            &said,
            &["particle 7", "overlaps wall '", "25.", "limit 25.0 %", "guards.overlap"],
        );
    }
}

/// Grains in one layer between two panes, over a mouth of 1.6 diameters between two slopes; the lid comes down on request.
fn hopper(variant: &Variant, lid: f64) -> Simulation {
    let mut setup = variant.rough(0.3, 0.8);
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.8);
    let slope = |side: f64| {
        let at = |x: f64, y: f64, z: f64| Vec3::new(side * x, y, z);
        let vertices =
            vec![at(0.013, -0.03, 0.0), at(0.013, 0.03, 0.0), at(0.093, 0.03, 0.06), at(0.093, -0.03, 0.06)];
        let shape = WallShape::Mesh(TriMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] });
        Wall::new(format!("slope {side}"), 1, shape)
    };
    let still = Vec3::zeros();
    setup.walls = vec![
        slope(1.0),
        slope(-1.0),
        wall("front", Vec3::new(0.0, -0.0102, 0.0), Vec3::y(), still),
        wall("back", Vec3::new(0.0, 0.0102, 0.0), -Vec3::y(), still),
        wall("left", Vec3::new(-0.09, 0.0, 0.0), Vec3::x(), still),
        wall("right", Vec3::new(0.09, 0.0, 0.0), -Vec3::x(), still),
        wall("lid", Vec3::new(0.0, 0.0, 0.2), -Vec3::z(), Vec3::new(0.0, 0.0, -lid)),
    ];
    setup.walls[6].motion.from = 0.3;
    let place = |k: u32| {
        let off = 3e-4 * f64::from(k * 7 % 5);
        Vec3::new(-0.0735 + 0.021 * f64::from(k % 8) + off, 0.0, 0.075 + 0.021 * f64::from(k / 8))
    };
    setup.particles = (0..24).map(|k| grain(k, place(k))).collect();
    simulation(setup)
}

#[test]
fn an_arch_stands_and_a_jam_that_is_pressed_on_stops() {
    for variant in variants() {
        let mut sim = hopper(&variant, 0.0);
        while sim.time() < 2.5 {
            sim.step().expect("an arch");
        }
        let early = particles(&mut sim);
        run(&mut sim, 5_000);
        let late = particles(&mut sim);
        let (speed, _) = fastest(&late);
        let way = farthest(&early, &late) / 5_000.0;
        if variant.mixed() {
            MIXED.within(&variant.name(), way, "m a step", 2e-11);
        } else {
            STILL.within(&variant.name(), speed, "m/s", 1e-8);
        }
        let fallen = late.iter().filter(|p| p.position.z < 0.0).count();
        ARCH.within(&variant.name(), fallen as f64, "grains fallen through", 0.0);
        let mut sim = hopper(&variant, 0.2);
        let said = halt(&mut sim, 1_000_000).expect("it stops");
        PRESSED.refused(
            &variant.name(),
            &said,
            &["overlaps", "25.0 % of the smaller radius", "guards.overlap"],
        );
    }
}

const HEAD: Head = Head {
    time: "until = 0.1",
    output: "every = 0.005",
    material: "stone",
    density: 2500.0,
    young: 1e7,
    contact: "LAW\nrestitution = 0.5\nsliding_friction = 0.5",
};

/// A grain between a floor and a plane that comes down.
const CLOSING: &str = r#"[[particles]]
source = "one.csv"
material = "stone"
[[wall]]
name = "low"
plane = "0,0,0,0,0,1"
material = "stone"
[[wall]]
name = "high"
plane = "0,0,0.021,0,0,-1"
material = "stone"
motion = { translate = [0, 0, -0.1] }
"#;

#[test]
fn dem_run_says_why_it_stops_with_code_3() {
    let laws = [
        ("hooke", "law = \"hooke\"\nstiffness = 1e4"),
        ("hertz", "law = \"hertz\""),
        ("jkr", "law = \"jkr\"\nwork_of_adhesion = 1.0"),
        ("hertz with cohesion", "cohesion = \"sjkr\"\ncohesion_energy_density = 5e4"),
    ];
    for (name, law) in laws {
        for precision in ["f64", "mixed"] {
            if precision == "mixed" && !["hooke", "hertz"].contains(&name) {
                continue;
            }
            let scene = HEAD.toml().replace("LAW", law) + CLOSING;
            let scene = format!("precision = \"{precision}\"\n{scene}");
            let folder =
                folder(&[("one.csv", "id,x,y,z,radius\n7,0,0,0.0101,0.01\n"), ("s.toml", scene.as_str())]);
            let f = folder.path();
            let done = tool(f, "dem-run", &["s.toml", "-o", "run.mcap", "--threads", "1"]);
            assert_eq!(done.code, 3, "{}", done.stderr);
            EXIT.refused(
                &format!("{name}, {precision}"),
                &done.stderr,
                &["dem-run: ", "particle 7", "overlaps wall '", "limit 25.0 %"],
            );
            succeed(f, "dem-view", &["run.mcap", "-o", "run.png", "--size", "64x64"]);
            // The step above the critical one, by the key that a user would set.
            let done = line(f, "dem-run s.toml --set time.dt=0.01 -o no.mcap");
            assert_eq!(done.code, 1, "{}", done.stderr);
            crate::step::ABOVE.refused(
                &format!("dem-run --set time.dt, {name}, {precision}"),
                &done.stderr,
                &["time.dt", "critical step", "stone (radius 1.0000e-2 m)"],
            );
        }
    }
}
