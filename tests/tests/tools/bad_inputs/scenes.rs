//! Scenes, stages and resumed runs that cannot run.

use super::*;

const SCENE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.06
[output]
every = 0.02
checkpoint = 0.04
[[material]]
name = "sinter"
density = 3300
young = 2e7
poisson = 0.25
[[contact]]
between = ["sinter", "sinter"]
restitution = 0.5
[[fill]]
material = "sinter"
shape = "box:-0.04,-0.04,0.02,0.04,0.04,0.06"
diameter = [0.008, 0.012]
count = 40
[[wall]]
plane = "0,0,0,0,0,1"
material = "sinter"
"#;

pub fn scenes() -> TempDir {
    let folder = clouds();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("s.toml", SCENE);
    write("key.toml", &SCENE.replace("young =", "yung ="));
    write("type.toml", &SCENE.replace("density = 3300", "density = \"3300\""));
    write("broken.toml", &SCENE.replace("[time]", "[time"));
    let steel = "[[material]]\nname = \"steel\"\nyoung = 2e8\npoisson = 0.3\n";
    write(
        "law.toml",
        &format!("{}{steel}", SCENE.replace("1\"\nmaterial = \"sinter\"", "1\"\nmaterial = \"steel\"")),
    );
    let plant = SCENE.replace("plane = \"0,0,0,", "plane = \"0,0,-0.1,");
    write("plant.toml", &plant);
    write("walls.toml", &SCENE.replace("plane = \"0,0,0,0,0,1\"\n", ""));
    let f = folder.path();
    succeed(f, "wallgen", &["good.ply", "--roughness", "0.002", "--material", "sinter", "-o", "walls.mcap"]);
    for (stage, file) in [("upstream", "up.toml"), ("downstream", "down.toml")] {
        succeed(
            f,
            "stage-split",
            &["plant.toml", "--at", "0,0,0,0,0,-1", "--keep", stage, "--motion", "constant", "-o", file],
        );
    }
    succeed(f, "dem-run", &["s.toml", "-o", "run.mcap"]);
    succeed(f, "dem-run", &["up.toml", "--until", "0.1", "-o", "up.mcap"]);
    succeed(f, "stage-replay", &["up.mcap", "-o", "in.mcap"]);
    for name in ["up", "walls", "in"] {
        let bytes = fs::read(f.join(format!("{name}.mcap"))).unwrap();
        let write =
            |kind: &str, bytes: &[u8]| fs::write(f.join(format!("{name}-{kind}.mcap")), bytes).unwrap();
        write("cut", &bytes[..bytes.len() * 2 / 3]);
        write("long", &[&bytes[..], b"more"].concat());
        write("twice", &[&bytes[..], &bytes[..]].concat());
        let mut flipped = bytes.clone();
        flipped[bytes.len() / 2] ^= 0x10;
        write("flipped", &flipped);
    }
    let bytes = fs::read(f.join("run.mcap")).unwrap();
    fs::write(f.join("start.mcap"), &bytes[..700]).unwrap();
    folder
}

const SCENES: &[Case] = &[
    failed("dem-run missing.toml", &["missing.toml", "cannot open"]),
    misused("dem-run good.ply", &["good.ply is a cloud or a mesh", "the first file is the scene"]),
    failed("dem-run key.toml", &["key.toml:10:1", "'yung'", "did you mean 'young'?"]),
    failed("dem-run type.toml", &["type.toml:9:11", "expected a number"]),
    failed("dem-run broken.toml", &["broken.toml:2:"]),
    failed("dem-run law.toml", &["law.toml: contact: no law between 'sinter' and 'steel'", "[[contact]]"]),
    failed("dem-run s.toml --set material.0.density=-1", &["material.0.density = -1 kg/m³", "positive"]),
    failed("dem-run s.toml --set contact.0.restitutio=1", &["restitutio", "did you mean 'restitution'?"]),
    failed(
        "dem-run s.toml --set time.dt=0.01",
        &["s.toml with --set time.dt=0.01: time.dt: 1.0000e-2 s", "critical step", "sinter (radius", "auto"],
    ),
    failed("dem-run s.toml --set fill.0.count=0", &["fill.0.count", "0"]),
    failed("dem-run s.toml --set fill.0.count=4000000000", &["fill.0.count = 4000000000", "fifty million"]),
    failed(
        "dem-run s.toml --set gravity=[0,0]",
        &["s.toml with --set gravity=[0,0]: ", "number of values: 2", "list of 3"],
    ),
    failed("dem-run s.toml --set material.0.name=\"\"", &["material.0.name = \"\"", "is not a name"]),
    failed("dem-run s.toml --set guards.overlap=0", &["guards.overlap = 0: must"]),
    failed("dem-run s.toml --set fill.0.diameter.0=-0.1", &["fill.0.diameter", "-0.1"]),
    failed("dem-run s.toml --set fill.0.shape=box:0,0,0,1", &["fill.0.shape", "expected 6 numbers"]),
    failed("dem-run s.toml --until=-1", &["time.until = -1", "s"]),
    failed("dem-run s.toml --set wall.0.plane=0,0,0,0,0,0", &["wall.0.plane", "normal"]),
];

const SCENES_WITH_THEIR_WALLS_AND_INLETS: &[Case] = &[
    failed("dem-run walls.toml", &["waits for walls", "wallgen"]),
    misused("dem-run walls.toml good.ply", &["good.ply holds no walls", "wallgen"]),
    failed("dem-run walls.toml walls-cut.mcap", &["walls-cut.mcap", "truncated"]),
    failed("dem-run walls.toml walls-long.mcap", &["walls-long.mcap", "bytes follow the end"]),
    failed("dem-run walls.toml walls-twice.mcap", &["walls-twice.mcap", "bytes follow the end"]),
    failed("dem-run walls.toml walls-flipped.mcap", &["walls-flipped.mcap", "damaged"]),
    failed("dem-run s.toml missing.mcap", &["missing.mcap", "cannot open"]),
    failed("dem-run s.toml in.mcap", &["in.mcap: the scene has no [[inlet]]"]),
];

#[test]
fn scenes_that_cannot_run() {
    let folder = scenes();
    check(folder.path(), SCENES);
    check(folder.path(), SCENES_WITH_THEIR_WALLS_AND_INLETS);
}

const REPLAYS_AND_SPLITS: &[Case] = &[
    failed("stage-replay run.mcap", &["run.mcap", "without [[outlet]]", "stage-split"]),
    failed("stage-replay walls.mcap", &["walls.mcap"]),
    failed("stage-replay up-cut.mcap", &["up-cut.mcap", "truncated"]),
    failed("stage-replay <up-cut.mcap", &["stdin", "truncated"]),
    failed("stage-replay up-flipped.mcap", &["up-flipped.mcap", "damaged"]),
    failed("stage-replay up-long.mcap", &["up-long.mcap", "bytes follow the end"]),
    failed("stage-replay up-twice.mcap", &["up-twice.mcap", "cat"]),
    failed("stage-replay up.mcap --length 0.01", &["0.01", "largest diameter", "at least"]),
    misused("stage-replay up.mcap --move free", &["--move", "'free'", "ballistic"]),
    failed("stage-replay up.mcap --outlet 3", &["outlet", "3"]),
    failed(
        "stage-split plant.toml --at 0,0,0,0,0,-1 --keep upstream --length 0.01",
        &["--length 0.01 m", "largest diameter", "at least 0.0144 m"],
    ),
    failed(
        "stage-split plant.toml --at 0,0,0.1,0,0,-1 --keep upstream",
        &["no grains start upstream of the plane: its normal must point in the direction of flow"],
    ),
    failed("stage-split plant.toml --at 0,0,0.04,0,0,-1 --keep upstream", &["fill.0", "both sides"]),
    misused(
        "stage-split plant.toml --at 0,0,0,0,0,-1 --keep upstream --motion free",
        &["--motion", "'free'", "ballistic"],
    ),
];

const DOWNSTREAM_AND_RESUMED_RUNS: &[Case] = &[
    failed("dem-run down.toml", &["waits for an inlet", "stage-replay"]),
    failed("dem-run down.toml up.mcap", &["up.mcap", "stage-replay"]),
    failed("dem-run down.toml in-cut.mcap", &["in-cut.mcap", "truncated"]),
    failed(
        "dem-run s.toml --set outlet=[{plane=\"0,0,-1,0,0,-1\",length=0.01}]",
        &["outlet.0.length = 0.01 m", "largest diameter"],
    ),
    failed("dem-run plant.toml --resume run.mcap", &["--resume", "wall.0.plane", "was"]),
    failed("dem-run s.toml --resume start.mcap", &["start.mcap", "checkpoint"]),
    failed("dem-run s.toml --resume walls.mcap", &["walls.mcap"]),
    failed("dem-run s.toml --resume good.ply", &["good.ply", "MCAP"]),
    failed("dem-run s.toml --resume run.mcap", &["until"]),
    failed("dem-view in.mcap", &["in.mcap", "/particles"]),
    failed("dem-view up-cut.mcap", &["up-cut.mcap", "truncated"]),
];

#[test]
fn stages_and_resumed_runs_that_do_not_fit() {
    let folder = scenes();
    check(folder.path(), REPLAYS_AND_SPLITS);
    check(folder.path(), DOWNSTREAM_AND_RESUMED_RUNS);
}
