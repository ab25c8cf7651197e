//! A run that keeps the ledger ends with the error of its time step; the step of elastic grains keeps it small.

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use std::fmt::Write;

/// A dense gas of 216 grains that lose nothing.
fn gas() -> tempfile::TempDir {
    let (side, apart) = (6u32, 0.0215);
    let mut csv = "id,x,y,z,radius,vx,vy,vz\n".to_owned();
    let mut random = 12345u64;
    let mut speed = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    };
    for k in 0..side.pow(3) {
        let at = [k % side, k / side % side, k / side / side].map(|n| apart * (f64::from(n) + 0.5));
        let v = [speed(), speed(), speed()];
        writeln!(csv, "{k},{},{},{},0.01,{},{},{}", at[0], at[1], at[2], v[0], v[1], v[2]).expect("a string");
    }
    let edge = apart * f64::from(side);
    let toml = format!(
        "[time]\nuntil = 0.5\n[output]\nevery = 0.1\nenergy = true\n[domain]\nperiodic = [\"x\", \"y\", \"z\"]\n\
         low = [0, 0, 0]\nhigh = [{edge}, {edge}, {edge}]\n[[material]]\nname = \"glass\"\ndensity = 2500\nyoung = 1e7\n\
         poisson = 0.25\n[[contact]]\nbetween = [\"*\", \"*\"]\nlaw = \"hooke\"\nstiffness = 1e5\nrestitution = 1\n\
         [[particles]]\nsource = \"gas.csv\"\nmaterial = \"glass\"\n"
    );
    folder(&[("s.toml", toml), ("gas.csv", csv)])
}

/// The share [%] that the last line names.
fn share(stderr: &str) -> f64 {
    let (_, rest) = stderr.split_once("integration error ").unwrap_or_else(|| panic!("no line: {stderr}"));
    rest.split_whitespace().next().and_then(|word| word.parse().ok()).unwrap_or_else(|| panic!("{stderr}"))
}

#[test]
fn an_elastic_gas_keeps_its_energy_in_the_step_that_is_chosen() {
    let folder = gas();
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    assert!(share(&done.stderr).abs() < 1.0, "{}", done.stderr);
    assert!(!done.stderr.contains("warning"), "{}", done.stderr);
    let sampled = ["--set", "time.contacts=sampled"];
    let coarse = ["s.toml", "-o", "coarse.mcap", "--set", "time.safety=0.5", "--set", "guards.energy=1"];
    let coarse = succeed(folder.path(), "dem-run", &[&coarse[..], &sampled].concat());
    assert!(share(&coarse.stderr) > 1.0, "{}", coarse.stderr);
    assert!(
        coarse.stderr.contains("warning") && coarse.stderr.contains("smaller time.safety"),
        "{}",
        coarse.stderr
    );
    let text = tool(folder.path(), "dem-run", &[&["s.toml", "--explain"][..], &sampled].concat());
    let text = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(text.contains("safety 0.2 instead of 0.5") && text.contains("restitution 1"), "{text}");
    // Averaged, where damping is not matched to the step.
    let scene = std::fs::read_to_string(folder.path().join("s.toml")).expect("the scene");
    for unmatched in [
        scene.replace("\"hooke\"", "\"walton_braun\""),
        scene.replace("restitution = 1\n", "normal_damping = 1e-3\n"),
    ] {
        std::fs::write(folder.path().join("unmatched.toml"), unmatched).expect("written");
        let done = succeed(folder.path(), "dem-run", &["unmatched.toml", "-o", "unmatched.mcap"]);
        assert!(share(&done.stderr).abs() < 2.0, "{}", done.stderr);
    }
    // Without the ledger nothing is known of it, and the line says so.
    let plain =
        succeed(folder.path(), "dem-run", &["s.toml", "-o", "plain.mcap", "--set", "output.energy=false"]);
    assert!(
        plain.stderr.contains("integration error not measured (output.energy = true"),
        "{}",
        plain.stderr
    );
}

/// Grains of a lattice that touch up to the rounding of their places, 1e-18 m deep, and do not move: no energy to compare with, no warning, no guard.
#[test]
fn what_touches_by_rounding_does_not_move() {
    let toml = "[time]\nuntil = 0.01\n[guards]\nenergy = 0.01\n[output]\nenergy = true\n[[material]]\nname = \"a\"\ndensity = 1065\nyoung = 1e6\n\
                poisson = 0.4\n[[contact]]\nbetween = [\"a\", \"a\"]\nlaw = \"hooke\"\nrestitution = 1\nstiffness = 12960\n[[fill]]\n\
                material = \"a\"\nlattice = \"cubic\"\ndiameter = 0.0095\nshape = \"box:0,0,0,0.03,0.03,0.02\"\n";
    let folder = folder(&[("s.toml", toml.to_owned())]);
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    assert!(!done.stderr.contains("warning") && !done.stderr.contains("integration"), "{}", done.stderr);
}

/// A run that keeps the ledger stops where the step makes too much energy; one without it knows nothing of that. 5 % where contacts are sampled.
#[test]
fn the_ledger_stops_a_run_whose_step_makes_energy() {
    let folder = gas();
    let run = |sets: &[&str]| {
        let sets = sets.iter().flat_map(|set| ["--set", *set]);
        let args: Vec<&str> = ["s.toml", "-o", "-"].into_iter().chain(sets).collect();
        tool(folder.path(), "dem-run", &args)
    };
    let coarse = ["time.safety=0.95", "time.contacts=sampled"];
    let stopped = run(&coarse);
    assert!(stopped.code == 3 && stopped.stderr.contains("guards.energy"), "{}", stopped.stderr);
    for more in ["guards.energy=100", "guards.energy=false", "output.energy=false", "time.contacts=averaged"]
    {
        let done = run(&[&coarse[..], &[more]].concat());
        assert!(done.code == 0, "{more}: {}", done.stderr);
    }
}

/// The overlap guard makes the critical step of Hertz contacts: `--explain` says so.
#[test]
fn explain_says_what_the_overlap_guard_costs() {
    let folder = gas();
    let explain = |set: &[&str]| {
        let done = succeed(folder.path(), "dem-run", &[&["s.toml", "--explain"], set].concat());
        String::from_utf8_lossy(&done.stdout).into_owned()
    };
    let toml = std::fs::read_to_string(folder.path().join("s.toml")).expect("written");
    std::fs::write(
        folder.path().join("s.toml"),
        toml.replace("stiffness = 1e5\n", "").replace("law = \"hooke\"\n", ""),
    )
    .expect("written");
    let text = explain(&["--set", "guards.overlap=0.2"]);
    assert!(text.contains("at guards.overlap = 0.2; half of that would allow a critical step of"), "{text}");
    let hooke = ["--set", "contact.0.law=hooke", "--set", "contact.0.stiffness=1e5"];
    assert!(!explain(&hooke).contains("guards.overlap"));
}
