//! Mixtures: sizes and materials with shares, poured through one place.

use grainpipe_tests::recorded::frames;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use std::path::Path;

const HEAD: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.5
[output]
every = 0.1
[[material]]
name = "ore"
density = 3500
young = 5e7
poisson = 0.25
[[material]]
name = "coal"
density = 1400
young = 5e7
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
[[wall]]
box = [-0.1, -0.1, 0, 0.1, 0.1, 2]
material = "ore"
"#;

/// Mass of the grains of the last frame that a test picks by diameter [m] and material.
fn mass(run: &Path, pick: impl Fn(f64, f64) -> bool) -> f64 {
    let table = frames(run).pop().unwrap();
    let columns = record::Columns { name: "run", table: &table };
    let (radii, materials) = (columns.numbers("radius").unwrap(), columns.numbers("material").unwrap());
    let mass = |(r, m): (&f64, &f64)| {
        let density = if *m == 0.0 { 3500.0 } else { 1400.0 };
        if pick(2.0 * r, *m) { density * geom::sphere::volume(*r) } else { 0.0 }
    };
    radii.iter().zip(&materials).map(mass).sum()
}

#[test]
fn a_fill_has_the_shares_of_its_sizes_and_materials() {
    let fill = "[[fill]]\nsizes = [[\"16 mm\", 50, \"ore\"], [\"12 mm\", 30, \"coal\"], [[0.006, 0.008], 20, \"coal\"]]\n\
                shape = \"box:-0.1,-0.1,0,0.1,0.1,0.3\"\nmass = 2\n";
    let folder = folder(&[("s.toml", format!("{HEAD}{fill}"))]);
    succeed(folder.path(), "dem-run", &["s.toml", "--until", "0.0001", "-o", "run.mcap"]);
    let run = folder.path().join("run.mcap");
    let all = mass(&run, |_, _| true);
    assert!((all - 2.0).abs() < 0.01, "{all} kg");
    let near = |d: f64, of: f64| (d - of).abs() < 1e-6;
    // Within half a grain of the largest: 7.5 g.
    for (share, found) in [
        (0.5, mass(&run, |d, m| near(d, 0.016) && m == 0.0)),
        (0.3, mass(&run, |d, m| near(d, 0.012) && m == 1.0)),
        (0.2, mass(&run, |d, m| (0.006 - 1e-6..0.008 + 1e-6).contains(&d) && m == 1.0)),
    ] {
        assert!((found - share * all).abs() < 0.0075, "{share}: {found} of {all} kg");
    }
}

/// Two entries through one place: none comes in on top of another, and both keep their rates and shares.
#[test]
fn two_insertions_pour_through_one_place() {
    let insert = |material: &str, sizes: &str, rate: &str, seed: u64| {
        format!(
            "[[insert]]\nmaterial = \"{material}\"\nshape = \"box:-0.1,-0.1,0.5,0.1,0.1,0.6\"\nsizes = {sizes}\nrate = \"{rate}\"\n\
             velocity = [0, 0, -1]\nseed = {seed}\n"
        )
    };
    let sieve = "diameter,passing\n8,0\n12,40\n20,100\n";
    let both = insert("ore", "[[\"16 mm\", 1], [\"8 mm\", 1]]", "3 t/h", 0)
        + &insert("coal", "{ file = \"sieve.csv\", units = \"mm\" }", "2 t/h", 0);
    let folder = folder(&[("s.toml", format!("{HEAD}{both}")), ("sieve.csv", sieve.to_owned())]);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    let run = folder.path().join("run.mcap");
    let (ore, coal) = (mass(&run, |_, m| m == 0.0), mass(&run, |_, m| m == 1.0));
    // Grains enter 0.1 s before they leave the shape; frames hold those on their way, too.
    assert!((ore / (3.0 / 3.6 * 0.5) - 1.0).abs() < 0.02, "{ore} kg of ore");
    assert!((coal / (2.0 / 3.6 * 0.5) - 1.0).abs() < 0.02, "{coal} kg of coal");
    let fine = mass(&run, |d, m| m == 1.0 && d < 0.012);
    assert!((fine / coal - 0.4).abs() < 0.02, "{fine} of {coal} kg pass 12 mm");
    // At another velocity they would meet.
    let done = tool(folder.path(), "dem-run", &["s.toml", "--check", "--set", "insert.1.velocity=[0,0,-2]"]);
    assert!(done.code == 1 && done.stderr.contains("comes through the same place"), "{}", done.stderr);
}

#[test]
fn fixed_grains_stay_and_hold_others() {
    let more = "[[particles]]\nsource = \"fixed.csv\"\nmaterial = \"ore\"\nfixed = true\n\
                [[particles]]\nsource = \"free.csv\"\nmaterial = \"coal\"\n";
    let files = [
        ("s.toml", format!("{HEAD}{more}")),
        ("fixed.csv", "x,y,z,radius\n0,0,0.05,0.02\n".to_owned()),
        ("free.csv", "x,y,z,radius\n0,0,0.075,0.004\n".to_owned()),
    ];
    let folder = folder(&files);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    let coal = mass(&folder.path().join("run.mcap"), |_, m| m == 1.0);
    let all = mass(&folder.path().join("run.mcap"), |_, _| true);
    assert!(coal > 0.0 && coal == all, "the fixed one is a wall: {coal} of {all} kg");
}

#[test]
fn sizes_that_cannot_be_meant_are_refused() {
    let fill = "[[fill]]\nmaterial = \"ore\"\nshape = \"box:-0.1,-0.1,0,0.1,0.1,0.3\"\nmass = 0.1\nsizes = [[0.01, 1]]\n";
    let folder = folder(&[
        ("s.toml", format!("{HEAD}{fill}")),
        ("down.csv", "diameter,passing\n8,0\n6,100\n".to_owned()),
    ]);
    for (sizes, part) in [
        ("[[\"10 mm\", 0]]", "is not a share above 0"),
        ("[[\"10 kg\", 1]]", "kg"),
        ("[[[0.02, 0.01], 1]]", "ends before it begins"),
        ("[[0.01]]", "is not a diameter and a share"),
        ("[]", "has no size"),
        ("3", "is no list, file or law"),
        ("\"none.csv\"", "none.csv"),
        ("\"down.csv\"", "is no sieve curve"),
        ("{ law = \"normal\" }", "there are \"log-normal\""),
        ("{ law = \"log-normal\", median = 0.01, deviation = 0.1, from = 1, to = 2 }", "leave 0.000 %"),
        (
            "{ law = \"log-normal\", median = 0.01, deviation = 0.3, from = 0.012, to = 0.014 }",
            "0.012, law = \"log-normal\", median = 0.01, to = 0.014 }: 'from' and 'to' leave",
        ),
        (
            "{ law = \"rosin-rammler\", size = 0.01, spred = 3, from = 0.001, to = 0.02 }",
            "spred: is not known here",
        ),
        ("[[0.01, 1, \"gold\"]]", "each of sizes"),
        ("[[500, 1]]", "is no diameter from 0 to 100 m"),
    ] {
        let set = format!("fill.0.sizes={sizes}");
        let done = tool(folder.path(), "dem-run", &["s.toml", "--check", "--set", &set]);
        assert!(done.code == 1 && done.stderr.contains(part), "{sizes}: {}", done.stderr);
    }
}
