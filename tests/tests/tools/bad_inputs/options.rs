//! Options that cannot be meant.

use super::*;

const OF_CLOUD_CROP_AND_FILL: &[Case] = &[
    misused("cloud-crop good.ply --keep ball:0,0,0,1", &["--keep", "ball", "sphere:"]),
    misused("cloud-crop good.ply --keep sphere:0,0,0", &["--keep", "expected 4 numbers", "found 3"]),
    misused("cloud-crop good.ply --remove halfspace:0,0,0,0,0,0", &["--remove", "normal"]),
    misused("cloud-crop good.ply --keep sphere:0,0,0,-1", &["radius -1 m", "positive"]),
    misused("cloud-crop good.ply --keep mesh:missing.ply", &["missing.ply", "cannot read"]),
    misused("cloud-crop good.ply --keep mesh:mesh.obj", &["mesh.obj", "not closed"]),
    misused("cloud-crop good.ply --keep mesh:word.xyz", &["word.xyz", "give PLY, STL, OBJ"]),
    misused("cloud-crop good.ply --kep sphere:0,0,0,1", &["--kep", "--keep"]),
    misused("cloud-crop good.ply --largest -1", &["--largest"]),
    misused("cloud-crop good.ply --threads 0", &["--threads"]),
    misused("cloud-fill good.ply good.xyz", &["good.xyz"]),
    misused("cloud-fill good.ply --spacing 0", &["--spacing", "above 0"]),
    misused("cloud-fill good.ply --spacing=-0.1", &["--spacing", "above 0"]),
    misused("cloud-fill good.ply --fill noise", &["--fill", "noise", "blue-noise"]),
    misused("cloud-crop good.ply --threads 1000000", &["--threads 1000000", "at most 4096"]),
];

const OF_BLUENOISE_SAMPLE: &[Case] = &[
    misused("bluenoise-sample good.ply", &["--spacing", "--count", "--density"]),
    misused("bluenoise-sample good.ply --spacing 0.01 --count 5", &["--spacing", "--count"]),
    misused("bluenoise-sample good.ply --spacing -0.01", &["'-0.01' for '--spacing", "above 0"]),
    misused("bluenoise-sample good.ply --spacing 12furlong", &["--spacing", "12furlong", "furlong"]),
    misused("bluenoise-sample good.ply --count 0", &["count 0"]),
    misused("bluenoise-sample good.ply --density 500,20", &["density 500,20", "lower one first"]),
    misused("bluenoise-sample good.ply --density 500 --method tile", &["--density", "LO,HI"]),
    misused("bluenoise-sample good.ply --spacing 0.01 --method blue", &["--method", "poisson", "eliminate"]),
    misused("bluenoise-sample good.ply --spacing 0.01 --plot a.pdf", &["--plot", "a.pdf", "svg"]),
];

const OF_WALLGEN: &[Case] = &[
    misused(
        "wallgen good.ply --roughness 0.002mm",
        &["--roughness 0.002mm: is neither a length in metres nor a file"],
    ),
    misused("wallgen good.ply", &["--roughness", "--radius M"]),
    misused("wallgen good.ply --roughness 0", &["--roughness 0 m", "positive"]),
    misused("wallgen good.ply --roughness -0.001", &["--roughness -0.001 m", "positive"]),
    misused(
        "wallgen good.ply --roughness 0.001 --place surface --facing 0,0,0",
        &["--facing 0,0,0", "no direction"],
    ),
    misused("wallgen good.ply --roughness 0.001 --smallest-particle -1", &["--smallest-particle -1 m"]),
    misused("wallgen good.ply --roughness 0.001 --young 0", &["--young 0 Pa", "positive"]),
    misused("wallgen good.ply --roughness 0.001 --place surface", &["--place surface", "--facing x,y,z"]),
    misused("wallgen good.ply --roughness 0.001 --poisson 0.7", &["--poisson", "0.7"]),
    misused("wallgen --roughness 0.001 --from-mesh mesh.obj", &["--from-mesh", "add --radius M"]),
    misused("wallgen --from-mesh mesh.obj", &["--from-mesh", "add --radius M and --roughness M"]),
    misused("wallgen --radius 0.01 --from-mesh mesh.obj", &["--from-mesh", "add --roughness M"]),
    failed("wallgen --radius 0.01 --roughness 0.02 --from-mesh mesh.obj", &["0.02 m", "at most the radius"]),
    failed("wallgen --radius 1e-9 --roughness 1e-12 --from-mesh mesh.obj", &["too many", "millimetres"]),
    failed(
        "wallgen --radius 0.01 --roughness 0.001 --from-mesh missing.stl",
        &["missing.stl", "cannot read"],
    ),
    misused("wallgen good.ply --roughness 0.001 --ascii", &["--ascii", "no text form"]),
];

const OF_RUNS_STAGES_AND_VIEWS: &[Case] = &[
    misused("stage-replay up.mcap --from nan", &["--from", "nan", "seconds"]),
    misused("stage-replay up.mcap --from 2 --until 1", &["--until 1 s", "--from 2 s"]),
    misused("stage-replay up.mcap --axis 0,0,0,0,0,1", &["--turn-deg"]),
    misused("stage-replay up.mcap --ahead 0.1 --intervals generation", &["--ahead 0.1", "changes nothing"]),
    misused("dem-view good.ply --time nan", &["--time", "seconds"]),
    misused("dem-view - -", &["only one of the inputs"]),
    misused("dem-run - -", &["only one of the inputs", "give files"]),
    failed("dem-view good.ply --colour speeed", &["speeed"]),
    misused("stage-split s.toml --at 0,0,0,0,0,0 --keep upstream", &["--at", "normal"]),
    misused("stage-split s.toml --at 0,0,0,0,0,-1", &["--keep"]),
    misused("stage-split s.toml --at 0,0,0,0,0,-1 --keep both", &["both", "upstream"]),
    misused("dem-run", &["SCENE.toml"]),
    misused("dem-run s.toml --until soon", &["--until", "soon"]),
];

const OF_NUMBERS: &[Case] = &[
    misused("chute-scan --tilt-deg nan", &["--tilt-deg", "not a finite number"]),
    misused("cost-curve s.toml --vary time.safety=0.1,0.5 --exact nan", &["--exact", "not a finite number"]),
    misused("dem-measure up.mcap --repose --ground nan", &["--ground", "not a finite number"]),
    misused("dem-measure up.mcap --repose --time inf", &["--time", "give a time in seconds"]),
    misused("dem-measure up.mcap --segregation --split nan", &["--split", "not a finite number"]),
    misused("dem-measure up.mcap --wear all --cell 1e308", &["--cell", "beyond 1e100"]),
    misused("dem-measure up.mcap --flow 0,0,0,0,0,1 --span 0", &["--span", "above 0"]),
    misused("stage-replay up.mcap --length nan", &["--length", "not a finite number"]),
    misused("wallgen good.ply --roughness 0.001 --friction nan", &["--friction", "not a finite number"]),
    misused("wallgen good.ply --roughness 0.001 --radius 1e308", &["--radius", "1e308"]),
    misused("cloud-fill good.ply --spacing 1e308", &["--spacing", "beyond 1e100"]),
    misused("bluenoise-sample good.ply --spacing 1e308", &["--spacing", "beyond 1e100"]),
];

#[test]
fn options_that_cannot_be_meant() {
    let folder = clouds();
    for cases in
        [OF_CLOUD_CROP_AND_FILL, OF_BLUENOISE_SAMPLE, OF_WALLGEN, OF_RUNS_STAGES_AND_VIEWS, OF_NUMBERS]
    {
        check(folder.path(), cases);
    }
}

#[test]
fn outputs_of_a_format_or_a_folder_that_cannot_be_written() {
    let folder = clouds();
    for (line, part) in [
        ("cloud-crop good.ply -o a.las", "-o a.las: the output is PLY"),
        ("cloud-fill good.ply -o a.csv", "-o a.csv: the output is PLY"),
        ("bluenoise-sample good.ply --spacing 0.02 -o a.xyz", "-o a.xyz: the output is PLY"),
        ("wallgen good.ply --roughness 0.002 -o a.las", "-o a.las: the output is MCAP or PLY"),
        ("dem-view good.ply -o a.png --every 0.1", "--every changes nothing in .png"),
        ("dem-view good.ply -o a.xyz", ".html"),
        ("dem-view good.ply -o a", ".html"),
    ] {
        let done = run(folder.path(), line, &[]);
        assert!(done.code == 2 && done.stderr.contains(part), "{line}: {}", done.stderr);
    }
    for line in [
        "cloud-crop good.ply -o no/such/a.ply",
        "cloud-crop good.ply -o folder",
        "cloud-crop good.ply -o b.ply --report no/r.json",
    ] {
        let done = run(folder.path(), line, &[]);
        assert!(done.code == 1 && done.stderr.contains("folder"), "{line}: {}", done.stderr);
        println!("{line}\n    {}", done.stderr);
    }
}

#[test]
fn lengths_of_another_unit_are_told() {
    let folder = clouds();
    for (line, part) in [
        ("wallgen mm.xyz --roughness 0.05 --smallest-particle 0.01", "far larger than the smallest particle"),
        ("wallgen good.ply --radius 12", "the given radius of 12 m is larger than the cloud"),
        ("bluenoise-sample mm.xyz --spacing 0.01", "all 400 points were kept"),
        ("bluenoise-sample good.ply --spacing 10", "1 of 400 points were kept"),
    ] {
        let done = run(folder.path(), line, &[]);
        assert!(done.code == 0 && done.stderr.contains(part), "{line}: {}", done.stderr);
    }
}
