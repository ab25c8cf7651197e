//! A step above the critical one is refused before anything is written, and the pair is named.

use dem::setup::*;
use dem::{Simulation, critical_step, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{LAWS, empty, grain, plane, with_friction};
use grainpipe_tests::tools::tool;
use tempfile::tempdir;

const REFUSED: Case = case("Time step", "1.05 of the critical step is refused, naming the pair");

#[test]
fn by_the_engine() {
    for law in LAWS {
        for friction in [false, true] {
            let mut setup = empty(law, 0.5);
            setup.contacts.push(Contact::new((1, 1), law, 0.5));
            setup.walls = vec![plane(Vec3::z())];
            let small = Particle { radius: 0.001, material: 1, ..grain(2, Vec3::new(0.0, 0.0, 0.1)) };
            setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.01)), small];
            if friction {
                setup = with_friction(setup, 0.5);
            }
            let critical = critical_step(&setup).expect("laws for all pairs").dt;
            setup.step = Step::Fixed(0.999 * critical);
            Simulation::new(setup.clone()).expect("below the critical step");
            setup.step = Step::Fixed(1.05 * critical);
            let Err(message) = Simulation::new(setup).map(|_| ()) else { panic!("not refused") };
            let words = ["time.dt", "above the critical step", "wall (radius 1.0000e-3 m)"];
            REFUSED.refused(&format!("{law:?}, friction {friction}"), &message.to_string(), &words);
        }
    }
}

const SCENE: &str = r#"[time]
until = 0.001
dt = DT
[[material]]
name = "stone"
density = 2500
young = 1e7
poisson = 0.25
[[contact]]
between = ["stone", "stone"]
law = "hooke"
stiffness = 1e4
restitution = 1
[[particles]]
source = "grains.csv"
material = "stone"
"#;

/// Without damping and friction: 1/√(k/m*), of the smaller grains.
#[test]
fn by_the_tool() {
    let folder = tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let csv = "id,x,y,z,radius\n1,0,0,0,0.01\n2,0.05,0,0,0.004\n3,0.1,0,0,0.004\n";
    std::fs::write(path("grains.csv"), csv).expect("written");
    let critical = (0.5 * mass(0.004, 2500.0) / 1e4).sqrt();
    let run = |share: f64| {
        std::fs::write(path("s.toml"), SCENE.replace("DT", &format!("{:e}", share * critical)))
            .expect("written");
        tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"])
    };
    let done = run(1.05);
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(!path("run.mcap").exists());
    let words = ["time.dt", "above the critical step", "stone (radius 4.0000e-3 m)", "dt = \"auto\""];
    REFUSED.refused("dem-run", &done.stderr, &words);
    let done = run(0.999);
    assert_eq!(done.code, 0, "{}", done.stderr);
}
