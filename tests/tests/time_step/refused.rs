//! A step above the critical one is refused before anything is written, and the pair is named.

use dem::setup::*;
use dem::{Simulation, critical_step, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::scenes::{Head, folder, write};
use grainpipe_tests::setups::{LAWS, contact, empty, grain, plane, with_friction};
use grainpipe_tests::tools::tool;
use scene::advice::explain_setup_error;

const REFUSED: Case = case("Time step", "1.05 of the critical step is refused, naming the pair");

#[test]
fn by_the_engine() {
    for law in LAWS {
        for friction in [false, true] {
            let mut setup = empty(law, 0.5);
            setup.contacts.push(contact((1, 1), law, 0.5));
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
            REFUSED.refused(&format!("{law:?}, friction {friction}"), &explain_setup_error(&message), &words);
        }
    }
}

/// Three grains that fly freely, in a step that is given.
fn scene(dt: f64) -> String {
    let head = Head {
        time: "until = 0.001\ndt = DT",
        output: "every = 0.001",
        material: "stone",
        density: 2500.0,
        young: 1e7,
        contact: "law = \"hooke\"\nstiffness = 1e4\nrestitution = 1",
    };
    let grains = "[[particles]]\nsource = \"grains.csv\"\nmaterial = \"stone\"\n";
    head.toml().replace("DT", &format!("{dt:e}")) + grains
}

/// Without damping and friction: 1/√(k/m*), of the smaller grains.
#[test]
fn by_the_tool() {
    let csv = "id,x,y,z,radius\n1,0,0,0,0.01\n2,0.05,0,0,0.004\n3,0.1,0,0,0.004\n";
    let folder = folder(&[("grains.csv", csv)]);
    let critical = (0.5 * mass(0.004, 2500.0) / 1e4).sqrt();
    let run = |share: f64| {
        write(folder.path(), "s.toml", scene(share * critical));
        tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"])
    };
    let done = run(1.05);
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(!folder.path().join("run.mcap").exists());
    let words = ["time.dt", "above the critical step", "stone (radius 4.0000e-3 m)", "dt = \"auto\""];
    REFUSED.refused("dem-run", &done.stderr, &words);
    let done = run(0.999);
    assert_eq!(done.code, 0, "{}", done.stderr);
}
